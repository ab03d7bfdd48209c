//! Where an image goes: the format is that of the file's name.

use super::Shown;
use super::passes::{Rendered, Source};
use crate::image::encoding::Encoding;
use crate::image::exr::{self, Channel, Exr, Storage};
use crate::image::{ImageError, hdr, pfm, png};
use crate::scene::reference::ERROR_PREFIX;
use std::path::PathBuf;

/// How an image is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Exr,
    Pfm,
    Hdr,
    Png,
}

/// The names that a file may end in.
const FORMATS: [(&str, Format); 4] =
    [("exr", Format::Exr), ("pfm", Format::Pfm), ("hdr", Format::Hdr), ("png", Format::Png)];

/// The channel of an EXR file with the samples that each pixel took.
pub(crate) const SAMPLES: &str = "samples";

/// A file to be.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Output {
    pub(crate) path: PathBuf,
    format: Format,
}

impl std::str::FromStr for Output {
    type Err = String;

    fn from_str(word: &str) -> Result<Self, String> {
        let path = PathBuf::from(word);
        let ending = path.extension().unwrap_or_default().to_ascii_lowercase();
        let format = FORMATS.iter().find(|(name, _)| ending == *name).map(|(_, format)| *format);
        let format = format.ok_or("the name must end in .exr, .pfm, .hdr or .png")?;
        Ok(Self { path, format })
    }
}

impl Output {
    /// That there is a folder for it: known before anything is rendered.
    pub(crate) fn check(&self) -> Result<(), String> {
        let folder = self.path.parent().filter(|folder| !folder.as_os_str().is_empty());
        match folder.filter(|folder| !folder.is_dir()) {
            Some(folder) => {
                Err(format!("there is no folder `{}`; make it first", folder.display()))
            }
            None if self.path.is_dir() => {
                Err(format!("`{}` is a folder; name a file", self.path.display()))
            }
            None => Ok(()),
        }
    }

    /// Whether it holds the standard errors of the image too.
    pub(crate) fn holds_errors(&self) -> bool {
        self.format == Format::Exr
    }

    /// Writes an image, and in EXR its standard errors and where it is from.
    pub(crate) fn write(
        &self,
        shown: &Shown,
        mut made: Vec<(&'static str, String)>,
    ) -> Result<(), ImageError> {
        let rendered = match shown {
            Shown::Codes(codes) => return png::write(&self.path, codes),
            Shown::Radiance(rendered) => rendered,
        };
        let Self { path, format } = self;
        match format {
            Format::Exr => {
                let source = rendered.standard_error.as_ref().map(|(_, source)| source.to_string());
                made.push(("passes", rendered.passes.to_string()));
                made.push(("standard-errors-from", source.unwrap_or_else(|| "unknown".to_owned())));
                exr::write(path, &with_all(rendered, &made))
            }
            Format::Pfm => pfm::write(path, &rendered.image),
            Format::Hdr => hdr::write(path, &rendered.image),
            Format::Png => png::write(path, &Encoding::of(rendered.curve).picture(&rendered.image)),
        }
    }

    /// Whether it is an image of 8 bits.
    pub(crate) fn is_png(&self) -> bool {
        self.format == Format::Png
    }
}

fn with_all(rendered: &Rendered, made: &[(&str, String)]) -> Exr {
    let mut file = Exr::from_image(&rendered.image);
    if let Some((errors, _)) = &rendered.standard_error {
        file = file.with_colours(ERROR_PREFIX, errors, Storage::Single);
    }
    if let Some(samples) = &rendered.samples {
        let name = SAMPLES.to_owned();
        let storage = Storage::Single;
        file.channels.push(Channel { name, values: samples.clone(), storage });
    }
    made.iter().fold(file, |file, (name, words)| file.with_attribute(name, words.clone()))
}

impl std::fmt::Display for Source {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Spread => "the spread of the passes",
            Self::Core => "the core's own variances",
        })
    }
}
