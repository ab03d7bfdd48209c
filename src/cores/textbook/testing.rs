//! Scenes of a few lines and means with their errors, for the tests of this core.

use super::integrator::Integrator;
use super::random::Random;
use super::steps::LESSON;
use super::world::World;
use crate::contract::{Acceleration, IntegratorSettings, Ray};
use crate::scene::{Cap, Emission, Light, Material, Mesh, Rgb, SceneDescription, Sphere, Surface};
use glam::DVec3;

/// A scene under construction.
#[derive(Clone, Debug, Default)]
pub(crate) struct Stage(SceneDescription);

impl Stage {
    /// Nothing at all.
    pub(crate) fn empty() -> Self {
        Self::default()
    }

    /// A polygon, fanned from its first corner; counter-clockwise from the front.
    pub(crate) fn polygon(mut self, corners: &[DVec3], look: Look) -> Self {
        let material = self.add(look);
        let indices = (2..corners.len() as u32).map(|last| [0, last - 1, last]).collect();
        let mesh = Mesh { positions: corners.to_vec(), indices, material, ..Mesh::default() };
        self.0.meshes.push(mesh);
        self
    }

    /// A mesh as it is.
    pub(crate) fn mesh(mut self, mut mesh: Mesh, look: Look) -> Self {
        mesh.material = self.add(look);
        self.0.meshes.push(mesh);
        self
    }

    /// The plane z = 0 from −10 to 10, facing up, with reflectance .37.
    pub(crate) fn floor(self) -> Self {
        let corners = [(-10.0, -10.0), (10.0, -10.0), (10.0, 10.0), (-10.0, 10.0)];
        self.polygon(&corners.map(|(x, y)| DVec3::new(x, y, 0.0)), diffuse(0.37))
    }

    /// A ball, with its front outside.
    pub(crate) fn ball(self, centre: DVec3, radius: f64, look: Look) -> Self {
        self.sphere(centre, radius, false, look)
    }

    /// A room, with its front inside.
    pub(crate) fn room(self, radius: f64, look: Look) -> Self {
        self.sphere(DVec3::ZERO, radius, true, look)
    }

    fn sphere(mut self, centre: DVec3, radius: f64, inward: bool, look: Look) -> Self {
        let material = self.add(look);
        self.0.spheres.push(Sphere { name: String::new(), centre, radius, inward, material });
        self
    }

    /// A light that is no shape.
    pub(crate) fn light(mut self, light: Light) -> Self {
        self.0.lights.push(light);
        self
    }

    fn add(&mut self, look: Look) -> u32 {
        let Look { surface, emission } = look;
        self.0.materials.push(Material { name: String::new(), surface, emission });
        self.0.materials.len() as u32 - 1
    }

    /// The description.
    pub(crate) fn scene(self) -> SceneDescription {
        self.0.with_area_lights()
    }

    /// The scene as rays see it.
    pub(crate) fn world(self) -> World<'static> {
        World::new(&self.scene(), Acceleration::DEFAULT, &LESSON)
    }
}

/// How a shape scatters and glows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Look {
    /// How it scatters.
    pub(crate) surface: Surface,
    /// How it glows.
    pub(crate) emission: Option<Emission>,
}

impl Look {
    /// And glows with this radiance.
    pub(crate) fn glowing(self, radiance: f64) -> Self {
        Self { emission: Some(Emission { radiance: grey(radiance), cap: None }), ..self }
    }

    /// And glows within `half_angle` of +z.
    pub(crate) fn glowing_cap(self, radiance: f64, half_angle: f64) -> Self {
        let cap = Some(Cap { axis: DVec3::Z, half_angle });
        Self { emission: Some(Emission { radiance: grey(radiance), cap }), ..self }
    }
}

/// The same in all channels.
pub(crate) fn grey(value: f64) -> Rgb {
    [value; 3]
}

/// A diffuse surface that does not glow.
pub(crate) fn diffuse(reflectance: f64) -> Look {
    looks(Surface::Diffuse { reflectance: grey(reflectance) })
}

/// A surface that does not glow.
pub(crate) fn looks(surface: Surface) -> Look {
    Look { surface, emission: None }
}

/// Glass of index 1.5 that absorbs nothing.
pub(crate) fn clear_glass() -> Look {
    let (reflectance, transmittance) = (grey(1.0), grey(1.0));
    looks(Surface::Glass { index: 1.5, reflectance, transmittance })
}

/// A mean with its standard error.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Estimate {
    /// Of the red channel.
    pub(crate) mean: f64,
    /// Of the mean.
    pub(crate) standard_error: f64,
    /// Of a single path.
    pub(crate) variance: f64,
}

impl Estimate {
    /// Traces `paths` paths along `ray`.
    pub(crate) fn of(
        world: &World<'_>,
        ray: &Ray,
        settings: &IntegratorSettings,
        paths: usize,
    ) -> Self {
        let integrator = Integrator::new(world, settings);
        let mut mean = 0.0;
        let mut squared_deviations = 0.0;
        for path in 0..paths {
            let radiance = integrator.radiance(ray, &mut Random::for_ray(settings.seed, path)).x;
            // Welford's update: sums of squares would hide that a scene has no variance at all.
            let deviation = radiance - mean;
            mean += deviation / (path + 1) as f64;
            squared_deviations += deviation * (radiance - mean);
        }
        let variance = squared_deviations / (paths as f64 - 1.0);
        Self { mean, standard_error: (variance / paths as f64).sqrt(), variance }
    }

    /// The mean is `expected` within 4.5 standard errors (one false alarm in 150,000), and those
    /// are at most `resolution` of it: an error of ten times that could not hide.
    pub(crate) fn assert_is(self, expected: f64, resolution: f64) {
        let rounding = 1e-9 * expected;
        let error = (self.mean - expected).abs();
        assert!(error <= 4.5 * self.standard_error + rounding, "expected {expected}, got {self:?}");
        let resolved = self.standard_error <= resolution * expected + rounding;
        assert!(resolved, "too noisy to tell {expected}: {self:?}");
    }

    /// The mean is `expected` at once: every path says so.
    pub(crate) fn assert_is_exactly(self, expected: f64) {
        self.assert_is(expected, 0.0);
    }
}
