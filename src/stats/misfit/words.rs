//! What was found, as sentences.

use super::{BouncesOff, Fit, Lines, Misfit, Symmetry};
use std::fmt;

impl fmt::Display for Symmetry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::LeftRight => "mirrored left to right",
            Self::UpsideDown => "upside down",
            Self::HalfTurn => "turned by 180°",
            Self::Transposed => "transposed",
            Self::AntiTransposed => "transposed from the other corner",
            Self::QuarterTurn => "turned by 90° clockwise",
            Self::QuarterTurnBack => "turned by 90° counterclockwise",
        })
    }
}

impl fmt::Display for Misfit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Turned(symmetry) => write!(f, "{symmetry}"),
            Self::Brighter(gain) => brighter(f, gain),
            Self::Power(power) => {
                let [low, high] = power.interval;
                write!(f, "raised to the power {:.3} ({low:.3} to {high:.3})", power.value)
            }
            Self::EncodedTwice => f.write_str("gamma-encoded (sRGB) once too often"),
            Self::DecodedTwice => f.write_str("gamma-decoded (sRGB) once too often"),
            Self::Clipped { level, pixels } => {
                write!(f, "clipped at {level:.4}, where {pixels} pixels should be brighter")
            }
            Self::TimesAlpha => f.write_str("multiplied by its alpha once too often"),
            Self::OverAlpha => f.write_str("divided by its alpha once too often"),
            Self::Displaced { right, down } => {
                displaced(f, [right.value, down.value])?;
                let half = |ends: [f64; 2]| 0.5 * (ends[1] - ends[0]);
                write!(f, ", ± {:.3} and {:.3}", half(right.interval), half(down.interval))
            }
            Self::Stripe { lines, first, last, factor } => {
                let lines = match lines {
                    Lines::Columns => "columns",
                    Lines::Rows => "rows",
                };
                let half = factor.interval[1] - factor.value;
                write!(
                    f,
                    "{:.3} ± {half:.3} times as bright in {lines} {first} to {last}",
                    factor.value
                )
            }
            Self::Magnified { across, upright, right, down } => {
                write!(f, "magnified by {:.4} × {:.4}", across.value, upright.value)?;
                f.write_str(" about its centre, then ")?;
                displaced(f, [right.value, down.value])
            }
        }
    }
}

fn brighter(f: &mut fmt::Formatter<'_>, gain: &[super::Estimate; 3]) -> fmt::Result {
    let [red, green, blue] = gain.map(|channel| channel.value);
    let common = (red + green + blue) / 3.0;
    if gain.iter().all(|channel| channel.allows(common)) {
        let half = gain.iter().map(|c| c.interval[1] - c.value).fold(0.0, f64::max);
        return write!(f, "{common:.4} ± {half:.4} times as bright, alike in all channels");
    }
    write!(f, "{red:.4}, {green:.4}, {blue:.4} times as bright in red, green, blue")
}

/// "displaced by 0.50 pixels to the right and 1.00 up"
fn displaced(f: &mut fmt::Formatter<'_>, [right, down]: [f64; 2]) -> fmt::Result {
    let across = if right < 0.0 { "left" } else { "right" };
    let upright = if down < 0.0 { "up" } else { "down" };
    write!(f, "displaced by {:.2} pixels to the {across}", right.abs())?;
    write!(f, " and {:.2} {upright}", down.abs())
}

impl fmt::Display for BouncesOff {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let are = match self.first == self.last {
            true => format!("bounce {} is", self.first),
            false => format!("bounces {} to {} are", self.first, self.last),
        };
        let missing = self.share.missing;
        let [low, high] = missing.interval;
        match missing.value > 0.0 {
            true => write!(f, "{are} missing, {:.2} times ({low:.2} to {high:.2})", missing.value),
            false => write!(
                f,
                "{are} there too often, by {:.2} times ({:.2} to {:.2})",
                -missing.value, -high, -low
            ),
        }
    }
}

impl fmt::Display for Fit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: explains {:.1} % of the difference", self.misfit, 100.0 * self.explains)
    }
}
