//! Pictures: linear RGB f32, row 0 on top.

/// A picture of linear RGB radiance, row-major from the top left.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// `width · height` values.
    pub pixels: Vec<[f32; 3]>,
}

impl Image {
    /// A picture of one colour.
    pub fn new(width: usize, height: usize, colour: [f32; 3]) -> Self {
        Self { width, height, pixels: vec![colour; width * height] }
    }
}
