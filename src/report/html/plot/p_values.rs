//! The p-values of the cases of a run against the uniform law that they have of a right core: a histogram a core.

use super::chart::{Axis, Chart};
use super::figure::{Figure, Mark, Shape};
use super::scale::Scale;
use crate::report::tree::RunTree;
use crate::run::TrialRecord;
use crate::stats::binomial_at_least;
use crate::text::number::figure;
use maud::{Markup, html};

/// Bars of the histogram.
const BARS: usize = 10;
/// Of fewer p-values no histogram can be read.
const FEWEST: usize = 20;
/// The probability that any bar of a right core is outside the band.
const OUTSIDE: f64 = 1e-3;

const SHOULD: &str = "Of a right core every bar is about as high as the line: inside the band in 999 of 1000 runs. Cases that fail stand \
    at 0. A leaning towards 0 without failures is bias within tolerance. A heap at 1 is too little noise: answers that were looked up, \
    or samples of one case that are used in another.";

/// What the cases of one core say.
struct PValues {
    core: String,
    /// One a case, of the first number that chance has a part in, so that they are independent; whether the case fails.
    all: Vec<(f64, bool)>,
    /// Cases whose first such number is NaN or infinite.
    not_finite: usize,
}

impl PValues {
    fn of(tree: &RunTree, core: &str) -> Self {
        let trials: Vec<_> = tree.trials_of(core).collect();
        let all = trials
            .iter()
            .filter_map(|trial| Some((first(trial)?, trial.outcome.status().is_failure())));
        let not_finite = trials.iter().filter(|trial| is_not_finite(trial)).count();
        Self { core: core.to_owned(), all: all.collect(), not_finite }
    }

    /// How many stand in a bar, and how many of those fail.
    fn bar(&self, number: usize) -> [usize; 2] {
        let is_in = |p: f64| ((p * BARS as f64) as usize).min(BARS - 1) == number;
        let here = || self.all.iter().filter(|(p, _)| is_in(*p));
        [here().count(), here().filter(|(_, fails)| *fails).count()]
    }

    /// The fewest and the most that a bar of a right core has.
    fn band(&self) -> [usize; 2] {
        let (all, share) = (self.all.len() as u64, 1.0 / BARS as f64);
        let level = OUTSIDE / (2 * BARS) as f64;
        let at_least = |count: usize| binomial_at_least(count as u64, all, share);
        let low = (0..=self.all.len()).find(|count| 1.0 - at_least(count + 1) > level);
        let high = (0..=self.all.len()).find(|count| at_least(count + 1) <= level);
        [low.unwrap_or(0), high.unwrap_or(self.all.len())]
    }

    fn title(&self) -> String {
        format!("p-values of {} cases of {}", self.all.len(), self.core)
    }

    fn words(&self) -> String {
        let [low, high] = self.band();
        let bars: Vec<_> = (0..BARS).map(|number| self.bar(number)[0]).collect();
        let outside: Vec<_> =
            bars.iter().enumerate().filter(|(_, n)| **n < low || **n > high).collect();
        let counted = format!(
            "{}: {} cases, {} a bar expected, {low} to {high} within the band",
            self.core,
            self.all.len(),
            figure(self.all.len() as f64 / BARS as f64)
        );
        let failing = self.all.iter().filter(|(_, fails)| *fails).count();
        let failing = if failing > 0 { format!("; {failing} of them fail") } else { String::new() };
        let told: Vec<_> = outside
            .iter()
            .map(|(bar, count)| {
                format!(
                    "{count} from {} to {}",
                    figure(*bar as f64 / BARS as f64),
                    figure((bar + 1) as f64 / BARS as f64)
                )
            })
            .collect();
        match told.is_empty() {
            true => format!("{counted}{failing}; every bar is within it."),
            false => format!("{counted}{failing}; outside are {}.", told.join(", ")),
        }
    }

    fn chart(&self) -> Option<Markup> {
        let [low, high] = self.band();
        let highest = (0..BARS).map(|number| self.bar(number)[0]).max().unwrap_or(0).max(high);
        let y = Scale::linear([0.0, 1.05 * highest as f64])?;
        let mut chart =
            Chart::new(Axis::new("p-value", Scale::linear([0.0, 1.0])?), Axis::new("cases", y));
        chart.bar("band", [0.0, 1.0], [low as f64, high as f64], "");
        for number in 0..BARS {
            let [all, failing] = self.bar(number).map(|count| count as f64);
            let ends = [number, number + 1].map(|edge| edge as f64 / BARS as f64);
            let bar = [ends[0] + 0.008, ends[1] - 0.008];
            let title =
                format!("{} to {}: {all} cases, {failing} fail", figure(ends[0]), figure(ends[1]));
            if failing > 0.0 {
                chart.bar("wrong", bar, [0.0, failing], &title);
            }
            chart.bar("data", bar, [failing, all], &title);
        }
        let mean = self.all.len() as f64 / BARS as f64;
        chart.line("guide", [[0.0, mean], [1.0, mean]]);
        Some(chart.svg(&self.title(), &self.words()))
    }
}

/// The p-value of the first number of a trial that has one.
fn first(trial: &TrialRecord) -> Option<f64> {
    trial.outcome.finding()?.measures.iter().find_map(|measure| measure.p_value)
}

fn is_not_finite(trial: &TrialRecord) -> bool {
    let measures = trial.outcome.finding().map(|finding| &finding.measures);
    let judged = measures.into_iter().flatten().find(|measure| measure.hypothesis.is_some());
    first(trial).is_none() && judged.is_some_and(|measure| !measure.measured.is_finite())
}

/// One histogram a core; in words, where a core has too few.
pub(in crate::report::html) fn plot(tree: &RunTree) -> Option<Markup> {
    let all: Vec<_> = tree.run.cores.iter().map(|core| PValues::of(tree, &core.spec)).collect();
    let (shown, few): (Vec<_>, Vec<_>) = all.into_iter().partition(|one| one.all.len() >= FEWEST);
    let few: Vec<_> = few.iter().map(|one| format!("{} ({})", one.core, one.all.len())).collect();
    let few = (!few.is_empty())
        .then(|| format!("Too few p-values to draw, below {FEWEST}: {}.", few.join(", ")));
    if shown.is_empty() {
        return few.map(|words| html! { p.faint { (words) } });
    }
    let drawing = html! {
        div.panels {
            @for one in &shown {
                div {
                    @if shown.len() > 1 { p.map-name { (one.core) } }
                    @if let Some(chart) = one.chart() { (chart) }
                }
            }
        }
    };
    let words = shown.iter().map(PValues::words).chain(few);
    let figure = Figure {
        title: "p-values of the cases against the uniform law".to_owned(),
        drawing,
        legend: vec![
            (Mark::new("data", Shape::Area), "cases that do not fail".to_owned()),
            (Mark::new("wrong", Shape::Area), "cases that fail".to_owned()),
            (Mark::new("band", Shape::Area), "band of 99.9 %".to_owned()),
            (Mark::new("guide", Shape::Line), "uniform".to_owned()),
        ],
        found: words.collect::<Vec<_>>().join(" "),
        should: SHOULD,
        left_out: shown.iter().map(|one| one.not_finite).sum(),
    };
    Some(figure.markup())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::{Finding, Measure};
    use crate::report::example::Example;
    use crate::run::Outcome;

    /// 24 p-values on `builtin`, as they come; what has none is NaN.
    fn tree(p_value: impl Fn(usize) -> Option<f64>) -> RunTree {
        let mut example = Example::of_default_size();
        example.trials.retain(|trial| trial.core == "builtin");
        example.trials.truncate(24);
        for (number, trial) in example.trials.iter_mut().enumerate() {
            let p_value = p_value(number);
            let measure = Measure {
                p_value,
                ..Measure::exact("t", 1.0, 1.0, f64::from(p_value > Some(0.001)))
            };
            trial.outcome = Outcome::Judged { finding: Finding::of("", "", vec![measure]) };
        }
        example.tree()
    }

    #[test]
    fn uniform_p_values_are_within_the_band_and_a_heap_is_not() {
        let page = plot(&tree(|number| Some((number as f64 + 0.5) / 24.0))).unwrap().into_string();
        assert!(
            page.contains("24 cases, 2.4 a bar expected, 0 to 10 within the band; every bar"),
            "{page}"
        );
        assert!(page.contains("Too few p-values to draw, below 20: textbook (0)."));
        let heap = plot(&tree(|number| Some(if number < 16 { 0.999 } else { 0.5 })))
            .unwrap()
            .into_string();
        assert!(heap.contains("outside are 16 from 0.9 to 1."), "{heap}");
        assert!(heap.contains("<title>0.9 to 1: 16 cases, 0 fail</title>"));
    }

    #[test]
    fn too_few_are_said_and_no_frame_is_drawn() {
        let page = plot(&tree(|number| (number < 7).then_some(0.5))).unwrap().into_string();
        assert!(
            page.contains("below 20: builtin (7), textbook (0).") && !page.contains("<svg"),
            "{page}"
        );
    }
}
