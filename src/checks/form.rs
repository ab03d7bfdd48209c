//! Answers that are a constant times a power of the cosine: what most wrong pdfs and values
//! are, and how they are told apart.

use std::f64::consts::FRAC_1_PI;

/// Nearly all values lie within this of the form, relative.
const SPREAD: f64 = 0.02;
/// Powers of the cosine that mistakes make.
const POWERS: [i32; 5] = [0, 1, -1, 2, -2];
/// Fewer values prove nothing.
const FEWEST: usize = 20;

/// `constant` · cosᵖ θ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Form {
    /// In the middle of all values.
    pub(crate) constant: f64,
    pub(crate) power: i32,
}

impl Form {
    pub(crate) const fn constant(constant: f64) -> Self {
        Self { constant, power: 0 }
    }

    /// The pdf of uniform directions of the hemisphere.
    pub(crate) const UNIFORM: Self = Self::constant(0.5 * FRAC_1_PI);
    /// The pdf of cosine-distributed directions.
    pub(crate) const COSINE: Self = Self { constant: FRAC_1_PI, power: 1 };

    /// The form of these values, each at its cosine, if they have one.
    pub(crate) fn of(values: &[(f64, f64)]) -> Option<Self> {
        let form = |power| Some(Self { constant: constant_of(values, power)?, power });
        POWERS.into_iter().find_map(form)
    }

    /// The same, so many times as large.
    pub(crate) fn times(self, factor: f64) -> Self {
        Self { constant: factor * self.constant, ..self }
    }

    /// Whether it is the other one but for noise.
    pub(crate) fn is_like(self, other: Self) -> bool {
        self.power == other.power && self.is_times(1.0, other)
    }

    /// Whether it is the other one times `factor`.
    pub(crate) fn is_times(self, factor: f64, other: Self) -> bool {
        let ratio = self.constant / (factor * other.constant);
        self.power == other.power && (ratio - 1.0).abs() <= SPREAD
    }
}

/// c, if nearly all values are c cosᵖ θ.
fn constant_of(values: &[(f64, f64)], power: i32) -> Option<f64> {
    let mut constants: Vec<_> =
        values.iter().map(|(value, cosine)| value / cosine.abs().powi(power)).collect();
    constants.sort_by(f64::total_cmp);
    let at = |share: f64| constants.get((share * constants.len() as f64) as usize).copied();
    let (low, middle, high) = (at(0.05)?, at(0.5)?, at(0.95)?);
    let is_one = values.len() >= FEWEST && high - low <= SPREAD * middle.abs();
    is_one.then_some(middle)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn form(value: fn(f64) -> f64) -> Option<Form> {
        let cosines = (0..100).map(|i| (f64::from(i) + 0.5) / 100.0);
        Form::of(&cosines.map(|cosine| (value(cosine), cosine)).collect::<Vec<_>>())
    }

    #[test]
    fn powers_of_the_cosine_are_told_apart() {
        assert_eq!(form(|_| 0.5), Some(Form { constant: 0.5, power: 0 }));
        assert!(form(|c| c / PI).is_some_and(|form| form.is_like(Form::COSINE)));
        assert!(form(|c| c).is_some_and(|form| form.is_times(PI, Form::COSINE)));
        assert!(form(|c| 2.0 / c).is_some_and(|form| form.power == -1));
        assert_eq!(form(f64::exp), None);
    }

    #[test]
    fn a_few_values_have_no_form() {
        assert_eq!(Form::of(&[(1.0, 0.5), (1.0, 0.6)]), None);
    }
}
