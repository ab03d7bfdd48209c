//! What a core made of a stream, and the mistakes that would have made the same of it.

use super::known_stream::{Answer, KnownStream, MISTAKES};
use super::rule::WRONG_RULES;
use crate::cause::{Cause, adaptive};
use crate::checks::Measure;
use crate::checks::phrase::figure;
use crate::contract::AdaptiveMean;

/// A stream, and what the core made of it.
pub(super) type Answered<'a> = (&'a KnownStream, AdaptiveMean);

pub(super) fn measures((stream, answer): &Answered<'_>, tolerance: f64) -> [Measure; 2] {
    let (_, mean) = stream.prefix(answer.used);
    let (used, right) = (f64::from(answer.used), f64::from(stream.stops_at));
    [
        Measure::exact("samples used", used, right, 0.0),
        Measure::exact("mean of the samples used", answer.mean, mean, tolerance * mean.abs()),
    ]
    .map(|measure| measure.of_row(&stream.name))
}

/// The mistakes that predict the answers for every stream, and what speaks for them.
pub(super) fn explanations(
    answered: &[Answered<'_>],
    tolerance: f64,
) -> (Vec<&'static Cause>, String) {
    let predicts = |answers: &dyn Fn(&KnownStream) -> Answer| {
        answered.iter().all(|(stream, answer)| {
            let (used, mean) = answers(stream);
            answer.used == used && (answer.mean - mean).abs() <= tolerance * mean.abs()
        })
    };
    let in_rule = WRONG_RULES.iter().filter(|(_, rule)| predicts(&|stream| stream.by(*rule)));
    let elsewhere = MISTAKES.iter().filter(|(_, answers)| predicts(answers));
    let causes: Vec<_> =
        in_rule.map(|(cause, _)| *cause).chain(elsewhere.map(|(cause, _)| *cause)).collect();
    if causes.is_empty() && equal_samples_alone_are_late(answered, tolerance) {
        let evidence = "every stream stops where it should but those of equal samples";
        return (vec![&adaptive::VARIANCE_BELOW_ZERO], evidence.to_owned());
    }
    (causes, format!("predicts where {} streams stop, and their means", answered.len()))
}

/// Equal samples take more batches than one, and all else is right. How many depends on every rounding.
fn equal_samples_alone_are_late(answered: &[Answered<'_>], tolerance: f64) -> bool {
    answered.iter().filter(|answered| complaint(answered, tolerance).is_some()).all(
        |(stream, answer)| {
            stream.repeats.iter().all(|value| *value == stream.repeats[0])
                && answer.used > stream.stops_at
                && answer.used.is_multiple_of(stream.batch)
        },
    )
}

/// What is wrong with one stream.
pub(super) fn complaint((stream, answer): &Answered<'_>, tolerance: f64) -> Option<String> {
    let (used, mean) = stream.prefix(answer.used);
    let right = stream.stops_at;
    if used != right {
        return Some(format!("{} stops at {used} instead of {right}", stream.name));
    }
    let is_right = (answer.mean - mean).abs() <= tolerance * mean.abs();
    (!is_right).then(|| {
        format!(
            "{}: the mean is {} of that of the {used} samples used",
            stream.name,
            figure(answer.mean / mean)
        )
    })
}
