//! Samples of a mirror or of glass, view by view, and how often they are reflections.

use super::interface::Interface;
use super::smooth_view::{Allowed, SmoothView, is_reflection};
use crate::checks::Result;
use crate::checks::numbers::Numbers;
use crate::checks::phrase::degrees;
use crate::checks::surface::{sampled, seen_from};
use crate::contract::{BsdfSample, Core};
use crate::math::rng::Seed;
use crate::scene::Material;
use crate::stats::{Band, Effort, ShareReport, judge_share};
use glam::DVec3;

/// Samples of each view that are looked at one by one: a lobe of 4 % is missed with probability 1e-72.
const EXAMINED: usize = 4096;
/// Samples drawn in one batch.
const BATCH: u64 = 1 << 16;

/// What is asked of every view.
pub(super) struct Trial {
    pub(super) material: Material,
    pub(super) interface: Interface,
    pub(super) allowed: Allowed,
    pub(super) effort: Effort,
    pub(super) band: Band,
}

impl Trial {
    pub(super) fn view(&self, core: &mut dyn Core, angle: f64, seed: Seed) -> Result<SmoothView> {
        let wo = seen_from(angle);
        let mut view = SmoothView {
            name: format!("at {}", degrees(angle)),
            wo,
            right: self.interface.lobes(wo),
            samples: self.samples(core, wo, seed.child("examined"), EXAMINED)?,
            probability: None,
            allowed: self.allowed,
        };
        if let Some(stated) = view.stated_probability() {
            view.probability = Some(self.probability(core, wo, stated, seed)?);
        }
        Ok(view)
    }

    fn samples(
        &self,
        core: &mut dyn Core,
        wo: DVec3,
        seed: Seed,
        count: usize,
    ) -> Result<Vec<BsdfSample>> {
        let numbers = Numbers::new(seed, count);
        Ok(sampled(core, &self.material, &vec![wo; count], numbers.randomness())?)
    }

    /// Whether samples are reflected as often as they say.
    fn probability(
        &self,
        core: &mut dyn Core,
        wo: DVec3,
        stated: f64,
        seed: Seed,
    ) -> Result<ShareReport> {
        judge_share(stated, self.band, &self.effort, &mut |stage, trials| {
            let mut reflected = 0;
            for batch in 0..trials.div_ceil(BATCH) {
                let count = BATCH.min(trials - batch * BATCH);
                let count = usize::try_from(count).unwrap_or(usize::MAX);
                let samples = self.samples(core, wo, seed.child(stage).child(batch), count)?;
                reflected += samples.iter().filter(|s| is_reflection(s, wo)).count() as u64;
            }
            Ok(reflected)
        })
    }
}
