//! Whatever the camera sees, a light at the camera illuminates: shadow rays are camera rays reversed. Else: shadow acne.
//!
//! So a point of light is put where the camera is, all other lights out, and every point of a diffuse surface that
//! is seen has to have the radiance that its distance and its angle say. A dark one lies in its own shadow.

use super::seen_points::{INTENSITY, MISTAKES, Point, Seen};
use crate::cause::light as cause;
use crate::checks::integrator::{lit_by, settings};
use crate::checks::numbers::Numbers;
use crate::checks::phrase::percent;
use crate::checks::{Check, Context, Finding, Measure, Result, camera_of, check};
use crate::contract::{Acceleration, DirectSampling, Hit, Ray};
use crate::math::rng::Seed;
use crate::scene::{Light, Rgb, SceneDescription, Surface};
use crate::stats::{Rarity, Tolerance, Verdict, judge_rare};
use crate::text::{Count, Several};

/// Seen under a flatter angle than this cosine, a surface may well hide behind its own rounding.
const GRAZING: f64 = 0.01;
check! {
    pub(crate) struct NoSelfShadowing {
        scenes: Several<String>,
        /// Rays through the film of each scene.
        rays: Count,
    }
    name: "no-self-shadowing",
    summary: "a point light at the camera lights all that is seen: no surface shadows itself",
    needs: BUILD_SCENE | GENERATE_RAYS | INTERSECT | RADIANCE,
}

impl Check for NoSelfShadowing {
    fn scenes(&self) -> &[String] {
        &self.scenes
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding> {
        let mut seen = Vec::new();
        for name in self.scenes.iter() {
            let scene = context.load(name)?;
            let seed = context.seed.child(name);
            seen.push(Seen { scene: name, points: self.points(context, &scene, seed)? });
        }
        let precision = context.info.precision;
        Ok(finding(&seen, Tolerance::FORMULA.of(precision), Rarity::OWN_SHADOWS.of(precision)))
    }
}

impl NoSelfShadowing {
    fn points(
        &self,
        context: &mut Context<'_>,
        scene: &SceneDescription,
        seed: Seed,
    ) -> Result<Vec<Point>> {
        let camera = camera_of(scene)?;
        let light = Light::Point { position: camera.position, intensity: INTENSITY };
        let scene = lit_by(scene, light);
        let film = Numbers::new(seed, self.rays.0 as usize).points;
        let mut rays = vec![Ray::new(camera.position, camera.camera_to_world.z_axis); film.len()];
        context.core.generate_rays(&camera, &film, &mut rays)?;
        let falloff = context.info.conventions.point_light_falloff;
        let mut built = context.core.build_scene(&scene, Acceleration::DEFAULT)?;
        let mut hits = vec![Hit::MISS; rays.len()];
        built.intersect(&rays, &mut hits)?;
        let mut radiance = vec![[0.0; 3]; rays.len()];
        let bounces = settings([1, 1], DirectSampling::Lights);
        built.radiance(&rays, &bounces, &mut radiance)?;
        let met = rays.iter().zip(&hits).zip(radiance);
        let point = |((ray, hit), radiance): ((&Ray, &Hit), Rgb)| {
            let Surface::Diffuse { reflectance } = material(&scene, hit)? else { return None };
            let cosine = hit.shading_normal.dot(ray.direction).abs();
            let world_cosine = ray.direction.z.abs();
            let distance = hit.t;
            let point = Point { distance, cosine, world_cosine, reflectance, falloff, radiance };
            (cosine > GRAZING && reflectance != [0.0; 3]).then_some(point)
        };
        Ok(met.filter_map(point).collect())
    }
}

/// How the surface scatters that a ray has met.
fn material(scene: &SceneDescription, hit: &Hit) -> Option<Surface> {
    hit.is_hit().then(|| scene.material_of(hit.shape).surface)
}

fn finding(seen: &[Seen<'_>], tolerance: f64, allowed: f64) -> Finding {
    let all = || seen.iter().flat_map(|one| &one.points);
    let (points, dark) = (all().count(), all().filter(|point| point.is_dark()).count());
    let rare = judge_rare(dark as u64, points as u64, allowed);
    let mut measures = vec![Measure::of("share of points in their own shadow", &rare)];
    measures.extend(seen.iter().flat_map(|one| one.measures(tolerance)));
    let resolution = format!(
        "would have caught {} of dark points, and an error of {}",
        percent(rare.resolution),
        percent(tolerance)
    );
    let mut complaints: Vec<_> = seen.iter().filter_map(|one| one.complaint(tolerance)).collect();
    if rare.verdict == Verdict::Fail {
        complaints.extend(seen.iter().filter_map(Seen::darkness));
    }
    if complaints.is_empty() {
        let lit = points - dark;
        let right = format!("a point light at the camera lights {lit} of {points} points seen");
        return Finding::of(right, resolution, measures);
    }
    let finding = Finding::of(complaints.join("; "), resolution, measures);
    if dark == points {
        finding
    } else if rare.verdict == Verdict::Fail {
        let evidence = format!("{dark} of {points} points that light at the camera has to reach");
        finding.because(&cause::SHADOW_ACNE, evidence)
    } else {
        let predicts = |mistake| all().all(|point| point.is_by(mistake, tolerance));
        let made = MISTAKES.iter().filter(|(_, mistake)| predicts(*mistake));
        let evidence = format!("predicts the radiance of {points} points");
        finding.because_each(made.map(|(cause, _)| *cause), &evidence)
    }
}

#[cfg(test)]
mod tests {
    use super::super::seen_points::Mistake;
    use super::*;
    use crate::checks::testing::{assert_passes, causes, failure};
    use crate::contract::Falloff;

    /// Points in general position, with the radiance of a mistake.
    fn seen(share: Mistake, dark: usize) -> Finding {
        let points = (0..100).map(|i| {
            let turn = f64::from(i) / 100.0;
            let mut point = Point {
                distance: 0.5 + 3.0 * turn,
                cosine: 0.1 + 0.8 * turn * turn,
                world_cosine: 0.9 - 0.5 * turn,
                reflectance: [0.37, 0.53, 0.71],
                falloff: Falloff::InverseSquare,
                radiance: [0.0; 3],
            };
            let lit = if (i as usize) < dark { 0.0 } else { share(&point) };
            point.radiance = [0, 1, 2].map(|channel| lit * point.right(channel));
            point
        });
        finding(&[Seen { scene: "a scene", points: points.collect() }], 1e-6, 1e-4)
    }

    #[test]
    fn all_points_lit_pass() {
        assert_passes(&seen(|_| 1.0, 0));
    }

    #[test]
    fn points_in_their_own_shadow_are_counted_and_named() {
        let finding = seen(|_| 1.0, 7);
        assert!(failure(&finding).contains("7 of 100 points that the camera sees are dark"));
        assert_eq!(finding.clues[0].cause, cause::SHADOW_ACNE.name);
    }

    #[test]
    fn a_point_where_surfaces_cross_may_be_dark() {
        assert_passes(&seen(|_| 1.0, 1));
    }

    #[test]
    fn a_light_that_lights_nothing_is_no_shadow() {
        assert!(seen(|_| 1.0, 100).clues.is_empty());
    }

    #[test]
    fn every_mistake_is_named() {
        for (cause, mistake) in MISTAKES {
            assert_eq!(causes(&seen(*mistake, 0)), [cause.name]);
        }
    }

    #[test]
    fn nothing_seen_is_no_pass() {
        let nothing = finding(&[Seen { scene: "empty", points: Vec::new() }], 1e-6, 1e-4);
        assert_ne!(nothing.verdict, Verdict::Pass);
    }
}
