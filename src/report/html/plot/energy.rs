//! Energy by bounce: what a core returns at each depth against what it should, one line a channel, and the factor a
//! bounce that fits.

use super::chart::{Axis, Chart};
use super::figure::{Figure, Mark, Shape};
use super::scale::Scale;
use crate::checks::{Finding, Measure};
use crate::image::{CHANNELS, Channel};
use crate::text::number::{figure, plus_minus, ratio};
use maud::html;

const SHOULD: &str = "Radiance falls along the expected lines, and every ratio is 1 within its interval. A ratio that falls \
    by one factor a bounce is a straight line: grey if the survival probability of Russian roulette is not divided by, coloured if \
    the albedo is counted twice. A step at bounce 1 is direct light, one at the last bounce a wrong maximum depth.";

/// Bounces that a line has to have.
const FEWEST: usize = 3;
/// Standard errors on each side of a 99.9 % interval.
const THREE_NINES: f64 = 3.29;

/// What came back at one depth.
struct Bounce {
    number: u32,
    measured: f64,
    expected: f64,
    interval: [f64; 2],
    allowed: f64,
}

impl Bounce {
    fn of(measure: &Measure) -> Option<Self> {
        let number = measure.row.strip_prefix("bounce ")?.parse().ok()?;
        let (measured, expected) = (measure.measured, measure.expected);
        Some(Self {
            number,
            measured,
            expected,
            interval: measure.interval.unwrap_or([measured; 2]),
            allowed: measure.allowed,
        })
    }

    fn ratio(&self) -> f64 {
        self.measured / self.expected
    }

    fn ratios(&self) -> [f64; 2] {
        self.interval.map(|end| end / self.expected)
    }

    /// How far the ratio may be from 1, without noise.
    fn tolerance(&self) -> f64 {
        self.allowed / self.expected.abs()
    }
}

/// One channel, in the order of the bounces.
struct Line {
    channel: Channel,
    bounces: Vec<Bounce>,
}

impl Line {
    fn of(finding: &Finding, channel: Channel) -> Self {
        let measures = finding.measures.iter().filter(|m| m.channel == Some(channel));
        let mut bounces: Vec<_> = measures.filter_map(Bounce::of).collect();
        bounces.sort_by_key(|bounce| bounce.number);
        Self { channel, bounces }
    }

    const fn mark(&self) -> Mark {
        match self.channel {
            Channel::Red => Mark::new("red", Shape::Circle),
            Channel::Green => Mark::new("green", Shape::Square),
            Channel::Blue => Mark::new("blue", Shape::Triangle),
        }
    }

    /// Scattered light: weighted least squares of ln ratio on the bounce.
    fn fit(&self) -> Option<Fit> {
        let points: Vec<_> = self.bounces.iter().filter_map(point).collect();
        let sum = |term: &dyn Fn(&[f64; 3]) -> f64| points.iter().map(term).sum::<f64>();
        let weights = sum(&|[.., weight]| *weight);
        let mean = |of: usize| sum(&|point| point[2] * point[of]) / weights;
        let (x, y) = (mean(0), mean(1));
        let squares = sum(&|point| point[2] * (point[0] - x).powi(2));
        let slope = sum(&|point| point[2] * (point[0] - x) * (point[1] - y)) / squares;
        let is_known = points.len() >= FEWEST && slope.is_finite();
        is_known.then(|| Fit { slope, at: [x, y], error: squares.recip().sqrt() })
    }
}

/// Of a bounce of scattered light: its number, ln of its ratio, and one over the variance of that.
fn point(bounce: &Bounce) -> Option<[f64; 3]> {
    let (ratio, [low, high]) = (bounce.ratio(), bounce.ratios());
    let half = (0.5 * (high - low)).max(bounce.tolerance()).max(1e-6);
    let error = half / (THREE_NINES * ratio);
    let point = [f64::from(bounce.number), ratio.ln(), error.powi(-2)];
    (bounce.number >= 1 && point.iter().all(|value| value.is_finite())).then_some(point)
}

/// The ratio at bounce k is exp(y + slope (k − x)).
struct Fit {
    slope: f64,
    at: [f64; 2],
    /// Standard error of the slope.
    error: f64,
}

impl Fit {
    fn ratio(&self, bounce: u32) -> f64 {
        (self.at[1] + self.slope * (f64::from(bounce) - self.at[0])).exp()
    }

    fn may_be_one(&self) -> bool {
        self.slope.abs() <= THREE_NINES * self.error
    }

    fn words(&self) -> String {
        let factor = self.slope.exp();
        plus_minus(factor, factor * THREE_NINES * self.error)
    }
}

/// The plot of a finding that isolates three bounces or more.
pub(super) fn plot(finding: &Finding) -> Option<Figure> {
    let lines = CHANNELS.map(|channel| Line::of(finding, channel));
    (lines[0].bounces.len() >= FEWEST).then(|| draw(&lines))?
}

/// Whether it is a bounce that fails: where a sum does, each may be right.
pub(super) fn is_wrong(finding: &Finding) -> bool {
    let mut failed = finding.measures.iter().filter(|measure| measure.failed());
    failed.any(|measure| Bounce::of(measure).is_some())
}

fn draw(lines: &[Line; 3]) -> Option<Figure> {
    let [radiance, ratios] = [radiance(lines)?, ratios(lines)?];
    let found = found(lines);
    let drawing = html! {
        div.panels {
            (radiance.svg("Radiance by bounce", &found))
            (ratios.svg("Measured over expected radiance by bounce", &found))
        }
    };
    let mut legend: Vec<_> = lines
        .iter()
        .map(|line| (line.mark(), format!("{}, with its 99.9 % interval", line.channel)))
        .collect();
    legend.push((Mark::new("band", Shape::Area), "tolerance".to_owned()));
    legend.push((Mark::new("guide", Shape::Line), "expected".to_owned()));
    legend.push((Mark::new("fit", Shape::Line), "fit, a factor a bounce".to_owned()));
    let title = "Energy by bounce".to_owned();
    let left_out = ratios.left_out;
    Some(Figure { title, drawing, legend, found, should: SHOULD, left_out })
}

fn last(lines: &[Line; 3]) -> u32 {
    let numbers = lines.iter().flat_map(|line| &line.bounces).map(|bounce| bounce.number);
    numbers.max().unwrap_or(0)
}

fn bounces(lines: &[Line; 3]) -> Option<Axis> {
    let last = last(lines);
    let scale = Scale::linear([0.0, f64::from(last)])?.with_room(0.04);
    Some(Axis::of_whole("bounce", scale, 0..=last))
}

fn radiance(lines: &[Line; 3]) -> Option<Chart> {
    let all = || lines.iter().flat_map(|line| &line.bounces);
    let values = all().flat_map(|bounce| [bounce.measured, bounce.expected]);
    let scale = Scale::log(values)?.with_room(0.05);
    let mut chart = Chart::new(bounces(lines)?, Axis::new("radiance, W/(m² sr)", scale));
    for line in lines {
        let at = |bounce: &Bounce, value: f64| [f64::from(bounce.number), value];
        chart.line("guide", line.bounces.iter().map(|bounce| at(bounce, bounce.expected)));
        for bounce in &line.bounces {
            chart.point(line.mark(), at(bounce, bounce.measured), "");
        }
    }
    Some(chart)
}

/// What the axis of the ratios has to have room for.
fn shown(bounce: &Bounce) -> [f64; 5] {
    let ([low, high], tolerance) = (bounce.ratios(), bounce.tolerance());
    [bounce.ratio(), low, high, 1.0 - tolerance, 1.0 + tolerance]
}

fn ratios(lines: &[Line; 3]) -> Option<Chart> {
    let all = || lines.iter().flat_map(|line| &line.bounces);
    let values = || all().flat_map(shown).chain([1.0]);
    let smallest = values().filter(|value| value.is_finite()).fold(1.0, f64::min);
    let scale = match smallest {
        ..=0.0 | 0.5.. => Scale::linear(values()),
        _ => Scale::log(values()),
    };
    let mut chart =
        Chart::new(bounces(lines)?, Axis::new("measured / expected", scale?.with_room(0.06)));
    let tolerance = all().map(Bounce::tolerance).fold(0.0, f64::max);
    chart.bar("band", [0.0, f64::from(last(lines))], [1.0 - tolerance, 1.0 + tolerance], "");
    chart.line("guide", [[0.0, 1.0], [f64::from(last(lines)), 1.0]]);
    for (line, side) in lines.iter().zip([-1.0, 0.0, 1.0]) {
        // Beside each other, so that one does not hide the others.
        let aside = side * 0.015 * f64::from(last(lines));
        if let Some(fit) = line.fit() {
            chart.line(
                "fit",
                (1..=last(lines)).map(|bounce| [f64::from(bounce), fit.ratio(bounce)]),
            );
        }
        for bounce in &line.bounces {
            let x = f64::from(bounce.number) + aside;
            chart.interval(line.mark().class, x, bounce.ratios());
            let title = format!(
                "bounce {}, {}: {} measured, {} expected, ratio {}",
                bounce.number,
                line.channel,
                figure(bounce.measured),
                figure(bounce.expected),
                figure(bounce.ratio())
            );
            chart.point(line.mark(), [x, bounce.ratio()], &title);
        }
    }
    Some(chart)
}

fn found(lines: &[Line; 3]) -> String {
    let all = lines.iter().flat_map(|line| line.bounces.iter().map(move |bounce| (line, bounce)));
    let off = |bounce: &Bounce| (bounce.ratio() - 1.0).abs();
    let known = all.filter(|(_, bounce)| bounce.ratio().is_finite());
    let worst = known.max_by(|a, b| off(a.1).total_cmp(&off(b.1)));
    let furthest = worst.map(|(line, bounce)| match off(bounce) <= bounce.tolerance() {
        true => "Every ratio is 1 within its tolerance.".to_owned(),
        false => {
            let (number, channel) = (bounce.number, line.channel);
            format!("Furthest from 1 is bounce {number}, {channel}: {}.", ratio(bounce.ratio()))
        }
    });
    furthest.into_iter().chain(fitted(lines)).collect::<Vec<_>>().join(" ")
}

/// The factor a bounce, of each channel.
fn fitted(lines: &[Line; 3]) -> Option<String> {
    let fits: Vec<_> = lines.iter().filter_map(|line| Some((line.channel, line.fit()?))).collect();
    let words = fits.iter().map(|(channel, fit)| format!("{channel} {}", fit.words()));
    let words = words.collect::<Vec<_>>().join(", ");
    match fits.iter().all(|(_, fit)| fit.may_be_one()) {
        _ if fits.is_empty() => None,
        true => Some(format!("No factor a bounce: {words}.")),
        false => Some(format!("From bounce 1 on each bounce has one more factor of {words}.")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn furnace(factor: f64, at: impl Fn(u32) -> f64) -> Finding {
        let measure = |bounce: u32, channel| {
            let expected = 0.7 * 0.5_f64.powi(bounce.cast_signed());
            let measured =
                expected * factor.powi(bounce.saturating_sub(1).cast_signed()) * at(bounce);
            let half = 0.003 * measured;
            Measure {
                interval: Some([measured - half, measured + half]),
                ..Measure::exact("", measured, expected, 0.0)
            }
            .of_row(format!("bounce {bounce}"))
            .of_channel(channel)
        };
        let measures = (0..6).flat_map(|bounce| CHANNELS.map(|channel| measure(bounce, channel)));
        Finding::of("", "", measures.collect())
    }

    #[test]
    fn the_factor_of_each_bounce_is_fitted_and_told() {
        let page = plot(&furnace(0.7, |_| 1.0)).unwrap().markup().into_string();
        assert!(page.contains("each bounce has one more factor of red 0.7000 ± 0.0"), "{page}");
        assert!(page.contains("Furthest from 1 is bounce 5, blue: 0.24."), "{page}");
        assert_eq!(page.matches("<svg role=\"img\"").count(), 2);
        assert_eq!(page.matches("<title>bounce ").count(), 18);
        assert!(is_wrong(&furnace(0.7, |_| 1.0)) && !is_wrong(&furnace(1.0, |_| 1.0)));
        let right = plot(&furnace(1.0, |_| 1.0)).unwrap().markup().into_string();
        assert!(right.contains("No factor a bounce: red 1.0000 ± 0.00"), "{right}");
        assert!(page.contains("<desc>") && page.contains("measured / expected"));
    }

    #[test]
    fn nan_is_counted_and_black_bounces_are_drawn_at_zero() {
        let page = plot(&furnace(1.0, |k| if k == 3 { f64::NAN } else { 1.0 }))
            .unwrap()
            .markup()
            .into_string();
        assert!(page.contains("3 values are not drawn"), "{page}");
        let black = plot(&furnace(1.0, |k| f64::from(k < 2))).unwrap().markup().into_string();
        assert!(!black.contains("not drawn") && !black.contains("NaN"), "{black}");
    }

    #[test]
    fn fewer_than_three_bounces_are_no_plot() {
        let mut finding = furnace(1.0, |_| 1.0);
        finding.measures.truncate(6);
        assert!(plot(&finding).is_none());
    }
}
