//! Samples of the numbers at the ends of their range: 0, just above it, the middle, just below 1.
//!
//! A random number of exactly 0 comes once in four thousand million, which is once a picture. A sample of pdf 0
//! divides by it, unless it lies on the rim of the hemisphere: where the cosine is 0 the pdf may be, as of the
//! concentric map (Shirley and Chiu 1997), whose square has its edges there.

use super::distribution::Drawn;
use crate::cause::sampling;
use crate::checks::phrase::some_are;
use crate::checks::{Finding, Measure};
use crate::contract::{CoreError, Precision};
use crate::stats::{Compared, Tolerance, Verdict, judge_exact};
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

/// Numbers far from the ends, for the mistakes that have nothing to do with them: a grid of so many by so many.
const BETWEEN: usize = 6;

fn between() -> impl Iterator<Item = Extreme> {
    let number = |place: usize| (place as f64 + 0.5) / BETWEEN as f64;
    (0..BETWEEN * BETWEEN)
        .map(move |at| (DVec2::new(number(at % BETWEEN), number(at / BETWEEN)), 0.5))
}

/// What a core of this precision can be handed: numbers that are below 1 in it.
fn all_numbers(precision: Precision) -> impl Iterator<Item = Extreme> {
    let is_below_1 = |number: &f64| precision == Precision::Double || (*number as f32) < 1.0;
    let numbers: Vec<_> = NUMBERS.into_iter().filter(is_below_1).collect();
    let all = numbers.clone();
    let pairs = all.into_iter().flat_map({
        let numbers = numbers.clone();
        move |x| numbers.clone().into_iter().map(move |y| DVec2::new(x, y))
    });
    pairs.flat_map(move |point| numbers.clone().into_iter().map(move |lobe| (point, lobe)))
}

/// What was drawn by one set of numbers, and its pdf as evaluated; or how it breaks the contract.
type Answer = Result<(Drawn, f64), String>;

/// What is wrong with an answer in one way, if it is.
type Way = Box<dyn Fn(&Answer) -> Option<String>>;

/// The ways in which a sample is wrong whatever its pdf is.
fn ways(range: Range, precision: Precision) -> [(&'static str, Way); 3] {
    let of_pdf_0 = move |answer: &Answer| {
        let (drawn, _) = answer.as_ref().ok()?;
        let is_on_rim = |direction: DVec3| {
            range == Range::Hemisphere && direction.z.abs() <= Tolerance::DIRECTION.of(precision)
        };
        let is_wrong = drawn.direction.is_some_and(|direction| !is_on_rim(direction));
        (is_wrong && drawn.pdf == 0.0).then(|| "the pdf of the sample is 0".to_owned())
    };
    let below_horizon = move |answer: &Answer| {
        let is_below = |direction: &DVec3| range == Range::Hemisphere && direction.z < 0.0;
        let below = answer.as_ref().ok()?.0.direction.filter(is_below)?;
        Some(format!("the direction is {below}, below the horizon"))
    };
    [
        ("samples that break the contract", Box::new(|answer| answer.clone().err())),
        ("samples of pdf 0", Box::new(of_pdf_0)),
        ("samples below the horizon", Box::new(below_horizon)),
    ]
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
    /// The numbers of samples that are wrong.
    wrong: Vec<Extreme>,
    /// Whether some lie clearly below the horizon, which no rounding does.
    goes_below: bool,
    /// Sets of numbers that give a sample, whatever is wrong with it.
    drawn: usize,
    asked: usize,
    /// Whether samples of ordinary numbers are wrong, too.
    is_wrong_between: bool,
}

impl Extremes {
    /// Asks for the sample of each set of numbers, and for its pdf as evaluated.
    ///
    /// # Errors
    pub(crate) fn of(
        name: String,
        range: Range,
        precision: Precision,
        allowed: f64,
        ask: &mut dyn FnMut(Extreme) -> Result<(Drawn, f64), CoreError>,
    ) -> Result<Self, CoreError> {
        let mut answers_to = |numbers: &mut dyn Iterator<Item = Extreme>| {
            let answer = |numbers| match ask(numbers) {
                Err(CoreError::BrokeContract(breach)) => Ok((numbers, Err(breach.to_string()))),
                answer => answer.map(|answer| (numbers, Ok(answer))),
            };
            numbers.map(answer).collect::<Result<Vec<(Extreme, Answer)>, CoreError>>()
        };
        let answers = answers_to(&mut all_numbers(precision))?;
        let answers_between = answers_to(&mut between())?;
        let lies_below = |(_, answer): &(Extreme, Answer)| {
            let direction = answer.as_ref().ok().and_then(|(drawn, _)| drawn.direction);
            direction.is_some_and(|direction| direction.z < -Tolerance::DIRECTION.of(precision))
        };
        let ways = ways(range, precision);
        let is_wrong =
            |(_, answer): &(Extreme, Answer)| ways.iter().any(|(_, wrong)| wrong(answer).is_some());
        let mut judged = Self {
            name,
            measures: Vec::new(),
            complaints: Vec::new(),
            wrong: Vec::new(),
            goes_below: range == Range::Hemisphere && answers.iter().any(lies_below),
            drawn: 0,
            asked: answers.len(),
            is_wrong_between: answers_between.iter().any(is_wrong),
        };
        for (what, wrong) in ways {
            judged.count(&answers, what, &wrong);
        }
        let samples = answers.iter().filter_map(|(_, answer)| answer.as_ref().ok());
        let samples = samples.filter(|(drawn, _)| drawn.direction.is_some());
        judged.drawn = samples.clone().count();
        let compared = samples.map(|(drawn, pdf)| Compared::relative(drawn.pdf, *pdf, allowed));
        let report = judge_exact(compared);
        let what = "pdf of a sample against its evaluation";
        judged.measures.push(Measure::worst(what, &report).of_row(&judged.name));
        if report.disagree > 0 {
            let some = some_are(report.disagree, report.compared, "pdfs");
            judged.complaints.push(format!("{some} not what is evaluated"));
        }
        Ok(judged)
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
        self.wrong.extend(found.iter().map(|(numbers, _)| *numbers));
        if let Some(((point, lobe), complaint)) = found.first() {
            let [x, y, lobe] = [point.x, point.y, *lobe].map(word);
            self.complaints.push(format!("of the numbers {x}, {y} and {lobe}: {complaint}"));
        }
    }
}

/// Whether an end of a range makes most samples wrong, whatever the other numbers are. Where a few pairs of numbers alone do,
/// it is not the end.
fn is_of_an_end(wrong: &[Extreme]) -> bool {
    let others = NUMBERS.len() * NUMBERS.len();
    let coordinates: [fn(&Extreme) -> f64; 3] =
        [|(point, _)| point.x, |(point, _)| point.y, |(_, lobe)| *lobe];
    let ends = NUMBERS.into_iter().filter(|number| *number != 0.5);
    ends.flat_map(|end| coordinates.map(|coordinate| (end, coordinate))).any(|(end, coordinate)| {
        wrong.iter().filter(|numbers| coordinate(numbers) == end).count() >= others / 2
    })
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
    let right = format!("{asked} sets of numbers from 0 to nearly 1 give samples and pdfs");
    let finding = Finding::of(right, "would have caught one wrong sample", measures)
        .complaining(wrong.map(|one| format!("{}: {}", one.name, one.complaints.join("; "))));
    let of_an_end = extremes.iter().any(|one| is_of_an_end(&one.wrong));
    let wrong: usize = extremes.iter().map(|one| one.wrong.len()).sum();
    // The ends are forgotten where what lies between is not: a sampler that fails anyway says nothing of them. What goes
    // below the horizon, as half vectors near the rim reflect, has forgotten that.
    let drawn: usize = extremes.iter().map(|one| one.drawn).sum();
    let is_wrong_elsewhere = extremes.iter().any(|one| one.is_wrong_between || one.goes_below);
    match finding.verdict {
        Verdict::Fail if of_an_end && !is_wrong_elsewhere && wrong < drawn => {
            let evidence =
                format!("{wrong} of {asked} sets of extreme numbers give no proper sample");
            finding.because(&sampling::ENDS_OF_RANGE, evidence)
        }
        _ => finding,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_end_makes_most_samples_wrong_and_a_pair_of_numbers_few() {
        let wrong = |is_so: fn(&Extreme) -> bool| {
            is_of_an_end(&all_numbers(Precision::Double).filter(is_so).collect::<Vec<_>>())
        };
        assert!(wrong(|(point, _)| point.x == 0.0));
        assert!(wrong(|(_, lobe)| *lobe == 0.0));
        assert!(!wrong(|(point, _)| point.x == 0.5));
        assert!(!wrong(|(point, _)| point.x == 0.5 && point.y < 0.5));
    }

    #[test]
    fn an_end_is_forgotten_where_what_lies_between_is_right() {
        let told = |is_wrong: fn(&Extreme) -> bool| {
            let ask = &mut |numbers: Extreme| {
                let pdf = if is_wrong(&numbers) { 0.0 } else { 1.0 };
                Ok((Drawn { direction: Some(DVec3::Z), pdf }, pdf))
            };
            let range = Range::Hemisphere;
            let of = Extremes::of(String::new(), range, Precision::Double, 1e-6, ask).unwrap();
            let found = finding(&[of]);
            assert_eq!(found.verdict, Verdict::Fail);
            found.clues.len()
        };
        assert_eq!(told(|(point, _)| point.x < 1e-6), 1);
        assert_eq!(told(|(point, _)| point.x < 0.3), 0);
    }

    #[test]
    fn samples_that_go_below_the_horizon_have_forgotten_the_horizon() {
        let ask = &mut |(point, _): Extreme| {
            let z = if point.x > 0.99 { -0.5 } else { 0.5 };
            let direction = DVec3::new(0.75_f64.sqrt(), 0.0, z);
            Ok((Drawn { direction: Some(direction), pdf: 1.0 }, 1.0))
        };
        let precision = Precision::Double;
        let of = Extremes::of(String::new(), Range::Hemisphere, precision, 1e-6, ask).unwrap();
        let found = finding(&[of]);
        assert_eq!(found.verdict, Verdict::Fail);
        assert!(found.clues.is_empty(), "{found:?}");
    }

    #[test]
    fn single_precision_is_handed_what_is_below_1_in_it() {
        let largest = |precision| {
            let all = all_numbers(precision).flat_map(|(point, lobe)| [point.x, point.y, lobe]);
            all.fold(0.0, f64::max)
        };
        assert_eq!(largest(Precision::Single) as f32, 1.0 - 0.5 * f32::EPSILON);
        assert_eq!(largest(Precision::Double), 1.0 - f64::EPSILON / 2.0);
    }
}
