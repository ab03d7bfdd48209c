//! A sampler's map and its density fit together at every point: |∂ω/∂u × ∂ω/∂v| · pdf = 1.
//!
//! Where a third number chooses between ways, each way has a map of its own, and the product is the chance of that
//! way: the share of third numbers that choose it, which is found by halving.
//!
//! No statistics: wherever the map from the unit square is smooth, how much it stretches area is the reciprocal of
//! the density (an idea seen in the tests of lajolla). Needs a core that samples with the caller's numbers.

use super::density::{Density, Law};
use super::distribution::{Distribution, DistributionEntry, Drawn};
use super::of_distributions::OfDistributions;
use super::way::{Way, is_same_way};
use crate::cause::Cause;
use crate::checks::form::Form;
use crate::checks::numbers::Numbers;
use crate::checks::phrase::figure;
use crate::checks::{CheckError, Context, Finding, Measure};
use crate::contract::{Capabilities, Precision, Randomness};
use crate::math::ratios::names_of;
use crate::stats::{Tolerance, Verdict};
use glam::DVec2;
use serde::Deserialize;

/// Points of the unit square.
const POINTS: usize = 2000;
/// Fewer points with a derivative than this prove nothing: most of the map fails, or has a kink.
const FEWEST_POINTS: usize = POINTS / 10;
/// Points lie on a grid of this step, so that single precision holds them and their neighbours.
const GRID: f64 = 1.0 / 1_048_576.0;

/// Density times Jacobian is 1.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct SampleJacobian {
    distribution: DistributionEntry,
}

impl OfDistributions for SampleJacobian {
    const NAME: &'static str = "sample-jacobian";
    const SUMMARY: &'static str =
        "density times the area that the sampler's map makes of the unit square";
    type Judged = Vec<Products>;

    fn distribution(&self) -> &DistributionEntry {
        &self.distribution
    }

    fn needs_besides(&self) -> Capabilities {
        Capabilities::CALLERS_RANDOMNESS
    }

    fn judge(
        &self,
        context: &mut Context<'_>,
        distribution: &Distribution,
    ) -> Result<Self::Judged, CheckError> {
        Way::of(distribution).iter().map(|way| Products::of(context, distribution, *way)).collect()
    }

    fn finding(judged: &[Self::Judged]) -> Finding {
        let products = || judged.iter().flatten();
        let right =
            format!("density times Jacobian is 1 at {} points", POINTS * products().count());
        let precision = products().next().map_or(Precision::Double, |one| one.precision);
        let allowed = Tolerance::JACOBIAN_MEDIAN.of(precision);
        let caught = format!("would have caught a factor of 1 ± {}", figure(allowed));
        Finding::of(right, caught, products().flat_map(Products::measures).collect())
            .complaining(products().filter_map(Products::complaint))
            .because_each(
                products().filter_map(Products::cause),
                "predicts density and Jacobian at nearly all points",
            )
    }
}

/// Half the distance of central differences: the cube root of a rounding balances truncation against rounding.
const fn step(precision: Precision) -> f64 {
    match precision {
        Precision::Double => GRID * 8.0,
        Precision::Single => GRID * 4096.0,
    }
}

/// Density times Jacobian at many points.
pub struct Products {
    name: String,
    /// (product, cos θ), sorted by product; points whose neighbours fail are left out.
    values: Vec<(f64, f64)>,
    precision: Precision,
    density: Option<Density>,
}

impl Products {
    fn of(
        context: &mut Context<'_>,
        distribution: &Distribution,
        way: Way,
    ) -> Result<Self, CheckError> {
        let precision = context.info.precision;
        let h = step(precision);
        let seed = context.seed.child(distribution.name());
        let numbers = Numbers::new(seed, POINTS);
        let on_grid = |u: f64| h + ((1.0 - 2.0 * h) * u / GRID).floor() * GRID;
        let points: Vec<_> =
            numbers.points.iter().map(|p| DVec2::new(on_grid(p.x), on_grid(p.y))).collect();
        let core = &mut *context.core;
        let mut draw = |points: &[DVec2], lobes: &[f64]| {
            let random = Randomness { points, lobes, seed: seed.0 };
            Ok(distribution.sample(core, random)?)
        };
        let lobes = vec![way.lobe(); points.len()];
        let mut at = |offset: DVec2| {
            draw(&points.iter().map(|point| *point + offset).collect::<Vec<_>>(), &lobes)
        };
        let centre = at(DVec2::ZERO)?;
        let [right, left] = [at(DVec2::new(h, 0.0))?, at(DVec2::new(-h, 0.0))?];
        let [above, below] = [at(DVec2::new(0.0, h))?, at(DVec2::new(0.0, -h))?];
        let chances = way.chances(&points, &mut draw, &centre)?;
        let product = |i: usize| {
            let neighbours = [&right[i], &left[i], &above[i], &below[i]];
            let goes_on = neighbours.iter().all(|drawn| is_same_way(drawn, &centre[i]));
            let along = |to: &[Drawn], from: &[Drawn]| {
                Some((to[i].direction? - from[i].direction?) / (2.0 * h))
            };
            let jacobian = along(&right, &left)?.cross(along(&above, &below)?).length();
            let product = centre[i].pdf * jacobian / chances[i];
            goes_on.then_some((product, centre[i].direction?.z))
        };
        let mut values: Vec<_> = (0..points.len()).filter_map(product).collect();
        values.sort_by(|a, b| a.0.total_cmp(&b.0));
        let density = Density::of(context.core, distribution)?;
        Ok(Self { name: distribution.name() + way.words(), values, precision, density })
    }

    /// The error that this share of the points does not exceed.
    fn error_of_share(&self, share: f64) -> f64 {
        let mut errors: Vec<_> = self.values.iter().map(|(value, _)| (value - 1.0).abs()).collect();
        errors.sort_by(f64::total_cmp);
        let last = errors.len().saturating_sub(1);
        errors.get(((share * errors.len() as f64) as usize).min(last)).copied().unwrap_or(f64::NAN)
    }

    fn measures(&self) -> Vec<Measure> {
        let of = |what: &str, share, tolerance: Tolerance| {
            let (error, allowed) = (self.error_of_share(share), tolerance.of(self.precision));
            Measure::exact(format!("error of {what} of the points"), error, 0.0, allowed)
                .of_row(&self.name)
        };
        let mut measures = vec![
            of("half", 0.5, Tolerance::JACOBIAN_MEDIAN),
            of("99 %", 0.99, Tolerance::JACOBIAN_TAIL),
        ];
        if self.values.len() < FEWEST_POINTS {
            measures.iter_mut().for_each(|measure| measure.verdict = Verdict::Inconclusive);
        }
        measures
    }

    fn fails(&self) -> bool {
        self.measures().iter().any(Measure::failed)
    }

    fn complaint(&self) -> Option<String> {
        self.fails().then(|| format!("{}: density times Jacobian is {}", self.name, self.factor()))
    }

    /// A wrong density, or else a wrong map.
    fn cause(&self) -> Option<&'static Cause> {
        let density = self.density.filter(|_| self.fails())?;
        density.mistake().or_else(|| density.mistake_of_map(self.law(density)?))
    }

    fn law(&self, density: Density) -> Option<Law> {
        if self.error_of_share(0.5) > 0.99 && self.values.iter().all(|(value, _)| *value < 0.01) {
            return Some(Law::Line);
        }
        let over_sine =
            |(value, cosine): &(f64, f64)| (value / (1.0 - cosine * cosine).sqrt(), *cosine);
        let by_angle: Vec<_> = self.values.iter().map(over_sine).collect();
        match Form::of(&self.values) {
            Some(product) => density.law_of_product(product),
            None => density.law_of_angle(Form::of(&by_angle)?),
        }
    }

    /// The product as a constant, as a constant times a power of the cosine, or by its range.
    fn factor(&self) -> String {
        if let Some(Form { constant, power }) = Form::of(&self.values) {
            let words = match power {
                1 => " cos θ",
                -1 => " / cos θ",
                2 => " cos² θ",
                -2 => " / cos² θ",
                _ => "",
            };
            return format!("{}{words} instead of 1", named(constant));
        }
        let [low, high] = [0.05, 0.95].map(|share| {
            self.values.get((share * self.values.len() as f64) as usize).map_or(f64::NAN, |v| v.0)
        });
        format!("between {} and {} instead of 1", figure(low), figure(high))
    }
}

/// `2π`, or the figure.
fn named(value: f64) -> String {
    let names = names_of([0.99 * value, 1.01 * value], &[]);
    names.first().map_or_else(|| figure(value), |ratio| ratio.name.clone())
}

#[cfg(test)]
mod tests {
    use super::super::fake::{
        cosine, cosine_density, drawing, interface, uniform, uniform_density,
    };
    use super::*;
    use crate::checks::testing::{assert_passes, check_of, failure, judge};
    use crate::math::sphere::at_height;
    use glam::DVec3;
    use std::f64::consts::TAU;

    fn found(map: fn(DVec2) -> Option<DVec3>, density: fn(DVec3) -> f64) -> Finding {
        let check: SampleJacobian =
            check_of("[expect]\ndistribution = { sampler = \"cosine-hemisphere\" }");
        judge(&check, &mut drawing(map, density))
    }

    /// The statement and the first clue.
    fn named(map: fn(DVec2) -> Option<DVec3>, density: fn(DVec3) -> f64) -> (String, String) {
        let finding = found(map, density);
        let clue = finding.clues.first().map_or_else(String::new, |clue| clue.cause.clone());
        (failure(&finding).to_owned(), clue)
    }

    fn assert_named(found: (String, String), statement: &str, clue: &str) {
        assert!(found.0.ends_with(statement), "{found:?}");
        assert_eq!(found.1, clue);
    }

    #[test]
    fn maps_that_fit_their_densities_pass() {
        assert_passes(&found(cosine, cosine_density));
        assert_passes(&found(uniform, uniform_density));
    }

    #[test]
    fn a_missing_one_over_pi_is_a_constant_factor() {
        assert_named(named(cosine, |d| d.z.max(0.0)), "is π instead of 1", "pdf-without-pi");
    }

    #[test]
    fn the_wrong_density_for_the_map_is_a_cosine() {
        let wrong_density = named(cosine, uniform_density);
        assert_named(wrong_density, "is 1/2 / cos θ instead of 1", "uniform-pdf-for-cosine");
        let wrong_map = named(uniform, cosine_density);
        assert_named(wrong_map, "is 2 cos θ instead of 1", "uniform-for-cosine");
    }

    #[test]
    fn angles_that_are_drawn_uniformly_are_named() {
        let theta = |p: DVec2| Some(crate::math::frame::direction(0.25 * TAU * p.x, TAU * p.y));
        let finding = found(theta, cosine_density);
        failure(&finding);
        assert_eq!(finding.clues[0].cause, "theta-uniform");
    }

    #[test]
    fn half_of_the_azimuths_is_a_factor_of_one_half() {
        let half = |p: DVec2| Some(at_height((1.0 - p.x).sqrt(), 0.5 * TAU * p.y));
        assert_named(named(half, cosine_density), "is 1/2 instead of 1", "half-of-azimuths");
    }

    fn of_both_ways(density: fn(DVec3) -> f64) -> Finding {
        let check: SampleJacobian = check_of(
            "[expect]\ndistribution = { surface = { rough-glass = { index = 1.5, roughness = 0.5 } }, \
             seen-from = [\"30 deg\"] }",
        );
        judge(&check, &mut interface(0.3, density))
    }

    #[test]
    fn ways_that_are_chosen_by_their_chance_pass_and_others_are_off_by_it() {
        assert_passes(&of_both_ways(|d| {
            (if d.z > 0.0 { 0.3 } else { 0.7 }) * cosine_density(d.with_z(d.z.abs()))
        }));
        let finding = of_both_ways(|d| cosine_density(d.with_z(d.z.abs())));
        assert!(
            failure(&finding).contains("lobe 0: density times Jacobian is 3.33 instead"),
            "{finding:?}"
        );
    }

    #[test]
    fn a_map_that_mostly_fails_proves_nothing() {
        let finding = found(|_| None, cosine_density);
        // The contract has no failing sampler, so that the fake answers +z everywhere: area 0.
        assert_eq!(finding.verdict, Verdict::Fail);
    }
}
