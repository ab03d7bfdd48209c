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
