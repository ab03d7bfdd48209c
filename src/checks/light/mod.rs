//! Lights, sampled from a point.

mod density;
mod light_samples_reach_light;
mod open_light_samples;

pub use light_samples_reach_light::LightSamplesReachLight;
pub use open_light_samples::OpenLightSamples;
