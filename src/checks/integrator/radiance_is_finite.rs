//! No NaN, no infinity, no negative radiance, in scenes that invite them.
//!
//! The validation in front of every core refuses such pixels by itself; this check renders what provokes them:
//! grazing light, roughness near zero, rays along planes, a camera inside glass.

use crate::checks::rendering::Rendering;
use crate::checks::{Check, CheckError, Context, Finding, Measure, Result, breach, check};
use crate::contract::{Acceleration, Breach, Capabilities, CoreError, DirectSampling};
use crate::scene::SceneDescription;
use crate::text::{Between, Bounces, Several, Size};

check! {
    /// Renders each scene with light sampling and, where the core has it, hemisphere sampling.
    pub(crate) struct RadianceIsFinite {
        scenes: Several<String>,
        size: Size,
        samples_per_pixel: Between<1, 65536>,
        bounces: Bounces,
    }
    name: "radiance-is-finite",
    summary: "no NaN, infinite or negative pixel in scenes that invite them",
    needs: BUILD_SCENE | RENDER,
}

impl Check for RadianceIsFinite {
    fn scenes(&self) -> &[String] {
        &self.scenes
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding> {
        let mut measures = Vec::new();
        let mut breaches = Vec::new();
        for name in self.scenes.iter() {
            let scene = context.load(name)?;
            for direct in [DirectSampling::Lights, DirectSampling::Hemisphere] {
                if !can(context, direct) {
                    continue;
                }
                let breach = self.breach(context, &scene, direct)?;
                let what = format!("pictures that cannot be, by {direct:?}");
                measures.push(Measure::none(what, breach.is_some().into()).of_row(name));
                breaches.extend(breach.map(|breach| (name, breach)));
            }
        }
        let statement = match breaches.first() {
            None => format!("every pixel of {} pictures is finite", measures.len()),
            Some((scene, breach)) => format!("{scene}: {breach}"),
        };
        let cause = breaches.first().and_then(|(_, breach)| breach::cause_of(breach));
        Ok(Finding::of(&statement, "would have caught one such pixel", measures)
            .because_each(cause, &statement))
    }
}

fn can(context: &Context<'_>, direct: DirectSampling) -> bool {
    direct == DirectSampling::Lights
        || context.info.capabilities.contains(Capabilities::HEMISPHERE_SAMPLING)
}

impl RadianceIsFinite {
    /// What the validation says of a picture, if anything.
    fn breach(
        &self,
        context: &mut Context<'_>,
        scene: &SceneDescription,
        direct: DirectSampling,
    ) -> Result<Option<Breach>> {
        let seed = context.seed.child(&scene.name).child(format!("{direct:?}")).0;
        let rendering =
            Rendering::of(scene, self.size.0, self.bounces.0, self.samples_per_pixel.0)?.by(direct);
        let mut built = context.core.build_scene(scene, Acceleration::DEFAULT)?;
        match rendering.film(built.as_mut(), seed, 0) {
            Ok(_) => Ok(None),
            Err(CheckError::Core(CoreError::BrokeContract(breach))) => Ok(Some(*breach)),
            Err(other) => Err(other),
        }
    }
}
