//! Wavefront OBJ, and MTL.

mod read;
mod write;

pub use read::read;
pub use write::export;
