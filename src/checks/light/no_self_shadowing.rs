//! Whatever the camera sees, a light at the camera illuminates: shadow rays are camera rays reversed. Else: shadow acne.
//!
//! So a point of light is put where the camera is, all other lights out, and every point of a diffuse surface that
//! is seen has to have the radiance that its distance and its angle say. A dark one lies in its own shadow. Where a core
//! makes an estimate of it, so that seeds differ, only the mean is compared.

use super::seen_points::{INTENSITY, MISTAKES, Point, Seen};
use crate::cause::light as cause;
use crate::checks::integrator::{lit_by, settings};
use crate::checks::numbers::Numbers;
use crate::checks::phrase::{figure, percent};
use crate::checks::{Check, CheckError, Context, Finding, Measure, Result, camera_of, check};
use crate::contract::{
    Acceleration, BuiltScene, DirectSampling, Falloff, Hit, IntegratorSettings, Ray,
};
use crate::math::rng::Seed;
use crate::scene::{Light, Rgb, SceneDescription, Surface};
use crate::stats::{
    Band, Claim, Effort, MeanReport, Rarity, Tolerance, Verdict, judge_means, judge_rare,
};
use crate::text::{Count, Percent, Several};

/// Seen under a flatter angle than this cosine, a surface may well hide behind its own rounding.
const GRAZING: f64 = 0.01;
/// The smallest error of a mean that must be seen, and the most paths that may be spent on it.
const MEAN_DETECTS: Percent = Percent(0.02);
const MEAN_AT_MOST: Count = Count(4_000_000);
/// How often points that are dark are asked again: rare bright estimates are no shadow.
const LOOKS_AT_DARK: u64 = 16;

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
            match self.ask(context, name, &mut exact_points)? {
                Some(points) => seen.push(Seen { scene: name, points }),
                None => return self.estimated(context),
            }
        }
        let precision = context.info.precision;
        Ok(finding(&seen, Tolerance::FORMULA.of(precision), Rarity::OWN_SHADOWS.of(precision)))
    }
}

/// The rays to points that the camera sees, and the points, in a scene that a light at the camera illuminates.
type Question<'a, T> = &'a mut dyn FnMut(&mut dyn BuiltScene, &[Ray], &[Point], Seed) -> Result<T>;

impl NoSelfShadowing {
    fn ask<T>(
        &self,
        context: &mut Context<'_>,
        name: &str,
        question: Question<'_, T>,
    ) -> Result<T> {
        let scene = context.load(name)?;
        let seed = context.seed.child(name);
        let camera = camera_of(&scene)?;
        let light = Light::Point { position: camera.position, intensity: INTENSITY };
        let scene = lit_by(&scene, light);
        let film = Numbers::new(seed, self.rays.0 as usize).points;
        let mut rays = vec![Ray::new(camera.position, camera.camera_to_world.z_axis); film.len()];
        context.core.generate_rays(&camera, &film, &mut rays)?;
        let falloff = context.info.conventions.point_light_falloff;
        let mut built = context.core.build_scene(&scene, Acceleration::DEFAULT)?;
        let (rays, points) = lit_points(built.as_mut(), &scene, falloff, rays)?;
        question(built.as_mut(), &rays, &points, seed)
    }

    /// Of a core that makes estimates even of this, as it may: the mean over points and seeds.
    fn estimated(&self, context: &mut Context<'_>) -> Result<Finding> {
        let effort = context.effort(MEAN_DETECTS, MEAN_AT_MOST);
        let mut measures = Vec::new();
        for name in self.scenes.iter() {
            let report = self.ask(context, name, &mut |built, rays, points, seed| {
                mean_over_what_is_right(built, rays, points, seed, effort)
            })?;
            measures.push(Measure::of("mean of radiance over what is right", &report).of_row(name));
        }
        Ok(of_estimates(measures))
    }
}

/// The points with their radiance, if that is no estimate: if no seed changes anything, and what is dark stays so.
fn exact_points(
    built: &mut dyn BuiltScene,
    rays: &[Ray],
    points: &[Point],
    seed: Seed,
) -> Result<Option<Vec<Point>>> {
    let once = radiance(built, rays, seed.child("once"))?;
    if once != radiance(built, rays, seed.child("again"))? {
        return Ok(None);
    }
    let dark = rays.iter().zip(&once).filter(|(_, radiance)| **radiance == [0.0; 3]);
    let dark: Vec<Ray> = dark.map(|(ray, _)| *ray).collect();
    for look in 0..if dark.is_empty() { 0 } else { LOOKS_AT_DARK } {
        let found = radiance(built, &dark, seed.child("dark").child(look))?;
        if found.iter().any(|radiance| *radiance != [0.0; 3]) {
            return Ok(None);
        }
    }
    let known = points.iter().zip(once);
    Ok(Some(known.map(|(point, radiance)| Point { radiance, ..*point }).collect()))
}

fn mean_over_what_is_right(
    built: &mut dyn BuiltScene,
    rays: &[Ray],
    points: &[Point],
    seed: Seed,
    effort: Effort,
) -> Result<MeanReport> {
    let at_once = rays.len().max(1) as u64;
    let claims = [Claim::value(1.0, Band::RADIANCE)];
    let mut reports = judge_means(&claims, &effort.in_steps_of(at_once), &mut |draw| {
        let looks = draw.samples / at_once;
        let mut sum = 0.0;
        for look in 0..looks {
            sum += mean_share(points, &radiance(built, rays, draw.seed(seed).child(look))?);
        }
        Ok::<_, CheckError>(vec![sum / looks as f64])
    })?;
    Ok(reports.remove(0))
}

/// The rays that meet a diffuse surface, and where; nothing is known of its radiance yet.
fn lit_points(
    built: &mut dyn BuiltScene,
    scene: &SceneDescription,
    falloff: Falloff,
    rays: Vec<Ray>,
) -> Result<(Vec<Ray>, Vec<Point>)> {
    let mut hits = vec![Hit::MISS; rays.len()];
    built.intersect(&rays, &mut hits)?;
    let point = |ray: &Ray, hit: &Hit| {
        let Surface::Diffuse { reflectance } = material(scene, hit)? else { return None };
        let cosine = hit.shading_normal.dot(ray.direction).abs();
        let (world_cosine, distance, radiance) = (ray.direction.z.abs(), hit.t, [0.0; 3]);
        let point = Point { distance, cosine, world_cosine, reflectance, falloff, radiance };
        (cosine > GRAZING && reflectance != [0.0; 3]).then_some(point)
    };
    let met = rays.iter().zip(&hits);
    Ok(met.filter_map(|(ray, hit)| Some((*ray, point(ray, hit)?))).unzip())
}

/// What light of the first bounce arrives along each ray.
fn radiance(built: &mut dyn BuiltScene, rays: &[Ray], seed: Seed) -> Result<Vec<Rgb>> {
    let bounces = settings([1, 1], DirectSampling::Lights);
    let bounces = IntegratorSettings { seed: seed.0, ..bounces };
    let mut radiance = vec![[0.0; 3]; rays.len()];
    built.radiance(rays, &bounces, &mut radiance)?;
    Ok(radiance)
}

/// The mean over points of the light of all channels, over what it should be.
fn mean_share(points: &[Point], found: &[Rgb]) -> f64 {
    let share = |(point, found): (&Point, &Rgb)| {
        found.iter().sum::<f64>() / (0..3).map(|channel| point.right(channel)).sum::<f64>()
    };
    points.iter().zip(found).map(share).sum::<f64>() / points.len() as f64
}

/// How the surface scatters that a ray has met.
fn material(scene: &SceneDescription, hit: &Hit) -> Option<Surface> {
    hit.is_hit().then(|| scene.material_of(hit.shape).surface)
}

/// Of a core that makes estimates everywhere.
fn of_estimates(estimated: Vec<Measure>) -> Finding {
    let failed = estimated.iter().find(|measure| measure.failed());
    let complaint = failed
        .map(|measure| format!("{} is {} instead of 1", measure.name(), figure(measure.measured)));
    Finding::measured("what the camera sees is as bright as a light there makes it", estimated)
        .complaining(complaint)
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
    if dark == points || rare.verdict == Verdict::Fail && !are_lit_by_a_law(all(), tolerance) {
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

/// Whether points that are not dark are as bright as they should be, by a mistake or all by one factor: where the light is
/// wrong otherwise, those that are dark need not be shadowed.
fn are_lit_by_a_law<'a>(points: impl Iterator<Item = &'a Point>, tolerance: f64) -> bool {
    let lit: Vec<_> = points.filter(|point| !point.is_dark()).collect();
    let Some(first) = lit.first() else { return false };
    let factor = first.radiance[0] / first.right(0);
    let is_by = |mistake| lit.iter().all(|point| point.is_by(mistake, tolerance));
    lit.iter().all(|point| point.is_times(factor, tolerance))
        || MISTAKES.iter().any(|(_, mistake)| is_by(*mistake))
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
    fn darkness_beside_light_that_follows_no_law_is_not_named() {
        let in_any_direction: Mistake = |point| (10.0 * point.distance).sin();
        assert!(seen(in_any_direction, 7).clues.is_empty());
        assert_eq!(causes(&seen(|_| 0.5, 7)), [cause::SHADOW_ACNE.name]);
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
