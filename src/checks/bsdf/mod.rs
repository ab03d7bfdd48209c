//! BSDFs, without any scene.

mod agrees_with_itself;
mod conserves_energy;
#[cfg(test)]
mod fake;
mod interface;
pub(super) mod metal;
mod reciprocal;
mod reflects_and_refracts;
mod smooth_view;

pub use agrees_with_itself::AgreesWithItself;
pub use conserves_energy::ConservesEnergy;
pub use reciprocal::Reciprocal;
pub use reflects_and_refracts::ReflectsAndRefracts;
