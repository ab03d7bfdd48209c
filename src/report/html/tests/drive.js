// Drives a page from within, as a reader would, and sends what it saw to the test that opened it, whose port is the
// query of the address.

const seen = { errors: drivenErrors };
const frameOfBrowser = () => new Promise(done => { requestAnimationFrame(() => setTimeout(done)); });
const encoded = bytes => btoa(Array.from(bytes, byte => String.fromCharCode(byte)).join(''));

/** A state from which every key has somewhere to go. */
function unsettle(viewer) {
  const middle = { layout: 'one', show: 1, under: 0, zoom: 3.3, x: 5, y: 5, region: [1, 1, 2, 2], limit: 3 };
  Object.assign(viewer.state, viewer.initial, middle);
  viewer.help.hidden = true;
}

const shownBy = viewer => JSON.stringify([viewer.state, viewer.help.hidden]);

/** The keys that change nothing. */
function deadKeys(viewer) {
  const digits = ['Digit1', 'Digit3'].map(code => ({ key: code.slice(-1), code }));
  const others = Object.keys(KEYS).filter(key => key !== 's').map(key => ({ key, code: '' }));
  return [...digits, ...others].filter(press => {
    unsettle(viewer);
    const before = shownBy(viewer);
    viewer.root.dispatchEvent(new KeyboardEvent('keydown', { ...press, bubbles: true }));
    return shownBy(viewer) === before;
  }).map(press => press.key);
}

/** Whether that changes what is shown, from one of two states. */
async function hasEffect(viewer, operate) {
  const last = { tone: TONES.at(-1), channel: CHANNELS.at(-1), part: viewer.partNames.at(-1), metric: viewer.metrics.at(-1) };
  for (const other of [{}, { ...last, layout: 'all', show: 0, under: 1, cells: NO_CELLS }]) {
    unsettle(viewer);
    Object.assign(viewer.state, other);
    drawAll(viewer);
    const before = shownBy(viewer);
    operate();
    await frameOfBrowser();
    if (shownBy(viewer) !== before) return true;
  }
  return false;
}

const setTo = (control, value, event) => {
  control.value = value;
  control.dispatchEvent(new Event(event));
};

/** The controls that change nothing, at any of their values. */
async function deadControls(viewer) {
  const dead = [];
  const operate = async (name, action) => { if (!await hasEffect(viewer, action)) dead.push(name); };
  for (const button of all('.tools button', viewer.root).filter(button => button.textContent !== 'PNG')) {
    await operate(button.textContent, () => button.click());
  }
  for (const select of all('.tools select', viewer.root)) {
    for (const { value } of select.options) await operate(`${select.title}: ${value}`, () => setTo(select, value, 'change'));
  }
  for (const slider of all('.tools input', viewer.root)) {
    await operate(slider.ariaLabel, () => setTo(slider, slider.min, 'input'));
  }
  return dead;
}

/** The files that are saved by the key and by the button for it. */
async function savedFiles(viewer) {
  const saved = [];
  const click = HTMLAnchorElement.prototype.click;
  HTMLAnchorElement.prototype.click = function () { saved.push(this.download); };
  viewer.root.dispatchEvent(new KeyboardEvent('keydown', { key: 's', bubbles: true }));
  all('.tools button', viewer.root).find(button => button.textContent === 'PNG').click();
  for (let turn = 0; turn < 200 && saved.length < 2; turn += 1) await frameOfBrowser();
  HTMLAnchorElement.prototype.click = click;
  return saved;
}

/** The 8-bit colours of every image under each tone curve. */
function shaded(viewer, stops) {
  return Object.keys(CURVES).map(tone => {
    const state = { ...viewer.initial, tone, stops };
    return viewer.frames.map((frame, index) => {
      const canvas = viewer.layers.of(viewer.views[index], state);
      return encoded(canvas.getContext('2d').getImageData(0, 0, frame.width, frame.height).data);
    });
  });
}

async function hover(viewer) {
  Object.assign(viewer.state, viewer.initial);
  drawAll(viewer);
  const [pane] = viewer.stage.panes;
  const box = viewer.canvas.getBoundingClientRect();
  const [x, y] = toStage(viewer, pane, 2.5, 1.5).map(place => place / viewer.ratio);
  viewer.canvas.dispatchEvent(new PointerEvent('pointermove', { clientX: box.left + x, clientY: box.top + y }));
  await frameOfBrowser();
  return { pointer: viewer.pointer, rows: all('tr', viewer.table).map(row => all('td', row).map(cell => cell.textContent)) };
}

/** What the parts of images are called, and what a pixel of three bounces is worth. */
function partsSeen({ partNames, whole }) {
  const value = frame => valueOf(frame, 30, 0);
  const labels = whole.slice(0, 2).map(frame => partOf(frame, 'light sampling').label);
  return { names: partNames, labels, whole: value(whole[0]), sum: value(partOf(whole[0], 'bounces 0 to 2')) };
}

/** The stage without and with insets, and the colour at the corner of one. */
function insetsSeen(viewer) {
  Object.assign(viewer.state, viewer.initial);
  drawAll(viewer);
  const without = viewer.stage.height;
  Object.assign(viewer.state, { insets: [[4, 3, 4, 4]] });
  drawAll(viewer);
  const { panes: [pane], boxes: [box], height } = viewer.stage;
  const [x, y] = [pane.x + box.x + box.width / 8, pane.y + pane.height + GAP * viewer.ratio + box.height / 8];
  const layer = viewer.layers.of(pane.view, viewer.state);
  const colour = (canvas, x, y) => [...canvas.getContext('2d').getImageData(x, y, 1, 1).data];
  const seen = { without, with: height, colour: colour(viewer.canvas, x, y), expected: colour(layer, 4, 3) };
  Object.assign(viewer.state, viewer.initial);
  return seen;
}

async function driveViewer(viewer) {
  seen.state = { ...viewer.state };
  seen.values = viewer.frames.map(frame => {
    const values = Array.from({ length: frame.pixels }, (_, pixel) => pixelOf(frame, pixel));
    return values.flat().map(String);
  });
  seen.tables = Object.keys(CURVES).map(tone => encoded(toneTable(1, { tone, stops: 0.3, offset: 0 })));
  seen.shaded = shaded(viewer, 1.3);
  seen.dead = [...deadKeys(viewer), ...await deadControls(viewer)];
  seen.saved = await savedFiles(viewer);
  seen.hover = await hover(viewer);
  seen.parts = partsSeen(viewer);
  seen.insets = insetsSeen(viewer);
  seen.canvas = [viewer.canvas.width, viewer.canvas.height];
}

/** What is serious, with everything unfolded. */
async function barriers() {
  for (const folded of document.querySelectorAll('details')) folded.open = true;
  await frameOfBrowser();
  const { violations } = await axe.run(document, { preload: false });
  const serious = violations.filter(found => ['serious', 'critical'].includes(found.impact));
  return serious.map(({ id, nodes }) => `${id}: ${nodes.map(node => node.html.slice(0, 160)).join('\n')}`);
}

async function drive() {
  const started = typeof viewers === 'undefined' ? [] : await viewers;
  await frameOfBrowser();
  await Promise.all(started.map(viewer => viewer?.unpacked));
  if (typeof axe !== 'undefined') seen.barriers = await barriers();
  if (started[0]) await driveViewer(started[0]);
  seen.listed = all('#all-trials tbody tr').filter(row => !row.hidden).map(row => row.textContent);
  const loaded = performance.getEntriesByType('resource').map(entry => entry.name);
  seen.fetched = loaded.filter(name => !/^(file|data|blob):/.test(name));
  seen.width = [document.documentElement.scrollWidth, innerWidth];
}

drive().catch(error => drivenErrors.push(`${error.message} ${error.stack}`)).then(() => {
  const port = location.search.slice(1);
  return fetch(`http://127.0.0.1:${port}/`, { method: 'POST', mode: 'no-cors', body: JSON.stringify(seen) });
});
