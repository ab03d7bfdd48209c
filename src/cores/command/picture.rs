//! The picture that a program has written, as linear radiance from the top left.

use super::adapter::{FirstRow, Output};
use crate::image::encoding::Encoding;
use crate::image::png::Picture as Codes;
use crate::image::{Image, ImageError, exr, pfm};
use std::path::Path;

/// A picture, and which pixels say only that they are bright.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Picture {
    pub(crate) image: Image,
    /// Codes of 255 stand for anything from there up.
    pub(crate) clipped: Vec<bool>,
    /// The codes themselves, if the file holds no more.
    pub(crate) codes: Option<Codes>,
}

impl Picture {
    /// One that holds radiance as it is.
    pub(crate) fn linear(image: Image) -> Self {
        let clipped = vec![false; image.pixels.len()];
        Self { image, clipped, codes: None }
    }
}

/// Reads what `output` declares from `folder`.
///
/// # Errors
/// If it is no such picture.
pub(crate) fn read(output: &Output, folder: &Path) -> Result<Picture, ImageError> {
    let path = folder.join(&output.file);
    let ending = path.extension().unwrap_or_default();
    let mut picture = if ending == "exr" {
        Picture::linear(exr::read_image(&path)?)
    } else if ending == "pfm" {
        Picture::linear(pfm::read(&path)?)
    } else {
        let opened = image::open(&path).map_err(|error| ImageError::unreadable(&path, error))?;
        match output.encoding.of_codes() {
            None => Picture::linear(from_floats(&opened.to_rgb32f())),
            Some(encoding) => decoded(&opened.to_rgb8(), encoding),
        }
    };
    if output.first_row == FirstRow::Bottom {
        turn_over(&mut picture);
    }
    Ok(picture)
}

fn from_floats(buffer: &image::Rgb32FImage) -> Image {
    let (width, height) = buffer.dimensions();
    let pixels = buffer.pixels().map(|pixel| pixel.0).collect();
    Image { width: width as usize, height: height as usize, pixels }
}

fn decoded(buffer: &image::RgbImage, encoding: Encoding) -> Picture {
    let (width, height) = buffer.dimensions();
    let (width, height) = (width as usize, height as usize);
    let codes = Codes { width, height, pixels: buffer.pixels().map(|pixel| pixel.0).collect() };
    #[expect(clippy::cast_possible_truncation, reason = "pictures are single precision")]
    let light = |code: u8| encoding.light(code) as f32;
    let pixels = codes.pixels.iter().map(|pixel| pixel.map(light)).collect();
    Picture {
        image: Image { width, height, pixels },
        clipped: codes.pixels.iter().map(|pixel| pixel.contains(&255)).collect(),
        codes: Some(codes),
    }
}

fn turn_over(picture: &mut Picture) {
    let width = picture.image.width.max(1);
    picture.image.pixels = picture.image.pixels.rchunks(width).flatten().copied().collect();
    picture.clipped = picture.clipped.rchunks(width).flatten().copied().collect();
    if let Some(codes) = &mut picture.codes {
        codes.pixels = codes.pixels.rchunks(width).flatten().copied().collect();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_png_says_where_it_is_clipped_and_can_stand_upside_down() {
        let folder = tempfile::tempdir().unwrap();
        let pixels = image::RgbImage::from_raw(1, 2, vec![10, 20, 30, 255, 0, 0]).unwrap();
        pixels.save(folder.path().join("p.png")).unwrap();
        let mut output = Output {
            file: "p.png".to_owned(),
            encoding: crate::cores::command::adapter::Encoding::Course,
            first_row: FirstRow::Top,
        };
        let upright = read(&output, folder.path()).unwrap();
        assert_eq!(upright.clipped, [false, true]);
        output.first_row = FirstRow::Bottom;
        let turned = read(&output, folder.path()).unwrap();
        assert_eq!(turned.clipped, [true, false]);
        assert_eq!(turned.image.pixels[1], upright.image.pixels[0]);
        assert_eq!(turned.codes.unwrap().pixels, [[255, 0, 0], [10, 20, 30]]);
    }
}
