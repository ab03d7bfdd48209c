//! What was found, as sentences.

use super::{BouncesOff, Estimate, Fit, Lines, Misfit};
use crate::text::number::{percent, plus_minus, significant};
use std::fmt;

impl fmt::Display for Misfit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Turned(symmetry) => write!(f, "{symmetry}"),
            Self::Brighter(gain) => brighter(f, gain),
            Self::Power(power) => write!(f, "raised to the power {power}"),
            Self::EncodedTwice => f.write_str("gamma-encoded (sRGB) once too often"),
            Self::DecodedTwice => f.write_str("gamma-decoded (sRGB) once too often"),
            Self::Clipped { level, pixels } => {
                let level = significant(*level, 4);
                write!(f, "clipped at {level}, where {pixels} pixels should be brighter")
            }
            Self::TimesAlpha => f.write_str("multiplied by its alpha once too often"),
            Self::OverAlpha => f.write_str("divided by its alpha once too often"),
            Self::Displaced { right, down } => displaced(f, right, down),
            Self::Stripe { lines, first, last, factor } => {
                let lines = match lines {
                    Lines::Columns => "columns",
                    Lines::Rows => "rows",
                };
                write!(f, "{factor} times as bright in {lines} {first} to {last}")
            }
            Self::Magnified { across, upright, right, down } => {
                write!(f, "magnified by {across} × {upright} about its centre, then ")?;
                displaced(f, right, down)
            }
        }
    }
}

/// `0.7000 ± 0.0004`
impl fmt::Display for Estimate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [low, high] = self.interval;
        f.write_str(&plus_minus(self.value, 0.5 * (high - low)))
    }
}

fn brighter(f: &mut fmt::Formatter<'_>, gain: &[Estimate; 3]) -> fmt::Result {
    let common = gain.iter().map(|channel| channel.value).sum::<f64>() / 3.0;
    if gain.iter().all(|channel| channel.allows(common)) {
        let half = gain.iter().map(|c| c.interval[1] - c.value).fold(0.0, f64::max);
        let gain = Estimate::new(common, half);
        return write!(f, "{gain} times as bright, alike in all channels");
    }
    let [red, green, blue] = gain;
    write!(f, "{red}, {green}, {blue} times as bright in red, green, blue")
}

/// "displaced by 0.50 ± 0.01 pixels to the right and 1.00 ± 0.01 up"
fn displaced(f: &mut fmt::Formatter<'_>, right: &Estimate, down: &Estimate) -> fmt::Result {
    let across = if right.value < 0.0 { "left" } else { "right" };
    let upright = if down.value < 0.0 { "up" } else { "down" };
    let [right, down] = [right.length(), down.length()];
    write!(f, "displaced by {right} pixels to the {across} and {down} {upright}")
}

impl fmt::Display for BouncesOff {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let are = match self.first == self.last {
            true => format!("bounce {} is", self.first),
            false => format!("bounces {} to {} are", self.first, self.last),
        };
        let missing = self.share.missing;
        let times = missing.length();
        match missing.value > 0.0 {
            true => write!(f, "{are} missing, {times} times"),
            false => write!(f, "{are} there too often, by {times} times"),
        }
    }
}

impl fmt::Display for Fit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: explains {} of the difference", self.misfit, percent(self.explains))
    }
}
