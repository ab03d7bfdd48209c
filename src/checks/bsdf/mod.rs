//! BSDFs, without any scene.

mod agrees_with_itself;
pub(in crate::checks) mod albedo;
mod conserves_energy;
#[cfg(test)]
mod fake;
mod follows_ggx;
mod interface;
pub(super) mod metal;
mod reciprocal;
mod reflects_and_refracts;
pub(super) mod rough_glass;
mod smooth_view;
mod weights_make_the_albedo;

pub use agrees_with_itself::AgreesWithItself;
pub use conserves_energy::ConservesEnergy;
pub use follows_ggx::FollowsGgx;
pub use reciprocal::Reciprocal;
pub use reflects_and_refracts::ReflectsAndRefracts;
pub use weights_make_the_albedo::WeightsMakeTheAlbedo;
