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

/// How a wrong core decides what is a hit.
type Rule = fn(&Encounter) -> bool;

const RULES: &[(&Cause, Rule)] = &[
    (&shape::BACK_CULLED, |e| e.should_hit() && e.meeting.determinant > 0.0),
    (&shape::FRONT_CULLED, |e| e.should_hit() && e.meeting.determinant < 0.0),
    (&shape::PARALLELOGRAM, |e| is_on_segment(e) && is_inside_of(e, [1, 2])),
    (&shape::V_NOT_COMPARED, |e| is_on_segment(e) && is_inside_of(e, [0, 2])),
    (&shape::W_NOT_COMPARED, |e| is_on_segment(e) && is_inside_of(e, [0, 1])),
    (&shape::WHOLE_PLANE_HIT, is_on_segment),
    (&shape::SEGMENT_END_IGNORED, |e| is_inside(e) && e.meeting.t > 0.0),
    (&shape::SEGMENT_IGNORED, is_inside),
    (&shape::HITS_BEHIND_ORIGIN, |e| is_inside(e) && e.meeting.t < e.t_max),
];

fn is_inside(e: &Encounter) -> bool {
    is_inside_of(e, [0, 1, 2])
}

/// Whether the weights of these vertices are not negative.
fn is_inside_of<const N: usize>(e: &Encounter, vertices: [usize; N]) -> bool {
    vertices.iter().all(|vertex| e.meeting.weights[*vertex] >= 0.0)
}

fn is_on_segment(e: &Encounter) -> bool {
    e.meeting.t > 0.0 && e.meeting.t < e.t_max
}

/// The mistake that explains every clear ray, if one does, and what speaks for it.
pub(super) fn explanation(encounters: &[Encounter]) -> Option<(&'static Cause, String)> {
    // Where nothing is hit any rule that has no hits here fits.
    if encounters.iter().all(|e| e.found.is_none()) {
        return None;
    }
    if encounters.iter().filter_map(Encounter::t_compared).any(|t| !t.agrees()) {
        return None;
    }
    let follows = |hits: Rule| encounters.iter().all(|e| hits(e) == e.found.is_some());
    let evidence = || format!("predicts which of {} clear rays hit", encounters.len());
    let rule = RULES.iter().find(|(_, hits)| follows(*hits)).map(|(cause, _)| (*cause, evidence()));
    rule.or_else(|| threshold(encounters))
}

/// Hits are lost exactly where the determinant is small: its size says nothing about parallelism.
fn threshold(encounters: &[Encounter]) -> Option<(&'static Cause, String)> {
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
