//! A render against a Mitsuba reference, with the noise of both in the account.

use super::conventions::{regarded, that_matter};
use super::parts::{self, Parts};
use super::shot::{Setup, Shot};
use super::told::{ERROR_SCALE, error_picture, finding, glance, rejected};
use super::{by_codes, clues};
use crate::checks::convergence;
use crate::checks::series::Series;
use crate::checks::{Check, CheckError, Context, Finding, Picture, PictureRole, camera_of, check};
use crate::contract::{Acceleration, Capabilities, DirectSampling};
use crate::image::{Image, luminance};
use crate::scene::reference::{self, Reference};
use crate::stats::{self, ImageDraw, ImageEffort, Report, Stage, judge_image};
use crate::text::{Between, Bounces, Percent};

check! {
    /// Independent renders agree with a reference, at every scale from a pixel to the whole picture.
    pub(crate) struct MatchesReference {
        /// The folder below `references/`.
        reference: String,
        bounces: Bounces,
        #[serde(default)]
        direct: DirectSampling,
        /// Of each run, at the default budget.
        samples_per_pixel: Between<1, 65536>,
        /// The error of the whole picture that must be seen.
        detects: Percent,
        /// Whether the report shows its bounces and both ways of sampling: more samples, which judge nothing.
        #[serde(default)]
        shows_parts: bool,
    }
    name: "matches-reference",
    summary: "independent renders against a Mitsuba reference, at every scale",
}

impl Check for MatchesReference {
    fn needs_besides(&self) -> Capabilities {
        self.needs_beside(Capabilities::RENDER)
    }

    fn needs_instead(&self) -> Option<Capabilities> {
        Some(self.needs_beside(Capabilities::RENDER_CODES))
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        match context.info.capabilities.contains(Capabilities::RENDER) {
            true => self.by_radiance(context),
            false => self.by_codes(context),
        }
    }
}

impl MatchesReference {
    fn needs_beside(&self, picture: Capabilities) -> Capabilities {
        let mut needs = Capabilities::BUILD_SCENE | picture;
        if self.direct == DirectSampling::Hemisphere {
            needs |= Capabilities::HEMISPHERE_SAMPLING;
        }
        if self.bounces.0[0] > 0 {
            needs |= Capabilities::ISOLATED_BOUNCES;
        }
        needs
    }

    /// The reference, and how the core is asked for the same.
    pub(super) fn setup(&self, context: &Context<'_>) -> Result<Setup, CheckError> {
        let scene = context.scene()?;
        let camera = camera_of(&scene)?;
        let reference = reference::load_from(context.references, &self.reference, &scene)
            .map_err(|error| CheckError::Broken(error.to_string()))?;
        if reference.provenance.bounces != self.bounces.0 {
            return Err(CheckError::Broken(format!(
                "reference `{}` holds bounces {:?}, the case asks for {:?}",
                self.reference, reference.provenance.bounces, self.bounces.0
            )));
        }
        let samples = context.budget.samples_of_a_pixel(self.samples_per_pixel.0);
        let isolates = context.info.capabilities.contains(Capabilities::ISOLATED_BOUNCES);
        let (direct, bounces) = (self.direct, self.bounces.0);
        let shot = Shot { camera, direct, bounces, samples, isolates };
        let effort = ImageEffort::new(self.detects.0 * context.budget.coarseness(), samples);
        let effort = if context.budget.looks_roughly { effort.halved() } else { effort };
        let differing = that_matter(context.info.conventions, &scene);
        Ok(Setup { scene, reference, shot, effort, differing })
    }

    /// A core that writes 8 bits and nothing else.
    fn by_codes(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let setup = self.setup(context)?;
        let seed = context.seed;
        let mut built = context.core.build_scene(&setup.scene, Acceleration::DEFAULT)?;
        let declared = setup.shot.codes(built.as_mut(), seed.child("encoding"))?.0;
        let judged = by_codes::judge(&setup, declared, &mut |draw| {
            Ok(setup.shot.codes(built.as_mut(), draw.seed(seed))?.1)
        })?;
        drop(built);
        Ok(judged.shown(&setup, context))
    }

    fn by_radiance(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let Setup { scene, reference, shot, effort, differing } = self.setup(context)?;
        let seed = context.seed;
        let mut built = context.core.build_scene(&scene, Acceleration::DEFAULT)?;
        if context.budget.only_glances {
            return Ok(glance(&shot.render(built.as_mut(), ImageDraw::FIRST.seed(seed))?));
        }
        let question =
            stats::Reference { mean: &reference.mean, standard_error: &reference.standard_error };
        let (mut screened, mut first) = (Vec::new(), None);
        let report = judge_image(question, &effort, &mut |draw| {
            let image = shot.render(built.as_mut(), draw.seed(seed))?;
            if draw.stage == Stage::First {
                screened.push(luminances(&image));
                first.get_or_insert_with(|| image.clone());
            }
            Ok::<_, CheckError>(image)
        })?;
        let finding = finding(&report, report.judgement().hypothesis);
        let errors = errors(&screened, shot.samples, &reference);
        let mut finding = regarded(finding, &report, &differing).showing([errors]);
        let tells_why = !context.budget.judges_alone;
        if finding.failed() && report.impossible.is_none() && tells_why {
            let seed = seed.child("clues");
            finding = clues::explained(finding, &report, &reference, &shot, built.as_mut(), seed)?;
        }
        let first = first.filter(|_| self.shows_parts && report.impossible.is_none() && tells_why);
        let parts = match first {
            Some(first) => {
                let asked = Parts { shot: &shot, scene: &scene, can: context.info.capabilities };
                asked.of_core(first, built.as_mut(), seed.child("parts"))?
            }
            None => Vec::new(),
        };
        drop(built);
        let of_parts = parts::caption(&parts, shot.samples);
        let caption =
            format!("mean of {} runs of {} samples per pixel{of_parts}", report.runs, shot.samples);
        let error = error_picture(&report, &reference.mean, &reference.standard_error);
        context.pictures.push(
            Picture::of(PictureRole::Reference, "Mitsuba", reference.mean)
                .with_standard_error(reference.standard_error)
                .with_layers(parts::of_reference(reference.layers.bounces, &parts)),
        );
        context.pictures.push(Picture {
            rejected: rejected(&report),
            ..Picture::of(PictureRole::Render, caption, report.mean)
                .with_standard_error(report.standard_error)
                .with_layers(parts)
        });
        let caption = format!("difference, {ERROR_SCALE} standard errors at the ends of the scale");
        context.show(PictureRole::SignedError, caption, error);
        Ok(finding)
    }
}

fn luminances(image: &Image) -> Vec<f64> {
    image.pixels.iter().map(|pixel| luminance(*pixel)).collect()
}

/// How the error of the screened runs falls as they are put together.
fn errors(runs: &[Vec<f64>], samples: u32, reference: &Reference) -> Series {
    let truth = luminances(&reference.mean);
    let mean = truth.iter().sum::<f64>() / truth.len() as f64;
    // The noise of its channels is taken for independent.
    let variances = reference.standard_error.pixels.iter().map(|error| {
        let weights = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(luminance);
        let terms = error.iter().zip(weights).map(|(error, weight)| f64::from(*error) * weight);
        terms.map(|term| term * term).sum::<f64>()
    });
    let noise = (variances.sum::<f64>() / truth.len() as f64).sqrt();
    convergence::series(&convergence::levels(runs, u64::from(samples), &truth), mean, noise)
}
