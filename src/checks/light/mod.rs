//! Lights, sampled from a point or seen at work.

mod area_pdf;
mod delta_samples;
mod light_numbers;
mod light_samples_reach_light;
mod no_self_shadowing;
mod open_light_samples;
mod seen_points;
mod traced;

use super::checks;

checks! {
    light_samples_reach_light::LightSamplesReachLight,
    light_numbers::LightNumbers,
    open_light_samples::OpenLightSamples,
    no_self_shadowing::NoSelfShadowing,
}
