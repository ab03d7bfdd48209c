//! What becomes of the film on its way into directions, as a linear map: `(x, y) is taken for (0.8 x, -y)`.
//!
//! Told where no mistake that is known gives the rays.

use super::shots::Shot;
use crate::scene::Camera;
use crate::text::number::figure;
use glam::{DMat3, DVec2, DVec3};

/// How well the map gives each point, in halves of the sensor.
const FIT: f64 = 1e-4;
/// A smaller coefficient is none.
const NONE: f64 = 1e-3;

/// Nothing is wrong with it.
const RIGHT: &str = "(x, y)";

/// The map, from -1 to 1 on either axis with the centre at (0, 0); the same for all cameras, or one for each.
pub(super) fn laws(shots: &[Shot], film: &[DVec2]) -> Vec<String> {
    let of_shots: Vec<_> = shots.iter().filter_map(|shot| map(shot, film)).collect();
    let Some(first) = of_shots.first().filter(|_| of_shots.len() == shots.len()) else {
        return Vec::new();
    };
    let told = |map: &str, of: &str| {
        format!("the point (x, y) of the film{of}, each from -1 to 1, is taken for {map}")
    };
    match of_shots.iter().all(|map| map == first) {
        true if first == RIGHT => Vec::new(),
        true => vec![told(first, "")],
        false => {
            let of_shot =
                |(number, map): (usize, &String)| told(map, &format!(" of camera {}", number + 1));
            of_shots.iter().enumerate().map(of_shot).collect()
        }
    }
}

fn map(shot: &Shot, film: &[DVec2]) -> Option<String> {
    let right: Vec<_> = film.iter().map(|point| 2.0 * *point - 1.0).collect();
    let taken = shot.rays.iter().map(|ray| taken_for(&shot.camera, ray.direction));
    let taken = taken.collect::<Option<Vec<_>>>()?;
    let coordinate = |axis: usize| {
        let values: Vec<_> = taken.iter().map(|point| point[axis]).collect();
        in_words(fitted(&right, &values)?)
    };
    Some(format!("({}, {})", coordinate(0)?, coordinate(1)?))
}

/// The point of the sensor through which a ray goes; none where it leaves backwards.
fn taken_for(camera: &Camera, direction: DVec3) -> Option<DVec2> {
    let local = camera.camera_to_world.transpose() * direction;
    let half = DVec2::new(camera.horizontal_fov, camera.vertical_fov).map(|fov| (fov / 2.0).tan());
    (local.z < 0.0).then(|| local.truncate() / -local.z / half)
}

/// a, b and c, if a x + b y + c is each of these values at its point.
fn fitted(points: &[DVec2], values: &[f64]) -> Option<DVec3> {
    let rows = || points.iter().map(|point| point.extend(1.0));
    let squares = rows().fold(DMat3::ZERO, |sum, row| sum + outer(row));
    let products = rows().zip(values).map(|(row, value)| *value * row).sum::<DVec3>();
    let map = squares.inverse() * products;
    rows().zip(values).all(|(row, value)| (map.dot(row) - value).abs() <= FIT).then_some(map)
}

fn outer(row: DVec3) -> DMat3 {
    DMat3::from_cols(row * row.x, row * row.y, row * row.z)
}

/// `0.8 x + 0.1`. None where all three have a part: it is turned, or worse.
fn in_words(map: DVec3) -> Option<String> {
    let terms = map.to_array().into_iter().zip(["x", "y", ""]);
    let terms: Vec<_> = terms.filter(|(factor, _)| factor.abs() > NONE).collect();
    let mut words = String::new();
    for (factor, name) in &terms {
        let size = factor.abs();
        let size = match (*name, (size - 1.0).abs() <= NONE) {
            ("", _) => figure(size),
            (name, true) => name.to_owned(),
            (name, false) => format!("{} {name}", figure(size)),
        };
        let sign = match (words.is_empty(), *factor < 0.0) {
            (true, false) => "",
            (true, true) => "-",
            (false, false) => " + ",
            (false, true) => " - ",
        };
        words += sign;
        words += &size;
    }
    match terms.len() {
        0 => Some("0".to_owned()),
        1 | 2 => Some(words),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::super::projection::projection;
    use super::*;
    use crate::contract::Ray;
    use crate::math::rng::{Seed, in_square};

    type Taken = fn(DVec2) -> DVec2;

    fn laws_of(film_of: Taken) -> Vec<String> {
        let mut stream = Seed(1).stream();
        let film: Vec<_> = (0..20).map(|_| in_square(&mut stream)).collect();
        let camera =
            Camera::look_at(DVec3::ZERO, DVec3::new(1.0, 2.0, 3.0), DVec3::Y, 1.0, [480, 360]);
        let ray =
            |film: &DVec2| Ray::new(DVec3::ZERO, projection(&camera, film_of(*film)).normalize());
        let rays = film.iter().map(ray).collect();
        laws(&[Shot { camera, rays }], &film)
    }

    #[test]
    fn a_film_that_is_scaled_moved_or_mirrored_says_so() {
        let told: [(Taken, &str); 3] = [
            (|film| DVec2::new(0.5 + 0.8 * (film.x - 0.5), film.y), "(0.8 x, y)"),
            (|film| DVec2::new(1.0 - film.y, film.x + 0.05), "(-y, x + 0.1)"),
            (|film| DVec2::new(film.x, 0.5), "(x, 0)"),
        ];
        for (film, map) in told {
            let [law] = &laws_of(film)[..] else { panic!("no law") };
            assert!(law.ends_with(map), "{law}");
        }
        assert!(laws_of(|film| film * film).is_empty());
        assert!(laws_of(|film| film).is_empty());
    }
}
