//! Lights, sampled from a point or seen at work.

mod density;
mod lamp_at_the_eye;
mod light_numbers;
mod light_samples_reach_light;
mod open_light_samples;

pub use lamp_at_the_eye::LampAtTheEye;
pub use light_numbers::LightNumbers;
pub use light_samples_reach_light::LightSamplesReachLight;
pub use open_light_samples::OpenLightSamples;
