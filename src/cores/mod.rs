//! Renderer cores: who keeps the promise of [`crate::contract`]. Two of our own, written independently.

pub mod builtin;
pub mod textbook;
