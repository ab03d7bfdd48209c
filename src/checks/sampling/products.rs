//! Pdf times Jacobian at many points of one distribution.

use super::claimed_pdf::{ClaimedPdf, Law};
use super::distribution::{Distribution, Drawn};
use super::way::{Way, is_same_way};
use crate::cause::Cause;
use crate::checks::bsdf::terms::Scattering;
use crate::checks::form::Form;
use crate::checks::law::{Answered, Terms, law_of};
use crate::checks::numbers::Numbers;
use crate::checks::phrase::figure;
use crate::checks::{Context, Measure, Result};
use crate::contract::{BsdfQuery, Conventions, Core, Precision, Randomness};
use crate::math::ratios::names_of;
use crate::math::rng::Seed;
use crate::math::sphere::on_sphere;
use crate::stats::{Tolerance, Verdict};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// Points of the unit square.
pub(super) const POINTS: usize = 2000;

/// What central differences may be off by, where nothing is wrong.
const DIFFERENCES: f64 = 1e-3;

/// Points in which a law is looked for, about.
const LOOKED_AT: usize = 400;

/// Fewer points with a derivative than this prove nothing: most of the map fails, or has a kink.
const FEWEST_POINTS: usize = POINTS / 10;

/// Points lie on a grid of this step, so that single precision holds them and their neighbours.
const GRID: f64 = 1.0 / 1_048_576.0;

/// Half the distance of central differences: the cube root of a rounding balances truncation against rounding.
const fn step(precision: Precision) -> f64 {
    match precision {
        Precision::Double => GRID * 8.0,
        Precision::Single => GRID * 4096.0,
    }
}

/// Pdf times Jacobian at many points.
pub(crate) struct Products {
    pub(super) name: String,
    /// (product, cos θ), sorted by product; points whose neighbours fail are left out.
    pub(super) values: Vec<(f64, f64)>,
    /// In an eighth of the circle at least there is no direction.
    pub(super) leaves_azimuths_out: bool,
    pub(super) precision: Precision,
    pub(super) pdf: Option<ClaimedPdf>,
    /// What the pdf is to that of the samples.
    law: Option<String>,
}

impl Products {
    pub(super) fn of(
        context: &mut Context<'_>,
        distribution: &Distribution,
        way: Way,
    ) -> Result<Self> {
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
            goes_on.then_some((product, centre[i].direction?))
        };
        let products: Vec<_> = (0..points.len()).filter_map(product).collect();
        let conventions = context.info.conventions;
        let mut values: Vec<_> = products.iter().map(|(value, wi)| (*value, wi.z)).collect();
        values.sort_by(|a, b| a.0.total_cmp(&b.0));
        let pdf = ClaimedPdf::of(context.core, distribution)?;
        let name = distribution.name() + way.words();
        let leaves_azimuths_out = leave_azimuths_out(&centre);
        let judged = Self { name, values, leaves_azimuths_out, precision, pdf, law: None };
        if !judged.fails() {
            return Ok(judged);
        }
        let of_pdf = law_of_pdf(context.core, distribution, conventions, precision)?;
        let law = of_pdf.or_else(|| law(distribution, conventions, &products, precision));
        let kind = kind(distribution, conventions);
        Ok(Self { law: law.map(|law| format!("the pdf of {kind} {law}")), ..judged })
    }

    /// The error that this share of the points does not exceed.
    fn error_of_share(&self, share: f64) -> f64 {
        let mut errors: Vec<_> = self.values.iter().map(|(value, _)| (value - 1.0).abs()).collect();
        errors.sort_by(f64::total_cmp);
        let last = errors.len().saturating_sub(1);
        errors.get(((share * errors.len() as f64) as usize).min(last)).copied().unwrap_or(f64::NAN)
    }

    pub(super) fn measures(&self) -> Vec<Measure> {
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

    pub(super) fn fails(&self) -> bool {
        self.measures().iter().any(Measure::failed)
    }

    pub(super) fn complaint(&self) -> Option<String> {
        let factor = || format!("{}: pdf times Jacobian is {}", self.name, self.factor());
        let law = self.law_in_words().filter(|_| Form::of(&self.values).is_none());
        let law = law.map(|law| format!("{}: {law}", self.name));
        self.fails().then(|| law.unwrap_or_else(factor))
    }

    pub(super) fn law_in_words(&self) -> Option<String> {
        self.law.clone()
    }

    /// A wrong pdf, or else a wrong map.
    pub(super) fn cause(&self) -> Option<&'static Cause> {
        let pdf = self.pdf.filter(|_| self.fails())?;
        pdf.mistake().or_else(|| pdf.mistake_of_map(self.law(pdf)?))
    }

    pub(super) fn law(&self, pdf: ClaimedPdf) -> Option<Law> {
        if self.error_of_share(0.5) > 0.99 && self.values.iter().all(|(value, _)| *value < 0.01) {
            return self.winds_around().then_some(Law::Line);
        }
        let over_sine =
            |(value, cosine): &(f64, f64)| (value / (1.0 - cosine * cosine).sqrt(), *cosine);
        let by_angle: Vec<_> = self.values.iter().map(over_sine).collect();
        match Form::of(&self.values) {
            Some(product) => pdf.law_of_product(product, self.leaves_azimuths_out),
            None => pdf.law_of_angle(Form::of(&by_angle)?),
        }
    }

    /// Whether heights and azimuths both vary, as along a spiral: a line that keeps one of them is another mistake.
    fn winds_around(&self) -> bool {
        let cosines = || self.values.iter().map(|(_, cosine)| *cosine);
        let heights = cosines().fold(-1.0, f64::max) - cosines().fold(1.0, f64::min);
        heights > 0.5 && !self.leaves_azimuths_out
    }

    /// The product as a constant, as a constant times a power of the cosine, or by its range.
    pub(super) fn factor(&self) -> String {
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

fn kind(distribution: &Distribution, conventions: Conventions) -> String {
    match distribution {
        Distribution::Sampler(_) => distribution.name(),
        Distribution::Bsdf { material, .. } => {
            Scattering { surface: material.surface, conventions }.kind().to_owned()
        }
    }
}

/// What gives the pdf by itself, at many directions.
fn law_of_pdf(
    core: &mut dyn Core,
    distribution: &Distribution,
    conventions: Conventions,
    precision: Precision,
) -> Result<Option<String>> {
    let Distribution::Bsdf { material, wo, .. } = distribution else { return Ok(None) };
    let mut stream = Seed::SUITE.child("law of a pdf").stream();
    let directions: Vec<_> = (0..LOOKED_AT).map(|_| on_sphere(&mut stream)).collect();
    let mut pdfs = vec![0.0; directions.len()];
    distribution.pdf(core, &directions, &mut pdfs)?;
    let query = |(wi, pdf): (&DVec3, &f64)| (BsdfQuery { wo: *wo, wi: *wi }, *pdf);
    let pdfs: Vec<_> = directions.iter().zip(&pdfs).map(query).collect();
    let scattering = Scattering { surface: material.surface, conventions };
    Ok(scattering.law_of_pdfs(&pdfs, Tolerance::FORMULA.of(precision)))
}

/// What these products of pdf and Jacobian are made of.
fn law(
    distribution: &Distribution,
    conventions: Conventions,
    products: &[(f64, DVec3)],
    precision: Precision,
) -> Option<String> {
    const AGAINST: &str = "that of its samples";
    let allowed = Tolerance::JACOBIAN_MEDIAN.of(precision).max(DIFFERENCES);
    let apart = (products.len() / LOOKED_AT).max(1);
    let products = products.iter().step_by(apart);
    match distribution {
        Distribution::Sampler(_) => {
            let answered = |(found, wi): &(f64, DVec3)| Answered {
                found: *found,
                right: 1.0,
                quantities: vec![wi.z],
                places: Vec::new(),
            };
            let terms = Terms { quantities: &["cos θ"], places: &[], right: AGAINST };
            law_of(terms, &products.map(answered).collect::<Vec<_>>(), allowed)
        }
        Distribution::Bsdf { material, wo, .. } => {
            let scattering = Scattering { surface: material.surface, conventions };
            let number = |(found, wi): &(f64, DVec3)| (BsdfQuery { wo: *wo, wi: *wi }, *found, 1.0);
            scattering.law_of_numbers(&products.map(number).collect::<Vec<_>>(), AGAINST, allowed)
        }
    }
}

/// Whether one of eight sectors has no direction. Of [`POINTS`] directions that go all around, each has hundreds.
fn leave_azimuths_out(drawn: &[Drawn]) -> bool {
    const SECTORS: usize = 8;
    let mut is_met = [false; SECTORS];
    for direction in drawn.iter().filter_map(|one| one.direction) {
        let turn = direction.y.atan2(direction.x) / TAU + 0.5;
        is_met[((turn * SECTORS as f64) as usize).min(SECTORS - 1)] = true;
    }
    is_met.contains(&false)
}

/// `2π`, or the figure.
pub(super) fn named(value: f64) -> String {
    let names = names_of([0.99 * value, 1.01 * value], &[]);
    names.first().map_or_else(|| figure(value), |ratio| ratio.name.clone())
}
