//! Pictures that are mirrored, rotated or transposed.

use super::Misfit;
use super::question::Question;
use crate::image::Image;
use crate::text::spoken;
use serde::{Deserialize, Serialize};

spoken! {
    /// A way to lay a picture onto itself.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(rename_all = "kebab-case")]
    pub(crate) enum Symmetry {
        LeftRight = "mirrored left to right",
        UpsideDown = "upside down",
        HalfTurn = "turned by 180°",
        Transposed = "transposed",
        AntiTransposed = "transposed from the other corner",
        QuarterTurn = "turned by 90° clockwise",
        QuarterTurnBack = "turned by 90° counterclockwise",
    }
}

impl Symmetry {
    pub(crate) const ALL: [Self; 7] = [
        Self::LeftRight,
        Self::UpsideDown,
        Self::HalfTurn,
        Self::Transposed,
        Self::AntiTransposed,
        Self::QuarterTurn,
        Self::QuarterTurnBack,
    ];

    /// Whether rows become columns, which only square pictures survive.
    const fn exchanges_axes(self) -> bool {
        !matches!(self, Self::LeftRight | Self::UpsideDown | Self::HalfTurn)
    }

    /// The picture laid so.
    pub(crate) fn of(self, image: &Image) -> Image {
        let (width, height) = (image.width, image.height);
        let (new_width, new_height) =
            if self.exchanges_axes() { (height, width) } else { (width, height) };
        Image::from_fn(new_width, new_height, |x, y| self.seen_at(image, x, y))
    }

    /// What lies in a column and row of the picture laid so.
    fn seen_at(self, image: &Image, x: usize, y: usize) -> [f32; 3] {
        let (width, height) = (image.width, image.height);
        let at = |x: usize, y: usize| image.pixels[y * width + x];
        match self {
            Self::LeftRight => at(width - 1 - x, y),
            Self::UpsideDown => at(x, height - 1 - y),
            Self::HalfTurn => at(width - 1 - x, height - 1 - y),
            Self::Transposed => at(y, x),
            Self::AntiTransposed => at(width - 1 - y, height - 1 - x),
            Self::QuarterTurn => at(y, height - 1 - x),
            Self::QuarterTurnBack => at(width - 1 - y, x),
        }
    }
}

/// The reference laid in every way that keeps its size.
pub(super) fn candidates(question: &Question<'_>, consider: &mut dyn FnMut((Misfit, Image))) {
    let is_square = question.image.width == question.image.height;
    for symmetry in Symmetry::ALL {
        let fits_film = is_square || !symmetry.exchanges_axes();
        let laid = |pixel: usize| {
            let width = question.image.width;
            symmetry.seen_at(question.reference, pixel % width, pixel / width)
        };
        if fits_film && question.is_worth_a_look(laid) {
            consider((Misfit::Turned(symmetry), symmetry.of(question.reference)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_way_is_another_and_four_corners_go_where_they_should() {
        let image = Image::from_fn(2, 2, |x, y| [(10 * y + x) as f32; 3]);
        let laid = |symmetry: Symmetry| symmetry.of(&image).pixels.iter().map(|p| p[0]).collect();
        let all: Vec<Vec<f32>> = Symmetry::ALL.into_iter().map(laid).collect();
        assert_eq!(all[0], [1.0, 0.0, 11.0, 10.0]);
        assert_eq!(all[1], [10.0, 11.0, 0.0, 1.0]);
        assert_eq!(all[2], [11.0, 10.0, 1.0, 0.0]);
        assert_eq!(all[3], [0.0, 10.0, 1.0, 11.0]);
        assert_eq!(all[4], [11.0, 1.0, 10.0, 0.0]);
        assert_eq!(all[5], [10.0, 0.0, 11.0, 1.0]);
        assert_eq!(all[6], [1.0, 11.0, 0.0, 10.0]);
    }
}
