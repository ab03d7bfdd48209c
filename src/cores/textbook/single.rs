//! The answers of a core, rounded to f32.

use crate::contract::{
    Acceleration, AdaptiveMean, AdaptiveSettings, BoxHit, BsdfQuery, BsdfSample, BsdfValue,
    BuildStats, BuiltScene, Core, CoreInfo, DirectionSample, Film, Hit, IntegratorSettings,
    LightSample, Primitive, Randomness, Ray, RenderSettings, Result, Sampler, TraversalStats,
};
use crate::scene::{Aabb, Camera, Material, SceneDescription};
use glam::{DVec2, DVec3};

/// A core whose answers are those of another, rounded.
pub struct Single<C>(pub C);

/// A scene in such a core.
struct SingleScene<'a>(Box<dyn BuiltScene + 'a>);

fn rounded(value: f64) -> f64 {
    f64::from(value as f32)
}

fn vector(value: DVec3) -> DVec3 {
    value.as_vec3().as_dvec3()
}

fn hit(hit: &Hit) -> Hit {
    Hit {
        t: rounded(hit.t),
        geometric_normal: vector(hit.geometric_normal),
        shading_normal: vector(hit.shading_normal),
        uv: hit.uv.as_vec2().as_dvec2(),
        ..*hit
    }
}

/// Rounds every answer.
fn each<T>(answers: &mut [T], round: impl Fn(&T) -> T) {
    answers.iter_mut().for_each(|answer| *answer = round(answer));
}

impl<C: Core> Core for Single<C> {
    fn info(&self) -> CoreInfo {
        self.0.info()
    }

    fn generate_rays(&mut self, camera: &Camera, film: &[DVec2], rays: &mut [Ray]) -> Result<()> {
        self.0.generate_rays(camera, film, rays)?;
        each(rays, |ray| Ray {
            origin: vector(ray.origin),
            t_min: rounded(ray.t_min),
            direction: vector(ray.direction),
            t_max: rounded(ray.t_max),
        });
        Ok(())
    }

    fn intersect_primitive(
        &mut self,
        primitive: &Primitive,
        rays: &[Ray],
        hits: &mut [Hit],
    ) -> Result<()> {
        self.0.intersect_primitive(primitive, rays, hits)?;
        each(hits, hit);
        Ok(())
    }

    fn intersect_box(&mut self, bounds: &Aabb, rays: &[Ray], hits: &mut [BoxHit]) -> Result<()> {
        self.0.intersect_box(bounds, rays, hits)?;
        each(hits, |hit| BoxHit {
            t_enter: rounded(hit.t_enter),
            t_exit: rounded(hit.t_exit),
            ..*hit
        });
        Ok(())
    }

    fn sample_direction(
        &mut self,
        sampler: Sampler,
        random: Randomness<'_>,
        samples: &mut [DirectionSample],
    ) -> Result<()> {
        self.0.sample_direction(sampler, random, samples)?;
        each(samples, |sample| DirectionSample {
            direction: vector(sample.direction),
            pdf: rounded(sample.pdf),
        });
        Ok(())
    }

    fn direction_pdf(
        &mut self,
        sampler: Sampler,
        directions: &[DVec3],
        pdf: &mut [f64],
    ) -> Result<()> {
        self.0.direction_pdf(sampler, directions, pdf)?;
        each(pdf, |pdf| rounded(*pdf));
        Ok(())
    }

    fn eval_bsdf(
        &mut self,
        material: &Material,
        queries: &[BsdfQuery],
        values: &mut [BsdfValue],
    ) -> Result<()> {
        self.0.eval_bsdf(material, queries, values)?;
        each(values, |value| BsdfValue { f: value.f.map(rounded), pdf: rounded(value.pdf) });
        Ok(())
    }

    fn sample_bsdf(
        &mut self,
        material: &Material,
        wo: &[DVec3],
        random: Randomness<'_>,
        samples: &mut [BsdfSample],
    ) -> Result<()> {
        self.0.sample_bsdf(material, wo, random, samples)?;
        each(samples, |sample| BsdfSample {
            wi: vector(sample.wi),
            f: sample.f.map(rounded),
            pdf: rounded(sample.pdf),
            ..*sample
        });
        Ok(())
    }

    fn adaptive_mean(
        &mut self,
        settings: AdaptiveSettings,
        streams: &[&[f64]],
        means: &mut [AdaptiveMean],
    ) -> Result<()> {
        self.0.adaptive_mean(settings, streams, means)?;
        each(means, |mean| AdaptiveMean { mean: rounded(mean.mean), ..*mean });
        Ok(())
    }

    fn build_scene(
        &mut self,
        scene: &SceneDescription,
        acceleration: Acceleration,
    ) -> Result<Box<dyn BuiltScene + '_>> {
        Ok(Box::new(SingleScene(self.0.build_scene(scene, acceleration)?)))
    }
}

impl BuiltScene for SingleScene<'_> {
    fn stats(&self) -> BuildStats {
        self.0.stats()
    }

    fn intersect(&mut self, rays: &[Ray], hits: &mut [Hit]) -> Result<TraversalStats> {
        let stats = self.0.intersect(rays, hits)?;
        each(hits, hit);
        Ok(stats)
    }

    fn occluded(&mut self, rays: &[Ray], occluded: &mut [bool]) -> Result<TraversalStats> {
        self.0.occluded(rays, occluded)
    }

    fn sample_light(
        &mut self,
        light: u32,
        from: &[DVec3],
        random: Randomness<'_>,
        samples: &mut [LightSample],
    ) -> Result<()> {
        self.0.sample_light(light, from, random, samples)?;
        each(samples, |sample| LightSample {
            wi: vector(sample.wi),
            distance: rounded(sample.distance),
            radiance: sample.radiance.map(rounded),
            pdf: rounded(sample.pdf),
            ..*sample
        });
        Ok(())
    }

    fn radiance(
        &mut self,
        rays: &[Ray],
        settings: &IntegratorSettings,
        radiance: &mut [[f64; 3]],
    ) -> Result<()> {
        self.0.radiance(rays, settings, radiance)?;
        each(radiance, |radiance| radiance.map(rounded));
        Ok(())
    }

    fn render(
        &mut self,
        camera: &Camera,
        settings: &RenderSettings,
        film: &mut Film,
    ) -> Result<()> {
        self.0.render(camera, settings, film)
    }
}
