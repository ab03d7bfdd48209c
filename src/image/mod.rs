//! Images: linear RGB f32, row 0 on top. Reading, writing, showing and measuring them.
//!
//! Not here: whether two images agree. That is decided in `stats`; the [`metric`]s here inform
//! and never grade.

mod channel;
pub(crate) mod encoding;
mod error;
pub mod exr;
pub(crate) mod file;
pub(crate) mod filter;
pub(crate) mod flip;
pub(crate) mod hdr;
pub(crate) mod heatmap;
pub(crate) mod mask;
pub mod metric;
mod ms_ssim;
pub mod pair;
pub(crate) mod pfm;
mod pixel_error;
pub(crate) mod png;
mod shrink;
mod ssim;
pub(crate) mod tonemap;

pub(crate) use channel::{CHANNELS, Channel};
pub(crate) use error::ImageError;

/// An image of linear RGB radiance, row-major from the top left.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Image {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// `width · height` values.
    pub pixels: Vec<[f32; 3]>,
}

impl Image {
    /// An image of one colour.
    pub fn new(width: usize, height: usize, colour: [f32; 3]) -> Self {
        Self { width, height, pixels: vec![colour; width * height] }
    }

    /// An image whose pixel in column `x` of row `y` is `colour(x, y)`.
    pub fn from_fn(
        width: usize,
        height: usize,
        mut colour: impl FnMut(usize, usize) -> [f32; 3],
    ) -> Self {
        let positions = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        Self { width, height, pixels: positions.map(|(x, y)| colour(x, y)).collect() }
    }

    /// Adds the light of an image of the same size.
    pub(crate) fn add(&mut self, other: &Image) {
        for (sum, pixel) in self.pixels.iter_mut().zip(&other.pixels) {
            *sum = std::array::from_fn(|c| sum[c] + pixel[c]);
        }
    }

    pub(crate) fn same_size(&self, other: &Image) -> bool {
        self.size() == other.size()
    }

    /// Columns and rows.
    pub(crate) fn size(&self) -> [usize; 2] {
        [self.width, self.height]
    }

    /// The image of what `colour` makes of each pixel, row by row from the top left.
    pub(crate) fn map(&self, colour: impl FnMut([f32; 3]) -> [f32; 3]) -> Self {
        Self { pixels: self.pixels.iter().copied().map(colour).collect(), ..*self }
    }
}

/// Luminance of linear RGB with the primaries of Rec. 709.
pub fn luminance(colour: [f32; 3]) -> f64 {
    let [red, green, blue] = colour.map(f64::from);
    0.2126 * red + 0.7152 * green + 0.0722 * blue
}
