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
