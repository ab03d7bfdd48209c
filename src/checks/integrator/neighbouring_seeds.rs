//! Neighbouring seeds are as unrelated as any: a core that adds the seed to the number of a pixel
//! shows the same noise again, one pixel further.

use crate::cause::{Cause, integrator};
use crate::checks::phrase::figure;
use crate::checks::rendering::Rendering;
use crate::checks::{Check, Context, Finding, Measure, Result, check};
use crate::contract::{Acceleration, Film};
use crate::image::luminance;
use crate::stats::{CorrelationReport, Verdict, judge_uncorrelated};
use crate::text::{Between, Bounces, Size};

/// Seeds that follow each other.
const SEEDS: u64 = 16;
/// Seeds between the two of a difference: those of the next difference are the next seeds.
const APART: usize = 8;
/// Noise that is this much alike is the same noise, seen through another pixel.
const REPEATED: f64 = 0.3;

check! {
    pub(crate) struct NeighbouringSeeds {
        size: Size,
        bounces: Bounces,
        samples_per_pixel: Between<1, 65536>,
    }
    name: "neighbouring-seeds",
    summary: "the noise of consecutive seeds is not one picture, shifted",
    needs: BUILD_SCENE | RENDER,
}

impl Check for NeighbouringSeeds {
    fn run(&self, context: &mut Context<'_>) -> Result<Finding> {
        let scene = context.scene()?;
        let picture = Rendering::of(&scene, self.size.0, self.bounces.0, self.samples_per_pixel.0)?;
        // Far from the largest seed, so that none of them wraps around.
        let first = context.seed.0 / 2;
        let mut built = context.core.build_scene(&scene, Acceleration::DEFAULT)?;
        let films = (0..SEEDS)
            .map(|number| picture.film(built.as_mut(), first + number, 0))
            .collect::<Result<Vec<_>, _>>()?;
        let noise = Noise::of(&films);
        let shifts = self.shifts().map(|(pixels, words)| Shift::of(&noise, pixels, words));
        Ok(finding(&shifts))
    }
}

impl NeighbouringSeeds {
    /// By how many pixels the noise of the next seed may have moved.
    fn shifts(&self) -> [(isize, &'static str); 4] {
        let row = isize::try_from(self.size.0[0]).unwrap_or(isize::MAX);
        [
            (-1, "one pixel to the left"),
            (1, "one pixel to the right"),
            (-row, "one pixel above"),
            (row, "one pixel below"),
        ]
    }
}

/// Signs of each pixel's difference between two seeds: as in `seeds-matter`, the few pixels that are a hundred times
/// as noisy as the rest would otherwise decide alone. A difference is as often above 0 as below, whatever the picture;
/// one to a mean is not where a few samples carry the light, and by as much as they do: parts of a picture would agree.
struct Noise(Vec<Vec<f64>>);

impl Noise {
    fn of(films: &[Film]) -> Self {
        let sign = |(one, other): (&[f32; 3], &[f32; 3])| {
            let difference = luminance(*one) - luminance(*other);
            if difference == 0.0 { 0.0 } else { difference.signum() }
        };
        let signs =
            |(one, other): (&Film, &Film)| one.pixels.iter().zip(&other.pixels).map(sign).collect();
        Self(films.iter().zip(&films[APART..]).map(signs).collect())
    }
}

/// The noise of two seeds against that of the next two, so many pixels further.
struct Shift {
    words: &'static str,
    report: CorrelationReport,
}

impl Shift {
    fn of(Noise(seeds): &Noise, pixels: isize, words: &'static str) -> Self {
        let mut pairs = Vec::new();
        for two in seeds.windows(2) {
            for (pixel, here) in two[0].iter().enumerate() {
                let there = pixel.checked_add_signed(pixels).and_then(|other| two[1].get(other));
                pairs.extend(
                    there.filter(|there| *here * **there != 0.0).map(|there| [*here, *there]),
                );
            }
        }
        Self { words, report: judge_uncorrelated(&pairs) }
    }

    fn measure(&self) -> Measure {
        Measure::of("correlation with the next seed", &self.report).of_row(self.words)
    }

    /// The same numbers, a pixel further.
    fn cause(&self) -> Option<(&'static Cause, String)> {
        let (words, told) = (self.words, figure(self.report.coefficient));
        let evidence = format!(
            "the noise of each seed comes again with the next, {words}: correlation {told}"
        );
        let repeats = self.report.coefficient >= REPEATED;
        repeats.then_some((&integrator::SEED_PLUS_PIXEL, evidence))
    }
}

fn finding(shifts: &[Shift]) -> Finding {
    let measures: Vec<_> = shifts.iter().map(Shift::measure).collect();
    let worst = shifts.iter().find(|shift| shift.report.verdict == Verdict::Fail);
    let doubt = shifts.iter().find_map(|shift| shift.report.doubt());
    let statement = match worst {
        None => {
            doubt.unwrap_or_else(|| format!("the noise of {SEEDS} consecutive seeds is unrelated"))
        }
        Some(shift) => format!(
            "the noise of a seed is that of the one before, {}: correlation {}",
            shift.words,
            figure(shift.report.coefficient)
        ),
    };
    let limit = shifts.iter().map(|shift| shift.report.limit).fold(0.0, f64::max);
    let resolution = format!("would have caught a correlation of {}", figure(2.0 * limit));
    Finding::of(statement, resolution, measures)
        .because_of(shifts.iter().find_map(Shift::cause).filter(|_| worst.is_some()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rng::{Seed, uniform};

    const WIDTH: u64 = 24;

    /// Pictures whose pixels are made of the first number of a stream each.
    fn films(stream: fn(seed: u64, pixel: u64) -> u64) -> Vec<Film> {
        let film = |seed: u64| {
            let pixel = |pixel| [uniform(&mut Seed(stream(seed, pixel)).stream()) as f32; 3];
            let pixels = (0..WIDTH * 18).map(pixel).collect();
            Film { width: WIDTH as u32, height: 18, pixels, ..Film::default() }
        };
        (0..SEEDS).map(film).collect()
    }

    fn found(stream: fn(u64, u64) -> u64) -> Finding {
        let check = NeighbouringSeeds {
            size: Size([WIDTH as u32, 18]),
            bounces: Bounces([0, 1]),
            samples_per_pixel: Between(1),
        };
        let noise = Noise::of(&films(stream));
        finding(&check.shifts().map(|(pixels, words)| Shift::of(&noise, pixels, words)))
    }

    #[test]
    fn mixed_seeds_pass() {
        assert_eq!(found(|seed, pixel| Seed(seed).child(pixel).0).verdict, Verdict::Pass);
    }

    /// On the left one pixel in fifty is a thousand times as bright as all others.
    fn bright_on_the_left(seed: u64) -> Film {
        let mut stream = Seed(seed).child("picture").stream();
        let mut pixel = |number: u64| {
            let is_rare = uniform(&mut stream) < 0.02 && number % WIDTH < WIDTH / 2;
            [uniform(&mut stream) as f32 + if is_rare { 1000.0 } else { 0.0 }; 3]
        };
        let pixels = (0..WIDTH * 18).map(&mut pixel).collect();
        Film { width: WIDTH as u32, height: 18, pixels, ..Film::default() }
    }

    #[test]
    fn bright_rare_samples_in_one_part_of_the_picture_are_no_pattern() {
        let coefficients_in_errors = (0..200).map(|round| {
            let films: Vec<_> =
                (0..SEEDS).map(|seed| bright_on_the_left(round * SEEDS + seed)).collect();
            let report = Shift::of(&Noise::of(&films), 1, "one pixel to the right").report;
            assert_eq!(report.verdict, Verdict::Pass, "{report:?}");
            report.coefficient * (report.pairs as f64).sqrt()
        });
        // Standard normal, by theory: 200 squares add up to 200 ± 20.
        let squares: f64 = coefficients_in_errors.map(|error| error * error).sum();
        assert!((120.0..280.0).contains(&squares), "{squares}");
    }

    #[test]
    fn a_seed_that_is_added_to_the_pixel_is_named() {
        let finding = found(|seed, pixel| seed + pixel);
        assert_eq!(finding.verdict, Verdict::Fail);
        assert_eq!(finding.clues[0].cause, "seed-plus-pixel");
        assert!(
            finding.statement.contains("one pixel to the left: correlation 1"),
            "{}",
            finding.statement
        );
        let rows = found(|seed, pixel| WIDTH * seed + pixel);
        assert!(rows.statement.contains("one pixel above"), "{}", rows.statement);
    }
}
