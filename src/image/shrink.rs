//! Smaller images for reports: means over square blocks of pixels.

use super::Image;

impl Image {
    /// The image with no side longer than `longest` pixels, each the mean of a block. NaN stays
    /// NaN: a block is what its worst pixel is.
    pub(crate) fn shrunk_to(&self, longest: usize) -> Self {
        let block = self.width.max(self.height).div_ceil(longest.max(1)).max(1);
        let (width, height) = (self.width.div_ceil(block), self.height.div_ceil(block));
        let mut small = Self::new(width, height, [0.0; 3]);
        for (number, pixel) in small.pixels.iter_mut().enumerate() {
            *pixel = self.mean_of_block(number % width, number / width, block);
        }
        small
    }

    fn mean_of_block(&self, column: usize, row: usize, block: usize) -> [f32; 3] {
        let columns = column * block..((column + 1) * block).min(self.width);
        let rows = row * block..((row + 1) * block).min(self.height);
        let count = (columns.len() * rows.len()) as f64;
        let mut sum = [0.0; 3];
        for y in rows {
            for pixel in &self.pixels[y * self.width..][columns.clone()] {
                for (sum, value) in sum.iter_mut().zip(pixel) {
                    *sum += f64::from(*value);
                }
            }
        }
        #[expect(
            clippy::cast_possible_truncation,
            reason = "a mean of f32 is as precise as they are"
        )]
        let mean = sum.map(|sum| (sum / count) as f32);
        mean
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_block_is_the_mean_of_its_pixels_also_at_the_edge_and_keeps_nan() {
        let mut image = Image::from_fn(3, 1, |x, _| [[1.0, 3.0, 7.0][x]; 3]);
        let small = image.shrunk_to(2);
        assert_eq!((small.size(), small.pixels), ([2, 1], vec![[2.0; 3], [7.0; 3]]));
        assert_eq!(image.shrunk_to(3), image);
        image.pixels[1][1] = f32::NAN;
        assert!(image.shrunk_to(2).pixels[0][1].is_nan());
    }
}
