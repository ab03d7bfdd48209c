//! The pdf of uniform points of a mesh light, right and wrong.

use crate::cause::{Cause, light};
use crate::checks::law::{Answered, Terms, law_of};
use crate::contract::{Hit, LightSample};
use crate::scene::{SceneDescription, Shape};
use glam::DVec3;

/// Two pdfs this close, relative, are the same; the wrong ones are far apart.
const SAME: f64 = 1e-3;

/// What a pdf is made of.
#[derive(Clone, Copy, Debug)]
pub struct Geometry {
    distance: f64,
    /// At the light.
    cosine: f64,
    /// At the surface that is lit.
    cosine_at_surface: f64,
    area: f64,
}

const TERMS: Terms = Terms {
    quantities: &["distance", "cos θ at the light", "cos θ at the surface", "area"],
    places: &[],
    right: "that of points uniform over the light",
};
/// Samples in which a law is looked for, about.
const LOOKED_AT: usize = 400;

type Formula = fn(&Geometry) -> f64;

/// Per steradian: distance² / (cos θ · area).
fn right(g: &Geometry) -> f64 {
    g.distance * g.distance / (g.cosine * g.area)
}

const MISTAKES: &[(&Cause, Formula)] = &[
    (&light::LIGHT_COSINE_FORGOTTEN, |g| right(g) * g.cosine),
    (&light::LIGHT_DISTANCE_FORGOTTEN, |g| 1.0 / (g.cosine * g.area)),
    (&light::LIGHT_PDF_PER_AREA, |g| 1.0 / g.area),
    (&light::LIGHT_DISTANCE_NOT_SQUARED, |g| right(g) / g.distance),
    (&light::LIGHT_AREA_FORGOTTEN, |g| right(g) * g.area),
    (&light::LIGHT_AREA_MULTIPLIED, |g| right(g) * g.area * g.area),
    (&light::LIGHT_PDF_INVERTED, |g| 1.0 / right(g)),
    (&light::LIGHT_SURFACE_COSINE, |g| right(g) * g.cosine / g.cosine_at_surface),
];

/// The mistake that predicts the pdf of every sample. Of a light whose pdf is right, and which fails all the
/// same, the points are not uniform. None of lights that are no meshes.
pub(crate) fn mistake(geometries: &[(Geometry, f64)]) -> Option<&'static Cause> {
    let predicts = |formula: Formula| {
        let same = |(g, pdf): &(Geometry, f64)| (pdf / formula(g) - 1.0).abs() <= SAME;
        !geometries.is_empty() && geometries.iter().all(same)
    };
    if predicts(right) {
        return Some(&light::LIGHT_POINTS_UNEVEN);
    }
    MISTAKES.iter().find(|(_, formula)| predicts(*formula)).map(|(cause, _)| *cause)
}

/// The law of pdfs that are not those of uniform points.
pub(crate) fn law(geometries: &[(Geometry, f64)], allowed: f64) -> Option<String> {
    let answered = |(g, pdf): &(Geometry, f64)| Answered {
        found: *pdf,
        right: right(g),
        quantities: vec![g.distance, g.cosine, g.cosine_at_surface, g.area],
        places: Vec::new(),
    };
    let apart = (geometries.len() / LOOKED_AT).max(1);
    let answers: Vec<_> = geometries.iter().step_by(apart).map(answered).collect();
    Some(format!("the pdf {}", law_of(TERMS, &answers, allowed)?))
}

impl Geometry {
    /// Of samples that met the light, each with its pdf.
    pub(crate) fn of(
        area: f64,
        normal: DVec3,
        samples: &[LightSample],
        hits: &[Hit],
    ) -> Vec<(Self, f64)> {
        let met = samples.iter().zip(hits).filter(|(_, hit)| hit.is_hit());
        met.map(|(sample, hit)| {
            let cosine = -sample.wi.dot(hit.geometric_normal);
            let cosine_at_surface = sample.wi.dot(normal);
            (Self { distance: sample.distance, cosine, cosine_at_surface, area }, sample.pdf)
        })
        .collect()
    }
}

/// The area of a mesh. A sphere may be sampled in many ways.
pub(crate) fn area_of(scene: &SceneDescription, shape: u32) -> Option<f64> {
    let Shape::Mesh(mesh) = scene.shape(shape) else { return None };
    let area = |number| {
        let [a, b, c] = mesh.corners(number);
        0.5 * (b - a).cross(c - a).length()
    };
    Some((0..mesh.indices.len()).map(area).sum())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn samples(formula: Formula) -> Vec<(Geometry, f64)> {
        let at = |i: u32| {
            let step = f64::from(i) / 10.0;
            let (distance, cosine) = (1.0 + step, 0.9 - 0.5 * step);
            Geometry { distance, cosine, cosine_at_surface: 0.3 + 0.4 * step, area: 0.7 }
        };
        (0..10).map(at).map(|g| (g, formula(&g))).collect()
    }

    #[test]
    fn every_mistake_is_told_from_the_others() {
        for (cause, formula) in MISTAKES {
            assert_eq!(mistake(&samples(*formula)), Some(*cause));
        }
        assert_eq!(mistake(&samples(right)), Some(&light::LIGHT_POINTS_UNEVEN));
        assert_eq!(mistake(&samples(|g| 1.1 * right(g))), None);
    }
}
