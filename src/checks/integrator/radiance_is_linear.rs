//! Light adds up: twice the light gives twice the radiance, two lights give the sum of each, and the size of the
//! scene does not matter.

use super::estimate::{RayEntry, needs, settings};
use super::linearity::Trial;
use crate::checks::{Check, Context, Finding, Measure, Result, check};
use crate::contract::{Capabilities, DirectSampling};
use crate::text::number::apart;
use crate::text::{Bounces, Count, Percent};

/// Everything is so many times as large.
const LARGER: f64 = 2.0;

check! {
    pub(crate) struct RadianceIsLinear {
        ray: RayEntry,
        bounces: Bounces,
        #[serde(default)]
        direct: DirectSampling,
        detects: Percent,
        at_most: Count,
    }
    name: "radiance-is-linear",
    summary: "twice the light, the sum of two lights, a scene twice as large",
}

impl Check for RadianceIsLinear {
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
        let same_paths = Capabilities::DETERMINISTIC | Capabilities::PLAIN_ESTIMATORS;
        let mut measures = match context.info.capabilities.contains(same_paths) {
            true => trial.doubles(context.core, &scene)?,
            false => trial.doubles_in_the_mean(context.core, &scene)?,
        };
        measures.extend(trial.superposes(context.core, &scene)?);
        let cause = match measures.iter().any(Measure::failed) {
            true => trial.what_lights_make_of_each_other(context.core, &scene)?,
            false => None,
        };
        measures.extend(trial.ignores_size(context.core, &scene, LARGER)?);
        let complaint = measures.iter().find(|measure| measure.failed()).map(|measure| {
            let [measured, expected] = apart([measure.measured, measure.expected]);
            format!("light does not add up: {} is {measured} instead of {expected}", measure.name())
        });
        Ok(Finding::measured("light adds up", measures)
            .complaining(complaint)
            .because_each(cause, "predicts the radiance of all lights from that of each alone"))
    }
}
