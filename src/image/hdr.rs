//! Radiance HDR: eight bits a channel and an exponent that the three share, for programs that read no OpenEXR.

use super::{Image, ImageError};
use image::Rgb;
use image::codecs::hdr::HdrEncoder;
use std::path::Path;

/// Writes a file. It holds no negative values and no NaN.
pub(crate) fn write(path: &Path, picture: &Image) -> Result<(), ImageError> {
    let pixels: Vec<_> = picture.pixels.iter().copied().map(Rgb).collect();
    let mut bytes = Vec::new();
    let encoded = HdrEncoder::new(&mut bytes).encode(&pixels, picture.width, picture.height);
    encoded.map_err(|error| ImageError::unwritable(path, error))?;
    crate::disk::replace(path, &bytes).map_err(|error| ImageError::unwritable(path, error))
}
