//! Equal samples: every pixel of every film is that sample, whatever the size and the number of
//! samples.

use super::film_mistakes::{MISTAKES, Place, TILES, whole_tiles_only};
use crate::cause::{Cause, adaptive, image};
use crate::checks::phrase::{figure, some_are};
use crate::checks::rendering::Rendering;
use crate::checks::{Check, CheckError, Context, Finding, Measure, check};
use crate::contract::{Acceleration, Film};
use crate::stats::{Compared, Tolerance, judge_exact};
use crate::text::{Between, Lit, Several, Size};

/// How far a pixel may be from what a mistake writes, relative: different mistakes are several
/// times as far apart.
const EXPLAINED: f64 = 1e-3;

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

/// A film and the samples that were asked for.
struct Exposed {
    samples: u32,
    film: Film,
}

impl Exposed {
    fn name(&self) -> String {
        format!("{} × {}, {} samples", self.film.width, self.film.height, self.samples)
    }

    /// Every pixel with its place.
    fn pixels(&self) -> impl Iterator<Item = (Place, [f64; 3])> {
        let size = [self.film.width, self.film.height];
        let rows = (0..size[1]).flat_map(move |y| (0..size[0]).map(move |x| [x, y]));
        let place = move |at| Place { at, size, samples: self.samples };
        rows.map(place).zip(self.film.pixels.iter().map(|pixel| pixel.map(f64::from)))
    }
}

impl ConstantFilm {
    fn exposures(&self) -> impl Iterator<Item = ([u32; 2], u32)> {
        let samples = || self.samples_per_pixel.iter().map(|samples| samples.0);
        self.sizes.iter().flat_map(move |size| samples().map(|samples| (size.0, samples)))
    }

    fn judge(&self, films: &[Exposed], allowed: f64) -> Finding {
        let mut measures = Vec::new();
        for exposed in films {
            measures.push(self.worst_pixel(exposed, allowed));
            measures.push(wrong_counts(exposed));
        }
        let right = format!("all pixels of {} films are the sample they are made of", films.len());
        let resolution = format!("would have caught one pixel wrong by {}", figure(allowed));
        let finding = Finding::of(right, resolution, measures);
        if !finding.failed() {
            return finding;
        }
        self.explain(finding.complaining([self.complaint(films, allowed)]), films, allowed)
    }

    fn compared<'a>(
        &'a self,
        exposed: &'a Exposed,
        allowed: f64,
    ) -> impl Iterator<Item = Compared> + 'a {
        let Lit(radiance) = self.radiance;
        exposed.pixels().flat_map(move |(_, pixel)| {
            (0..3).map(move |c| Compared::relative(pixel[c], radiance[c], allowed))
        })
    }

    fn worst_pixel(&self, exposed: &Exposed, allowed: f64) -> Measure {
        let report = judge_exact(self.compared(exposed, allowed));
        Measure::worst("channel of a pixel", &report).of_row(exposed.name())
    }

    /// The film with most wrong pixels, and the first of them.
    fn complaint(&self, films: &[Exposed], allowed: f64) -> String {
        let Lit(radiance) = self.radiance;
        let is_wrong = |pixel: &[f64; 3]| {
            (0..3).any(|c| !Compared::relative(pixel[c], radiance[c], allowed).agrees())
        };
        let wrong = |exposed: &&Exposed| exposed.pixels().filter(|(_, p)| is_wrong(p)).count();
        let worst = films.iter().max_by_key(wrong).filter(|exposed| wrong(exposed) > 0);
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

    fn explain(&self, mut finding: Finding, films: &[Exposed], allowed: f64) -> Finding {
        let all: usize = films.iter().map(|exposed| exposed.film.pixels.len()).sum();
        let pixels_wrong =
            films.iter().flat_map(|e| self.compared(e, allowed)).any(|c| !c.agrees());
        if pixels_wrong {
            for (cause, words) in self.causes(films) {
                finding = finding.because(cause, format!("{words}predicts all {all} pixels"));
            }
        }
        for step in [1, -1] {
            let is_off = |exposed: &Exposed| {
                let expected = exposed.samples.checked_add_signed(step);
                exposed.film.sample_counts.iter().all(|count| Some(*count) == expected)
            };
            if films.iter().all(is_off) {
                let evidence = format!("all {all} counts are {step:+} off");
                finding = finding.because(&image::COUNTS_OFF_BY_ONE, evidence);
            }
        }
        match stops_early(films).filter(|_| !pixels_wrong) {
            Some(count) => {
                let evidence = format!("pixels of more samples than {count} stop at {count}");
                finding.because(&adaptive::ADAPTIVE_ALWAYS, evidence)
            }
            None => finding,
        }
    }

    /// The mistakes that write just these pixels.
    fn causes(&self, films: &[Exposed]) -> Vec<(&'static Cause, String)> {
        let Lit(radiance) = self.radiance;
        let predicts = |develop: &dyn Fn([f64; 3], Place) -> [f64; 3]| {
            films.iter().flat_map(Exposed::pixels).all(|(place, pixel)| {
                let made = develop(radiance, place);
                (0..3).all(|c| (pixel[c] - made[c]).abs() <= EXPLAINED * radiance[c])
            })
        };
        let plain = MISTAKES.iter().filter(|mistake| predicts(&mistake.develop));
        let tile = TILES
            .iter()
            .find(|tile| predicts(&|radiance, place| whole_tiles_only(radiance, place, **tile)));
        let tile = tile
            .map(|tile| (&image::PARTIAL_TILES_LEFT_OUT, format!("a tile of {tile} × {tile} ")));
        plain.map(|mistake| (mistake.cause, String::new())).chain(tile).collect()
    }
}

/// The count at which every pixel stops that was to take more.
fn stops_early(films: &[Exposed]) -> Option<u32> {
    let wrong = films.iter().filter(|e| e.film.sample_counts.iter().any(|n| *n != e.samples));
    let stop = *wrong.clone().next()?.film.sample_counts.first()?;
    let is_stop = |exposed: &Exposed| exposed.film.sample_counts.iter().all(|n| *n == stop);
    let most_asked = wrong.clone().map(|exposed| exposed.samples).min()?;
    (stop > 1 && stop < most_asked && wrong.clone().all(is_stop)).then_some(stop)
}

fn wrong_counts(exposed: &Exposed) -> Measure {
    let counts = exposed.film.sample_counts.iter().map(|count| f64::from(*count));
    let expected = f64::from(exposed.samples);
    let report = judge_exact(counts.map(|count| Compared::within(count, expected, 0.0)));
    Measure::worst("count of samples", &report).of_row(exposed.name())
}

#[cfg(test)]
mod tests {
    use super::super::fake::{FakeFilm, Step};
    use super::*;
    use crate::checks::testing::{assert_passes, check_of, failure, try_judge};
    use crate::scene::SceneDescription;

    fn check() -> ConstantFilm {
        check_of(include_str!(
            "../../../cases/camera/constant-radiance-gives-a-constant-image.toml"
        ))
    }

    fn found(core: FakeFilm) -> Finding {
        let Lit(radiance) = check().radiance;
        let core = FakeFilm { radiance: Box::new(move |_, _| radiance), ..core };
        let scene = SceneDescription { camera: Some(FakeFilm::camera()), ..Default::default() };
        try_judge(&check(), &mut core.core(), Some(scene)).unwrap()
    }

    fn developed(develop: fn([f64; 3], Place) -> [f64; 3]) -> Finding {
        found(FakeFilm { develop, ..FakeFilm::default() })
    }

    fn causes(finding: &Finding) -> Vec<&str> {
        finding.clues.iter().map(|clue| clue.cause.as_str()).collect()
    }

    #[test]
    fn a_film_that_averages_passes() {
        assert_passes(&found(FakeFilm::default()));
    }

    #[test]
    fn pixels_that_stop_early_are_told_from_counts_that_are_off_by_one() {
        let exposed = |samples: u32, count: u32| Exposed {
            samples,
            film: Film {
                width: 1,
                height: 1,
                pixels: vec![[1.0; 3]],
                sample_counts: vec![count],
                variances: Vec::new(),
            },
        };
        assert_eq!(stops_early(&[exposed(1, 1), exposed(64, 32)]), Some(32));
        assert_eq!(stops_early(&[exposed(1, 0), exposed(64, 63)]), None);
        assert_eq!(stops_early(&[exposed(1, 1), exposed(64, 64)]), None);
    }

    #[test]
    fn every_mistake_fails_under_its_own_name_alone() {
        for mistake in MISTAKES {
            let finding = developed(mistake.develop);
            failure(&finding);
            assert_eq!(causes(&finding), [mistake.cause.name]);
        }
        let finding = developed(|radiance, place| whole_tiles_only(radiance, place, 16));
        assert_eq!(causes(&finding), ["partial-tiles-left-out"]);
        assert!(finding.clues[0].evidence.starts_with("a tile of 16 × 16 predicts all"));
    }

    #[test]
    fn the_worst_film_is_told_with_a_pixel() {
        let finding = developed(MISTAKES[0].develop);
        let statement = failure(&finding);
        assert!(statement.contains("pixels are wrong; (0, 0) is (64, 32, 128)"), "{statement}");
    }

    #[test]
    fn one_pixel_a_little_too_dark_fails_and_is_not_explained() {
        let finding = developed(|radiance, place| match place.at {
            [3, 4] => radiance.map(|value| value * (1.0 - 1e-5)),
            _ => radiance,
        });
        failure(&finding);
        assert!(finding.clues.is_empty(), "{finding:?}");
    }

    #[test]
    fn counts_are_looked_at() {
        let finding = found(FakeFilm { count: Step(-1), ..FakeFilm::default() });
        assert!(failure(&finding).contains("a pixel's count says "), "{}", finding.statement);
        assert_eq!(causes(&finding), ["sample-counts-off-by-one"]);
    }
}
