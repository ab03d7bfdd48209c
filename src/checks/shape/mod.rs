//! Rays against single primitives and boxes.

mod agrees_with_exact_arithmetic;
mod exact_triangle;
mod hits_primitive;
mod imitation;
mod overlaps_box;

pub use agrees_with_exact_arithmetic::AgreesWithExactArithmetic;
pub use hits_primitive::HitsPrimitive;
#[cfg(test)]
pub(in crate::checks) use imitation::{Answer, intersection};
pub use overlaps_box::OverlapsBox;
