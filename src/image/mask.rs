//! Pixels that do not count, because somebody has declared so: where a renderer is known to differ
//! on purpose, or an image shows something else.

use super::{Image, ImageError};

/// A rectangle of pixels: first column, first row from the top, columns, rows.
pub(crate) type Rectangle = [usize; 4];

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Mask {
    rectangles: Vec<Rectangle>,
    /// Columns, rows, and which pixels count.
    picture: Option<([usize; 2], Vec<bool>)>,
}

impl Mask {
    pub(crate) fn of_rectangles(rectangles: &[Rectangle]) -> Self {
        Self { rectangles: rectangles.to_vec(), picture: None }
    }

    /// Of an image that is black where pixels do not count.
    pub(crate) fn from_picture(image: &Image) -> Self {
        let counted = image.pixels.iter().map(|pixel| *pixel != [0.0; 3]).collect();
        Self { rectangles: Vec::new(), picture: Some((image.size(), counted)) }
    }

    /// Which pixels of an image of this size count, row by row; an error if the mask is an image of another size, or
    /// nothing counts.
    pub(crate) fn counted(&self, [width, height]: [usize; 2]) -> Result<Vec<bool>, ImageError> {
        let mut counted = match &self.picture {
            None => vec![true; width * height],
            Some((size, counted)) if *size == [width, height] => counted.clone(),
            Some((size, _)) => {
                return Err(ImageError::DifferentSizes { sizes: [[width, height], *size] });
            }
        };
        for [x, y, columns, rows] in &self.rectangles {
            for row in (*y).min(height)..(y + rows).min(height) {
                let (first, end) = ((*x).min(width), (x + columns).min(width));
                counted[row * width..][first..end].fill(false);
            }
        }
        if counted.contains(&true) { Ok(counted) } else { Err(ImageError::Empty) }
    }
}

impl Image {
    /// Shows `other` where pixels do not count, so that no comparison of both sees them.
    pub(crate) fn paint_over(&mut self, counted: &[bool], other: &Image) {
        let pixels = self.pixels.iter_mut().zip(&other.pixels).zip(counted);
        for ((pixel, other), _) in pixels.filter(|(_, counted)| !**counted) {
            *pixel = *other;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rectangles_and_black_pixels_do_not_count() {
        let mask = Mask::of_rectangles(&[[1, 0, 2, 1], [3, 1, 9, 9]]);
        let counted = mask.counted([4, 2]).unwrap();
        assert_eq!(counted, [true, false, false, true, true, true, true, false]);
        let picture = Image::from_fn(4, 2, |x, _| [x as f32, 0.0, 0.0]);
        let counted = Mask::from_picture(&picture).counted([4, 2]).unwrap();
        assert_eq!(counted, [false, true, true, true, false, true, true, true]);
    }

    #[test]
    fn a_mask_of_another_size_or_of_everything_is_refused() {
        let picture = Mask::from_picture(&Image::new(4, 2, [1.0; 3]));
        assert!(picture.counted([2, 4]).is_err());
        assert!(Mask::of_rectangles(&[[0, 0, 9, 9]]).counted([4, 2]).is_err());
    }

    #[test]
    fn what_does_not_count_is_painted_over() {
        let mut image = Image::new(2, 1, [f32::NAN; 3]);
        image.paint_over(&[false, false], &Image::new(2, 1, [0.5; 3]));
        assert_eq!(image, Image::new(2, 1, [0.5; 3]));
    }
}
