//! From film points to rays.

mod projection;
mod rays_through_film;

pub(in crate::checks) use projection::projection;
pub use rays_through_film::RaysThroughFilm;
