//! Adaptive pictures: sample counts in range, and means divided by the samples that were used.

use super::looks_before_the_end;
use crate::checks::rendering::Rendering;
use crate::checks::{Check, Context, Finding, Measure, Picture, PictureRole, Result, check};
use crate::contract::{Acceleration, AdaptiveSettings, Film};
use crate::image::{CHANNELS, Image};
use crate::stats::Verdict;
use crate::text::{Bounces, Lit, Percent, Size};

/// Relative error of a pixel whose samples are all alike: rounding of a sum of some thousand terms.
const EXACT_PIXEL: f64 = 1e-5;

check! {
    pub(crate) struct SampleCounts {
        size: Size,
        bounces: Bounces,
        /// The most samples a pixel may take.
        cap: u32,
        /// Samples between two looks.
        batch: u32,
        /// Half width of the interval that is good enough.
        tolerance: Percent,
        /// The scene has no noise: every pixel stops at the first look, and has this radiance.
        radiance: Option<Lit>,
    }
    name: "sample-counts",
    summary: "adaptive pictures: counts in range, means over what was used",
    needs: BUILD_SCENE | RENDER | ADAPTIVE_SAMPLING,
}

impl Check for SampleCounts {
    fn validate(&self) -> Result<(), String> {
        looks_before_the_end(self.batch, self.cap)
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding> {
        let scene = context.scene()?;
        let settings =
            AdaptiveSettings { samples_per_batch: self.batch, max_tolerance: self.tolerance.0 };
        let rendering =
            Rendering::of(&scene, self.size.0, self.bounces.0, self.cap)?.adaptive(settings);
        let mut built = context.core.build_scene(&scene, Acceleration::DEFAULT)?;
        let film = rendering.film(built.as_mut(), context.seed.0, 0)?;
        let mut measures = vec![self.out_of_range(&film)];
        if let Some(Lit(radiance)) = self.radiance {
            measures.push(self.beyond_first_look(&film));
            measures.extend(pixels_equal(&film, radiance));
        } else {
            measures.push(distinct_counts(&film));
        }
        drop(built);
        context.pictures.push(rate_picture(&film, self.cap));
        let caption = format!("up to {} samples per pixel", self.cap);
        context.show(PictureRole::Render, caption, image_of(film.width, film.height, film.pixels));
        let right = format!("counts lie in {} to {}, in steps of a batch", self.batch, self.cap);
        let failed = measures.iter().find(|measure| measure.verdict != Verdict::Pass);
        let complaint =
            failed.map(|m| format!("{}: {} instead of {}", m.name(), m.measured, m.expected));
        Ok(Finding::of(right, "would have caught one wrong count in the picture", measures)
            .complaining(complaint))
    }
}

impl SampleCounts {
    /// A count is a whole number of batches, or the cap.
    fn out_of_range(&self, film: &Film) -> Measure {
        let is_wrong = |count: &&u32| {
            let whole = count.is_multiple_of(self.batch) || **count == self.cap;
            !(whole && (self.batch..=self.cap).contains(*count))
        };
        let wrong = film.sample_counts.iter().filter(is_wrong).count();
        Measure::none("counts that no look can give", wrong).in_unit("pixels")
    }

    fn beyond_first_look(&self, film: &Film) -> Measure {
        let later = film.sample_counts.iter().filter(|count| **count != self.batch).count();
        Measure::none("pixels without noise that took more than one batch", later).in_unit("pixels")
    }
}

/// The darkest and the brightest pixel of a picture that is all one colour. Divided by the cap instead of the
/// samples used, they would be `batch / cap` of it.
fn pixels_equal(film: &Film, radiance: [f64; 3]) -> Vec<Measure> {
    let channel = |c: usize| film.pixels.iter().map(move |pixel| f64::from(pixel[c]));
    let exact = |name: &str, value: f64, c: usize| {
        Measure::exact(name, value, radiance[c], EXACT_PIXEL * radiance[c]).of_channel(CHANNELS[c])
    };
    (0..3)
        .flat_map(|c| {
            [
                exact("darkest pixel", channel(c).fold(f64::INFINITY, f64::min), c),
                exact("brightest pixel", channel(c).fold(0.0, f64::max), c),
            ]
        })
        .collect()
}

/// A noisy scene whose pixels all take the same count is not sampled adaptively.
fn distinct_counts(film: &Film) -> Measure {
    let mut counts = film.sample_counts.clone();
    counts.sort_unstable();
    counts.dedup();
    Measure::none("a noisy picture with one count everywhere", usize::from(counts.len() < 2))
}

fn image_of(width: u32, height: u32, pixels: Vec<[f32; 3]>) -> Image {
    Image { width: width as usize, height: height as usize, pixels }
}

fn rate_picture(film: &Film, cap: u32) -> Picture {
    let rates = film.sample_counts.iter().map(|count| [*count as f32 / cap as f32; 3]).collect();
    let image = image_of(film.width, film.height, rates);
    Picture::of(PictureRole::SampleRate, format!("samples taken, as a share of {cap}"), image)
}
