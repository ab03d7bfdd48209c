//! Camera rays against the projection formula.
//!
//! Not here: directions whose length is not 1, which the contract refuses before a check sees them.

use super::projection::{Formula, MISTAKES, Mistake, projection};
use crate::cause::{self, Cause};
use crate::checks::phrase::{degrees, some_are};
use crate::checks::{Check, CheckError, Context, Finding, Measure, check};
use crate::contract::Ray;
use crate::math::rng::{Seed, uniform};
use crate::math::sphere::angle_between;
use crate::scene::Camera;
use crate::stats::{Compared, ExactReport, Tolerance, judge_exact};
use crate::text::{Arrow, Polar, Positive, Several, Vector};
use glam::{DVec2, DVec3};
use serde::Deserialize;
use std::f64::consts::PI;

/// Film points in general position, beside the four corners and the centre.
const GENERIC_POINTS: usize = 48;

check! {
    /// Rays leave the camera through the film points they are asked for.
    pub(crate) struct RaysThroughFilm {
        /// Cameras in general position: no angle, axis or coordinate that hides a mistake.
        camera: Several<CameraRow>,
    }
    name: "rays-through-film",
    summary: "camera rays against the projection formula",
    needs: GENERATE_RAYS,
}

/// A camera as a case writes it.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct CameraRow {
    position: Vector,
    target: Vector,
    up: Arrow,
    horizontal_fov: Polar,
    vertical_fov: Polar,
    near: Positive,
    far: Positive,
}

impl CameraRow {
    fn camera(&self) -> Camera {
        let film = [480, 360];
        Camera {
            vertical_fov: self.vertical_fov.0,
            near: self.near.0,
            far: self.far.0,
            ..Camera::look_at(
                self.position.0,
                self.target.0,
                self.up.0,
                self.horizontal_fov.0,
                film,
            )
        }
    }
}

impl Check for RaysThroughFilm {
    fn validate(&self) -> Result<(), String> {
        let is_camera = |row: &CameraRow| {
            let view = row.target.0 - row.position.0;
            let opens = |angle: Polar| 0.0 < angle.0 && angle.0 < PI;
            view.cross(row.up.0).try_normalize().is_some()
                && opens(row.horizontal_fov)
                && opens(row.vertical_fov)
                && row.near.0 < row.far.0
        };
        match self.camera.iter().position(|row| !is_camera(row)) {
            None => Ok(()),
            Some(number) => Err(format!(
                "camera {} needs a target beside its `up`, fields of view between 0 and 180 deg, \
                 and `near` before `far`",
                number + 1
            )),
        }
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let film = film_points(context.seed);
        let mut shots = Vec::new();
        for row in self.camera.iter() {
            let camera = row.camera();
            let mut rays = vec![Ray::new(DVec3::ZERO, DVec3::ZERO); film.len()];
            context.core.generate_rays(&camera, &film, &mut rays)?;
            shots.push(Shot { camera, rays });
        }
        let allowed = Tolerance::DIRECTION.of(context.info.precision);
        Ok(judge(&shots, &film, allowed))
    }
}

/// The corners, the centre, and points in general position.
fn film_points(seed: Seed) -> Vec<DVec2> {
    let mut stream = seed.child("film").stream();
    let fixed = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0], [0.5, 0.5]];
    let generic = (0..GENERIC_POINTS).map(|_| [uniform(&mut stream), uniform(&mut stream)]);
    fixed.into_iter().chain(generic).map(DVec2::from).collect()
}

/// A camera and the rays a core made for it.
struct Shot {
    camera: Camera,
    rays: Vec<Ray>,
}

impl Shot {
    fn direction_errors<'a>(
        &'a self,
        film: &'a [DVec2],
        formula: Formula,
    ) -> impl Iterator<Item = f64> + 'a {
        let expected = film.iter().map(move |point| formula(&self.camera, *point).normalize());
        self.rays.iter().zip(expected).map(|(ray, d)| ray.direction.distance(d))
    }

    /// Directions, origins, and the ends of the segments. Single precision rounds positions relative to their size.
    fn reports(&self, film: &[DVec2], allowed: f64) -> [(&'static str, ExactReport); 4] {
        let Camera { position, near, far, .. } = self.camera;
        let directions = self.direction_errors(film, projection);
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

fn judge(shots: &[Shot], film: &[DVec2], allowed: f64) -> Finding {
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
    complaints.splice(0..0, direction_complaint(shots, film, allowed, explained));
    let all = shots.len() * film.len();
    let right = format!("{all} rays of {} cameras leave through their film points", shots.len());
    let resolution = format!("would have caught a ray {} off", degrees(allowed));
    let elsewhere = causes_elsewhere(&measures);
    Finding::of(right, resolution, measures)
        .complaining(complaints)
        .because_each(explained, &format!("predicts the directions of all {all} rays"))
        .because_each(elsewhere, "the directions have no part in it")
}

/// What is wrong beside directions.
fn causes_elsewhere(measures: &[Measure]) -> Vec<&'static Cause> {
    let fails = |what: &str| measures.iter().any(|m| m.failed() && m.quantity.starts_with(what));
    let origin = fails("origin").then_some(&cause::camera::ORIGIN_NOT_AT_CAMERA);
    let clips = (fails("t_min") || fails("t_max")).then_some(&cause::camera::CLIPS_NOT_SET);
    origin.into_iter().chain(clips).collect()
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
    explained: Option<&Cause>,
) -> Option<String> {
    let all = shots.len() * film.len();
    let wrong = all - errors(shots, film, projection).filter(|error| *error <= allowed).count();
    if wrong == 0 {
        return None;
    }
    let by = degrees(largest_angle(shots, film));
    let why = explained
        .map_or("no single mistake that is known explains all of them", |cause| cause.headline);
    Some(format!("{} wrong by up to {by}: {why}", some_are(wrong, all, "rays")))
}

/// The mistake that predicts every direction, the right ones among them.
fn explanation(shots: &[Shot], film: &[DVec2], allowed: f64) -> Option<&'static Cause> {
    if errors(shots, film, projection).all(|error| error <= allowed) {
        return None;
    }
    // A mistake may magnify rounding, but not a hundredfold; different mistakes are degrees apart.
    let explains =
        |mistake: &&Mistake| errors(shots, film, mistake.formula).all(|e| e <= 100.0 * allowed);
    MISTAKES.iter().find(explains).map(|mistake| mistake.cause)
}

/// How far each direction is from what a formula makes it.
fn errors<'a>(
    shots: &'a [Shot],
    film: &'a [DVec2],
    formula: Formula,
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::fake::Fake;
    use crate::checks::testing::{assert_passes, check_of, failure, judge, try_judge};

    /// A core that makes its rays by a formula and then does something to them.
    fn lens(formula: Formula, spoil: fn(&mut Ray)) -> Fake {
        let ray = move |camera: &Camera, film| {
            let direction = formula(camera, film).normalize();
            let (t_min, t_max) = (camera.near, camera.far);
            let mut ray = Ray { origin: camera.position, t_min, direction, t_max };
            spoil(&mut ray);
            ray
        };
        Fake { ray: Box::new(ray), ..Fake::default() }
    }

    fn shipped() -> RaysThroughFilm {
        check_of(include_str!("../../../cases/camera/rays-pass-through-their-film-points.toml"))
    }

    fn found(formula: Formula) -> Finding {
        judge(&shipped(), &mut lens(formula, |_| ()))
    }

    #[test]
    fn the_projection_formula_passes() {
        assert_passes(&found(projection));
    }

    #[test]
    fn every_mistake_fails_under_its_own_name() {
        for mistake in MISTAKES {
            let finding = found(mistake.formula);
            let statement = failure(&finding);
            let Cause { name, headline, .. } = mistake.cause;
            assert!(statement.contains(headline), "{name}: {statement}");
            assert_eq!(finding.clues[0].cause, *name);
            assert_eq!(finding.clues.len(), 1);
        }
    }

    #[test]
    fn a_flipped_film_says_how_many_by_how_much_and_why() {
        let finding = found(|camera, film| projection(camera, DVec2::new(film.x, 1.0 - film.y)));
        let statement = failure(&finding);
        // The film's horizontal centre line is the same either way: the centre of each camera is right.
        assert!(statement.starts_with("156 of 159 rays are wrong by up to "), "{statement}");
        assert!(statement.ends_with("°: the film's y axis points down"), "{statement}");
    }

    #[test]
    fn a_mistake_nobody_knows_is_not_given_a_name() {
        let finding = found(|camera, film| projection(camera, film * film));
        assert!(
            failure(&finding).ends_with("no single mistake that is known explains all of them")
        );
        assert!(finding.clues.is_empty());
    }

    #[test]
    fn clip_distances_and_origins_are_looked_at() {
        let finding = judge(&shipped(), &mut lens(projection, |ray| ray.t_min = 0.0));
        assert!(failure(&finding).contains("t_min of the rays of camera 1 is 0, not the camera's"));
        assert_eq!(finding.clues[0].cause, "clips-not-set");
        let finding = judge(&shipped(), &mut lens(projection, |ray| ray.origin += 1e-6));
        assert!(failure(&finding).contains("do not start at its position"));
        assert_eq!(finding.clues[0].cause, "origin-not-at-camera");
    }

    #[test]
    fn directions_that_are_not_unit_break_the_contract() {
        let mut lens = lens(projection, |ray| ray.direction *= 1.01);
        let error = try_judge(&shipped(), &mut lens, None).unwrap_err().to_string();
        assert!(error.contains("direction has length 1.01"), "{error}");
    }
}
