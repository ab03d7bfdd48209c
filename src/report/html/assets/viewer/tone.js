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
