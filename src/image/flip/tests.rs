//! Against the numbers of NVIDIA's implementation, written by tests/fixtures/flip/make.py.

use super::*;
use crate::image::{Image, pfm};
use std::path::PathBuf;

/// How far a mean and any pixel may be from NVIDIA's.
const TOLERANCE: f64 = 1e-4;

/// An image from the formula of tests/fixtures/flip/make.py.
fn waves(width: usize, height: usize, shift: f64, level: f64) -> Image {
    Image::from_fn(width, height, |x, y| {
        let (x, y) = (x as f64, y as f64);
        let red = 0.5 + 0.4 * ((x + shift) / 3.0).sin() * (y / 5.0).cos();
        let green = 0.5 + 0.4 * ((x - y) / 4.0 + shift).cos();
        let blue = 0.3 + 0.2 * ((x + 2.0 * y) / 6.0).sin() + 0.02 * shift * (x % 5.0);
        [red, green, blue].map(|value| (level * value * value) as f32)
    })
}

const PIXELS: [[usize; 2]; 4] = [[0, 0], [11, 7], [20, 16], [22, 3]];

#[test]
fn it_is_the_number_of_nvidia() {
    let dim = (0.108336, [0.048865, 0.140711, 0.140448, 0.132537]);
    let clipped = (0.441682, [0.182567, 0.569366, 0.567277, 0.563280]);
    let bright = (0.196304, [0.078480, 0.181532, 0.173275, 0.218941]);
    let flip_of_waves = |map: fn(&Pair<'_>) -> Plane, size: [usize; 2], shift, level| {
        let [image, reference] = [shift, 0.0].map(|shift| waves(size[0], size[1], shift, level));
        map(&Pair::new(&image, &reference).unwrap())
    };
    for (found, (of_mean, of_pixels)) in [
        (flip_of_waves(flip, [40, 30], 0.05, 1.0), dim),
        (flip_of_waves(flip, [23, 17], 0.3, 1.4), clipped),
        (flip_of_waves(high_dynamic_range_flip, [40, 30], 0.1, 30.0), bright),
    ] {
        assert!((mean(&found) - of_mean).abs() < TOLERANCE, "mean {}, {of_mean}", mean(&found));
        for ([x, y], expected) in PIXELS.into_iter().zip(of_pixels) {
            let error = f64::from(found.row(y)[x]);
            assert!((error - expected).abs() < TOLERANCE, "({x}, {y}): {error}, {expected}");
        }
    }
}

#[test]
fn a_nan_pixel_is_the_largest_error_and_spoils_no_other() {
    let reference = waves(32, 32, 0.0, 1.0);
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let mut image = reference.clone();
        image.pixels[16 * 32 + 16][1] = bad;
        for map in [flip, high_dynamic_range_flip] {
            for (a, b) in [(&image, &reference), (&reference, &image)] {
                let found = map(&Pair::new(a, b).unwrap());
                assert_eq!(found.row(16)[16], 1.0);
                assert!(found.values.iter().all(|error| error.is_finite()));
                assert!(found.row(0)[0] < 1e-4, "{}", found.row(0)[0]);
            }
        }
    }
}

#[test]
fn equal_pictures_look_equal_and_black_against_white_does_not() {
    let picture = waves(20, 10, 0.0, 5.0);
    let pair = Pair::new(&picture, &picture).unwrap();
    assert_eq!((mean(&flip(&pair)), mean(&high_dynamic_range_flip(&pair))), (0.0, 0.0));
    let [black, white] = [0.0, 1.0].map(|level| Image::new(20, 10, [level; 3]));
    assert!(mean(&flip(&Pair::new(&black, &white).unwrap())) > 0.9);
}

#[test]
#[ignore = "needs flip-evaluator: python tests/fixtures/flip/make.py DIR, then FURNACE_FLIP_PAIRS=DIR"]
fn every_pixel_of_twenty_pairs_is_that_of_nvidia() {
    let folder = PathBuf::from(std::env::var_os("FURNACE_FLIP_PAIRS").unwrap());
    for kind in ["LDR", "HDR"] {
        let map = if kind == "LDR" { flip } else { high_dynamic_range_flip };
        for number in 0..10 {
            let read = |name| pfm::read(&folder.join(format!("{kind}-{number}.{name}.pfm")));
            let [image, reference, errors] =
                ["image", "reference", "errors"].map(|name| read(name).unwrap());
            let found = map(&Pair::new(&image, &reference).unwrap());
            let difference = |(found, expected): (&f32, &[f32; 3])| (found - expected[0]).abs();
            let pixels = found.values.iter().zip(&errors.pixels);
            let worst = pixels.map(difference).fold(0.0, f32::max);
            let expected = errors.pixels.iter().map(|pixel| f64::from(pixel[0])).sum::<f64>();
            let of_mean = (mean(&found) - expected / errors.pixels.len() as f64).abs();
            println!("{kind} {number}: mean off by {of_mean:.1e}, worst pixel by {worst:.1e}");
            assert!(of_mean < TOLERANCE && f64::from(worst) < TOLERANCE);
        }
    }
}
