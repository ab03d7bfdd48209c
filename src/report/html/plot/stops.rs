//! Where something random stops, against the law that it has: adaptive sampling after so many samples, paths under
//! Russian roulette before so many bounces.

use super::chart::{Axis, Chart};
use super::figure::{Figure, Mark, Shape};
use super::scale::Scale;
use crate::checks::series::{StopCounts, Survival};
use crate::text::number::{figure, percent};

const OBSERVED: Mark = Mark::new("data", Shape::Area);
const LAW: Mark = Mark::new("line-b", Shape::Circle);
const REJECTED: Mark = Mark::new("wrong", Shape::Area);
const SHARE: Mark = Mark::new("line-a", Shape::Circle);

const COUNTS: &str = "Every bar ends at its mark, which is the exact law of the rule: one bar a batch. All streams at the cap: the rule never stops, or the counts are not real. \
    Bars between the batches: it looks after every sample. Too many early: the tolerance or the confidence interval is too wide.";
const SHARES: &str = "Shares fall along the law, by the survival probability at each bounce once the guaranteed ones are over. A line that is shifted by a bounce: one bounce more or less is \
    guaranteed. One that is too steep: roulette is played twice, or by throughput.";

pub(super) fn counts(counts: &StopCounts) -> Option<Figure> {
    let chart = counts_chart(counts)?;
    let title = format!("Samples used, streams of {}", counts.of);
    let found = counts_found(counts);
    let drawing = chart.svg(&title, &found);
    let mut legend = vec![
        (OBSERVED, "streams that stopped there".to_owned()),
        (LAW, "the law of the rule".to_owned()),
    ];
    if !counts.rejected.is_empty() {
        legend.push((REJECTED, "rejected for itself".to_owned()));
    }
    Some(Figure { title, drawing, legend, found, should: COUNTS, left_out: chart.left_out })
}

/// Number of samples, observed, expected.
fn places(counts: &StopCounts) -> impl Iterator<Item = (f64, [f64; 2])> {
    let values = counts.observed.iter().zip(counts.expected.iter());
    let values = values.map(|(observed, expected)| [*observed as f64, *expected]);
    counts.samples.iter().map(|samples| *samples as f64).zip(values)
}

fn counts_chart(counts: &StopCounts) -> Option<Chart> {
    let highest = places(counts).flat_map(|(_, values)| values);
    let x = Scale::linear(places(counts).map(|(samples, _)| samples).chain([0.0]))?.with_room(0.03);
    let y = Scale::linear(highest.chain([0.0]))?;
    let half = 0.4 * narrowest(counts);
    let mut chart = Chart::new(Axis::new("samples used", x), Axis::new("streams", y));
    for (samples, [observed, expected]) in places(counts) {
        let is_rejected = counts.rejected.iter().any(|rejected| *rejected as f64 == samples);
        let class = if is_rejected { REJECTED } else { OBSERVED }.class;
        let title = format!("{samples} samples: {observed} streams, {} expected", figure(expected));
        chart.bar(class, [samples - half, samples + half], [0.0, observed], &title);
    }
    // Where the rule never stops there is no mark that could hide a bar.
    for (samples, [_, expected]) in places(counts).filter(|(_, [_, expected])| *expected > 0.0) {
        chart.point(LAW, [samples, expected], "");
    }
    Some(chart)
}

/// The distance of the nearest numbers of samples.
fn narrowest(counts: &StopCounts) -> f64 {
    let steps = counts.samples.windows(2).map(|pair| (pair[1] - pair[0]) as f64);
    steps.reduce(f64::min).unwrap_or(1.0)
}

fn counts_found(counts: &StopCounts) -> String {
    let sum = |of: &dyn Fn(f64, [f64; 2]) -> f64| {
        places(counts).map(|(n, values)| of(n, values)).sum::<f64>()
    };
    let streams = sum(&|_, [observed, _]| observed);
    let mean =
        |number: usize| sum(&|n, values| n * values[number]) / sum(&|_, values| values[number]);
    let used = format!(
        "{streams} streams use {} samples on average, {} by the law.",
        figure(mean(0)),
        figure(mean(1))
    );
    match counts.rejected.len() {
        0 => format!("{used} No bar is rejected for itself."),
        1 => format!("{used} 1 bar is rejected for itself."),
        many => format!("{used} {many} bars are rejected, each for itself."),
    }
}

pub(super) fn survival(survival: &Survival) -> Option<Figure> {
    let chart = survival_chart(survival)?;
    let title = format!("Paths that reach a bounce, {}", survival.of);
    let found = survival_found(survival);
    let drawing = chart.svg(&title, &found);
    let legend = vec![
        (SHARE, "share of paths, with its interval".to_owned()),
        (Mark::new("guide", Shape::Line), "the law".to_owned()),
    ];
    Some(Figure { title, drawing, legend, found, should: SHARES, left_out: chart.left_out })
}

fn survival_chart(survival: &Survival) -> Option<Chart> {
    let bounces = || survival.bounces.iter().map(|bounce| f64::from(*bounce));
    let last = survival.bounces.last()?;
    let values = survival.high.iter().chain(survival.expected.iter()).copied();
    let y = Scale::linear(values.chain([0.0, 1.0]))?;
    let x = Scale::linear(bounces().chain([0.0]))?.with_room(0.04);
    let mut chart =
        Chart::new(Axis::of_whole("bounce", x, 0..=*last), Axis::new("share of paths", y));
    chart.line("guide", bounces().zip(survival.expected.iter()).map(|(x, y)| [x, *y]));
    let ends = survival.low.iter().zip(survival.high.iter());
    for ((bounce, share), (low, high)) in bounces().zip(survival.share.iter()).zip(ends) {
        chart.interval(SHARE.class, bounce, [*low, *high]);
        chart.point(SHARE, [bounce, *share], &format!("bounce {bounce}: {}", percent(*share)));
    }
    Some(chart)
}

fn survival_found(survival: &Survival) -> String {
    let shares = survival.share.iter().zip(survival.expected.iter());
    let rows = survival.bounces.iter().zip(shares);
    let off = |(share, expected): (&f64, &f64)| (share - expected).abs();
    let known = rows.filter(|(_, (share, expected))| (**share - **expected).is_finite());
    let worst = known.max_by(|a, b| off(a.1).total_cmp(&off(b.1)));
    worst.map_or_else(String::new, |(bounce, (share, expected))| {
        format!(
            "Furthest off at bounce {bounce}: {} of paths, {} by the law.",
            percent(*share),
            percent(*expected)
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::series::OneLine;

    fn stops(rejected: &[u64]) -> StopCounts {
        StopCounts {
            of: "0 or 1 with 10 %".to_owned(),
            samples: [8, 16, 64].into_iter().collect(),
            observed: [10, 30, 60].into_iter().collect(),
            expected: OneLine::rounded([12.0, 28.0, 60.0]),
            rejected: rejected.iter().copied().collect(),
        }
    }

    #[test]
    fn each_count_is_a_bar_beside_its_law() {
        let page = counts(&stops(&[])).unwrap().markup().into_string();
        assert!(
            page.contains("100 streams use 44 samples on average, 43.8 by the law. No bar"),
            "{page}"
        );
        assert_eq!(page.matches("class=\"data area\"").count(), 3 + 1, "with its legend");
        let page = counts(&stops(&[16])).unwrap().markup().into_string();
        assert!(
            page.contains("1 bar is rejected for itself.") && page.contains("class=\"wrong area\"")
        );
    }

    #[test]
    fn shares_are_drawn_with_their_law_and_nan_is_said() {
        let paths = Survival {
            of: "stop 0.3, 1 guaranteed".to_owned(),
            bounces: [1, 2, 3].into_iter().collect(),
            share: OneLine::rounded([1.0, 0.7, f64::NAN]),
            low: OneLine::rounded([1.0, 0.69, f64::NAN]),
            high: OneLine::rounded([1.0, 0.71, f64::NAN]),
            expected: OneLine::rounded([1.0, 0.69, 0.49]),
        };
        let page = survival(&paths).unwrap().markup().into_string();
        assert!(
            page.contains("Furthest off at bounce 2: 70 % of paths, 69 % by the law."),
            "{page}"
        );
        assert!(page.contains("1 value is not drawn") && !page.contains("NaN\""));
    }
}
