//! BSDFs, without any scene.

mod agrees_with_itself;
pub(in crate::checks) mod albedo;
mod conserves_energy;
mod drawn;
#[cfg(test)]
mod fake;
mod follows_ggx;
pub(super) mod ggx_pair;
mod interface;
mod reciprocal;
mod reflects_and_refracts;
pub(super) mod rough_glass;
mod smooth_trial;
mod smooth_view;
pub(super) mod terms;
mod weights_make_the_albedo;
mod wrong_value;

use super::checks;

checks! {
    agrees_with_itself::AgreesWithItself,
    reciprocal::Reciprocal,
    conserves_energy::ConservesEnergy,
    weights_make_the_albedo::WeightsMakeTheAlbedo,
    follows_ggx::FollowsGgx,
    reflects_and_refracts::ReflectsAndRefracts,
}
