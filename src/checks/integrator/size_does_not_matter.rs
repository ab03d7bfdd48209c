//! The unit of length is free: a scene of a few millimetres and one of a few kilometres show the radiance of one of a
//! few metres.

use super::estimate::{RayEntry, needs, settings};
use super::linearity::Trial;
use crate::cause::integrator::FIXED_LENGTH;
use crate::checks::phrase::figure;
use crate::checks::{Check, Context, Finding, Measure, Result, check};
use crate::contract::{Capabilities, DirectSampling};
use crate::stats::Verdict;
use crate::text::{Bounces, Count, Percent};

/// From metres to millimetres and to kilometres.
const FACTORS: [f64; 2] = [1e-3, 1e3];

check! {
    pub(crate) struct SizeDoesNotMatter {
        ray: RayEntry,
        bounces: Bounces,
        #[serde(default)]
        direct: DirectSampling,
        detects: Percent,
        at_most: Count,
    }
    name: "size-does-not-matter",
    summary: "the radiance of a scene a thousand times smaller, and larger",
}

impl Check for SizeDoesNotMatter {
    fn needs_besides(&self) -> Capabilities {
        needs(&settings(self.bounces.0, self.direct))
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding> {
        let scene = context.scene()?;
        let trial = Trial {
            settings: settings(self.bounces.0, self.direct),
            effort: context.effort(self.detects, self.at_most),
            ray: self.ray.ray(),
            seed: context.seed,
        };
        let mut measures = Vec::new();
        let (mut differing, mut agreeing) = (Vec::new(), Vec::new());
        for factor in FACTORS {
            let of_size = trial.ignores_size(context.core, &scene, factor)?;
            if of_size.iter().any(Measure::failed) {
                differing.push(factor);
            } else if of_size.iter().all(|measure| measure.verdict == Verdict::Pass) {
                agreeing.push(factor);
            }
            measures.extend(of_size);
        }
        let complaint = measures.iter().find(|measure| measure.failed()).map(|measure| {
            format!(
                "radiance depends on the unit of length: {} is {}",
                measure.name(),
                figure(measure.measured)
            )
        });
        // A power of length that is missing shows in both.
        let evidence = match (&differing[..], &agreeing[..]) {
            ([other], [same]) => Some(format!(
                "the scene {other} times as large has another radiance, {same} times as large it has its own"
            )),
            _ => None,
        };
        Ok(Finding::measured("radiance does not depend on the unit of length", measures)
            .complaining(complaint)
            .because_of(evidence.map(|evidence| (&FIXED_LENGTH, evidence))))
    }
}
