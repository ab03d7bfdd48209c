//! Roots and powers to six digits, without branches and tables, so that the compiler can compute
//! several at once.

use std::f32::consts::LN_2;

/// The cube root of a positive number, to 10⁻⁶.
#[inline(always)]
pub(super) fn cube_root(x: f32) -> f32 {
    // A third of the exponent, and of what stands for the mantissa: right to 4 %.
    let start = f32::from_bits(x.to_bits() / 3 + 0x2a51_37a0);
    halley(halley(start, x), x)
}

/// One step of Halley's method for y³ = x: the error cubed.
#[inline(always)]
fn halley(y: f32, x: f32) -> f32 {
    let cube = y * y * y;
    y * (cube + 2.0 * x) / (2.0 * cube + x)
}

/// `x` to the power `p`, to 10⁻⁶, for x and p in [0, 100]; 0 for x = 0.
#[inline(always)]
pub(super) fn power(x: f32, p: f32) -> f32 {
    if x > 0.0 { exponential(p * logarithm(x)) } else { 0.0 }
}

/// The binary logarithm of a positive number.
#[inline(always)]
fn logarithm(x: f32) -> f32 {
    const ROOT_OF_HALF: u32 = 0x3f35_04f3;
    // The exponent that leaves a mantissa between √½ and √2.
    let exponent = (x.to_bits().wrapping_sub(ROOT_OF_HALF) as i32) >> 23;
    let mantissa = f32::from_bits(x.to_bits().wrapping_sub((exponent << 23) as u32));
    // ln m = 2 artanh s
    let s = (mantissa - 1.0) / (mantissa + 1.0);
    let square = s * s;
    let series = 1.0 + square * (1.0 / 3.0 + square * (0.2 + square * (1.0 / 7.0 + square / 9.0)));
    exponent as f32 + s * series * (2.0 / LN_2)
}

/// Two to the power of a number in [−126, 127].
#[inline(always)]
fn exponential(x: f32) -> f32 {
    /// Added to a number, it leaves the nearest whole number in the lowest bits.
    const ROUND: f32 = 12_582_912.0;
    let shifted = x.max(-126.0) + ROUND;
    let whole = (shifted.to_bits() as i32).wrapping_sub(ROUND.to_bits() as i32);
    let t = (x.max(-126.0) - (shifted - ROUND)) * LN_2;
    let tail = 1.0 / 24.0 + t * (1.0 / 120.0 + t * (1.0 / 720.0 + t / 5040.0));
    let series = 1.0 + t * (1.0 + t * (0.5 + t * (1.0 / 6.0 + t * tail)));
    series * f32::from_bits(((whole + 127) << 23) as u32)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers() -> impl Iterator<Item = f32> {
        (-60..=27).flat_map(|i| [1.0, 1.17, 1.41, 1.42, 1.99].map(|m| m * (i as f32 * 0.25).exp2()))
    }

    #[test]
    fn cube_roots_are_right_to_six_digits() {
        for x in numbers() {
            assert!((cube_root(x) / x.cbrt() - 1.0).abs() < 1e-6, "{x}");
        }
    }

    #[test]
    fn powers_are_right_to_six_digits() {
        for x in numbers() {
            for p in [0.0, 0.1, 0.5, 0.7, 0.999, 1.0] {
                assert!((power(x, p) / x.powf(p) - 1.0).abs() < 2e-6, "{x} {p}");
            }
        }
        assert_eq!([0.0, 0.3, 1.0].map(|p| power(0.0, p)), [0.0; 3]);
    }
}
