//! Comparisons without noise: how far rounding may take a correct core, and where the worst element
//! is.
//!
//! Every tolerance of a deterministic check stands here, by name and for both precisions. They are
//! rounding errors with room for another order of operations, not room for another formula: the
//! mistakes they tell apart are orders of magnitude larger.

use crate::math::Precision;
use crate::stats::plan::{Judgement, Report, Verdict};

/// The error allowed to a correct core, relative to the size and the condition of what is compared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Tolerance {
    double: f64,
    single: f64,
}

impl Tolerance {
    /// Components of a unit direction after a handful of operations (camera rays, normals, mirror
    /// directions).
    pub(crate) const DIRECTION: Self = Self { double: 1e-12, single: 2e-6 };
    /// Ray parameters of intersections, relative, before their condition number.
    pub(crate) const INTERSECTION: Self = Self { double: 1e-9, single: 1e-4 };
    /// Some sixteen roundings of numbers whose size is known; what is compared says which.
    pub(crate) const ROUNDINGS: Self = Self { double: 16.0 * f64::EPSILON, single: 16.0 * 1.2e-7 };
    /// By how much two ways around a box may differ that do not touch: a box test rounds each
    /// crossing twice.
    pub(crate) const SLAB: Self = Self { double: 1e-12, single: 1e-6 };
    /// A pdf or a BSDF evaluated twice for the same directions, relative.
    pub(crate) const SAME_VALUE: Self = Self { double: 1e-6, single: 1e-4 };
    /// A pdf or a BSDF against its formula, relative: cancellation near grazing costs single
    /// precision digits.
    pub(crate) const FORMULA: Self = Self { double: 1e-6, single: 1e-3 };
    /// An integral over the sphere, by quadrature of the core's own values.
    pub(crate) const INTEGRAL: Self = Self { double: 1e-6, single: 1e-5 };
    /// Pdf times Jacobian of a sampler by central differences, half the points.
    pub(crate) const JACOBIAN_MEDIAN: Self = Self { double: 1e-6, single: 1e-2 };
    /// The same, 99 points of 100.
    pub(crate) const JACOBIAN_TAIL: Self = Self { double: 1e-3, single: 1e-1 };
    /// Radiance without noise: delta lights, furnaces without variance. Relative. In both
    /// precisions a shadow ray starts and ends a little off its surfaces.
    pub(crate) const RADIANCE: Self = Self { double: 1e-5, single: 1e-5 };

    /// A pixel that is the mean of equal samples, relative: films are single precision in every
    /// core, and weights of 1/n round once a sample.
    pub(crate) const PIXEL: Self = Self { double: 1e-6, single: 1e-6 };

    /// The relative error allowed in this precision.
    pub(crate) const fn of(self, precision: Precision) -> f64 {
        match precision {
            Precision::Double => self.double,
            Precision::Single => self.single,
        }
    }
}

/// A number that was asked for, and the one that is right.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Compared {
    pub(crate) found: f64,
    pub(crate) expected: f64,
    /// How far apart they may be, absolute.
    pub(crate) allowed: f64,
}

impl Compared {
    /// Allows an absolute error.
    pub(crate) fn within(found: f64, expected: f64, allowed: f64) -> Self {
        Self { found, expected, allowed }
    }

    /// Allows an error relative to what is expected.
    pub(crate) fn relative(found: f64, expected: f64, allowed: f64) -> Self {
        Self { found, expected, allowed: allowed * expected.abs() }
    }

    /// How far apart they are; 0 for equal infinities.
    pub(crate) fn error(&self) -> f64 {
        if self.found == self.expected { 0.0 } else { (self.found - self.expected).abs() }
    }

    /// Whether that is allowed. NaN is not.
    pub(crate) fn agrees(&self) -> bool {
        self.error() <= self.allowed
    }

    /// The error as a multiple of what is allowed; infinite for NaN.
    fn excess(&self) -> f64 {
        let excess = if self.error() == 0.0 { 0.0 } else { self.error() / self.allowed };
        if excess.is_nan() { f64::INFINITY } else { excess }
    }
}

/// The worst element of a comparison.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Worst {
    /// Its number in the order compared.
    pub(crate) index: usize,
    pub(crate) compared: Compared,
}

/// The judgement of a comparison without noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ExactReport {
    /// Pass or fail; inconclusive if nothing was compared.
    pub(crate) verdict: Verdict,
    pub(crate) compared: usize,
    pub(crate) disagree: usize,
    /// The element furthest beyond what is allowed, or nearest to it.
    pub(crate) worst: Option<Worst>,
}

impl Report for ExactReport {
    /// The worst element; NaN if nothing was compared.
    fn judgement(&self) -> Judgement {
        let nothing = Compared::within(f64::NAN, 0.0, 0.0);
        let Compared { found, expected, allowed } = self.worst.map_or(nothing, |w| w.compared);
        Judgement {
            allowed,
            smallest_detectable_error: (expected != 0.0).then(|| allowed / expected.abs()),
            ..Judgement::new(self.verdict, found, expected)
        }
    }
}

/// Judges elements one by one: all have to agree.
pub(crate) fn judge_exact(elements: impl IntoIterator<Item = Compared>) -> ExactReport {
    let mut report =
        ExactReport { verdict: Verdict::Inconclusive, compared: 0, disagree: 0, worst: None };
    for (index, compared) in elements.into_iter().enumerate() {
        report.compared += 1;
        report.disagree += usize::from(!compared.agrees());
        if report.worst.is_none_or(|worst| compared.excess() > worst.compared.excess()) {
            report.worst = Some(Worst { index, compared });
        }
    }
    if report.compared > 0 {
        report.verdict = Verdict::pass_if(report.disagree == 0);
    }
    report
}

#[cfg(test)]
mod tests {
    use super::*;

    fn judged(found: [f64; 3]) -> ExactReport {
        judge_exact(found.map(|found| Compared::within(found, 1.0, 0.1)))
    }

    #[test]
    fn all_have_to_agree_and_the_worst_is_named() {
        for (found, disagree) in [([1.0, 1.3, 1.2], 2), ([9.0, f64::NAN, 1.0], 2)] {
            let report = judged(found);
            assert_eq!(report.verdict, Verdict::Fail);
            assert_eq!((report.compared, report.disagree), (3, disagree));
            assert_eq!(report.worst.map(|worst| worst.index), Some(1));
        }
        assert_eq!(judged([1.0; 3]).verdict, Verdict::Pass);
        assert_eq!(judge_exact([]).verdict, Verdict::Inconclusive);
    }

    #[test]
    fn nan_disagrees_as_different_infinities_do_and_equal_ones_agree() {
        const INFINITY: f64 = f64::INFINITY;
        for (found, expected, allowed, agrees) in [
            (1.0, 1.0, f64::NAN, false),
            (INFINITY, INFINITY, 0.0, true),
            (INFINITY, -INFINITY, 1.0, false),
            (INFINITY, 1.0, 1.0, false),
        ] {
            assert_eq!(Compared::within(found, expected, allowed).agrees(), agrees, "{found}");
        }
    }

    #[test]
    fn single_precision_is_allowed_more() {
        for tolerance in [Tolerance::DIRECTION, Tolerance::INTERSECTION, Tolerance::FORMULA] {
            assert!(tolerance.of(Precision::Single) > tolerance.of(Precision::Double));
        }
    }
}
