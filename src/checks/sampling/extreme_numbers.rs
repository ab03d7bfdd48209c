//! Samples of the numbers at the ends of their range: 0, just above it, the middle, just below 1.
//!
//! A random number of exactly 0 comes once in four thousand million, which is once a picture. A
//! sample of density 0 divides by it; a direction on the horizon is neither above nor below.

use super::distribution::{Distribution, DistributionEntry, Drawn};
use crate::cause::sampling;
use crate::checks::phrase::{some_are, worst_measure};
use crate::checks::{Check, CheckError, Context, Finding, Measure};
use crate::contract::{Capabilities, CoreError, Randomness};
use crate::stats::{Compared, Tolerance, Verdict, judge_exact};
use glam::DVec2;
use serde::Deserialize;

/// The ends of both precisions: 2⁻⁵³ and 2⁻²⁴, and the smallest number there is.
const NUMBERS: [f64; 7] = [
    0.0,
    f64::from_bits(1),
    f64::EPSILON / 2.0,
    0.5 * f32::EPSILON as f64,
    0.5,
    1.0 - 0.5 * f32::EPSILON as f64,
    1.0 - f64::EPSILON / 2.0,
];

/// Every pair of extreme numbers gives a direction above the horizon, with its density.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct ExtremeNumbers {
    distribution: DistributionEntry,
}

impl Check for ExtremeNumbers {
    const NAME: &'static str = "extreme-numbers";
    const SUMMARY: &'static str = "samples of random numbers that are 0, or nearly 1";

    fn needs(&self) -> Capabilities {
        self.distribution.needs() | Capabilities::CALLERS_RANDOMNESS
    }

    fn validate(&self) -> Result<(), String> {
        self.distribution.validate()
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let mut judged = Vec::new();
        for distribution in self.distribution.distributions() {
            judged.push(Judged::of(context, &distribution)?);
        }
        Ok(finding(&judged))
    }
}

/// Two numbers for the direction, one for the lobe.
type Numbers = (DVec2, f64);

fn all_numbers() -> impl Iterator<Item = Numbers> {
    let pairs = NUMBERS.into_iter().flat_map(|x| NUMBERS.map(|y| DVec2::new(x, y)));
    pairs.flat_map(|point| NUMBERS.map(|lobe| (point, lobe)))
}

/// What came of one set of numbers.
enum Answer {
    /// What was drawn, and its density as evaluated.
    Sample(Drawn, f64),
    /// No answer of the contract's form.
    Broken(String),
}

/// What came of one distribution.
struct Judged {
    name: String,
    measures: Vec<Measure>,
    complaints: Vec<String>,
    /// Samples that are wrong, and how many of them have a number at an end of its range.
    wrong: usize,
    asked: usize,
}

impl Judged {
    fn of(context: &mut Context<'_>, distribution: &Distribution) -> Result<Self, CheckError> {
        let mut answers = Vec::new();
        for numbers in all_numbers() {
            answers.push((numbers, answer(context, distribution, numbers)?));
        }
        let allowed = Tolerance::SAME_VALUE.of(context.info.precision);
        Ok(Self::from_answers(distribution.name(), &answers, allowed))
    }

    fn from_answers(name: String, answers: &[(Numbers, Answer)], allowed: f64) -> Self {
        let mut judged = Self {
            name,
            measures: Vec::new(),
            complaints: Vec::new(),
            wrong: 0,
            asked: answers.len(),
        };
        judged.count(answers, "samples that break the contract", &|answer| match answer {
            Answer::Broken(complaint) => Some(complaint.clone()),
            Answer::Sample(..) => None,
        });
        judged.count(answers, "samples of density 0", &|answer| match answer {
            Answer::Sample(drawn, _) if drawn.direction.is_some() && drawn.pdf == 0.0 => {
                Some("the density of the sample is 0".to_owned())
            }
            _ => None,
        });
        judged.count(answers, "samples below the horizon", &|answer| match answer {
            Answer::Sample(drawn, _) => {
                let below = drawn.direction.filter(|direction| direction.z < 0.0)?;
                Some(format!("the direction is {below}, below the horizon"))
            }
            Answer::Broken(_) => None,
        });
        let report = judge_exact(answers.iter().filter_map(|(_, answer)| match answer {
            Answer::Sample(drawn, pdf) if drawn.direction.is_some() => {
                Some(Compared::relative(drawn.pdf, *pdf, allowed))
            }
            _ => None,
        }));
        let name = format!("{}: density of a sample against its evaluation", judged.name);
        judged.measures.push(worst_measure(name, &report));
        if report.disagree > 0 {
            let some = some_are(report.disagree, report.compared, "densities");
            judged.complaints.push(format!("{some} not what is evaluated"));
        }
        judged
    }

    /// Counts what is wrong in one way, and tells the first.
    fn count(
        &mut self,
        answers: &[(Numbers, Answer)],
        what: &str,
        wrong: &dyn Fn(&Answer) -> Option<String>,
    ) {
        let found: Vec<_> = answers
            .iter()
            .filter_map(|(numbers, answer)| Some((*numbers, wrong(answer)?)))
            .collect();
        let name = format!("{}: {what}, of {}", self.name, answers.len());
        self.measures.push(Measure::exact(name, found.len() as f64, 0.0, 0.0));
        self.wrong += found.len();
        if let Some(((point, lobe), complaint)) = found.first() {
            let [x, y, lobe] = [point.x, point.y, *lobe].map(word);
            self.complaints.push(format!("of the numbers {x}, {y} and {lobe}: {complaint}"));
        }
    }
}

/// An extreme number as people write it.
fn word(number: f64) -> String {
    let words = ["0", "5e-324", "2⁻⁵³", "2⁻²⁴", "1/2", "1 − 2⁻²⁴", "1 − 2⁻⁵³"];
    let place = NUMBERS.iter().position(|known| *known == number);
    place.map_or_else(|| number.to_string(), |place| words[place].to_owned())
}

fn answer(
    context: &mut Context<'_>,
    distribution: &Distribution,
    (point, lobe): Numbers,
) -> Result<Answer, CheckError> {
    let random = Randomness { points: &[point], lobes: &[lobe], seed: 0 };
    let asked = distribution.sample(context.core, random).and_then(|drawn| {
        let mut pdf = [0.0];
        if let Some(direction) = drawn[0].direction {
            distribution.pdf(context.core, &[direction], &mut pdf)?;
        }
        Ok(Answer::Sample(drawn[0], pdf[0]))
    });
    match asked {
        Err(CoreError::BrokeContract(complaint)) => Ok(Answer::Broken(complaint)),
        other => other.map_err(CheckError::from),
    }
}

fn finding(judged: &[Judged]) -> Finding {
    let measures: Vec<_> = judged.iter().flat_map(|judged| judged.measures.clone()).collect();
    let complaints: Vec<_> = judged
        .iter()
        .filter(|judged| !judged.complaints.is_empty())
        .map(|judged| format!("{}: {}", judged.name, judged.complaints.join("; ")))
        .collect();
    let asked: usize = judged.iter().map(|judged| judged.asked).sum();
    let statement = match complaints.is_empty() {
        true => format!("{asked} sets of numbers from 0 to nearly 1 give samples and densities"),
        false => complaints.join("; "),
    };
    let finding = Finding::of(statement, "would have caught one wrong sample", measures);
    let wrong: usize = judged.iter().map(|judged| judged.wrong).sum();
    match finding.verdict {
        Verdict::Fail if 0 < wrong && wrong < asked => {
            let evidence =
                format!("{wrong} of {asked} sets of extreme numbers give no proper sample");
            finding.because(&sampling::ENDS_OF_RANGE, evidence)
        }
        _ => finding,
    }
}

#[cfg(test)]
mod tests {
    use super::super::fake::{FakeSampler, cosine, cosine_density, uniform, uniform_density};
    use super::*;
    use crate::checks::testing::{assert_passes, check_of, failure, judge};
    use crate::math::sphere::at_height;
    use glam::DVec3;
    use std::f64::consts::TAU;

    fn found(map: fn(DVec2) -> Option<DVec3>, density: fn(DVec3) -> f64) -> Finding {
        let check: ExtremeNumbers =
            check_of("[expect]\ndistribution = { sampler = \"cosine-hemisphere\" }");
        judge(&check, &mut FakeSampler { map, density })
    }

    #[test]
    fn maps_of_one_minus_u_pass() {
        assert_passes(&found(cosine, cosine_density));
        assert_passes(&found(uniform, uniform_density));
    }

    #[test]
    fn a_map_of_u_itself_ends_on_the_horizon_with_density_0() {
        let finding = found(|p| Some(at_height(p.x.sqrt(), TAU * p.y)), cosine_density);
        let statement = failure(&finding);
        assert!(statement.contains("of the numbers 0, 0 and 0: the density of the sample is 0"));
        assert_eq!(finding.clues[0].cause, "ends-of-range-forgotten");
    }

    #[test]
    fn nan_at_an_end_is_told_with_its_numbers() {
        let finding =
            found(|p| Some(at_height((1.0 - p.x).sqrt() + 0.0 / p.x, TAU * p.y)), cosine_density);
        let statement = failure(&finding);
        assert!(statement.contains("of the numbers 0, 0 and 0: sample 0 of 1: "), "{statement}");
    }

    #[test]
    fn a_density_that_is_not_evaluated_is_no_matter_of_extremes() {
        let finding = found(|p| cosine(p).map(|d| -d), |d| d.z.abs());
        failure(&finding);
        assert!(finding.clues.is_empty());
    }
}
