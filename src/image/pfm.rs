//! Portable float maps: three floats a pixel, or one for grey, after three lines of text. The rows
//! stand from the bottom up.

use super::{Image, ImageError};
use std::path::Path;

pub(crate) fn read(path: &Path) -> Result<Image, ImageError> {
    let bytes = std::fs::read(path).map_err(|error| ImageError::unreadable(path, error))?;
    decode(&bytes).map_err(|problem| ImageError::unreadable(path, problem))
}

/// Writes a file, least significant byte first.
pub(crate) fn write(path: &Path, image: &Image) -> Result<(), ImageError> {
    let mut bytes = format!("PF\n{} {}\n-1.0\n", image.width, image.height).into_bytes();
    for row in image.pixels.chunks(image.width.max(1)).rev() {
        bytes.extend(row.as_flattened().iter().flat_map(|value| value.to_le_bytes()));
    }
    crate::disk::replace(path, &bytes).map_err(|error| ImageError::unwritable(path, error))
}

fn decode(bytes: &[u8]) -> Result<Image, String> {
    let (header, values) = Header::read(bytes)?;
    let Header { channels, width, height, .. } = header;
    let pixels = width.checked_mul(height).ok_or("its size exceeds the address space")?;
    let wanted = pixels.checked_mul(4 * channels).ok_or("its size exceeds the address space")?;
    if values.len() != wanted {
        return Err(format!("{} bytes of pixels, expected {wanted}", values.len()));
    }
    let rows = values.chunks(4 * channels * width.max(1)).rev();
    let pixels = rows.flat_map(|row| row.chunks(4 * channels)).map(|pixel| header.colour(pixel));
    Ok(Image { width, height, pixels: pixels.collect() })
}

struct Header {
    channels: usize,
    width: usize,
    height: usize,
    little_endian: bool,
}

impl Header {
    /// The header, and the bytes after it.
    fn read(bytes: &[u8]) -> Result<(Self, &[u8]), String> {
        let (kind, rest) = word(bytes)?;
        let channels = match kind {
            "PF" => 3,
            "Pf" => 1,
            _ => return Err("not a portable float map".to_owned()),
        };
        let (width, rest) = number::<usize>(rest)?;
        let (height, rest) = number::<usize>(rest)?;
        let (scale, rest) = number::<f32>(rest)?;
        Ok((Self { channels, width, height, little_endian: scale < 0.0 }, rest))
    }

    fn colour(&self, bytes: &[u8]) -> [f32; 3] {
        let value = |channel: usize| {
            let four = std::array::from_fn(|i| bytes[4 * channel + i]);
            if self.little_endian { f32::from_le_bytes(four) } else { f32::from_be_bytes(four) }
        };
        std::array::from_fn(|i| value(i % self.channels))
    }
}

/// The next word of the header and what follows the one white space that ends it.
fn word(bytes: &[u8]) -> Result<(&str, &[u8]), String> {
    let cut_off = || "truncated header".to_owned();
    let start = bytes.iter().position(|byte| !byte.is_ascii_whitespace()).ok_or_else(cut_off)?;
    let bytes = &bytes[start..];
    let end = bytes.iter().position(u8::is_ascii_whitespace).ok_or_else(cut_off)?;
    let word = str::from_utf8(&bytes[..end]).map_err(|_| "its header is not text".to_owned())?;
    Ok((word, &bytes[end + 1..]))
}

fn number<T: std::str::FromStr>(bytes: &[u8]) -> Result<(T, &[u8]), String> {
    let (word, rest) = word(bytes)?;
    let number = word.parse().map_err(|_| format!("not a number in its header: `{word}`"))?;
    Ok((number, rest))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_comes_back_bit_for_bit_the_right_way_up() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("picture.pfm");
        let mut image = Image::from_fn(5, 3, |x, y| [x as f32 * 0.1, y as f32, -1e-30]);
        image.pixels[7] = [f32::INFINITY, 0.0, 1.0];
        write(&path, &image).unwrap();
        assert_eq!(read(&path).unwrap(), image);
    }

    #[test]
    fn grey_and_the_other_order_of_bytes_are_read() {
        let mut bytes = b"Pf\n1 2\n1.0\n".to_vec();
        bytes.extend([0.25f32, 0.5].iter().flat_map(|value| value.to_be_bytes()));
        assert_eq!(decode(&bytes).unwrap().pixels, [[0.5; 3], [0.25; 3]]);
    }

    #[test]
    fn what_is_cut_off_or_nonsense_is_refused() {
        for bytes in [&b"PF"[..], b"PF\n2 2\n-1\n1234", b"P6\n1 1\n255\nabc", b"PF\n2 x\n-1\n"] {
            assert!(decode(bytes).is_err(), "{}", String::from_utf8_lossy(bytes));
        }
        assert!(decode(format!("PF\n{} 9\n-1\n", usize::MAX).as_bytes()).is_err());
    }
}
