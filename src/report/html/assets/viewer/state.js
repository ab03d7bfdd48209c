// What a reader chooses in a viewer, and how it stands in the address.

const CHANNELS = ['RGB', 'R', 'G', 'B', 'luminance'];
const LAYOUTS = { all: 'side by side', one: 'one', wipe: 'wipe' };

/** Shown in place of a scale of rejected cells. */
const NO_CELLS = 'no cells';

/** The scales at which some image is rejected, tiles before pixels: they show most. */
function scalesOf(frames) {
  const scales = new Set(frames.flatMap(frame => frame.rejected.map(cell => cell.scale)));
  return [...scales].sort((a, b) => b.startsWith('tile') - a.startsWith('tile'));
}

/** What is shown at first. */
function initialState({ frames, views, stops, scales }) {
  const render = views.findIndex(view => frames[view.frame].role === 'render');
  const reference = Math.max(0, frames.findIndex(frame => frame.role === 'reference'));
  return {
    layout: 'all', show: Math.max(0, render), under: reference, reference,
    tone: 'sRGB', stops, offset: 0, channel: 'RGB', metric: 'relative error', limit: 0,
    zoom: 0, x: 0, y: 0, wipe: 0.5, region: null, insets: [],
    part: WHOLE, cells: scales[0] || NO_CELLS, histogram: true,
  };
}

/** The choices that differ from what is shown at first. */
function choicesOf(state, initial) {
  const text = value => Array.isArray(value) ? value.join(' ') : String(value);
  const changed = Object.keys(initial).filter(name => text(state[name]) !== text(initial[name]));
  const short = value => typeof value === 'number' ? Number(value.toFixed(3)) : text(value);
  return changed.map(name => [name, short(state[name])]);
}

/** A state with what the address says; what makes no sense there is left out. */
function withChoices(initial, choices, views) {
  const state = { ...initial };
  for (const [name, word] of choices) {
    const value = read(name, word, initial, views);
    if (value !== undefined) state[name] = value;
  }
  return state;
}

function read(name, word, initial, views) {
  const known = { layout: Object.keys(LAYOUTS), tone: TONES, channel: CHANNELS, metric: Object.keys(METRICS) };
  if (known[name]) return known[name].includes(word) ? word : undefined;
  if (name === 'region') return readExtent(word.split(' '));
  if (name === 'insets') return word.split(' ').map(corners => readExtent(corners.split(','))).filter(Boolean);
  if (name === 'cells' || name === 'part') return word;
  if (typeof initial[name] === 'boolean') return word === 'true';
  const number = Number(word);
  if (!(name in initial) || !Number.isFinite(number)) return undefined;
  const isView = ['show', 'under', 'reference'].includes(name);
  return isView && !views[number] ? undefined : number;
}

function readExtent(numbers) {
  const extent = numbers.map(Number);
  return extent.length === 4 && extent.every(Number.isInteger) ? extent : undefined;
}
