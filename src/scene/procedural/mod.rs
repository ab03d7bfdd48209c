//! Meshes from a number: any size, no file, the same on every machine.
//!
//! Every function gives a flat mesh in its own coordinates with material 0; scene files place it,
//! benches take it as it is. Y is up where there is an up.

mod builder;
mod pathological;
mod polyhedron;
mod sphere;
mod sphereflake;
mod teapot;

pub(crate) use pathological::pathological;
pub use pathological::{Layout, soup};
pub(crate) use polyhedron::{block, parallelogram};
pub(crate) use sphere::{bumpy_sphere, icosphere};
pub use sphereflake::sphereflake;
pub(crate) use sphereflake::sphereflake_spheres;
pub use teapot::teapot;
