//! Direct light in two scenes where nothing is special: every common mistake predicts another pair of ratios.
//!
//! One scene alone confuses a forgotten cosine with a forgotten cosine at the light (1.111 and 1.115); the other
//! tells them apart (1.795 and 1.922). The predictions are integrals over the light, checked by this file's test.

use super::readings::{Reading, channels};
use super::{Degree, Evidence, RuledOut, Suspicion};
use crate::case::Role;
use crate::cause::{Cause, bsdf, light, sampling};
use crate::text::number::figure;
use std::f64::consts::{FRAC_1_PI, PI, TAU};

/// The two scenes, by light sampling with 7 and 5 samples.
const BY_LIGHTS: [Role; 2] = [Role::TiltedLight, Role::SlantedLight];
/// The same by hemisphere sampling.
const BY_HEMISPHERE: [Role; 2] = [Role::TiltedLightByHemisphere, Role::SlantedLightByHemisphere];
const ROW: &str = "bounce 1";
/// How much less a mistake weighs if it is not the only one that fits.
const SHARED: f64 = 0.6;

/// A mistake and what it makes of the two scenes, measured over expected.
struct Signature {
    cause: &'static Cause,
    ratios: [f64; 2],
}

const fn signature(cause: &'static Cause, first: f64, second: f64) -> Signature {
    Signature { cause, ratios: [first, second] }
}

static OF_BOTH: &[Signature] = &[
    signature(&bsdf::WITHOUT_PI, PI, PI),
    signature(&light::EMISSION_OVER_PI, FRAC_1_PI, FRAC_1_PI),
    signature(&light::COSINE_TWICE, 0.90211, 0.56201),
    signature(&light::COSINE_FORGOTTEN, 1.11073, 1.79493),
    signature(&light::TWICE_AS_BRIGHT, 2.0, 2.0),
    signature(&light::HALF_AS_BRIGHT, 0.5, 0.5),
    signature(&light::DIVIDED_TWICE_BY_SAMPLES, 1.0 / 7.0, 1.0 / 5.0),
    signature(&light::NOT_DIVIDED_BY_SAMPLES, 7.0, 5.0),
];

static OF_LIGHTS: &[Signature] = &[
    signature(&light::EMITTER_SHADOWS_ITSELF, 0.0, 0.0),
    signature(&light::WORLD_COSINE, 0.87589, 0.83780),
    signature(&light::LIGHT_COSINE_FORGOTTEN, 1.11544, 1.92193),
    signature(&light::LIGHT_DISTANCE_NOT_SQUARED, 1.65690, 1.54050),
    signature(&light::LIGHT_DISTANCE_FORGOTTEN, 2.75220, 2.38790),
    signature(&light::LIGHT_PDF_PER_AREA, 3.08548, 4.64660),
    signature(&light::LIGHT_AREA_FORGOTTEN, 3.17460, 4.0),
    signature(&light::TIMES_PDF, 98.1978, 365.0396),
    signature(&light::PDF_FORGOTTEN, 9.79518, 18.5864),
];

static OF_HEMISPHERE: &[Signature] = &[
    // Local directions taken for world ones have their cosine with +z, and the light in view.
    signature(&light::HEMISPHERE_IN_WORLD, 0.87589, 0.83780),
    signature(&sampling::COSINE_PDF_FOR_UNIFORM, 0.55537, 0.89747),
    signature(&sampling::UNIFORM_PDF_FOR_COSINE, 1.80423, 1.12401),
    signature(&light::PDF_FORGOTTEN, 1.0 / TAU, 1.0 / TAU),
    signature(&light::TIMES_PDF, 1.0 / (TAU * TAU), 1.0 / (TAU * TAU)),
];

/// Mistakes whose predictions lie inside every interval of both scenes.
pub(crate) fn suspect(evidence: &Evidence<'_>) -> Vec<Suspicion> {
    let mut suspicions = explain(evidence, &BY_LIGHTS, OF_LIGHTS);
    suspicions.extend(explain(evidence, &BY_HEMISPHERE, OF_HEMISPHERE));
    suspicions
}

fn explain(
    evidence: &Evidence<'_>,
    roles: &[Role; 2],
    special: &'static [Signature],
) -> Vec<Suspicion> {
    let failed: Vec<_> = roles
        .iter()
        .filter(|role| evidence.failed_finding(**role).is_some())
        .map(|role| evidence.case(*role).to_owned())
        .collect();
    let Some(readings) = read(evidence, roles).filter(|_| !failed.is_empty()) else {
        return Vec::new();
    };
    let (fitting, others): (Vec<_>, Vec<_>) =
        OF_BOTH.iter().chain(special).partition(|signature| fits(signature, &readings));
    let ruled_out = nearest_misses(&others, &readings);
    let weight = if fitting.len() == 1 { 1.0 } else { SHARED };
    let suspicion = |signature: &&Signature| Suspicion {
        cause: signature.cause,
        cases: failed.clone(),
        evidence: vec![sentence(signature, &readings)],
        ruled_out: ruled_out.clone(),
        weight,
        degree: Degree::of_one_among(fitting.len()),
        beside: false,
    };
    fitting.iter().map(suspicion).collect()
}

/// The lit channels of both scenes; none if one of them was not tried.
fn read(evidence: &Evidence<'_>, roles: &[Role; 2]) -> Option<[Vec<Reading>; 2]> {
    let of = |role: Role| {
        let readings: Vec<_> =
            channels(evidence.finding(role)?, ROW).into_iter().flatten().collect();
        (!readings.is_empty()).then_some(readings)
    };
    Some([of(roles[0])?, of(roles[1])?])
}

fn fits(signature: &Signature, readings: &[Vec<Reading>; 2]) -> bool {
    let admitted = |(readings, ratio): (&Vec<Reading>, f64)| {
        readings.iter().all(|reading| reading.admits(ratio))
    };
    readings.iter().zip(signature.ratios).all(admitted)
}

fn best(readings: &[Reading]) -> Reading {
    let narrower = |a: &Reading, b: &Reading| a.half_width() <= b.half_width();
    readings[1..].iter().fold(readings[0], |best, r| if narrower(&best, r) { best } else { *r })
}

fn sentence(signature: &Signature, readings: &[Vec<Reading>; 2]) -> String {
    let one = |number: usize| best(&readings[number]).beside(signature.ratios[number]);
    format!(
        "direct light over what it should be in two scenes in general position: {} and {}",
        one(0),
        one(1)
    )
}

/// The mistakes that come nearest and still are outside an interval.
fn nearest_misses(others: &[&Signature], readings: &[Vec<Reading>; 2]) -> Vec<RuledOut> {
    let measured = [best(&readings[0]).ratio, best(&readings[1]).ratio];
    let distance = |signature: &Signature| -> f64 {
        let apart = |number: usize| signature.ratios[number] - measured[number];
        apart(0).abs().max(apart(1).abs())
    };
    let mut sorted = others.to_vec();
    sorted.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
    let words = |signature: &&Signature| {
        let [first, second] = signature.ratios.map(figure);
        RuledOut::new(signature.cause.headline, format!("would give {first} and {second}"))
    };
    sorted.iter().take(2).map(words).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::diagnose;
    use crate::diagnosis::testing::{Made, mean, means};
    use crate::image::CHANNELS;
    use glam::DVec3;

    fn pair(roles: &[Role; 2], ratios: [f64; 2]) -> Made {
        let finding =
            |ratio| means(CHANNELS.map(|channel| mean(ROW, channel, 0.05, ratio, 0.004)).into());
        Made::new().with(roles[0], finding(ratios[0])).with(roles[1], finding(ratios[1]))
    }

    #[test]
    fn every_signature_is_told_by_its_own_ratios() {
        for (roles, special) in [(&BY_LIGHTS, OF_LIGHTS), (&BY_HEMISPHERE, OF_HEMISPHERE)] {
            for signature in OF_BOTH.iter().chain(special) {
                let made = pair(roles, signature.ratios.map(|ratio| 1.001 * ratio));
                assert_eq!(made.first(), Some(signature.cause.name));
                let diagnosis = diagnose(&made.evidence());
                assert_eq!(diagnosis.headlines[0].explains.len(), 2);
            }
        }
    }

    #[test]
    fn one_scene_that_does_not_fit_rules_a_mistake_out() {
        let made = pair(&BY_LIGHTS, [1.11073, 1.66]);
        let diagnosis = diagnose(&made.evidence());
        assert_eq!(diagnosis.first(), None, "{diagnosis:?}");
        assert_eq!(diagnosis.unexplained.len(), 2);
    }

    #[test]
    fn what_came_near_is_said_to_be_ruled_out() {
        let diagnosis = diagnose(&pair(&BY_LIGHTS, [1.11073, 1.79493]).evidence());
        let ruled_out = diagnosis.headlines[0].ruled_out.join("; ");
        assert!(ruled_out.contains("the cosine at the light"), "{ruled_out}");
        assert!(ruled_out.contains("1.12 and 1.92"), "{ruled_out}");
    }

    #[test]
    fn what_both_ways_of_sampling_rule_out_is_said_once() {
        // Both pairs are half as bright: what comes near is, among others, the same mistake with other numbers.
        let finding =
            |ratio| means(CHANNELS.map(|channel| mean(ROW, channel, 0.05, ratio, 0.004)).into());
        let all = BY_LIGHTS.into_iter().chain(BY_HEMISPHERE);
        let made = all.fold(Made::new(), |made, role| made.with(role, finding(0.5)));
        let diagnosis = diagnose(&made.evidence());
        let told = diagnosis.headlines[0].ruled_out.iter();
        let told: Vec<_> = told.map(|one| one.split(" (").next().unwrap()).collect();
        let once: std::collections::BTreeSet<_> = told.iter().collect();
        assert_eq!(once.len(), told.len(), "{told:?}");
        assert!(told.len() > 1);
    }

    /// Floor normal, light centre and edges of the two scenes.
    fn scene(number: usize) -> (DVec3, [DVec3; 3]) {
        let rows = [
            ([0.2, -0.1, 1.0], [0.9, -0.5, 1.3], [1.2, 0.1, -0.15], 0.7, [0.05, 1.0, 0.2], 0.45),
            ([0.1, 0.4, 1.0], [-1.1, 0.8, 0.75], [0.6, 0.9, 0.2], 0.5, [-0.5, 0.3, 1.0], 0.5),
        ];
        let (normal, centre, along, width, across, height) = rows[number];
        let edge = DVec3::from(along).normalize() * width;
        let light_normal = edge.cross(DVec3::from(across)).normalize();
        let other = light_normal.cross(edge).normalize() * height;
        (DVec3::from(normal).normalize(), [DVec3::from(centre), edge, other])
    }

    /// The mean over the light of `integrand(cosine, cosine at the light, distance², area, cosine with z)`.
    fn over_light(number: usize, integrand: impl Fn(f64, f64, f64, f64, f64) -> f64) -> f64 {
        let (normal, [centre, edge, other]) = scene(number);
        let light_normal = edge.cross(other);
        let area = light_normal.length();
        let light_normal = light_normal / area * -light_normal.dot(centre).signum();
        const CELLS: usize = 200;
        let at = |i: usize| (i as f64 + 0.5) / CELLS as f64 - 0.5;
        let points =
            (0..CELLS * CELLS).map(|i| centre + at(i / CELLS) * edge + at(i % CELLS) * other);
        let values = points.map(|point| {
            let (squared, wi) = (point.length_squared(), point.normalize());
            let (cosine, at_light) = (wi.dot(normal).max(0.0), (-wi).dot(light_normal).max(0.0));
            integrand(cosine, at_light, squared, area, wi.z.abs())
        });
        values.sum::<f64>() / (CELLS * CELLS) as f64
    }

    #[test]
    fn the_predictions_are_integrals_over_the_light() {
        type Integrand = fn(f64, f64, f64, f64, f64) -> f64;
        let wrong: [(&Cause, Integrand); 9] = [
            (&light::WORLD_COSINE, |_, l, d2, a, z| z * l * a / d2),
            (&light::COSINE_TWICE, |c, l, d2, a, _| c * c * l * a / d2),
            (&light::COSINE_FORGOTTEN, |_, l, d2, a, _| l * a / d2),
            (&light::LIGHT_COSINE_FORGOTTEN, |c, _, d2, a, _| c * a / d2),
            (&light::LIGHT_DISTANCE_NOT_SQUARED, |c, l, d2, a, _| c * l * a / d2.sqrt()),
            (&light::LIGHT_DISTANCE_FORGOTTEN, |c, l, _, a, _| c * l * a),
            (&light::LIGHT_PDF_PER_AREA, |c, _, _, a, _| c * a),
            (&light::LIGHT_AREA_FORGOTTEN, |c, l, d2, _, _| c * l / d2),
            (&light::TIMES_PDF, |c, l, d2, a, _| c * d2 / (l * a)),
        ];
        for (cause, integrand) in wrong {
            let mut signatures = OF_BOTH.iter().chain(OF_LIGHTS);
            let known = signatures.find(|s| s.cause.name == cause.name).unwrap();
            for number in 0..2 {
                let right = over_light(number, |c, l, d2, a, _| c * l * a / d2);
                let ratio = over_light(number, integrand) / right;
                let predicted = known.ratios[number];
                assert!((ratio / predicted - 1.0).abs() < 1e-4, "{}: {ratio}", cause.name);
            }
        }
    }
}
