//! A measured interval beside what is expected, as a small drawing in the line of its measure.

use crate::checks::Measure;
use crate::report::measure::MeasureWords;
use maud::{Markup, html};

const WIDTH: f64 = 180.0;
const HEIGHT: f64 = 22.0;
/// Empty space at either end.
const MARGIN: f64 = 8.0;
/// What is narrower cannot be seen.
const NARROWEST: f64 = 2.0;

struct Scale {
    low: f64,
    high: f64,
}

impl Scale {
    /// The scale that shows all of the values; none if one is not finite or all are equal.
    fn around(values: &[f64]) -> Option<Self> {
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let shows = values.iter().all(|value| value.is_finite()) && high > low;
        shows.then_some(Self { low, high })
    }

    fn place(&self, value: f64) -> f64 {
        let share = (value - self.low) / (self.high - self.low);
        MARGIN + share * (WIDTH - 2.0 * MARGIN)
    }
}

/// The drawing; nothing for a measure without an interval, or with one that cannot be drawn.
pub(crate) fn plot(measure: &Measure) -> Markup {
    let drawing = measure.interval.and_then(|interval| draw(measure, interval));
    html! { @if let Some(drawing) = drawing { (drawing) } }
}

fn draw(measure: &Measure, [low, high]: [f64; 2]) -> Option<Markup> {
    let band = [measure.expected - measure.allowed, measure.expected + measure.allowed];
    let scale = Scale::around(&[band[0], band[1], low, high, measure.measured])?;
    let words = MeasureWords::of(measure);
    let text = format!(
        "measured {}, interval {}; expected {} {}",
        words.measured, words.interval, words.expected, words.allowed
    );
    let number = |value: f64| format!("{value:.1}");
    let (left, right) = at_least(NARROWEST, scale.place(band[0]), scale.place(band[1]));
    let (from, to) = (scale.place(low), scale.place(high));
    let middle = HEIGHT / 2.0;
    Some(html! {
        svg.interval role="img" aria-label=(text)
            viewBox={ "0 0 " (WIDTH) " " (HEIGHT) } width=(WIDTH) height=(HEIGHT)
        {
            title { (text) }
            rect.band x=(number(left)) y="2" width=(number(right - left)) height=(HEIGHT - 4.0) {}
            path.expected d={ "M" (number(scale.place(measure.expected))) " 1V" (HEIGHT - 1.0) } {}
            path.measured d={
                "M" (number(from)) " " (middle) "H" (number(to))
                "M" (number(from)) " " (middle - 4.0) "v8M" (number(to)) " " (middle - 4.0) "v8"
            } {}
            circle.measured cx=(number(scale.place(measure.measured))) cy=(middle) r="3" {}
        }
    })
}

/// The same span, widened about its middle if it is narrower than `width`.
fn at_least(width: f64, left: f64, right: f64) -> (f64, f64) {
    let lacking = (width - (right - left)).max(0.0) / 2.0;
    (left - lacking, right + lacking)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn measure(interval: Option<[f64; 2]>) -> Measure {
        Measure { interval, ..Measure::exact("red", 0.35, 0.37, 0.001) }
    }

    #[test]
    fn an_interval_is_drawn_beside_its_band() {
        let drawing = plot(&measure(Some([0.349, 0.351]))).into_string();
        assert!(drawing.contains("interval [0.3490, 0.3510]"), "{drawing}");
        // The interval ends left of the band: 0.349 is the low end of the scale, 0.371 the high one.
        assert!(drawing.contains("M8.0 11H22.9"), "{drawing}");
    }

    #[test]
    fn without_an_interval_or_with_nan_nothing_is_drawn() {
        assert_eq!(plot(&measure(None)).into_string(), "");
        assert_eq!(plot(&measure(Some([f64::NAN, 1.0]))).into_string(), "");
    }
}
