//! The ways of a sampler that chooses between them by a third number, and the probability of each: the share of third
//! numbers that choose it. A core may choose by whatever probability it likes; it has to say so in its pdf.

use super::distribution::{Distribution, Drawn};
use crate::checks::Result;
use glam::DVec2;

/// The probability of a way is found to 2⁻³⁰, and in single precision to a rounding.
const HALVINGS: usize = 30;

/// The third number of all points, by the way that it chooses.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Way {
    /// There is one.
    Only,
    /// That of the smallest numbers.
    First,
    /// That of the largest.
    Last,
}

impl Way {
    /// Those that samples may go.
    pub(crate) const fn of(distribution: &Distribution) -> &'static [Self] {
        match distribution.is_of_sphere() {
            true => &[Self::First, Self::Last],
            false => &[Self::Only],
        }
    }

    /// A third number that chooses it, if any does.
    pub(crate) const fn lobe(self) -> f64 {
        match self {
            Self::Only => 0.5,
            Self::First => 0.0,
            Self::Last => 1.0 - 0.5 * f32::EPSILON as f64,
        }
    }

    const fn opposite(self) -> Self {
        match self {
            Self::Only => Self::Only,
            Self::First => Self::Last,
            Self::Last => Self::First,
        }
    }

    /// As part of a name.
    pub(crate) const fn words(self) -> &'static str {
        match self {
            Self::Only => "",
            Self::First => ", lobe 0",
            Self::Last => ", lobe 1",
        }
    }

    /// The probability of the way at each point, `centre` being its samples there.
    pub(crate) fn chances(
        self,
        points: &[DVec2],
        draw: &mut Draw<'_>,
        centre: &[Drawn],
    ) -> Result<Vec<f64>> {
        if matches!(self, Self::Only) {
            return Ok(vec![1.0; points.len()]);
        }
        // Of each point: a number that goes this way, and one that goes the other.
        let (end, away) = (self.lobe().round(), 1.0 - self.lobe().round());
        let mut ends = vec![(self.lobe(), away); points.len()];
        let elsewhere = draw(points, &vec![self.opposite().lobe(); points.len()])?;
        for _ in 0..HALVINGS {
            let middle: Vec<_> = ends.iter().map(|(here, there)| 0.5 * (here + there)).collect();
            let drawn = draw(points, &middle)?;
            for (i, end) in ends.iter_mut().enumerate() {
                let goes_here = is_same_way(&centre[i], &drawn[i]);
                *(if goes_here { &mut end.0 } else { &mut end.1 }) = middle[i];
            }
        }
        let probability = |(i, (here, _)): (usize, &(f64, f64))| {
            let is_sure = is_same_way(&centre[i], &elsewhere[i]);
            if is_sure { 1.0 } else { (here - end).abs() }
        };
        Ok(ends.iter().enumerate().map(probability).collect())
    }
}

/// One sample for each point and third number.
pub(crate) type Draw<'a> = dyn FnMut(&[DVec2], &[f64]) -> Result<Vec<Drawn>> + 'a;

/// Whether two samples lie on the same side, or fail both.
pub(crate) fn is_same_way(one: &Drawn, other: &Drawn) -> bool {
    let side = |drawn: &Drawn| drawn.direction.map(|direction| direction.z > 0.0);
    side(one) == side(other)
}
