//! A ray at a box and whether it meets it, as a case says it and as exact arithmetic has it.

use super::exact_overlap::Overlap;
use crate::checks::Measure;
use crate::checks::phrase::instead;
use crate::checks::ray_row::{RayRow, hits_measure, ray_row};
use crate::contract::{BoxHit, Ray};
use crate::scene::Aabb;
use crate::text::Vector;
use serde::Deserialize;

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BoxEntry {
    min: Vector,
    max: Vector,
}

ray_row! {
    /// A ray segment, and whether it meets the closed box.
    pub(super) struct Row {
        r#box: Option<BoxEntry>,
    }
}

impl Row {
    /// Its own box, or that of all rows.
    pub(super) fn bounds(&self, common: BoxEntry) -> Aabb {
        let BoxEntry { min, max } = self.r#box.unwrap_or(common);
        Aabb { min: min.0, max: max.0 }
    }
}

/// Whether it hits; and if it does and should, from where to where.
pub(super) fn measures(
    row: &Row,
    number: usize,
    bounds: &Aabb,
    answer: &BoxHit,
    allowed: f64,
) -> Vec<Measure> {
    let hits = answer.hit == 1;
    let truth = Overlap::exact(bounds, &row.ray()).filter(|truth| truth.hits && hits);
    let end = |what, found, right: f64| Measure::exact(what, found, right, allowed * right.abs());
    let mut measures = vec![hits_measure(hits, row.hits)];
    measures.extend(truth.map(|truth| end("t_enter", answer.t_enter, truth.enters)));
    measures.extend(truth.map(|truth| end("t_exit", answer.t_exit, truth.exits)));
    measures.into_iter().map(|measure| measure.of_row(row.label(number))).collect()
}

pub(super) fn complaint(row: &Row, number: usize, answer: &BoxHit, worst: &Measure) -> String {
    let label = row.label(number);
    match (answer.hit == 1, row.hits) {
        (true, false) => format!("{label} hits, and should miss"),
        (false, true) => format!("{label} misses, and should hit"),
        _ => instead(worst),
    }
}
