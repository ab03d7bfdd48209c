//! A ray at a primitive and what has to come out of it, as a case says it and as the geometry has it.

use super::imitation::Answer;
use crate::checks::Measure;
use crate::checks::phrase::{figure, instead};
use crate::checks::ray_row::{RayRow, hits_measure, ray_row};
use crate::contract::{Hit, Precision, Ray};
use crate::stats::Tolerance;
use glam::DVec3;

/// How far the numbers of a row may be from its own geometry: they are typed with this many digits.
const TYPED: f64 = 1e-6;

ray_row! {
    /// A ray segment and what has to come out of it. What a row does not say is known from the geometry.
    pub(super) struct Row {
        t: Option<f64>,
        normal: Option<DVec3>,
        shading_normal: Option<DVec3>,
        barycentric: Option<[f64; 3]>,
    }
}

impl Row {
    /// Whether the row says what the geometry says.
    pub(super) fn is_true_of(&self, answer: Option<&Answer>) -> bool {
        let Some(answer) = answer else { return !self.hits };
        let near = |typed: Option<DVec3>, known: DVec3| {
            typed.is_none_or(|typed| typed.distance(known) <= TYPED)
        };
        let weights = self.barycentric.is_none_or(|typed| {
            answer.weights.is_some_and(|known| DVec3::from(typed).distance(known.into()) <= TYPED)
        });
        self.hits
            && self.t.is_some_and(|t| (t - answer.t).abs() <= TYPED * answer.t.abs())
            && near(self.normal, answer.geometric_normal)
            && near(self.shading_normal, answer.shading_normal)
            && weights
    }
}

/// Whether it hits; and if it does and should, where, with which normals and weights.
pub(super) fn measures(
    row: &Row,
    number: usize,
    answer: Option<&Answer>,
    hit: &Hit,
    precision: Precision,
) -> Vec<Measure> {
    let label = row.label(number);
    let hits = hits_measure(hit.is_hit(), row.hits).of_row(&label);
    let (true, Some(answer)) = (hit.is_hit() && row.hits, answer) else { return vec![hits] };
    let intersection = Tolerance::INTERSECTION.of(precision);
    let direction = Tolerance::DIRECTION.of(precision);
    let error = |what: &str, error: f64, allowed: f64| {
        Measure::exact(format!("error of the {what}"), error, 0.0, allowed).of_row(&label)
    };
    let geometric = hit.geometric_normal.distance(answer.geometric_normal);
    let shading = hit.shading_normal.distance(answer.shading_normal);
    let mut measures = vec![
        hits,
        Measure::exact("t", hit.t, answer.t, intersection * answer.t.abs()).of_row(&label),
        error("geometric normal", geometric, direction),
        error("shading normal", shading, direction),
    ];
    if let Some([_, v, w]) = answer.weights {
        let off = (hit.uv.x - v).abs().max((hit.uv.y - w).abs());
        measures.push(error("barycentric weights", off, intersection));
    }
    measures
}

pub(super) fn complaint(
    row: &Row,
    number: usize,
    answer: Option<&Answer>,
    hit: &Hit,
    worst: &Measure,
) -> String {
    let label = row.label(number);
    match (hit.is_hit(), answer) {
        (true, None) => format!("{label} hits at t = {}; it should miss", figure(hit.t)),
        (false, Some(right)) => format!("{label} misses; it should hit at t = {}", figure(right.t)),
        _ if worst.expected == 0.0 => format!("{} is {}", worst.name(), figure(worst.measured)),
        _ => instead(worst),
    }
}
