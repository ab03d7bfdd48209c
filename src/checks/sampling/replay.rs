//! Asking for the same samples again, in another order, and with one of their numbers changed.

use super::distribution::Drawn;
use crate::cause::{Cause, sampling};
use crate::checks::Measure;
use crate::checks::numbers::Numbers;
use crate::checks::phrase::{percent, some_are};
use glam::{DVec2, DVec3};

/// Samples.
pub(crate) const COUNT: usize = 2000;
/// A number is changed by this much: about a third of its range, round the end.
const STEP: f64 = 0.37;
/// A direction that is moved by less than this has not been moved.
const MOVED: f64 = 1e-4;
/// Numbers that do nothing for more samples than this share are not used. Failed samples stay where
/// they are, and so do those of a lobe that needs fewer numbers.
const MOSTLY: f64 = 0.5;

impl Numbers {
    /// The same backwards.
    fn reversed(&self) -> Self {
        let mut reversed = self.clone();
        reversed.points.reverse();
        reversed.lobes.reverse();
        reversed
    }

    /// The first or the second number of every sample, changed.
    fn with_changed(&self, number: usize) -> Self {
        let mut changed = self.clone();
        let points = changed.points.iter_mut();
        points.for_each(|point| point[number] = (point[number] + STEP).fract());
        changed
    }
}

/// What came of asking again and again.
pub(crate) struct Replayed {
    name: String,
    /// Samples that differ when the same is asked again.
    forgotten: usize,
    /// Samples that differ when the batch is asked backwards.
    misplaced: usize,
    /// Shares of samples that the first and the second number move.
    moved: [f64; 2],
    /// Whether both numbers move every sample along the same curve.
    along_one_curve: bool,
}

impl Replayed {
    /// Asks for the same samples, backwards, and with one number changed.
    pub(crate) fn of<E>(
        name: String,
        numbers: &Numbers,
        ask: &mut dyn FnMut(&Numbers) -> Result<Vec<Drawn>, E>,
    ) -> Result<Self, E> {
        let first = ask(numbers)?;
        let again = ask(numbers)?;
        let mut backwards = ask(&numbers.reversed())?;
        backwards.reverse();
        let moved = [ask(&numbers.with_changed(0))?, ask(&numbers.with_changed(1))?];
        let swapped = Numbers {
            points: numbers.points.iter().map(|point| DVec2::splat(point.x)).collect(),
            ..numbers.clone()
        };
        let along = ask(&swapped)?;
        Ok(Self {
            name,
            forgotten: differing(&first, &again),
            misplaced: differing(&first, &backwards),
            moved: moved.each_ref().map(|moved| share_moved(&first, moved)),
            along_one_curve: differing(&first, &along) == 0,
        })
    }

    /// Four.
    pub(crate) fn measures(&self) -> [Measure; 4] {
        let unmoved = |which: &str, moved: f64| {
            let what = format!("share of samples that are not moved by the {which} number");
            Measure::at_most(what, 1.0 - moved, 1.0 - MOSTLY)
        };
        let again = "samples that differ when they are asked for again";
        let measures = [
            Measure::none(again, self.forgotten),
            Measure::none("samples that depend on their place in the batch", self.misplaced),
            unmoved("first", self.moved[0]),
            unmoved("second", self.moved[1]),
        ];
        measures.map(|measure| measure.of_row(&self.name))
    }

    /// The first thing that is wrong.
    pub(crate) fn complaint(&self) -> Option<String> {
        let told = |some: usize, what: &str| {
            format!("{}: {} {what}", self.name, some_are(some, COUNT, "samples"))
        };
        if self.forgotten > 0 {
            return Some(told(self.forgotten, "another when the same numbers are given again"));
        }
        if self.misplaced > 0 {
            return Some(told(self.misplaced, "another at another place of the batch"));
        }
        let unused = (0..2).find(|number| self.moved[*number] < MOSTLY)?;
        let share = percent(self.moved[unused]);
        let which = ["first", "second"][unused];
        Some(format!("{}: the {which} number moves {share} of the samples", self.name))
    }

    /// The mistake that is told by it, with evidence.
    pub(crate) fn cause(&self) -> Option<(&'static Cause, String)> {
        if self.forgotten > 0 {
            let evidence = format!("{} of {COUNT} samples change", self.forgotten);
            return Some((&sampling::OWN_NUMBERS, evidence));
        }
        if self.misplaced > 0 {
            let evidence = format!("{} of {COUNT} samples change with their place", self.misplaced);
            return Some((&sampling::NUMBERS_OF_ANOTHER, evidence));
        }
        let evidence = || "the second number of every sample can be replaced by its first";
        // Samples that are all alike, or all invalid, lie on no curve.
        let one_number = self.along_one_curve && self.moved[0] >= MOSTLY;
        one_number.then(|| (&sampling::ONE_NUMBER_TWICE, evidence().to_owned()))
    }
}

/// Samples that have not the same bits.
fn differing(first: &[Drawn], other: &[Drawn]) -> usize {
    let bits = |drawn: &Drawn| {
        let direction = drawn.direction.map(|direction| direction.to_array().map(f64::to_bits));
        (direction, drawn.pdf.to_bits())
    };
    first.iter().zip(other).filter(|(a, b)| bits(a) != bits(b)).count()
}

/// The share of samples that lie elsewhere, of those that lie anywhere.
fn share_moved(first: &[Drawn], other: &[Drawn]) -> f64 {
    let pairs = || first.iter().zip(other).filter_map(|(a, b)| Some((a.direction?, b.direction?)));
    let is_moved = |(a, b): &(DVec3, DVec3)| a.distance(*b) > MOVED;
    pairs().filter(is_moved).count() as f64 / pairs().count() as f64
}
