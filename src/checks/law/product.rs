//! The product of a few quantities that makes every wrong number out of the right one, or stands in its place.

use super::{Answered, FEWEST, FIT, LOST, Terms};
use crate::checks::phrase::figure;
use crate::math::ratios::names_of;
use std::cmp::Ordering;
use std::fmt;

/// Powers of one factor, and of each of two.
const POWERS: [f64; 8] = [1.0, -1.0, 2.0, -2.0, 0.5, -0.5, 4.0, -4.0];
const FEW_POWERS: [f64; 4] = [1.0, -1.0, 2.0, -2.0];

pub(super) struct Rule {
    pub(super) words: String,
    /// What is cut off says itself where it is so.
    pub(super) tells_where: bool,
}

impl Rule {
    const fn of(words: String) -> Self {
        Self { words, tells_where: false }
    }
}

pub(super) struct Search<'a> {
    pub(super) terms: Terms,
    pub(super) wrong: &'a [&'a Answered],
    pub(super) right: &'a [&'a Answered],
    pub(super) allowed: f64,
}

impl Search<'_> {
    pub(super) fn rule(&self) -> Option<Rule> {
        let rules = [Self::nothing, Self::multiple, Self::constant, Self::other, Self::sum];
        rules.into_iter().find_map(|rule| rule(self))
    }

    fn nothing(&self) -> Option<Rule> {
        self.wrong.iter().all(|one| one.found == 0.0).then(|| Rule::of("is 0".to_owned()))
    }

    /// One answer to everything, or to all beyond it.
    fn constant(&self) -> Option<Rule> {
        let answer = self.wrong[0].found;
        let is_it = |one: &&Answered| (one.found - answer).abs() <= self.allowed * answer.abs();
        let is_cut = |beyond: Ordering| {
            let is_beyond = |one: &&Answered| one.right.total_cmp(&answer) == beyond;
            self.right.len() >= FEWEST
                && self.wrong.iter().all(is_beyond)
                && !self.right.iter().any(is_beyond)
        };
        if !self.wrong.iter().all(is_it) {
            return None;
        }
        let answer = figure(answer);
        Some(if is_cut(Ordering::Greater) {
            Rule { words: format!("is never above {answer}"), tells_where: true }
        } else if is_cut(Ordering::Less) {
            Rule { words: format!("is never below {answer}"), tells_where: true }
        } else {
            Rule::of(format!("is {answer} in place of {}", self.terms.right))
        })
    }

    fn multiple(&self) -> Option<Rule> {
        let ratio = |one: &Answered| one.found / one.right;
        let product = self.product(ratio, |one| one.found - one.right)?;
        Some(Rule::of(match product.is_minus_one() {
            true => "has the opposite sign".to_owned(),
            false => format!("is {product} times {}", self.terms.right),
        }))
    }

    /// Something else in the place of what is right.
    fn other(&self) -> Option<Rule> {
        let product = self.product(|one| one.found, |one| one.found)?;
        // What is right itself varies, or any one number would do.
        (!product.factors.is_empty())
            .then(|| Rule::of(format!("is {product}, not {}", self.terms.right)))
    }

    fn sum(&self) -> Option<Rule> {
        let difference = |one: &Answered| one.found - one.right;
        let product = self.product(|one| difference(one).abs(), difference)?;
        let is_more = self.wrong.iter().filter(|one| difference(one) > 0.0).count();
        let word = match (is_more, self.wrong.len() - is_more) {
            (_, 0) => "more",
            (0, _) => "less",
            _ => return None,
        };
        Some(Rule::of(format!("is {product} {word} than {}", self.terms.right)))
    }

    /// The simplest product that is `value` everywhere, to a small share of the error.
    fn product(
        &self,
        value: impl Fn(&Answered) -> f64,
        error: impl Fn(&Answered) -> f64,
    ) -> Option<Product> {
        let sign = value(self.wrong[0]).signum();
        let points: Vec<_> = self
            .wrong
            .iter()
            .map(|one| Point::of(one, sign * value(one), error(one), self.allowed))
            .collect();
        let lost = points.iter().filter(|point| point.is_none()).count();
        if lost > self.wrong.len() / LOST {
            return None;
        }
        let points: Vec<_> = points.into_iter().flatten().collect();
        let constant = candidates(self.terms.quantities.len())
            .find_map(|factors| Some((constant_of(&points, &factors)?, factors)));
        let (constant, factors) = constant?;
        let named = |(place, power): (usize, f64)| (self.terms.quantities[place], power);
        Some(Product {
            constant: sign * constant,
            factors: factors.into_iter().map(named).collect(),
        })
    }
}

/// Logarithms of one number and of what may make it.
struct Point {
    value: f64,
    factors: Vec<f64>,
    /// How far from a law it may be.
    slack: f64,
}

impl Point {
    fn of(one: &Answered, value: f64, error: f64, allowed: f64) -> Option<Self> {
        let slack = (FIT * error.abs() / one.found.abs()).max(allowed).min(FIT.max(allowed));
        let factors = one.quantities.iter().map(|quantity| quantity.ln()).collect();
        (value > 0.0).then(|| Self { value: value.ln(), factors, slack })
    }

    fn without(&self, factors: &[(usize, f64)]) -> f64 {
        let made = factors.iter().map(|(place, power)| power * self.factors[*place]).sum::<f64>();
        self.value - made
    }
}

/// Places of factors with their powers, the simplest first.
fn candidates(count: usize) -> impl Iterator<Item = Vec<(usize, f64)>> {
    let places = move || 0..count;
    let of_one = places().flat_map(|place| POWERS.map(|power| vec![(place, power)]));
    let pairs = places().flat_map(move |one| (one + 1..count).map(move |other| (one, other)));
    let of_two = pairs.flat_map(|(one, other)| {
        let both = FEW_POWERS.iter().flat_map(|p| FEW_POWERS.iter().map(move |q| (*p, *q)));
        let mut both: Vec<_> = both.collect();
        both.sort_by(|a, b| (a.0.abs() + a.1.abs()).total_cmp(&(b.0.abs() + b.1.abs())));
        both.into_iter().map(move |(p, q)| vec![(one, p), (other, q)])
    });
    let triples = places().flat_map(move |a| {
        (a + 1..count).flat_map(move |b| (b + 1..count).map(move |c| [a, b, c]))
    });
    let of_three = triples.flat_map(|[a, b, c]| {
        (0..8_u32).map(move |signs| {
            let power = |bit: u32| if signs >> bit & 1 == 0 { 1.0 } else { -1.0 };
            vec![(a, power(0)), (b, power(1)), (c, power(2))]
        })
    });
    std::iter::once(Vec::new()).chain(of_one).chain(of_two).chain(of_three)
}

/// What is left of every point without these factors, if it is one number.
fn constant_of(points: &[Point], factors: &[(usize, f64)]) -> Option<f64> {
    let lost = points.len() / LOST;
    let middle_of = |points: &[Point]| {
        median(&mut points.iter().map(|point| point.without(factors)).collect::<Vec<_>>())
    };
    let are_met = |points: &[Point], middle: f64, slack: f64| {
        let is_met =
            |point: &&Point| (point.without(factors) - middle).abs() <= slack * point.slack;
        points.iter().filter(is_met).count() + lost >= points.len()
    };
    // Most products fail at the first few points.
    let first = &points[..points.len().min(2 * lost + 3)];
    if !are_met(first, middle_of(first), 2.0) {
        return None;
    }
    let middle = middle_of(points);
    are_met(points, middle, 1.0).then(|| middle.exp())
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// A number times powers of factors.
struct Product {
    constant: f64,
    factors: Vec<(&'static str, f64)>,
}

impl Product {
    fn is_minus_one(&self) -> bool {
        self.factors.is_empty() && (self.constant + 1.0).abs() <= FIT
    }

    fn constant_in_words(&self) -> Option<String> {
        let size = self.constant.abs();
        let sign = if self.constant < 0.0 { "-" } else { "" };
        if (size - 1.0).abs() <= 0.5 * FIT && !self.factors.is_empty() {
            return (!sign.is_empty()).then(|| sign.to_owned());
        }
        let interval = [(1.0 - FIT) * size, (1.0 + FIT) * size];
        let named = names_of(interval, &[]).into_iter().next();
        Some(format!("{sign}{}", named.map_or_else(|| figure(size), |ratio| ratio.name)))
    }
}

impl fmt::Display for Product {
    /// `2 cos θo / (cos θi (ωo · h)²)`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let written = |(name, power): &(&str, f64)| match power.abs() {
            1.0 => (*name).to_owned(),
            0.5 => format!("√({})", name.trim_matches(['(', ')'])),
            2.0 => format!("{}²", bracketed(name)),
            _ => format!("{}⁴", bracketed(name)),
        };
        let of_sign = |sign: f64| {
            let factors = self.factors.iter().filter(|(_, power)| power.signum() == sign);
            factors.map(written).collect::<Vec<_>>()
        };
        let (above, below) = (of_sign(1.0), of_sign(-1.0));
        let mut above: Vec<_> = self.constant_in_words().into_iter().chain(above).collect();
        if above.is_empty() || above == ["-"] {
            above.push("1".to_owned());
        }
        f.write_str(&above.join(" ").replace("- ", "-"))?;
        match &below[..] {
            [] => Ok(()),
            [one] => write!(f, " / {one}"),
            more => write!(f, " / ({})", more.join(" ")),
        }
    }
}

fn bracketed(name: &str) -> String {
    match name.contains(' ') && !name.starts_with('(') {
        true => format!("({name})"),
        false => name.to_owned(),
    }
}
