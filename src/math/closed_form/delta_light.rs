//! Lambertian surfaces under delta lights: no noise at all.

use std::f64::consts::PI;

/// Radiance of a plane under an isotropic point light of this intensity (W·sr⁻¹) at `height` above
/// it, seen at `distance` from its foot: ρ/π · I cos θ / d².
pub(crate) fn point_light(intensity: f64, albedo: f64, height: f64, distance: f64) -> f64 {
    let squared = height * height + distance * distance;
    albedo / PI * intensity * height / (squared * squared.sqrt())
}

/// Radiance of a plane under a directional light of this irradiance at normal incidence: ρ/π · E
/// cos θ.
pub(crate) fn directional_light(irradiance: f64, albedo: f64, cos_theta: f64) -> f64 {
    albedo / PI * irradiance * cos_theta.max(0.0)
}

#[cfg(test)]
mod tests {
    use super::super::configuration_factor::sphere;
    use super::super::witness::assert_close;
    use super::*;

    /// A small sphere of radiance 1 has intensity πr².
    #[test]
    fn a_point_light_is_the_limit_of_a_small_sphere() {
        let (radius, height, distance) = (1e-3, 1.5, 0.9);
        let from_sphere =
            sphere(radius, f64::hypot(height, distance), f64::atan2(distance, height));
        let intensity = PI * radius * radius;
        assert_close(point_light(intensity, 0.37, height, distance), 0.37 * from_sphere, 1e-9);
    }
}
