//! Laws of wrong numbers: what gives every wrong answer of a function, though nobody has made that mistake before.
//!
//! - [`replaced()`]: the right formula with one quantity in the place of another (`takes ωi in place of ωo in G1`);
//! - [`law_of`]: a product of few quantities (`is 4 (ωo · h) times what it should be, where light passes`);
//! - [`place_of_wrong`]: where answers are wrong, and nowhere else;
//! - [`Lost`]: estimates of light of which some bring nothing, and the others all they should.
//!
//! A law has to give every wrong number, each to a five hundredth of its error, or of means within their noise; what no law
//! gives has none.

mod lost;
mod place;
mod product;
mod replaced;

pub(crate) use lost::{LOST_SAMPLES, Lost, lost_in_words};
use place::place_of;
pub(crate) use place::place_of_wrong;
use product::{Rule, Search};
pub(crate) use replaced::{Formula, are_right, replaced};

/// The law of answers in double precision that are as right as single precision comes.
pub(crate) const ROUNDED: &str =
    "right to single precision alone, as with a `float` among the doubles";
/// The same of all but what was mended.
pub(crate) const RIGHT_BUT_ROUNDED: &str =
    "is right to single precision, as with a `float` among the doubles";

/// What a law may be made of.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Terms {
    /// Factors, as they are written: `cos θi`, `D(h)`.
    pub(crate) quantities: &'static [&'static str],
    /// Places, each with where it is not: `where light is reflected`, `where light passes`.
    pub(crate) places: &'static [[&'static str; 2]],
    /// What the answers are held against: `what it should be`.
    pub(crate) right: &'static str,
}

/// A number that a core answered, and what it may depend on.
#[derive(Clone, Debug)]
pub(crate) struct Answered {
    pub(crate) found: f64,
    pub(crate) right: f64,
    /// In the order of the terms; 0 or less where a quantity is none.
    pub(crate) quantities: Vec<f64>,
    /// Whether it is the place of the term.
    pub(crate) places: Vec<bool>,
}

impl Answered {
    /// NaN is not.
    fn is_right(&self, allowed: f64) -> bool {
        (self.found - self.right).abs() <= allowed * self.right.abs()
    }
}

/// Fewer wrong numbers prove nothing.
const FEWEST: usize = 16;
/// How well a law gives each number, as a share of its error.
const FIT: f64 = 0.002;
/// One wrong number in so many may be lost to rounding.
const LOST: usize = 50;

/// The law of these answers, in words that go on after the name of what was answered: `is 2 cos θo times what it should
/// be`. `allowed` is what rounding may do, relative.
pub(crate) fn law_of(terms: Terms, answers: &[Answered], allowed: f64) -> Option<String> {
    let (right, wrong): (Vec<_>, Vec<_>) = answers.iter().partition(|one| one.is_right(allowed));
    if wrong.len() < FEWEST {
        return None;
    }
    let place = place_of(terms, &wrong, &right);
    let is_known = |one: &&Answered| one.found.is_finite() && one.right.is_finite();
    let search = Search { terms, wrong: &wrong, right: &right, allowed };
    match search.rule().filter(|_| wrong.iter().all(is_known)) {
        Some(Rule { words, tells_where: true }) => Some(words),
        Some(Rule { words, .. }) => Some(match place {
            _ if right.is_empty() => words,
            Some(place) => format!("{words} {place}, and right elsewhere"),
            None => format!("{words} at {} of {}", wrong.len(), answers.len()),
        }),
        None => place.map(|place| format!("is wrong {place}, and right elsewhere")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rng::{Seed, uniform};

    const TERMS: Terms = Terms {
        quantities: &["cos θo", "cos θi", "(ωo · h)"],
        places: &[["where light is reflected", "where light passes"]],
        right: "what it should be",
    };

    /// Of what is right.
    type Found = fn(f64, &Answered) -> f64;

    fn law(found: impl Fn(f64, &Answered) -> f64) -> String {
        let mut stream = Seed(3).stream();
        let mut answers = Vec::new();
        for number in 0..200 {
            let quantities: Vec<_> = (0..3).map(|_| 0.05 + 0.95 * uniform(&mut stream)).collect();
            let right = quantities[0] + uniform(&mut stream);
            let one = Answered { found: 0.0, right, quantities, places: vec![number % 3 == 0] };
            answers.push(Answered { found: found(right, &one), ..one });
        }
        law_of(TERMS, &answers, 1e-9).unwrap_or_else(|| "no law".to_owned())
    }

    #[test]
    fn a_product_of_few_quantities_is_told() {
        let told: [(&str, Found); 10] = [
            ("is 2 times what it should be", |right, _| 2.0 * right),
            ("has the opposite sign", |right, _| -right),
            ("is 4 cos θi times what it should be", |right, one| 4.0 * one.quantities[1] * right),
            ("is 1 / (ωo · h)² times what it should be", |r, one| r / one.quantities[2].powi(2)),
            ("is cos θo / cos θi times what it should be", |right, one| {
                right * one.quantities[0] / one.quantities[1]
            }),
            ("is √(ωo · h) / π times what it should be", |right, one| {
                right * one.quantities[2].sqrt() * std::f64::consts::FRAC_1_PI
            }),
            ("is cos θo (ωo · h) / cos θi times what it should be", |right, one| {
                right * one.quantities[0] * one.quantities[2] / one.quantities[1]
            }),
            ("is cos θi / 2, not what it should be", |_, one| 0.5 * one.quantities[1]),
            ("is 3 (cos θi)² more than what it should be", |right, one| {
                right + 3.0 * one.quantities[1].powi(2)
            }),
            ("is 0", |_, _| 0.0),
        ];
        for (words, found) in told {
            let law = law(found)
                .replace("1/2 cos θi", "cos θi / 2")
                .replace("1/π √(ωo · h)", "√(ωo · h) / π");
            assert_eq!(law, words);
        }
    }

    #[test]
    fn where_it_holds_is_told() {
        let told: [(&str, Found); 6] = [
            ("is wrong where cos θo is below 0.5, and right elsewhere", |right, one| {
                if one.quantities[0] > 0.5 { right } else { f64::INFINITY }
            }),
            ("is 2 times what it should be where light passes, and right elsewhere", |r, one| {
                if one.places[0] { r } else { 2.0 * r }
            }),
            ("is 0 where light is reflected, and right elsewhere", |r, one| {
                if one.places[0] { 0.0 } else { r }
            }),
            (
                "is 2 times what it should be where cos θi is below 0.299, and right elsewhere",
                |r, one| {
                    if one.quantities[1] < 0.3 { 2.0 * r } else { r }
                },
            ),
            ("is never above 1.2", |right, _| right.min(1.2)),
            ("is never below 0.6", |right, _| right.max(0.6)),
        ];
        for (words, found) in told {
            assert!(law(found).starts_with(words), "{}", law(found));
        }
    }

    #[test]
    fn what_no_law_gives_has_none() {
        let told: [Found; 4] = [
            |right, _| right,
            |right, one| right * (1.0 + 0.3 * (40.0 * one.quantities[1]).sin()),
            |right, one| right * (one.quantities[0] + one.quantities[1]),
            |_, _| f64::NAN,
        ];
        for found in told {
            assert_eq!(law(found), "no law");
        }
    }
}
