//! Whether samples follow a pdf: χ² (chi-square) on counts, in three stages ([`Escalation`]).
//!
//! Cells in which fewer than [`FEWEST_EXPECTED`] samples are expected are pooled,
//! because with starved cells the far tail of the statistic is ten times too fat. A sample where
//! the pdf is zero fails without statistics: in a cell of probability 0, and where the pdf
//! of the sample itself is 0 if that probability is an integral.
//!
//! Expectations come from quadrature and may be wrong by δ. The statistic is judged as if the error
//! had done its worst: √X² is a length, so an error moves it by at most √Q with Q = N Σ δ²/p. A
//! pass needs Q ≤ 2.
//!
//! Counts that vary less than χ² says, of strata or low discrepancy, are never rejected wrongly; of those that may vary
//! more, batches tell by how much (`dependence`). Not here: the cells (`histogram`).

mod dependence;
mod report;

pub(crate) use report::{CountDoubt, CountReport, CountStage, ForbiddenSamples};

use crate::stats::law::{chi_square_tail, chi_square_upper, detectable_noncentrality};
use crate::stats::plan::Escalation;
use crate::stats::plan::level::{MISS_LEVEL, STAGE_LEVEL};
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
pub(crate) trait CountSource {
    /// What goes wrong in the core.
    type Error;
    /// The probabilities of the cells of this stage. Called once a stage, before
    /// [`CountSource::draw`]; a good place to turn the cells by a new angle.
    fn expected(&mut self, stage: Stage) -> Result<CellProbabilities, Self::Error>;
    /// `samples` fresh samples, counted in the cells of this stage.
    fn draw(&mut self, stage: Stage, samples: u64) -> Result<Counts, Self::Error>;
    /// How many of the samples last drawn in a cell of probability 0 can be no chance. All, if the
    /// law is known; quadrature may have missed a sliver of a pdf, so that whoever integrates
    /// one has to look at the samples themselves.
    fn forbidden(&self, _cell: usize, samples: u64) -> u64 {
        samples
    }
    /// The samples last drawn, in batches of one size and of seeds of their own. None where samples are independent.
    fn batches(&self) -> &[Counts] {
        &[]
    }
}

/// Judges counts against probabilities that are the same in every stage.
pub(crate) fn judge_counts<E>(
    expected: &CellProbabilities,
    effort: &Effort,
    draw: &mut dyn FnMut(Stage, u64) -> Result<Counts, E>,
) -> Result<CountReport, E> {
    judge_count_source(effort, &mut Fixed { expected, draw })
}

/// Whether counts may well be of this law: one χ² at the level of a stage. It gives a name to what has
/// failed already, and is no verdict on its own.
pub(crate) fn follows_law(law: &CellProbabilities, counts: &Counts) -> bool {
    let forbidden = forbidden_samples(law, counts, |_, samples| samples);
    forbidden.is_none() && !score(Stage::Third, law, counts, &[]).rejects
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

/// Judges counts that a source draws stage by stage, in as many cells as it has probabilities for.
pub(crate) fn judge_count_source<S: CountSource>(
    effort: &Effort,
    source: &mut S,
) -> Result<CountReport, S::Error> {
    let mut stages = Escalation::default();
    let mut drawn = Drawn::of(Stage::First, source, |expected| planned_samples(expected, effort))?;
    stages.push(drawn.score(source.batches()));
    while let Some(stage) = stages.next().filter(|_| drawn.forbidden.is_none()) {
        let samples = confirming_samples(&stages, stage, effort);
        let fresh = Drawn::of(stage, source, |_| samples)?;
        stages.push(fresh.score(source.batches()));
        drawn = drawn.or_better(fresh);
    }
    Ok(report(stages, effort, drawn))
}

/// Samples of the second or third stage, in as many cells as the first.
fn confirming_samples(stages: &Escalation<CountStage>, stage: Stage, effort: &Effort) -> u64 {
    (stages.confirming(stage).max(FEWEST_SAMPLES).ceil() as u64).next_multiple_of(effort.grain)
}

/// The size of each of so many batches in place of `samples` that are known to be independent: a quarter more, since how
/// much counts vary has to be learnt.
pub(crate) fn batch_size(samples: u64, batches: u64) -> u64 {
    (samples + samples / 4).div_ceil(batches)
}

/// What was drawn in one stage, and what should have been.
struct Drawn {
    stage: Stage,
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
        Ok(Self { stage, expected, counts, forbidden })
    }

    fn score(&self, batches: &[Counts]) -> CountStage {
        score(self.stage, &self.expected, &self.counts, batches)
    }

    /// The one that says more: of forbidden samples, or on more samples.
    fn or_better(self, fresh: Self) -> Self {
        let is_better = fresh.forbidden.is_some() || fresh.counts.total() >= self.counts.total();
        if is_better { fresh } else { self }
    }
}

/// Samples of the first stage that see a pdf error of `effort.detects`, whatever the quadrature
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

/// Proper cells and "absorbed" (one past the last), the starved ones pooled until each pool expects enough.
fn pools(expected: &CellProbabilities, total: f64) -> Vec<Vec<usize>> {
    let wanted = |cell: usize| total * probability(expected, cell);
    let mut cells: Vec<usize> =
        (0..=expected.cells.len()).filter(|cell| probability(expected, *cell) >= 0.0).collect();
    cells.sort_by(|a, b| wanted(*a).total_cmp(&wanted(*b)));
    let mut pools: Vec<Vec<usize>> = Vec::new();
    let (mut open, mut expects) = (Vec::new(), 0.0);
    for cell in cells {
        open.push(cell);
        expects += wanted(cell);
        if expects >= FEWEST_EXPECTED {
            pools.push(std::mem::take(&mut open));
            expects = 0.0;
        }
    }
    match pools.first_mut() {
        Some(smallest) => smallest.extend(open),
        None => pools.push(open),
    }
    pools
}

fn probability(expected: &CellProbabilities, cell: usize) -> f64 {
    expected.cells.get(cell).copied().unwrap_or(expected.absorbed)
}

fn count(counts: &Counts, cell: usize) -> f64 {
    counts.cells.get(cell).copied().unwrap_or(counts.absorbed) as f64
}

/// Over the pools, each count over the root of what all samples together should make of it.
fn standardised(pools: &[Vec<usize>], roots: &[f64], counts: &Counts) -> Vec<f64> {
    let observed = |pool: &Vec<usize>| pool.iter().map(|cell| count(counts, *cell)).sum::<f64>();
    pools.iter().zip(roots).map(|(pool, root)| observed(pool) / root).collect()
}

fn score(
    stage: Stage,
    expected: &CellProbabilities,
    counts: &Counts,
    batches: &[Counts],
) -> CountStage {
    assert_eq!(expected.cells.len(), counts.cells.len(), "one count for each probability");
    let total = counts.total() as f64;
    let pools = pools(expected, total);
    let wanted = |pool: &Vec<usize>| {
        total * pool.iter().map(|cell| probability(expected, *cell)).sum::<f64>()
    };
    let roots: Vec<f64> = pools.iter().map(|pool| wanted(pool).sqrt()).collect();
    let found = standardised(&pools, &roots, counts);
    let statistic: f64 = found.iter().zip(&roots).map(|(o, e)| (o - e).powi(2)).sum();
    let freedom = (pools.len() - 1) as f64;
    let quadrature_error = quadrature_error(expected, total);
    let batches: Vec<_> = batches.iter().map(|batch| standardised(&pools, &roots, batch)).collect();
    let dependent = dependence::critical(STAGE_LEVEL, &batches).unwrap_or(0.0);
    let allowed = chi_square_upper(STAGE_LEVEL, freedom).max(dependent);
    let length = allowed.sqrt() + quadrature_error.sqrt();
    CountStage {
        stage,
        samples: counts.total(),
        statistic,
        freedom,
        allowed,
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

/// Samples where the pdf is zero, which no chance explains; `forbidden` tells how many of those
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

/// Why counts that are not rejected prove nothing, if that is so.
fn doubt(first: &CountStage, resolution: f64, detects: f64) -> Option<CountDoubt> {
    match (first.quadrature_error <= LARGEST_QUADRATURE_ERROR, resolution <= detects) {
        (false, _) => Some(CountDoubt::QuadratureNotConverged),
        (true, false) => Some(CountDoubt::TooFewSamples),
        (true, true) => None,
    }
}

fn report(stages: Escalation<CountStage>, effort: &Effort, drawn: Drawn) -> CountReport {
    let Drawn { expected, counts, forbidden, .. } = drawn;
    let (first, detects) = (stages[0], effort.detects);
    let resolution = resolution(&first);
    let improper_cell = expected.cells.iter().position(|p| !(*p >= 0.0 && p.is_finite()));
    let rejected = stages.rejects() || forbidden.is_some() || improper_cell.is_some();
    let doubt = doubt(&first, resolution, detects).filter(|_| !rejected);
    let total = counts.total() as f64;
    let wanted: Vec<f64> = expected.cells.iter().map(|p| p * total).collect();
    CountReport {
        verdict: Verdict::of_test(rejected, doubt.is_none()),
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
    // Where none are, samples that depend on each other hide the error.
    let missing = needed.saturating_sub(first.samples);
    (doubt == Some(CountDoubt::TooFewSamples) && missing > 0).then_some(missing)
}

fn residual(observed: u64, expected: f64) -> f64 {
    let difference = observed as f64 - expected;
    if difference == 0.0 { 0.0 } else { (difference / expected.sqrt()).min(LARGEST_RESIDUAL) }
}

/// The pdf error that the first stage sees. The quadrature error may have worked against it, and what samples that
/// depend on each other may do comes on top.
fn resolution(first: &CountStage) -> f64 {
    let dependence = first.allowed - chi_square_upper(STAGE_LEVEL, first.freedom);
    let noncentrality =
        detectable_noncentrality(first.freedom, STAGE_LEVEL, MISS_LEVEL) + dependence;
    (noncentrality.sqrt() + 2.0 * first.quadrature_error.sqrt()) / (first.samples as f64).sqrt()
}

#[cfg(test)]
mod tests;
