//! Pictures of a formula, each with one mistake, are told which.

use super::*;
use crate::math::rng::{Seed, uniform};

const WIDTH: usize = 96;
const HEIGHT: usize = 72;

/// A floor with discs and stripes, as bright as 4 and as dark as 0.02.
fn colour(x: f64, y: f64) -> [f64; 3] {
    let disc = |cx: f64, cy: f64, r: f64| (x - cx).hypot(y - cy) < r;
    if disc(30.0, 25.0, 12.0) {
        [1.5, 0.4, 0.1 + 0.01 * y]
    } else if disc(70.0, 45.0, 15.0) {
        [0.05, 0.3 + 0.01 * x, 0.6]
    } else if disc(60.0, 12.0, 4.0) {
        [4.0, 3.5, 3.0]
    } else {
        let stripe = if (x + 0.5 * y).rem_euclid(24.0) < 9.0 { 0.5 } else { 1.0 };
        [0.3, 0.35, 0.25].map(|value| value * stripe * (1.0 - 0.006 * y))
    }
}

/// The formula as seen at `place` of every pixel, with the edges of pixels smoothed.
fn seen(width: usize, height: usize, place: impl Fn(f64, f64) -> [f64; 2]) -> Image {
    const SIDE: usize = 6;
    Image::from_fn(width, height, |x, y| {
        let mut sum = [0.0; 3];
        for sample in 0..SIDE * SIDE {
            let offset = |i: usize| (i as f64 + 0.5) / SIDE as f64;
            let (x, y) = (x as f64 + offset(sample % SIDE), y as f64 + offset(sample / SIDE));
            let [u, v] = place(x, y);
            sum.iter_mut().zip(colour(u, v)).for_each(|(sum, value)| *sum += value);
        }
        sum.map(|sum| (sum / (SIDE * SIDE) as f64) as f32)
    })
}

fn reference() -> Image {
    seen(WIDTH, HEIGHT, |x, y| [x, y])
}

/// The picture with noise of the relative deviation `amount`, skewed as light is.
fn noisy(image: &Image, amount: f64, seed: u64) -> Image {
    let mut stream = Seed(seed).stream();
    image.map(|pixel| {
        let gain = 1.0 + amount * (-(1.0 - uniform(&mut stream)).ln() - 1.0);
        pixel.map(|value| value * gain as f32)
    })
}

fn with(change: impl Fn([f32; 3]) -> [f32; 3]) -> Image {
    reference().map(change)
}

fn fits(image: &Image) -> Vec<Fit> {
    explain(image, &reference(), &Knowledge::default())
}

fn only(image: &Image) -> Fit {
    let fits = fits(image);
    assert_eq!(fits.len(), 1, "{fits:#?}");
    fits[0]
}

#[test]
fn a_displacement_is_found_to_a_hundredth_of_a_pixel() {
    for [right, down] in [[0.5, 0.5], [0.37, -1.2], [0.0, 1.0], [-0.25, 0.0], [3.0, -4.5]] {
        let image = seen(WIDTH, HEIGHT, |x, y| [x - right, y - down]);
        let noise = if right < -0.01 { 0.01 } else { 0.1 };
        let precision = [(image.clone(), 0.015), (noisy(&image, noise, 7), 0.06)];
        for (image, precision) in precision {
            let fits = fits(&image);
            let Misfit::Displaced { right: x, down: y } = fits[0].misfit else {
                panic!("{fits:#?}")
            };
            assert!((x.value - right).abs() < precision, "{right}, {x:?}");
            assert!((y.value - down).abs() < precision, "{down}, {y:?}");
            assert!(x.allows(right) && y.allows(down), "{x:?} {y:?}");
        }
    }
}

#[test]
fn a_magnification_is_found_with_its_displacement() {
    let (across, upright) = (1.03, 0.98);
    let (cx, cy) = (WIDTH as f64 / 2.0, HEIGHT as f64 / 2.0);
    let image = seen(WIDTH, HEIGHT, |x, y| [cx + (x - cx - 0.3) / across, cy + (y - cy) / upright]);
    let fits = fits(&noisy(&image, 0.05, 3));
    let Misfit::Magnified { across: a, upright: u, right, .. } = fits[0].misfit else {
        panic!("{fits:#?}")
    };
    assert!((a.value - across).abs() < 1e-3 && (u.value - upright).abs() < 1e-3, "{a:?} {u:?}");
    assert!((right.value - 0.3).abs() < 0.03, "{right:?}");
}

#[test]
fn every_symmetry_is_found() {
    let square = seen(80, 80, |x, y| [x, y]);
    for symmetry in Symmetry::ALL {
        let image = noisy(&symmetry.of(&square), 0.2, 5);
        let fits = explain(&image, &square, &Knowledge::default());
        assert_eq!(fits[0].misfit, Misfit::Turned(symmetry));
    }
}

#[test]
fn one_per_cent_too_bright_is_found_in_noise_and_measured() {
    let bright = with(|pixel| pixel.map(|value| 1.01 * value));
    for (image, tolerance) in [(bright.clone(), 1e-4), (noisy(&bright, 0.05, 2), 0.003)] {
        let found = fits(&image);
        // In noise, one per cent is little of the difference: not worth a name.
        if let Some(Fit { misfit: Misfit::Brighter(gain), .. }) = found.first() {
            assert!(gain.iter().all(|gain| (gain.value - 1.01).abs() < tolerance), "{gain:?}");
        } else {
            assert!(tolerance > 1e-3, "{found:#?}");
        }
    }
}

#[test]
fn channels_with_factors_of_their_own_are_told_apart() {
    let fit = only(&noisy(&with(|[r, g, b]| [1.2 * r, g, 0.7 * b]), 0.02, 4));
    let Misfit::Brighter(gain) = fit.misfit else { panic!("{fit:?}") };
    for (gain, expected) in gain.into_iter().zip([1.2, 1.0, 0.7]) {
        assert!((gain.value - expected).abs() < 0.005, "{gain:?}");
    }
}

#[test]
fn gamma_is_found_as_power_or_curve() {
    for exponent in [1.0 / 2.2, 2.2, 1.6, 0.7] {
        let fit = fits(&noisy(&with(|p| p.map(|v| v.powf(exponent))), 0.02, 6))[0];
        match fit.misfit {
            Misfit::Power(power) => {
                assert!((power.value - f64::from(exponent)).abs() < 0.01, "{power:?}");
            }
            // The curve of sRGB is nearly a power of 2.2.
            Misfit::EncodedTwice => assert_eq!(exponent, 1.0 / 2.2),
            Misfit::DecodedTwice => assert_eq!(exponent, 2.2),
            _ => panic!("{fit:?}"),
        }
    }
    let encode = |value: f32| match value {
        dark if dark <= 0.003_130_8 => 12.92 * dark,
        bright => 1.055 * bright.powf(1.0 / 2.4) - 0.055,
    };
    assert_eq!(only(&with(|p| p.map(encode))).misfit, Misfit::EncodedTwice);
}

#[test]
fn a_limit_is_found_where_pixels_should_be_brighter() {
    let fit = only(&with(|pixel| pixel.map(|value| value.min(1.0))));
    let Misfit::Clipped { level, pixels } = fit.misfit else { panic!("{fit:?}") };
    assert_eq!(level, 1.0);
    assert!((800..900).contains(&pixels), "{pixels}");
}

#[test]
fn alpha_once_too_often_is_found() {
    let values = (0..WIDTH * HEIGHT).map(|i| 0.3 + 0.7 * (i % 17) as f32 / 17.0).collect();
    let alpha = Plane { width: WIDTH, height: HEIGHT, values };
    let mut image = reference();
    image.pixels.iter_mut().zip(&alpha.values).for_each(|(p, a)| *p = p.map(|v| v * a));
    let knowledge = Knowledge { alpha: Some(&alpha), ..Default::default() };
    let found = explain(&image, &reference(), &knowledge);
    assert_eq!(found[0].misfit, Misfit::TimesAlpha);
    let found = explain(&reference(), &image, &knowledge);
    assert_eq!(found[0].misfit, Misfit::OverAlpha);
}

#[test]
fn two_mistakes_are_both_named() {
    let moved = seen(WIDTH, HEIGHT, |x, y| [x - 1.0, y]);
    let found = fits(&moved.map(|pixel| pixel.map(|value| 1.3 * value)));
    assert_eq!(found.len(), 2, "{found:#?}");
    assert!(found.iter().any(|fit| matches!(fit.misfit, Misfit::Displaced { .. })), "{found:#?}");
    assert!(found.iter().any(|fit| matches!(fit.misfit, Misfit::Brighter(_))), "{found:#?}");
}

#[test]
fn noise_alone_is_never_named() {
    for seed in 0..60 {
        let found = fits(&noisy(&reference(), 0.4, seed));
        assert!(found.is_empty(), "seed {seed}: {found:#?}");
    }
}

#[test]
fn what_no_known_mistake_makes_is_not_named() {
    let mut image = reference();
    for y in 20..50 {
        image.pixels[y * WIDTH..][..16].as_flattened_mut().iter_mut().for_each(|v| *v *= 0.2);
    }
    let found = fits(&noisy(&image, 0.1, 1));
    assert!(found.iter().all(|fit| fit.explains < 0.3), "{found:#?}");
    assert!(fits(&reference()).is_empty());
}

#[test]
fn pixels_that_are_not_numbers_spoil_nothing() {
    let mut image = seen(WIDTH, HEIGHT, |x, y| [x - 0.5, y]);
    image.pixels[1000] = [f32::NAN, 1.0, f32::INFINITY];
    let Misfit::Displaced { right, .. } = only(&image).misfit else { panic!() };
    assert!((right.value - 0.5).abs() < 0.015, "{right:?}");
}

#[test]
fn pixels_that_do_not_count_do_not_count() {
    let mut image = reference();
    let counted: Vec<bool> = (0..WIDTH * HEIGHT).map(|i| i % WIDTH >= 20).collect();
    for (pixel, counted) in image.pixels.iter_mut().zip(&counted) {
        if !counted {
            *pixel = [0.0; 3];
        }
    }
    let knowledge = Knowledge { counted: Some(&counted), ..Default::default() };
    assert!(explain(&image, &reference(), &knowledge).is_empty());
}

#[test]
fn sentences_say_how_far_which_way() {
    let estimate = |value| Estimate::new(value, 0.01);
    let misfit = Misfit::Displaced { right: estimate(0.5), down: estimate(-1.0) };
    let said = Fit { misfit, explains: 0.995, certainty: 40.0 }.to_string();
    assert_eq!(
        said,
        "displaced by 0.50 ± 0.01 pixels to the right and 1.00 ± 0.01 up: explains 99.5 % of \
         the difference"
    );
    let alike = Misfit::Brighter([1.01, 1.012, 1.011].map(estimate)).to_string();
    assert_eq!(alike, "1.01 ± 0.01 times as bright, alike in all channels");
}

#[test]
fn a_stripe_is_found_with_its_ends_and_its_factor() {
    let striped = |lines: Lines, amount: f32| {
        let reference = reference();
        let image = Image::from_fn(WIDTH, HEIGHT, |x, y| {
            let line = if lines == Lines::Columns { x } else { y };
            let factor = if (32..40).contains(&line) { amount } else { 1.0 };
            reference.pixels[y * WIDTH + x].map(|value| factor * value)
        });
        noisy(&image, 0.05, 3)
    };
    for (lines, amount) in [(Lines::Columns, 1.3), (Lines::Rows, 0.7)] {
        let fits = fits(&striped(lines, amount));
        let Misfit::Stripe { lines: found, first, last, factor } = fits[0].misfit else {
            panic!("{fits:#?}")
        };
        assert_eq!((found, first, last), (lines, 32, 39));
        assert!(factor.allows(f64::from(amount)), "{factor:?}");
    }
}

#[test]
fn large_pictures_are_searched_in_part_and_told_the_same() {
    let (width, height) = (800, 480);
    let place = |x: f64, y: f64| [x * 96.0 / 800.0, y * 72.0 / 480.0];
    let reference = seen(width, height, place);
    let only = |image: &Image| {
        let fits = explain(image, &reference, &Knowledge::default());
        assert_eq!(fits.len(), 1, "{fits:#?}");
        fits[0].misfit
    };
    let raised = noisy(&reference.map(|pixel| pixel.map(|value| value.powf(0.6))), 0.05, 1);
    let Misfit::Power(power) = only(&raised) else { panic!("a power") };
    assert!(power.allows(0.6), "{power:?}");
    let mirrored = noisy(&Symmetry::LeftRight.of(&reference), 0.05, 2);
    assert_eq!(only(&mirrored), Misfit::Turned(Symmetry::LeftRight));
    let moved = seen(width, height, |x, y| place(x - 0.5, y));
    let Misfit::Displaced { right, down } = only(&noisy(&moved, 0.05, 3)) else {
        panic!("displaced")
    };
    assert!((right.value - 0.5).abs() < 0.02 && down.value.abs() < 0.02, "{right:?} {down:?}");
}
