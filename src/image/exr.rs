//! OpenEXR: the colours of an image, any other channels beside them, and text about where it came
//! from.
//!
//! Values survive the way to disk and back bit for bit, NaN and infinity included, unless a channel
//! asks for half precision. Files are read whatever their compression and written with ZIP, which
//! every viewer reads.

use super::{Image, ImageError};
use crate::disk;
use ::exr::prelude as openexr;
use ::exr::prelude::{ReadChannels, ReadLayers, WritableImage};
use half::f16;
use std::collections::BTreeMap;
use std::io::Cursor;
use std::path::Path;

/// The channels of a colour, in the order of a pixel.
const COLOURS: [&str; 3] = ["R", "G", "B"];

/// How the values of a channel are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Storage {
    /// 11 bits of precision between 6e-8 and 65504: enough for standard errors.
    Half,
    /// All 24 bits.
    Single,
}

/// One value for each pixel.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Channel {
    /// Such as `R`, or `se.R`.
    pub name: String,
    /// Row-major from the top left.
    pub values: Vec<f32>,
    pub storage: Storage,
}

/// What is in an OpenEXR file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Exr {
    pub(crate) width: usize,
    pub(crate) height: usize,
    /// In the order of the file: by name.
    pub(crate) channels: Vec<Channel>,
    /// Text attributes by name. Other attributes are not kept.
    pub(crate) attributes: BTreeMap<String, String>,
}

impl Exr {
    /// A file of the colours of `image` in single precision.
    pub fn from_image(image: &Image) -> Self {
        let file = Self { width: image.width, height: image.height, ..Self::default() };
        file.with_colours("", image, Storage::Single)
    }

    /// The same with three channels more: `prefix` and then R, G and B.
    pub fn with_colours(mut self, prefix: &str, image: &Image, storage: Storage) -> Self {
        for (i, colour) in COLOURS.into_iter().enumerate() {
            let values = image.pixels.iter().map(|pixel| pixel[i]).collect();
            self.channels.push(Channel { name: format!("{prefix}{colour}"), values, storage });
        }
        self
    }

    pub(crate) fn with_attribute(mut self, name: &str, text: impl Into<String>) -> Self {
        self.attributes.insert(name.to_owned(), text.into());
        self
    }

    /// The image in R, G and B.
    pub(crate) fn image(&self) -> Result<Image, ImageError> {
        self.colours("")
    }

    /// The image in the channels `prefix` R, G and B.
    pub(crate) fn colours(&self, prefix: &str) -> Result<Image, ImageError> {
        let [red, green, blue] = COLOURS.map(|colour| self.whole(&format!("{prefix}{colour}")));
        let colours = red?.iter().zip(green?).zip(blue?);
        let pixels = colours.map(|((red, green), blue)| [*red, *green, *blue]).collect();
        Ok(Image { width: self.width, height: self.height, pixels })
    }

    /// What its other images are called: `bounce.2` has the channels `bounce.2.R` and so on. Short names first, so that
    /// numbers are in order.
    pub(crate) fn layers(&self) -> Vec<&str> {
        let names = self.channels.iter().filter_map(|channel| channel.name.strip_suffix(".R"));
        let mut names: Vec<_> = names.collect();
        names.sort_by_key(|name| name.len());
        names
    }

    /// The values of a channel that has one for each pixel: a file may have fewer.
    fn whole(&self, name: &str) -> Result<&[f32], ImageError> {
        let values = &self.channel(name)?.values;
        let (count, pixels) = (values.len(), self.width * self.height);
        match count == pixels {
            true => Ok(values),
            false => {
                Err(ImageError::WrongLength { channel: name.to_owned(), values: count, pixels })
            }
        }
    }

    pub(crate) fn channel(&self, name: &str) -> Result<&Channel, ImageError> {
        self.channels.iter().find(|channel| channel.name == name).ok_or_else(|| {
            ImageError::NoChannel {
                channel: name.to_owned(),
                found: self.channels.iter().map(|channel| channel.name.clone()).collect(),
            }
        })
    }
}

/// How many times its own size a file may unfold to: even an image of one colour is packed less.
const UNFOLDS: u128 = 1 << 16;

/// That a file can hold what it announces: memory is asked for before the first pixel is read.
fn check_size(path: &Path) -> Result<(), ImageError> {
    let unreadable = |error: &dyn std::fmt::Display| ImageError::unreadable(path, error);
    let length = std::fs::metadata(path).map_err(|error| unreadable(&error))?.len();
    let meta = ::exr::meta::MetaData::read_from_file(path, false);
    let meta = meta.map_err(|error| unreadable(&in_words(error)))?;
    let announced = |header: &::exr::meta::header::Header| {
        let [width, height] = [header.layer_size.width(), header.layer_size.height()];
        width as u128 * height as u128 * header.channels.bytes_per_pixel as u128
    };
    let announced: u128 = meta.headers.iter().map(announced).sum();
    if announced > UNFOLDS * u128::from(length) {
        return Err(unreadable(&format!("{announced} bytes of pixels in a file of {length}")));
    }
    Ok(())
}

/// What the library calls a reference to missing bytes is a file that was cut off.
fn in_words(error: ::exr::error::Error) -> String {
    match error {
        ::exr::error::Error::Invalid(what) if what.contains("missing bytes") => {
            "the file ends too early; was it written to its end?".to_owned()
        }
        other => other.to_string(),
    }
}

/// Reads the first layer of a file.
pub fn read(path: &Path) -> Result<Exr, ImageError> {
    check_size(path)?;
    let reader = openexr::read().no_deep_data().largest_resolution_level().all_channels();
    let file = reader
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_file(path)
        .map_err(|error| ImageError::unreadable(path, in_words(error)))?;
    let layer = file.layer_data;
    let text = |(name, value): (&openexr::Text, &openexr::AttributeValue)| match value {
        openexr::AttributeValue::Text(text) => Some((decoded(name), decoded(text))),
        _ => None,
    };
    let attributes = file.attributes.other.iter().chain(&layer.attributes.other);
    let channels = layer.channel_data.list.into_iter().map(|channel| Channel {
        name: decoded(&channel.name),
        storage: match channel.sample_data {
            openexr::FlatSamples::F16(_) => Storage::Half,
            _ => Storage::Single,
        },
        values: match channel.sample_data {
            openexr::FlatSamples::F32(values) => values,
            others => others.values_as_f32().collect(),
        },
    });
    Ok(Exr {
        width: layer.size.width(),
        height: layer.size.height(),
        channels: channels.collect(),
        attributes: attributes.filter_map(text).collect(),
    })
}

/// Reads the colours of a file.
pub fn read_image(path: &Path) -> Result<Image, ImageError> {
    read(path)?.image()
}

/// Writes a file.
pub fn write(path: &Path, file: &Exr) -> Result<(), ImageError> {
    disk::replace(path, &encode(path, file)?).map_err(|error| ImageError::unwritable(path, error))
}

/// The bytes of a file that is to stand at `path`.
pub(crate) fn encode(path: &Path, file: &Exr) -> Result<Vec<u8>, ImageError> {
    let pixels = file.width * file.height;
    if let Some(wrong) = file.channels.iter().find(|channel| channel.values.len() != pixels) {
        let (channel, values) = (wrong.name.clone(), wrong.values.len());
        return Err(ImageError::WrongLength { channel, values, pixels });
    }
    let channels = file.channels.iter().map(encode_channel).collect();
    let mut attributes = openexr::LayerAttributes::default();
    let texts = file.attributes.iter();
    attributes.other.extend(
        texts.map(|(name, text)| (encoded(name), openexr::AttributeValue::Text(encoded(text)))),
    );
    let layer = openexr::Layer::new(
        (file.width, file.height),
        attributes,
        openexr::Encoding::SMALL_LOSSLESS,
        openexr::AnyChannels::sort(channels),
    );
    let image = openexr::Image::from_layer(layer);
    let mut bytes = Cursor::new(Vec::new());
    let written = image.write().non_parallel().to_buffered(&mut bytes);
    written.map_err(|error| ImageError::unwritable(path, error))?;
    Ok(bytes.into_inner())
}

/// Writes the colours of an image.
pub fn write_image(path: &Path, image: &Image) -> Result<(), ImageError> {
    write(path, &Exr::from_image(image))
}

fn encode_channel(channel: &Channel) -> openexr::AnyChannel<openexr::FlatSamples> {
    let values = &channel.values;
    let samples = match channel.storage {
        Storage::Half => {
            openexr::FlatSamples::F16(values.iter().copied().map(f16::from_f32).collect())
        }
        Storage::Single => openexr::FlatSamples::F32(values.clone()),
    };
    openexr::AnyChannel::new(encoded(&channel.name), samples)
}

/// OpenEXR text is bytes; viewers read them as UTF-8.
fn encoded(text: &str) -> openexr::Text {
    openexr::Text::from_slice_unchecked(text.as_bytes())
}

fn decoded(text: &openexr::Text) -> String {
    String::from_utf8_lossy(text.as_slice()).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture() -> Image {
        let mut image = Image::from_fn(5, 3, |x, y| [x as f32 * 0.1, y as f32, 1e-30]);
        image.pixels[7] = [f32::NAN, f32::INFINITY, -0.25];
        image
    }

    fn bits(image: &Image) -> Vec<[u32; 3]> {
        image.pixels.iter().map(|pixel| pixel.map(f32::to_bits)).collect()
    }

    #[test]
    fn a_picture_comes_back_bit_for_bit_the_right_way_up() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("picture.exr");
        write_image(&path, &picture()).unwrap();
        let back = read_image(&path).unwrap();
        assert_eq!((back.width, back.height), (5, 3));
        assert_eq!(bits(&back), bits(&picture()));
    }

    #[test]
    fn channels_beside_the_colours_and_text_come_back() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("mean.exr");
        let errors = Image::new(5, 3, [0.5, 0.25, 0.125]);
        let file = Exr::from_image(&picture())
            .with_colours("se.", &errors, Storage::Half)
            .with_attribute("scene", "cornell-spheres, ρ = 0.5");
        write(&path, &file).unwrap();
        let back = read(&path).unwrap();
        assert_eq!(back.colours("se.").unwrap(), errors);
        assert_eq!(back.channel("se.R").unwrap().storage, Storage::Half);
        assert_eq!(back.channel("R").unwrap().storage, Storage::Single);
        assert_eq!(back.attributes["scene"], "cornell-spheres, ρ = 0.5");
    }

    #[test]
    fn a_missing_channel_is_named_with_those_there_are() {
        let file = Exr::from_image(&picture());
        let message = file.colours("se.").unwrap_err().to_string();
        assert_eq!(message, "the image has no channel `se.R`; its channels are R, G, B");
    }

    #[test]
    fn a_truncated_or_missing_file_is_an_error_that_names_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("half.exr");
        write_image(&path, &Image::new(64, 64, [0.1, 0.2, 0.3])).unwrap();
        let whole = std::fs::read(&path).unwrap();
        for length in [0, 10, 100, whole.len() / 2, whole.len() - 1] {
            std::fs::write(&path, &whole[..length]).unwrap();
            let message = read(&path).unwrap_err().to_string();
            assert!(message.contains("half.exr"), "{message}");
        }
        assert!(read(&folder.path().join("none.exr")).is_err());
    }

    #[test]
    fn a_channel_of_the_wrong_length_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let mut file = Exr::from_image(&picture());
        file.channels[1].values.pop();
        let refused = write(&folder.path().join("x.exr"), &file);
        assert!(matches!(refused, Err(ImageError::WrongLength { values: 14, .. })));
    }
}
