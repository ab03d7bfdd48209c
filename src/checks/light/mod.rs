//! Lights, sampled from a point or seen at work.

mod delta_samples;
mod density;
mod lamp_at_the_eye;
mod light_numbers;
mod light_samples_reach_light;
mod open_light_samples;
mod seen_points;
mod traced;

use super::CheckKind;

/// The checks of this subject.
pub(crate) static CHECKS: &[CheckKind] = &[
    CheckKind::of::<light_samples_reach_light::LightSamplesReachLight>(),
    CheckKind::of::<light_numbers::LightNumbers>(),
    CheckKind::of::<open_light_samples::OpenLightSamples>(),
    CheckKind::of::<lamp_at_the_eye::LampAtTheEye>(),
];
