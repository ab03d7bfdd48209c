//! What pixels show of their strata, and the mistakes that make it.

use super::strata_pattern::{Reading, STRATA, law};
use crate::cause::{Cause, camera};
use crate::checks::phrase::percent;
use crate::stats::{CountReport, Counts, follows_law};

/// What pixels have shown.
#[derive(Clone, Debug)]
pub(super) struct Tally {
    pub(super) pixels: u64,
    /// Of them, those in which no cell has two samples.
    even: u64,
    /// Those that are no mean of four samples of the scene.
    pub(super) unreadable: u64,
    /// The first pixel that can be read to its last sample, and whether all such are like it.
    pattern: Option<[u32; STRATA]>,
    one_pattern: bool,
    /// Where in its cell one sample of each pixel lies.
    pub(super) counts: Counts,
}

impl Default for Tally {
    fn default() -> Self {
        let counts = Counts { cells: vec![0; 9], absorbed: 0 };
        Self { pixels: 0, even: 0, unreadable: 0, pattern: None, one_pattern: true, counts }
    }
}

impl Tally {
    pub(super) fn take(&mut self, reading: Option<Reading>) {
        self.pixels += 1;
        let Some(reading) = reading else { return self.unreadable += 1 };
        self.even += u64::from(reading.is_even());
        match reading.cell {
            Some(cell) => self.counts.cells[cell] += 1,
            None => self.counts.absorbed += 1,
        }
        if reading.is_whole() {
            let pattern = *self.pattern.get_or_insert(reading.strata);
            self.one_pattern &= pattern == reading.strata;
        }
    }

    pub(super) fn uneven(&self) -> u64 {
        self.pixels - self.even - self.unreadable
    }

    pub(super) fn is_uneven(&self) -> bool {
        self.even < self.pixels
    }
}

/// How far from what independent samples give the share of even pixels may be: five standard errors of the first look.
const EXPLAINED: f64 = 0.035;

/// The share of pixels in which four independent samples fall in four different cells: 4!/4⁴.
const EVEN_BY_CHANCE: f64 = 24.0 / 256.0;

/// The mistake that predicts what is seen, if there is one.
pub(super) fn mistake(
    all: &Tally,
    report: Option<&CountReport>,
) -> Option<(&'static Cause, String)> {
    let Some(report) = report else { return uneven_mistake(all) };
    let counts = Counts { cells: report.observed.clone(), absorbed: report.absorbed_observed };
    if counts.cells[4] == counts.total() {
        let all = counts.total();
        let evidence = format!("all {all} samples lie in the middle ninth of their cells");
        return Some((&camera::STRATUM_CENTRE, evidence));
    }
    let halves = [[0.0, 0.5], [0.25, 0.75], [0.5, 1.0]];
    let [from, to] = halves.into_iter().find(|half| follows_law(&law(*half), &counts))?;
    let evidence = format!("from {from} to {to} of a cell predicts the counts of all its ninths");
    Some((&camera::STRATUM_HALF, evidence))
}

fn uneven_mistake(all: &Tally) -> Option<(&'static Cause, String)> {
    if all.unreadable > 0 {
        return None;
    }
    let even = all.even as f64 / all.pixels as f64;
    if (even - EVEN_BY_CHANCE).abs() <= EXPLAINED {
        let (chance, found) = (percent(EVEN_BY_CHANCE), percent(even));
        let evidence = format!("{found} of the pixels are even, {chance} would be by chance");
        return Some((&camera::STRATA_IGNORED, evidence));
    }
    let pattern = all.pattern.filter(|_| all.one_pattern)?;
    let evidence = format!("the four cells of every pixel have {pattern:?} samples");
    Some((&camera::STRATA_UNEVEN, evidence))
}
