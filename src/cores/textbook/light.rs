//! Part 3: where light comes from, and directions towards it.
//!
//! Every pdf is per steradian as seen from the point that asks. Area lights shine from their front alone. Not here:
//! whether anything stands in between (`direct`), and how shapes that emit are sampled (`area_light`).

use super::area_light::{MeshLight, SphereLight};
use super::sampling;
use super::steps::Steps;
use crate::contract::LightSample;
use crate::scene::{Light, Rgb, SceneDescription, Shape};
use glam::{DVec2, DVec3};

/// A light, prepared for sampling.
#[derive(Clone, Debug)]
pub(crate) enum Emitter {
    /// Point, directional or sky: nothing to prepare.
    Simple(Light),
    Mesh(MeshLight),
    Sphere(SphereLight),
    /// A shape that was declared a light but does not emit.
    Dark,
}

impl Emitter {
    pub(crate) fn new(light: &Light, scene: &SceneDescription) -> Self {
        let Light::Area { shape } = *light else { return Self::Simple(*light) };
        let Some(emission) = scene.material_of(shape).emission else { return Self::Dark };
        match scene.shape(shape) {
            Shape::Mesh(mesh) => Self::Mesh(MeshLight::new(mesh, emission.radiance)),
            Shape::Sphere(sphere) => Self::Sphere(SphereLight::new(sphere, emission)),
        }
    }

    /// Whether no ray can meet the light by chance.
    pub(crate) fn is_delta(&self) -> bool {
        matches!(self, Self::Simple(light) if light.is_delta())
    }

    /// Radiance of the sky from `direction`; zero for other lights.
    pub(crate) fn sky_radiance(&self, direction: DVec3) -> Rgb {
        match self {
            Self::Simple(light) => light.sky_radiance(direction),
            _ => [0.0; 3],
        }
    }

    /// A direction from `from` towards the light; `lobe` chooses the triangle of a mesh.
    pub(crate) fn sample(
        &self,
        from: DVec3,
        point: DVec2,
        lobe: f64,
        steps: &Steps,
    ) -> Option<LightSample> {
        match self {
            Self::Simple(light) => sample_simple(light, from, point, steps),
            Self::Mesh(mesh) => mesh.sample(from, point, lobe, steps),
            Self::Sphere(sphere) => sphere.sample(from, point, steps),
            Self::Dark => None,
        }
    }

    /// The pdf with which [`Self::sample`] draws the direction from `from` to `at`, an emitting
    /// point of the light with unit `normal` on its front.
    pub(crate) fn area_pdf(&self, from: DVec3, at: DVec3, normal: DVec3, steps: &Steps) -> f64 {
        match self {
            Self::Mesh(mesh) => mesh.pdf(from, at, normal, steps),
            Self::Sphere(sphere) => sphere.pdf(from, at, normal, steps),
            Self::Simple(_) | Self::Dark => 0.0,
        }
    }

    /// The pdf with which [`Self::sample`] draws a direction into the sky; zero for other lights.
    pub(crate) fn sky_pdf(&self, steps: &Steps) -> f64 {
        match self {
            Self::Simple(Light::ConstantSky { .. } | Light::GradientSky { .. }) => steps.sky_pdf(),
            _ => 0.0,
        }
    }
}

fn sample_simple(light: &Light, from: DVec3, point: DVec2, steps: &Steps) -> Option<LightSample> {
    match *light {
        Light::Point { position, intensity } => {
            let wi = (position - from).try_normalize()?;
            let distance = (position - from).length();
            Some(delta(wi, distance, steps.point_light_radiance(intensity, distance)))
        }
        Light::Directional { direction, irradiance } => {
            Some(delta(steps.towards_directional(direction), f64::INFINITY, irradiance))
        }
        Light::ConstantSky { .. } | Light::GradientSky { .. } => {
            Some(sample_sky(light, point, steps))
        }
        Light::Area { .. } => None,
    }
}

/// Intensity over distance squared.
pub(crate) fn point_light_radiance(intensity: Rgb, distance: f64) -> Rgb {
    intensity.map(|i| i / (distance * distance))
}

/// Against the way its light travels.
pub(crate) fn towards_directional(direction: DVec3) -> DVec3 {
    -direction
}

fn delta(wi: DVec3, distance: f64, radiance: Rgb) -> LightSample {
    LightSample { wi, distance, radiance, pdf: 1.0, is_delta: 1, is_valid: 1 }
}

/// The sample that leads from `from` to the point `at`, drawn with this `pdf`. From behind,
/// where the pdf is 0, there is none.
pub(crate) fn towards(from: DVec3, at: DVec3, radiance: Rgb, pdf: f64) -> Option<LightSample> {
    let wi = (at - from).try_normalize()?;
    let distance = from.distance(at);
    let sample = LightSample { wi, distance, radiance, pdf, is_delta: 0, is_valid: 1 };
    (pdf > 0.0).then_some(sample)
}

fn sample_sky(light: &Light, point: DVec2, steps: &Steps) -> LightSample {
    let wi = sampling::uniform_sphere(point);
    LightSample {
        wi,
        distance: f64::INFINITY,
        radiance: light.sky_radiance(wi),
        pdf: steps.sky_pdf(),
        is_delta: 0,
        is_valid: 1,
    }
}

/// Uniform over all directions: the point that asks has no normal to prefer some.
pub(crate) fn sky_pdf() -> f64 {
    sampling::uniform_sphere_pdf()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::Ray;
    use crate::cores::stage::{Stage, diffuse, grey};
    use crate::cores::textbook::random::Random;
    use crate::cores::textbook::steps::LESSON;

    /// The last light of a stage.
    fn emitter(stage: Stage) -> Emitter {
        let scene = stage.scene();
        Emitter::new(scene.lights.last().expect("there is a light"), &scene)
    }

    fn rectangle(x: f64, y: f64, z: f64) -> Emitter {
        let corners = [(-x, -y), (-x, y), (x, y), (x, -y)].map(|(x, y)| DVec3::new(x, y, z));
        emitter(Stage::empty().polygon(&corners, diffuse(0.0).emitting(1.0)))
    }

    fn samples(emitter: &Emitter, from: DVec3, count: usize) -> Vec<Option<LightSample>> {
        let mut random = Random::for_ray(5, 0);
        (0..count).map(|_| emitter.sample(from, random.point(), random.number(), &LESSON)).collect()
    }

    #[test]
    fn samples_lead_to_the_light_and_carry_the_pdf_of_their_direction() {
        let look = diffuse(0.0).emitting(1.0);
        let far_sphere = Stage::empty().sphere(DVec3::new(3.0, 4.0, 5.0), 0.01, look);
        let from = DVec3::new(0.2, 0.1, -0.3);
        for stage in [
            Stage::empty().room(2.0, look),
            Stage::empty().room(2.0, diffuse(0.0).emitting_cap(1.0, 0.7)),
            Stage::empty().sphere(DVec3::new(1.0, 1.0, 1.0), 0.5, look),
            far_sphere,
        ] {
            let (emitter, world) = (emitter(stage.clone()), stage.world());
            for sample in samples(&emitter, from, 1000).into_iter().flatten() {
                let ray = Ray::new(from, sample.wi);
                let hit = world.closest_hit(&ray, &mut Default::default()).expect("it is there");
                assert!((hit.t / sample.distance - 1.0).abs() < 1e-6, "{hit:?} {sample:?}");
                let pdf = emitter.area_pdf(from, ray.at(hit.t), hit.geometric_normal, &LESSON);
                assert!((pdf / sample.pdf - 1.0).abs() < 1e-6, "{pdf} {sample:?}");
            }
        }
    }

    #[test]
    fn nothing_is_sampled_from_behind() {
        let sphere = Stage::empty().sphere(DVec3::ZERO, 1.0, diffuse(0.0).emitting(1.0));
        for sample in samples(&emitter(sphere), DVec3::new(0.3, 0.2, 0.1), 100) {
            assert_eq!(sample, None);
        }
        assert!(
            samples(&rectangle(1.0, 1.0, 1.0), DVec3::Z * 2.0, 100).iter().all(Option::is_none)
        );
    }

    #[test]
    fn triangles_without_area_are_never_chosen() {
        let positions = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let mesh = crate::scene::Mesh {
            positions: positions.map(|[x, y]| DVec3::new(x, y, 0.0)).to_vec(),
            indices: vec![[0, 0, 1], [0, 1, 2], [2, 2, 2], [0, 2, 3], [3, 3, 0]],
            ..Default::default()
        };
        let emitter = emitter(Stage::empty().mesh(mesh, diffuse(0.0).emitting(1.0)));
        for lobe in [0.0, 0.49, 0.5, 1.0 - f64::EPSILON / 2.0] {
            let sample =
                emitter.sample(DVec3::Z, DVec2::splat(0.5), lobe, &LESSON).expect("it is in front");
            assert!(sample.pdf.is_finite() && sample.pdf > 0.0, "{sample:?}");
            let at = DVec3::Z + sample.distance * sample.wi;
            assert_eq!(at.x > at.y, lobe < 0.5, "{lobe}: {at}");
        }
    }

    #[test]
    fn a_light_in_the_point_that_asks_is_a_failed_sample() {
        let light = Light::Point { position: DVec3::ONE, intensity: grey(1.0) };
        assert_eq!(Emitter::Simple(light).sample(DVec3::ONE, DVec2::ZERO, 0.0, &LESSON), None);
    }
}
