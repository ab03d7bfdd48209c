//! Different seeds give different noise; and neighbouring pixels have nothing to do with each other, where a core
//! promises that.

use crate::cause::{self, Cause};
use crate::checks::rendering::Rendering;
use crate::checks::{Check, Context, Finding, Measure, Result, check};
use crate::contract::{Acceleration, Capabilities, Film};
use crate::image::luminance;
use crate::stats::{CorrelationReport, Verdict, judge_uncorrelated};
use crate::text::number::figure;
use crate::text::{Between, Bounces, Size};

check! {
    pub(crate) struct SeedsMatter {
        size: Size,
        bounces: Bounces,
        samples_per_pixel: Between<1, 65536>,
        /// How many; differences are taken in pairs.
        seeds: Between<4, 4096>,
    }
    name: "seeds-matter",
    summary: "different seeds give different noise; pixels are independent",
    needs: BUILD_SCENE | RENDER,
}

impl Check for SeedsMatter {
    fn run(&self, context: &mut Context<'_>) -> Result<Finding> {
        let scene = context.scene()?;
        let picture = Rendering::of(&scene, self.size.0, self.bounces.0, self.samples_per_pixel.0)?;
        let seed = context.seed;
        let mut built = context.core.build_scene(&scene, Acceleration::DEFAULT)?;
        let n = self.seeds.0;
        let films = (0..n)
            .map(|run| picture.film(built.as_mut(), seed.child(run).0, 0))
            .collect::<Result<Vec<_>, _>>()?;
        let is_promised = context.info.capabilities.contains(Capabilities::INDEPENDENT_PIXELS);
        let reports = if is_promised { correlations(&films) } else { Vec::new() };
        let mut measures = vec![equal_pictures(&films)];
        measures.extend(reports.iter().map(|(direction, report)| {
            Measure::of(format!("correlation of pixels {direction}"), report)
        }));
        let doubt = reports.iter().find_map(|(_, report)| report.doubt());
        let statement = match measures.iter().find(|measure| measure.failed()) {
            None => doubt.unwrap_or_else(|| format!("{n} seeds give {n} different pictures")),
            Some(measure) => {
                let (name, is) = (measure.name(), figure(measure.measured));
                format!("the noise is not independent: {name} is {is}")
            }
        };
        let resolution = match measures.get(1) {
            Some(one) => {
                format!("would have caught a correlation of {}", figure(2.0 * one.allowed))
            }
            None => "would have caught one picture of two seeds".to_owned(),
        };
        let cause = cause(&measures, films.len());
        let evidence = statement.clone();
        Ok(Finding::of(statement, resolution, measures).because_each(cause, &evidence))
    }
}

/// Every picture is the same, or else every pixel's noise is.
fn cause(measures: &[Measure], pictures: usize) -> Option<&'static Cause> {
    let (equal, correlations) = measures.split_first()?;
    let is_shared = |measure: &Measure| measure.failed() && measure.measured >= SHARED;
    if equal.failed() && equal.measured as usize == pictures - 1 {
        Some(&cause::integrator::SEED_IGNORED)
    } else if !correlations.is_empty() && correlations.iter().all(is_shared) {
        Some(&cause::integrator::PIXELS_SHARE_NOISE)
    } else {
        None
    }
}

/// Pictures of different seeds that have the same bits.
fn equal_pictures(films: &[Film]) -> Measure {
    let is_repeated = |i: usize| films[..i].iter().any(|earlier| earlier.pixels == films[i].pixels);
    let repeated = (1..films.len()).filter(|i| is_repeated(*i)).count();
    let measure = Measure::none("pictures that an earlier seed has given", repeated);
    // Where nothing is to be seen there is no noise that could differ.
    let is_plain = |film: &Film| film.pixels.windows(2).all(|two| two[0] == two[1]);
    match films.iter().all(is_plain) {
        true => Measure { verdict: Verdict::Inconclusive, ..measure },
        false => measure,
    }
}

/// Noise that is nearly the same in neighbouring pixels.
const SHARED: f64 = 0.5;

/// Of pixels side by side, and of pixels above each other: a promise of its own, which not every core makes.
fn correlations(films: &[Film]) -> Vec<(&'static str, CorrelationReport)> {
    [("side by side", [1, 0]), ("above each other", [0, 1])]
        .map(|(direction, step)| (direction, neighbours(films, step)))
        .into()
}

/// Correlation of the signs of the noise of pixels that are `step` apart. Differences of two seeds have no picture
/// left in them, and signs count every pixel alike: the few at the edge of a light, a hundred times as noisy as the
/// rest, would otherwise decide alone, and the standard error would not be 1/√n.
fn neighbours(films: &[Film], step: [usize; 2]) -> CorrelationReport {
    let pairs: Vec<_> = films.chunks_exact(2).flat_map(|two| sign_pairs(two, step)).collect();
    judge_uncorrelated(&pairs)
}

/// Signs of the noise of each pixel and of the one `step` further, where both have any.
fn sign_pairs(two: &[Film], step: [usize; 2]) -> Vec<[f64; 2]> {
    let [width, height] = [two[0].width as usize, two[0].height as usize];
    let sign = |x: usize, y: usize| {
        let difference =
            luminance(two[0].pixels[y * width + x]) - luminance(two[1].pixels[y * width + x]);
        if difference == 0.0 { 0.0 } else { difference.signum() }
    };
    let rows = 0..height - step[1];
    let places = rows.flat_map(|y| (0..width - step[0]).map(move |x| (x, y)));
    let pairs = places.map(|(x, y)| [sign(x, y), sign(x + step[0], y + step[1])]);
    pairs.filter(|[here, there]| here * there != 0.0).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rng::{Seed, uniform};

    /// Pictures with a light a hundred times as noisy as the rest; a share of each pixel's noise is its neighbour's.
    fn films(shared: f32) -> Vec<Film> {
        let mut stream = Seed(3).stream();
        let mut film = || {
            let noise: Vec<f32> = (0..48 * 36).map(|_| uniform(&mut stream) as f32).collect();
            let pixel = |i: usize| {
                let scale = if i.is_multiple_of(97) { 100.0 } else { 1.0 };
                [scale * ((1.0 - shared) * noise[i] + shared * noise[i.saturating_sub(1)]); 3]
            };
            let pixels = (0..noise.len()).map(pixel).collect();
            Film { width: 48, height: 36, pixels, ..Film::default() }
        };
        (0..32).map(|_| film()).collect()
    }

    #[test]
    fn independent_pixels_pass_although_some_are_a_hundred_times_as_noisy() {
        assert_eq!(neighbours(&films(0.0), [1, 0]).verdict, Verdict::Pass);
        assert_eq!(neighbours(&films(0.0), [0, 1]).verdict, Verdict::Pass);
    }

    #[test]
    fn noise_that_neighbours_share_is_seen() {
        assert_eq!(neighbours(&films(0.2), [1, 0]).verdict, Verdict::Fail);
    }

    #[test]
    fn pictures_that_repeat_are_counted() {
        let mut films = films(0.0);
        films[7] = films[2].clone();
        assert_eq!(equal_pictures(&films).measured, 1.0);
    }

    #[test]
    fn black_pictures_say_nothing_of_seeds() {
        let black = Film { width: 2, height: 1, pixels: vec![[0.0; 3]; 2], ..Film::default() };
        assert_eq!(equal_pictures(&[black.clone(), black]).verdict, Verdict::Inconclusive);
    }

    #[test]
    fn one_picture_for_all_seeds_and_one_noise_for_all_pixels_are_named() {
        let measures = |equal: f64, correlation: f64| {
            let correlated = Measure::exact("correlation", correlation, 0.0, 0.05);
            [Measure::exact("equal", equal, 0.0, 0.0), correlated.clone(), correlated]
        };
        assert_eq!(cause(&measures(0.0, 0.01), 8), None);
        assert_eq!(cause(&measures(7.0, 0.01), 8), Some(&cause::integrator::SEED_IGNORED));
        assert_eq!(cause(&measures(0.0, 0.97), 8), Some(&cause::integrator::PIXELS_SHARE_NOISE));
        assert_eq!(cause(&measures(1.0, 0.2), 8), None);
        // Pixels that promise nothing are not compared.
        assert_eq!(cause(&measures(0.0, 0.97)[..1], 8), None);
        assert_eq!(cause(&measures(7.0, 0.97)[..1], 8), Some(&cause::integrator::SEED_IGNORED));
    }
}
