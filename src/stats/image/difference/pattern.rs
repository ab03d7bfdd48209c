//! What differences are looked for: light, in cells of several sizes, and edges that lie elsewhere.

use super::STAGES;
use super::unit::{MEASURES, SIDE, Unit, Units};
use crate::stats::Moments;
use crate::stats::image::Extent;
use crate::stats::image::cells::COMPONENTS;
use crate::stats::law::student_tail;
use crate::text::spoken;
use serde::Serialize;
use std::collections::BTreeMap;
use std::ops::Range;

/// Cells and measures that are confirmed together.
const MOST_CHOSEN: usize = 64;
/// A cell with fewer units in a stage is not judged: their spread says too little.
const FEWEST_UNITS: usize = 6;

spoken! {
    /// A kind of difference.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Pattern {
        /// Light in tiles of 64 by 64 pixels.
        Tiles = "light in tiles of 64 × 64 pixels",
        /// Light in bands of 16 rows.
        Rows = "light in bands of 16 rows",
        /// Light in bands of 16 columns.
        Columns = "light in bands of 16 columns",
        /// Light in the whole picture.
        Whole = "light in the whole picture",
        /// Edges in the whole picture.
        Edges = "where edges lie",
    }
}

impl Pattern {
    /// From the finest to the coarsest.
    pub(crate) const ALL: [Self; 5] =
        [Self::Tiles, Self::Rows, Self::Columns, Self::Whole, Self::Edges];

    /// Units in a cell, across and down; none for as many as there are.
    const fn extent(self) -> [Option<usize>; 2] {
        match self {
            Self::Tiles => [Some(8), Some(8)],
            Self::Rows => [None, Some(2)],
            Self::Columns => [Some(2), None],
            Self::Whole | Self::Edges => [None, None],
        }
    }

    const fn measures(self) -> Range<usize> {
        match self {
            Self::Edges => COMPONENTS..MEASURES,
            _ => 0..COMPONENTS,
        }
    }

    /// The cells with units enough in every stage.
    pub(super) fn cells(self, units: &Units) -> Vec<Cell<'_>> {
        let [across, down] = self.extent().map(|units| units.unwrap_or(usize::MAX));
        let mut cells = BTreeMap::<_, Cell<'_>>::new();
        for unit in &units.all {
            let cell = cells.entry((unit.row / down, unit.column / across)).or_default();
            cell.stages[unit.stage()].push(unit);
        }
        cells.retain(|_, cell| cell.stages.iter().all(|units| units.len() >= FEWEST_UNITS));
        cells.into_values().collect()
    }

    /// What stands out in the first stage, the most extreme first.
    pub(super) fn choices(self, cells: &[Cell<'_>]) -> Vec<Choice> {
        let mut choices = Vec::new();
        for (number, cell) in cells.iter().enumerate() {
            choices.extend(self.measures().filter_map(|measure| cell.choice(number, measure)));
        }
        choices.sort_by(|a, b| b.t.total_cmp(&a.t));
        choices.truncate(MOST_CHOSEN);
        choices
    }
}

/// Units that are judged together.
#[derive(Clone, Debug, Default)]
pub(crate) struct Cell<'a> {
    stages: [Vec<&'a Unit>; STAGES],
}

/// A measure of a cell that stood out in the first stage.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Choice {
    pub(super) cell: usize,
    measure: usize,
    sign: f64,
    weight: f64,
    /// How far outside its band, in standard errors.
    pub(super) t: f64,
}

impl Choice {
    /// What of light it is about; nothing of an edge.
    pub(super) fn component(&self) -> Option<usize> {
        (self.measure < COMPONENTS).then_some(self.measure)
    }
}

impl Cell<'_> {
    /// The mean of a measure over the units of a stage, with its standard error.
    pub(super) fn moments(&self, stage: usize, measure: usize) -> Moments {
        self.stages[stage].iter().map(|unit| unit.sums[measure]).collect()
    }

    /// How far the mean of a measure may be from nothing.
    pub(super) fn band(&self, stage: usize, measure: usize) -> f64 {
        self.mean(stage, |unit| unit.bands[measure])
    }

    /// What the mean of a measure is relative to.
    pub(super) fn scale(&self, stage: usize, measure: usize) -> f64 {
        self.mean(stage, |unit| unit.scales[measure])
    }

    fn mean(&self, stage: usize, of: impl Fn(&Unit) -> f64) -> f64 {
        let units = &self.stages[stage];
        units.iter().map(|unit| of(unit)).sum::<f64>() / units.len() as f64
    }

    /// The standard error that the known noise gives the mean of a measure; 0 where none is known.
    pub(super) fn known_error(&self, stage: usize, measure: usize) -> f64 {
        let units = &self.stages[stage];
        let variance: f64 = units.iter().map(|unit| unit.variances[measure]).sum();
        variance.sqrt() / units.len() as f64
    }

    fn choice(&self, cell: usize, measure: usize) -> Option<Choice> {
        let (moments, band) = (self.moments(0, measure), self.band(0, measure));
        let departure = moments.mean().abs() - band;
        let error = moments.standard_error().max(self.known_error(0, measure));
        // The band keeps a cell that happened not to vary from weighing more than all others.
        let weight = departure / (error * error + band * band);
        let stands_out = departure > 0.0 && weight.is_finite();
        stands_out.then(|| Choice {
            cell,
            measure,
            sign: moments.mean().signum(),
            weight,
            t: departure / error,
        })
    }

    /// How often a choice of the first stage stands out so far by chance.
    pub(super) fn tail(&self, choice: &Choice) -> f64 {
        student_tail(choice.t, self.stages[0].len() as f64 - 1.0)
    }

    /// The difference of a choice over what it is relative to, in all stages.
    pub(super) fn relative(&self, choice: &Choice) -> f64 {
        let units = || self.stages.iter().flatten();
        let sum: f64 = units().map(|unit| unit.sums[choice.measure]).sum();
        sum / units().map(|unit| unit.scales[choice.measure]).sum::<f64>()
    }

    pub(super) fn extent(&self) -> Extent {
        let units = || self.stages.iter().flatten();
        let ends = |of: fn(&Unit) -> usize| {
            let least = units().map(|unit| of(unit)).min().unwrap_or(0);
            let most = units().map(|unit| of(unit)).max().unwrap_or(0);
            (SIDE * least, SIDE * (most + 1 - least))
        };
        let ((x, width), (y, height)) = (ends(|unit| unit.column), ends(|unit| unit.row));
        Extent { x, y, width, height }
    }
}

/// What a confirmation says: how far the choices are outside their bands together, in standard
/// errors, and the degrees of freedom of those.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Score {
    pub(super) t: f64,
    pub(super) freedom: f64,
}

/// The weighted sum of all choices in a stage. The measures of one cell hang together, so they are
/// added up unit by unit before their spread is taken; cells do not.
pub(super) fn confirm(cells: &[Cell<'_>], choices: &[Choice], stage: usize) -> Score {
    let (mut total, mut variance, mut fourth) = (0.0, 0.0, 0.0);
    for (number, cell) in cells.iter().enumerate() {
        let chosen: Vec<_> = choices.iter().filter(|choice| choice.cell == number).collect();
        if chosen.is_empty() {
            continue;
        }
        let of_unit = |unit: &&Unit| -> f64 {
            let term = |choice: &&Choice| {
                let band = unit.bands[choice.measure];
                choice.weight * (choice.sign * unit.sums[choice.measure] - band)
            };
            chosen.iter().map(term).sum()
        };
        let moments: Moments = cell.stages[stage].iter().map(of_unit).collect();
        let known = chosen.iter().map(|c| c.weight * cell.known_error(stage, c.measure)).sum();
        let square = moments.standard_error().max(known).powi(2);
        total += moments.mean();
        variance += square;
        fourth += square * square / (moments.count() as f64 - 1.0);
    }
    let t = if total == 0.0 { 0.0 } else { total / variance.sqrt() };
    // After Welch and Satterthwaite; nothing varied where there is nothing to divide by.
    let freedom = if fourth > 0.0 { variance * variance / fourth } else { FEWEST_UNITS as f64 };
    Score { t, freedom }
}
