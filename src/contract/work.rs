//! How much a core has been asked, in the work of a ray that meets little. It is the same in every run, unlike the time
//! that it takes, so that what ends when enough has been done ends at the same place on every machine.

use super::{Acceleration, Circumstances, IntegratorSettings, RenderSettings};
use crate::scene::SceneDescription;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};

/// Counted while questions are asked, also those that are never answered.
#[derive(Clone, Debug, Default)]
pub(crate) struct Work(Arc<Counted>);

#[derive(Debug, Default)]
struct Counted {
    work: AtomicU64,
    circumstances: AtomicU32,
}

impl Work {
    pub(crate) fn done(&self) -> u64 {
        self.0.work.load(Ordering::Relaxed)
    }

    /// Under which it was done.
    pub(crate) fn circumstances(&self) -> Circumstances {
        Circumstances::from_bits_truncate(self.0.circumstances.load(Ordering::Relaxed))
    }

    pub(super) fn add(&self, work: u64) {
        self.0.work.fetch_add(work, Ordering::Relaxed);
    }

    pub(super) fn see(&self, circumstances: Circumstances) {
        self.0.circumstances.fetch_or(circumstances.bits(), Ordering::Relaxed);
    }
}

/// Bounces after which hardly any light is left, however many are asked for.
const BOUNCES: u32 = 8;

/// Of a path: at each vertex a ray goes on, and one to each light.
pub(super) fn of_path(settings: &IntegratorSettings) -> u64 {
    let bounces = settings.bounces.end().min(&BOUNCES);
    1 + u64::from(*bounces) * (1 + u64::from(settings.samples_per_light))
}

/// Of a pixel.
pub(super) fn of_pixel(settings: &RenderSettings) -> u64 {
    u64::from(settings.samples_per_pixel) * of_path(&settings.integrator)
}

/// Of a ray that looks for something in this scene.
pub(super) fn of_ray(scene: &SceneDescription, how: Acceleration) -> u64 {
    let primitives = scene.primitive_count() as u64;
    match how {
        Acceleration::BruteForce => 1 + primitives / 4,
        Acceleration::Bvh { .. } => 1 + u64::from(primitives.max(1).ilog2()),
    }
}
