//! Whether samples follow a density: χ² on counts, in three stages ([`Escalation`]).
//!
//! Cells in which fewer than [`FEWEST_EXPECTED`] samples are expected are pooled,
//! because with starved cells the far tail of the statistic is ten times too fat. A sample where
//! the density is zero fails without statistics: in a cell of probability 0, and where the density
//! of the sample itself is 0 if that probability is an integral.
//!
//! Expectations come from quadrature and may be wrong by δ. The statistic is judged as if the error
//! had done its worst: √X² is a length, so an error moves it by at most √Q with Q = N Σ δ²/p. A
//! pass needs Q ≤ 2.
//!
//! Not here: the cells (`histogram`), and cores that stratify their samples, whose counts vary less
//! than χ² says: they are never rejected wrongly.

mod report;

pub use report::{CountDoubt, CountReport, CountStage, ForbiddenSamples};

use crate::stats::law::{chi_square_tail, chi_square_upper, detectable_noncentrality};
use crate::stats::plan::{Escalation, MISS_LEVEL, STAGE_LEVEL};
use crate::stats::{CellProbabilities, Counts, Effort, Stage, Verdict};

/// Expected samples below which a cell is pooled.
const FEWEST_EXPECTED: f64 = 25.0;
/// The largest N Σ δ²/p with which a sampler may pass.
const LARGEST_QUADRATURE_ERROR: f64 = 2.0;
/// Samples of the smallest first stage.
const FEWEST_SAMPLES: f64 = 10_000.0;
/// Above this ratio of its counts to those expected, a picture of the residuals shows nothing more.
const LARGEST_RESIDUAL: f64 = 1e6;

/// Where counts come from, and what they should be.
pub trait CountSource {
    /// What goes wrong in the core.
    type Error;
    /// The probabilities of the cells of this stage. Called once a stage, before
    /// [`CountSource::draw`]; a good place to turn the cells by a new angle.
    fn expected(&mut self, stage: Stage) -> Result<CellProbabilities, Self::Error>;
    /// `samples` fresh samples, counted in the cells of this stage.
    fn draw(&mut self, stage: Stage, samples: u64) -> Result<Counts, Self::Error>;
    /// How many of the samples last drawn in a cell of probability 0 can be no chance. All, if the
    /// law is known; quadrature may have missed a sliver of a density, so that whoever integrates
    /// one has to look at the samples themselves.
    fn forbidden(&self, _cell: usize, samples: u64) -> u64 {
        samples
    }
}

/// Judges counts against probabilities that are the same in every stage.
pub fn judge_counts<E>(
    expected: &CellProbabilities,
    effort: &Effort,
    draw: &mut dyn FnMut(Stage, u64) -> Result<Counts, E>,
) -> Result<CountReport, E> {
    judge_count_source(effort, &mut Fixed { expected, draw })
}

/// Whether counts may well be of this law: one χ² at the level of a stage. It gives a name to what has
/// failed already, and is no verdict on its own.
pub fn follows_law(law: &CellProbabilities, counts: &Counts) -> bool {
    let forbidden = forbidden_samples(law, counts, |_, samples| samples);
    forbidden.is_none() && !score(Stage::Third, law, counts).rejects
}

struct Fixed<'a, E> {
    expected: &'a CellProbabilities,
    draw: &'a mut dyn FnMut(Stage, u64) -> Result<Counts, E>,
}

impl<E> CountSource for Fixed<'_, E> {
    type Error = E;

    fn expected(&mut self, _: Stage) -> Result<CellProbabilities, E> {
        Ok(self.expected.clone())
    }

    fn draw(&mut self, stage: Stage, samples: u64) -> Result<Counts, E> {
        (self.draw)(stage, samples)
    }
}

/// Judges counts that a source draws stage by stage.
///
/// # Panics
///
/// If the source counts in another number of cells than it has probabilities for.
pub fn judge_count_source<S: CountSource>(
    effort: &Effort,
    source: &mut S,
) -> Result<CountReport, S::Error> {
    let mut stages = Escalation::default();
    let mut drawn = Drawn::of(Stage::First, source, |expected| planned_samples(expected, effort))?;
    let first_samples = drawn.samples;
    loop {
        stages.push(score(drawn.stage, &drawn.expected, &drawn.counts));
        match stages.next().filter(|_| drawn.forbidden.is_none()) {
            Some(stage) => drawn = Drawn::of(stage, source, |_| stage.factor() * first_samples)?,
            None => return Ok(report(stages, effort, drawn)),
        }
    }
}

/// What was drawn in one stage, and what should have been.
struct Drawn {
    stage: Stage,
    samples: u64,
    expected: CellProbabilities,
    counts: Counts,
    forbidden: Option<ForbiddenSamples>,
}

impl Drawn {
    fn of<S: CountSource>(
        stage: Stage,
        source: &mut S,
        samples: impl Fn(&CellProbabilities) -> u64,
    ) -> Result<Self, S::Error> {
        let expected = source.expected(stage)?;
        let samples = samples(&expected);
        let counts = source.draw(stage, samples)?;
        let forbidden =
            forbidden_samples(&expected, &counts, |cell, samples| source.forbidden(cell, samples));
        Ok(Self { stage, samples, expected, counts, forbidden })
    }
}

/// Samples of the first stage that see a density error of `effort.detects`, whatever the quadrature
/// error hides.
fn planned_samples(expected: &CellProbabilities, effort: &Effort) -> u64 {
    let populated = expected.cells.iter().filter(|p| **p > 0.0).count();
    let most = effort.most_samples as f64;
    let hidden = 2.0 * (quadrature_error(expected, most) / most).sqrt();
    let needed = match effort.detects - hidden {
        visible if visible > 0.0 => needed_samples(populated as f64, visible),
        _ => f64::INFINITY,
    };
    (needed.min(most) as u64).next_multiple_of(effort.grain)
}

fn needed_samples(freedom: f64, detects: f64) -> f64 {
    let noncentrality = detectable_noncentrality(freedom, STAGE_LEVEL, MISS_LEVEL);
    (noncentrality / (detects * detects)).ceil().max(FEWEST_SAMPLES)
}

/// A cell after pooling: expected and observed.
#[derive(Clone, Copy, Default)]
struct Pool {
    expected: f64,
    observed: f64,
}

impl Pool {
    fn take(&mut self, other: Pool) {
        self.expected += other.expected;
        self.observed += other.observed;
    }
}

/// Proper cells and "absorbed", the starved ones pooled until each pool expects enough.
fn pooled(expected: &CellProbabilities, counts: &Counts) -> Vec<Pool> {
    assert_eq!(expected.cells.len(), counts.cells.len(), "one count for each probability");
    let total = counts.total() as f64;
    let absorbed = (expected.absorbed, counts.absorbed);
    let cells = expected.cells.iter().copied().zip(counts.cells.iter().copied());
    let mut cells: Vec<Pool> = cells
        .filter(|(probability, _)| *probability >= 0.0)
        .chain([absorbed])
        .map(|(p, observed)| Pool { expected: p * total, observed: observed as f64 })
        .collect();
    cells.sort_by(|a, b| a.expected.total_cmp(&b.expected));
    let mut pools = Vec::new();
    let mut open = Pool::default();
    for cell in cells {
        open.take(cell);
        if open.expected >= FEWEST_EXPECTED {
            pools.push(std::mem::take(&mut open));
        }
    }
    match pools.first_mut() {
        Some(smallest) => smallest.take(open),
        None => pools.push(open),
    }
    pools
}

fn score(stage: Stage, expected: &CellProbabilities, counts: &Counts) -> CountStage {
    let pools = pooled(expected, counts);
    let freedom = (pools.len() - 1) as f64;
    let term = |pool: &Pool| (pool.observed - pool.expected).powi(2) / pool.expected;
    let statistic: f64 = pools.iter().map(term).sum();
    let quadrature_error = quadrature_error(expected, counts.total() as f64);
    let length = chi_square_upper(STAGE_LEVEL, freedom).sqrt() + quadrature_error.sqrt();
    CountStage {
        stage,
        samples: counts.total(),
        statistic,
        freedom,
        critical: length * length,
        p_value: chi_square_tail(statistic, freedom),
        quadrature_error,
        rejects: statistic > length * length,
    }
}

/// N Σ δ²/p over the cells, starved ones held up to what a pool holds.
fn quadrature_error(expected: &CellProbabilities, samples: f64) -> f64 {
    let cells = expected.cells.iter().zip(&expected.errors).filter(|(p, _)| **p > 0.0);
    cells.map(|(p, error)| (samples * error).powi(2) / (samples * p).max(FEWEST_EXPECTED)).sum()
}

/// Samples where the density is zero, which no chance explains; `forbidden` tells how many of those
/// in a cell of probability 0.
fn forbidden_samples(
    expected: &CellProbabilities,
    counts: &Counts,
    forbidden: impl Fn(usize, u64) -> u64,
) -> Option<ForbiddenSamples> {
    let cells = expected.cells.iter().zip(&counts.cells).enumerate();
    let empty = cells.filter(|(_, (p, samples))| **p == 0.0 && **samples > 0);
    let hits = empty.map(|(cell, (_, samples))| (cell, forbidden(cell, *samples)));
    let hits = hits.filter(|(_, samples)| *samples > 0);
    hits.map(|(cell, samples)| ForbiddenSamples { cell, samples }).max_by_key(|f| f.samples)
}

/// What the stages say together.
fn decide(
    first: &CountStage,
    rejected: bool,
    resolution: f64,
    detects: f64,
) -> (Verdict, Option<CountDoubt>) {
    let converged = first.quadrature_error <= LARGEST_QUADRATURE_ERROR;
    if rejected {
        (Verdict::Fail, None)
    } else if !converged {
        (Verdict::Inconclusive, Some(CountDoubt::QuadratureNotConverged))
    } else if resolution <= detects {
        (Verdict::Pass, None)
    } else {
        (Verdict::Inconclusive, Some(CountDoubt::TooFewSamples))
    }
}

fn report(stages: Escalation<CountStage>, effort: &Effort, drawn: Drawn) -> CountReport {
    let Drawn { expected, counts, forbidden, .. } = drawn;
    let (first, detects) = (stages[0], effort.detects);
    let resolution = resolution(&first);
    let improper_cell = expected.cells.iter().position(|p| !(*p >= 0.0 && p.is_finite()));
    let rejected = stages.rejects() || forbidden.is_some() || improper_cell.is_some();
    let (verdict, doubt) = decide(&first, rejected, resolution, detects);
    let total = counts.total() as f64;
    let wanted: Vec<f64> = expected.cells.iter().map(|p| p * total).collect();
    CountReport {
        verdict,
        doubt,
        forbidden,
        improper_cell,
        resolution,
        detects,
        samples: stages.iter().map(|stage| stage.samples).sum(),
        samples_missing: samples_missing(&first, doubt, detects),
        residuals: counts.cells.iter().zip(&wanted).map(|(o, e)| residual(*o, *e)).collect(),
        observed: counts.cells,
        absorbed_observed: counts.absorbed,
        absorbed_expected: expected.absorbed * total,
        expected: wanted,
        mass: expected.mass,
        stages,
    }
}

fn samples_missing(first: &CountStage, doubt: Option<CountDoubt>, detects: f64) -> Option<u64> {
    let needed = needed_samples(first.freedom, detects) as u64;
    let missing = needed.saturating_sub(first.samples).max(1);
    (doubt == Some(CountDoubt::TooFewSamples)).then_some(missing)
}

fn residual(observed: u64, expected: f64) -> f64 {
    let difference = observed as f64 - expected;
    if difference == 0.0 { 0.0 } else { (difference / expected.sqrt()).min(LARGEST_RESIDUAL) }
}

/// The density error that the first stage sees. The quadrature error may have worked against it.
fn resolution(first: &CountStage) -> f64 {
    let noncentrality = detectable_noncentrality(first.freedom, STAGE_LEVEL, MISS_LEVEL);
    (noncentrality.sqrt() + 2.0 * first.quadrature_error.sqrt()) / (first.samples as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::frame::direction;
    use crate::math::quadrature::Diligence;
    use crate::math::rng::{Seed, Stream, uniform};
    use crate::stats::SphereCells;
    use glam::DVec3;
    use std::convert::Infallible;
    use std::f64::consts::{FRAC_1_PI, TAU};

    fn cells() -> SphereCells {
        SphereCells::hemisphere(10, 20)
    }

    fn probabilities(pdf: impl Fn(DVec3) -> f64) -> CellProbabilities {
        let mut batch = |directions: &[DVec3], values: &mut [f64]| {
            directions.iter().zip(values).for_each(|(d, v)| *v = pdf(*d));
            Ok::<_, Infallible>(())
        };
        let Ok(expected) = cells().probabilities(Diligence::default(), &mut batch);
        expected
    }

    fn cosine() -> CellProbabilities {
        probabilities(|d| d.z.max(0.0) * FRAC_1_PI)
    }

    /// Samples with cos θ = u^(1/(exponent + 1)): the cosine law at exponent 1.
    fn power(stream: &mut Stream, exponent: f64) -> DVec3 {
        let z = uniform(stream).powf(1.0 / (exponent + 1.0));
        direction(z.acos(), TAU * uniform(stream))
    }

    fn judge(
        expected: &CellProbabilities,
        detects: f64,
        seed: u64,
        sample: impl Fn(&mut Stream) -> Option<DVec3>,
    ) -> CountReport {
        let mut draw = |stage: Stage, samples: u64| {
            let mut stream = Seed(seed).child(stage).stream();
            Ok::<_, Infallible>(cells().count((0..samples).map(|_| sample(&mut stream))))
        };
        let Ok(report) = judge_counts(expected, &Effort::new(detects), &mut draw);
        report
    }

    #[test]
    fn a_right_sampler_passes_and_says_what_it_would_have_seen() {
        let report = judge(&cosine(), 0.03, 1, |s| Some(power(s, 1.0)));
        assert_eq!(report.verdict, Verdict::Pass, "{:?}", report.stages);
        assert!(report.resolution <= 0.03 && report.resolution > 0.02);
        assert_eq!(report.stages.len(), 1);
    }

    #[test]
    fn gross_mistakes_fail() {
        let uniform_for_cosine =
            judge(&cosine(), 0.1, 1, |s| Some(direction(uniform(s).acos(), TAU * uniform(s))));
        let half_the_circle =
            judge(&cosine(), 0.1, 1, |s| Some(power(s, 1.0)).map(|d| d.with_y(d.y.abs())));
        let one_number_twice = judge(&cosine(), 0.1, 1, |s| {
            let u = uniform(s);
            Some(direction(u.sqrt().acos(), TAU * u))
        });
        for report in [uniform_for_cosine, half_the_circle, one_number_twice] {
            assert_eq!(report.verdict, Verdict::Fail, "{:?}", report.stages);
            assert_eq!(report.stages.len(), 3);
        }
    }

    #[test]
    fn a_slightly_wrong_exponent_fails_where_it_is_promised_and_not_below() {
        // The density of exponent 1.05 is 1.2 % off, root mean square.
        let seen = judge(&cosine(), 0.012, 1, |s| Some(power(s, 1.05)));
        assert_eq!(seen.verdict, Verdict::Fail);
        let unseen = judge(&cosine(), 0.1, 1, |s| Some(power(s, 1.05)));
        assert_eq!(unseen.verdict, Verdict::Pass);
    }

    #[test]
    fn one_sample_below_the_horizon_fails() {
        let report = judge(&cosine(), 0.1, 1, |s| {
            let up = power(s, 1.0);
            Some(if uniform(s) < 1e-3 { -up } else { up })
        });
        assert_eq!(report.verdict, Verdict::Fail);
        assert!(report.forbidden.is_some_and(|forbidden| forbidden.cell < 20));
    }

    #[test]
    fn failed_samples_are_right_if_the_density_lacks_them_and_wrong_if_not() {
        let lossy = |s: &mut Stream| (uniform(s) < 0.9).then(|| power(s, 1.0));
        let honest = probabilities(|d| 0.9 * d.z.max(0.0) * FRAC_1_PI);
        assert_eq!(judge(&honest, 0.1, 1, lossy).verdict, Verdict::Pass);
        assert_eq!(judge(&cosine(), 0.1, 1, lossy).verdict, Verdict::Fail);
    }

    #[test]
    fn a_density_that_is_twice_too_large_fails() {
        let doubled = probabilities(|d| 2.0 * d.z.max(0.0) * FRAC_1_PI);
        let report = judge(&doubled, 0.1, 1, |s| Some(power(s, 1.0)));
        assert_eq!(report.verdict, Verdict::Fail);
    }

    #[test]
    fn a_density_that_is_not_a_number_fails() {
        let mut expected = cosine();
        expected.cells[50] = f64::NAN;
        let report = judge(&expected, 0.1, 1, |s| Some(power(s, 1.0)));
        assert_eq!(report.verdict, Verdict::Fail);
        assert_eq!(report.improper_cell, Some(50));
    }

    #[test]
    fn an_unknown_integral_is_no_ground_for_a_verdict() {
        let mut expected = cosine();
        expected.errors.fill(1e-3);
        let report = judge(&expected, 0.1, 1, |s| Some(power(s, 1.0)));
        assert_eq!(report.verdict, Verdict::Inconclusive);
        assert_eq!(report.doubt, Some(CountDoubt::QuadratureNotConverged));
    }

    #[test]
    fn an_integral_known_roughly_takes_more_samples_to_pass() {
        let mut expected = cosine();
        let exact = judge(&expected, 0.03, 1, |s| Some(power(s, 1.0)));
        expected.errors.fill(3e-6);
        let rough = judge(&expected, 0.03, 1, |s| Some(power(s, 1.0)));
        assert_eq!(rough.verdict, Verdict::Pass, "{:?}", rough.doubt);
        assert!(rough.samples > exact.samples && rough.resolution <= 0.03);
    }

    #[test]
    fn an_unknown_integral_does_not_hide_a_gross_mistake() {
        let mut expected = cosine();
        expected.errors.fill(1e-4);
        let report = judge(&expected, 0.1, 1, |s| Some(power(s, 3.0)));
        assert_eq!(report.verdict, Verdict::Fail);
    }

    #[test]
    fn starved_cells_are_pooled_until_they_expect_enough() {
        let expected = CellProbabilities::exact(vec![0.001; 1000]);
        let counts = Counts { cells: vec![1; 1000], absorbed: 0 };
        let pools = pooled(&expected, &counts);
        assert!(pools.iter().all(|pool| pool.expected >= FEWEST_EXPECTED));
        let observed: f64 = pools.iter().map(|pool| pool.observed).sum();
        assert_eq!(observed, 1000.0);
    }

    #[test]
    fn p_values_of_a_right_sampler_are_uniform() {
        let expected = cosine();
        let mut stream = Seed(7).stream();
        let trials = 2000;
        let p_values: Vec<f64> = (0..trials)
            .map(|_| {
                let samples = (0..6000).map(|_| Some(power(&mut stream, 1.0)));
                score(Stage::First, &expected, &cells().count(samples)).p_value
            })
            .collect();
        for level in [0.01, 0.05, 0.5] {
            let below = p_values.iter().filter(|p| **p < level).count() as f64;
            let deviation = (trials as f64 * level * (1.0 - level)).sqrt();
            assert!((below - trials as f64 * level).abs() < 4.0 * deviation, "{level}: {below}");
        }
    }
}
