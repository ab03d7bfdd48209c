//! The rays that a core makes for cameras, against formulas of projection.

use super::film_law;
use super::projection::{MISTAKES, Mistake, Projection, projection};
use crate::cause::{Cause, camera};
use crate::checks::few::{Few, few_that_fit};
use crate::checks::phrase::{degrees, some_are};
use crate::checks::{Finding, Measure};
use crate::contract::Ray;
use crate::math::sphere::angle_between;
use crate::scene::Camera;
use crate::stats::{Compared, ExactReport, judge_exact};
use glam::{DVec2, DVec3};

/// A camera and the rays a core made for it.
pub(super) struct Shot {
    pub(super) camera: Camera,
    pub(super) rays: Vec<Ray>,
}

impl Shot {
    fn direction_errors<'a>(
        &'a self,
        film: &'a [DVec2],
        formula: Projection,
    ) -> impl Iterator<Item = f64> + 'a {
        let expected =
            film.iter().map(move |point| formula.direction(&self.camera, *point).normalize());
        self.rays.iter().zip(expected).map(|(ray, d)| ray.direction.distance(d))
    }

    /// Directions, origins, and the ends of the segments. Single precision rounds positions relative to their size.
    fn reports(&self, film: &[DVec2], allowed: f64) -> [(&'static str, ExactReport); 4] {
        let Camera { position, near, far, .. } = self.camera;
        let directions = self.direction_errors(film, Projection::RIGHT);
        let compare = |error| Compared::within(error, 0.0, allowed);
        let size = position.length().max(1.0);
        let origins = self.rays.iter().map(|ray| ray.origin.distance(position) / size);
        let end = |found, expected| Compared::relative(found, expected, allowed);
        [
            ("direction", judge_exact(directions.map(compare))),
            ("origin", judge_exact(origins.map(compare))),
            ("t_min", judge_exact(self.rays.iter().map(|ray| end(ray.t_min, near)))),
            ("t_max", judge_exact(self.rays.iter().map(|ray| end(ray.t_max, far)))),
        ]
    }
}

/// What is found of the rays of some cameras through these film points.
pub(super) fn judge(shots: &[Shot], film: &[DVec2], allowed: f64) -> Finding {
    let mut measures = Vec::new();
    let mut complaints = Vec::new();
    for (number, shot) in shots.iter().enumerate() {
        for (what, report) in shot.reports(film, allowed) {
            let row = format!("camera {}", number + 1);
            measures.push(Measure::worst(what, &report).of_row(row));
            if report.disagree > 0 && what != "direction" {
                complaints.push(complaint(number, what, &measures[measures.len() - 1]));
            }
        }
    }
    complaints.dedup();
    let explained = explanation(shots, film, allowed);
    complaints.splice(0..0, direction_complaint(shots, film, allowed, &explained));
    let all = shots.len() * film.len();
    let right = format!("{all} rays of {} cameras leave through their film points", shots.len());
    let resolution = format!("would have caught a ray {} off", degrees(allowed));
    let elsewhere = causes_elsewhere(shots, &measures, allowed);
    let laws = if explained.is_empty() { film_law::laws(shots, film) } else { Vec::new() };
    Finding::of(right, resolution, measures)
        .complaining(complaints)
        .because_few(explained, &format!("predicts the directions of all {all} rays"))
        .because_all(elsewhere, "the directions have no part in it")
        .by_law(laws)
}

/// What is wrong beside directions.
fn causes_elsewhere(shots: &[Shot], measures: &[Measure], allowed: f64) -> Vec<&'static Cause> {
    let fails = |what: &str| measures.iter().any(|m| m.failed() && m.quantity.starts_with(what));
    let origin = fails("origin").then_some(&camera::ORIGIN_NOT_AT_CAMERA);
    let ends = [fails("t_min"), fails("t_max")];
    let clips = ends.contains(&true).then(|| mistake_of_clips(shots, ends, allowed)).flatten();
    origin.into_iter().chain(clips).collect()
}

/// What makes those ends of segments that are wrong: t_min, t_max.
fn mistake_of_clips(shots: &[Shot], wrong: [bool; 2], allowed: f64) -> Option<&'static Cause> {
    let rays = || shots.iter().flat_map(|shot| shot.rays.iter().map(move |ray| (shot, ray)));
    let ends = |ray: &Ray| [ray.t_min, ray.t_max];
    let first = rays().next().map(|(_, ray)| ends(ray))?;
    let is_same = |end: usize| rays().all(|(_, ray)| ends(ray)[end] == first[end]);
    let is_along_axis = |(shot, ray): (&Shot, &Ray)| {
        let Camera { camera_to_world, near, far, .. } = shot.camera;
        let cosine = ray.direction.normalize().dot(camera_to_world * DVec3::NEG_Z);
        let on_axis = ends(ray).map(|end| end * cosine);
        on_axis.iter().zip([near, far]).all(|(end, clip)| (end / clip - 1.0).abs() <= allowed)
    };
    // Whatever the camera, they are the same.
    if (0..2).all(|end| !wrong[end] || is_same(end)) {
        Some(&camera::CLIPS_NOT_SET)
    } else {
        rays().all(is_along_axis).then_some(&camera::CLIPS_ALONG_AXIS)
    }
}

fn complaint(camera: usize, what: &str, worst: &Measure) -> String {
    let camera = camera + 1;
    match what {
        "origin" => format!("the rays of camera {camera} do not start at its position"),
        end => format!(
            "{end} of the rays of camera {camera} is {}, not the camera's {}",
            worst.measured, worst.expected
        ),
    }
}

/// How many directions are wrong, by how much, and why.
fn direction_complaint(
    shots: &[Shot],
    film: &[DVec2],
    allowed: f64,
    explained: &Few<&'static Cause>,
) -> Option<String> {
    let all = shots.len() * film.len();
    let wrong =
        all - errors(shots, film, Projection::RIGHT).filter(|error| *error <= allowed).count();
    if wrong == 0 {
        return None;
    }
    let by = degrees(largest_angle(shots, film));
    let why = match explained.is_empty() {
        true => "no mistake that is known explains all of them".to_owned(),
        false => explained.words(),
    };
    Some(format!("{} wrong by up to {by}: {why}", some_are(wrong, all, "rays")))
}

/// The mistakes that predict every direction, the right ones among them.
fn explanation(shots: &[Shot], film: &[DVec2], allowed: f64) -> Few<&'static Cause> {
    // A mistake may magnify rounding, but not a hundredfold; different mistakes are degrees apart.
    let explains = |made: &[&Mistake]| {
        let formula =
            made.iter().fold(Projection::RIGHT, |right, mistake| (mistake.made_in)(right));
        errors(shots, film, formula).all(|error| error <= 100.0 * allowed)
    };
    few_that_fit(MISTAKES, explains).map(|mistake| mistake.cause)
}

/// How far each direction is from what a formula makes it.
fn errors<'a>(
    shots: &'a [Shot],
    film: &'a [DVec2],
    formula: Projection,
) -> impl Iterator<Item = f64> + 'a {
    shots.iter().flat_map(move |shot| shot.direction_errors(film, formula))
}

fn largest_angle(shots: &[Shot], film: &[DVec2]) -> f64 {
    let angles = shots.iter().flat_map(|shot| {
        let expected = film.iter().map(|point| projection(&shot.camera, *point));
        shot.rays.iter().zip(expected).map(|(ray, d)| angle_between(ray.direction, d))
    });
    angles.fold(0.0, f64::max)
}
