//! Different seeds give different noise; and pixels have nothing to do with each other, neighbours or not, where a
//! core promises that.

use super::estimate::RouletteEntry;
use crate::cause::{self, Cause};
use crate::checks::rendering::Rendering;
use crate::checks::{Check, Context, Finding, Measure, Result, check};
use crate::contract::{Acceleration, Capabilities, Film, Roulette};
use crate::image::luminance;
use crate::stats::{CorrelationReport, Verdict, judge_most_related, judge_uncorrelated};
use crate::text::number::figure;
use crate::text::{Between, Bounces, Size};
use rayon::prelude::*;

check! {
    pub(crate) struct SeedsMatter {
        size: Size,
        bounces: Bounces,
        /// In a furnace paths end by it alone, so that pixels of equal random numbers are equal.
        roulette: Option<RouletteEntry>,
        samples_per_pixel: Between<1, 65536>,
        /// How many; differences are taken in pairs.
        seeds: Between<4, 4096>,
    }
    name: "seeds-matter",
    summary: "different seeds give different noise; pixels are independent",
    needs: BUILD_SCENE | RENDER,
}

impl Check for SeedsMatter {
    fn needs_besides(&self) -> Capabilities {
        self.roulette.map_or(Capabilities::empty(), |_| Capabilities::ROULETTE)
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding> {
        let scene = context.scene()?;
        let picture = Rendering::of(&scene, self.size.0, self.bounces.0, self.samples_per_pixel.0)?
            .with_roulette(self.roulette.map(Roulette::from));
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

/// Of pixels side by side, of pixels above each other, and of the most alike further apart: a promise of its own,
/// which not every core makes.
fn correlations(films: &[Film]) -> Vec<(String, CorrelationReport)> {
    let noise: Vec<_> = films.chunks_exact(2).map(Signs::of).collect();
    let neighbours = [("side by side", [1, 0]), ("above each other", [0, 1])];
    let of = |(direction, step): (&str, _)| (direction.to_owned(), apart(&noise, step));
    neighbours.map(of).into_iter().chain(most_alike(&noise)).collect()
}

/// Streams that are numbered by column + row · height repeat where a film is wide, and tiles of noise at every tile:
/// of all steps the one whose pixels are most alike.
fn most_alike(noise: &[Signs]) -> Option<(String, CorrelationReport)> {
    let [width, height] = noise.first()?.size;
    let steps = (0..height).flat_map(|y| (1 - width..width).map(move |x| [x, y]));
    let further: Vec<_> = steps.filter(|[x, y]| (*y, *x) > (0, 1) && [*x, *y] != [0, 1]).collect();
    let reports: Vec<_> = further.into_par_iter().map(|step| (step, apart(noise, step))).collect();
    let direction = |[x, y]: [i32; 2]| {
        let side = if x < 0 { "left" } else { "right" };
        format!("{y} down and {} to the {side}", x.abs())
    };
    judge_most_related(reports).map(|(step, report)| (direction(step), report))
}

/// Correlation of the signs of the noise of pixels that are `step` apart: columns, to either side, and rows down.
fn apart(noise: &[Signs], step: [i32; 2]) -> CorrelationReport {
    let pairs: Vec<_> = noise.iter().flat_map(|signs| signs.pairs(step)).collect();
    judge_uncorrelated(&pairs)
}

/// The signs of a picture's noise. Differences of two seeds have no picture left in them, and signs count every pixel
/// alike: the few at the edge of a light, a hundred times as noisy as the rest, would otherwise decide alone, and the
/// standard error would not be 1/√n.
struct Signs {
    size: [i32; 2],
    /// 1, -1, or 0 where there is no noise; row by row.
    signs: Vec<f64>,
}

impl Signs {
    fn of(two: &[Film]) -> Self {
        let sign = |(a, b): (&[f32; 3], &[f32; 3])| {
            let difference = luminance(*a) - luminance(*b);
            if difference == 0.0 { 0.0 } else { difference.signum() }
        };
        let signs = two[0].pixels.iter().zip(&two[1].pixels).map(sign).collect();
        Self { size: [two[0].width as i32, two[0].height as i32], signs }
    }

    /// Of each pixel and of the one `step` further, where both have noise.
    fn pairs(&self, step: [i32; 2]) -> impl Iterator<Item = [f64; 2]> {
        let [width, height] = self.size;
        let columns = 0.max(-step[0])..width.min(width - step[0]);
        let places = (0..height - step[1]).flat_map(move |y| columns.clone().map(move |x| (x, y)));
        let sign = move |x: i32, y: i32| self.signs[(y * width + x) as usize];
        let pairs = places.map(move |(x, y)| [sign(x, y), sign(x + step[0], y + step[1])]);
        pairs.filter(|[here, there]| here * there != 0.0)
    }
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
        assert_eq!(apart(&noise(&films(0.0)), [1, 0]).verdict, Verdict::Pass);
        assert_eq!(apart(&noise(&films(0.0)), [0, 1]).verdict, Verdict::Pass);
    }

    #[test]
    fn noise_that_neighbours_share_is_seen() {
        assert_eq!(apart(&noise(&films(0.2)), [1, 0]).verdict, Verdict::Fail);
    }

    fn noise(films: &[Film]) -> Vec<Signs> {
        films.chunks_exact(2).map(Signs::of).collect()
    }

    /// The pixel at column x of row y has the noise of `number(x, y)`.
    fn numbered(number: fn(usize, usize) -> usize) -> Vec<Signs> {
        let mut films = films(0.0);
        for film in &mut films {
            let pixels = film.pixels.clone();
            let places = (0..36).flat_map(|y| (0..48).map(move |x| (x, y)));
            film.pixels = places.map(|(x, y)| pixels[number(x, y)]).collect();
        }
        noise(&films)
    }

    #[test]
    fn streams_that_repeat_on_a_wide_film_are_seen() {
        let (_, right) = most_alike(&numbered(|x, y| x + 48 * y)).unwrap();
        assert_eq!(right.verdict, Verdict::Pass);
        let (step, wrong) = most_alike(&numbered(|x, y| x + 36 * y)).unwrap();
        assert_eq!((step.as_str(), wrong.verdict), ("1 down and 36 to the left", Verdict::Fail));
        let (_, tiles) = most_alike(&numbered(|x, y| x % 16 + 16 * (y % 16))).unwrap();
        assert_eq!(tiles.verdict, Verdict::Fail);
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
