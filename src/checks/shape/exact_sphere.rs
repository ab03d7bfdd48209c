//! Spheres and rays in general position, near and far, and where they meet in exact arithmetic.
//!
//! In rationals, with a square root of sixty digits: no rounding takes part in what is right. The
//! numbers themselves are such that the core holds them without rounding.

use crate::contract::{Precision, Primitive, Ray};
use crate::math::rng::{Stream, uniform};
use crate::math::sphere::on_sphere;
use crate::stats::Tolerance;
use glam::DVec3;
use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive, Zero};
use serde::Deserialize;

/// Binary digits of a square root behind the point.
const ROOT_DIGITS: usize = 200;
/// Rays pass within this many radii of the centre: one in six goes past.
const REACH: f64 = 1.2;

/// A sphere, a ray, and what has to come out of them; all lengths are the world's.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Encounter {
    pub(crate) centre: DVec3,
    /// Its direction has any length.
    pub(crate) ray: Ray,
    /// t and the outward normal; `None` for a miss.
    pub(crate) hit: Option<(f64, DVec3)>,
    /// From the ray's origin to the centre.
    far: f64,
    pub(crate) radius: f64,
    /// Of the ray from the centre.
    offset: f64,
    /// Half the way through the sphere; 0 past it.
    half_chord: f64,
}

impl Encounter {
    /// A random one whose origin is this many radii from the centre.
    pub(crate) fn random(distance: f64, precision: Precision, stream: &mut Stream) -> Self {
        let held = |vector: DVec3| match precision {
            Precision::Single => vector.as_vec3().as_dvec3(),
            Precision::Double => vector,
        };
        let held_number = |number: f64| held(DVec3::splat(number)).x;
        let radius = held_number(2f64.powf(20.0 * uniform(stream) - 10.0));
        let centre = held(8.0 * radius * uniform(stream) * on_sphere(stream));
        let place = if distance < 1.0 { uniform(stream).cbrt() } else { distance };
        let origin = held(centre + place * radius * on_sphere(stream));
        let across = (origin - centre).cross(on_sphere(stream)).normalize_or(DVec3::X);
        let passing = centre + REACH * radius * uniform(stream) * across;
        let target = if distance < 1.0 { origin + on_sphere(stream) } else { passing };
        let length = 2f64.powf(6.0 * uniform(stream) - 3.0);
        let direction = held(length * (target - origin).normalize_or(DVec3::Z));
        let ray = Ray::new(origin, direction);
        // Every fourth ray begins between the roots where they lie ahead, every eighth behind both.
        let t_min = match (uniform(stream) * 8.0) as u32 {
            0 | 1 => {
                held_number((centre - origin).dot(direction) / direction.length_squared()).max(0.0)
            }
            2 => held_number((distance + 2.0) * radius / length),
            _ => 0.0,
        };
        Self::of(centre, radius, Ray { t_min, ..ray })
    }

    fn of(centre: DVec3, radius: f64, ray: Ray) -> Self {
        let exact = |vector: DVec3| vector.to_array().map(rational);
        let dot = |a: &[BigRational; 3], b: &[BigRational; 3]| {
            a.iter().zip(b).map(|(a, b)| a * b).fold(BigRational::zero(), |sum, term| sum + term)
        };
        let direction = exact(ray.direction);
        let (origin, middle) = (exact(ray.origin), exact(centre));
        let from_centre: [_; 3] = std::array::from_fn(|axis| &origin[axis] - &middle[axis]);
        let squared_radius = rational(radius) * rational(radius);
        let a = dot(&direction, &direction);
        let half_b = dot(&from_centre, &direction);
        let squared_far = dot(&from_centre, &from_centre);
        let squared_half = (&half_b * &half_b / &a - &squared_far + &squared_radius) / &a;
        let squared_offset = &squared_far - &half_b * &half_b / &a;
        let root = |number: &BigRational| number.to_f64().unwrap_or(f64::NAN).max(0.0).sqrt();
        let mut encounter = Self {
            centre,
            ray,
            hit: None,
            far: root(&squared_far),
            radius,
            offset: root(&squared_offset),
            half_chord: root(&(&squared_half * &a)),
        };
        if squared_half.is_positive() {
            let half = square_root(&squared_half);
            let roots = [-&half_b / &a - &half, -&half_b / &a + &half];
            let t_min = rational(ray.t_min);
            encounter.hit = roots.into_iter().find(|t| *t > t_min).map(|t| {
                let normal = std::array::from_fn(|axis| {
                    let out = &from_centre[axis] + &t * &direction[axis];
                    out.to_f64().unwrap_or(f64::NAN) / radius
                });
                (t.to_f64().unwrap_or(f64::NAN), DVec3::from_array(normal))
            });
        }
        encounter
    }

    pub(crate) const fn primitive(&self) -> Primitive {
        Primitive::Sphere { centre: self.centre, radius: self.radius }
    }

    /// Whether no rounding of the formula decides between a hit and a miss, or between two hits.
    pub(crate) fn is_clear(&self, formula: Formula, precision: Precision) -> bool {
        let rounding = self.rounding(formula, precision);
        let grazes = (self.radius - self.offset).abs();
        let room = if self.half_chord > 0.0 { grazes.min(self.half_chord) } else { grazes };
        let length = self.ray.direction.length();
        let middle = -(self.ray.origin - self.centre).dot(self.ray.direction) / length;
        let ends = [middle - self.half_chord, middle + self.half_chord]
            .map(|root| (root - self.ray.t_min * length).abs());
        rounding < 0.1 * room
            && ends.iter().all(|end| self.half_chord == 0.0 || rounding < 0.1 * end)
    }

    /// What the formula's roundings amount to, in the world.
    fn rounding(&self, formula: Formula, precision: Precision) -> f64 {
        let magnified = match formula {
            Formula::Quadratic => (self.far / self.radius).max(1.0),
            Formula::Stable => 1.0,
        };
        Tolerance::ROUNDINGS.of(precision) * magnified * (self.far + self.radius)
    }

    /// How far t may be off: roundings, more where the ray grazes, over the length of the direction.
    pub(crate) fn allowed(&self, formula: Formula, precision: Precision) -> f64 {
        let slant = 1.0 + self.offset / self.half_chord;
        self.rounding(formula, precision) * slant / self.ray.direction.length()
    }

    /// How far the normal may be off: as t is, and as the hit point is rounded.
    pub(crate) fn allowed_normal(&self, formula: Formula, precision: Precision) -> f64 {
        let along = self.allowed(formula, precision) * self.ray.direction.length();
        let place = Tolerance::ROUNDINGS.of(precision) * self.ray.origin.length();
        Tolerance::DIRECTION.of(precision) + (along + place) / self.radius
    }
}

/// How a sphere's discriminant is formed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Formula {
    /// b² − 4ac, with the square of the distance in b and in c: rounding grows with it.
    Quadratic,
    /// r² − |l|², with l the offset of the ray from the centre.
    Stable,
}

/// A finite number; 0 for others.
fn rational(number: f64) -> BigRational {
    BigRational::from_float(number).unwrap_or_else(BigRational::zero)
}

/// Of a positive number, rounded down at [`ROOT_DIGITS`] binary digits.
fn square_root(number: &BigRational) -> BigRational {
    // √(p/q) = √(pq)/q
    let product = (number.numer() * number.denom()) << (2 * ROOT_DIGITS);
    BigRational::new(product.sqrt(), number.denom() << ROOT_DIGITS)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rng::Seed;

    #[test]
    fn a_square_root_is_one() {
        let two = rational(2.0);
        let error = &square_root(&two) * &square_root(&two) - &two;
        assert!(error.to_f64().unwrap().abs() < 1e-50);
        assert_eq!(square_root(&rational(0.0625)), rational(0.25));
    }

    #[test]
    fn a_meeting_by_hand_is_exact() {
        let ray = Ray::new(DVec3::new(-4.0, 3.2, 3.0), DVec3::new(2.0, 0.0, 0.0));
        let encounter = Encounter::of(DVec3::new(1.0, 2.0, 3.0), 2.0, ray);
        let (t, normal) = encounter.hit.unwrap();
        assert!((t - 1.7).abs() < 1e-15);
        assert!(normal.distance(DVec3::new(-0.8, 0.6, 0.0)) < 1e-15);
        assert!((encounter.offset - 1.2).abs() < 1e-15);
        assert!((encounter.half_chord - 1.6).abs() < 1e-15);
        let behind = Encounter::of(DVec3::new(-9.0, 3.0, 3.0), 2.0, ray);
        assert_eq!(behind.hit, None);
    }

    #[test]
    fn most_encounters_are_clear_and_of_every_kind() {
        let stream = &mut Seed(1).stream();
        for distance in [0.0, 1.5, 1e2, 1e4] {
            let random = |_| Encounter::random(distance, Precision::Single, stream);
            let encounters: Vec<_> = (0..200).map(random).collect();
            let hits = encounters.iter().filter(|encounter| encounter.hit.is_some()).count();
            assert!((100..200).contains(&hits), "{distance}: {hits}");
            for Encounter { centre, radius, ray, hit, .. } in encounters {
                let numbers = DVec3::new(radius, ray.t_min, 0.0);
                for vector in [ray.origin, ray.direction, centre, numbers] {
                    assert_eq!(vector.as_vec3().as_dvec3(), vector);
                }
                assert!(hit.is_none_or(|(_, normal)| (normal.length() - 1.0).abs() < 1e-9));
            }
        }
    }
}
