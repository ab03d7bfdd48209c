//! Mirrors and glass: where they send light, how much of it, and how often.
//!
//! Three things have to fit for each view: the directions (the law of reflection, Snell's), what each of them
//! carries (Fresnel reflectance times the colour), and the probability of choosing it, which the core may pick but has to say.

use super::interface::{Interface, MISTAKES, Mistake};
use super::smooth_trial::Trial;
use super::smooth_view::{Allowed, SmoothView, chance_clue, mark_clue};
use crate::cause::Cause;
use crate::checks::phrase::{degrees, percent};
use crate::checks::surface::SurfaceEntry;
use crate::checks::{Check, Context, Finding, Result, check};
use crate::stats::{Band, Tolerance};
use crate::text::{Count, Percent, Polar, Several};

check! {
    /// Samples a mirror or glass from some angles; beyond 90° the viewer is inside.
    pub(crate) struct ReflectsAndRefracts {
        surface: SurfaceEntry,
        seen_from: Several<Polar>,
        /// The smallest error of the share of samples reflected.
        detects: Percent,
        at_most: Count,
    }
    name: "reflects-and-refracts",
    summary: "mirror and glass: directions, Fresnel's shares, weights, chances",
    needs: SAMPLE_BSDF,
}

impl Check for ReflectsAndRefracts {
    fn validate(&self) -> Result<(), String> {
        match self.surface.is_delta() {
            true => Ok(()),
            false => Err(format!("{} scatters; give a mirror or glass", self.surface)),
        }
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding> {
        let precision = context.info.precision;
        let material = self.surface.material();
        let trial = Trial {
            interface: Interface::new(material.surface, context.info.conventions),
            material,
            allowed: Allowed {
                direction: Tolerance::DIRECTION.of(precision),
                formula: Tolerance::FORMULA.of(precision),
            },
            effort: context.effort(self.detects, self.at_most),
            band: Band::math(precision),
        };
        let seed = context.seed;
        let view = |Polar(angle): &Polar| trial.view(context.core, *angle, seed.child(angle));
        let views = self.seen_from.iter().map(view).collect::<Result<Vec<_>, _>>()?;
        Ok(explained(&trial, finding(&trial, self.surface, &views), &views))
    }
}

fn finding(trial: &Trial, surface: SurfaceEntry, views: &[SmoothView]) -> Finding {
    let right = format!("{surface} does what it should in {} views", views.len());
    let complaint = views.iter().find_map(SmoothView::complaint);
    let resolution = format!(
        "would have caught a direction {} off, and an error of {} of what is reflected",
        degrees(trial.allowed.direction),
        percent(trial.allowed.formula)
    );
    let measures = views.iter().flat_map(SmoothView::measures).collect();
    Finding::of(right, resolution, measures)
        .complaining(complaint.map(|complaint| format!("{surface} {complaint}")))
}

/// With the mistakes that predict every sample of every view.
fn explained(trial: &Trial, finding: Finding, views: &[SmoothView]) -> Finding {
    if !finding.failed() {
        return finding;
    }
    let is_made = |(_, mistake): &&(&'static Cause, Mistake)| {
        let mistaken = |view: &SmoothView| trial.interface.mistaken(view.wo, *mistake);
        views.iter().any(|view| mistaken(view) != view.right)
            && views.iter().all(|view| view.is_predicted_by(mistaken(view)))
    };
    let made = MISTAKES.iter().filter(is_made).map(|(cause, _)| *cause);
    finding
        .because_each(made, &format!("predicts every sample of {} views", views.len()))
        .because_of(chance_clue(views).into_iter().chain(mark_clue(views)))
}

#[cfg(test)]
mod tests {
    use super::super::fake::Smooth;
    use super::*;
    use crate::cause::bsdf;
    use crate::checks::fake::Fake;
    use crate::checks::testing::{assert_passes, check_of, failure, judge};
    use crate::contract::{BsdfSample, Conventions, GlassFresnel, GlassRadiance};
    use crate::stats::Verdict;
    use glam::DVec3;

    const GLASS: &str = include_str!("../../../cases/bsdf/glass-follows-snell-and-fresnel.toml");
    const MIRROR: &str = include_str!("../../../cases/bsdf/mirror-reflects-its-reflectance.toml");

    fn found(case: &str, smooth: Smooth) -> Finding {
        // The probability of a reflection is not what takes time to judge here.
        let case = case.replace("5 %", "30 %");
        let mut core = Fake::default();
        core.info.conventions = smooth.conventions;
        core.sample = Box::new(move |material, wo, _, lobe| smooth.sample(material, wo, lobe));
        judge(&check_of::<ReflectsAndRefracts>(&case), &mut core)
    }

    fn spoilt(spoil: fn(&mut BsdfSample)) -> Finding {
        found(GLASS, Smooth { spoil, ..Smooth::default() })
    }

    #[test]
    fn right_ones_pass_by_every_convention() {
        assert_passes(&found(MIRROR, Smooth::default()));
        for glass_radiance in [GlassRadiance::Scaled, GlassRadiance::Unscaled] {
            let forms = [GlassFresnel::Exact, GlassFresnel::Schlick, GlassFresnel::SchlickOutside];
            for glass_fresnel in forms {
                let conventions =
                    Conventions { glass_radiance, glass_fresnel, ..Conventions::default() };
                assert_passes(&found(GLASS, Smooth { conventions, ..Smooth::default() }));
            }
        }
    }

    #[test]
    fn a_chance_that_is_stated_wrongly_is_seen() {
        let halved = Smooth { spoil: |sample| sample.pdf = 0.5, ..Smooth::default() };
        assert!(failure(&found(MIRROR, halved)).contains("100 % of samples are reflected"));
    }

    #[test]
    fn every_mistake_fails_under_its_own_name() {
        for (cause, mistake) in MISTAKES {
            let is_named = |case, glass_radiance| {
                let conventions = Conventions { glass_radiance, ..Conventions::default() };
                let smooth = Smooth { mistake: Some(*mistake), conventions, ..Smooth::default() };
                let finding = found(case, smooth);
                let clue = finding.clues.first().map(|clue| clue.cause.as_str());
                finding.verdict == Verdict::Fail && clue == Some(cause.name)
            };
            let named = is_named(GLASS, GlassRadiance::Scaled)
                || is_named(GLASS, GlassRadiance::Unscaled)
                || is_named(MIRROR, GlassRadiance::Scaled);
            assert!(named, "{}", cause.name);
        }
    }

    #[test]
    fn chances_that_are_not_stated_are_seen() {
        let finding = spoilt(|sample| sample.pdf = 1.0);
        assert_eq!(
            failure(&finding).split(": ").nth(1),
            Some("pdf says that light is refracted with probability 1, of 0 left")
        );
        assert_eq!(finding.clues[0].cause, bsdf::DELTA_PROBABILITY_IS_ONE.name);
        failure(&spoilt(|sample| sample.pdf *= 0.99));
    }

    #[test]
    fn samples_that_are_not_marked_or_slightly_off_are_seen() {
        let unmarked = spoilt(|sample| sample.is_delta = 0);
        assert!(failure(&unmarked).contains("not marked as delta"));
        assert_eq!(unmarked.clues[0].cause, bsdf::MIRROR_NOT_DELTA.name);
        assert!(failure(&spoilt(|sample| sample.is_valid = 0)).contains("samples fail"));
        let bent = spoilt(|sample| sample.wi = (sample.wi + 1e-6 * DVec3::X).normalize());
        assert!(failure(&bent).contains("off its direction") && bent.clues.is_empty());
        let brighter = spoilt(|sample| sample.f[1] *= 1.001);
        assert!(failure(&brighter).contains("off by 0.1 %"), "{}", brighter.statement);
    }
}
