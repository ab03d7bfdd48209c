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
