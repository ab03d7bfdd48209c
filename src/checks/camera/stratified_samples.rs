//! Stratified sampling: a core that says that its pixels are stratified puts one sample in each cell, anywhere in it, as
//! a picture of a [`strata_pattern`](super::strata_pattern) shows.

use super::painting::{FILM, places};
use super::strata::{Tally, mistake};
use super::strata_pattern::{SAMPLES, law, read, scene};
use crate::checks::rendering::Rendering;
use crate::checks::{Check, CheckError, Context, Finding, Measure, check};
use crate::contract::{Acceleration, BuiltScene, Capabilities};
use crate::math::rng::Seed;
use crate::stats::{
    CellProbabilities, CountReport, CountSource, Counts, Stage, batch_size, judge_count_source,
};
use crate::text::{Count, Percent};

/// Pictures that are looked at before any are counted: where cells are uneven, that is enough.
const FIRST_LOOK: u64 = 8;
/// Pictures that tell how much counts vary where pixels may depend on each other.
const FEWEST_PICTURES: u64 = 32;

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
        let is_promised = context.info.capabilities.contains(Capabilities::INDEPENDENT_PIXELS);
        let fewest = if is_promised { 1 } else { FEWEST_PICTURES };
        let effort = context.effort(self.detects, self.at_most);
        let effort = effort.in_steps_of(fewest * pixels_of_a_picture());
        let seed = context.seed;
        let mut built = context.core.build_scene(&scene, Acceleration::DEFAULT)?;
        let (scene, pictures) = (built.as_mut(), Vec::new());
        let mut places = Places {
            scene,
            rendering: &rendering,
            seed,
            all: Tally::default(),
            is_promised,
            pictures,
        };
        for number in 0..FIRST_LOOK {
            places.picture(seed.child("look").child(number))?;
        }
        if places.all.is_uneven() {
            return Ok(finding(&places.all, None));
        }
        let report = judge_count_source(&effort, &mut places)?;
        Ok(finding(&places.all, Some(&report)))
    }
}

/// Where in its cell one sample of each pixel lies.
struct Places<'a> {
    scene: &'a mut dyn BuiltScene,
    rendering: &'a Rendering,
    seed: Seed,
    /// What all pictures so far have shown.
    all: Tally,
    /// Whether the pixels of one picture are independent.
    is_promised: bool,
    /// Those last drawn, one by one.
    pictures: Vec<Counts>,
}

impl Places<'_> {
    fn picture(&mut self, seed: Seed) -> Result<Counts, CheckError> {
        let film = self.rendering.film(self.scene, seed.0, 0)?;
        let mut tally = Tally::default();
        for (at, pixel) in places().zip(&film.pixels) {
            let reading = read(at, *pixel);
            tally.take(reading);
            self.all.take(reading);
        }
        Ok(tally.counts)
    }
}

impl CountSource for Places<'_> {
    type Error = CheckError;

    fn expected(&mut self, _: Stage) -> Result<CellProbabilities, CheckError> {
        Ok(law([0.0, 1.0]))
    }

    fn draw(&mut self, stage: Stage, samples: u64) -> Result<Counts, CheckError> {
        let seed = self.seed.child(stage);
        let samples = if self.is_promised { samples } else { batch_size(samples, 1) };
        let pictures = 0..samples / pixels_of_a_picture();
        self.pictures =
            pictures.map(|number| self.picture(seed.child(number))).collect::<Result<_, _>>()?;
        let mut all = Tally::default().counts;
        self.pictures.iter().for_each(|picture| all.add(picture));
        Ok(all)
    }

    fn batches(&self) -> &[Counts] {
        if self.is_promised { &[] } else { &self.pictures }
    }
}

fn pixels_of_a_picture() -> u64 {
    u64::from(FILM[0]) * u64::from(FILM[1])
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
