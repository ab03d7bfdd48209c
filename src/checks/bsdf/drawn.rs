//! Samples of one surface, beside what it evaluates to.

use super::terms::Scattering;
use crate::cause::{Cause, bsdf};
use crate::checks::form::Form;
use crate::checks::numbers::Numbers;
use crate::checks::phrase::some_are;
use crate::checks::surface::{SurfaceEntry, evaluated, sampled};
use crate::checks::{Context, Measure, Result};
use crate::contract::{BsdfQuery, BsdfSample, BsdfValue, Conventions};
use crate::math::frame::direction;
use crate::math::rng::{Stream, uniform};
use crate::math::sphere::{at_height, on_hemisphere};
use crate::stats::{Compared, ExactReport, Tolerance, judge_exact};
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Views with many samples each.
const VIEWS: usize = 64;

const SAMPLES_PER_VIEW: usize = 512;

/// Samples in which a law is looked for, about.
const LOOKED_AT: usize = 400;

/// Angles from the horizon at which mistakes divide by nearly nothing, radians.
pub(super) const GRAZING: [f64; 4] = [1e-2, 1e-4, 1e-8, 1e-12];

/// What there is to say of one surface.
pub(super) struct Judged {
    pub(super) measures: Vec<Measure>,
    pub(super) complaint: Option<String>,
    pub(super) cause: Option<&'static Cause>,
    pub(super) laws: Vec<String>,
}

/// Samples of one surface, with the views they were drawn for.
pub(super) struct Drawn {
    pub(super) surface: SurfaceEntry,
    pub(super) views: Vec<DVec3>,
    pub(super) samples: Vec<BsdfSample>,
}

/// Directions from which the surface is seen, among them straight on and grazing ones.
pub(super) fn views(surface: SurfaceEntry, stream: &mut Stream) -> Vec<DVec3> {
    let special = GRAZING.iter().map(|up| direction(FRAC_PI_2 - up, 1.0)).chain([DVec3::Z]);
    let mut views: Vec<_> = special.collect();
    if surface.lets_pass() {
        views.extend_from_within(..);
        views.iter_mut().take(GRAZING.len() + 1).for_each(|view| *view = -*view);
    }
    views.resize_with(VIEWS, || surface.direction(stream));
    views
}

impl Drawn {
    pub(super) fn new(context: &mut Context<'_>, surface: SurfaceEntry) -> Result<Self> {
        let seed = context.seed.child(surface);
        let mut stream = seed.stream();
        let each = |view: DVec3| std::iter::repeat_n(view, SAMPLES_PER_VIEW);
        let views: Vec<_> = views(surface, &mut stream).into_iter().flat_map(each).collect();
        let numbers = Numbers::new(seed.child("numbers"), views.len());
        let random = numbers.randomness();
        let samples = sampled(context.core, &surface.material(), &views, random)?;
        Ok(Self { surface, views, samples })
    }

    pub(super) fn judge(&self, context: &mut Context<'_>) -> Result<Judged> {
        if self.surface.is_delta() {
            return self.judge_delta(context);
        }
        let allowed = Tolerance::SAME_VALUE.of(context.info.precision);
        let valid: Vec<_> = self.valid().collect();
        let values = self.evaluated(context, valid.iter().map(|(view, s)| (*view, s.wi)))?;
        let pairs = || valid.iter().zip(&values);
        let compared = |(_, s): &(DVec3, BsdfSample), v: &BsdfValue| {
            let f = |c: usize| Compared::relative(s.f[c], v.f[c], allowed);
            [Compared::relative(s.pdf, v.pdf, allowed), f(0), f(1), f(2)]
        };
        let mut compared: Vec<_> = pairs().map(|(pair, value)| compared(pair, value)).collect();
        self.forgive_rounding(context, &valid, &values, &mut compared)?;
        let pdf = judge_exact(compared.iter().map(|[pdf, ..]| *pdf));
        let f = judge_exact(compared.iter().flat_map(|[_, f @ ..]| *f));
        let below = self.lit_below_horizon(context)?;
        let cosines = pairs().filter(|(_, value)| value.f[1] > 0.0);
        let shares: Vec<_> = cosines.map(|((_, s), v)| (s.f[1] / v.f[1], s.wi.z)).collect();
        let is_cosine =
            Form::of(&shares).is_some_and(|f| f.is_like(Form { constant: 1.0, power: 1 }));
        let name = self.surface.to_string();
        let dark = |below| Measure::none("directions below the horizon with a value", below);
        let measures =
            [Measure::worst("pdf of a sample", &pdf), Measure::worst("value of a sample", &f)];
        let measures = measures.into_iter().chain(below.map(dark)).map(|m| m.of_row(&name));
        let measures = measures.collect();
        let below = below.unwrap_or(0);
        let other = |what: &str, report: &ExactReport, noun: &str| {
            let some = some_are(report.disagree, report.compared, noun);
            Some(format!("{some} drawn with another {what} than evaluated"))
        };
        let complaint = match (pdf.disagree, f.disagree, below) {
            (0, 0, 0) => None,
            (0, 0, _) => {
                Some(format!("{below} directions below the horizon have a value or a pdf"))
            }
            (0, ..) => other("value", &f, "channels"),
            _ => other("pdf", &pdf, "samples"),
        };
        let cause = match (pdf.disagree, f.disagree) {
            (0, 0) if below > 0 => Some(&bsdf::LIGHT_FROM_BELOW),
            (0, 1..) if is_cosine => Some(&bsdf::COSINE_IN_SAMPLED_F),
            _ => None,
        };
        let complaint = complaint.map(|complaint| format!("{name}: {complaint}"));
        let laws = self.laws(context.info.conventions, &valid, &values, allowed);
        Ok(Judged { measures, complaint, cause, laws })
    }

    /// What samples are over what is evaluated, of some of them.
    fn laws(
        &self,
        conventions: Conventions,
        valid: &[(DVec3, BsdfSample)],
        values: &[BsdfValue],
        allowed: f64,
    ) -> Vec<String> {
        let scattering = Scattering { surface: self.surface.material().surface, conventions };
        let apart = (valid.len() / LOOKED_AT).max(1);
        let pairs = || valid.iter().zip(values).step_by(apart);
        let law = |what: &str,
                   of: &dyn Fn(&BsdfSample) -> f64,
                   right: &dyn Fn(&BsdfValue) -> f64| {
            let numbers = pairs().map(|((wo, sample), value)| {
                (BsdfQuery { wo: *wo, wi: sample.wi }, of(sample), right(value))
            });
            let numbers: Vec<_> = numbers.collect();
            let law = scattering.law_of_numbers(&numbers, "what is evaluated", 10.0 * allowed)?;
            Some(format!("the {what} of samples of {} {law}", scattering.kind()))
        };
        let pdf = law("pdf", &|sample| sample.pdf, &|value| value.pdf);
        pdf.into_iter().chain(law("f", &|sample| sample.f[1], &|value| value.f[1])).collect()
    }

    /// A mirror or glass says so, and is nothing to whoever evaluates it.
    fn judge_delta(&self, context: &mut Context<'_>) -> Result<Judged> {
        let unmarked = self.valid().filter(|(_, sample)| sample.is_delta == 0).count();
        let mut stream = context.seed.child("elsewhere").stream();
        let elsewhere: Vec<_> =
            self.views.iter().map(|view| (*view, on_hemisphere(&mut stream))).collect();
        let values = self.evaluated(context, elsewhere.into_iter())?;
        let lit = values.iter().filter(|value| has_value(value)).count();
        let name = self.surface.to_string();
        let measures = vec![
            Measure::none("samples not marked as delta", unmarked).of_row(&name),
            Measure::none("other directions with a value", lit).of_row(&name),
        ];
        let complaint = (unmarked + lit > 0)
            .then(|| format!("{name} is certain of its direction: mark it, and evaluate to zero"));
        let cause = (unmarked > 0 && lit == 0).then_some(&bsdf::MIRROR_NOT_DELTA);
        Ok(Judged { measures, complaint, cause, laws: Vec::new() })
    }

    pub(super) fn valid(&self) -> impl Iterator<Item = (DVec3, BsdfSample)> {
        let pairs = self.views.iter().copied().zip(self.samples.iter().copied());
        pairs.filter(|(_, sample)| sample.is_valid == 1)
    }

    pub(super) fn evaluated(
        &self,
        context: &mut Context<'_>,
        pairs: impl Iterator<Item = (DVec3, DVec3)>,
    ) -> Result<Vec<BsdfValue>> {
        let queries: Vec<_> = pairs.map(|(wo, wi)| BsdfQuery { wo, wi }).collect();
        Ok(evaluated(context.core, &self.surface.material(), &queries)?)
    }

    /// A sampled direction is rounded, and value and pdf are evaluated where it went to. Where they differ, as much
    /// more is allowed as they change within that rounding.
    fn forgive_rounding(
        &self,
        context: &mut Context<'_>,
        valid: &[(DVec3, BsdfSample)],
        values: &[BsdfValue],
        compared: &mut [[Compared; 4]],
    ) -> Result<()> {
        let rounding = Tolerance::DIRECTION.of(context.info.precision);
        let differing: Vec<_> = (0..valid.len())
            .filter(|number| !compared[*number].iter().all(Compared::agrees))
            .collect();
        let around = differing.iter().flat_map(|number| {
            let (view, sample) = valid[*number];
            beside(sample.wi, rounding).map(|wi| (view, wi))
        });
        let around = self.evaluated(context, around)?;
        for (number, around) in differing.iter().zip(around.chunks_exact(BESIDE)) {
            let parts = |value: &BsdfValue| [value.pdf, value.f[0], value.f[1], value.f[2]];
            let there = parts(&values[*number]);
            for (part, compared) in compared[*number].iter_mut().enumerate() {
                let changes = around.iter().map(|value| (parts(value)[part] - there[part]).abs());
                compared.allowed += changes.fold(0.0, f64::max);
            }
        }
        Ok(())
    }

    /// A surface that reflects only has no value below the horizon. `None` where light passes.
    fn lit_below_horizon(&self, context: &mut Context<'_>) -> Result<Option<usize>> {
        if self.surface.lets_pass() {
            return Ok(None);
        }
        let mut stream = context.seed.child("below").stream();
        let mut down = || at_height(-1.0 + 0.99 * uniform(&mut stream), TAU * uniform(&mut stream));
        let pairs: Vec<_> = self.views.iter().map(|view| (*view, down())).collect();
        let values = self.evaluated(context, pairs.into_iter())?;
        Ok(Some(values.iter().filter(|value| has_value(value)).count()))
    }
}

/// How many directions [`beside`] answers.
const BESIDE: usize = 4;

/// Directions at the angle `rounding`, radians, from `wi` on four sides.
fn beside(wi: DVec3, rounding: f64) -> [DVec3; BESIDE] {
    let (first, second) = wi.any_orthonormal_pair();
    [first, -first, second, -second].map(|side| (wi + rounding * side).normalize())
}

fn has_value(value: &BsdfValue) -> bool {
    value.pdf != 0.0 || value.f != [0.0; 3]
}
