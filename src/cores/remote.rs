//! A core that lives in a worker process, asked through its channel.
//!
//! To checks it is a [`Core`] like any other. If it dies in a batch, fresh workers are given halves
//! of that batch until the element is found that it dies of.

mod scene;

use crate::contract::{
    Acceleration, AdaptiveMean, AdaptiveSettings, BoxHit, BsdfQuery, BsdfSample, BsdfValue,
    BuiltScene, Core, CoreError, CoreInfo, DirectionSample, Hit, Primitive, Randomness, Ray,
    Result, Sampler,
};
use crate::scene::{Aabb, Camera, Material, SceneDescription};
use crate::worker::message::{Answer, Blank, Request, Sent, Wanted};
use crate::worker::narrow::narrow;
use crate::worker::{Confinement, Launch, StartError, Worker};
use glam::{DVec2, DVec3};
use scene::RemoteScene;
use std::ops::Range;
use std::time::{Duration, Instant};

/// How long the search for the element that crashes a core may take.
const SEARCH: Duration = Duration::from_secs(10);

/// A core in a worker process.
pub struct Remote {
    launch: Launch,
    worker: Worker,
}

impl Remote {
    /// Starts a worker for the core.
    ///
    /// # Errors
    /// If there is no process, or the core fails to start.
    pub fn start(launch: &Launch) -> std::result::Result<Self, StartError> {
        Ok(Self { launch: launch.clone(), worker: Worker::start(launch)? })
    }

    /// What the system enforces on it.
    pub const fn confinement(&self) -> &Confinement {
        self.worker.confinement()
    }

    /// What it has printed.
    pub fn printed(&self) -> String {
        self.worker.printed()
    }

    /// Asks for a batch; a crash is narrowed to the element that it comes of.
    fn ask(
        &mut self,
        before: Option<Step<'_>>,
        request: &Request,
        sent: &[Sent<'_>],
        wanted: &mut [Wanted<'_>],
    ) -> Result<Answer> {
        let answer = self.worker.ask(request, sent, wanted);
        let Err(CoreError::Crashed { how, during }) = answer else { return answer };
        let place = self.search(before, request, sent, wanted).unwrap_or_default();
        Err(CoreError::Crashed { how, during: during + &place })
    }

    /// Where in the batch the core dies, in words.
    fn search(
        &self,
        before: Option<Step<'_>>,
        request: &Request,
        sent: &[Sent<'_>],
        wanted: &[Wanted<'_>],
    ) -> Option<String> {
        let count = wanted.first()?.count();
        let of_batch: Vec<_> = sent.iter().filter(|array| !array.is_shared()).collect();
        // A picture has no elements that could be asked for alone.
        let is_batch = count > 0
            && !of_batch.is_empty()
            && of_batch.iter().all(|array| array.count() == count);
        if !is_batch {
            return None;
        }
        let begun = Instant::now();
        let found = narrow(count, |range| {
            (begun.elapsed() < SEARCH).then(|| self.dies_of(before, request, sent, wanted, range))
        });
        Some(match found {
            None => format!(" of {count} elements, though not of them alone"),
            Some(range) if range.len() == 1 => {
                let element = of_batch.first().map(|array| array.describe(range.start));
                format!(", element {} of {count}: {}", range.start, element.unwrap_or_default())
            }
            Some(range) => format!(", elements {} to {} of {count}", range.start, range.end - 1),
        })
    }

    /// Whether a fresh worker dies of a part of the batch.
    fn dies_of(
        &self,
        before: Option<Step<'_>>,
        request: &Request,
        sent: &[Sent<'_>],
        wanted: &[Wanted<'_>],
        range: Range<usize>,
    ) -> bool {
        let Ok(mut worker) = Worker::start(&self.launch) else { return false };
        if let Some(step) = before
            && worker.ask(step.request, step.sent, &mut []).is_err()
        {
            return false;
        }
        let part: Vec<_> = sent.iter().map(|array| array.part(range.clone())).collect();
        let mut memory: Vec<_> = wanted.iter().map(|wanted| wanted.blank(range.len())).collect();
        let mut answers: Vec<_> = memory.iter_mut().map(Blank::wanted).collect();
        matches!(worker.ask(request, &part, &mut answers), Err(CoreError::Crashed { .. }))
    }
}

/// What a fresh worker has to be asked first.
#[derive(Clone, Copy)]
struct Step<'a> {
    request: &'a Request,
    sent: &'a [Sent<'a>],
}

impl Core for Remote {
    fn info(&self) -> CoreInfo {
        self.worker.info().clone()
    }

    fn generate_rays(&mut self, camera: &Camera, film: &[DVec2], rays: &mut [Ray]) -> Result<()> {
        let request = Request::GenerateRays { camera: *camera };
        done(self.ask(None, &request, &[Sent::new("film", film)], &mut [Wanted::new("rays", rays)]))
    }

    fn intersect_primitive(
        &mut self,
        primitive: &Primitive,
        rays: &[Ray],
        hits: &mut [Hit],
    ) -> Result<()> {
        let wanted = &mut [Wanted::new("hits", hits)];
        let rays = Sent::new("rays", rays);
        match primitive {
            Primitive::Triangle { positions, normals } => {
                let positions = Sent::shared("positions", positions);
                let sent = [positions, Sent::shared("normals", normals), rays];
                done(self.ask(None, &Request::IntersectTriangle, &sent, wanted))
            }
            Primitive::Sphere { centre, radius } => {
                let sphere = [[centre.x, centre.y, centre.z, *radius]];
                let sent = [Sent::shared("spheres", &sphere), rays];
                done(self.ask(None, &Request::IntersectSphere, &sent, wanted))
            }
        }
    }

    fn intersect_box(&mut self, bounds: &Aabb, rays: &[Ray], hits: &mut [BoxHit]) -> Result<()> {
        let corners = [bounds.min, bounds.max];
        let sent = [Sent::shared("bounds", &corners), Sent::new("rays", rays)];
        let wanted = Wanted::new("box-hits", hits);
        done(self.ask(None, &Request::IntersectBox, &sent, &mut [wanted]))
    }

    fn sample_direction(
        &mut self,
        sampler: Sampler,
        random: Randomness<'_>,
        samples: &mut [DirectionSample],
    ) -> Result<()> {
        let request = Request::SampleDirection { sampler, seed: random.seed };
        done(self.ask(None, &request, &numbers(random), &mut [Wanted::new("samples", samples)]))
    }

    fn direction_pdf(
        &mut self,
        sampler: Sampler,
        directions: &[DVec3],
        pdf: &mut [f64],
    ) -> Result<()> {
        let sent = Sent::new("directions", directions);
        let request = Request::DirectionPdf { sampler };
        done(self.ask(None, &request, &[sent], &mut [Wanted::new("pdf", pdf)]))
    }

    fn eval_bsdf(
        &mut self,
        material: &Material,
        queries: &[BsdfQuery],
        values: &mut [BsdfValue],
    ) -> Result<()> {
        let request = Request::EvalBsdf { material: material.clone() };
        let sent = Sent::new("queries", queries);
        done(self.ask(None, &request, &[sent], &mut [Wanted::new("values", values)]))
    }

    fn sample_bsdf(
        &mut self,
        material: &Material,
        wo: &[DVec3],
        random: Randomness<'_>,
        samples: &mut [BsdfSample],
    ) -> Result<()> {
        let request = Request::SampleBsdf { material: material.clone(), seed: random.seed };
        let [points, lobes] = numbers(random);
        let sent = [Sent::new("wo", wo), points, lobes];
        done(self.ask(None, &request, &sent, &mut [Wanted::new("samples", samples)]))
    }

    fn adaptive_mean(
        &mut self,
        settings: AdaptiveSettings,
        streams: &[&[f64]],
        means: &mut [AdaptiveMean],
    ) -> Result<()> {
        let lengths: Vec<_> = streams.iter().map(|stream| stream.len() as u64).collect();
        let values = streams.concat();
        let sent = [Sent::new("values", &values), Sent::new("lengths", &lengths)];
        let wanted = Wanted::new("means", means);
        done(self.ask(None, &Request::AdaptiveMean { settings }, &sent, &mut [wanted]))
    }

    fn build_scene(
        &mut self,
        scene: &SceneDescription,
        acceleration: Acceleration,
    ) -> Result<Box<dyn BuiltScene + '_>> {
        Ok(Box::new(RemoteScene::build(self, scene, acceleration)?))
    }
}

/// Random numbers as they are sent.
fn numbers(random: Randomness<'_>) -> [Sent<'_>; 2] {
    [Sent::new("points", random.points), Sent::new("lobes", random.lobes)]
}

/// An answer that is nothing but its arrays.
fn done(answer: Result<Answer>) -> Result<()> {
    match answer? {
        Answer::Done => Ok(()),
        other => Err(out_of_place(&other)),
    }
}

fn out_of_place(answer: &Answer) -> CoreError {
    CoreError::BrokeContract(format!("it answered {answer:?}, which does not match the request"))
}
