//! Metrics of PNG files against the standard tools, whose numbers tests/fixtures/compare/make.py wrote: FLIP by
//! flip-evaluator 1.7, RMSE and SSIM by scikit-image 0.26.0.

use super::tests::{compared, path_of};
use crate::image::png::{self, Picture};
use crate::stats::Comparison;
use std::path::Path;

/// How far a metric may be from that of the standard tool.
const TOLERANCE: f64 = 1e-4;

/// FLIP, RMSE and SSIM; scikit-image has no SSIM for images smaller than its window.
const EXPECTED: [(&str, f64, f64, Option<f64>); 10] = [
    ("noise", 0.087286, 0.036115, Some(0.945401)),
    ("blur", 0.102831, 0.043971, Some(0.894225)),
    ("shift", 0.301907, 0.076454, Some(0.815072)),
    ("tint", 0.370135, 0.076532, Some(0.980263)),
    ("clipped", 0.268745, 0.076404, Some(0.889383)),
    ("gradient", 0.120800, 0.029346, Some(0.862883)),
    ("equal", 0.000000, 0.000000, Some(1.000000)),
    ("tiny", 0.308593, 0.070501, None),
    ("non-square", 0.146845, 0.071052, Some(0.824750)),
    ("grey", 0.214580, 0.046625, Some(0.993644)),
];

/// Eight bits that look random.
fn noise(x: usize, y: usize, c: usize, seed: usize) -> i64 {
    let h = (x * 73_856_093) ^ (y * 19_349_663) ^ (c * 83_492_791) ^ (seed * 40_503);
    let h = (h as u32 ^ (h as u32 >> 13)).wrapping_mul(1_274_126_177);
    i64::from((h ^ (h >> 16)) & 255)
}

fn codes(size: [usize; 2], code: impl Fn(usize, usize, usize) -> i64) -> Picture {
    let [width, height] = size;
    let code = |x, y, c| code(x, y, c).clamp(0, 255) as u8;
    let pixel = |i: usize| [0, 1, 2].map(|c| code(i % width, i / width, c));
    Picture { width, height, pixels: (0..width * height).map(pixel).collect() }
}

/// Triangle waves of another period in each channel, stripes, and a little grain.
fn pattern(x: usize, y: usize, c: usize) -> i64 {
    let phase = ((x * (c + 2) + y * 3) % 96) as i64;
    let wave = 4 * phase.min(95 - phase);
    let stripes = if (x / 7 + y / 5).is_multiple_of(2) { 40 } else { 0 };
    (20 + wave + stripes + noise(x, y, c, 1) / 32).clamp(0, 255)
}

/// Means of three by three codes, the border repeated.
fn blurred(x: usize, y: usize, c: usize) -> i64 {
    let near = |at: usize, end: usize| (0..3).map(move |i| (at + i).saturating_sub(1).min(end - 1));
    near(y, 48).flat_map(|y| near(x, 64).map(move |x| pattern(x, y, c))).sum::<i64>() / 9
}

/// An image and its reference, of the same codes as in make.py.
fn pair(name: &str) -> [Picture; 2] {
    let size = [64, 48];
    let reference = codes(size, pattern);
    let of = |code: fn(usize, usize, usize) -> i64| [codes(size, code), reference.clone()];
    match name {
        "noise" => of(|x, y, c| pattern(x, y, c) + noise(x, y, c, 2) / 8 - 16),
        "blur" => of(blurred),
        "shift" => of(|x, y, c| pattern(x.saturating_sub(1), y, c)),
        "tint" => of(|x, y, c| pattern(x, y, c) * [18, 16, 13][c] / 16),
        "clipped" => [3, 2].map(|gain| {
            codes(size, |x, y, c| gain * pattern(x, y, c) - if gain == 3 { 200 } else { 90 })
        }),
        "gradient" => [16, 1].map(|step| codes(size, |x, _, _| 4 * x as i64 / step * step)),
        "equal" => of(pattern),
        "tiny" => {
            [1, 0].map(|on| codes([8, 8], |x, y, c| pattern(x, y, c) + on * noise(x, y, c, 3) / 8))
        }
        "non-square" => [1, 0].map(|on| {
            codes([97, 31], |x, y, c| pattern(x, y, c) + on * (noise(x, y, c, 4) / 4 - 32))
        }),
        _ => [12, 0].map(|more| codes(size, |x, y, _| pattern(x, y, 1) + more)),
    }
}

fn found(folder: &Path, name: &str) -> Comparison {
    let files = ["image", "reference"].map(|role| folder.join(format!("{name}-{role}.png")));
    for (file, codes) in files.iter().zip(pair(name)) {
        png::write(file, &codes).unwrap();
    }
    compared(&files.each_ref().map(|file| path_of(file))).unwrap()
}

fn metric(comparison: &Comparison, name: &str) -> f64 {
    let found = comparison.metrics.iter().find(|metric| metric.name == name);
    found.and_then(|metric| metric.value).unwrap()
}

#[test]
fn metrics_of_png_files_are_those_of_the_standard_tools() {
    let folder = tempfile::tempdir().unwrap();
    for (name, flip, rmse, ssim) in EXPECTED {
        let found = found(folder.path(), name);
        let of = |metric: &str| self::metric(&found, metric);
        let expected = [("FLIP", Some(flip)), ("RMSE", Some(rmse)), ("SSIM", ssim)];
        for (metric, expected) in expected {
            let off = expected.map_or(0.0, |expected| of(metric) - expected);
            assert!(off.abs() < TOLERANCE, "{name}: {metric} {} is off by {off:e}", of(metric));
        }
        // Of noise-free numbers nothing is left to say but this.
        let noise_ratio = -20.0 * rmse.log10();
        assert!(rmse == 0.0 || (of("PSNR") - noise_ratio).abs() < 0.1, "{name}");
    }
}

#[test]
fn clipped_pixels_are_counted_apart_and_are_part_of_the_metrics() {
    let folder = tempfile::tempdir().unwrap();
    let found = found(folder.path(), "clipped");
    let clipped = found.clipped.as_ref().unwrap();
    for (ends, codes) in [&clipped.image, &clipped.reference].into_iter().zip(pair("clipped")) {
        let with = |code: u8| codes.pixels.iter().filter(|pixel| pixel.contains(&code)).count();
        assert_eq!([ends.black, ends.white], [with(0), with(255)]);
        assert!(ends.white > 100 && ends.black > 100, "{ends:?}");
    }
    let told = crate::report::comparison::told_of(&found);
    assert!(told.contains("clipped pixels included"), "{told}");
    assert!(!told.contains("HDR-FLIP") && !told.contains("relMSE"), "{told}");
}
