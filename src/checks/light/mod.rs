//! Lights, sampled from a point or seen at work.

mod delta_samples;
mod density;
mod lamp_at_the_eye;
mod light_numbers;
mod light_samples_reach_light;
mod open_light_samples;
mod seen_points;
mod traced;

use super::checks;

checks! {
    light_samples_reach_light::LightSamplesReachLight,
    light_numbers::LightNumbers,
    open_light_samples::OpenLightSamples,
    lamp_at_the_eye::LampAtTheEye,
}
