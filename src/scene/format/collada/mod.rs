//! The course's COLLADA: files with its CGL profile, as the course's own program understands them.

mod read;
mod write;

pub use read::load;
pub(crate) use read::{FILM, load_camera};
pub(super) use write::export;
