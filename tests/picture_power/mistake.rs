//! What is done to pictures, and what the message has to say.

use furnace::image::Image;

/// What is done to a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mistake {
    None,
    OnePercent,
    Columns,
    DeadPixels,
    HalfPixel,
    GammaTwice,
    MissingBounce,
    Clamped,
}

impl Mistake {
    pub const ALL: [Self; 8] = [
        Self::None,
        Self::OnePercent,
        Self::Columns,
        Self::DeadPixels,
        Self::HalfPixel,
        Self::GammaTwice,
        Self::MissingBounce,
        Self::Clamped,
    ];

    pub const fn words(self) -> &'static str {
        match self {
            Self::None => "none: a right core",
            Self::OnePercent => "+1 % everywhere",
            Self::Columns => "+30 % in 16 columns",
            Self::DeadPixels => "20 dead pixels",
            Self::HalfPixel => "displaced by half a pixel",
            Self::GammaTwice => "gamma applied once too often",
            Self::MissingBounce => "the sixth bounce is missing",
            Self::Clamped => "samples clamped at 10, those of the light of 12 too",
        }
    }

    /// Whether the first cause of a failure, or else its message, names the mistake.
    pub fn is_named_by(self, cause: &str, statement: &str) -> bool {
        match self {
            Self::None => statement.contains("agrees with the reference"),
            Self::OnePercent => cause == "picture-factor",
            Self::Columns => cause == "picture-stripe" && statement.contains("columns 48 to 63"),
            Self::DeadPixels => statement.contains("pixels stay black in every run"),
            Self::HalfPixel => cause == "half-a-pixel-off",
            Self::GammaTwice => cause == "gamma-in-film",
            Self::MissingBounce => {
                cause == "bounce-missing" && statement.contains("bounce 6 is missing, ")
            }
            Self::Clamped => cause == "samples-clamped",
        }
    }

    /// Of a picture that was rendered for it.
    pub fn spoil(self, image: &mut Image) {
        let width = image.width;
        for (i, pixel) in image.pixels.iter_mut().enumerate() {
            let factor = match self {
                Self::OnePercent => 1.01,
                Self::Columns if (48..64).contains(&(i % width)) => 1.3,
                Self::DeadPixels if i % 613 == 100 => 0.0,
                _ => 1.0,
            };
            *pixel = pixel.map(|value| factor * value);
            if self == Self::GammaTwice {
                *pixel = pixel.map(|value| value.powf(1.0 / 2.2));
            }
        }
    }
}
