//! BSDFs, without any scene.

mod agrees_with_itself;
mod conserves_energy;
#[cfg(test)]
mod fake;
mod reciprocal;

pub use agrees_with_itself::AgreesWithItself;
pub use conserves_energy::ConservesEnergy;
pub use reciprocal::Reciprocal;
