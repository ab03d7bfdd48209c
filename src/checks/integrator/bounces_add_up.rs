//! What is accumulated over some bounces is the sum of those bounces, isolated.

use super::estimate::{RayEntry, estimate, needs, settings};
use crate::checks::phrase::percent;
use crate::checks::{Check, CheckError, Context, Finding, Measure, check};
use crate::contract::{Acceleration, Capabilities, DirectSampling};
use crate::stats::{Band, Claim, Verdict, judge_means};
use crate::text::{Between, Count, Percent};

/// Samples of the estimate that relative errors are relative to.
const SCALE_SAMPLES: u64 = 65_536;

check! {
    /// Radiance over bounces `0..=last` is the sum of the bounces `0`, `1`, … `last` alone.
    pub(crate) struct BouncesAddUp {
        ray: RayEntry,
        /// The last bounce.
        last: Between<1, 1000>,
        #[serde(default)]
        direct: DirectSampling,
        /// The smallest difference that must be seen.
        detects: Percent,
        /// Past this the verdict is inconclusive, never a pass.
        at_most: Count,
    }
    name: "bounces-add-up",
    summary: "isolated bounces sum to the accumulated radiance",
}

impl Check for BouncesAddUp {
    fn needs_besides(&self) -> Capabilities {
        needs(&settings([self.last.0; 2], self.direct))
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let scene = context.scene()?;
        let (seed, ray) = (context.seed, self.ray.ray());
        let effort = context.effort(self.detects, self.at_most);
        let mut built = context.core.build_scene(&scene, Acceleration::DEFAULT)?;
        let accumulated = settings([0, self.last.0], self.direct);
        let isolated: Vec<_> =
            (0..=self.last.0).map(|bounce| settings([bounce, bounce], self.direct)).collect();
        let scale =
            estimate(built.as_mut(), ray, &accumulated, seed.child("scale"), SCALE_SAMPLES)?.mean;
        let claims = scale.map(|scale| Claim::difference(scale, Band::RADIANCE));
        let reports = judge_means(&claims, &effort, &mut |draw| {
            let seed = draw.seed(seed);
            let all = seed.child("all");
            let mut difference =
                estimate(built.as_mut(), ray, &accumulated, all, draw.samples)?.mean;
            for (bounce, settings) in isolated.iter().enumerate() {
                let alone =
                    estimate(built.as_mut(), ray, settings, seed.child(bounce), draw.samples)?;
                (0..3).for_each(|c| difference[c] -= alone.mean[c]);
            }
            Ok::<_, CheckError>(difference.to_vec())
        })?;
        let difference = Measure::of_channels("accumulated minus sum", &reports);
        let share = |c: usize| (reports[c].mean / scale[c]).abs();
        let worst = percent((0..3).map(share).fold(0.0, f64::max));
        let failed = reports.iter().any(|report| report.verdict == Verdict::Fail);
        let complaint =
            format!("accumulated radiance differs from the sum of its bounces by {worst}");
        Ok(Finding::measured(format!("bounces 0 to {} add up", self.last.0), difference)
            .complaining(failed.then_some(complaint)))
    }
}
