//! The answers of a core to spheres at one distance.

use super::exact_sphere::{Encounter, Formula};
use crate::cause::shape;
use crate::checks::phrase::{figure, some_are};
use crate::checks::{Finding, Measure};
use crate::contract::{Hit, Precision};
use crate::stats::{Compared, judge_exact};

/// An encounter, and what a core makes of it.
pub(super) struct Answer {
    pub(super) encounter: Encounter,
    pub(super) found: Hit,
}

impl Answer {
    /// The error of t; none if there is no t to compare.
    fn error(&self) -> Option<f64> {
        let (t, _) = self.encounter.hit.filter(|_| self.found.is_hit())?;
        Some((self.found.t - t).abs())
    }

    fn is_wrong_side(&self) -> bool {
        self.encounter.hit.is_some() != self.found.is_hit()
    }
}

/// The answers at one distance.
pub(super) struct Range {
    pub(super) distance: f64,
    pub(super) answers: Vec<Answer>,
}

/// The four things that are compared at one distance.
pub(super) struct Judged {
    pub(super) measures: Vec<Measure>,
    wrong_sides: usize,
    /// Answers without a number.
    spoilt: usize,
    pub(super) clear: usize,
    pub(super) worst_t: f64,
}

impl Judged {
    pub(super) fn failed(&self) -> bool {
        self.measures.iter().any(Measure::failed)
    }
}

impl Range {
    fn name(&self) -> String {
        match self.distance {
            distance if distance < 1.0 => "from inside".to_owned(),
            distance => format!("{} radii away", figure(distance)),
        }
    }

    pub(super) fn judge(&self, formula: Formula, precision: Precision) -> Judged {
        // The answers in which rounding decides nothing.
        let is_clear = |answer: &&Answer| answer.encounter.is_clear(formula, precision);
        let clear: Vec<_> = self.answers.iter().filter(is_clear).collect();
        if clear.is_empty() {
            return Judged {
                measures: Vec::new(),
                wrong_sides: 0,
                spoilt: 0,
                clear: 0,
                worst_t: 0.0,
            };
        }
        let wrong_sides = clear.iter().filter(|answer| answer.is_wrong_side()).count();
        let sides = format!("hits lost or invented of {}", clear.len());
        let mut measures = vec![Measure::none(sides, wrong_sides)];
        let both = || clear.iter().filter(|answer| answer.error().is_some());
        let t = judge_exact(both().filter_map(|answer| {
            let (t, _) = answer.encounter.hit?;
            let allowed = answer.encounter.allowed(formula, precision);
            Some(Compared::within(answer.found.t, t, allowed))
        }));
        let normals = judge_exact(both().filter_map(|answer| {
            let (_, normal) = answer.encounter.hit?;
            let off = answer.found.geometric_normal.distance(normal);
            Some(Compared::within(off, 0.0, answer.encounter.allowed_normal(formula, precision)))
        }));
        if t.compared > 0 {
            measures.push(Measure::worst("t", &t));
            measures.push(Measure::worst("normal off by", &normals));
        }
        let in_radii = |answer: &&&Answer| {
            let length = answer.encounter.ray.direction.length() / answer.encounter.radius;
            answer.error().map_or(0.0, |error| error * length)
        };
        let worst_t = both().map(|answer| in_radii(&answer)).fold(0.0, f64::max);
        let measures = measures.into_iter().map(|measure| measure.of_row(self.name())).collect();
        let spoilt = clear.iter().filter(|answer| answer.found.t.is_nan()).count();
        Judged { measures, wrong_sides, spoilt, clear: clear.len(), worst_t }
    }

    /// Whether some t is off by a hundredth of a rounding of single precision, at least: the worst of many is about one.
    fn is_off_by_single_roundings(&self) -> bool {
        let Judged { clear, worst_t, .. } = self.judge(Formula::Stable, Precision::Single);
        let rounding = Precision::Single.epsilon() * self.distance.max(1.0);
        clear == 0 || worst_t >= 0.01 * rounding
    }

    /// Decimal digits of the distance that t has lost.
    pub(super) fn digits_lost(&self, worst_t: f64, precision: Precision) -> f64 {
        (worst_t / (precision.epsilon() * self.distance.max(1.0))).max(1.0).log10()
    }
}

pub(super) fn complaint(range: &Range, judged: &Judged, precision: Precision) -> String {
    let digits = -precision.epsilon().log10();
    let name = range.name();
    if judged.wrong_sides > 0 {
        let some = some_are(judged.wrong_sides, judged.clear, "rays");
        return format!("{name}: {some} wrong about hit or miss");
    }
    if judged.spoilt > 0 {
        let (some, all) = (judged.spoilt, judged.clear);
        return format!(
            "{name}: {some} of {all} answers break the contract: NaN, or a normal that is not of unit length"
        );
    }
    format!(
        "{name}: t is off by up to {} radii: {:.0} of {digits:.0} digits are lost",
        figure(judged.worst_t),
        range.digits_lost(judged.worst_t, precision)
    )
}

/// Errors that grow as the square of the distance are those of the quadratic's discriminant; errors
/// of single precision everywhere are those of a float.
pub(super) fn explain(finding: Finding, ranges: &[Range], precision: Precision) -> Finding {
    let holds = |range: &Range, formula, precision| !range.judge(formula, precision).failed();
    let nearest = ranges.iter().min_by(|a, b| a.distance.total_cmp(&b.distance));
    let near_is_right = nearest.is_some_and(|range| holds(range, Formula::Stable, precision));
    let fits = |formula, precision| ranges.iter().all(|range| holds(range, formula, precision));
    let all: usize = ranges.iter().map(|range| range.answers.len()).sum();
    let evidence = |what: &str| format!("all {all} rays are within {what}");
    if near_is_right && fits(Formula::Quadratic, precision) {
        let what = "the roundings of b² − 4ac, which grow as the square of the distance";
        finding.because(&shape::SPHERE_CANCELLATION, evidence(what))
    } else if precision == Precision::Double
        && fits(Formula::Stable, Precision::Single)
        && ranges.iter().all(Range::is_off_by_single_roundings)
    {
        let what = "the roundings of single precision";
        finding.because(&shape::SINGLE_PRECISION_INSIDE, evidence(what))
    } else {
        finding
    }
}
