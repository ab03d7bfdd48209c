//! The same seed gives the same bits, whatever the number of threads.

use crate::cause::{self, Cause};
use crate::checks::rendering::Rendering;
use crate::checks::{Check, Context, Finding, Measure, Result, check};
use crate::contract::{Acceleration, Film};
use crate::text::{Between, Bounces, Size};

check! {
    pub(crate) struct SameSeedSamePicture {
        size: Size,
        bounces: Bounces,
        samples_per_pixel: Between<1, 65536>,
    }
    name: "same-seed-same-picture",
    summary: "the same seed gives the same bits, on one thread or many",
    needs: BUILD_SCENE | RENDER | DETERMINISTIC,
}

impl Check for SameSeedSamePicture {
    fn run(&self, context: &mut Context<'_>) -> Result<Finding> {
        let scene = context.scene()?;
        let seed = context.seed.0;
        let picture = Rendering::of(&scene, self.size.0, self.bounces.0, self.samples_per_pixel.0)?;
        let mut built = context.core.build_scene(&scene, Acceleration::DEFAULT)?;
        let first = picture.film(built.as_mut(), seed, 0)?;
        let again = picture.film(built.as_mut(), seed, 0)?;
        let alone = picture.film(built.as_mut(), seed, 1)?;
        drop(built);
        let mut rebuilt = context.core.build_scene(&scene, Acceleration::DEFAULT)?;
        let anew = picture.film(rebuilt.as_mut(), seed, 0)?;
        let pixels = first.pixels.len();
        let measures: Vec<_> =
            [("rendered again", again), ("on one thread", alone), ("built anew", anew)]
                .into_iter()
                .map(|(name, other)| differing(name, &first, &other))
                .collect();
        let worst = measures.iter().find(|measure| measure.measured > 0.0);
        let statement = match worst {
            None => "the same seed gives the same bits".to_owned(),
            Some(measure) => {
                format!("{}: {} of {pixels} pixels differ", measure.row, measure.measured)
            }
        };
        let cause = cause(&measures);
        let evidence = statement.clone();
        Ok(Finding::of(statement, "would have caught one bit in one pixel", measures)
            .because_each(cause, &evidence))
    }
}

/// Pictures differ each time, or only with the number of threads.
fn cause(measures: &[Measure]) -> Option<&'static Cause> {
    let differs = |name: &str| measures.iter().any(|m| m.row == name && m.measured > 0.0);
    match (differs("rendered again"), differs("on one thread")) {
        (true, _) => Some(&cause::integrator::NOT_REPRODUCIBLE),
        (false, true) => Some(&cause::integrator::THREADS_MATTER),
        (false, false) => None,
    }
}

/// How many pixels have not the same bits.
fn differing(name: &str, first: &Film, other: &Film) -> Measure {
    let bits = |pixel: &[f32; 3]| pixel.map(f32::to_bits);
    let pairs = first.pixels.iter().zip(&other.pixels);
    let count = pairs.filter(|(a, b)| bits(a) != bits(b)).count();
    Measure::none("pixels that differ", count).of_row(name)
}
