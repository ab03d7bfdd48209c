//! The steps of screen-and-confirm: screening, freezing, confirming, reporting.

use super::brightness::Brightness;
use super::cell_noise::{CellNoise, known_of_frozen};
use super::cells::{COMPONENTS, Component, Scale};
use super::dead_pixels::LitRuns;
use super::draw::{ImageDraw, ImageEffort, Levels};
use super::lack::pixels_that_lack;
use super::report::{
    CellScore, Confirmation, ImageReport, Impossible, ImpossiblePixels, ScaleReport,
};
use super::target::{Frozen, Target};
use crate::image::Image;
use crate::stats::law::{Spread, student_tail};
use crate::stats::plan::Doubt;
use crate::stats::plan::level::MISS_LEVEL;
use crate::stats::{Moments, Stage, Verdict, normal_upper, student_upper};

/// Cells of a scale that are confirmed together.
const MOST_FROZEN: usize = 64;
/// Cells of a scale that are reported.
const MOST_REPORTED: usize = 256;
/// Samples of a cell in each of two confirmations, or of all runs where it lacks light, that hardly all miss what light
/// there is: one in 10,000 that finds it is missed by all with probability 2e-6.
const FEWEST: u64 = 131_072;

struct Sampled {
    spread: Spread,
    /// Of each scale, the numbers of its frozen cells.
    scalars: Vec<Moments>,
}

impl Sampled {
    fn of_scales(scales: usize) -> Self {
        Self { spread: Spread::default(), scalars: vec![Moments::default(); scales] }
    }
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
        let mut screened = Sampled::of_scales(0);
        let mut bright = Brightness::of(self.size);
        self.sample(&mut screened, &mut bright, Stage::First, self.effort.screen_runs / 2, &[])?;
        if !self.is_gross_all_over(&screened) {
            self.sample(&mut screened, &mut bright, Stage::First, self.effort.screen_runs, &[])?;
        }
        let noise = self.noise(&screened, |_| true);
        let mut scales: Vec<ScaleReport> =
            (0..Scale::ALL.len()).map(|i| self.screen(i, &noise)).collect();
        if !scales.iter().any(ScaleReport::stands_out) && self.lit.suspects().is_empty() {
            return Ok(self.report(scales, &screened, &bright));
        }
        let frozen: Vec<Option<Frozen>> =
            (0..Scale::ALL.len()).map(|i| self.freeze(i, &noise)).collect();
        let bright = self.confirm(&mut scales, &frozen)?;
        Ok(self.report(scales, &screened, &bright))
    }

    /// Draws both confirmations and looks at them, until a look tells; hands back how bright both are: a few runs of one
    /// know that too badly to tell causes apart.
    fn confirm(
        &mut self,
        scales: &mut [ScaleReport],
        frozen: &[Option<Frozen>],
    ) -> Result<Brightness, Interrupted<E>> {
        let is_gross = scales.iter().any(ScaleReport::is_gross);
        let [mut second, mut third] = [(); 2].map(|()| Sampled::of_scales(frozen.len()));
        let mut bright = Brightness::of(self.size);
        for runs in self.effort.looks {
            self.sample(&mut second, &mut bright, Stage::Second, runs, frozen)?;
            self.sample(&mut third, &mut bright, Stage::Third, runs, frozen)?;
            let mut tells = runs == self.effort.confirm_runs();
            for (i, report) in scales.iter_mut().enumerate() {
                let Some(frozen) = &frozen[i] else { continue };
                let keys = [&second.scalars[i], &third.scalars[i]];
                let known = self.known(i, frozen, [&second.spread, &third.spread]);
                report.confirm(confirm(self.levels.of_a_look(), keys, known));
                let is_known = frozen.is_too_bright()
                    || runs > self.effort.first_look()
                        && (is_gross || self.samples(i, runs) >= FEWEST);
                tells |= report.rejects && report.scale.is_large() && is_known;
            }
            if tells {
                break;
            }
        }
        Ok(bright)
    }

    /// The larger of the standard errors that the frozen cells of a scale are known to have: nothing where they are too
    /// bright, which no light that is missed can make them, and infinite where too few samples fell on the tiles in which
    /// large cells lack light.
    fn known(&self, scale: usize, frozen: &Frozen, confirmations: [&Spread; 2]) -> f64 {
        if frozen.is_too_bright() {
            return 0.0;
        }
        let samples = self.effort.samples;
        if Scale::ALL[scale].is_large() {
            let pixels = pixels_that_lack(frozen, confirmations, &self.target, scale);
            let seen = pixels * f64::from(samples) * f64::from(self.runs);
            let is_enough = seen >= FEWEST as f64;
            if !is_enough {
                return f64::INFINITY;
            }
        }
        let known = |spread| known_of_frozen(frozen, spread, &self.target, scale, samples);
        confirmations.map(known).into_iter().fold(0.0, f64::max)
    }

    /// Samples that a cell of a scale sees in so many runs.
    fn samples(&self, scale: usize, runs: u32) -> u64 {
        let pixels = self.target.cells.grids[scale].pixels() as u64;
        pixels * u64::from(self.effort.samples) * u64::from(runs)
    }

    /// Draws the runs that a stage lacks to so many.
    fn sample(
        &mut self,
        sampled: &mut Sampled,
        bright: &mut Brightness,
        stage: Stage,
        runs: u32,
        frozen: &[Option<Frozen>],
    ) -> Result<(), Interrupted<E>> {
        for run in sampled.spread.count()..runs {
            let images = (self.draw)(ImageDraw { stage, run }).map_err(Interrupted::Core)?;
            let values = self.values(images, stage, run)?;
            for (moments, frozen) in sampled.scalars.iter_mut().zip(frozen) {
                let scalar = frozen.as_ref().map(|frozen| frozen.scalar(&self.target, &values));
                scalar.into_iter().for_each(|scalar| moments.push(scalar));
            }
            sampled.spread.push(&values);
            bright.push(&values);
            self.all.push(&values[..COMPONENTS * self.size.0 * self.size.1]);
            self.runs += 1;
        }
        Ok(())
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

    /// Whether half of the screen shows an error that the other half cannot take back.
    fn is_gross_all_over(&self, screened: &Sampled) -> bool {
        let noise = self.noise(screened, Scale::is_large);
        let large = (0..Scale::ALL.len()).filter(|i| Scale::ALL[*i].is_large());
        large.map(|i| self.screen(i, &noise)).any(|scale| scale.is_gross_all_over())
    }

    fn noise<'s>(&self, screened: &'s Sampled, wanted: fn(Scale) -> bool) -> CellNoise<'s> {
        let (samples, level) = (self.effort.samples, self.levels.screen);
        CellNoise::of(&screened.spread, &self.target, samples, level, wanted)
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
    /// None where all cells are inside their bands.
    fn freeze(&self, scale: usize, noise: &CellNoise<'_>) -> Option<Frozen> {
        let term = |(index, t): (usize, f64)| {
            // The band keeps a cell that happened not to vary from weighing more than all others.
            let error = noise.standard_error(index).hypot(self.target.bands[index]);
            let departure = self.target.departure(index, noise.spread.mean(index));
            (index, t.signum(), departure.abs() / error.powi(2))
        };
        let terms: Vec<_> =
            self.extremes(scale, noise).into_iter().take(MOST_FROZEN).map(term).collect();
        (!terms.is_empty()).then_some(Frozen { terms })
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

    fn report(
        &self,
        scales: Vec<ScaleReport>,
        screened: &Sampled,
        bright: &Brightness,
    ) -> ImageReport {
        let dead_pixels = self.lit.dead();
        let resolution = self.resolution(&screened.spread);
        let rejected = !dead_pixels.is_empty() || scales.iter().any(|scale| scale.rejects);
        let may_lack_its_tail = !rejected && scales.iter().any(ScaleReport::may_lack_its_tail);
        let sees = resolution <= self.effort.detects && !may_lack_its_tail;
        ImageReport {
            verdict: Verdict::of_test(rejected, sees),
            doubt: may_lack_its_tail.then_some(Doubt::HeavyTail),
            impossible: None,
            dead_pixels,
            worst_scale: worst_scale(&scales),
            scales,
            ratios: bright.ratios(&self.target),
            parts: bright.of_parts(&self.target),
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
            doubt: None,
            impossible: Some(pixels),
            dead_pixels: Vec::new(),
            scales: Vec::new(),
            worst_scale: None,
            ratios: Vec::new(),
            parts: Vec::new(),
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

/// Both confirmations of one scale, each with the larger of the two spreads, and with what is known of them: the double
/// key. Runs that have all missed the same light do not vary, and where so few samples find it they are no normal
/// variable: then a cell that is too dark needs the other key.
fn confirm(level: f64, keys: [&Moments; 2], known: f64) -> [Confirmation; 2] {
    let error = keys[0].standard_error().max(keys[1].standard_error());
    let critical = [student_upper(level, (keys[0].count() - 1) as f64), normal_upper(level)];
    keys.map(|moments| {
        let in_units = |error| if moments.mean() == 0.0 { 0.0 } else { moments.mean() / error };
        let [t, u] = [error, known].map(in_units);
        let [by_own, by_known] = [t > critical[0], u > critical[1]];
        Confirmation {
            t: t.clamp(-1e9, 1e9),
            rejects: by_own && by_known,
            may_lack_its_tail: by_own && !by_known,
        }
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
