//! Reflection and refraction at smooth dielectric interfaces. `eta` is the index beyond over the
//! index before.

/// Unpolarised reflectance (Fresnel 1823); 1 under total internal reflection.
pub fn reflectance(cos_incident: f64, eta: f64) -> f64 {
    let sine_squared = (1.0 - cos_incident * cos_incident) / (eta * eta);
    if sine_squared >= 1.0 {
        return 1.0;
    }
    let cos_refracted = (1.0 - sine_squared).sqrt();
    let perpendicular = (cos_incident - eta * cos_refracted) / (cos_incident + eta * cos_refracted);
    let parallel = (eta * cos_incident - cos_refracted) / (eta * cos_incident + cos_refracted);
    0.5 * (perpendicular * perpendicular + parallel * parallel)
}

/// Schlick's approximation (1994): R₀ + (1 − R₀)(1 − cos θ)⁵ with the cosine on the thin side; 1
/// under total internal reflection.
pub fn schlick(cos_incident: f64, eta: f64) -> f64 {
    let at_normal = ((eta - 1.0) / (eta + 1.0)).powi(2);
    let sine_squared = (1.0 - cos_incident * cos_incident) / (eta * eta);
    if sine_squared >= 1.0 {
        return 1.0;
    }
    let cosine = if eta < 1.0 { (1.0 - sine_squared).sqrt() } else { cos_incident };
    at_normal + (1.0 - at_normal) * (1.0 - cosine).powi(5)
}

/// The same with the cosine at hand on either side, as courses teach it: no longer the same both
/// ways through a face.
pub fn schlick_of_view(cos_incident: f64, eta: f64) -> f64 {
    if reflectance(cos_incident, eta) == 1.0 {
        return 1.0;
    }
    let at_normal = ((eta - 1.0) / (eta + 1.0)).powi(2);
    at_normal + (1.0 - at_normal) * (1.0 - cos_incident).powi(5)
}

/// What a clear parallel slab lets through, all internal reflections included, if each face
/// reflects `face`: (1 − F)² Σ F²ᵏ = (1 − F)/(1 + F).
pub fn slab_transmittance(face: f64) -> f64 {
    (1.0 - face) / (1.0 + face)
}

/// What it reflects.
pub fn slab_reflectance(face: f64) -> f64 {
    2.0 * face / (1.0 + face)
}

/// Radiance of a clear sphere in surroundings of radiance 1, if paths end after `segments` segments
/// inside: all but what is still inside. Every reflection inside a sphere meets it at the same
/// angle.
pub fn sphere_in_furnace(face: f64, segments: u32) -> f64 {
    let still_inside = (0..segments).fold(1.0 - face, |left, _| left * face);
    1.0 - still_inside
}

/// Radiance of an emitter inside a dielectric of index `eta` seen through one face: (1 − F) L / η².
/// Radiance over index squared is what refraction conserves.
pub fn embedded_emitter(cos_outside: f64, eta: f64, emission: f64) -> f64 {
    (1.0 - reflectance(cos_outside, eta)) * emission / (eta * eta)
}

/// Reflectance under uniform light from the thin side (Walsh 1926).
pub fn diffuse_external(n: f64) -> f64 {
    let n2 = n * n;
    let n4 = n2 * n2;
    0.5 + (n - 1.0) * (3.0 * n + 1.0) / (6.0 * (n + 1.0).powi(2))
        + n2 * (n2 - 1.0).powi(2) / (n2 + 1.0).powi(3) * ((n - 1.0) / (n + 1.0)).ln()
        - 2.0 * n2 * n * (n2 + 2.0 * n - 1.0) / ((n2 + 1.0) * (n4 - 1.0))
        + 8.0 * n4 * (n4 + 1.0) / ((n2 + 1.0) * (n4 - 1.0).powi(2)) * n.ln()
}

/// Reflectance under uniform light from the dense side: 1 − (1 − external)/n², by reciprocity.
pub fn diffuse_internal(n: f64) -> f64 {
    1.0 - (1.0 - diffuse_external(n)) / (n * n)
}

#[cfg(test)]
mod tests {
    use super::super::witness::assert_close;
    use super::*;
    use crate::math::quadrature::integrate;

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
    fn slabs_are_series_of_reflections() {
        for degrees in [0f64, 60.0] {
            let face = reflectance(degrees.to_radians().cos(), GLASS);
            let through: f64 = (0..60).map(|k| (1.0 - face).powi(2) * face.powi(2 * k)).sum();
            assert_close(slab_transmittance(face), through, 1e-12);
            assert_close(slab_transmittance(face) + slab_reflectance(face), 1.0, 1e-12);
        }
        let at = |degrees: f64| slab_transmittance(reflectance(degrees.to_radians().cos(), GLASS));
        assert_close(at(0.0), 0.923_076_923_1, 1e-9);
        assert_close(at(60.0), 0.836_232_462_7, 1e-9);
    }

    #[test]
    fn a_sphere_gives_back_what_has_left_it() {
        let face = 0.1f64;
        let escapes = |segment: i32| (1.0 - face).powi(2) * face.powi(segment);
        let left = |segments: u32| face + (0..segments as i32).map(escapes).sum::<f64>();
        for segments in 0..6 {
            assert_close(sphere_in_furnace(face, segments), left(segments), 1e-12);
        }
        assert_close(sphere_in_furnace(face, 3), 0.9991, 1e-9);
    }

    #[test]
    fn an_embedded_emitter_has_the_value_of_the_table() {
        assert_close(embedded_emitter(1.0, GLASS, 1.0), 0.426_666_666_7, 1e-9);
    }

    /// 2 ∫ F(μ) μ dμ, with a break where total reflection begins.
    fn diffuse_by_quadrature(eta: f64) -> f64 {
        let critical = (1.0 - eta * eta).max(0.0).sqrt();
        integrate(&[0.0, critical, 1.0], 1e-11, |mu| 2.0 * mu * reflectance(mu, eta)).value
    }

    #[test]
    fn diffuse_reflectances_agree_with_quadrature_and_the_table() {
        assert_close(diffuse_external(GLASS), diffuse_by_quadrature(GLASS), 1e-9);
        assert_close(diffuse_internal(GLASS), diffuse_by_quadrature(GLASS.recip()), 1e-8);
        assert_close(diffuse_external(GLASS), 0.091_777_959_34, 1e-9);
        assert_close(diffuse_internal(GLASS), 0.596_345_759_7, 1e-9);
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
