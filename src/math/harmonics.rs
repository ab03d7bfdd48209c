//! Real spherical harmonics up to the third degree, as polynomials of a unit direction.
//!
//! In Racah's normalisation: the squares of one degree add up to 1 everywhere, so that none exceeds
//! 1.

use glam::DVec3;

/// Harmonics of degree 1, 2 and 3; that of degree 0 is 1.
pub(crate) const COUNT: usize = 15;

/// Their names, as polynomials.
pub(crate) const NAMES: [&str; COUNT] = [
    "y",
    "z",
    "x",
    "xy",
    "yz",
    "3z² − 1",
    "xz",
    "x² − y²",
    "y(3x² − y²)",
    "xyz",
    "y(5z² − 1)",
    "z(5z² − 3)",
    "x(5z² − 1)",
    "z(x² − y²)",
    "x(x² − 3y²)",
];

/// All of them in a direction, degree by degree, order by order.
pub(crate) fn harmonics(direction: DVec3) -> [f64; COUNT] {
    let DVec3 { x, y, z } = direction;
    let (xx, yy, zz) = (x * x, y * y, z * z);
    [
        y,
        z,
        x,
        3f64.sqrt() * x * y,
        3f64.sqrt() * y * z,
        0.5 * (3.0 * zz - 1.0),
        3f64.sqrt() * x * z,
        0.75f64.sqrt() * (xx - yy),
        0.625f64.sqrt() * y * (3.0 * xx - yy),
        15f64.sqrt() * x * y * z,
        0.375f64.sqrt() * y * (5.0 * zz - 1.0),
        0.5 * z * (5.0 * zz - 3.0),
        0.375f64.sqrt() * x * (5.0 * zz - 1.0),
        3.75f64.sqrt() * z * (xx - yy),
        0.625f64.sqrt() * x * (xx - 3.0 * yy),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rng::Seed;
    use crate::math::sphere::on_sphere;

    #[test]
    fn the_squares_of_a_degree_add_up_to_one() {
        let mut stream = Seed(1).stream();
        for _ in 0..100 {
            let values = harmonics(on_sphere(&mut stream));
            for degree in [&values[..3], &values[3..8], &values[8..]] {
                let sum: f64 = degree.iter().map(|value| value * value).sum();
                assert!((sum - 1.0).abs() < 1e-14, "{sum}");
            }
        }
    }

    #[test]
    fn they_are_orthogonal() {
        // Squares of degree l have the mean 1/(2l + 1) over the sphere; 20 000 samples see 0.03.
        let mut stream = Seed(2).stream();
        let mut products = [[0.0; COUNT]; COUNT];
        for _ in 0..20_000 {
            let values = harmonics(on_sphere(&mut stream));
            for (i, row) in products.iter_mut().enumerate() {
                row.iter_mut().zip(values).for_each(|(sum, v)| *sum += values[i] * v / 20_000.0);
            }
        }
        for (i, row) in products.iter().enumerate() {
            let degree = [1, 2, 3][usize::from(i >= 3) + usize::from(i >= 8)];
            for (j, product) in row.iter().enumerate() {
                let expected = if i == j { 1.0 / f64::from(2 * degree + 1) } else { 0.0 };
                assert!((product - expected).abs() < 0.03, "{i}, {j}: {product}");
            }
        }
    }
}
