//! Pictures of codes that are right, wrong, and encoded in some other way than they say.

use super::*;
use crate::image::encoding::Curve;
use crate::math::rng::{Seed, Stream, uniform};
use std::convert::Infallible;

const SIZE: usize = 40;
const SAMPLES: u32 = 64;
const GAMMA: Encoding = Encoding::of(Curve::Gamma(2.2));

/// Light from 0.05 to 1.5: some of it clips.
fn ramp() -> Image {
    Image::from_fn(SIZE, SIZE, |x, y| {
        let level = 0.05 + 0.55 * x as f32 / SIZE as f32 + if y < 8 { 0.9 } else { 0.0 };
        [level, 0.8 * level, 0.5 * level]
    })
}

/// The mean of so many exponential samples of mean 1: Gamma, just as the law has it.
fn noise(stream: &mut Stream) -> f64 {
    let logs: f64 = (0..SAMPLES).map(|_| (1.0 - uniform(stream)).ln()).sum();
    -logs / f64::from(SAMPLES)
}

/// One picture of a core whose light is `light`.
fn picture(light: &Image, encoding: Encoding, stream: &mut Stream) -> Codes {
    let pixel = |light: &[f32; 3]| {
        let gain = noise(stream);
        light.map(|light| encoding.code(gain * f64::from(light)))
    };
    let pixels = light.pixels.iter().map(pixel).collect();
    Codes { width: light.width, height: light.height, pixels }
}

/// Judges the pictures that `draw` makes against the ramp, known to `error` from so many samples a pixel.
fn judged(error: &Image, samples: u64, mut draw: impl FnMut(ImageDraw) -> Codes) -> CodeReport {
    let (mean, samples) = (&ramp(), Some(samples));
    let reference = CodeReference { mean, standard_error: error, samples };
    let settings = CodeSettings { declared: GAMMA, effort: ImageEffort::new(0.02, SAMPLES) };
    let Ok(report) =
        judge_codes(reference, &settings, &mut |request| Ok::<_, Infallible>(draw(request)));
    report
}

/// Judges pictures of a core whose light is `light`.
fn rendered(error: &Image, light: &Image, encoding: Encoding) -> CodeReport {
    judged(error, 1 << 16, |draw| picture(light, encoding, &mut draw.seed(Seed(1)).stream()))
}

fn judge(light: &Image, encoding: Encoding) -> CodeReport {
    rendered(&Image::new(SIZE, SIZE, [0.0; 3]), light, encoding)
}

fn with_gain(gain: impl Fn(usize, usize) -> f32) -> Image {
    let ramp = ramp();
    Image::from_fn(SIZE, SIZE, |x, y| ramp.pixels[y * SIZE + x].map(|v| v * gain(x, y)))
}

#[test]
fn a_right_picture_passes_although_its_codes_decode_to_another() {
    let report = judge(&ramp(), GAMMA);
    assert_eq!(report.verdict, Verdict::Pass, "{:?}", report.image.unwrap().scales);
    let image = report.image.unwrap();
    assert!(image.resolution < 0.02, "{}", image.resolution);
    assert_eq!(report.deciphered.found, Some(GAMMA));
    assert!((report.deciphered.power.unwrap() - 1.0 / 2.2).abs() < 0.01);
    let clipping = report.clipping.unwrap();
    assert!(clipping.channels > 100 && !clipping.rejects, "{clipping:?}");
    assert!(report.compared > 0.8);
}

#[test]
fn two_per_cent_of_light_fail_either_way() {
    for gain in [0.98, 1.02] {
        let report = judge(&with_gain(|_, _| gain), GAMMA);
        assert_eq!(report.verdict, Verdict::Fail, "{gain}");
        assert_eq!(report.deciphered.found, Some(GAMMA), "{gain}");
    }
}

#[test]
fn a_darker_corner_fails() {
    let corner = |x, y| if x < 8 && y >= 32 { 0.7 } else { 1.0 };
    assert_eq!(judge(&with_gain(corner), GAMMA).verdict, Verdict::Fail);
}

#[test]
fn light_that_should_clip_and_does_not_fails() {
    // Tone-mapped: everything above 0.8 is pressed into what is left.
    let mut light = ramp();
    for value in light.pixels.iter_mut().flatten() {
        *value = if *value > 0.8 { 0.8 + 0.1 * (*value - 0.8) } else { *value };
    }
    let report = judge(&light, GAMMA);
    assert_eq!(report.verdict, Verdict::Fail);
    assert!(report.clipping.unwrap().rejects, "{:?}", report.clipping);
}

#[test]
fn another_encoding_is_named_and_not_blamed_on_the_renderer() {
    for encoding in decipher::candidates(GAMMA) {
        let report = judge(&ramp(), encoding);
        assert_eq!(report.deciphered.found, Some(encoding));
        let expected = if encoding == GAMMA { Verdict::Pass } else { Verdict::Fail };
        assert_eq!(report.verdict, expected, "{encoding}");
        assert_eq!(report.image.is_none(), encoding != GAMMA, "{encoding}");
    }
}

#[test]
fn a_bright_renderer_is_not_taken_for_another_encoding() {
    for gain in [0.5, 0.8, 1.1] {
        let report = judge(&with_gain(|_, _| gain), GAMMA);
        assert_eq!(report.deciphered.found, Some(GAMMA), "{gain}");
        assert_eq!(report.verdict, Verdict::Fail, "{gain}");
    }
}

#[test]
fn pictures_without_noise_are_compared_to_the_step() {
    let judge = |gain: f32| {
        let picture = GAMMA.picture(&with_gain(|_, _| gain));
        judged(&Image::new(SIZE, SIZE, [1e-5; 3]), 64, |_| picture.clone()).verdict
    };
    assert_eq!(judge(1.0), Verdict::Pass);
    assert_eq!(judge(1.0005), Verdict::Pass);
    assert_eq!(judge(1.02), Verdict::Fail);
}

#[test]
fn pixels_that_fireflies_reach_are_not_compared() {
    // In one of 2000 samples 1000 times the light: an 8-bit picture shows none of it.
    let deviation = |value: f32| value * 0.5 * 1000.0 / 2000f32.sqrt();
    let error = ramp().map(|pixel| pixel.map(|value| deviation(value) / 256.0));
    let report = rendered(&error, &with_gain(|_, _| 0.5), GAMMA);
    assert_eq!(report.verdict, Verdict::Inconclusive);
    assert!(report.compared < 0.1, "{}", report.compared);
}
