//! Where an image goes: the format is that of the file's name.

use super::passes::{Rendered, Source};
use crate::image::encoding::{Curve, Encoding};
use crate::image::exr::{self, Exr, Storage};
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

/// A file to be.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Output {
    pub(super) path: PathBuf,
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
    pub(super) fn check(&self) -> Result<(), String> {
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
    pub(super) fn holds_errors(&self) -> bool {
        self.format == Format::Exr
    }

    /// Writes an image, and in EXR its standard errors and where it is from.
    pub(super) fn write(
        &self,
        rendered: &Rendered,
        made: &[(&str, String)],
    ) -> Result<(), ImageError> {
        let Self { path, format } = self;
        match format {
            Format::Exr => exr::write(path, &with_all(rendered, made)),
            Format::Pfm => pfm::write(path, &rendered.image),
            Format::Hdr => hdr::write(path, &rendered.image),
            Format::Png => png::write(path, &Encoding::of(Curve::Srgb).picture(&rendered.image)),
        }
    }

    /// Whether it is an image of 8 bits.
    pub(super) fn is_png(&self) -> bool {
        self.format == Format::Png
    }
}

fn with_all(rendered: &Rendered, made: &[(&str, String)]) -> Exr {
    let mut file = Exr::from_image(&rendered.image);
    if let Some((errors, _)) = &rendered.standard_error {
        file = file.with_colours(ERROR_PREFIX, errors, Storage::Single);
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
