//! The stopping rule on streams whose count is known, without any picture.

use super::answered_stream::{Answered, complaint, explanations, measures};
use super::known_stream::KnownStream;
use crate::checks::few::Few;
use crate::checks::{Check, Context, Finding, Result, check};
use crate::contract::{AdaptiveMean, AdaptiveSettings};
use crate::stats::Tolerance;
use crate::text::Several;

check! {
    pub(crate) struct StopsWhereItShould {
        stream: Several<KnownStream>,
    }
    name: "stops-where-it-should",
    summary: "the adaptive stopping rule on streams whose count is known",
    needs: ADAPTIVE_MEAN,
}

impl Check for StopsWhereItShould {
    fn validate(&self) -> Result<(), String> {
        self.stream.iter().try_for_each(KnownStream::validate)
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding> {
        let tolerance = Tolerance::SAME_VALUE.of(context.info.precision);
        let asked: Result<Vec<_>, _> =
            self.stream.iter().map(|stream| ask(context, stream)).collect();
        Ok(judge(&asked?, tolerance))
    }
}

fn judge(answered: &[Answered<'_>], tolerance: f64) -> Finding {
    let measures = answered.iter().flat_map(|answered| measures(answered, tolerance)).collect();
    let complaints: Vec<_> = answered.iter().filter_map(|a| complaint(a, tolerance)).collect();
    let few = match complaints.is_empty() {
        true => Few::OneOf(Vec::new()),
        false => explanations(answered, tolerance),
    };
    let statement = match (complaints.is_empty(), few.is_empty()) {
        (true, _) => format!("{} streams stop where they should", answered.len()),
        (false, true) => complaints.join("; "),
        (false, false) => format!("{}: {}", complaints.join("; "), few.words()),
    };
    let evidence = format!("predicts where {} streams stop, and their means", answered.len());
    Finding::of(statement, "would have caught a count that is off by one batch", measures)
        .because_few(few, &evidence)
}

fn ask<'a>(context: &mut Context<'_>, stream: &'a KnownStream) -> Result<Answered<'a>> {
    let settings =
        AdaptiveSettings { samples_per_batch: stream.batch, max_tolerance: stream.tolerance.0 };
    let mut means = [AdaptiveMean { mean: 0.0, used: 0, reserved: 0 }];
    context.core.adaptive_mean(settings, &[&stream.samples()], &mut means)?;
    Ok((stream, means[0]))
}

#[cfg(test)]
mod tests {
    use super::super::known_stream::{Answer, Mistake, Procedure, mistakes};
    use super::super::rule::Rule;
    use super::*;
    use crate::cause::{Cause, adaptive};
    use crate::checks::fake::Fake;
    use crate::checks::testing::{assert_passes, causes, check_of, failure, judge};
    use crate::text::Percent;

    fn found(answers: impl Fn(&KnownStream) -> Answer + Send + 'static) -> Finding {
        let case =
            include_str!("../../../cases/adaptive/known-streams-stop-where-the-rule-says.toml");
        let mean = move |settings: AdaptiveSettings, stream: &[f64]| {
            let mut entry = KnownStream {
                name: String::new(),
                repeats: stream.to_vec().try_into().unwrap(),
                batch: settings.samples_per_batch,
                tolerance: Percent(settings.max_tolerance),
                cap: u32::try_from(stream.len()).unwrap(),
                stops_at: 0,
            };
            entry.stops_at = entry.count(Rule::RIGHT, entry.batch);
            let (used, mean) = answers(&entry);
            AdaptiveMean { mean, used, reserved: 0 }
        };
        let mut core = Fake { mean: Box::new(mean), ..Fake::default() };
        judge(&check_of::<StopsWhereItShould>(case), &mut core)
    }

    fn by(procedure: Procedure, stream: &KnownStream) -> Answer {
        procedure.answer(stream, procedure.count(stream))
    }

    #[test]
    fn the_rule_itself_passes() {
        assert_passes(&found(|stream| by(Procedure::RIGHT, stream)));
    }

    #[test]
    fn every_mistake_fails_and_is_told_from_the_others() {
        // What rounding does is no formula.
        for mistake in mistakes().iter().filter(|m| m.cause != &adaptive::VARIANCE_BELOW_ZERO) {
            let wrong = mistake.made_in(Procedure::RIGHT);
            let finding = found(move |stream| by(wrong, stream));
            let headline = mistake.cause.headline;
            assert!(failure(&finding).contains(headline), "{}", finding.statement);
            assert_eq!(causes(&finding), [mistake.cause.name]);
        }
    }

    #[test]
    fn two_mistakes_of_different_steps_are_told_together() {
        let known = mistakes();
        let of = |cause: &Cause| known.iter().find(|mistake| mistake.cause == cause).unwrap();
        let both = |a: &Mistake, b: &Mistake| b.made_in(a.made_in(Procedure::RIGHT));
        let told = |one: &Cause, other: &Cause| {
            let wrong = both(of(one), of(other));
            causes(&found(move |stream| by(wrong, stream)))
                .iter()
                .map(ToString::to_string)
                .collect::<Vec<_>>()
        };
        let [absolute, over_n] = [&adaptive::TOLERANCE_ABSOLUTE, &adaptive::SIGMA_OVER_N];
        assert_eq!(told(absolute, over_n), [over_n.name, absolute.name]);
        let cap = &adaptive::DIVIDED_BY_CAP;
        assert_eq!(told(cap, absolute), [absolute.name, cap.name]);
    }

    #[test]
    fn equal_samples_that_stop_late_have_a_variance_below_zero() {
        let told = |late: u32| {
            let finding =
                found(move |stream| match stream.repeats[..32].iter().all(|x| *x == 0.7) {
                    true => stream.prefix(late),
                    false => by(Procedure::RIGHT, stream),
                });
            causes(&finding).first().map(ToString::to_string)
        };
        assert_eq!(told(128).as_deref(), Some("variance-below-zero"));
        assert_eq!(told(33), None);
    }

    #[test]
    fn a_mean_of_something_else_is_seen() {
        let finding = found(|stream| (stream.stops_at, 0.99 * stream.prefix(stream.stops_at).1));
        assert!(failure(&finding).contains("the mean is 0.99 of that"), "{}", finding.statement);
        assert!(finding.clues.is_empty());
    }

    #[test]
    fn a_case_with_a_wrong_count_is_refused() {
        let wrong = "stream = [{ name = \"five values\", repeats = [1, 3, 0.5, 1, 1], batch = 2, \
                     tolerance = \"50 %\", cap = 64, stops-at = 8 }]";
        let check: StopsWhereItShould = crate::text::read_toml(wrong).unwrap();
        assert!(check.validate().unwrap_err().contains("stops at 10"));
    }
}
