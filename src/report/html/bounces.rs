//! Energy bounce by bounce: each bounce of a furnace over what it should be, one line a channel, where a cause
//! explains a case that isolates bounces.

use crate::checks::{Finding, Measure};
use crate::diagnosis::Headline;
use crate::image::{CHANNELS, Channel};
use crate::report::tree::RunTree;
use crate::text::number::ratio;
use maud::{Markup, html};

const WIDTH: f64 = 460.0;
const HEIGHT: f64 = 170.0;
const LEFT: f64 = 46.0;
const BOTTOM: f64 = 30.0;

struct Point {
    bounce: u32,
    ratio: f64,
    interval: [f64; 2],
}

/// The plot, if one of the explained cases has three isolated bounces at least.
pub(crate) fn plot(tree: &RunTree, core: &str, headline: &Headline) -> Option<Markup> {
    let findings = tree.trials_of(core).filter(|trial| headline.explains.contains(&trial.case));
    let mut findings = findings.filter_map(|trial| trial.outcome.finding());
    findings.find_map(|finding| {
        let lines = CHANNELS.map(|channel| points(finding, channel));
        (lines[0].len() >= 3).then(|| draw(&lines))
    })
}

/// Of the rows `bounce k`, in the order of the bounces.
fn points(finding: &Finding, channel: Channel) -> Vec<Point> {
    let point = |measure: &Measure| {
        let bounce = measure.row.strip_prefix("bounce ")?.parse().ok()?;
        let ratio = measure.measured / measure.expected;
        let interval = measure.interval.unwrap_or([measure.measured; 2]);
        let interval = interval.map(|end| end / measure.expected);
        ratio.is_finite().then_some(Point { bounce, ratio, interval })
    };
    let of_channel = finding.measures.iter().filter(|m| m.channel == Some(channel));
    let mut points: Vec<_> = of_channel.filter_map(point).collect();
    points.sort_by_key(|point| point.bounce);
    points
}

fn draw(lines: &[Vec<Point>; 3]) -> Markup {
    let all = || lines.iter().flatten();
    let last = all().map(|point| point.bounce).max().unwrap_or(1).max(1);
    let top = all().map(|point| point.ratio).fold(1.0, f64::max) * 1.08;
    let x = |bounce: u32| LEFT + 12.0 + (WIDTH - LEFT - 24.0) * f64::from(bounce) / f64::from(last);
    let y = |ratio: f64| (HEIGHT - BOTTOM) * (1.0 - ratio.clamp(0.0, top) / top) + 6.0;
    let words: Vec<_> =
        lines[0].iter().map(|p| format!("{}: {}", p.bounce, ratio(p.ratio))).collect();
    let label = format!("each bounce relative to its expected value, red: {}", words.join(", "));
    html! {
        figure.bounces {
            svg viewBox=(format!("0 0 {WIDTH} {HEIGHT}")) role="img" aria-label=(label) {
                line.axis x1=(LEFT) x2=(WIDTH) y1=(y(1.0)) y2=(y(1.0)) {}
                text x=(LEFT - 8.0) y=(y(1.0) + 4.0) text-anchor="end" { "right" }
                text x=(LEFT - 8.0) y=(y(0.0) + 4.0) text-anchor="end" { "0" }
                @for bounce in 0..=last {
                    text x=(x(bounce)) y=(HEIGHT - 8.0) text-anchor="middle" { (bounce) }
                }
                @for (line, channel) in lines.iter().zip(CHANNELS) {
                    polyline class=(channel) points=(path(line, &x, &y)) {}
                    @for point in line {
                        line class=(channel) x1=(x(point.bounce)) x2=(x(point.bounce))
                            y1=(y(point.interval[0])) y2=(y(point.interval[1])) {}
                        circle class=(channel) cx=(x(point.bounce)) cy=(y(point.ratio)) r="3" {
                            title { (format!("bounce {}, {channel}: {}", point.bounce, ratio(point.ratio))) }
                        }
                    }
                }
            }
            figcaption { "Each bounce relative to its expected value; bars are 99.9 % confidence intervals." }
        }
    }
}

fn path(line: &[Point], x: &impl Fn(u32) -> f64, y: &impl Fn(f64) -> f64) -> String {
    let point = |p: &Point| format!("{:.1},{:.1}", x(p.bounce), y(p.ratio));
    line.iter().map(point).collect::<Vec<_>>().join(" ")
}
