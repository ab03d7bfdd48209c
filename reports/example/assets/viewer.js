'use strict';
// Elements, in one expression each.

function make(name, properties = {}, ...children) {
  const element = Object.assign(document.createElement(name), properties);
  element.append(...children);
  return element;
}

/** An element of a drawing. */
function draw(name, attributes = {}, ...children) {
  const element = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.append(...children);
  return element;
}
// Half floats: what they are worth, and how images come out of the page.

/** The value of each of the 65,536 half floats. */
const HALVES = Float32Array.from({ length: 65536 }, (_, code) => halfValue(code));

function halfValue(code) {
  const sign = code & 0x8000 ? -1 : 1;
  const exponent = (code >> 10) & 31;
  const fraction = code & 1023;
  if (exponent === 0) return sign * fraction * 2 ** -24;
  if (exponent === 31) return fraction ? NaN : sign * Infinity;
  return sign * (1 + fraction / 1024) * 2 ** (exponent - 15);
}

const single = new Float32Array(1);
const singleBits = new Uint32Array(single.buffer);

/** The half float nearest to a value. */
function halfCode(value) {
  if (Number.isNaN(value)) return 0x7e00;
  // What half floats call their exponents lies 112 below what single ones do.
  single[0] = Math.abs(value) * 2 ** -112;
  const [bits] = singleBits;
  const code = Math.min(bits + 0xfff + (bits >> 13 & 1) >> 13, 0x7c00);
  return value < 0 ? code | 0x8000 : code;
}

const isFiniteHalf = code => (code & 0x7c00) !== 0x7c00;

/**
 * An image out of the page: codes of half floats, red, green and blue of each pixel, times a power of two.
 * They were packed as planes of high bytes, then of low bytes, for neighbours are alike.
 */
async function unpack({ data, exponent }, pixels) {
  const text = atob(data);
  const deflated = new Uint8Array(text.length);
  for (let at = 0; at < text.length; at++) deflated[at] = text.charCodeAt(at);
  const stream = new Blob([deflated]).stream().pipeThrough(new DecompressionStream('deflate'));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  const codes = new Uint16Array(3 * pixels);
  const low = 3 * pixels;
  for (let channel = 0; channel < 3; channel++) {
    for (let pixel = 0, at = channel * pixels; pixel < pixels; pixel++, at++) {
      codes[3 * pixel + channel] = bytes[at] << 8 | bytes[low + at];
    }
  }
  return { codes, scale: 2 ** exponent };
}

const valueOf = (image, pixel, channel) => HALVES[image.codes[3 * pixel + channel]] * image.scale;
const pixelOf = (image, pixel) => [valueOf(image, pixel, 0), valueOf(image, pixel, 1), valueOf(image, pixel, 2)];
// Tone mapping: exposure, offset, then a curve to 8 bits. Byte for byte what furnace does in Rust.

const CURVES = {
  'sRGB': srgb,
  'gamma 2.2': light => clip(light) ** (1 / 2.2),
  'linear': clip,
  'filmic': light => srgb(filmic(Math.max(light, 0))),
};
/** Not a curve: luminance in false colour. */
const FALSE_COLOUR = 'false colour';
const TONES = [...Object.keys(CURVES), FALSE_COLOUR];

const MAGENTA = [255, 0, 255];

function clip(light) {
  return Math.min(Math.max(light, 0), 1);
}

/** IEC 61966-2-1. */
function srgb(light) {
  const clipped = clip(light);
  if (clipped <= 0.0031308) return 12.92 * clipped;
  return clipped >= 1 ? 1 : 1.055 * clipped ** (1 / 2.4) - 0.055;
}

/** Narkowicz's fit of the ACES curve (2015). */
function filmic(light) {
  return (light * (2.51 * light + 0.03)) / (light * (2.43 * light + 0.59) + 0.14);
}

/** Radiance as it is shown: in single precision, as in Rust. */
function exposed(radiance, { stops, offset }) {
  return Math.fround(Math.fround(radiance * Math.fround(2 ** stops)) + Math.fround(offset));
}

/** The 8-bit code of each half float under these settings. */
function toneTable(scale, settings) {
  const curve = CURVES[settings.tone];
  return Uint8Array.from(HALVES, half => toneCode(curve, exposed(half * scale, settings)));
}

function toneCode(curve, light) {
  return Number.isNaN(light) ? 0 : Math.floor(255 * curve(light) + 0.5);
}

const luminance = ([red, green, blue]) => 0.2126 * red + 0.7152 * green + 0.0722 * blue;
// False colour: a signed scale, one for magnitudes; the same stops as in Rust.

/** ColorBrewer's RdBu, reversed: blue for too dark, red for too bright. */
const SIGNED = [0x2166ac, 0x67a9cf, 0xd1e5f0, 0xf7f7f7, 0xfddbc7, 0xef8a62, 0xb2182b];
/** Nine stops of viridis: dark for little, bright for much. */
const MAGNITUDE = [0x440154, 0x472c7a, 0x3b518b, 0x2c718e, 0x21908d, 0x27ad81, 0x5cc863, 0xaadc32, 0xfde725];

const bytesOf = colour => [colour >> 16, colour >> 8 & 255, colour & 255];

/** The colour at a place in [0, 1] of a scale, between two stops; magenta for NaN. */
function scaleColour(stops, place) {
  if (Number.isNaN(place)) return MAGENTA;
  const along = clip(place) * (stops.length - 1);
  const left = Math.min(Math.floor(along), stops.length - 2);
  const [from, to] = [bytesOf(stops[left]), bytesOf(stops[left + 1])];
  return from.map((value, i) => Math.round(value + (along - left) * (to[i] - value)));
}

const signedColour = (value, limit) => scaleColour(SIGNED, 0.5 + 0.5 * value / limit);
const magnitudeColour = (value, limit) => scaleColour(MAGNITUDE, value / limit);

/** Luminance in false colour runs over these stops around white. */
const FALSE_STOPS = [-8, 2];

function falseColour(light) {
  if (!Number.isFinite(light)) return MAGENTA;
  const [low, high] = FALSE_STOPS;
  return scaleColour(MAGNITUDE, (Math.log2(Math.max(light, 2 ** low)) - low) / (high - low));
}

/** CSS for a legend. */
function gradient(stops) {
  return `linear-gradient(90deg, ${stops.map(stop => `rgb(${bytesOf(stop)})`).join(', ')})`;
}
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
// Error maps: how far a render is from the reference, pixel by pixel.

/** What dark pixels are measured against: this share of the reference's mean luminance. */
const DARK = 0.01;

/**
 * Each metric is a function of measured and expected value, what counts as dark, and the noise of both. A signed
 * one has no end where it is zero; `limit` is the end of its scale where that does not depend on the image.
 */
const METRICS = {
  'relative error': { signed: true, of: (a, b, dark) => (a - b) / (Math.abs(b) + dark), unit: '%' },
  'error by channel': { signed: true, coloured: true, of: (a, b, dark) => (a - b) / (Math.abs(b) + dark), unit: '%' },
  'absolute error': { signed: false, of: (a, b) => Math.abs(a - b) },
  'relative squared error': { signed: false, of: (a, b, dark) => (a - b) ** 2 / (b ** 2 + dark ** 2) },
  'standard errors': { signed: true, noisy: true, limit: 6, of: (a, b, _, noise) => noise === 0 ? 0 : (a - b) / noise },
};

/** The metrics that these images allow: some need to know the noise. */
function metricsOf(frames) {
  const known = frames.filter(frame => frame.kind === 'radiance').every(frame => frame.noise);
  return Object.keys(METRICS).filter(name => known || !METRICS[name].noisy);
}

/** The error of each pixel of `test`: one number, or three where each channel is shown in its own colour. */
function errorMap(test, reference, name, channel) {
  const metric = METRICS[name];
  const dark = DARK * reference.mean || 1e-6;
  const one = (pixel, pick) => {
    const noise = metric.noisy ? Math.hypot(pick(noiseOf(test, pixel)), pick(noiseOf(reference, pixel))) : 0;
    return metric.of(pick(pixelOf(test, pixel)), pick(pixelOf(reference, pixel)), dark, noise);
  };
  const picks = metric.coloured && channel === 'RGB' ? ['R', 'G', 'B'].map(pickOf) : [pickOf(channel)];
  const errors = new Float32Array(picks.length * test.pixels);
  for (let pixel = 0, at = 0; pixel < test.pixels; pixel++) {
    for (const pick of picks) errors[at++] = one(pixel, pick);
  }
  return { errors, channels: picks.length };
}

/** From a colour to the number that is looked at. */
function pickOf(channel) {
  const index = ['R', 'G', 'B'].indexOf(channel);
  return index < 0 ? luminance : colour => colour[index];
}

const noiseOf = (frame, pixel) => frame.noise ? pixelOf(frame.noise, pixel) : [NaN, NaN, NaN];

/** The end of a scale that shows nearly all of the errors: 1, 2 or 5 times a power of ten. */
function limitOf(errors) {
  const sizes = errors.filter(Number.isFinite).map(Math.abs).sort();
  const high = sizes[Math.floor(0.95 * sizes.length)] || 1e-3;
  const power = 10 ** Math.floor(Math.log10(high));
  return [1, 2, 5, 10].map(step => step * power).find(limit => limit >= 0.999 * high);
}
// From half floats to 8 bits: the pixels of a view, made again only when what they depend on has changed.

class Layers {
  constructor(frames) {
    this.frames = frames;
    this.kept = new Map();
  }

  /** A canvas with one pixel for each pixel of the view. */
  of(view, state) {
    const frame = this.frames[view.frame];
    const look = view.isError ? ['metric', 'limit', 'channel', 'reference']
      : isRadiance(frame) ? ['tone', 'stops', 'offset', 'channel'] : [];
    const key = JSON.stringify(['part', ...look].map(name => state[name]));
    const kept = this.kept.get(view);
    if (kept && kept.key === key) return kept.canvas;
    const canvas = this.canvasOf(frame, this.shade(view, frame, state));
    this.kept.set(view, { key, canvas });
    return canvas;
  }

  canvasOf({ width, height }, colours) {
    const canvas = Object.assign(document.createElement('canvas'), { width, height });
    canvas.getContext('2d').putImageData(new ImageData(colours, width, height), 0, 0);
    return canvas;
  }

  shade(view, frame, state) {
    if (view.isError) return this.shadeError(frame, state);
    if (!isRadiance(frame)) return shadeScale(frame);
    return state.channel === 'RGB' && state.tone !== FALSE_COLOUR
      ? shadeColour(frame, state) : shadeNumber(frame, state);
  }

  /** The error map of a frame under these settings, with the end of its scale. */
  errorsOf(frame, { metric, channel, reference, limit }) {
    const map = errorMap(frame, this.frames[reference], metric, channel);
    return { ...map, limit: limit || METRICS[metric].limit || limitOf(map.errors) };
  }

  shadeError(frame, state) {
    const { errors, channels, limit } = this.errorsOf(frame, state);
    if (channels === 3) return shadeThree(errors, limit);
    const colour = METRICS[state.metric].signed ? signedColour : magnitudeColour;
    return fill(frame.pixels, pixel => colour(errors[pixel], limit));
  }
}

/** Bytes of red, green, blue and full opacity. */
function fill(pixels, colour) {
  const bytes = new Uint8ClampedArray(4 * pixels).fill(255);
  for (let pixel = 0; pixel < pixels; pixel++) bytes.set(colour(pixel), 4 * pixel);
  return bytes;
}

/** Three channels through one table: a half float has only 65,536 values. */
function shadeColour(frame, state) {
  const { codes, scale, pixels } = frame;
  const table = toneTable(scale, state);
  return fill(pixels, pixel => {
    const [red, green, blue] = codes.subarray(3 * pixel, 3 * pixel + 3);
    const isFinite = isFiniteHalf(red) && isFiniteHalf(green) && isFiniteHalf(blue);
    return isFinite ? [table[red], table[green], table[blue]] : MAGENTA;
  });
}

/** One channel or luminance, in grey or in false colour. */
function shadeNumber(frame, state) {
  const pick = pickOf(state.channel);
  const light = pixel => exposed(pick(pixelOf(frame, pixel)), state);
  if (state.tone === FALSE_COLOUR) return fill(frame.pixels, pixel => falseColour(light(pixel)));
  const curve = CURVES[state.tone];
  const grey = value => Number.isFinite(value) ? Array(3).fill(toneCode(curve, value)) : MAGENTA;
  return fill(frame.pixels, pixel => grey(light(pixel)));
}

/** What is no radiance, in the colours of its own scale: the channel farthest from zero. */
function shadeScale(frame) {
  const colour = frame.kind === 'signed' ? signedColour : magnitudeColour;
  const farther = (a, b) => Number.isNaN(a) || Math.abs(a) >= Math.abs(b) ? a : b;
  return fill(frame.pixels, pixel => colour(pixelOf(frame, pixel).reduce(farther), 1));
}

/** Errors of three channels around grey: darker is too dark, a tint is an error of colour. */
function shadeThree(errors, limit) {
  const code = error => 127.5 * (1 + Math.max(-1, Math.min(1, error / limit)));
  return fill(errors.length / 3, pixel => {
    const three = errors.subarray(3 * pixel, 3 * pixel + 3);
    return three.some(Number.isNaN) ? MAGENTA : Array.from(three, code);
  });
}
// Where each view stands on the stage, and how image and stage coordinates belong together. All in device pixels.

/** An image is shown at this size or more where there is room. */
const LEAST_ZOOM = 4;
const LABEL_HEIGHT = 24;
const GAP = 8;
/** Of the window's height, what one image may take. */
const TALLEST = 0.72;

/** As many beside each other as can be shown large. */
function columnsFor(count, width, imageWidth) {
  const fits = columns => width / columns - GAP >= LEAST_ZOOM * imageWidth;
  const columns = [4, 3, 2].find(columns => columns <= count && fits(columns));
  return columns || (width > 700 ? Math.min(2, count) : 1);
}

/** Lays the stage out for a width in CSS pixels: its height, its panes, and the zoom that fits. */
function layOut({ views, state, frames, width: cssWidth, ratio }) {
  const [image] = frames;
  const shown = state.layout === 'all' ? views : [views[state.show]];
  const columns = columnsFor(shown.length, cssWidth, image.width);
  const [width, label, gap] = [cssWidth * ratio, LABEL_HEIGHT * ratio, GAP * ratio];
  const paneWidth = Math.floor((width - gap * (columns - 1)) / columns);
  const tallest = Math.max(TALLEST * innerHeight * ratio, LEAST_ZOOM * ratio * image.height);
  const zoom = wholeZoom(Math.min(paneWidth / image.width, tallest / image.height));
  const paneHeight = Math.ceil(image.height * zoom);
  const boxes = insetBoxes(state.insets, paneWidth, gap);
  const below = Math.max(0, ...boxes.map(box => box.height + gap));
  const panes = shown.map((view, index) => ({
    view,
    x: index % columns * (paneWidth + gap),
    y: Math.floor(index / columns) * (paneHeight + below + label + gap) + label,
    width: paneWidth,
    height: paneHeight,
  }));
  const rows = Math.ceil(shown.length / columns);
  return { panes, boxes, zoom, width, height: rows * (paneHeight + below + label + gap) - gap };
}

/** Where insets stand below a pane, from its left edge, each at most as high as wide. */
function insetBoxes(insets, paneWidth, gap) {
  const most = Math.floor((paneWidth - gap * (insets.length - 1)) / Math.max(2, insets.length));
  return insets.map(([, , width, height], index) => {
    const zoom = wholeZoom(Math.min(most / width, most / height));
    return { x: index * (most + gap), width: width * zoom, height: height * zoom };
  });
}

/** Whole numbers of device pixels, so that all pixels are alike. */
const wholeZoom = zoom => zoom >= 1 ? Math.floor(zoom) : zoom;

/** The zoom and the centre that hold: the reader's, or what shows all of the image. */
function cameraOf({ state, frames, stage, ratio }) {
  const [{ width, height }] = frames;
  if (!state.zoom) return { zoom: stage.zoom, x: width / 2, y: height / 2 };
  return { zoom: state.zoom * ratio, x: state.x, y: state.y };
}

const paneAt = (stage, x, y) => stage.panes.find(pane =>
  x >= pane.x && x < pane.x + pane.width && y >= pane.y && y < pane.y + pane.height);

/** The place in the image below a place on the stage. */
function toImage(viewer, pane, x, y) {
  const camera = cameraOf(viewer);
  return [
    (x - pane.x - pane.width / 2) / camera.zoom + camera.x,
    (y - pane.y - pane.height / 2) / camera.zoom + camera.y,
  ];
}

/** The place on the stage of a place in the image. */
function toStage(viewer, pane, x, y) {
  const camera = cameraOf(viewer);
  return [
    Math.round((x - camera.x) * camera.zoom + pane.x + pane.width / 2),
    Math.round((y - camera.y) * camera.zoom + pane.y + pane.height / 2),
  ];
}
// The stage: images, and over them what was chosen: outlines of rejected cells, numbers, the wipe, the selection.

/** Pixels this large carry their numbers, CSS pixels. */
const NUMBERS_FROM = 44;

function paint(viewer) {
  const { canvas, layers, state, views, stage } = viewer;
  const pen = canvas.getContext('2d');
  pen.clearRect(0, 0, canvas.width, canvas.height);
  for (const pane of stage.panes) {
    within(pen, pane, () => drawImage(viewer, pen, pane, layers.of(pane.view, state)));
    if (state.layout === 'wipe') wipe(viewer, pen, pane, layers.of(views[state.under], state));
    within(pen, pane, () => drawOver(viewer, pen, pane));
    drawInsets(viewer, pen, pane, layers.of(pane.view, state));
    drawLabel(viewer, pen, pane);
  }
}

/** Draws with nothing outside of a rectangle. */
function within(pen, { x, y, width, height }, draw) {
  pen.save();
  pen.beginPath();
  pen.rect(x, y, width, height);
  pen.clip();
  draw();
  pen.restore();
}

function drawImage(viewer, pen, pane, layer) {
  const [left, top] = toStage(viewer, pane, 0, 0);
  const { zoom } = cameraOf(viewer);
  pen.imageSmoothingEnabled = false;
  pen.drawImage(layer, left, top, layer.width * zoom, layer.height * zoom);
}

function wipe(viewer, pen, pane, layer) {
  const width = Math.round(pane.width * viewer.state.wipe);
  within(pen, { ...pane, width }, () => {
    pen.clearRect(pane.x, pane.y, width, pane.height);
    drawImage(viewer, pen, pane, layer);
  });
  pen.fillStyle = '#fff';
  pen.fillRect(pane.x + width - viewer.ratio, pane.y, 2 * viewer.ratio, pane.height);
}

function drawOver(viewer, pen, pane) {
  const { state, frames, ratio } = viewer;
  const frame = frames[pane.view.frame];
  outlineArea(viewer, pen, pane, rejectedAt(frame, state.cells));
  state.insets.forEach((inset, index) => outline(viewer, pen, pane, inset, INSET_COLOURS[index]));
  if (state.region) outline(viewer, pen, pane, state.region, '#fff');
  if (viewer.pointer) outline(viewer, pen, pane, [...viewer.pointer, 1, 1], '#fff');
  if (cameraOf(viewer).zoom >= NUMBERS_FROM * ratio) drawNumbers(viewer, pen, pane);
}

/** Of the outlines of insets, in their order: far from those of rejected cells. */
const INSET_COLOURS = ['#4cc9f0', '#ff8fd0', '#9be564'];

/** What is enlarged below a pane, in the same colours as above. */
function drawInsets(viewer, pen, pane, layer) {
  viewer.stage.boxes.forEach((box, index) => {
    const [left, top] = [pane.x + box.x, pane.y + pane.height + GAP * viewer.ratio];
    pen.imageSmoothingEnabled = false;
    pen.drawImage(layer, ...viewer.state.insets[index], left, top, box.width, box.height);
    const edge = new Path2D();
    edge.rect(left, top, box.width, box.height);
    stroke(viewer, pen, edge, INSET_COLOURS[index]);
  });
}

/** Where a scale rejects: cells of one component may stand where those of another do. */
function rejectedAt(frame, scale) {
  const extents = frame.rejected.filter(cell => cell.scale === scale).map(cell => cell.extent);
  return [...new Map(extents.map(extent => [String(extent), extent])).values()];
}

/** The border of all cells together: no line stands between two of them. */
function outlineArea(viewer, pen, pane, cells) {
  const corners = new Set(cells.map(([x, y]) => `${x} ${y}`));
  const area = new Path2D();
  for (const [x, y, width, height] of cells) {
    const [left, top] = toStage(viewer, pane, x, y);
    const [right, bottom] = toStage(viewer, pane, x + width, y + height);
    const edges = [
      [x - width, y, left, top, left, bottom], [x + width, y, right, top, right, bottom],
      [x, y - height, left, top, right, top], [x, y + height, left, bottom, right, bottom],
    ];
    for (const [besideX, besideY, fromX, fromY, toX, toY] of edges) {
      if (corners.has(`${besideX} ${besideY}`)) continue;
      area.moveTo(fromX, fromY);
      area.lineTo(toX, toY);
    }
  }
  stroke(viewer, pen, area, '#ffd23f');
}

/** A rectangle in a line with a dark rim, which is seen on any image. */
function outline(viewer, pen, pane, [x, y, width, height], colour) {
  const [left, top] = toStage(viewer, pane, x, y);
  const [right, bottom] = toStage(viewer, pane, x + width, y + height);
  const box = new Path2D();
  box.rect(left, top, right - left, bottom - top);
  stroke(viewer, pen, box, colour);
}

function stroke({ ratio }, pen, path, colour) {
  for (const [thickness, style] of [[3.5, 'rgba(0,0,0,.6)'], [1.5, colour]]) {
    Object.assign(pen, { lineWidth: thickness * ratio, strokeStyle: style });
    pen.stroke(path);
  }
}

function drawNumbers(viewer, pen, pane) {
  const [left, top] = toImage(viewer, pane, pane.x, pane.y).map(Math.floor);
  const [right, bottom] = toImage(viewer, pane, pane.x + pane.width, pane.y + pane.height).map(Math.ceil);
  const { width, height } = viewer.frames[0];
  const numbers = numbersOf(viewer, pane.view);
  pen.textAlign = 'center';
  for (let y = Math.max(0, top); y < Math.min(height, bottom); y++) {
    for (let x = Math.max(0, left); x < Math.min(width, right); x++) {
      drawNumber(viewer, pen, toStage(viewer, pane, x + 0.5, y + 0.5), numbers(y * width + x));
    }
  }
}

/** What stands in a pixel of a view: three channels, or one error. */
function numbersOf({ layers, frames, state }, view) {
  const frame = frames[view.frame];
  if (!view.isError) return pixel => pixelOf(frame, pixel);
  const { errors, channels } = layers.errorsOf(frame, state);
  return pixel => Array.from(errors.subarray(channels * pixel, channels * (pixel + 1)));
}

function drawNumber({ ratio }, pen, [x, y], numbers) {
  const line = 13 * ratio;
  pen.font = `${11 * ratio}px ui-monospace, monospace`;
  numbers.forEach((number, index) => {
    const below = y + (index - (numbers.length - 1) / 2) * line + 4 * ratio;
    pen.lineWidth = 3 * ratio;
    pen.strokeStyle = 'rgba(0,0,0,.75)';
    pen.strokeText(figure(number), x, below);
    pen.fillStyle = numbers.length === 1 ? '#fff' : ['#ff9d8a', '#a5e59b', '#9cc4ff'][index];
    pen.fillText(figure(number), x, below);
  });
}

/** The name of a view above its pane, and what its colours mean. */
function drawLabel(viewer, pen, pane) {
  const { ratio, state, views, frames } = viewer;
  const [size, baseline] = [13 * ratio, pane.y - 7 * ratio];
  pen.fillStyle = viewer.ink;
  const own = labelOf(frames, pane.view);
  const name = state.layout === 'wipe' ? `${labelOf(frames, views[state.under])} | ${own}` : own;
  const legend = legendOf(viewer, pane.view);
  const room = legend ? drawLegend(viewer, pen, pane, legend) - pane.x : pane.width;
  pen.font = `600 ${size}px system-ui, sans-serif`;
  pen.textAlign = 'left';
  pen.fillText(shortened(pen, name, room - 8 * ratio), pane.x, baseline);
}

/** As much of a text as there is room for. */
function shortened(pen, text, room) {
  if (pen.measureText(text).width <= room) return text;
  const letters = [...text];
  while (letters.length > 1 && pen.measureText(`${letters.join('')}…`).width > room) letters.pop();
  return `${letters.join('')}…`;
}

/** The two ends of a scale, and its colours. */
function legendOf({ layers, frames, state }, view) {
  const frame = frames[view.frame];
  if (view.isError) {
    const metric = METRICS[state.metric];
    const { limit, channels } = layers.errorsOf(frame, state);
    const end = metric.unit === '%' ? `${figure(100 * limit)} %` : figure(limit);
    const stops = channels === 3 ? [0x000000, 0x7f7f7f, 0xffffff] : metric.signed ? SIGNED : MAGNITUDE;
    return { low: metric.signed ? `−${end}` : '0', high: metric.signed ? `+${end}` : end, stops };
  }
  if (frame.kind === 'signed') return { low: '−', high: '+', stops: SIGNED };
  if (frame.kind === 'magnitude') return { low: '0', high: '1', stops: MAGNITUDE };
  const [low, high] = FALSE_STOPS.map(stops => figure(2 ** (stops - state.stops)));
  return state.tone === FALSE_COLOUR ? { low, high, stops: MAGNITUDE } : null;
}

/** Draws it at the right, and says where it begins. */
function drawLegend({ ratio, ink }, pen, pane, { low, high, stops }) {
  const [width, height, top] = [70 * ratio, 9 * ratio, pane.y - 16 * ratio];
  pen.font = `${11 * ratio}px system-ui, sans-serif`;
  pen.textAlign = 'right';
  pen.fillStyle = ink;
  const right = pane.x + pane.width;
  pen.fillText(high, right, pane.y - 8 * ratio);
  const left = right - pen.measureText(high).width - 5 * ratio - width;
  pen.fillText(low, left - 5 * ratio, pane.y - 8 * ratio);
  for (let at = 0; at < width; at++) {
    pen.fillStyle = `rgb(${scaleColour(stops, at / width)})`;
    pen.fillRect(left + at, top, 1, height);
  }
  pen.fillStyle = ink;
  return left - 5 * ratio - pen.measureText(low).width;
}

/** A number for people: four digits. */
function figure(value) {
  if (!Number.isFinite(value)) return Number.isNaN(value) ? 'NaN' : value > 0 ? 'Inf' : '−Inf';
  const size = Math.abs(value);
  const text = size && (size < 1e-3 || size >= 1e5) ? value.toExponential(2) : String(Number(value.toPrecision(4)));
  return text.replace('-', '−');
}
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
// The controls above the stage, and how they follow the state.

/** Builds the controls of a viewer; the answer makes them show its state. */
function controls(viewer, changed) {
  const doing = action => () => { action(viewer); changed(); };
  const button = (label, action, properties = {}) =>
    make('button', { type: 'button', ...properties, onclick: doing(action) }, ...[label].flat());
  const chooser = (label, options, name, then = () => {}) => make('select', {
    title: label,
    ariaLabel: label,
    onchange: event => { viewer.state[name] = event.target.value; then(); changed(); },
  }, ...options.map(option => make('option', { value: option }, option)));

  const images = viewer.views.map((view, index) =>
    button([make('kbd', {}, String(index + 1)), ` ${labelOf(viewer.whole, view)}`], () => choose(viewer, index)));
  const layouts = Object.entries(LAYOUTS).map(([layout, label]) =>
    button(label, () => { viewer.state.layout = layout; }, { title: { all: 'g', wipe: 'w' }[layout] || '' }));
  const tone = chooser('tone curve (t)', TONES, 'tone');
  const channel = chooser('channel ([ and ])', CHANNELS, 'channel');
  const metric = chooser('error metric (m)', viewer.metrics, 'metric', () => { viewer.state.limit = 0; });
  const stops = slider('exposure (e, E)', -12, 12, 0.1, value => { viewer.state.stops = value; changed(); });
  const limit = slider('end of the error scale', -12, 6, 0.25, value => { viewer.state.limit = 2 ** value; changed(); });
  const cells = chooser('outlines of rejected cells (p)', [...viewer.scales, NO_CELLS], 'cells');
  const part = chooser('part of the image (b)', viewer.partNames, 'part');
  const bars = button('histogram', KEYS.i[1], { title: 'i' });
  const enlarge = button('enlarge region', KEYS.x[1], { title: 'x' });
  const key = name => button(name, KEYS[name][1], { title: KEYS[name][0], ariaLabel: KEYS[name][0] });
  const hasErrors = viewer.views.some(view => view.isError);

  const rows = [
    [...images, make('span', { className: 'gap' }), ...layouts],
    [...(viewer.partNames.length > 1 ? [part] : []), stops.label, tone, channel, ...(hasErrors ? [metric, limit.label] : []),
      ...(viewer.scales.length ? [cells] : []), bars, enlarge, key('-'), button('fit', KEYS.f[1], { title: 'f' }), key('+'),
      button('reset', KEYS.r[1], { title: 'r' }), button('PNG', KEYS.s[1], { title: 'save as PNG (s)' }), key('?')],
  ];
  viewer.root.prepend(...rows.map(row => make('div', { className: 'tools' }, ...row)));

  return () => {
    const { state } = viewer;
    images.forEach((one, index) => press(one, state.layout !== 'all' && index === state.show));
    layouts.forEach((one, index) => press(one, Object.keys(LAYOUTS)[index] === state.layout));
    Object.assign(tone, { value: state.tone });
    Object.assign(channel, { value: state.channel });
    Object.assign(metric, { value: state.metric });
    Object.assign(cells, { value: state.cells });
    Object.assign(part, { value: state.part });
    enlarge.disabled = !state.region && !state.insets.length;
    enlarge.textContent = state.region || !state.insets.length ? 'enlarge region' : 'drop insets';
    stops.show(state.stops, `${state.stops < 0 ? '−' : '+'}${Math.abs(state.stops).toFixed(1)} EV`);
    limit.show(Math.log2(state.limit || 1), state.limit ? figure(state.limit) : 'auto');
    press(bars, state.histogram);
  };
}

/** A slider with its value beside it. */
function slider(title, min, max, step, changed) {
  const input = make('input', { type: 'range', min, max, step, ariaLabel: title });
  input.addEventListener('input', () => changed(Number(input.value)));
  const output = make('output');
  const show = (value, words) => { input.value = value; output.textContent = words; };
  return { label: make('label', { title }, input, output), show };
}

/** The list of keys. */
function help() {
  const rows = Object.entries(KEYS).map(([key, [words]]) =>
    make('li', {}, make('kbd', {}, key === ' ' ? 'space' : key.replace('Arrow', '')), ` ${words}`));
  const first = [['1 … 9', 'choose an image'], ['Shift+1 … 9', 'choose the reference'],
    ['Shift+drag', 'means of a region, and what x enlarges'], ['wheel', 'zoom, once the viewer has the focus; always with Ctrl']];
  const more = first.map(([key, words]) => make('li', {}, make('kbd', {}, key), ` ${words}`));
  return make('ul', { className: 'keys', hidden: true }, ...more, ...rows);
}
// The pointer over the stage: values below it, panning, zooming, the wipe, and regions.

function followPointer(viewer, changed, moved) {
  const { canvas, state, root } = viewer;
  let drag = null;

  const at = event => {
    const box = canvas.getBoundingClientRect();
    return [(event.clientX - box.left) * viewer.ratio, (event.clientY - box.top) * viewer.ratio];
  };
  const pixel = (pane, x, y) => {
    const [column, row] = toImage(viewer, pane, x, y).map(Math.floor);
    const { width, height } = viewer.frames[0];
    return column >= 0 && row >= 0 && column < width && row < height ? [column, row] : null;
  };

  canvas.addEventListener('pointerdown', event => {
    const [x, y] = at(event);
    const pane = paneAt(viewer.stage, x, y);
    if (!pane) return;
    root.focus({ preventScroll: true });
    canvas.setPointerCapture(event.pointerId);
    drag = dragFrom(viewer, event, pane, x, y);
  });
  canvas.addEventListener('pointermove', event => {
    const [x, y] = at(event);
    const pane = drag ? drag.pane : paneAt(viewer.stage, x, y);
    viewer.pointer = pane ? pixel(pane, x, y) : null;
    if (drag) drag.to(x, y);
    moved();
  });
  canvas.addEventListener('pointerup', event => {
    const [x, y] = at(event);
    if (drag && !drag.moved(x, y)) flip(viewer, drag.pane);
    drag = null;
    changed();
  });
  canvas.addEventListener('pointerleave', () => { viewer.pointer = null; moved(); });
  canvas.addEventListener('dblclick', () => { state.zoom = 0; changed(); });
  canvas.addEventListener('wheel', event => {
    const [x, y] = at(event);
    const pane = paneAt(viewer.stage, x, y);
    // Only once the viewer has the focus: a page that is scrolled past must not catch the wheel.
    if (!pane || !(event.ctrlKey || root.contains(document.activeElement))) return;
    event.preventDefault();
    zoomBy(viewer, Math.exp(-event.deltaY * 0.0018), pane, x, y);
    changed();
  }, { passive: false });
}

/** What dragging does from here on: it draws a region, moves the wipe, or moves the image. */
function dragFrom(viewer, event, pane, x, y) {
  const { state } = viewer;
  const moved = (toX, toY) => Math.hypot(toX - x, toY - y) > 3 * viewer.ratio;
  if (event.shiftKey) return { pane, moved, to: (toX, toY) => { state.region = regionOf(viewer, pane, [x, y], [toX, toY]); } };
  const handle = pane.x + state.wipe * pane.width;
  if (state.layout === 'wipe' && Math.abs(x - handle) < 16 * viewer.ratio) {
    return { pane, moved: () => true, to: toX => { state.wipe = clip((toX - pane.x) / pane.width); } };
  }
  const start = cameraOf(viewer);
  const to = (toX, toY) => {
    if (!moved(toX, toY)) return;
    const zoom = start.zoom / viewer.ratio;
    Object.assign(state, { zoom, x: start.x - (toX - x) / start.zoom, y: start.y - (toY - y) / start.zoom });
  };
  return { pane, moved, to };
}

/** Column, row, width and height between two places on the stage. */
function regionOf(viewer, pane, from, to) {
  const { width, height } = viewer.frames[0];
  const corners = [from, to].map(([x, y]) => toImage(viewer, pane, x, y));
  const [low, high] = [Math.min, Math.max].map(pick => [0, 1].map(axis => pick(corners[0][axis], corners[1][axis])));
  const left = Math.max(0, Math.floor(low[0])), top = Math.max(0, Math.floor(low[1]));
  const right = Math.min(width, Math.ceil(high[0])), bottom = Math.min(height, Math.ceil(high[1]));
  return right > left && bottom > top ? [left, top, right - left, bottom - top] : null;
}

/** A click shows an image alone, and flips back. */
function flip(viewer, pane) {
  const index = viewer.views.indexOf(pane.view);
  choose(viewer, viewer.state.layout === 'all' ? index : viewer.state.under);
}
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
