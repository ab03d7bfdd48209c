//! PNG. Written with 8 bits a channel, for reports and never for comparison: rounding and clipping cannot be undone.

use super::ImageError;
use crate::disk;
use ::png::{BitDepth, ColorType, Compression, Decoder, Encoder, Filter, Transformations};
use std::io::Cursor;
use std::path::Path;

/// An image as a screen shows it: sRGB, row-major from the top left.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Picture {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// `width · height` colours.
    pub pixels: Vec<[u8; 3]>,
}

/// What a file holds, whichever of the kinds of PNG it is.
pub(crate) struct Decoded {
    pub width: usize,
    pub height: usize,
    /// Codes of 16 bits, row-major from the top left. Codes of 8 are widened without loss: 65,535 = 257 · 255.
    pub rgba: Vec<[u16; 4]>,
    /// Whether the file has 16 bits a channel.
    pub is_deep: bool,
    pub has_alpha: bool,
}

impl Decoded {
    /// The nearest codes of 8 bits, without alpha.
    pub fn picture(&self) -> Picture {
        #[expect(clippy::cast_possible_truncation, reason = "at most 255")]
        let narrow = |code: u16| ((u32::from(code) + 128) / 257) as u8;
        let pixels = self.rgba.iter().map(|&[r, g, b, _]| [r, g, b].map(narrow)).collect();
        Picture { width: self.width, height: self.height, pixels }
    }
}

/// More bytes of pixels than any image has.
const MOST_BYTES: usize = 1 << 29;

/// The image in a file's bytes; a palette is looked up, and so is what it says of transparency.
pub(super) fn decode(bytes: &[u8]) -> Result<Decoded, String> {
    let mut decoder = Decoder::new(Cursor::new(bytes));
    decoder.set_transformations(Transformations::EXPAND);
    let mut reader = decoder.read_info().map_err(|error| error.to_string())?;
    let size = reader.output_buffer_size().filter(|size| *size <= MOST_BYTES);
    let mut data = vec![0; size.ok_or("its size exceeds the address space")?];
    let frame = reader.next_frame(&mut data).map_err(|error| error.to_string())?;
    let samples = frame.color_type.samples();
    let is_deep = frame.bit_depth == BitDepth::Sixteen;
    let rgba = widened(&data, is_deep).chunks_exact(samples).map(spelt_out).collect();
    let [width, height] = [frame.width, frame.height].map(|side| side as usize);
    Ok(Decoded { width, height, rgba, is_deep, has_alpha: samples % 2 == 0 })
}

fn widened(data: &[u8], is_deep: bool) -> Vec<u16> {
    if is_deep {
        data.chunks_exact(2).map(|two| u16::from_be_bytes([two[0], two[1]])).collect()
    } else {
        data.iter().map(|code| 257 * u16::from(*code)).collect()
    }
}

fn spelt_out(samples: &[u16]) -> [u16; 4] {
    match *samples {
        [grey] => [grey, grey, grey, u16::MAX],
        [grey, alpha] => [grey, grey, grey, alpha],
        [red, green, blue] => [red, green, blue, u16::MAX],
        _ => std::array::from_fn(|channel| samples[channel]),
    }
}

/// Reads a file.
///
/// # Errors
/// If it is missing, damaged, or no PNG.
pub(crate) fn read(path: &Path) -> Result<Decoded, ImageError> {
    let bytes = std::fs::read(path).map_err(|error| ImageError::unreadable(path, error))?;
    decode(&bytes).map_err(|problem| ImageError::unreadable(path, problem))
}

/// The bytes of a PNG file.
///
/// # Errors
/// If a side is no positive number of 31 bits, or there are not as many pixels as the sides say.
pub fn encode(picture: &Picture) -> Result<Vec<u8>, ::png::EncodingError> {
    // One that does not fit is refused as no side at all is.
    let side = |length: usize| u32::try_from(length).unwrap_or(0);
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, side(picture.width), side(picture.height));
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Balanced);
    // Filters predict a pixel from its neighbours. Noise and false colour defeat that: both are
    // smaller without.
    encoder.set_filter(Filter::NoFilter);
    encoder.write_header()?.write_image_data(picture.pixels.as_flattened())?;
    Ok(bytes)
}

/// Writes a PNG file.
pub fn write(path: &Path, picture: &Picture) -> Result<(), ImageError> {
    let bytes = encode(picture).map_err(|error| ImageError::unwritable(path, error))?;
    disk::replace(path, &bytes).map_err(|error| ImageError::unwritable(path, error))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file of `samples` as they are.
    fn file(color: ColorType, depth: BitDepth, width: u32, samples: &[u8]) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = Encoder::new(&mut bytes, width, 1);
        encoder.set_color(color);
        encoder.set_depth(depth);
        if color == ColorType::Indexed {
            encoder.set_palette(vec![9, 8, 7, 6, 5, 4]);
            encoder.set_trns(vec![0]);
        }
        encoder.write_header().unwrap().write_image_data(samples).unwrap();
        bytes
    }

    #[test]
    fn what_is_written_is_read() {
        let pixels = (0..12u8).map(|i| [i, 10 * i, 255 - i]).collect::<Vec<_>>();
        let picture = Picture { width: 4, height: 3, pixels };
        let read = decode(&encode(&picture).unwrap()).unwrap();
        assert_eq!((read.is_deep, read.has_alpha), (false, false));
        assert_eq!(read.picture(), picture);
    }

    #[test]
    fn every_kind_is_read_as_colours_and_coverage() {
        let read = |color, depth, width, samples: &[u8]| {
            let decoded = decode(&file(color, depth, width, samples)).unwrap();
            (decoded.rgba, decoded.is_deep, decoded.has_alpha)
        };
        let grey = read(ColorType::Grayscale, BitDepth::One, 2, &[0b1000_0000]);
        let [white, black] = [[u16::MAX; 4], [0, 0, 0, u16::MAX]];
        assert_eq!(grey, (vec![white, black], false, false));
        let deep = read(ColorType::GrayscaleAlpha, BitDepth::Sixteen, 1, &[1, 2, 3, 4]);
        assert_eq!(deep, (vec![[0x102, 0x102, 0x102, 0x304]], true, true));
        let colours = read(ColorType::Rgba, BitDepth::Eight, 1, &[1, 2, 3, 4]);
        assert_eq!(colours, (vec![[257, 514, 771, 1028]], false, true));
        let palette = read(ColorType::Indexed, BitDepth::Eight, 2, &[0, 1]);
        let expected = vec![[9 * 257, 8 * 257, 7 * 257, 0], [6 * 257, 5 * 257, 4 * 257, u16::MAX]];
        assert_eq!(palette, (expected, false, true));
    }

    #[test]
    fn sixteen_bits_are_rounded_to_eight() {
        let samples = [0, 128, 0, 129, 255, 255];
        let deep = decode(&file(ColorType::Rgb, BitDepth::Sixteen, 1, &samples)).unwrap();
        assert_eq!(deep.picture().pixels, [[0, 1, 255]]);
    }

    #[test]
    fn what_is_cut_off_or_of_no_size_is_refused() {
        let picture = Picture { width: 1, height: 1, pixels: vec![[7; 3]] };
        let bytes = encode(&picture).unwrap();
        assert!(decode(&bytes[..bytes.len() / 2]).is_err());
        assert!(encode(&Picture { width: 0, ..picture.clone() }).is_err());
        assert!(encode(&Picture { width: 2, ..picture }).is_err());
    }
}
