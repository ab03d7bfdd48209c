//! Fresnel reflectance and refraction at smooth dielectric interfaces. `eta` is the relative index of
//! refraction eta_t / eta_i.

/// Unpolarised reflectance (Fresnel 1823); 1 under total internal reflection.
pub(crate) fn reflectance(cos_incident: f64, eta: f64) -> f64 {
    let [perpendicular, parallel] = amplitudes(cos_incident, eta);
    0.5 * (perpendicular * perpendicular + parallel * parallel)
}

/// The amplitudes that are reflected of light polarised across the plane of incidence and along it; 1 under total internal
/// reflection, but for a phase.
pub(crate) fn amplitudes(cos_incident: f64, eta: f64) -> [f64; 2] {
    let sine_squared = (1.0 - cos_incident * cos_incident) / (eta * eta);
    if sine_squared >= 1.0 {
        return [1.0; 2];
    }
    let cos_refracted = (1.0 - sine_squared).sqrt();
    [
        (cos_incident - eta * cos_refracted) / (cos_incident + eta * cos_refracted),
        (eta * cos_incident - cos_refracted) / (eta * cos_incident + cos_refracted),
    ]
}

/// Schlick's approximation (1994): R₀ + (1 − R₀)(1 − cos θ)⁵ with the cosine on the side of lower index; 1
/// under total internal reflection.
pub(crate) fn schlick(cos_incident: f64, eta: f64) -> f64 {
    let sine_squared = (1.0 - cos_incident * cos_incident) / (eta * eta);
    if sine_squared >= 1.0 {
        return 1.0;
    }
    schlick_at(if eta < 1.0 { (1.0 - sine_squared).sqrt() } else { cos_incident }, eta)
}

/// The same with the cosine at hand on either side, as courses teach it: no longer the same both
/// ways through a face.
pub(crate) fn schlick_of_view(cos_incident: f64, eta: f64) -> f64 {
    if reflectance(cos_incident, eta) == 1.0 {
        return 1.0;
    }
    schlick_at(cos_incident, eta)
}

fn schlick_at(cosine: f64, eta: f64) -> f64 {
    let at_normal = ((eta - 1.0) / (eta + 1.0)).powi(2);
    at_normal + (1.0 - at_normal) * (1.0 - cosine).powi(5)
}

/// What a clear parallel slab transmits, all internal reflections included, of faces that reflect
/// so much from outside and from inside: (1 − Fₒ) (1 − Fᵢ) Σ Fᵢ²ᵏ = (1 − Fₒ)/(1 + Fᵢ).
#[cfg(test)]
pub(crate) fn slab_transmittance(outside: f64, inside: f64) -> f64 {
    (1.0 - outside) / (1.0 + inside)
}

/// Radiance of a clear sphere in surroundings of radiance 1, if paths end after `segments` segments
/// inside: all but what is still inside. Every reflection inside a sphere meets it at the same
/// angle.
#[cfg(test)]
pub(crate) fn sphere_in_furnace(outside: f64, inside: f64, segments: u32) -> f64 {
    1.0 - (0..segments).fold(1.0 - outside, |left, _| left * inside)
}

#[cfg(test)]
mod tests {
    use super::super::witness::assert_close;
    use super::*;

    const GLASS: f64 = 1.5;

    #[test]
    fn reflectance_is_that_of_the_table_and_the_same_from_both_sides() {
        let at_60 = reflectance(60f64.to_radians().cos(), GLASS);
        assert_close(reflectance(1.0, GLASS), 0.04, 1e-12);
        assert_close(at_60, 0.089_186_712_8, 1e-9);
        let inside = (60f64.to_radians().sin() / GLASS).asin().cos();
        assert_close(reflectance(inside, GLASS.recip()), at_60, 1e-12);
        assert_eq!(reflectance(41f64.to_radians().sin(), GLASS.recip()), 1.0);
    }

    #[test]
    fn nothing_parallel_is_reflected_at_brewsters_angle() {
        let brewster = GLASS.atan();
        // Then reflected and refracted rays are at right angles, and R = sin²(θi − θt)/2.
        let refracted = (brewster.sin() / GLASS).asin();
        let expected = 0.5 * (brewster - refracted).sin().powi(2);
        assert_close(reflectance(brewster.cos(), GLASS), expected, 1e-12);
    }

    #[test]
    fn schlick_is_exact_at_both_ends() {
        for eta in [GLASS, GLASS.recip()] {
            assert_close(schlick(1.0, eta), reflectance(1.0, eta), 1e-12);
        }
        assert_close(schlick(0.0, GLASS), 1.0, 1e-12);
        assert_eq!(schlick(0.5, GLASS.recip()), 1.0);
    }

    #[test]
    fn slabs_and_spheres_are_series_of_reflections() {
        let (outside, inside) = (0.07f64, 0.1f64);
        let enters = (1.0 - outside) * (1.0 - inside);
        let through: f64 = (0..60).map(|k| enters * inside.powi(2 * k)).sum();
        assert_close(slab_transmittance(outside, inside), through, 1e-12);
        let escapes = |segment: i32| enters * inside.powi(segment);
        for segments in 0..6u32 {
            let left = outside + (0..segments.cast_signed()).map(escapes).sum::<f64>();
            assert_close(sphere_in_furnace(outside, inside, segments), left, 1e-12);
        }
    }

    #[test]
    fn the_two_forms_of_schlick_agree_outside_and_part_inside() {
        let cosine = 60f64.to_radians().cos();
        assert_close(schlick_of_view(cosine, GLASS), schlick(cosine, GLASS), 1e-15);
        // 0.04 + 0.96 (1 - cos 35°)⁵, and with the cosine of 59.36° outside.
        let inside = 35f64.to_radians().cos();
        assert_close(schlick_of_view(inside, GLASS.recip()), 0.040_185_7, 1e-5);
        assert_close(schlick(inside, GLASS.recip()), 0.067_206_6, 1e-5);
        assert_eq!(schlick_of_view(50f64.to_radians().cos(), GLASS.recip()), 1.0);
    }
}
