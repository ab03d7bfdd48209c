//! Separable filters, one row at a time: weighted sums of neighbours above and below, and left and
//! right.
//!
//! Each function works on a block of neighbouring pixels at once, whose sums stay in registers; the
//! compiler makes vector instructions of that.

/// Pixels whose sums are kept in registers together.
const BLOCK: usize = 16;

/// A row with its ends repeated on both sides, so that every pixel has all its neighbours.
#[derive(Clone, Debug, Default)]
pub(crate) struct PaddedRow {
    values: Vec<f32>,
    radius: usize,
}

impl PaddedRow {
    /// Room for a row of `width` pixels, `radius` more on either side.
    pub(crate) fn new(width: usize, radius: usize) -> Self {
        Self { values: vec![0.0; width + 2 * radius], radius }
    }

    /// The row itself.
    pub(crate) fn inside_mut(&mut self) -> &mut [f32] {
        let width = self.values.len() - 2 * self.radius;
        &mut self.values[self.radius..][..width]
    }

    pub(crate) fn repeat_ends(&mut self) {
        let (radius, end) = (self.radius, self.values.len() - self.radius);
        let [first, last] = [self.values[radius], self.values[end - 1]];
        self.values[..radius].fill(first);
        self.values[end..].fill(last);
    }

    /// The values that a filter of this many weights reads.
    fn for_filter(&self, weights: usize) -> &[f32] {
        let margin = self.radius - weights / 2;
        &self.values[margin..self.values.len() - margin]
    }
}

/// `out[x]` = Σ `weights[i]` · `rows[i][x]`: the rows above and below, from the top.
pub(crate) fn down(weights: &[f32], rows: &[&[f32]], out: &mut [f32]) {
    let terms = || weights.iter().copied().zip(rows.iter().copied());
    weighted_sums(out, terms);
}

/// `out[x]` = Σ `weights[i]` · `row[x + i − radius]`: the pixels left and right. The filter is no
/// wider than the row's padding.
pub(crate) fn along(weights: &[f32], row: &PaddedRow, out: &mut [f32]) {
    let source = row.for_filter(weights.len());
    let terms = || weights.iter().copied().enumerate().map(|(i, weight)| (weight, &source[i..]));
    weighted_sums(out, terms);
}

/// `out[x]` = Σ `weight` · `values[x]` over all terms.
#[inline(always)]
fn weighted_sums<'a, T>(out: &mut [f32], terms: impl Fn() -> T)
where
    T: Iterator<Item = (f32, &'a [f32])>,
{
    // The last block may cover pixels of the one before again.
    let last = out.len().saturating_sub(BLOCK);
    for start in (0..out.len()).step_by(BLOCK).map(|start| start.min(last)) {
        let Some(out) = out[start..].first_chunk_mut::<BLOCK>() else {
            return weighted_sums_one_by_one(out, terms);
        };
        let mut sums = [0.0; BLOCK];
        for (weight, values) in terms() {
            if let Some(values) = values[start..].first_chunk::<BLOCK>() {
                sums = std::array::from_fn(|i| sums[i] + weight * values[i]);
            }
        }
        *out = sums;
    }
}

/// The same for rows that are shorter than a block.
fn weighted_sums_one_by_one<'a, T>(out: &mut [f32], terms: impl Fn() -> T)
where
    T: Iterator<Item = (f32, &'a [f32])>,
{
    for (x, out) in out.iter_mut().enumerate() {
        *out = terms().map(|(weight, values)| weight * values[x]).sum();
    }
}

/// exp(−x² / 2σ²) at whole numbers from −`radius` to `radius`, summing to one.
pub(crate) fn gaussian(deviation: f64, radius: usize) -> Vec<f32> {
    let at = |i: usize| (-0.5 * ((i as f64 - radius as f64) / deviation).powi(2)).exp();
    let weights: Vec<f64> = (0..=2 * radius).map(at).collect();
    let sum: f64 = weights.iter().sum();
    #[expect(clippy::cast_possible_truncation, reason = "weights are used in single precision")]
    weights.iter().map(|weight| (weight / sum) as f32).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_beyond_the_end_are_the_end() {
        let mut row = PaddedRow::new(19, 3);
        row.inside_mut().iter_mut().enumerate().for_each(|(x, value)| *value = x as f32);
        row.repeat_ends();
        let mut out = [0.0; 19];
        along(&[1.0, 10.0, 100.0], &row, &mut out);
        assert_eq!(out[0], 0.0 + 0.0 + 100.0);
        assert_eq!(out[7], 6.0 + 70.0 + 800.0);
        assert_eq!(out[18], 17.0 + 180.0 + 1800.0);
    }

    #[test]
    fn rows_are_weighted_from_the_top() {
        let rows: Vec<Vec<f32>> = (0..3).map(|y| vec![y as f32; 21]).collect();
        let rows: Vec<&[f32]> = rows.iter().map(Vec::as_slice).collect();
        let mut out = [0.0; 21];
        down(&[1.0, 10.0, 100.0], &rows, &mut out);
        assert_eq!(out, [210.0; 21]);
    }

    #[test]
    fn a_bell_sums_to_one() {
        let weights = gaussian(1.5, 5);
        assert_eq!(weights.len(), 11);
        assert!((weights.iter().sum::<f32>() - 1.0).abs() < 1e-6);
        assert!((weights[5] / weights[6] - (1.0f32 / 4.5).exp()).abs() < 1e-5);
    }
}
