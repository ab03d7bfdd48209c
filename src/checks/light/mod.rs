//! Lights, sampled from a point.

mod light_samples_reach_light;

pub use light_samples_reach_light::LightSamplesReachLight;
