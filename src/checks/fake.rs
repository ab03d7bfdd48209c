//! The core of all tests of checks: it answers each question by a closure that the test gives it, element by element.

use super::shape::{Answer, as_hit, intersection};
use super::testing::info;
use crate::contract::{
    Acceleration, AdaptiveMean, AdaptiveSettings, BoxHit, BsdfQuery, BsdfSample, BsdfValue,
    BuildStats, BuiltScene, Core, CoreInfo, DirectionSample, Film, Hit, IntegratorSettings,
    LightSample, Precision, Primitive, Randomness, Ray, RenderSettings, Result, Sampler,
    TraversalStats,
};
use crate::image::encoding::Encoding;
use crate::image::png::Picture;
use crate::math::rng::{Seed, Stream};
use crate::scene::{Aabb, Camera, Material, SceneDescription};
use glam::{DVec2, DVec3};

/// See the module. A question that a test does not expect ends it.
#[expect(clippy::type_complexity, reason = "each closure's type is the signature of its question")]
pub(crate) struct Fake {
    pub(crate) info: CoreInfo,
    pub(crate) ray: Box<dyn FnMut(&Camera, DVec2) -> Ray + Send>,
    /// A hit of a primitive; right by default.
    pub(crate) primitive: Box<dyn FnMut(&Primitive, &Ray) -> Option<Answer> + Send>,
    pub(crate) bounds: Box<dyn FnMut(&Aabb, &Ray) -> BoxHit + Send>,
    /// The sample of this number in a batch.
    pub(crate) direction: Box<dyn FnMut(&Randomness<'_>, usize) -> DirectionSample + Send>,
    pub(crate) pdf: Box<dyn FnMut(DVec3) -> f64 + Send>,
    pub(crate) value: Box<dyn FnMut(&Material, &BsdfQuery) -> BsdfValue + Send>,
    pub(crate) sample: Box<dyn FnMut(&Material, DVec3, DVec2, f64) -> BsdfSample + Send>,
    /// Where a stream of samples stops.
    pub(crate) mean: Box<dyn FnMut(AdaptiveSettings, &[f64]) -> AdaptiveMean + Send>,
    pub(crate) stats: BuildStats,
    pub(crate) hit: Box<dyn FnMut(&Ray) -> Hit + Send>,
    pub(crate) light: Box<dyn FnMut(DVec3, DVec2) -> LightSample + Send>,
    /// An estimate of radiance, the same in every channel, whatever the ray.
    pub(crate) radiance: Box<dyn FnMut(&mut Stream, &IntegratorSettings) -> f64 + Send>,
    pub(crate) film: Box<dyn FnMut(&RenderSettings, &mut Film) + Send>,
    pub(crate) codes: Box<dyn FnMut(&RenderSettings) -> (Encoding, Picture) + Send>,
}

impl Default for Fake {
    fn default() -> Self {
        Self {
            info: info(Precision::Double),
            ray: Box::new(|_, _| panic!("no rays")),
            primitive: Box::new(intersection),
            bounds: Box::new(|_, _| panic!("no boxes")),
            direction: Box::new(|_, _| panic!("no directions")),
            pdf: Box::new(|_| panic!("no pdfs")),
            value: Box::new(|_, _| panic!("no BSDFs")),
            sample: Box::new(|_, _, _, _| panic!("no samples of BSDFs")),
            mean: Box::new(|_, _| panic!("no adaptive means")),
            stats: BuildStats::default(),
            hit: Box::new(|_| panic!("no hits")),
            light: Box::new(|_, _| panic!("no lights")),
            radiance: Box::new(|_, _| panic!("no radiance")),
            film: Box::new(|_, _| panic!("no pictures")),
            codes: Box::new(|_| panic!("no codes")),
        }
    }
}

impl Fake {
    pub(crate) fn intersecting(
        formula: impl FnMut(&Primitive, &Ray) -> Option<Answer> + Send + 'static,
    ) -> Self {
        Self { primitive: Box::new(formula), ..Self::default() }
    }

    pub(crate) fn drawing(
        draw: impl FnMut(&mut Stream, &IntegratorSettings) -> f64 + Send + 'static,
    ) -> Self {
        Self { radiance: Box::new(draw), ..Self::default() }
    }
}

impl Core for Fake {
    fn info(&self) -> CoreInfo {
        self.info.clone()
    }

    fn generate_rays(&mut self, camera: &Camera, film: &[DVec2], rays: &mut [Ray]) -> Result<()> {
        fill(rays, film, |point| (self.ray)(camera, *point))
    }

    fn intersect_primitive(
        &mut self,
        of: &Primitive,
        rays: &[Ray],
        hits: &mut [Hit],
    ) -> Result<()> {
        fill(hits, rays, |ray| as_hit((self.primitive)(of, ray)))
    }

    fn intersect_box(&mut self, bounds: &Aabb, rays: &[Ray], hits: &mut [BoxHit]) -> Result<()> {
        fill(hits, rays, |ray| (self.bounds)(bounds, ray))
    }

    fn sample_direction(
        &mut self,
        _: Sampler,
        random: Randomness<'_>,
        samples: &mut [DirectionSample],
    ) -> Result<()> {
        fill(samples, 0.., |number| (self.direction)(&random, number))
    }

    fn direction_pdf(&mut self, _: Sampler, directions: &[DVec3], pdf: &mut [f64]) -> Result<()> {
        fill(pdf, directions, |direction| (self.pdf)(*direction))
    }

    fn eval_bsdf(
        &mut self,
        material: &Material,
        queries: &[BsdfQuery],
        values: &mut [BsdfValue],
    ) -> Result<()> {
        fill(values, queries, |query| (self.value)(material, query))
    }

    fn sample_bsdf(
        &mut self,
        material: &Material,
        wo: &[DVec3],
        random: Randomness<'_>,
        samples: &mut [BsdfSample],
    ) -> Result<()> {
        let numbers = wo.iter().zip(random.points).zip(random.lobes);
        fill(samples, numbers, |((wo, point), lobe)| (self.sample)(material, *wo, *point, *lobe))
    }

    fn adaptive_mean(
        &mut self,
        settings: AdaptiveSettings,
        streams: &[&[f64]],
        means: &mut [AdaptiveMean],
    ) -> Result<()> {
        fill(means, streams, |stream| (self.mean)(settings, stream))
    }

    fn build_scene(
        &mut self,
        _: &SceneDescription,
        _: Acceleration,
    ) -> Result<Box<dyn BuiltScene + '_>> {
        Ok(Box::new(Built(self)))
    }
}

fn fill<Question, Answer>(
    answers: &mut [Answer],
    questions: impl IntoIterator<Item = Question>,
    mut answer: impl FnMut(Question) -> Answer,
) -> Result<()> {
    answers.iter_mut().zip(questions).for_each(|(to, question)| *to = answer(question));
    Ok(())
}

struct Built<'a>(&'a mut Fake);

impl BuiltScene for Built<'_> {
    fn stats(&self) -> BuildStats {
        self.0.stats
    }

    fn intersect(&mut self, rays: &[Ray], hits: &mut [Hit]) -> Result<TraversalStats> {
        fill(hits, rays, |ray| (self.0.hit)(ray))?;
        Ok(TraversalStats::default())
    }

    fn sample_light(
        &mut self,
        _: u32,
        from: &[DVec3],
        random: Randomness<'_>,
        samples: &mut [LightSample],
    ) -> Result<()> {
        let numbers = from.iter().zip(random.points);
        fill(samples, numbers, |(from, point)| (self.0.light)(*from, *point))
    }

    fn radiance(
        &mut self,
        rays: &[Ray],
        settings: &IntegratorSettings,
        radiance: &mut [[f64; 3]],
    ) -> Result<()> {
        let stream = &mut Seed(settings.seed).stream();
        fill(radiance, rays, |_| [(self.0.radiance)(stream, settings); 3])
    }

    fn render(&mut self, _: &Camera, settings: &RenderSettings, film: &mut Film) -> Result<()> {
        (self.0.film)(settings, film);
        Ok(())
    }

    fn render_codes(
        &mut self,
        _: &Camera,
        settings: &RenderSettings,
        codes: &mut Picture,
    ) -> Result<Encoding> {
        let (encoding, picture) = (self.0.codes)(settings);
        *codes = picture;
        Ok(encoding)
    }
}
