// Starts the viewers of a page: each figure carries its images, and shows them without scripts too.

async function startViewer(root) {
  const packed = JSON.parse(root.querySelector('script').textContent);
  const frames = await unpackFrames(packed);
  const views = viewsOf(frames);
  const scales = scalesOf(frames);
  const initial = initialState({ frames, views, scales, stops: packed.stops });
  const viewer = {
    root, id: root.id, frames, whole: frames, partNames: partsOf(frames), views, scales, initial, state: { ...initial }, metrics: metricsOf(frames),
    layers: new Layers(frames), pointer: null, help: help(), ...furniture(frames),
  };
  const { showControls, redraw } = animate(viewer);
  const changed = () => { writeAddress(viewer.id, choicesOf(viewer.state, initial)); redraw(); };
  const restore = () => {
    const { anchor, choices } = readAddress();
    if (anchor === viewer.id) Object.assign(viewer.state, withChoices(initial, choices, views));
    redraw();
  };
  showControls.of = controls(viewer, changed);
  root.querySelector('.frames').before(...viewer.parts, viewer.help);
  followPointer(viewer, changed, redraw);
  root.addEventListener('keydown', event => {
    if (event.ctrlKey || event.metaKey || event.altKey || isTyping(event)) return;
    if (act(viewer, event)) { event.preventDefault(); changed(); }
  });
  new ResizeObserver(redraw).observe(root);
  addEventListener('hashchange', restore);
  root.classList.add('started');
  restore();
  const drawn = new Promise(done => requestAnimationFrame(() => setTimeout(done)));
  viewer.unpacked = drawn.then(() => unpackLayers(frames)).then(redraw).catch(error => tell(root, error));
  return viewer;
}

/** Sliders, choosers and focused buttons keep their own arrows and space. */
function isTyping({ target, key }) {
  return ['INPUT', 'SELECT'].includes(target.tagName) || target.tagName === 'BUTTON' && [' ', 'Enter'].includes(key);
}

/** Of the table of values. */
const COLUMNS = [
  ['image', ''], ['red', ''], ['green', ''], ['blue', ''], ['luminance', ''],
  ['ratio', 'luminance over that of the reference'],
  ['z', 'how many standard errors the luminance lies from that of the reference'],
];

/** The stage and what stands below it. */
function furniture(frames) {
  const canvas = make('canvas', { className: 'stage', role: 'img' });
  const place = make('caption');
  const table = make('tbody');
  const columns = make('tr', {}, ...COLUMNS.map(([words, title]) => make('th', { scope: 'col', title }, words)));
  const cell = make('p', { className: 'cell-text' });
  const bars = make('div', { className: 'histogram' });
  const values = make('div', { className: 'wide', role: 'group', ariaLabel: 'values under the pointer', tabIndex: 0 }, make('table', { className: 'small values' }, place, make('thead', {}, columns), table));
  const notes = frames.map(frame => make('p', { className: 'faint' }, `${frame.label}: ${frame.caption}`, broken(frame)));
  const below = make('div', { className: 'below' }, make('div', {}, values, cell, ...notes), bars);
  return { canvas, place, table, cell, bars, parts: [canvas, below] };
}

/** How many pixels are no numbers: they are magenta. */
function broken({ nan, infinite }) {
  const counts = [[nan, 'NaN'], [infinite, 'infinite']].filter(([count]) => count);
  const words = counts.map(([count, what]) => `${count} ${what}`).join(', ');
  return words ? make('b', { className: 'bad' }, ` · pixels not finite: ${words} (magenta)`) : '';
}

/** Draws at most once a frame of the browser. */
function animate(viewer) {
  const showControls = { of: () => {} };
  let waiting = 0;
  const redraw = () => { waiting = waiting || requestAnimationFrame(() => { waiting = 0; drawAll(viewer); showControls.of(); }); };
  return { showControls, redraw };
}

function drawAll(viewer) {
  const { canvas, root, state } = viewer;
  viewer.ratio = Math.min(3, devicePixelRatio || 1);
  viewer.width = canvas.clientWidth;
  // Folded away: it is drawn once it is seen.
  if (!viewer.width) return;
  viewer.frames = viewer.whole.map(frame => partOf(frame, state.part));
  viewer.layers.frames = viewer.frames;
  viewer.ink = getComputedStyle(root).color;
  viewer.stage = layOut(viewer);
  const { width, height } = viewer.stage;
  if (canvas.width !== Math.round(width) || canvas.height !== Math.round(height)) {
    Object.assign(canvas, { width: Math.round(width), height: Math.round(height) });
  }
  canvas.style.height = `${height / viewer.ratio}px`;
  canvas.style.touchAction = state.zoom ? 'none' : 'pan-y';
  canvas.setAttribute('aria-label', `${viewer.stage.panes.map(pane => labelOf(viewer.frames, pane.view)).join(', ')}, `
    + `exposure ${state.stops.toFixed(1)} stops, ${state.tone}`);
  paint(viewer);
  probe(viewer);
  const drawn = state.histogram ? histogram(viewer) : [];
  viewer.bars.replaceChildren(...drawn);
}

/** The images without scripts stay. */
function tell(root, error) {
  root.append(make('p', { className: 'bad' }, `The viewer does not start: ${error.message}`));
}

const viewers = Promise.all(all('.viewer:has(script)').map(root => startViewer(root).catch(error => tell(root, error))));
