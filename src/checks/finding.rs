//! What a check has to say: a verdict, a sentence, and the numbers behind it.

use super::few::Few;
use super::series::Series;
use crate::cause::Cause;
use crate::image::{CHANNELS, Channel};
use crate::stats::{Doubt, ExactReport, Hypothesis, Report, Verdict};
use crate::text::number::percent;
use serde::{Deserialize, Serialize};
use std::fmt::Display;

/// The result of one check on one core.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Finding {
    /// The worst verdict of the measures.
    pub verdict: Verdict,
    /// One sentence in plain words, with the size of what was found.
    pub statement: String,
    /// The numbers, one a row of the case, channel or stage.
    pub measures: Vec<Measure>,
    /// The smallest error this trial would have caught, in words. Empty only where nothing was measured.
    pub resolution: String,
    /// Mistakes that the check recognised, the likeliest first; empty where it passes, or knows none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub clues: Vec<Clue>,
    /// The mistake that was seen and put right, and that did not explain what is wrong: a direction that is not unit, and
    /// points elsewhere.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) not_enough: Option<String>,
    /// What gives every wrong answer of a function: `f is 2 cos θo times what it should be`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) laws: Vec<String>,
    /// What plots show of it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) series: Vec<Series>,
}

/// A mistake that would have given just these answers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Clue {
    /// Its name in the glossary of [`crate::cause`].
    pub cause: String,
    /// What speaks for it, with numbers: `predicts all 159 rays`.
    pub evidence: String,
    /// Whether it is there whatever else is: it explains what the others do not.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub beside: bool,
    /// The interval of what is the same wherever the mistake shows: a factor, an exponent, pixels; none where it has
    /// no size.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub size: Option<[f64; 2]>,
}

/// One number that was measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Measure {
    /// Of which row of the case, scene, build or distribution; empty where there is one only.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub row: String,
    /// Which number of the row; empty where a row has one only.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub quantity: String,
    /// Of which channel; none for what has no colour.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub channel: Option<Channel>,
    /// Unit of the numbers; empty for a ratio or a count.
    pub unit: String,
    /// What the core gave.
    #[serde(with = "number")]
    pub measured: f64,
    /// What it should be.
    #[serde(with = "number")]
    pub expected: f64,
    /// How far from `expected` is still right, in the same unit, without noise.
    #[serde(with = "number")]
    pub allowed: f64,
    /// 99.9 % interval of what was measured; none for deterministic measures.
    #[serde(with = "number::interval")]
    pub interval: Option<[f64; 2]>,
    /// The smallest relative error that would have been caught.
    pub resolution: Option<f64>,
    /// The verdict on this number alone.
    pub verdict: Verdict,
    /// Why it cannot be decided, where it is not that more samples are needed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub doubt: Option<Doubt>,
    /// The probability that chance alone brings as large a difference, tolerance not counted; none where that is not
    /// known, or chance has no part in it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) p_value: Option<f64>,
    /// What the ledger enters for it; none where chance has no part in it, or where another measure
    /// stands for the same test.
    #[serde(rename = "leaf", default, skip_serializing_if = "Option::is_none")]
    pub hypothesis: Option<Hypothesis>,
}

/// The unit of numbers whose noise is one of them.
pub(crate) const STANDARD_ERRORS: &str = "standard errors";
/// Of such numbers, half of a 99.9 % interval.
const OF_ONE: f64 = 3.29;
/// With a larger error than this an integral is not known.
const KNOWN: f64 = 0.1;
/// Below this share of what it should be a number is next to nothing, and its size says no more than 0 does. A number of
/// samples that divides once too often leaves more: no case takes more than 4096 of a light.
const VANISHING: f64 = 1.0 / 5000.0;
/// Of many answers to one question, the one that is told.
const WORST: &str = ", worst of ";

impl Measure {
    /// Half of the 99.9 % interval of what was measured; none for deterministic measures.
    pub(crate) fn noise(&self) -> Option<f64> {
        let of_one = (self.unit == STANDARD_ERRORS).then_some(OF_ONE);
        self.interval.map(|[low, high]| 0.5 * (high - low)).or(of_one)
    }

    /// A deterministic measure: passes if it is within `allowed` of `expected`; NaN fails.
    pub(crate) fn exact(
        quantity: impl Display,
        measured: f64,
        expected: f64,
        allowed: f64,
    ) -> Self {
        let passes = (measured - expected).abs() <= allowed;
        Self {
            row: String::new(),
            quantity: quantity.to_string(),
            channel: None,
            unit: String::new(),
            measured,
            expected,
            allowed,
            interval: None,
            resolution: (expected != 0.0).then(|| allowed / expected.abs()),
            verdict: Verdict::pass_if(passes),
            doubt: None,
            p_value: None,
            hypothesis: None,
        }
    }

    /// An integral of which 1 is the whole, by a quadrature with this bound on its error: allowed too, but what is hardly
    /// known is not judged.
    pub(crate) fn by_quadrature(
        quantity: impl Display,
        [found, error]: [f64; 2],
        expected: f64,
        allowed: f64,
    ) -> Self {
        let measure = Self::exact(quantity, found, expected, allowed + error);
        match error <= KNOWN || measure.failed() {
            true => measure,
            false => Self { verdict: Verdict::Inconclusive, doubt: Some(Doubt::Spiked), ..measure },
        }
    }

    /// A count of what there must not be.
    pub(crate) fn none(quantity: impl Display, found: usize) -> Self {
        Self::exact(quantity, found as f64, 0.0, 0.0)
    }

    /// A measure without noise that only has to stay below a limit. NaN fails.
    pub(crate) fn at_most(quantity: impl Display, measured: f64, limit: f64) -> Self {
        Self {
            verdict: Verdict::pass_if(measured <= limit),
            resolution: None,
            ..Self::exact(format!("{quantity} (at most)"), measured, limit, 0.0)
        }
    }

    /// What a test says of the number it judged.
    pub(crate) fn of(quantity: impl Display, report: &impl Report) -> Self {
        let judgement = report.judgement();
        Self {
            interval: judgement.interval,
            resolution: judgement.smallest_detectable_error,
            verdict: judgement.verdict,
            doubt: judgement.doubt,
            p_value: judgement.p_value.filter(|p| p.is_finite()),
            hypothesis: judgement.hypothesis,
            ..Self::exact(quantity, judgement.measured, judgement.expected, judgement.allowed)
        }
    }

    /// The same of each channel of a colour.
    pub(crate) fn of_channels(quantity: &str, reports: &[impl Report]) -> Vec<Self> {
        let pairs = reports.iter().zip(CHANNELS);
        pairs.map(|(report, channel)| Self::of(quantity, report).of_channel(channel)).collect()
    }

    /// The worst element of a comparison. Of many, it says which it was, counted from 1.
    pub(crate) fn worst(quantity: impl Display, report: &ExactReport) -> Self {
        match (report.compared, report.worst) {
            (all @ 2.., Some(worst)) => {
                Self::of(format!("{quantity}{WORST}{all} (number {})", worst.index + 1), report)
            }
            _ => Self::of(quantity, report),
        }
    }

    /// What was asked, whichever answer to it was the worst.
    pub(crate) fn question(&self) -> (&str, &str, Option<Channel>) {
        let quantity = self.quantity.split(WORST).next().unwrap_or_default();
        (&self.row, quantity, self.channel)
    }

    pub(crate) fn of_row(self, row: impl Display) -> Self {
        Self { row: row.to_string(), ..self }
    }

    pub(crate) fn of_channel(self, channel: Channel) -> Self {
        Self { channel: Some(channel), ..self }
    }

    pub(crate) fn not_graded(self) -> Self {
        Self { verdict: Verdict::Pass, ..self }
    }

    /// What was measured, as people read it: `bounce 2, red`, `point 1: mean of 1/pdf`.
    pub fn name(&self) -> String {
        let parts = [&self.row, &self.quantity].map(String::as_str);
        let name = parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(": ");
        match self.channel {
            Some(channel) => format!("{name}, {channel}"),
            None => name,
        }
    }

    /// Whether what was measured lies within each other's intervals, or `slack` beyond them; of numbers without one the
    /// numbers themselves. NaN meets NaN alone.
    pub(crate) fn meets(&self, other: &Self, slack: f64) -> bool {
        if self.measured.is_nan() || other.measured.is_nan() {
            return self.measured.is_nan() && other.measured.is_nan();
        }
        let ends = |measure: &Self| measure.interval.unwrap_or([measure.measured; 2]);
        let ([a, b], [c, d]) = (ends(self), ends(other));
        a <= d + slack && c <= b + slack
    }

    pub(crate) fn failed(&self) -> bool {
        self.verdict == Verdict::Fail
    }

    /// Wrong, and NaN or next to nothing of what it should be: many mistakes have that in common.
    pub(crate) fn is_degenerate(&self) -> bool {
        let is_vanishing = self.measured.abs() <= VANISHING * self.expected.abs();
        self.failed() && (is_vanishing || self.measured == 0.0 || self.measured.is_nan())
    }

    /// Whether it is an answer that is yes or no, such as whether a ray hits.
    pub(crate) fn is_yes_or_no(&self) -> bool {
        let is_flag = |number: f64| number == 0.0 || number == 1.0;
        self.allowed == 0.0 && is_flag(self.expected) && is_flag(self.measured)
    }

    /// Why this could not be decided, where that is known.
    fn why_open(&self) -> Option<String> {
        let noise =
            |r| format!("too noisy to be judged: an error below {} goes unseen", percent(r));
        let dark = || "only 0 was measured, which proves nothing".to_owned();
        let is_dark = self.measured == 0.0 && self.expected == 0.0;
        let why = self.doubt.map(|doubt| doubt.to_string());
        let why = why.or_else(|| self.resolution.map(noise)).or_else(|| is_dark.then(dark));
        Some(format!("{}: {}", self.name(), why?))
    }

    pub(crate) fn in_unit(self, unit: &str) -> Self {
        Self { unit: unit.to_owned(), ..self }
    }
}

impl Finding {
    /// A finding of some measures: its verdict is the worst of theirs; none at all is inconclusive.
    pub(crate) fn of(
        statement: impl Into<String>,
        resolution: impl Into<String>,
        measures: Vec<Measure>,
    ) -> Self {
        let verdict = Verdict::worst_of(measures.iter().map(|measure| measure.verdict));
        Self {
            verdict,
            statement: statement.into(),
            measures,
            resolution: resolution.into(),
            clues: Vec::new(),
            not_enough: None,
            laws: Vec::new(),
            series: Vec::new(),
        }
        .doubting()
    }

    /// A finding of some measures that would have caught what the weakest of them resolves:
    /// `would have caught an error of 0.42 %`. It says nothing where none has a resolution.
    pub(crate) fn measured(
        statement: impl Into<String>,
        measures: impl IntoIterator<Item = Measure>,
    ) -> Self {
        let measures: Vec<_> = measures.into_iter().collect();
        let weakest = measures.iter().filter_map(|measure| measure.resolution).reduce(f64::max);
        let caught = |r| format!("would have caught an error of {}", percent(r));
        Self::of(statement, weakest.map_or_else(String::new, caught), measures)
    }

    /// The same, which says of what the error would have been: ` of a pdf, root mean square`.
    pub(crate) fn in_terms(mut self, of: &str) -> Self {
        self.resolution += of;
        self
    }

    /// The same, which would have caught this where no measure has a resolution.
    pub(crate) fn or_else_caught(mut self, caught: impl Into<String>) -> Self {
        if self.resolution.is_empty() {
            self.resolution = caught.into();
        }
        self
    }

    /// The same with what plots show of it.
    pub(crate) fn showing(mut self, series: impl IntoIterator<Item = Series>) -> Self {
        self.series.extend(series);
        self
    }

    /// Says what cannot be decided, and why, unless something has failed.
    fn doubting(self) -> Self {
        let is_open = |measure: &&Measure| measure.verdict == Verdict::Inconclusive;
        let open = self.measures.iter().filter(|_| self.verdict == Verdict::Inconclusive);
        let first = open.filter(is_open).filter_map(Measure::why_open).take(1).collect::<Vec<_>>();
        self.complaining(first)
    }

    /// The same with what is wrong for a statement, if anything is.
    pub(crate) fn complaining(mut self, complaints: impl IntoIterator<Item = String>) -> Self {
        let complaints: Vec<_> = complaints.into_iter().collect();
        if !complaints.is_empty() {
            self.statement = complaints.join("; ");
        }
        self
    }

    /// The same with the laws of what is wrong, if it is: a law that several rows share is told once.
    pub(crate) fn by_law(mut self, laws: impl IntoIterator<Item = String>) -> Self {
        let before = self.laws.len();
        self = self.knowing_laws(laws);
        for law in &self.laws[before..] {
            self.statement += &format!("; {law}");
        }
        self
    }

    /// The same where the statement tells them already.
    pub(crate) fn knowing_laws(mut self, laws: impl IntoIterator<Item = String>) -> Self {
        for law in laws.into_iter().filter(|_| self.verdict == Verdict::Fail) {
            if !self.laws.contains(&law) {
                self.laws.push(law);
            }
        }
        self
    }

    /// A failure with nothing to measure: the core's answer itself is wrong.
    pub(crate) fn failure(statement: impl Into<String>) -> Self {
        Self { verdict: Verdict::Fail, ..Self::of(statement, "", Vec::new()) }
    }

    /// Adds a mistake that would have given just these answers, less likely than those added before.
    pub(crate) fn because(self, cause: &Cause, evidence: impl Into<String>) -> Self {
        self.because_in_size(cause, evidence, None)
    }

    /// The same of a mistake that has a size.
    pub(crate) fn because_in_size(
        mut self,
        cause: &Cause,
        evidence: impl Into<String>,
        size: Option<[f64; 2]>,
    ) -> Self {
        let (cause, evidence) = (cause.name.to_owned(), evidence.into());
        self.clues.push(Clue { cause, evidence, beside: false, size });
        self
    }

    /// Adds mistakes that are all there, each beside whatever else is told.
    pub(crate) fn because_all<'a>(
        mut self,
        causes: impl IntoIterator<Item = &'a Cause>,
        evidence: &str,
    ) -> Self {
        let clues = causes.into_iter().map(|cause| Clue {
            cause: cause.name.to_owned(),
            evidence: evidence.to_owned(),
            beside: true,
            size: None,
        });
        self.clues.extend(clues);
        self
    }

    /// Adds mistakes with what speaks for each of them, the likeliest first.
    pub(crate) fn because_of<'a, Evidence: Into<String>>(
        self,
        causes: impl IntoIterator<Item = (&'a Cause, Evidence)>,
    ) -> Self {
        causes.into_iter().fold(self, |finding, (cause, evidence)| finding.because(cause, evidence))
    }

    /// Adds mistakes that all would have given just these answers, and that nothing here tells apart.
    pub(crate) fn because_each<'a>(
        self,
        causes: impl IntoIterator<Item = &'a Cause>,
        evidence: &str,
    ) -> Self {
        self.because_of(causes.into_iter().map(|cause| (cause, evidence)))
    }

    /// Adds the few mistakes that explain these answers.
    pub(crate) fn because_few(self, few: Few<&Cause>, evidence: &str) -> Self {
        match few {
            Few::OneOf(causes) => self.because_each(causes, evidence),
            Few::Both(causes) => self.because_all(causes, evidence),
        }
    }

    pub(crate) fn failed(&self) -> bool {
        self.verdict == Verdict::Fail
    }

    /// The tests that could have failed by chance.
    pub(crate) fn hypotheses(&self) -> impl Iterator<Item = Hypothesis> {
        self.measures.iter().filter_map(|measure| measure.hypothesis)
    }

    /// The probability that a correct core fails it, at most.
    pub(crate) fn false_alarm(&self) -> f64 {
        self.hypotheses().map(|hypothesis| hypothesis.false_alarm).sum()
    }

    /// Whether no light is expected and none is there: a core that finds nothing gives as much. Differences of light that is
    /// there are not exactly 0.
    pub(crate) fn is_of_darkness(&self) -> bool {
        let is_dark = |measure: &Measure| {
            measure.channel.is_some() && measure.expected == 0.0 && measure.measured == 0.0
        };
        !self.measures.is_empty() && self.measures.iter().all(is_dark)
    }

    pub(crate) fn failed_measures(&self) -> impl Iterator<Item = &Measure> {
        self.measures.iter().filter(|measure| measure.failed())
    }
}

/// Numbers in JSON, where NaN and the infinities have no literal: they are written as words.
pub(crate) mod number {
    use serde::{Deserialize, Deserializer, Serializer, de::Error};

    #[derive(Deserialize)]
    #[serde(untagged)]
    enum Written {
        Number(f64),
        Word(String),
    }

    /// Writes a number, or the word for one that JSON cannot write.
    pub(crate) fn serialize<S: Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
        if value.is_finite() {
            serializer.serialize_f64(*value)
        } else {
            serializer.serialize_str(&value.to_string())
        }
    }

    /// Reads what [`serialize`] has written.
    ///
    /// # Errors
    /// If it is neither a number nor `NaN`, `inf` or `-inf`.
    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
        match Written::deserialize(deserializer)? {
            Written::Number(value) => Ok(value),
            Written::Word(word) if ["NaN", "inf", "-inf"].contains(&word.as_str()) => {
                word.parse().map_err(D::Error::custom)
            }
            Written::Word(word) => {
                Err(D::Error::custom(format!("`{word}` is not a number, NaN, inf or -inf")))
            }
        }
    }

    /// The same for both ends of an interval, where there is one.
    pub(crate) mod interval {
        use serde::{Deserialize, Deserializer, Serialize, Serializer};

        #[derive(Serialize, Deserialize)]
        struct End(#[serde(with = "super")] f64);

        /// Writes an interval.
        pub(crate) fn serialize<S: Serializer>(
            value: &Option<[f64; 2]>,
            serializer: S,
        ) -> Result<S::Ok, S::Error> {
            value.map(|ends| ends.map(End)).serialize(serializer)
        }

        /// Reads what [`serialize`] has written.
        pub(crate) fn deserialize<'de, D: Deserializer<'de>>(
            deserializer: D,
        ) -> Result<Option<[f64; 2]>, D::Error> {
            let ends = Option::<[End; 2]>::deserialize(deserializer)?;
            Ok(ends.map(|ends| ends.map(|End(value)| value)))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::{Compared, judge_exact};

    #[test]
    fn nan_fails_and_nothing_is_no_pass() {
        assert_eq!(Measure::exact("t", f64::NAN, 1.0, 1e9).verdict, Verdict::Fail);
        assert_eq!(Finding::of("", "", Vec::new()).verdict, Verdict::Inconclusive);
    }

    #[test]
    fn next_to_nothing_has_no_size_and_a_sample_count_too_many_has() {
        let is_degenerate = |measured| Measure::exact("t", measured, 3.0, 1e-9).is_degenerate();
        assert!([0.0, 2e-5, -2e-5, f64::NAN].into_iter().all(is_degenerate));
        assert!(![3.0 / 4096.0, 3.0].into_iter().any(is_degenerate));
    }

    #[test]
    fn an_integral_that_is_not_known_proves_nothing() {
        let of = |found, error| Measure::by_quadrature("pdf", [found, error], 1.0, 1e-3);
        assert_eq!(of(1.0, 1e-3).verdict, Verdict::Pass);
        assert_eq!(
            (of(3.8e8, 1e9).verdict, of(3.8e8, 1e9).doubt.is_some()),
            (Verdict::Inconclusive, true)
        );
        assert_eq!(of(f64::NAN, f64::NAN).verdict, Verdict::Fail);
        assert_eq!(of(2.0, 0.2).verdict, Verdict::Fail);
    }

    #[test]
    fn a_doubt_is_told_in_place_of_what_is_right() {
        let (verdict, doubt) = (Verdict::Inconclusive, Some(Doubt::HeavyTail));
        let doubtful = Measure { verdict, doubt, ..Measure::none("radiance", 0) };
        let finding = Finding::of("all is right", "", vec![doubtful]);
        assert_eq!(finding.statement, format!("radiance: {}", Doubt::HeavyTail));
        let noisy = Measure { verdict, resolution: Some(0.3), ..Measure::none("radiance", 0) };
        let statement = Finding::of("all is right", "", vec![noisy]).statement;
        assert_eq!(statement, "radiance: too noisy to be judged: an error below 30 % goes unseen");
        let dark = Measure { verdict, ..Measure::none("radiance", 0) };
        let statement = Finding::of("all is right", "", vec![dark]).statement;
        assert_eq!(statement, "radiance: only 0 was measured, which proves nothing");
    }

    #[test]
    fn the_worst_element_is_shown_with_the_verdict_on_all() {
        let of = |all: &[f64]| {
            let compared = all.iter().map(|found| Compared::within(*found, 1.0, 0.1));
            Measure::worst("t", &judge_exact(compared)).of_row("ray 1")
        };
        assert_eq!(of(&[1.0, 3.0]).question(), of(&[2.0, 1.0, 1.0]).question());
        let report = judge_exact([1.0, 3.0].map(|found| Compared::within(found, 1.0, 0.1)));
        let measure = Measure::worst("t", &report).of_row("ray 1").of_channel(Channel::Red);
        assert_eq!(measure.name(), "ray 1: t, worst of 2 (number 2), red");
        assert_eq!((measure.measured, measure.verdict), (3.0, Verdict::Fail));
        assert_eq!(Measure::worst("t", &judge_exact([])).verdict, Verdict::Inconclusive);
    }

    #[test]
    fn complaints_take_the_place_of_a_statement_that_all_is_right() {
        let finding = || Finding::measured("right", [Measure::exact("t", 1.0, 1.0, 0.01)]);
        assert_eq!(finding().resolution, "would have caught an error of 1 %");
        assert_eq!(finding().complaining([]).statement, "right");
        let complaints = ["one".to_owned(), "two".to_owned()];
        assert_eq!(finding().complaining(complaints).statement, "one; two");
    }

    #[test]
    fn an_interval_survives_json_even_without_end() {
        let exact = Measure::exact("t", 1.0, 1.0, 0.5);
        let measure = Measure { interval: Some([f64::NEG_INFINITY, f64::NAN]), ..exact };
        let text = serde_json::to_string(&measure).unwrap();
        let read = serde_json::from_str::<Measure>(&text).unwrap().interval.unwrap();
        assert!(read[0] == f64::NEG_INFINITY && read[1].is_nan(), "{text}");
    }

    #[test]
    fn a_finding_survives_json_even_with_nan() {
        let finding = Finding::of("s", "r", vec![Measure::exact("t", f64::INFINITY, 1.0, 0.5)]);
        let text = serde_json::to_string(&finding).unwrap();
        assert_eq!(serde_json::from_str::<Finding>(&text).unwrap(), finding);
    }
}
