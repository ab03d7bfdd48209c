//! A formula with one quantity in the place of another, in one of its functions or everywhere.

use super::{Answered, FEWEST, FIT, LOST, Terms, place_of};
use std::collections::BTreeSet;

/// A formula of quantities.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Formula {
    /// What it takes: in which of its functions, and which of the terms' quantities.
    pub(crate) takes: &'static [(&'static str, usize)],
    /// Of what it takes, in that order, and of the places; but for a factor that does not depend on them.
    pub(crate) value: fn(&[f64], &[bool]) -> f64,
}

/// What a quantity may become: how it is written, before and after its name.
type Change = ([&'static str; 2], fn(f64) -> f64);

const CHANGES: [Change; 4] = [
    (["", "²"], |q| q * q),
    (["√", ""], f64::sqrt),
    (["1 / ", ""], f64::recip),
    (["1 - ", ""], |q| 1.0 - q),
];

/// What gives every wrong answer, in words that go on after the name of what was answered: `takes cos θi in place of cos θo
/// in G1`; and where, if it would give other answers where they are right. None where the formula itself gives them.
pub(crate) fn replaced(
    terms: Terms,
    formula: Formula,
    answers: &[Answered],
    allowed: f64,
) -> Option<String> {
    let (right, wrong): (Vec<_>, Vec<_>) = answers.iter().partition(|one| one.is_right(allowed));
    if wrong.len() < FEWEST {
        return None;
    }
    let place = place_of(terms, &wrong, &right);
    let told = |of_all: &[&Answered]| Search { terms, formula, answers: of_all, allowed }.told();
    let everywhere = told(&answers.iter().collect::<Vec<_>>());
    everywhere.or_else(|| Some(format!("{} {}", told(&wrong)?, place?)))
}

/// Whether answers are what they are held against, but for a few that may be lost to rounding.
pub(crate) fn are_right(answers: &[Answered], allowed: f64) -> bool {
    let is_off = |one: &&Answered| !one.is_right(allowed);
    answers.iter().filter(is_off).count() <= answers.len() / LOST
}

struct Search<'a> {
    terms: Terms,
    formula: Formula,
    answers: &'a [&'a Answered],
    allowed: f64,
}

impl Search<'_> {
    fn told(&self) -> Option<String> {
        let takes = self.formula.takes;
        let of_one = (0..takes.len()).find_map(|slot| {
            let (function, quantity) = takes[slot];
            self.change(&[slot], quantity, function)
        });
        let quantities: BTreeSet<_> = takes.iter().map(|(_, quantity)| *quantity).collect();
        let slots =
            |quantity: usize| (0..takes.len()).filter(move |slot| takes[*slot].1 == quantity);
        let of_all = |quantity: usize| {
            self.change(&slots(quantity).collect::<Vec<_>>(), quantity, "all of it")
        };
        of_one.or_else(|| quantities.into_iter().find_map(of_all))
    }

    /// What these slots take in place of the quantity that belongs there.
    fn change(&self, slots: &[usize], quantity: usize, function: &str) -> Option<String> {
        let belongs = self.terms.quantities[quantity];
        let others = (0..self.terms.quantities.len()).filter(|other| *other != quantity);
        let taken = others
            .filter(|other| self.gives(slots, |one| one.quantities[*other]))
            .map(|other| self.terms.quantities[other].to_owned());
        let changed = CHANGES
            .iter()
            .filter(|(_, change)| self.gives(slots, |one| change(one.quantities[quantity])));
        let changed = changed.map(|([before, after], _)| format!("{before}{belongs}{after}"));
        if let Some(taken) = taken.chain(changed).next() {
            return Some(format!("takes {taken} in place of {belongs} in {function}"));
        }
        self.gives(slots, |_| 1.0).then(|| format!("leaves {belongs} out of {function}"))
    }

    fn gives(&self, slots: &[usize], taken: impl Fn(&Answered) -> f64) -> bool {
        let Formula { takes, value } = self.formula;
        let is_given = |one: &&&Answered| {
            let right: Vec<_> = takes.iter().map(|(_, of)| one.quantities[*of]).collect();
            let mut wrong = right.clone();
            slots.iter().for_each(|slot| wrong[*slot] = taken(one));
            let expected = one.right * value(&wrong, &one.places) / value(&right, &one.places);
            let slack = (self.allowed * expected.abs()).max(FIT * (one.found - one.right).abs());
            (one.found - expected).abs() <= slack
        };
        // Most changes fail at the first few answers.
        let first = FEWEST.min(self.answers.len());
        let given = |answers: &[&Answered]| answers.iter().filter(is_given).count();
        let lost = self.answers.len() / LOST;
        given(&self.answers[..first]) + lost >= first
            && given(self.answers) + lost >= self.answers.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rng::{Seed, uniform};

    const TERMS: Terms =
        Terms {
            quantities: &["cos θo", "cos θi", "α"], places: &[], right: "what it should be"
        };

    const FORMULA: Formula = Formula {
        takes: &[("D", 0), ("D", 2), ("G", 1), ("G", 2), ("the denominator", 0)],
        value: |taken, _| {
            let [a, b, c, d, e] = *taken else { return f64::NAN };
            (1.0 + a * b) * (2.0 + c * d) / e
        },
    };

    fn law(found: impl Fn(&[f64]) -> f64) -> Option<String> {
        let mut stream = Seed(3).stream();
        let answered = |_| {
            let q: Vec<_> = (0..3).map(|_| 0.05 + 0.9 * uniform(&mut stream)).collect();
            let taken = FORMULA.takes.map_of(&q);
            let right = 0.7 * (FORMULA.value)(&taken, &[]);
            Answered { found: 0.7 * found(&q), right, quantities: q, places: Vec::new() }
        };
        let answers: Vec<_> = (0..100).map(answered).collect();
        replaced(TERMS, FORMULA, &answers, 1e-9)
    }

    type Made = fn(&[f64]) -> f64;

    trait MapOf {
        fn map_of(&self, quantities: &[f64]) -> Vec<f64>;
    }

    impl MapOf for [(&'static str, usize)] {
        fn map_of(&self, quantities: &[f64]) -> Vec<f64> {
            self.iter().map(|(_, of)| quantities[*of]).collect()
        }
    }

    #[test]
    fn what_stands_in_the_place_of_a_quantity_is_told() {
        let told: [(&str, Made); 5] = [
            ("takes cos θo in place of cos θi in G", |q| {
                (1.0 + q[0] * q[2]) * (2.0 + q[0] * q[2]) / q[0]
            }),
            ("takes α² in place of α in D", |q| {
                (1.0 + q[0] * q[2] * q[2]) * (2.0 + q[1] * q[2]) / q[0]
            }),
            ("takes √α in place of α in all of it", |q| {
                (1.0 + q[0] * q[2].sqrt()) * (2.0 + q[1] * q[2].sqrt()) / q[0]
            }),
            ("leaves cos θo out of the denominator", |q| {
                (1.0 + q[0] * q[2]) * (2.0 + q[1] * q[2])
            }),
            ("takes 1 - cos θo in place of cos θo in D", |q| {
                (1.0 + (1.0 - q[0]) * q[2]) * (2.0 + q[1] * q[2]) / q[0]
            }),
        ];
        for (words, found) in told {
            assert_eq!(law(found).as_deref(), Some(words));
        }
    }

    #[test]
    fn where_it_is_replaced_is_told() {
        let wrong = |q: &[f64]| (1.0 + q[0] * q[2]) * (2.0 + q[0] * q[2]) / q[0];
        let right = |q: &[f64]| (1.0 + q[0] * q[2]) * (2.0 + q[1] * q[2]) / q[0];
        let law = law(|q| if q[2] < 0.5 { wrong(q) } else { right(q) }).unwrap();
        assert!(law.starts_with("takes cos θo in place of cos θi in G where α is below"), "{law}");
    }

    #[test]
    fn what_is_right_or_otherwise_wrong_has_no_such_law() {
        assert_eq!(law(|q| (1.0 + q[0] * q[2]) * (2.0 + q[1] * q[2]) / q[0]), None);
        assert_eq!(law(|q| (1.0 + q[0] * q[2]) * (3.0 + q[1] * q[2]) / q[0]), None);
        assert_eq!(law(|_| f64::NAN), None);
    }
}
