//! The samples of a pixel cover it evenly, and nothing else, as a picture of a [`pattern`](super::pattern) shows.
//!
//! Not here: the first sample of a pixel, which some cores send through its centre; pictures of one
//! sample are not asked for.

use super::painting::FILM;
use super::pattern::{CELLS, SAMPLES, lit_pixels, scene, share};
use super::pixel_laws::{MISTAKES, Tally};
use crate::checks::phrase::percent;
use crate::checks::rendering::Rendering;
use crate::checks::{Check, CheckError, Context, Finding, Measure, check};
use crate::contract::{Acceleration, BuiltScene};
use crate::math::rng::Seed;
use crate::stats::{Band, Claim, MeanReport, judge_means};
use crate::text::{Count, Percent};

/// How far the shares of a mistake may be from those measured: those of two mistakes differ by twice that.
const EXPLAINED: f64 = 0.02;

check! {
    /// Fifths of a pixel, in columns, rows and diagonals, get a fifth of the samples each.
    pub(crate) struct PixelSamples {
        /// The smallest error of a fifth's share that must be seen.
        detects: Percent,
        /// Past this the verdict is inconclusive, never a pass.
        at_most: Count,
    }
    name: "pixel-samples",
    summary: "where the samples of a pixel lie, read from a picture",
    needs: BUILD_SCENE | RENDER,
}

impl Check for PixelSamples {
    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let scene = scene();
        let rendering = Rendering::of(&scene, FILM, [0, 0], SAMPLES)?;
        let effort = context.effort(self.detects, self.at_most).with_runs(32);
        let effort = effort.in_steps_of(samples_of_a_picture());
        let seed = context.seed;
        let mut built = context.core.build_scene(&scene, Acceleration::DEFAULT)?;
        let mut all = Tally::default();
        let claims = vec![Claim::share(share(), Band::RADIANCE); 4 * CELLS];
        let reports = judge_means(&claims, &effort, &mut |draw| {
            let tally = take_pictures(built.as_mut(), &rendering, draw.seed(seed), draw.samples)?;
            all.add(&tally);
            Ok::<_, CheckError>(tally.own_shares())
        })?;
        Ok(finding(&reports, &all))
    }
}

fn samples_of_a_picture() -> u64 {
    lit_pixels() * u64::from(SAMPLES)
}

/// As many pictures as it takes to see `samples` in lit pixels.
fn take_pictures(
    scene: &mut dyn BuiltScene,
    rendering: &Rendering,
    seed: Seed,
    samples: u64,
) -> Result<Tally, CheckError> {
    let mut tally = Tally::default();
    for picture in 0..samples / samples_of_a_picture() {
        let film = rendering.film(scene, seed.child(picture).0, 0)?;
        tally.add(&Tally::of_picture(&film.pixels));
    }
    Ok(tally)
}

const LINES: [&str; 4] = ["column", "row", "falling diagonal", "rising diagonal"];

fn finding(reports: &[MeanReport], all: &Tally) -> Finding {
    let share = |(number, report): (usize, &MeanReport)| {
        let line = format!("{} {}", LINES[number / CELLS], number % CELLS + 1);
        Measure::of("share", report).of_row(line)
    };
    let none = |name: &str, found: f64| Measure::exact(name, found, 0.0, 0.0);
    let measures = reports.iter().enumerate().map(share).chain([
        none("samples that see another pixel", all.strayed),
        none("pixels that are no mean of three samples", all.unreadable as f64),
    ]);
    let finding =
        Finding::measured(format!("{} samples lie evenly in their pixels", all.samples), measures)
            .in_terms(" of the share of a fifth of the pixel");
    if !finding.failed() {
        return finding;
    }
    let finding = finding.complaining([complaint(all)]);
    // Of pixels that cannot be read it is not known where their samples lie.
    if all.unreadable > 0 { finding } else { explain(finding, all) }
}

fn complaint(all: &Tally) -> String {
    if all.unreadable > 0 {
        return format!("{} pixels are no mean of {SAMPLES} samples of the scene", all.unreadable);
    }
    let shares = |line: usize| all.lines[line].map(|count| percent(count / all.samples)).join(", ");
    let strayed = match all.strayed_share() {
        0.0 => String::new(),
        share => format!("; {} of the samples of dark pixels see another pixel", percent(share)),
    };
    format!(
        "the fifths of a pixel from left to right get {} of its samples, from top to bottom {}, \
         its diagonals {}; {} would be even{strayed}",
        shares(0),
        shares(1),
        shares(2),
        percent(share()),
    )
}

fn explain(mut finding: Finding, all: &Tally) -> Finding {
    let found = all.shares();
    for mistake in MISTAKES {
        let expected = Tally::of_law(mistake.law).shares();
        let errors = found.iter().zip(&expected).map(|(found, right)| (found - right).abs());
        let errors: Vec<_> = errors.collect();
        if errors.iter().all(|error| *error <= EXPLAINED) {
            let largest = errors.into_iter().fold(0.0, f64::max);
            let what = "predicts the share of every fifth and of every border to";
            finding = finding.because(mistake.cause, format!("{what} {}", percent(largest)));
        }
    }
    finding
}

#[cfg(test)]
mod tests {
    use super::super::fake::FakeFilm;
    use super::super::pattern::radiance_at;
    use super::super::pixel_laws::Law;
    use super::*;
    use crate::checks::testing::{assert_passes, causes, check_of, failure};

    /// Coarser than the case, so that failing cores take a fraction of a second.
    fn found(core: FakeFilm) -> Finding {
        let check: PixelSamples = check_of("[expect]\ndetects = \"30 %\"\nat-most = \"5 k\"");
        FakeFilm { radiance: Box::new(|at, _| radiance_at(at)), ..core }.judged_by(&check)
    }

    fn placed(place: Law) -> Finding {
        found(FakeFilm { place, ..FakeFilm::default() })
    }

    #[test]
    fn an_even_spread_passes() {
        assert_passes(&placed(|u| u));
    }

    #[test]
    fn every_mistake_fails_under_its_own_name_alone() {
        for mistake in MISTAKES {
            let finding = placed(mistake.law);
            assert_eq!(causes(&finding), [mistake.cause.name], "{}", finding.statement);
        }
    }

    #[test]
    fn a_spread_that_is_a_fifth_too_narrow_fails_and_is_told_in_shares() {
        let finding = placed(|u| 0.8 * u + 0.1);
        let statement = failure(&finding);
        let told = "the fifths of a pixel from left to right get 12.";
        assert!(statement.starts_with(told), "{statement}");
        assert!(finding.clues.is_empty());
    }

    #[test]
    fn pixels_that_are_no_means_are_told() {
        let finding =
            found(FakeFilm { develop: |mean, _| mean.map(|v| 0.9 * v), ..FakeFilm::default() });
        assert!(failure(&finding).contains("pixels are no mean of 3 samples"), "{finding:?}");
    }
}
