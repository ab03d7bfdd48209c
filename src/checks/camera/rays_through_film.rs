//! Camera rays against the projection formula.
//!
//! Not here: directions whose length is not 1, which the contract refuses before a check sees them.

use super::shots::{Shot, judge};
use crate::checks::{Check, CheckError, Context, Finding, check};
use crate::contract::Ray;
use crate::math::rng::{Seed, in_square};
use crate::scene::Camera;
use crate::stats::Tolerance;
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
        let Self { position, target, up, horizontal_fov, .. } = self;
        Camera {
            vertical_fov: self.vertical_fov.0,
            near: self.near.0,
            far: self.far.0,
            ..Camera::look_at(position.0, target.0, up.0, horizontal_fov.0, [480, 360])
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
    let fixed = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0], [0.5, 0.5]].map(DVec2::from);
    let generic = (0..GENERIC_POINTS).map(|_| in_square(&mut stream));
    fixed.into_iter().chain(generic).collect()
}

#[cfg(test)]
mod tests {
    use super::super::projection::{MISTAKES, Projection, projection};
    use super::*;
    use crate::cause::{Cause, camera};
    use crate::checks::fake::Fake;
    use crate::checks::testing::{assert_passes, check_of, failure, judge, try_judge};
    use glam::DVec3;

    /// A core that makes its rays by a formula and then does something to them.
    fn lens(
        formula: impl Fn(&Camera, DVec2) -> DVec3 + Send + 'static,
        spoil: fn(&mut Ray),
    ) -> Fake {
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

    fn found(formula: impl Fn(&Camera, DVec2) -> DVec3 + Send + 'static) -> Finding {
        judge(&shipped(), &mut lens(formula, |_| ()))
    }

    #[test]
    fn the_projection_formula_passes() {
        assert_passes(&found(projection));
    }

    #[test]
    fn every_mistake_fails_under_its_own_name() {
        for mistake in MISTAKES {
            let wrong = (mistake.made_in)(Projection::RIGHT);
            let finding = found(move |camera, film| wrong.direction(camera, film));
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
    fn two_mistakes_of_different_steps_are_told_together() {
        let of = |wanted: &Cause| MISTAKES.iter().find(|m| m.cause == wanted).unwrap().made_in;
        let both = of(&camera::CAMERA_TO_WORLD_FORGOTTEN)(Projection::RIGHT);
        let both = of(&camera::FOV_NOT_HALVED)(both);
        let finding = found(move |camera, film| both.direction(camera, film));
        let told: Vec<_> =
            finding.clues.iter().map(|clue| (&clue.cause[..], clue.beside)).collect();
        let [view, world] = [&camera::FOV_NOT_HALVED, &camera::CAMERA_TO_WORLD_FORGOTTEN];
        assert_eq!(told, [(view.name, true), (world.name, true)]);
    }

    #[test]
    fn a_mistake_nobody_knows_is_not_given_a_name() {
        let finding = found(|camera, film| projection(camera, film * film));
        assert!(failure(&finding).ends_with("no mistake that is known explains all of them"));
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
