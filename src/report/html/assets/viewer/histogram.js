// How often each luminance occurs, image by image, on a logarithmic axis.

const BINS = 64;
const HISTOGRAM = { width: 320, height: 120, axis: 16 };

function histogram({ frames, state }) {
  const shown = frames.filter(isRadiance);
  const logs = shown.map(logLuminances);
  const [low, high] = rangeOf(logs.flat());
  const { width, height, axis } = HISTOGRAM;
  const counts = logs.map(values => binned(values, low, high));
  const most = Math.max(1, ...counts.flat());
  const x = log => (log - low) / (high - low) * width;
  const steps = of => of.map((count, bin) =>
    `${bin ? 'V' : 'M0 '}${((height - axis) * (1 - count / most)).toFixed(1)}H${((bin + 1) * width / BINS).toFixed(1)}`);
  const white = x(-state.stops);
  const svg = draw('svg', { viewBox: `0 0 ${width} ${height}`, role: 'img', 'aria-label': 'histogram of luminance' },
    ...counts.map((of, index) => draw('path', { class: `line-${index}`, d: steps(of).join('').replace('V', ' ') })),
    draw('line', { class: 'white', x1: white, x2: white, y1: 0, y2: height - axis }),
    text(0, 'start', figure(2 ** low)), text(width, 'end', figure(2 ** high)));
  const names = shown.map((frame, index) => make('span', { className: `line-${index}` }, `${frame.label} `));
  return [svg, make('p', { className: 'faint' }, 'luminance, logarithmic; the line is white: ', ...names)];
}

function text(x, anchor, words) {
  const drawn = draw('text', { x, y: HISTOGRAM.height - 3, 'text-anchor': anchor });
  drawn.textContent = words;
  return drawn;
}

function logLuminances(frame) {
  const values = Array.from({ length: frame.pixels }, (_, pixel) => luminance(pixelOf(frame, pixel)));
  return values.filter(value => Number.isFinite(value) && value > 0).map(Math.log2);
}

/** Whole powers of two around all but the darkest thousandth. */
function rangeOf(logs) {
  const sorted = Float32Array.from(logs).sort();
  if (!sorted.length) return [-8, 0];
  const low = Math.floor(sorted[Math.floor(sorted.length / 1000)]);
  return [low, Math.max(low + 1, Math.ceil(sorted[sorted.length - 1]))];
}

function binned(values, low, high) {
  const counts = Array(BINS).fill(0);
  for (const value of values) {
    const bin = Math.floor((value - low) / (high - low) * BINS);
    if (bin >= 0) counts[Math.min(bin, BINS - 1)]++;
  }
  return counts;
}
