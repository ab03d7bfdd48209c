//! Samples of the numbers at the ends of their range: 0, just above it, the middle, just below 1.
//!
//! A random number of exactly 0 comes once in four thousand million, which is once a picture. A
//! sample of density 0 divides by it; a direction on the horizon is neither above nor below.

use super::distribution::Drawn;
use crate::cause::sampling;
use crate::checks::phrase::some_are;
use crate::checks::{Finding, Measure};
use crate::contract::CoreError;
use crate::stats::{Compared, Verdict, judge_exact};
use glam::{DVec2, DVec3};

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

/// Two numbers for the direction, one for the lobe.
pub(crate) type Extreme = (DVec2, f64);

fn all_numbers() -> impl Iterator<Item = Extreme> {
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

/// Where samples belong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Range {
    /// Above the horizon.
    Hemisphere,
    /// Anywhere.
    Sphere,
}

/// What came of all sets of extreme numbers.
pub(crate) struct Extremes {
    name: String,
    measures: Vec<Measure>,
    complaints: Vec<String>,
    /// Samples that are wrong, and how many of them have a number at an end of its range.
    wrong: usize,
    asked: usize,
}

impl Extremes {
    /// Asks for the sample of each set of numbers, and for its density as evaluated.
    ///
    /// # Errors
    /// Those of `ask`, but for broken contracts, which are findings.
    pub(crate) fn of(
        name: String,
        range: Range,
        allowed: f64,
        ask: &mut dyn FnMut(Extreme) -> Result<(Drawn, f64), CoreError>,
    ) -> Result<Self, CoreError> {
        let mut answers = Vec::new();
        for numbers in all_numbers() {
            let answer = match ask(numbers) {
                Ok((drawn, pdf)) => Answer::Sample(drawn, pdf),
                Err(CoreError::BrokeContract(breach)) => Answer::Broken(breach.to_string()),
                Err(other) => return Err(other),
            };
            answers.push((numbers, answer));
        }
        Ok(Self::from_answers(name, range, &answers, allowed))
    }

    fn from_answers(
        name: String,
        range: Range,
        answers: &[(Extreme, Answer)],
        allowed: f64,
    ) -> Self {
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
                let is_below = |direction: &DVec3| range == Range::Hemisphere && direction.z < 0.0;
                let below = drawn.direction.filter(is_below)?;
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
        let what = "density of a sample against its evaluation";
        judged.measures.push(Measure::worst(what, &report).of_row(&judged.name));
        if report.disagree > 0 {
            let some = some_are(report.disagree, report.compared, "densities");
            judged.complaints.push(format!("{some} not what is evaluated"));
        }
        judged
    }

    /// Counts what is wrong in one way, and tells the first.
    fn count(
        &mut self,
        answers: &[(Extreme, Answer)],
        what: &str,
        wrong: &dyn Fn(&Answer) -> Option<String>,
    ) {
        let found: Vec<_> = answers
            .iter()
            .filter_map(|(numbers, answer)| Some((*numbers, wrong(answer)?)))
            .collect();
        let of_all = format!("{what}, of {}", answers.len());
        self.measures.push(Measure::none(of_all, found.len()).of_row(&self.name));
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

/// All of them together.
pub(crate) fn finding(extremes: &[Extremes]) -> Finding {
    let measures = extremes.iter().flat_map(|one| one.measures.clone()).collect();
    let wrong = extremes.iter().filter(|one| !one.complaints.is_empty());
    let asked: usize = extremes.iter().map(|one| one.asked).sum();
    let right = format!("{asked} sets of numbers from 0 to nearly 1 give samples and densities");
    let finding = Finding::of(right, "would have caught one wrong sample", measures)
        .complaining(wrong.map(|one| format!("{}: {}", one.name, one.complaints.join("; "))));
    let wrong: usize = extremes.iter().map(|one| one.wrong).sum();
    match finding.verdict {
        Verdict::Fail if 0 < wrong && wrong < asked => {
            let evidence =
                format!("{wrong} of {asked} sets of extreme numbers give no proper sample");
            finding.because(&sampling::ENDS_OF_RANGE, evidence)
        }
        _ => finding,
    }
}
