//! Lights, sampled from a point.

mod density;
mod light_samples_reach_light;

pub use light_samples_reach_light::LightSamplesReachLight;
