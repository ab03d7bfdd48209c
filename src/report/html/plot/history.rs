//! Score, time and numbers of a core over the runs that were asked the same.

use super::super::overview::date;
use super::chart::{Axis, Chart};
use super::figure::{Figure, Mark, Shape};
use super::scale::Scale;
use crate::report::history::{History, Past};
use crate::run::record::Number;
use crate::text::number::{duration, figure};
use maud::html;

/// How many numbers of cases are drawn: the first, in the order of parts.
const NUMBERS: usize = 4;
const POINT: Mark = Mark::new("line-a", Shape::Circle);

const SHOULD: &str = "Passes rise, and never fall without a reason; times stay level on one machine. Tests a ray and errors jump only where \
    the code has changed: they are measured with the same seeds.";

/// One number over the runs.
struct Line<'a> {
    title: &'a str,
    unit: &'a str,
    /// Which run, counted from 1, and its number; a run without one is a gap.
    points: Vec<[f64; 2]>,
    words: fn(f64) -> String,
}

/// None of a single run.
pub(in crate::report::html) fn plot(history: &History) -> Option<Figure> {
    let [first, .., last] = &history.runs[..] else { return None };
    let lines = lines(history, last);
    let charts: Vec<_> =
        lines.iter().filter_map(|line| Some((line, chart(history, line)?))).collect();
    let drawing = html! {
        div.panels {
            @for (line, chart) in &charts {
                div { p.map-name { (line.title) } (chart.svg(line.title, &line.described())) }
            }
        }
    };
    Some(Figure {
        title: format!("{} over {} runs", history.core, history.runs.len()),
        drawing,
        legend: Vec::new(),
        found: found(first, last),
        should: SHOULD,
        left_out: charts.iter().map(|(_, chart)| chart.left_out).sum(),
    })
}

/// Passes, time, and the numbers that the last run has.
fn lines<'a>(history: &'a History, last: &'a Past) -> Vec<Line<'a>> {
    let over = |of: &dyn Fn(&Past) -> Option<f64>| {
        let numbered = (1..).zip(&history.runs);
        numbered.filter_map(|(number, run)| Some([f64::from(number), of(run)?])).collect()
    };
    let passes = over(&|run| Some(run.score.passes as f64));
    let seconds = over(&|run| Some(run.score.seconds));
    let score =
        Line { title: "graded trials that pass", unit: "trials", points: passes, words: figure };
    let time = Line {
        title: "time of all trials, added up",
        unit: "seconds",
        points: seconds,
        words: duration,
    };
    let of_number = |number: &'a Number| Line {
        title: &number.case,
        unit: &number.what,
        points: over(&|run| value(run, number)),
        words: figure,
    };
    let numbers = last.score.numbers.iter().take(NUMBERS).map(of_number);
    [score, time].into_iter().chain(numbers).collect()
}

fn value(run: &Past, of: &Number) -> Option<f64> {
    let is_it = |number: &&Number| number.case == of.case && number.what == of.what;
    run.score.numbers.iter().find(is_it).map(|number| number.value)
}

fn chart(history: &History, line: &Line<'_>) -> Option<Chart> {
    let runs = history.runs.len();
    let x = Scale::linear([1.0, runs as f64])?.with_room(0.04);
    // A score has a top; the rest only a bottom.
    let top = history.runs.iter().map(|run| run.score.graded as f64).fold(0.0, f64::max);
    let top = (line.unit == "trials").then_some(top);
    let y = Scale::linear(line.points.iter().map(|[_, value]| *value).chain([0.0]).chain(top))?;
    let mut chart = Chart::new(
        Axis::of_whole("run", x, 1..=u32::try_from(runs).ok()?),
        Axis::new(line.unit, y),
    );
    if let Some(top) = top {
        chart.line("guide", [[1.0, top], [runs as f64, top]]);
    }
    chart.line(POINT.class, line.points.iter().copied());
    for [run, value] in &line.points {
        let past = &history.runs[*run as usize - 1];
        chart.point(
            POINT,
            [*run, *value],
            &format!("{}: {}", date(past.started), (line.words)(*value)),
        );
    }
    Some(chart)
}

impl Line<'_> {
    fn described(&self) -> String {
        let words: Vec<_> = self.points.iter().map(|[_, value]| (self.words)(*value)).collect();
        format!("{}, run by run: {}", self.unit, words.join(", "))
    }
}

fn found(first: &Past, last: &Past) -> String {
    let of = |past: &Past| {
        let score = &past.score;
        format!(
            "{}: {} of {} pass, {}",
            date(past.started),
            score.passes,
            score.graded,
            duration(score.seconds)
        )
    };
    format!("{}. {}.", of(first), of(last))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::history::histories;
    use crate::report::history::tests::runs;

    #[test]
    fn score_time_and_numbers_are_drawn_over_the_runs() {
        let (_folder, tree) = runs(&[7, 9, 12]);
        let page = plot(&histories(&tree)[0]).unwrap().markup().into_string();
        assert_eq!(page.matches("<svg role=\"img\"").count(), 3);
        assert_eq!(page.matches("<title>2026-").count(), 9);
        assert!(
            page.contains("7 of 12 pass, 10.0 s.") && page.contains("12 of 12 pass, 12.0 s."),
            "{page}"
        );
        assert!(page.contains("<desc>trials, run by run: 7, 9, 12</desc>"), "{page}");
    }

    #[test]
    fn one_run_is_no_history() {
        let (_folder, tree) = runs(&[7]);
        assert!(histories(&tree).iter().all(|history| plot(history).is_none()));
    }
}
