//! Where answers are wrong, and right everywhere else: in a place that has a name, or beyond a bound.

use super::{Answered, FEWEST, LOST, Terms};
use crate::checks::phrase::figure;
use std::collections::BTreeSet;

/// Where answers are wrong of which there is a right one and a wrong one: `where b1 is above 0.5`.
pub(crate) fn place_of_wrong(
    terms: Terms,
    answers: impl Iterator<Item = (bool, Vec<f64>, Vec<bool>)>,
) -> Option<String> {
    let of = |(is_right, quantities, places): (bool, Vec<f64>, Vec<bool>)| Answered {
        found: f64::from(u8::from(is_right)),
        right: 1.0,
        quantities,
        places,
    };
    let answers: Vec<_> = answers.map(of).collect();
    let (right, wrong): (Vec<_>, Vec<_>) = answers.iter().partition(|one| one.found == one.right);
    (wrong.len() >= FEWEST).then(|| place_of(terms, &wrong, &right)).flatten()
}

/// Where the wrong ones are and the right ones are not: in a place that has a name, or in two at once, or beyond a bound.
pub(super) fn place_of(terms: Terms, wrong: &[&Answered], right: &[&Answered]) -> Option<String> {
    let stray = right.len().min(wrong.len()) / LOST;
    let is_told_by = |is_there: &dyn Fn(&Answered) -> bool| {
        let outside = wrong.iter().filter(|one| !is_there(one)).count();
        right.len() >= FEWEST && outside + right.iter().filter(|one| is_there(one)).count() <= stray
    };
    let sides = || {
        (0..terms.places.len()).flat_map(move |number| {
            let [there, elsewhere] = terms.places[number];
            [(number, true, there), (number, false, elsewhere)]
        })
    };
    let in_one = sides().find_map(|(number, is_so, words)| {
        is_told_by(&|one| one.places[number] == is_so).then(|| words.to_owned())
    });
    let in_both = || {
        sides().flat_map(|one| sides().map(move |other| [one, other])).find_map(|[one, other]| {
            let is_there = |answered: &Answered| {
                answered.places[one.0] == one.1 && answered.places[other.0] == other.1
            };
            let told = one.0 < other.0 && is_told_by(&is_there);
            told.then(|| format!("{} and {}", one.2, other.2))
        })
    };
    let beyond = || {
        (0..terms.quantities.len()).find_map(|number| {
            let bound = bound_of(wrong, right, |one| one.quantities[number])?;
            Some(format!("where {} is {bound}", terms.quantities[number]))
        })
    };
    in_one.or_else(in_both).or_else(beyond)
}

/// The bound that parts the wrong from the right, if one does.
fn bound_of(
    wrong: &[&Answered],
    right: &[&Answered],
    of: impl Fn(&Answered) -> f64,
) -> Option<String> {
    let ends = |of_these: &[&Answered]| {
        let values = || of_these.iter().map(|one| of(one));
        [values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max)]
    };
    let distinct: BTreeSet<_> = right.iter().map(|one| of(one).to_bits()).collect();
    if distinct.len() < FEWEST {
        return None;
    }
    let ([wrong_low, wrong_high], [right_low, right_high]) = (ends(wrong), ends(right));
    if wrong_high < right_low {
        Some(format!("below {}", figure(0.5 * (wrong_high + right_low))))
    } else if right_high < wrong_low {
        Some(format!("above {}", figure(0.5 * (wrong_low + right_high))))
    } else {
        None
    }
}
