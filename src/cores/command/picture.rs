//! The picture that a program has written, as linear radiance from the top left.

use super::adapter::{FirstRow, Output};
use crate::image::encoding::Encoding;
use crate::image::png::Picture as Codes;
use crate::image::{Image, ImageError, exr, file, pfm, png};
use std::path::Path;

/// A picture, and which pixels say only that they are bright.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Linear.
    pub image: Image,
    /// Codes of 255 stand for anything from there up.
    pub clipped: Vec<bool>,
    /// The codes themselves, if the file holds no more.
    pub codes: Option<Codes>,
}

impl Picture {
    /// One that holds radiance as it is.
    pub fn linear(image: Image) -> Self {
        let clipped = vec![false; image.pixels.len()];
        Self { image, clipped, codes: None }
    }
}

/// Reads what `output` declares from `folder`.
///
/// # Errors
/// If it is no such picture.
pub fn read(output: &Output, folder: &Path) -> Result<Picture, ImageError> {
    let path = folder.join(&output.file);
    let ending = path.extension().unwrap_or_default();
    let mut picture = if ending == "exr" {
        Picture::linear(exr::read_image(&path)?)
    } else if ending == "pfm" {
        Picture::linear(pfm::read(&path)?)
    } else {
        match output.encoding.of_codes() {
            None => Picture::linear(file::load(&path, None)?.image),
            Some(encoding) => decoded(png::read(&path)?.picture(), encoding),
        }
    };
    if output.first_row == FirstRow::Bottom {
        turn_over(&mut picture);
    }
    Ok(picture)
}

fn decoded(codes: Codes, encoding: Encoding) -> Picture {
    let &Codes { width, height, .. } = &codes;
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
        let codes = Codes { width: 1, height: 2, pixels: vec![[10, 20, 30], [255, 0, 0]] };
        png::write(&folder.path().join("p.png"), &codes).unwrap();
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
