//! How much a core has been asked, in the work of a ray that meets little. It is the same in every run, unlike the time
//! that it takes, so that what ends when enough has been done ends at the same place on every machine. And until when it
//! is asked at all, where nobody else looks at the time.

use super::{Acceleration, Circumstances, CoreError, IntegratorSettings, RenderSettings, Result};
use crate::scene::SceneDescription;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// Counted while questions are asked, also those that are never answered.
#[derive(Clone, Debug, Default)]
pub(crate) struct Work {
    counted: Arc<Counted>,
    time: Option<Time>,
}

#[derive(Debug, Default)]
struct Counted {
    work: AtomicU64,
    circumstances: AtomicU32,
}

/// What a core may take in all, and since when.
#[derive(Clone, Copy, Debug)]
struct Time {
    began: Instant,
    limit: Duration,
}

impl Work {
    /// Nothing so far; once that time has passed, nothing more is asked.
    pub(crate) fn within(limit: Option<Duration>) -> Self {
        let time = limit.map(|limit| Time { began: Instant::now(), limit });
        Self { time, ..Self::default() }
    }

    /// Fails where time is over before `during` is asked.
    pub(super) fn look_at_the_time(&self, during: &str) -> Result<()> {
        match self.time {
            Some(Time { began, limit }) if began.elapsed() > limit => {
                Err(CoreError::TimedOut { limit, during: during.to_owned() })
            }
            _ => Ok(()),
        }
    }

    pub(crate) fn done(&self) -> u64 {
        self.counted.work.load(Ordering::Relaxed)
    }

    /// Under which it was done.
    pub(crate) fn circumstances(&self) -> Circumstances {
        Circumstances::from_bits_truncate(self.counted.circumstances.load(Ordering::Relaxed))
    }

    pub(super) fn add(&self, work: u64) {
        self.counted.work.fetch_add(work, Ordering::Relaxed);
    }

    pub(super) fn see(&self, circumstances: Circumstances) {
        self.counted.circumstances.fetch_or(circumstances.bits(), Ordering::Relaxed);
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_asked_once_time_is_over() {
        assert_eq!(Work::default().look_at_the_time("radiance"), Ok(()));
        assert_eq!(Work::within(Some(Duration::MAX)).look_at_the_time("radiance"), Ok(()));
        let over = Work::within(Some(Duration::ZERO));
        std::thread::sleep(Duration::from_millis(1));
        let late = CoreError::TimedOut { limit: Duration::ZERO, during: "radiance".to_owned() };
        assert_eq!(over.look_at_the_time("radiance"), Err(late));
    }
}
