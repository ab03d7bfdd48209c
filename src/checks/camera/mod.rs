//! From film points to rays.

mod projection;
mod rays_through_film;

pub use rays_through_film::RaysThroughFilm;
