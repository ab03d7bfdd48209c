//! The steps of screen-and-confirm: screening, freezing, confirming, reporting.

use super::brightness::Brightness;
use super::cell_noise::CellNoise;
use super::cells::{COMPONENTS, Component, Scale};
use super::dead_pixels::LitRuns;
use super::draw::{ImageDraw, ImageEffort, Levels};
use super::report::{
    CellScore, Confirmation, ImageReport, Impossible, ImpossiblePixels, ScaleReport,
};
use super::target::{Frozen, Target};
use crate::image::Image;
use crate::stats::law::{Spread, student_tail};
use crate::stats::plan::level::MISS_LEVEL;
use crate::stats::{Moments, Stage, Verdict, normal_upper, student_upper};

/// Cells of a scale that are confirmed together.
const MOST_FROZEN: usize = 64;
/// Cells of a scale that are reported.
const MOST_REPORTED: usize = 256;

struct Sampled {
    spread: Spread,
    brightness: Brightness,
    /// Of each scale, the numbers of its frozen cells.
    scalars: Vec<Moments>,
}

/// Renders the picture of a run, or the two that are compared.
pub(super) type DrawImages<'a, E> = dyn FnMut(ImageDraw) -> Result<Vec<Image>, E> + 'a;

/// What ends a stage early.
enum Interrupted<E> {
    Core(E),
    Impossible(ImpossiblePixels, Image),
}

/// The state of [`super::judge_image`].
pub(super) struct Screening<'a, E> {
    target: Target,
    effort: &'a ImageEffort,
    levels: Levels,
    draw: &'a mut DrawImages<'a, E>,
    lit: LitRuns,
    all: Spread,
    runs: u32,
    size: (usize, usize),
}

impl<'a, E> Screening<'a, E> {
    pub(super) fn new(
        target: Target,
        guide: &Image,
        effort: &'a ImageEffort,
        draw: &'a mut DrawImages<'a, E>,
    ) -> Self {
        let size = (guide.width, guide.height);
        let pixels = size.0 * size.1;
        let luminance = (0..pixels).map(|pixel| target.errors[(pixel + 1) * COMPONENTS - 1]);
        let lit = LitRuns::new(guide, luminance);
        let (all, levels) = (Spread::default(), Levels::DEFAULT);
        Self { target, effort, levels, draw, lit, all, runs: 0, size }
    }

    /// The same at other levels.
    pub(super) fn at(self, levels: Levels) -> Self {
        Self { levels, ..self }
    }

    pub(super) fn judge(mut self) -> Result<ImageReport, E> {
        match self.screen_and_confirm() {
            Ok(report) => Ok(report),
            Err(Interrupted::Core(error)) => Err(error),
            Err(Interrupted::Impossible(pixels, image)) => Ok(self.broken(pixels, image)),
        }
    }

    fn screen_and_confirm(&mut self) -> Result<ImageReport, Interrupted<E>> {
        let screened = self.sample(Stage::First, self.effort.screen_runs, &[])?;
        let noise =
            CellNoise::of(&screened.spread, &self.target, self.effort.samples, self.levels.screen);
        let mut scales: Vec<ScaleReport> =
            (0..Scale::ALL.len()).map(|i| self.screen(i, &noise)).collect();
        if !scales.iter().any(ScaleReport::stands_out) && self.lit.suspects().is_empty() {
            return Ok(self.report(scales, &screened, &screened));
        }
        let frozen: Vec<Frozen> = (0..Scale::ALL.len()).map(|i| self.freeze(i, &noise)).collect();
        let is_gross = scales.iter().any(ScaleReport::is_gross);
        let runs = if is_gross { self.effort.gross_runs } else { self.effort.confirm_runs };
        let second = self.sample(Stage::Second, runs, &frozen)?;
        let third = self.sample(Stage::Third, runs, &frozen)?;
        for (i, report) in scales.iter_mut().enumerate() {
            if !frozen[i].terms.is_empty() {
                let confirmations =
                    confirm(self.levels.confirm, &second.scalars[i], &third.scalars[i]);
                report.rejects = confirmations.iter().all(|confirmation| confirmation.rejects);
                report.confirmations = Some(confirmations);
            }
        }
        Ok(self.report(scales, &screened, &third))
    }

    /// Draws the runs of a stage.
    fn sample(
        &mut self,
        stage: Stage,
        runs: u32,
        frozen: &[Frozen],
    ) -> Result<Sampled, Interrupted<E>> {
        let mut sampled = Sampled {
            spread: Spread::default(),
            brightness: Brightness::of(self.size.0 * self.size.1),
            scalars: vec![Moments::default(); frozen.len()],
        };
        for run in 0..runs {
            let images = (self.draw)(ImageDraw { stage, run }).map_err(Interrupted::Core)?;
            let values = self.values(images, stage, run)?;
            for (moments, frozen) in sampled.scalars.iter_mut().zip(frozen) {
                moments.push(frozen.scalar(&self.target, &values));
            }
            sampled.spread.push(&values);
            sampled.brightness.push(&values);
            self.all.push(&values[..COMPONENTS * self.size.0 * self.size.1]);
            self.runs += 1;
        }
        Ok(sampled)
    }

    /// The cells of one picture, or of the difference of two.
    fn values(
        &mut self,
        images: Vec<Image>,
        stage: Stage,
        run: u32,
    ) -> Result<Vec<f64>, Interrupted<E>> {
        for image in &images {
            assert_eq!((image.width, image.height), self.size, "all pictures of one size");
            if let Some((kind, [x, y], pixels)) = Impossible::first_in(image, |_| true) {
                let pixels = ImpossiblePixels { kind, x, y, pixels, stage, run };
                return Err(Interrupted::Impossible(pixels, image.clone()));
            }
        }
        let mut values = self.target.cells.values(&images[0]);
        match images.get(1) {
            None => self.lit.take(&images[0]),
            Some(other) => {
                let subtracted = self.target.cells.values(other);
                values.iter_mut().zip(subtracted).for_each(|(value, other)| *value -= other);
            }
        }
        Ok(values)
    }

    /// The banded t of every cell of a scale, the worst first.
    fn screen(&self, scale: usize, noise: &CellNoise<'_>) -> ScaleReport {
        let range = self.target.cells.ranges()[scale].clone();
        let worst = self.extremes(scale, noise).into_iter().take(MOST_REPORTED);
        ScaleReport {
            scale: Scale::ALL[scale],
            cells: range.len(),
            worst: worst.map(|(index, t)| self.cell_score(scale, index, noise.spread, t)).collect(),
            critical: noise.critical[scale],
            confirmations: None,
            rejects: false,
        }
    }

    /// The cells of a scale outside their bands with their t, the most extreme first.
    fn extremes(&self, scale: usize, noise: &CellNoise<'_>) -> Vec<(usize, f64)> {
        let range = self.target.cells.ranges()[scale].clone();
        let t = |index: usize| {
            let departure = self.target.departure(index, noise.spread.mean(index));
            (departure != 0.0).then(|| (index, departure / noise.standard_error(index)))
        };
        let mut outside: Vec<(usize, f64)> = range.filter_map(t).collect();
        outside.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
        outside
    }

    /// A matched filter for what the screen saw: each cell weighs by its departure over its
    /// variance, so that one cell far out is not lost among 64 that are a little out by chance.
    fn freeze(&self, scale: usize, noise: &CellNoise<'_>) -> Frozen {
        let term = |(index, t): (usize, f64)| {
            // The band keeps a cell that happened not to vary from weighing more than all others.
            let error = noise.standard_error(index).hypot(self.target.bands[index]);
            let departure = self.target.departure(index, noise.spread.mean(index));
            (index, t.signum(), departure.abs() / error.powi(2))
        };
        Frozen {
            terms: self.extremes(scale, noise).into_iter().take(MOST_FROZEN).map(term).collect(),
        }
    }

    fn cell_score(&self, scale: usize, index: usize, spread: &Spread, t: f64) -> CellScore {
        let start = self.target.cells.ranges()[scale].start;
        let grid = &self.target.cells.grids[scale];
        CellScore {
            scale: grid.scale,
            component: Component::ALL[(index - start) % COMPONENTS],
            extent: grid.extent((index - start) / COMPONENTS),
            mean: spread.mean(index),
            expected: self.target.expected[index],
            band: self.target.bands[index],
            // Infinity, where nothing varied, does not survive JSON.
            t: t.clamp(-1e9, 1e9),
            p: 2.0 * student_tail(t.abs(), spread.freedom()),
        }
    }

    fn report(&self, scales: Vec<ScaleReport>, screened: &Sampled, last: &Sampled) -> ImageReport {
        let dead_pixels = self.lit.dead();
        let resolution = self.resolution(&screened.spread);
        let rejected = !dead_pixels.is_empty() || scales.iter().any(|scale| scale.rejects);
        ImageReport {
            verdict: Verdict::of_test(rejected, resolution <= self.effort.detects),
            impossible: None,
            dead_pixels,
            worst_scale: worst_scale(&scales),
            scales,
            ratios: last.brightness.ratios(&self.target),
            resolution,
            detects: self.effort.detects,
            runs: self.runs,
            mean: self.pixels(|index| self.all.mean(index)),
            standard_error: self.pixels(|index| self.all.standard_error(index)),
        }
    }

    /// A report on a picture that none can be.
    fn broken(&self, pixels: ImpossiblePixels, image: Image) -> ImageReport {
        ImageReport {
            verdict: Verdict::Fail,
            impossible: Some(pixels),
            dead_pixels: Vec::new(),
            scales: Vec::new(),
            worst_scale: None,
            ratios: Vec::new(),
            resolution: self.effort.detects,
            detects: self.effort.detects,
            runs: self.runs + 1,
            standard_error: Image::new(image.width, image.height, [0.0; 3]),
            mean: image,
        }
    }

    /// What the screen would have suspected with probability 1 − [`MISS_LEVEL`]; the confirmations,
    /// on twice the runs, would not have missed it. Normal approximation to the noncentral t.
    fn resolution(&self, screened: &Spread) -> f64 {
        let whole = self.target.whole_luminance();
        let looks = 2.0 * (Scale::ALL.len() * COMPONENTS) as f64;
        let critical = student_upper(self.levels.screen / looks, screened.freedom());
        let spread_of_t = (1.0 + 0.5 * critical * critical / screened.freedom()).sqrt();
        let sigmas = critical + normal_upper(MISS_LEVEL) * spread_of_t;
        let error = sigmas * screened.standard_error(whole);
        (self.target.bands[whole] + error) / self.target.scale[whole]
    }

    fn pixels(&self, value: impl Fn(usize) -> f64) -> Image {
        let (width, height) = self.size;
        Image::from_fn(width, height, |x, y| {
            let first = COMPONENTS * (y * width + x);
            // Back to the precision the pictures came in.
            std::array::from_fn(|i| value(first + i) as f32)
        })
    }
}

/// Both confirmations of one scale, each with the larger of the two spreads: the double key.
fn confirm(level: f64, second: &Moments, third: &Moments) -> [Confirmation; 2] {
    let error = second.standard_error().max(third.standard_error());
    let freedom = (second.count() - 1) as f64;
    [second, third].map(|moments| {
        let t = if moments.mean() == 0.0 { 0.0 } else { moments.mean() / error };
        let rejects = t > student_upper(level, freedom);
        Confirmation { t: t.clamp(-1e9, 1e9), rejects }
    })
}

/// The scale whose weaker confirmation is the strongest, among those that reject.
fn worst_scale(scales: &[ScaleReport]) -> Option<Scale> {
    let strength = |report: &&ScaleReport| {
        report.confirmations.map_or(0.0, |[second, third]| second.t.min(third.t))
    };
    let rejecting = scales.iter().filter(|report| report.rejects);
    let worst = rejecting.max_by(|a, b| strength(a).total_cmp(&strength(b)));
    worst.map(|report| report.scale)
}
