//! What a core made of a stream, and the mistakes that would have made the same of it.

use super::known_stream::{KnownStream, Mistake, Procedure, mistakes};
use crate::cause::Cause;
use crate::checks::Measure;
use crate::checks::few::{Few, few_that_fit};
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

/// The mistakes that predict the answers for every stream.
pub(super) fn explanations(answered: &[Answered<'_>], tolerance: f64) -> Few<&'static Cause> {
    let known = mistakes();
    let predict = |made: &[&Mistake]| {
        let procedure = made.iter().fold(Procedure::RIGHT, |right, made| made.made_in(right));
        answered.iter().all(|answered| predicts(&procedure, answered, tolerance))
    };
    few_that_fit(&known, predict).map(|mistake| mistake.cause)
}

/// How late equal samples stop whose variance is negative depends on every rounding.
fn predicts(procedure: &Procedure, (stream, answer): &Answered<'_>, tolerance: f64) -> bool {
    let is_answer = |used: u32| {
        let (reported, mean) = procedure.answer(stream, used);
        answer.used == reported && (answer.mean - mean).abs() <= tolerance * mean.abs()
    };
    let count = procedure.count(stream);
    let is_late = procedure.is_late_on_equal_samples
        && stream.is_of_equal_samples()
        && answer.used > count
        && answer.used.is_multiple_of(stream.batch);
    is_answer(count) || is_late && is_answer(answer.used)
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
