//! What a core made of one view of a mirror or of glass, next to what is right.

use super::interface::{Lobe, Lobes};
use crate::cause::{Cause, bsdf as cause};
use crate::checks::Measure;
use crate::checks::phrase::{degrees, figure, percent};
use crate::contract::BsdfSample;
use crate::math::sphere::angle_between;
use crate::stats::{Compared, ExactReport, ShareReport, Verdict, judge_exact};
use glam::DVec3;

/// A mistake may magnify rounding, but not a hundredfold; different mistakes differ in the second digit.
const LIKENESS: f64 = 100.0;

/// How far rounding may take a correct core.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Allowed {
    /// Of a direction, radians, before its condition.
    pub(crate) direction: f64,
    /// Of what a lobe carries, and of its probability; relative.
    pub(crate) formula: f64,
}

/// One view, the samples drawn for it, and how often they were reflections.
pub(crate) struct SmoothView {
    /// `at 60°`
    pub(crate) name: String,
    /// Towards the viewer, local.
    pub(crate) wo: DVec3,
    /// What light should do.
    pub(crate) right: Lobes,
    /// Samples that are looked at one by one.
    pub(crate) samples: Vec<BsdfSample>,
    /// Whether samples are reflections as often as they say.
    pub(crate) probability: Option<ShareReport>,
    /// How far rounding may take a correct core.
    pub(crate) allowed: Allowed,
}

/// One of the two ways, and what went it.
struct Way<'a> {
    name: &'static str,
    /// `None` where no light goes.
    right: Option<Lobe>,
    samples: Vec<&'a BsdfSample>,
    /// The probability that it should have, by what reflections say of theirs.
    probability: f64,
}

impl SmoothView {
    /// The probability of a reflection that the samples state.
    pub(crate) fn stated_probability(&self) -> Option<f64> {
        let (back, through) = self.sides();
        let of_reflection = back.first().map(|sample| sample.pdf);
        let stated = of_reflection.or_else(|| through.first().map(|sample| 1.0 - sample.pdf));
        stated.map(|probability| probability.clamp(0.0, 1.0))
    }

    /// Whether every sample goes where it should with what it should carry, and none is marked.
    pub(crate) fn lacks_its_mark(&self) -> bool {
        self.samples.iter().all(|sample| sample.is_valid == 1 && sample.is_delta == 0)
            && self.is_predicted_by(self.right)
    }

    /// What pdf says of a reflection and how many there are, if that is all that is wrong.
    pub(crate) fn other_chance(&self) -> Option<(f64, f64)> {
        let probability =
            self.probability.as_ref().filter(|probability| probability.verdict == Verdict::Fail)?;
        self.is_predicted_by(self.right).then_some((probability.expected, probability.share))
    }

    /// Whether light goes both ways, and every sample states a probability of one.
    pub(crate) fn is_sure_of_both(&self) -> Option<bool> {
        let (back, through) = self.sides();
        let goes_both_ways = !back.is_empty() && !through.is_empty();
        goes_both_ways.then(|| self.samples.iter().all(|s| s.is_valid == 1 && s.pdf == 1.0))
    }

    /// Whether a core that works light out this way would have given every sample.
    pub(crate) fn is_predicted_by(&self, lobes: Lobes) -> bool {
        let (back, through) = self.sides();
        let samples = || back.iter().chain(&through);
        let is_met = |lobe: Lobe| samples().any(|s| self.is_like(s, lobe));
        samples().all(|s| lobes.iter().any(|lobe| self.is_like(s, lobe)))
            && lobes.iter().all(is_met)
    }

    fn is_like(&self, sample: &BsdfSample, lobe: Lobe) -> bool {
        let carried = carried(sample);
        let is_as_bright = |c: usize| {
            let slack = LIKENESS * self.allowed.formula * lobe.carried[c];
            (carried[c] - lobe.carried[c]).abs() <= slack
        };
        angle_between(sample.wi, lobe.wi) <= LIKENESS * self.allowed_angle(lobe)
            && (0..3).all(is_as_bright)
    }

    /// A cosine near zero magnifies the rounding of its square.
    fn allowed_angle(&self, lobe: Lobe) -> f64 {
        self.allowed.direction / lobe.wi.z.abs()
    }

    /// The samples that stay on the side of the viewer, and those that pass.
    fn sides(&self) -> (Vec<&BsdfSample>, Vec<&BsdfSample>) {
        let valid = self.samples.iter().filter(|sample| sample.is_valid == 1);
        valid.partition(|sample| is_reflection(sample, self.wo))
    }

    fn ways(&self) -> [Way<'_>; 2] {
        let (back, through) = self.sides();
        let probability = self.stated_probability().unwrap_or(f64::NAN);
        let Lobes { reflected, refracted } = self.right;
        [
            Way { name: "reflected", right: reflected, samples: back, probability },
            Way {
                name: "refracted",
                right: refracted,
                samples: through,
                probability: 1.0 - probability,
            },
        ]
    }

    /// How many samples failed, and how many are not marked.
    fn unusable(&self) -> (usize, usize) {
        let failed = self.samples.iter().filter(|sample| sample.is_valid != 1).count();
        let marked = self.samples.iter().filter(|s| s.is_valid == 1 && s.is_delta == 1).count();
        (failed, self.samples.len() - failed - marked)
    }

    /// The rows of the finding.
    pub(crate) fn measures(&self) -> Vec<Measure> {
        let count = |what: &str, found: usize| Measure::none(what, found).in_unit("samples");
        let (failed, unmarked) = self.unusable();
        let mut measures = vec![count("failed", failed), count("not marked as delta", unmarked)];
        for way in self.ways() {
            let name = way.name;
            let Some(lobe) = way.right else {
                measures.push(count(&format!("{name} where no light goes"), way.samples.len()));
                continue;
            };
            let rows = [
                ("direction, radians off", self.directions(&way, lobe)),
                ("share of light", self.shares(&way, lobe)),
                ("probability", self.chances(&way)),
            ];
            let worst = |(what, report)| Measure::worst(format!("{name} {what}"), &report);
            measures.extend(rows.map(worst));
        }
        let probability = self.probability.as_ref();
        measures.extend(probability.map(|report| Measure::of("samples reflected", report)));
        measures.into_iter().map(|measure| measure.of_row(&self.name)).collect()
    }

    fn directions(&self, way: &Way<'_>, lobe: Lobe) -> ExactReport {
        let allowed = self.allowed_angle(lobe);
        let off = |s: &&BsdfSample| Compared::within(angle_between(s.wi, lobe.wi), 0.0, allowed);
        judge_exact(way.samples.iter().map(off))
    }

    fn shares(&self, way: &Way<'_>, lobe: Lobe) -> ExactReport {
        judge_exact(way.samples.iter().flat_map(|sample| {
            let carried = carried(sample);
            let share = |c| Compared::relative(carried[c], lobe.carried[c], self.allowed.formula);
            (0..3).map(share).collect::<Vec<_>>()
        }))
    }

    fn chances(&self, way: &Way<'_>) -> ExactReport {
        let probability =
            |s: &&BsdfSample| Compared::relative(s.pdf, way.probability, self.allowed.formula);
        judge_exact(way.samples.iter().map(probability))
    }

    /// The first thing that is wrong.
    pub(crate) fn complaint(&self) -> Option<String> {
        let at = &self.name;
        match self.unusable() {
            (0, 0) => {}
            (0, unmarked) => {
                return Some(format!("{at}: {unmarked} samples are not marked as delta"));
            }
            (failed, _) => {
                let all = self.samples.len();
                return Some(format!(
                    "{at}: {failed} of {all} samples fail, and their light is lost"
                ));
            }
        }
        let of_way = self.ways().iter().find_map(|way| self.complaint_of(way));
        of_way.or_else(|| self.complaint_of_chance()).map(|what| format!("{at}: {what}"))
    }

    fn complaint_of(&self, way: &Way<'_>) -> Option<String> {
        let name = way.name;
        let Some(lobe) = way.right else {
            let some = !way.samples.is_empty();
            return some.then(|| format!("light is {name} where none goes"));
        };
        if way.samples.is_empty() {
            return Some(format!("light is never {name}"));
        }
        let directions = self.directions(way, lobe);
        if directions.disagree > 0 {
            let off = degrees(directions.worst?.compared.found);
            return Some(format!("light is {name} {off} off its direction"));
        }
        let shares = self.shares(way, lobe);
        if shares.disagree > 0 {
            let Compared { found, expected, .. } = shares.worst?.compared;
            let (is, should) = (figure(found), figure(expected));
            let by = percent(found / expected - 1.0);
            return Some(format!("{is} of the light is {name} instead of {should}, off by {by}"));
        }
        let chances = self.chances(way);
        let Compared { found, expected, .. } = chances.worst?.compared;
        let (is, rest) = (figure(found), figure(expected));
        (chances.disagree > 0)
            .then(|| format!("pdf says that light is {name} with probability {is}, of {rest} left"))
    }

    fn complaint_of_chance(&self) -> Option<String> {
        let probability =
            self.probability.as_ref().filter(|probability| probability.verdict == Verdict::Fail)?;
        let (stated, share) = (percent(probability.expected), percent(probability.share));
        Some(format!("{share} of samples are reflected, and pdf says {stated}"))
    }
}

/// What is wrong with the probabilities of the two ways, if only they are.
pub(super) fn chance_clue(views: &[SmoothView]) -> Option<(&'static Cause, String)> {
    let sure: Vec<_> = views.iter().filter_map(SmoothView::is_sure_of_both).collect();
    if !sure.is_empty() && sure.iter().all(|sure| *sure) {
        let evidence = format!("pdf is 1 in {} views that go both ways", sure.len());
        return Some((&cause::DELTA_PROBABILITY_IS_ONE, evidence));
    }
    let (stated, share) = views.iter().find_map(SmoothView::other_chance)?;
    let (stated, share) = (percent(stated), percent(share));
    let evidence = format!("{share} of samples are reflections where pdf says {stated}");
    Some((&cause::LOBE_PROBABILITY_MISMATCH, evidence))
}

/// Right samples that no view has marked.
pub(super) fn mark_clue(views: &[SmoothView]) -> Option<(&'static Cause, String)> {
    let evidence = format!("is-delta is 0 in {} views, and all else is right", views.len());
    views.iter().all(SmoothView::lacks_its_mark).then_some((&cause::MIRROR_NOT_DELTA, evidence))
}

/// Whether a sample stays on the side of the viewer.
pub(crate) fn is_reflection(sample: &BsdfSample, wo: DVec3) -> bool {
    sample.is_valid == 1 && sample.wi.z * wo.z > 0.0
}

/// What a sample carries, whatever its probability.
fn carried(sample: &BsdfSample) -> [f64; 3] {
    sample.f.map(|f| f * sample.wi.z.abs())
}
