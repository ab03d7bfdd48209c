//! Lambertian surfaces under lights without extent: no noise at all.

use std::f64::consts::PI;

/// Radiance of a plane under an isotropic point light of this intensity (W·sr⁻¹) at `height` above
/// it, seen at `distance` from its foot: ρ/π · I cos θ / d².
pub fn point_light(intensity: f64, albedo: f64, height: f64, distance: f64) -> f64 {
    let squared = height * height + distance * distance;
    albedo / PI * intensity * height / (squared * squared.sqrt())
}

/// Radiance of a plane under a directional light of this irradiance at normal incidence: ρ/π · E
/// cos θ.
pub fn directional_light(irradiance: f64, albedo: f64, cos_theta: f64) -> f64 {
    albedo / PI * irradiance * cos_theta.max(0.0)
}

#[cfg(test)]
mod tests {
    use super::super::configuration_factor::disk_offset;
    use super::super::witness::assert_close;
    use super::*;

    #[test]
    fn the_values_are_those_of_the_table() {
        assert_close(point_light(2.0, 0.37, 1.5, 0.9), 0.066_007_148, 1e-8);
        assert_close(directional_light(2.0, 0.37, 40f64.to_radians().cos()), 0.180_441_2, 1e-6);
        assert_eq!(directional_light(2.0, 0.37, -0.1), 0.0);
    }

    /// A sphere's factor would do as well; a small disk facing down has intensity L A cos θ.
    #[test]
    fn a_point_light_is_the_limit_of_a_small_disk() {
        let (radius, height, distance) = (1e-3, 1.5, 0.9);
        let cos_at_light = height / f64::hypot(height, distance);
        let intensity = PI * radius * radius * cos_at_light;
        let from_disk = 0.37 * disk_offset(radius, height, distance);
        assert_close(point_light(intensity, 0.37, height, distance), from_disk, 1e-6);
    }
}
