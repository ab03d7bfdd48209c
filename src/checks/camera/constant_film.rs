//! Equal samples: every pixel of every film is that sample, whatever the size and the number of samples.

use super::exposed::{Exposed, channels, explained};
use crate::checks::phrase::{figure, some_are};
use crate::checks::rendering::Rendering;
use crate::checks::{Check, CheckError, Context, Finding, Measure, check};
use crate::contract::Acceleration;
use crate::stats::{Compared, Tolerance, judge_exact};
use crate::text::{Between, Lit, Several, Size};

check! {
    /// A scene that sends the same radiance into every pixel, in films of several sizes.
    pub(crate) struct ConstantFilm {
        /// What every ray brings home: different in every channel, none of them 0.
        radiance: Lit,
        /// Columns and rows.
        sizes: Several<Size>,
        samples_per_pixel: Several<Between<1, 65536>>,
    }
    name: "constant-film",
    summary: "equal samples make equal pixels, in films of all sizes",
    needs: BUILD_SCENE | RENDER,
}

impl Check for ConstantFilm {
    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let scene = context.scene()?;
        let seed = context.seed;
        let mut built = context.core.build_scene(&scene, Acceleration::DEFAULT)?;
        let mut films = Vec::new();
        for (size, samples) in self.exposures() {
            let rendering = Rendering::of(&scene, size, [0, 0], samples)?;
            films.push(Exposed { samples, film: rendering.film(built.as_mut(), seed.0, 0)? });
        }
        drop(built);
        Ok(self.judge(&films, Tolerance::PIXEL.of(context.info.precision)))
    }
}

impl ConstantFilm {
    fn exposures(&self) -> impl Iterator<Item = ([u32; 2], u32)> {
        let samples = || self.samples_per_pixel.iter().map(|samples| samples.0);
        self.sizes.iter().flat_map(move |size| samples().map(|samples| (size.0, samples)))
    }

    fn judge(&self, films: &[Exposed], allowed: f64) -> Finding {
        let Lit(radiance) = self.radiance;
        let measures: Vec<_> = films
            .iter()
            .flat_map(|film| [worst_pixel(film, radiance, allowed), wrong_counts(film)])
            .collect();
        let right = format!("all pixels of {} films are the sample they are made of", films.len());
        let resolution = format!("would have caught one pixel wrong by {}", figure(allowed));
        let finding = Finding::of(right, resolution, measures);
        if !finding.failed() {
            return finding;
        }
        let complaint = complaint(films, radiance, allowed);
        explained(finding.complaining([complaint]), films, radiance, allowed)
    }
}

fn worst_pixel(exposed: &Exposed, radiance: [f64; 3], allowed: f64) -> Measure {
    let pixels = exposed.pixels();
    let report = judge_exact(pixels.flat_map(|(_, pixel)| channels(pixel, radiance, allowed)));
    Measure::worst("channel of a pixel", &report).of_row(exposed.name())
}

fn wrong_counts(exposed: &Exposed) -> Measure {
    let counts = exposed.film.sample_counts.iter().map(|count| f64::from(*count));
    let expected = f64::from(exposed.samples);
    let report = judge_exact(counts.map(|count| Compared::within(count, expected, 0.0)));
    Measure::worst("count of samples", &report).of_row(exposed.name())
}

/// The film with most wrong pixels, and the first of them.
fn complaint(films: &[Exposed], radiance: [f64; 3], allowed: f64) -> String {
    let is_wrong =
        |pixel: &[f64; 3]| channels(*pixel, radiance, allowed).iter().any(|c| !c.agrees());
    let wrong = |exposed: &&Exposed| exposed.pixels().filter(|(_, p)| is_wrong(p)).count();
    let worst = films.iter().max_by_key(wrong);
    let pixels = worst.and_then(|exposed| {
        let (place, pixel) = exposed.pixels().find(|(_, pixel)| is_wrong(pixel))?;
        let some = some_are(wrong(&exposed), exposed.film.pixels.len(), "pixels");
        let [found, right] = [pixel, radiance].map(|rgb| rgb.map(figure).join(", "));
        let [x, y] = place.at;
        let name = exposed.name();
        Some(format!("{name}: {some} wrong; ({x}, {y}) is ({found}) instead of ({right})"))
    });
    let counts = films.iter().find_map(|exposed| {
        let found = exposed.film.sample_counts.iter().find(|n| **n != exposed.samples)?;
        Some(format!("{}: a pixel's count says {found}", exposed.name()))
    });
    [pixels, counts].into_iter().flatten().collect::<Vec<_>>().join("; ")
}

#[cfg(test)]
mod tests {
    use super::super::fake::{FakeFilm, Step};
    use super::super::film_mistakes::{MISTAKES, Place, whole_tiles_only};
    use super::*;
    use crate::checks::testing::{assert_passes, causes, check_of, failure};

    fn check() -> ConstantFilm {
        check_of(include_str!(
            "../../../cases/camera/constant-radiance-gives-a-constant-image.toml"
        ))
    }

    fn found(core: FakeFilm) -> Finding {
        let Lit(radiance) = check().radiance;
        FakeFilm { radiance: Box::new(move |_, _| radiance), ..core }.judged_by(&check())
    }

    fn developed(develop: fn([f64; 3], Place) -> [f64; 3]) -> Finding {
        found(FakeFilm { develop, ..FakeFilm::default() })
    }

    #[test]
    fn a_film_that_averages_passes() {
        assert_passes(&found(FakeFilm::default()));
    }

    #[test]
    fn every_mistake_fails_under_its_own_name_alone() {
        for mistake in MISTAKES {
            assert_eq!(causes(&developed(mistake.develop)), [mistake.cause.name]);
        }
        let finding = developed(|radiance, place| whole_tiles_only(radiance, place, 16));
        assert_eq!(causes(&finding), ["partial-tiles-left-out"]);
        assert!(finding.clues[0].evidence.starts_with("a tile of 16 × 16 predicts all"));
    }

    #[test]
    fn films_that_are_black_throughout_are_not_explained() {
        assert!(causes(&developed(|_, _| [0.0; 3])).is_empty());
    }

    #[test]
    fn the_worst_film_is_told_with_a_pixel() {
        let finding = developed(MISTAKES[0].develop);
        let statement = failure(&finding);
        assert!(statement.contains("pixels are wrong; (0, 0) is (16, 32, 128)"), "{statement}");
    }

    #[test]
    fn one_pixel_a_little_too_dark_fails_and_is_not_explained() {
        let finding = developed(|radiance, place| match place.at {
            [3, 4] => radiance.map(|value| value * (1.0 - 1e-5)),
            _ => radiance,
        });
        assert!(causes(&finding).is_empty(), "{finding:?}");
    }

    #[test]
    fn counts_are_looked_at() {
        let finding = found(FakeFilm { count: Step(-1), ..FakeFilm::default() });
        assert!(failure(&finding).contains("a pixel's count says "), "{}", finding.statement);
        assert_eq!(causes(&finding), ["sample-counts-off-by-one"]);
    }

    #[test]
    fn what_is_wrong_with_counts_stands_beside_what_is_wrong_with_pixels() {
        let mistake = MISTAKES.iter().find(|one| one.cause.name == "pixel-adds-one-too-many");
        let develop = mistake.unwrap().develop;
        let finding = found(FakeFilm { develop, count: Step(1), ..FakeFilm::default() });
        let told: Vec<_> =
            finding.clues.iter().map(|clue| (&clue.cause[..], clue.beside)).collect();
        assert_eq!(told, [("pixel-adds-one-too-many", false), ("sample-counts-off-by-one", true)]);
    }
}
