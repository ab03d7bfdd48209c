//! PNG, 8 bits a channel: for people to look at. Rounding and clipping cannot be undone.

use super::ImageError;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};
use std::path::Path;

/// An image as a screen shows it: sRGB, row-major from the top left.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Picture {
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) pixels: Vec<[u8; 3]>,
}

/// The bytes of a PNG file.
pub(crate) fn encode(picture: &Picture) -> Result<Vec<u8>, image::ImageError> {
    let side = |length: usize| {
        u32::try_from(length).map_err(|_| {
            let kind = image::error::ParameterErrorKind::DimensionMismatch;
            image::ImageError::Parameter(image::error::ParameterError::from_kind(kind))
        })
    };
    let mut bytes = Vec::new();
    // Filters predict a pixel from its neighbours. Noise and false colour defeat that: both are
    // smaller without.
    let (compression, filter) = (CompressionType::Default, FilterType::NoFilter);
    PngEncoder::new_with_quality(&mut bytes, compression, filter).write_image(
        picture.pixels.as_flattened(),
        side(picture.width)?,
        side(picture.height)?,
        ExtendedColorType::Rgb8,
    )?;
    Ok(bytes)
}

/// Writes a file.
pub(crate) fn write(path: &Path, picture: &Picture) -> Result<(), ImageError> {
    let bytes = encode(picture).map_err(|error| ImageError::unwritable(path, error))?;
    crate::disk::replace(path, &bytes).map_err(|error| ImageError::unwritable(path, error))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_what_any_reader_sees() {
        let pixels = (0..12u8).map(|i| [i, 10 * i, 255 - i]).collect::<Vec<_>>();
        let picture = Picture { width: 4, height: 3, pixels };
        let read = image::load_from_memory(&encode(&picture).unwrap()).unwrap().to_rgb8();
        assert_eq!(read.dimensions(), (4, 3));
        assert_eq!(read.get_pixel(1, 2).0, picture.pixels[2 * 4 + 1]);
    }
}
