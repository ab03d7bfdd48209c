//! Image files of whatever kind: OpenEXR, PFM, Radiance HDR, PNG. What a file holds is told by
//! its first bytes, not by its name.

use super::encoding::Curve;
use super::pair::Plane;
use super::png::Picture;
use super::{Image, ImageError, exr, pfm};
use image::{DynamicImage, ImageReader};
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// The codes of a file of whole numbers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Codes {
    /// The largest: 255 or 65,535.
    pub(crate) largest: u32,
    /// The codes themselves, if there are 256.
    pub(crate) picture: Option<Picture>,
}

/// What a file holds.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Loaded {
    /// Linear light, if the numbers were encoded as was said.
    pub(crate) image: Image,
    /// Coverage, where the file has it.
    pub(crate) alpha: Option<Plane>,
    /// How the numbers were taken.
    pub(crate) encoding: Curve,
    pub(crate) codes: Option<Codes>,
    /// Other channels of an OpenEXR file, such as standard errors.
    pub(crate) extra: Option<exr::Exr>,
}

/// Reads a file. Numbers of PNG are taken as `encoding`, sRGB if none is said; all others are
/// linear.
pub(crate) fn load(path: &Path, encoding: Option<Curve>) -> Result<Loaded, ImageError> {
    match first_bytes(path)?.as_slice() {
        [0x76, 0x2f, 0x31, 0x01] => load_exr(path),
        [b'P', b'F' | b'f', ..] => Ok(linear(pfm::read(path)?)),
        _ => load_other(path, encoding.unwrap_or(Curve::Srgb)),
    }
}

fn first_bytes(path: &Path) -> Result<Vec<u8>, ImageError> {
    let mut start = Vec::new();
    let read = File::open(path).and_then(|file| file.take(4).read_to_end(&mut start));
    read.map_err(|error| ImageError::unreadable(path, error))?;
    Ok(start)
}

fn linear(image: Image) -> Loaded {
    Loaded { image, alpha: None, encoding: Curve::Linear, codes: None, extra: None }
}

fn load_exr(path: &Path) -> Result<Loaded, ImageError> {
    let file = exr::read(path)?;
    // Images of luminance alone have one channel, Y.
    let image = match (file.image(), file.channel("Y")) {
        (Err(_), Ok(grey)) => {
            let pixels = grey.values.iter().map(|value| [*value; 3]).collect();
            Image { width: file.width, height: file.height, pixels }
        }
        (image, _) => image?,
    };
    let plane =
        |values: &[f32]| Plane { width: file.width, height: file.height, values: values.to_vec() };
    let alpha = file.channel("A").ok().map(|channel| plane(&channel.values));
    Ok(Loaded { alpha, extra: Some(file), ..linear(image) })
}

fn load_other(path: &Path, encoding: Curve) -> Result<Loaded, ImageError> {
    let failed = |error: &dyn std::fmt::Display| ImageError::unreadable(path, error);
    let reader = ImageReader::open(path).map_err(|error| failed(&error))?;
    let reader = reader.with_guessed_format().map_err(|error| failed(&error))?;
    let decoded = reader.decode().map_err(|error| failed(&error))?;
    match decoded {
        DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_) => {
            let floats = decoded.to_rgb32f();
            let [width, height] = [floats.width(), floats.height()].map(|side| side as usize);
            let pixels = floats.pixels().map(|pixel| pixel.0).collect();
            Ok(linear(Image { width, height, pixels }))
        }
        codes => Ok(of_codes(&codes, encoding)),
    }
}

fn of_codes(decoded: &DynamicImage, encoding: Curve) -> Loaded {
    let largest = match decoded {
        DynamicImage::ImageLuma16(_)
        | DynamicImage::ImageLumaA16(_)
        | DynamicImage::ImageRgb16(_)
        | DynamicImage::ImageRgba16(_) => 65_535,
        _ => 255,
    };
    // Codes of 8 bits are widened without loss: 65,535 = 257 · 255.
    let wide = decoded.to_rgba16();
    let [width, height] = [wide.width(), wide.height()].map(|side| side as usize);
    #[expect(clippy::cast_possible_truncation, reason = "as precise as the picture")]
    let light = |code: u16| encoding.decode(f64::from(code) / 65_535.0) as f32;
    let colour = |pixel: &image::Rgba<u16>| [pixel.0[0], pixel.0[1], pixel.0[2]].map(light);
    let pixels = wide.pixels().map(colour).collect();
    let alpha = decoded.color().has_alpha().then(|| {
        let values = wide.pixels().map(|pixel| f32::from(pixel.0[3]) / 65_535.0).collect();
        Plane { width, height, values }
    });
    let picture = (largest == 255).then(|| {
        let pixels = decoded.to_rgb8().pixels().map(|pixel| pixel.0).collect();
        Picture { width, height, pixels }
    });
    let codes = Some(Codes { largest, picture });
    Loaded { image: Image { width, height, pixels }, alpha, encoding, codes, extra: None }
}

#[cfg(test)]
mod tests {
    use super::super::png;
    use super::*;

    #[test]
    fn every_kind_is_read_whatever_its_name() {
        let folder = tempfile::tempdir().unwrap();
        let image = Image::from_fn(6, 4, |x, y| [x as f32, y as f32, 0.25]);
        let path = folder.path().join("picture");
        exr::write_image(&path, &image).unwrap();
        assert_eq!(load(&path, None).unwrap().image, image);
        pfm::write(&path, &image).unwrap();
        assert_eq!(load(&path, Some(Curve::Srgb)).unwrap().image, image);
    }

    #[test]
    fn png_is_decoded_as_is_said() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("picture.png");
        let pixels = vec![[0, 128, 255]; 6];
        png::write(&path, &Picture { width: 3, height: 2, pixels }).unwrap();
        for (encoding, middle) in [
            (None, 0.215_860_5),
            (Some(Curve::Linear), 128.0 / 255.0),
            (Some(Curve::Gamma(2.0)), (128.0f32 / 255.0).powi(2)),
        ] {
            let loaded = load(&path, encoding).unwrap();
            let codes = loaded.codes.unwrap();
            assert_eq!((codes.largest, codes.picture.unwrap().pixels[5]), (255, [0, 128, 255]));
            let [black, grey, white] = loaded.image.pixels[5];
            assert!(black == 0.0 && (grey - middle).abs() < 1e-5 && white == 1.0, "{grey}");
        }
    }

    #[test]
    fn radiance_files_are_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("picture.hdr");
        let mut bytes = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n".to_vec();
        // 0.5, 0.25, 0 and four times that: a shared exponent, 128 being one.
        bytes.extend([128, 64, 0, 128, 128, 64, 0, 130]);
        std::fs::write(&path, bytes).unwrap();
        let loaded = load(&path, None).unwrap();
        let [dim, bright] = [loaded.image.pixels[0], loaded.image.pixels[1]];
        assert!((dim[0] - 0.5).abs() < 0.01 && (bright[1] / dim[1] - 4.0).abs() < 1e-5);
    }

    #[test]
    fn what_is_no_picture_is_refused_by_name() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("letter.txt");
        assert!(load(&path, None).unwrap_err().to_string().contains("letter.txt"));
        for text in ["", "PF\n2 2\n", "Dear reader"] {
            std::fs::write(&path, text).unwrap();
            assert!(load(&path, None).unwrap_err().to_string().contains("letter.txt"));
        }
    }
}
