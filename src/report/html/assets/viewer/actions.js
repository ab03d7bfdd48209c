// What keys and buttons do to the state of a viewer. Keys are those of tev where it has them.

const STEP = { stops: 0.5, offset: 0.1, zoom: Math.SQRT2, pan: 40 };
const ZOOMS = [0.25, 128];

/** The next of a list after the present one, or the one before. */
function turned(list, present, by) {
  return list[(list.indexOf(present) + by + list.length) % list.length];
}

function choose(viewer, index) {
  const { state } = viewer;
  if (!viewer.views[index]) return;
  if (index !== state.show) state.under = state.show;
  state.show = index;
  if (state.layout === 'all') state.layout = 'one';
}

function lay(viewer, layout) {
  viewer.state.layout = viewer.state.layout === layout ? 'one' : layout;
}

/** Zooms about a place on the stage. */
function zoomBy(viewer, factor, pane, x, y) {
  const { state, ratio } = viewer;
  const before = cameraOf(viewer);
  const [atX, atY] = toImage(viewer, pane, x, y);
  const zoom = Math.min(Math.max(before.zoom / ratio * factor, ZOOMS[0]), ZOOMS[1]);
  const share = before.zoom / ratio / zoom;
  Object.assign(state, { zoom, x: atX + (before.x - atX) * share, y: atY + (before.y - atY) * share });
}

function zoomAboutCentre(viewer, factor) {
  const [pane] = viewer.stage.panes;
  zoomBy(viewer, factor, pane, pane.x + pane.width / 2, pane.y + pane.height / 2);
}

function pan(viewer, x, y) {
  const { zoom, ...centre } = cameraOf(viewer);
  const step = STEP.pan * viewer.ratio / zoom;
  Object.assign(viewer.state, { zoom: zoom / viewer.ratio, x: centre.x + x * step, y: centre.y + y * step });
}

/** Exposure and offset that bring the render's luminances into [0, 1]. */
function normalise({ frames, state, views }) {
  const frame = frames[views[state.show].frame];
  const values = logLuminances(frame);
  if (values.length) Object.assign(state, { stops: -values.reduce((a, b) => Math.max(a, b)), offset: 0 });
}

function reset(viewer) {
  Object.assign(viewer.state, viewer.initial, { show: viewer.state.show, layout: viewer.state.layout });
}

/** So many insets stand below an image. */
const MOST_INSETS = 3;

/** Enlarges the region below every image; without a region, takes all of these away. */
function pin({ state }) {
  state.insets = state.region ? [...state.insets, state.region].slice(-MOST_INSETS) : [];
  state.region = null;
}

/** Every key: what it does, in words and in code. */
const KEYS = {
  ' ': ['flip to the image before', viewer => choose(viewer, viewer.state.under)],
  'ArrowDown': ['next image', viewer => choose(viewer, (viewer.state.show + 1) % viewer.views.length)],
  'ArrowUp': ['image before', viewer => choose(viewer, (viewer.state.show + viewer.views.length - 1) % viewer.views.length)],
  'w': ['wipe', viewer => lay(viewer, 'wipe')],
  'g': ['side by side', viewer => lay(viewer, 'all')],
  'e': ['brighter by half a stop', ({ state }) => { state.stops += STEP.stops; }],
  'E': ['darker by half a stop', ({ state }) => { state.stops -= STEP.stops; }],
  'o': ['offset up', ({ state }) => { state.offset += STEP.offset; }],
  'O': ['offset down', ({ state }) => { state.offset -= STEP.offset; }],
  'n': ['normalise', normalise],
  'r': ['reset', reset],
  't': ['next tone curve', ({ state }) => { state.tone = turned(TONES, state.tone, 1); }],
  'T': ['tone curve before', ({ state }) => { state.tone = turned(TONES, state.tone, -1); }],
  ']': ['next channel', ({ state }) => { state.channel = turned(CHANNELS, state.channel, 1); }],
  '[': ['channel before', ({ state }) => { state.channel = turned(CHANNELS, state.channel, -1); }],
  'm': ['next error metric', ({ state, metrics }) => { state.metric = turned(metrics, state.metric, 1); state.limit = 0; }],
  'M': ['error metric before', ({ state, metrics }) => { state.metric = turned(metrics, state.metric, -1); state.limit = 0; }],
  'p': ['outlines of rejected cells, next scale', ({ state, scales }) => {
    state.cells = turned([...scales, NO_CELLS], state.cells, 1);
  }],
  'b': ['next part: each bounce, bounces added up, ways of sampling', ({ state, partNames }) => { state.part = turned(partNames, state.part, 1); }],
  'B': ['part before', ({ state, partNames }) => { state.part = turned(partNames, state.part, -1); }],
  'x': ['enlarge the region below every image; without one, take these away', pin],
  'i': ['histogram', ({ state }) => { state.histogram = !state.histogram; }],
  'f': ['fit', ({ state }) => { state.zoom = 0; }],
  '0': ['one to one', viewer => zoomAboutCentre(viewer, viewer.ratio / cameraOf(viewer).zoom)],
  '+': ['zoom in', viewer => zoomAboutCentre(viewer, STEP.zoom)],
  '-': ['zoom out', viewer => zoomAboutCentre(viewer, 1 / STEP.zoom)],
  'h': ['move left', viewer => pan(viewer, -1, 0)],
  'l': ['move right', viewer => pan(viewer, 1, 0)],
  'k': ['move up', viewer => pan(viewer, 0, -1)],
  'j': ['move down', viewer => pan(viewer, 0, 1)],
  's': ['save as PNG', viewer => save(viewer)],
  '?': ['these keys', viewer => { viewer.help.hidden = !viewer.help.hidden; }],
  'Escape': ['drop the region', viewer => { viewer.state.region = null; viewer.help.hidden = true; }],
};

/** Acts on a key; whether it is one of ours. */
function act(viewer, { key, code, shiftKey }) {
  const digit = /^Digit([1-9])$/.exec(code);
  if (digit && key !== '0') return number(viewer, Number(digit[1]) - 1, shiftKey);
  const known = KEYS[key === '=' ? '+' : key];
  if (known) known[1](viewer);
  return Boolean(known);
}

/** A number chooses an image; with shift, what the others are compared with. */
function number(viewer, index, isReference) {
  if (!viewer.views[index]) return false;
  if (!isReference) choose(viewer, index);
  else if (index < viewer.frames.length) viewer.state.reference = index;
  return true;
}

/** Downloads what is on the stage. */
function save({ canvas, id }) {
  canvas.toBlob(blob => {
    const href = URL.createObjectURL(blob);
    make('a', { href, download: `${id.replace(/[^a-z0-9-]+/gi, '-')}.png` }).click();
    setTimeout(() => URL.revokeObjectURL(href), 1000);
  });
}
