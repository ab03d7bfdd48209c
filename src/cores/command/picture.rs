//! The picture that a program has written, as linear radiance from the top left.

use super::adapter::{Encoding, FirstRow, Output};
use crate::image::{Image, ImageError, exr, pfm};
use std::path::Path;

/// A picture, and which pixels say only that they are bright.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Linear.
    pub image: Image,
    /// Codes of 255 stand for anything from there up.
    pub clipped: Vec<bool>,
}

/// Reads what `output` declares from `folder`.
///
/// # Errors
/// If it is no such picture.
pub fn read(output: &Output, folder: &Path) -> Result<Picture, ImageError> {
    let path = folder.join(&output.file);
    let ending = path.extension().unwrap_or_default();
    let mut picture = if ending == "exr" {
        linear(exr::read_image(&path)?)
    } else if ending == "pfm" {
        linear(pfm::read(&path)?)
    } else {
        let opened = image::open(&path).map_err(|error| ImageError::unreadable(&path, error))?;
        match output.encoding {
            Encoding::Linear => linear(from_floats(&opened.to_rgb32f())),
            encoding => decoded(&opened.to_rgb8(), encoding),
        }
    };
    if output.first_row == FirstRow::Bottom {
        turn_over(&mut picture);
    }
    Ok(picture)
}

fn linear(image: Image) -> Picture {
    let clipped = vec![false; image.pixels.len()];
    Picture { image, clipped }
}

fn from_floats(buffer: &image::Rgb32FImage) -> Image {
    let (width, height) = buffer.dimensions();
    let pixels = buffer.pixels().map(|pixel| pixel.0).collect();
    Image { width: width as usize, height: height as usize, pixels }
}

fn decoded(buffer: &image::RgbImage, encoding: Encoding) -> Picture {
    let (width, height) = buffer.dimensions();
    let pixels =
        buffer.pixels().map(|pixel| pixel.0.map(|code| radiance(code, encoding))).collect();
    Picture {
        image: Image { width: width as usize, height: height as usize, pixels },
        clipped: buffer.pixels().map(|pixel| pixel.0.contains(&255)).collect(),
    }
}

/// The radiance in the middle of what gives a code.
#[expect(clippy::cast_possible_truncation, reason = "pictures are single precision")]
pub fn radiance(code: u8, encoding: Encoding) -> f32 {
    let code = f64::from(code);
    let value = match encoding {
        Encoding::Linear => code / 255.0,
        Encoding::Srgb if code <= 10.0 => code / 255.0 / 12.92,
        Encoding::Srgb => ((code / 255.0 + 0.055) / 1.055).powf(2.4),
        Encoding::Course if code == 0.0 => 0.0,
        // Codes are cut off, not rounded.
        Encoding::Course => ((code + 0.5) / 255.0).powf(2.2) / std::f64::consts::SQRT_2,
    };
    value as f32
}

fn turn_over(picture: &mut Picture) {
    let width = picture.image.width.max(1);
    picture.image.pixels = picture.image.pixels.rchunks(width).flatten().copied().collect();
    picture.clipped = picture.clipped.rchunks(width).flatten().copied().collect();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_code_of_the_course_comes_back_as_itself() {
        for code in 1..=254u8 {
            let radiance = f64::from(radiance(code, Encoding::Course));
            let again = (255.0 * (2f64.sqrt() * radiance).powf(1.0 / 2.2)).floor();
            assert_eq!(again, f64::from(code));
        }
        assert_eq!(radiance(0, Encoding::Course), 0.0);
    }

    #[test]
    fn every_code_of_srgb_comes_back_as_itself() {
        for code in 0..=255u8 {
            let radiance = radiance(code, Encoding::Srgb);
            assert_eq!(crate::image::tonemap::srgb_code(radiance), code);
        }
    }

    #[test]
    fn a_png_says_where_it_is_clipped_and_can_stand_upside_down() {
        let folder = tempfile::tempdir().unwrap();
        let pixels = image::RgbImage::from_raw(1, 2, vec![10, 20, 30, 255, 0, 0]).unwrap();
        pixels.save(folder.path().join("p.png")).unwrap();
        let mut output = Output {
            file: "p.png".to_owned(),
            encoding: Encoding::Course,
            first_row: FirstRow::Top,
        };
        let upright = read(&output, folder.path()).unwrap();
        assert_eq!(upright.clipped, [false, true]);
        output.first_row = FirstRow::Bottom;
        let turned = read(&output, folder.path()).unwrap();
        assert_eq!(turned.clipped, [true, false]);
        assert_eq!(turned.image.pixels[1], upright.image.pixels[0]);
    }
}
