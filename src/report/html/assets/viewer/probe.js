// The table below the stage: values, ratio and standard errors of every image, of the pixel under the pointer, of the
// region that was drawn, or else of the whole image.

/** Standard errors of a 99.9 % confidence interval. */
const SIGMAS = 3.2905;

/** What the table is about: column, row, width and height, and its name. */
function placeOf({ pointer, state, frames }) {
  const [{ width, height }] = frames;
  if (pointer) return { extent: [...pointer, 1, 1], name: `pixel (${pointer.join(', ')})` };
  if (state.region) return { extent: state.region, name: `region of ${state.region.slice(2).join(' × ')} pixels` };
  return { extent: [0, 0, width, height], name: `whole image, ${width} × ${height} pixels` };
}

/** Means over the finite pixels of a rectangle, with their standard errors where the noise is known. */
function statistics(frame, [left, top, width, height]) {
  const sums = { count: 0, mean: [0, 0, 0, 0], variance: [0, 0, 0, 0] };
  for (let y = top; y < top + height; y++) {
    for (let x = left; x < left + width; x++) add(sums, frame, y * frame.width + x);
  }
  const { count } = sums;
  return {
    count,
    mean: sums.mean.map(sum => sum / count),
    error: frame.noise ? sums.variance.map(sum => Math.sqrt(sum) / count) : null,
  };
}

/** Red, green, blue, and luminance, whose noise is at most this, whatever the channels have in common. */
const withLuminance = colour => [colour[0], colour[1], colour[2], luminance(colour)];

function add(sums, frame, pixel) {
  const colour = pixelOf(frame, pixel);
  if (!colour.every(Number.isFinite)) return;
  const [values, noise] = [withLuminance(colour), withLuminance(noiseOf(frame, pixel))];
  sums.count++;
  for (let channel = 0; channel < 4; channel++) {
    sums.mean[channel] += values[channel];
    sums.variance[channel] += noise[channel] ** 2;
  }
}

/** The rows of the table: texts, image by image. */
function probeRows(viewer) {
  const { extent } = placeOf(viewer);
  const isOne = extent[2] * extent[3] === 1;
  const reference = statistics(viewer.frames[viewer.state.reference], extent);
  return viewer.frames.map((frame, index) => {
    const own = statistics(frame, extent);
    const colour = isOne ? withLuminance(pixelOf(frame, extent[1] * frame.width + extent[0])) : own.mean;
    const compared = isRadiance(frame) && index !== viewer.state.reference;
    return [
      frame.label,
      ...colour.map((value, channel) => withInterval(value, own.error && own.error[channel])),
      compared ? known(colour[3] / reference.mean[3]) : '',
      compared && own.error && reference.error ? known(apart(own, reference)) : '',
    ];
  });
}

function withInterval(value, error) {
  return error ? `${figure(value)} ±${Number((SIGMAS * error).toPrecision(2))}` : figure(value);
}

/** Nothing over nothing is left open. */
const known = value => Number.isFinite(value) ? figure(value) : '';

/** How many standard errors two luminances lie apart. */
function apart(own, reference) {
  return (own.mean[3] - reference.mean[3]) / Math.hypot(own.error[3], reference.error[3]);
}

/** The rejected cells that hold the pixel under the pointer. */
function cellsAt({ pointer, frames }) {
  const holds = ([x, y, width, height]) => pointer[0] >= x && pointer[0] < x + width
    && pointer[1] >= y && pointer[1] < y + height;
  return pointer ? frames.flatMap(frame => frame.rejected.filter(cell => holds(cell.extent))) : [];
}

function probe(viewer) {
  const place = placeOf(viewer);
  viewer.place.textContent = place.name;
  viewer.table.replaceChildren(...probeRows(viewer).map(cells => make('tr', {}, ...cells.map((text, index) =>
    make(index ? 'td' : 'th', index ? {} : { scope: 'row' }, text)))));
  viewer.cell.textContent = cellsAt(viewer).map(cell =>
    `rejected: ${cell.scale}, ${cell.component} ${figure(cell.measured)} instead of ${figure(cell.expected)}, `
    + `p ${cell.p < 1e-300 ? '< 1e−300' : `= ${figure(cell.p)}`}`).join('; ');
}
