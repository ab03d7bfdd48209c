//! Stratified sampling: a core that says that its pixels are stratified puts one sample in each cell, anywhere in it, as
//! a picture of a [`strata_pattern`](super::strata_pattern) shows.

use super::painting::{FILM, places};
use super::strata::{Tally, mistake};
use super::strata_pattern::{SAMPLES, law, read, scene};
use crate::checks::rendering::Rendering;
use crate::checks::{Check, CheckError, Context, Finding, Measure, check};
use crate::contract::{Acceleration, BuiltScene};
use crate::math::rng::Seed;
use crate::stats::{CountReport, judge_counts};
use crate::text::{Count, Percent};

/// Pictures that are looked at before any are counted: where cells are uneven, that is enough.
const FIRST_LOOK: u64 = 8;

check! {
    /// Four samples lie in the four quarters of each pixel, evenly spread within them.
    pub(crate) struct StratifiedSamples {
        /// The smallest error of the pdf within a cell that must be seen, root mean square.
        detects: Percent,
        /// Past this the verdict is inconclusive, never a pass.
        at_most: Count,
    }
    name: "stratified-samples",
    summary: "one sample in each cell of a pixel, and anywhere in it",
    needs: BUILD_SCENE | RENDER | STRATIFIED_PIXELS,
}

impl Check for StratifiedSamples {
    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let scene = scene();
        let rendering = Rendering::of(&scene, FILM, [0, 0], SAMPLES)?.stratified();
        let effort = context.effort(self.detects, self.at_most).in_steps_of(pixels_of_a_picture());
        let seed = context.seed;
        let mut built = context.core.build_scene(&scene, Acceleration::DEFAULT)?;
        let mut look = |seed: Seed, pictures: u64| -> Result<Tally, CheckError> {
            let mut tally = Tally::default();
            (0..pictures).try_for_each(|picture| {
                take_picture(built.as_mut(), &rendering, seed.child(picture), &mut tally)
            })?;
            Ok(tally)
        };
        let mut all = look(seed.child("look"), FIRST_LOOK)?;
        if all.is_uneven() {
            return Ok(finding(&all, None));
        }
        let report = judge_counts(&law([0.0, 1.0]), &effort, &mut |stage, samples| {
            let tally = look(seed.child(stage), samples / pixels_of_a_picture())?;
            all.add(&tally);
            Ok::<_, CheckError>(tally.counts)
        })?;
        Ok(finding(&all, Some(&report)))
    }
}

fn pixels_of_a_picture() -> u64 {
    u64::from(FILM[0]) * u64::from(FILM[1])
}

fn take_picture(
    scene: &mut dyn BuiltScene,
    rendering: &Rendering,
    seed: Seed,
    tally: &mut Tally,
) -> Result<(), CheckError> {
    let film = rendering.film(scene, seed.0, 0)?;
    for (at, pixel) in places().zip(&film.pixels) {
        tally.take(read(at, *pixel));
    }
    Ok(())
}

fn finding(all: &Tally, report: Option<&CountReport>) -> Finding {
    let none = |name: &str, found: u64| Measure::exact(name, found as f64, 0.0, 0.0);
    let mut measures = vec![
        none("pixels with two samples in one cell", all.uneven()),
        none("pixels that are no mean of four samples", all.unreadable),
    ];
    let name = "χ² per degree of freedom, places within a cell";
    measures.extend(report.map(|report| Measure::of(name, report)));
    let caught = "would have caught a single pixel with two samples in one cell";
    let failed = measures.iter().any(Measure::failed);
    let finding = match report {
        Some(_) => Finding::measured(statement(all, failed), measures)
            .in_terms(" of the pdf within a cell"),
        None => Finding::of(statement(all, failed), caught, measures),
    };
    finding.because_of(failed.then(|| mistake(all, report)).flatten())
}

fn statement(all: &Tally, failed: bool) -> String {
    let Tally { pixels, .. } = all;
    if !failed {
        return format!("{pixels} pixels have one sample in each cell, anywhere in it");
    }
    match (all.unreadable, all.uneven()) {
        (0, 0) => "within their cells the samples of pixels are not evenly spread".to_owned(),
        (0, uneven) => format!("{uneven} of {pixels} pixels have two samples in one of four cells"),
        (unreadable, _) => format!("{unreadable} of {pixels} pixels are no mean of four samples"),
    }
}

#[cfg(test)]
mod tests {
    use super::super::fake::FakeFilm;
    use super::super::strata_pattern::radiance_at;
    use super::*;
    use crate::cause::{Cause, camera};
    use crate::checks::testing::{assert_passes, causes, check_of, failure};
    use glam::DVec2;

    /// Where sample number so-and-so lies in its pixel, with two uniform numbers.
    type Arrange = fn(u32, DVec2) -> DVec2;

    fn cell(number: u32, within: DVec2) -> DVec2 {
        (DVec2::new(f64::from(number % 2), f64::from(number / 2)) + within) / 2.0
    }

    fn found(arrange: Arrange) -> Finding {
        let check: StratifiedSamples = check_of("[expect]\ndetects = \"15 %\"\nat-most = \"50 k\"");
        let radiance = Box::new(|at, _| radiance_at(at));
        FakeFilm { radiance, arrange, ..FakeFilm::default() }.judged_by(&check)
    }

    #[test]
    fn one_sample_in_each_cell_passes_in_any_order() {
        assert_passes(&found(cell));
        assert_passes(&found(|number, u| cell(3 - number, DVec2::new(1.0 - u.y, u.x))));
    }

    #[test]
    fn every_mistake_fails_under_its_own_name() {
        let mistakes: [(Arrange, &Cause); 6] = [
            (|_, u| u, &camera::STRATA_IGNORED),
            (|number, u| cell(3 * (number % 2), u), &camera::STRATA_UNEVEN),
            (|number, u| cell(2 * (number % 2), u), &camera::STRATA_UNEVEN),
            (|number, _| cell(number, DVec2::splat(0.5)), &camera::STRATUM_CENTRE),
            (|number, u| cell(number, 0.5 * u), &camera::STRATUM_HALF),
            (|number, u| cell(number, 0.5 * u + 0.25), &camera::STRATUM_HALF),
        ];
        for (arrange, cause) in mistakes {
            let finding = found(arrange);
            assert_eq!(causes(&finding), [cause.name], "{}", finding.statement);
        }
    }

    #[test]
    fn one_sample_in_a_thousand_in_another_cell_fails_without_a_name() {
        let finding = found(|number, u| match u.x < 1e-3 {
            true => cell(0, DVec2::splat(u.y)),
            false => cell(number, u),
        });
        assert!(failure(&finding).contains("two samples in one of four cells"), "{finding:?}");
        assert!(finding.clues.is_empty());
    }
}
