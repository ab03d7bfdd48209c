//! Whole paths against numbers that were worked out by hand: the closed forms S01 to S24 of the
//! catalogue of checks.
//!
//! Scenes, values and their sources (Howell's catalogue of configuration factors, Lambert's
//! formula, series) are the catalogue's; here they only show that this core can be believed.

mod direct;
mod paths;
