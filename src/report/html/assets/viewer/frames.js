// The images of a viewer, and what can be looked at: each of them, and the error of each render.

/** Unpacks the images that a figure carries. */
async function unpackFrames({ width, height, frames }) {
  return Promise.all(frames.map(async packed => {
    const frame = { ...packed, width, height, pixels: width * height };
    Object.assign(frame, await unpack(packed.image, frame.pixels));
    if (packed.noise) frame.noise = await unpack(packed.noise, frame.pixels);
    frame.mean = meanLuminance(frame);
    frame.layers = new Map(packed.layers.map(({ name, image }) => [name, image]));
    return frame;
  }));
}

/** Unpacks the parts of the images, which are many: the page is there before them. */
async function unpackLayers(frames) {
  for (const frame of frames) {
    for (const [name, image] of frame.layers) frame.layers.set(name, await unpack(image, frame.pixels));
    frame.hasParts = true;
  }
}

function meanLuminance(frame) {
  let sum = 0, count = 0;
  for (let pixel = 0; pixel < frame.pixels; pixel++) {
    const value = luminance(pixelOf(frame, pixel));
    if (Number.isFinite(value)) { sum += value; count++; }
  }
  return count ? sum / count : 0;
}

/** All that an image shows. */
const WHOLE = 'whole image';

/** What of the images can be looked at: all, each bounce alone, bounces added up, one way of sampling. */
function partsOf(frames) {
  const names = [...new Set(frames.flatMap(frame => [...frame.layers.keys()]))];
  const bounces = names.filter(name => name.startsWith('bounce '));
  const sums = bounces.slice(1).map(name => `${bounces[0].replace('bounce', 'bounces')} to ${name.slice(7)}`);
  return [WHOLE, ...bounces, ...sums, ...names.filter(name => !bounces.includes(name))];
}

/** A part of an image, made once; all of one that does not have it, which its label says. */
function partOf(frame, part) {
  if (part === WHOLE || !isRadiance(frame) || !frame.hasParts) return frame;
  frame.made = frame.made || new Map();
  if (!frame.made.has(part)) frame.made.set(part, makePart(frame, part));
  return frame.made.get(part);
}

function makePart(frame, part) {
  const layers = layersOf(frame, part);
  if (!layers) return { ...frame, label: `${frame.label} · ${WHOLE}` };
  const made = { ...frame, ...sumOf(layers, frame.pixels), noise: null, label: `${frame.label} · ${part}` };
  return Object.assign(made, { mean: meanLuminance(made) });
}

/** The layers that a part is the sum of; nothing where one is missing. */
function layersOf({ layers }, part) {
  const [, first, last] = /^bounces (\d+) to (\d+)$/.exec(part) || [];
  const names = last ? Array.from({ length: last - first + 1 }, (_, step) => `bounce ${Number(first) + step}`) : [part];
  return names.every(name => layers.has(name)) ? names.map(name => layers.get(name)) : null;
}

/** Images added up, as half floats again. */
function sumOf(images, pixels) {
  if (images.length === 1) return images[0];
  const scale = images.length * Math.max(...images.map(image => image.scale));
  const code = index => halfCode(images.reduce((sum, { codes, scale }) => sum + HALVES[codes[index]] * scale, 0) / scale);
  return { scale, codes: Uint16Array.from({ length: 3 * pixels }, (_, index) => code(index)) };
}

/** What the keys 1, 2, 3 choose: the images, then the error of each render. */
function viewsOf(frames) {
  const renders = frames.flatMap((frame, index) => frame.role === 'render' ? [index] : []);
  const hasReference = frames.some(frame => frame.role === 'reference');
  const errors = hasReference ? renders : [];
  return [
    ...frames.map((_, index) => ({ frame: index, isError: false })),
    ...errors.map(index => ({ frame: index, isError: true })),
  ];
}

/** What a view is called, with the part that is looked at. */
const labelOf = (frames, { frame, isError }) => `${isError ? 'error of ' : ''}${frames[frame].label}`;

/** Whether exposure and tone curve apply to a frame; others are in false colour of a fixed scale. */
const isRadiance = frame => frame.kind === 'radiance';
