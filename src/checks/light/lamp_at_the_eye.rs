//! Whatever an eye sees, a lamp at the eye lights: the shadow ray is the camera's ray, reversed.
//!
//! So a point of light is put where the camera is, all other lights out, and every point of a diffuse surface that
//! is seen has to have the radiance that its distance and its angle say. A dark one lies in its own shadow.

use crate::cause::{Cause, bsdf, light as cause};
use crate::checks::integrator::settings;
use crate::checks::phrase::{figure, percent, some_are};
use crate::checks::{Check, CheckError, Context, Finding, Measure, camera_of};
use crate::contract::{Acceleration, Capabilities, DirectSampling, Falloff, Hit, Ray};
use crate::image::CHANNELS;
use crate::math::rng::{Seed, uniform};
use crate::scene::{Light, Rgb, SceneDescription, Surface};
use crate::stats::{Compared, Rarity, Tolerance, Verdict, judge_exact, judge_rare};
use crate::text::{Count, Several};
use glam::DVec2;
use serde::Deserialize;
use std::f64::consts::{FRAC_1_PI, PI};

/// Of the lamp, in general position.
const INTENSITY: Rgb = [2.0, 3.0, 5.0];
/// Seen under a flatter angle than this cosine, a surface may well hide behind its own rounding.
const GRAZING: f64 = 0.01;
/// A mistake may magnify rounding, but not a hundredfold.
const LIKENESS: f64 = 100.0;

/// Random rays of the cameras of some scenes.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct LampAtTheEye {
    scenes: Several<String>,
    /// Rays through the film of each scene.
    rays: Count,
}

impl Check for LampAtTheEye {
    const NAME: &'static str = "lamp-at-the-eye";
    const SUMMARY: &'static str =
        "a lamp at the eye lights all that is seen: no surface shadows itself";

    fn needs(&self) -> Capabilities {
        Capabilities::BUILD_SCENE
            | Capabilities::GENERATE_RAYS
            | Capabilities::INTERSECT
            | Capabilities::RADIANCE
    }

    fn scenes(&self) -> &[String] {
        &self.scenes
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let mut seen = Vec::new();
        for name in self.scenes.iter() {
            let scene = context
                .scenes
                .load(name, &toml::Table::new())
                .map_err(|error| CheckError::Broken(error.to_string()))?;
            let seed = context.seed.child(name);
            seen.push(Seen { scene: name, points: self.points(context, &scene, seed)? });
        }
        let precision = context.info.precision;
        Ok(finding(&seen, Tolerance::FORMULA.of(precision), Rarity::OWN_SHADOWS.of(precision)))
    }
}

/// A point of a diffuse surface that the eye sees.
#[derive(Clone, Copy)]
struct Point {
    /// From the eye.
    distance: f64,
    /// Between view and shading normal.
    cosine: f64,
    /// The same, if all surfaces faced +z.
    world_cosine: f64,
    reflectance: Rgb,
    falloff: Falloff,
    /// What the core says it sends to the eye.
    radiance: Rgb,
}

/// The points that are seen in one scene.
struct Seen<'a> {
    scene: &'a str,
    points: Vec<Point>,
}

impl LampAtTheEye {
    fn points(
        &self,
        context: &mut Context<'_>,
        scene: &SceneDescription,
        seed: Seed,
    ) -> Result<Vec<Point>, CheckError> {
        let camera = camera_of(scene)?;
        let scene =
            lit_by_lamp(scene, Light::Point { position: camera.position, intensity: INTENSITY });
        let mut stream = seed.stream();
        let mut film = || DVec2::new(uniform(&mut stream), uniform(&mut stream));
        let film: Vec<_> = (0..self.rays.0).map(|_| film()).collect();
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

/// The scene with this light alone.
fn lit_by_lamp(scene: &SceneDescription, lamp: Light) -> SceneDescription {
    let mut scene = scene.clone();
    scene.materials.iter_mut().for_each(|material| material.emission = None);
    scene.lights = vec![lamp];
    scene
}

/// The radiance of a point as a share of what is right.
type Mistake = fn(&Point) -> f64;

const MISTAKES: &[(&Cause, Mistake)] = &[
    (&bsdf::WITHOUT_PI, |_| PI),
    (&cause::COSINE_FORGOTTEN, |point| point.cosine.recip()),
    (&cause::COSINE_TWICE, |point| point.cosine),
    (&cause::WORLD_COSINE, |point| point.world_cosine / point.cosine),
    (&cause::FADES_WITH_DISTANCE, |point| point.distance),
];

impl Point {
    /// albedo/π · intensity · cos/d².
    fn right(&self, channel: usize) -> f64 {
        let falloff = match self.falloff {
            Falloff::InverseSquare => self.distance.powi(-2),
            Falloff::None => 1.0,
        };
        self.reflectance[channel] * FRAC_1_PI * INTENSITY[channel] * self.cosine * falloff
    }

    /// Small angles to the surface magnify the rounding of its normal.
    fn compared(&self, channel: usize, share: f64, tolerance: f64) -> Compared {
        let expected = share * self.right(channel);
        Compared::relative(self.radiance[channel], expected, tolerance / self.cosine)
    }

    fn is_dark(&self) -> bool {
        (0..3).all(|channel| self.radiance[channel] == 0.0)
    }

    fn is_by(&self, mistake: Mistake, tolerance: f64) -> bool {
        let compare = |channel| self.compared(channel, mistake(self), LIKENESS * tolerance);
        (0..3).all(|channel| compare(channel).agrees())
    }
}

impl Seen<'_> {
    fn dark(&self) -> usize {
        self.points.iter().filter(|point| point.is_dark()).count()
    }

    /// How bright the points are that are not dark.
    fn measures(&self, tolerance: f64) -> impl Iterator<Item = Measure> {
        let of_channel = move |channel: usize| {
            let lit = self.points.iter().filter(|point| !point.is_dark());
            let compared = lit.map(|point| point.compared(channel, 1.0, tolerance));
            Measure::worst("radiance", &judge_exact(compared))
                .of_row(self.scene)
                .of_channel(CHANNELS[channel])
        };
        (0..3).map(of_channel)
    }

    fn darkness(&self) -> Option<String> {
        let (dark, all) = (self.dark(), self.points.len());
        let some = some_are(dark, all, "points that the eye sees");
        (dark > 0).then(|| format!("{}: {some} dark, with a lamp at the eye", self.scene))
    }

    fn complaint(&self, tolerance: f64) -> Option<String> {
        let all = self.points.len();
        let off = |point: &Point| {
            !point.is_dark() && !(0..3).all(|c| point.compared(c, 1.0, tolerance).agrees())
        };
        let wrong = self.points.iter().filter(|point| off(point)).count();
        let worst = self.points.iter().find(|point| off(point))?;
        let some = some_are(wrong, all, "points");
        let (is, should) = (figure(worst.radiance[0]), figure(worst.right(0)));
        Some(format!(
            "{}: {some} not as bright as they should be, one {is} instead of {should}",
            self.scene
        ))
    }
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
        let statement = format!("a lamp at the eye lights {lit} of {points} points that are seen");
        return Finding::of(statement, resolution, measures);
    }
    let finding = Finding::of(complaints.join("; "), resolution, measures);
    if dark == points {
        return finding;
    }
    if rare.verdict == Verdict::Fail {
        let evidence = format!("{} of {points} points that a lamp at the eye has to light", dark);
        return finding.because(&cause::SHADOW_ACNE, evidence);
    }
    let made = MISTAKES.iter().filter(|(_, mistake)| all().all(|p| p.is_by(*mistake, tolerance)));
    let evidence = format!("predicts the radiance of {points} points");
    finding.because_each(made.map(|(cause, _)| *cause), &evidence)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::testing::{assert_passes, failure};

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
        assert!(failure(&finding).contains("7 of 100 points that the eye sees are dark"));
        assert_eq!(finding.clues[0].cause, cause::SHADOW_ACNE.name);
    }

    #[test]
    fn a_point_where_surfaces_cross_may_be_dark() {
        assert_passes(&seen(|_| 1.0, 1));
    }

    #[test]
    fn a_lamp_that_lights_nothing_is_no_shadow() {
        assert!(seen(|_| 1.0, 100).clues.is_empty());
    }

    #[test]
    fn every_mistake_is_named() {
        for (cause, mistake) in MISTAKES {
            let finding = seen(*mistake, 0);
            failure(&finding);
            assert_eq!(finding.clues.len(), 1, "{}", cause.name);
            assert_eq!(finding.clues[0].cause, cause.name);
        }
    }

    #[test]
    fn nothing_seen_is_no_pass() {
        let nothing = finding(&[Seen { scene: "empty", points: Vec::new() }], 1e-6, 1e-4);
        assert_ne!(nothing.verdict, Verdict::Pass);
    }

    #[test]
    fn the_lamp_is_the_only_light() {
        let lamp = Light::Point { position: glam::DVec3::ZERO, intensity: INTENSITY };
        let scene = SceneDescription {
            lights: vec![Light::ConstantSky { radiance: [1.0; 3] }],
            ..SceneDescription::default()
        };
        assert_eq!(lit_by_lamp(&scene, lamp).lights, [lamp]);
    }
}
