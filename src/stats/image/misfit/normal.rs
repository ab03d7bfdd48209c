//! Least squares: parameters that make a difference small, with errors that hold whatever the noise
//! of each unit is.

use super::Estimate;

/// Standard errors on either side of a number with 99.9 % confidence.
const SIGMAS: f64 = 3.29;

/// The sums of a unit that a step of Gauss and Newton needs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sums<const N: usize> {
    /// Σ slopeᵢ · slopeⱼ
    squares: [[f64; N]; N],
    /// Σ slopeᵢ · difference
    scores: [f64; N],
}

impl<const N: usize> Sums<N> {
    pub(super) const NOTHING: Self = Self { squares: [[0.0; N]; N], scores: [0.0; N] };

    /// Adds a difference and how it shrinks with each parameter.
    pub(super) fn add(&mut self, slopes: [f64; N], difference: f64) {
        for i in 0..N {
            self.scores[i] += slopes[i] * difference;
            for j in 0..N {
                self.squares[i][j] += slopes[i] * slopes[j];
            }
        }
    }
}

/// By how much to change the parameters, and the standard errors of that; none where the difference
/// does not depend on one of them.
pub(super) fn solve<const N: usize>(units: &[Sums<N>]) -> Option<([f64; N], [f64; N])> {
    let mut total = Sums::<N>::NOTHING;
    for unit in units {
        for i in 0..N {
            total.scores[i] += unit.scores[i];
            for j in 0..N {
                total.squares[i][j] += unit.squares[i][j];
            }
        }
    }
    let inverse = inverse(total.squares)?;
    let times = |scores: [f64; N]| -> [f64; N] {
        std::array::from_fn(|i| (0..N).map(|j| inverse[i][j] * scores[j]).sum())
    };
    let step = times(total.scores);
    let mut variances = [0.0; N];
    for unit in units {
        // What is left of the unit's scores after the step.
        let fitted = |i: usize| (0..N).map(|j| unit.squares[i][j] * step[j]).sum::<f64>();
        let left = std::array::from_fn(|i| unit.scores[i] - fitted(i));
        for (variance, moved) in variances.iter_mut().zip(times(left)) {
            *variance += moved * moved;
        }
    }
    Some((step, variances.map(f64::sqrt)))
}

/// The inverse by Gauss and Jordan; none of a matrix that has none.
fn inverse<const N: usize>(mut matrix: [[f64; N]; N]) -> Option<[[f64; N]; N]> {
    let largest = (0..N).map(|i| matrix[i][i]).fold(0.0, f64::max);
    let mut inverse: [[f64; N]; N] =
        std::array::from_fn(|i| std::array::from_fn(|j| f64::from(u8::from(i == j))));
    for pivot in 0..N {
        // Positive, or the parameters cannot be told apart: no rows need be exchanged.
        let is_positive = matrix[pivot][pivot] > 1e-12 * largest;
        if !is_positive {
            return None;
        }
        let scale = 1.0 / matrix[pivot][pivot];
        matrix[pivot] = matrix[pivot].map(|value| value * scale);
        inverse[pivot] = inverse[pivot].map(|value| value * scale);
        for row in (0..N).filter(|row| *row != pivot) {
            let factor = matrix[row][pivot];
            for column in 0..N {
                matrix[row][column] -= factor * matrix[pivot][column];
                inverse[row][column] -= factor * inverse[pivot][column];
            }
        }
    }
    Some(inverse)
}

/// Numbers with their intervals; `allowance` for what the model itself is not exact to.
pub(super) fn estimates<const N: usize>(
    values: [f64; N],
    errors: [f64; N],
    allowance: [f64; N],
) -> [Estimate; N] {
    std::array::from_fn(|i| Estimate::new(values[i], SIGMAS * errors[i] + allowance[i]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_inverse_undoes_its_matrix() {
        let matrix = [[4.0, 1.0, 0.5], [1.0, 3.0, 0.2], [0.5, 0.2, 2.0]];
        let inverse = inverse(matrix).unwrap();
        for (i, row) in matrix.iter().enumerate() {
            let product =
                |j: usize| -> f64 { row.iter().zip(&inverse).map(|(a, b)| a * b[j]).sum() };
            let off = |j: usize| (product(j) - f64::from(u8::from(i == j))).abs();
            assert!((0..3).all(|j| off(j) < 1e-12));
        }
        assert!(super::inverse([[1.0, 1.0], [1.0, 1.0]]).is_none());
        assert!(super::inverse([[f64::NAN]]).is_none());
    }

    #[test]
    fn a_line_through_points_is_found() {
        let units: Vec<_> = (0..10)
            .map(|x| {
                let mut sums = Sums::NOTHING;
                sums.add([1.0, f64::from(x)], 3.0 - 0.5 * f64::from(x));
                sums
            })
            .collect();
        let (step, errors) = solve(&units).unwrap();
        assert!((step[0] - 3.0).abs() < 1e-9 && (step[1] + 0.5).abs() < 1e-9);
        assert!(errors.iter().all(|error| *error < 1e-9));
    }
}
