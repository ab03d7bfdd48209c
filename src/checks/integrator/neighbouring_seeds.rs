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

/// Signs of each pixel's difference to its mean over all seeds: as in `seeds-matter`, the
/// few pixels that are a hundred times as noisy as the rest would otherwise decide alone.
struct Noise(Vec<Vec<f64>>);

impl Noise {
    fn of(films: &[Film]) -> Self {
        let count = films.len() as f64;
        let pixels = films.first().map_or(0, |film| film.pixels.len());
        let mean: Vec<f64> = (0..pixels)
            .map(|pixel| {
                films.iter().map(|film| luminance(film.pixels[pixel])).sum::<f64>() / count
            })
            .collect();
        let sign = |(pixel, mean): (&[f32; 3], &f64)| {
            let off = luminance(*pixel) - mean;
            if off == 0.0 { 0.0 } else { off.signum() }
        };
        Self(films.iter().map(|film| film.pixels.iter().zip(&mean).map(sign).collect()).collect())
    }
}

/// The noise of a seed against that of the next, so many pixels further.
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

    #[test]
    fn a_seed_that_is_added_to_the_pixel_is_named() {
        let finding = found(|seed, pixel| seed + pixel);
        assert_eq!(finding.verdict, Verdict::Fail);
        assert_eq!(finding.clues[0].cause, "seed-plus-pixel");
        assert!(
            finding.statement.contains("one pixel to the left: correlation 0.9"),
            "{}",
            finding.statement
        );
        let rows = found(|seed, pixel| WIDTH * seed + pixel);
        assert!(rows.statement.contains("one pixel above"), "{}", rows.statement);
    }
}
