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
