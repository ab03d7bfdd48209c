//! A ray at a triangle, what exact arithmetic says of it, and the rules by which a wrong core decides.

use super::exact_triangle::{Meeting, Truth};
use crate::cause::{Cause, shape};
use crate::checks::phrase::figure;
use crate::stats::Compared;

/// A ray, what exact arithmetic says of it, and what the core does.
#[derive(Clone, Copy)]
pub(super) struct Encounter {
    pub(super) meeting: Meeting,
    pub(super) t_max: f64,
    /// The core's t, if it hit.
    pub(super) found: Option<f64>,
}

impl Encounter {
    pub(super) fn is_clear(&self) -> bool {
        self.meeting.truth != Truth::Ambiguous
    }

    pub(super) fn should_hit(&self) -> bool {
        matches!(self.meeting.truth, Truth::Hit { .. })
    }

    /// The error of t, where there is a t to compare.
    pub(super) fn t_compared(&self) -> Option<Compared> {
        match (self.meeting.truth, self.found) {
            (Truth::Hit { allowed }, Some(t)) => Some(Compared::within(t, self.meeting.t, allowed)),
            _ => None,
        }
    }

    pub(super) fn is_wrong(&self) -> bool {
        self.found.is_some() != self.should_hit()
            || self.t_compared().is_some_and(|compared| !compared.agrees())
    }
}

/// A rule by which a wrong core decides what is a hit.
struct Rule {
    pub(super) cause: &'static Cause,
    pub(super) hits: fn(&Encounter) -> bool,
}

const RULES: &[Rule] = &[
    Rule { cause: &shape::BACK_CULLED, hits: |e| e.should_hit() && e.meeting.determinant > 0.0 },
    Rule { cause: &shape::FRONT_CULLED, hits: |e| e.should_hit() && e.meeting.determinant < 0.0 },
    Rule {
        cause: &shape::PARALLELOGRAM,
        hits: |e| is_on_segment(e) && e.meeting.weights[1] >= 0.0 && e.meeting.weights[2] >= 0.0,
    },
    Rule {
        cause: &shape::V_NOT_COMPARED,
        hits: |e| is_on_segment(e) && e.meeting.weights[0] >= 0.0 && e.meeting.weights[2] >= 0.0,
    },
    Rule {
        cause: &shape::W_NOT_COMPARED,
        hits: |e| is_on_segment(e) && e.meeting.weights[0] >= 0.0 && e.meeting.weights[1] >= 0.0,
    },
    Rule { cause: &shape::SEGMENT_END_IGNORED, hits: |e| is_inside(e) && e.meeting.t > 0.0 },
    Rule { cause: &shape::SEGMENT_IGNORED, hits: is_inside },
    Rule { cause: &shape::HITS_BEHIND_ORIGIN, hits: |e| is_inside(e) && e.meeting.t < e.t_max },
];

pub(super) fn is_inside(e: &Encounter) -> bool {
    e.meeting.weights.iter().all(|weight| *weight >= 0.0)
}

fn is_on_segment(e: &Encounter) -> bool {
    e.meeting.t > 0.0 && e.meeting.t < e.t_max
}

/// The mistake that explains every clear ray, if one does, and what speaks for it.
pub(super) fn explanation(encounters: &[Encounter]) -> Option<(&'static Cause, String)> {
    if encounters.iter().filter_map(Encounter::t_compared).any(|t| !t.agrees()) {
        return None;
    }
    let follows = |rule: &&Rule| encounters.iter().all(|e| (rule.hits)(e) == e.found.is_some());
    let evidence = || format!("predicts which of {} clear rays hit", encounters.len());
    let rule = RULES.iter().find(follows).map(|rule| (rule.cause, evidence()));
    rule.or_else(|| threshold(encounters))
}

/// Hits are lost exactly where the determinant is small: its size says nothing about parallelism.
pub(super) fn threshold(encounters: &[Encounter]) -> Option<(&'static Cause, String)> {
    if encounters.iter().any(|e| e.is_wrong() && !e.should_hit()) {
        return None;
    }
    let sizes = |lost: bool| {
        let hits = encounters.iter().filter(move |e| e.should_hit() && e.found.is_none() == lost);
        hits.map(|e| e.meeting.determinant.abs())
    };
    let largest_lost = sizes(true).fold(0.0, f64::max);
    let smallest_kept = sizes(false).fold(f64::INFINITY, f64::min);
    (largest_lost < smallest_kept).then(|| {
        let evidence = format!("hits are lost just below about {}", figure(smallest_kept));
        (&shape::DETERMINANT_THRESHOLD, evidence)
    })
}
