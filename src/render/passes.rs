//! An image in passes: one call of the core each, with a seed of its own. The time to go is known after the first, and
//! how passes differ is the noise of their mean, whatever the core itself says of it.

use crate::contract::{BuiltScene, Capabilities, CoreError, Film, RenderSettings};
use crate::image::Image;
use crate::image::encoding::Curve;
use crate::math::rng::Seed;
use crate::scene::Camera;

/// Fewer passes say too little of their spread.
const FEWEST: u32 = 4;

/// Who says how noisy the image is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Source {
    Spread,
    Core,
}

/// What came of all passes.
#[derive(Debug)]
pub(crate) struct Rendered {
    pub(crate) image: Image,
    /// Of each value, if it is known.
    pub(crate) standard_error: Option<(Image, Source)>,
    /// The first pass with pixels that are not radiance.
    pub(crate) breach: Option<CoreError>,
    /// Samples that each pixel took; none where all took as many.
    pub(crate) samples: Option<Vec<f32>>,
    /// From its values to codes of 8 bits.
    pub(crate) curve: Curve,
    pub(crate) passes: u32,
}

impl Rendered {
    /// An image of something that is no radiance, and exact.
    pub(super) fn of_values(image: Image) -> Self {
        let (standard_error, breach, samples) = (None, None, None);
        Self { image, standard_error, breach, samples, curve: Curve::Linear, passes: 1 }
    }
}

/// What is rendered, but for samples and seeds.
pub(crate) struct Job<'a> {
    pub(crate) camera: &'a Camera,
    /// With all samples, and the seed of the whole.
    pub(crate) settings: &'a RenderSettings,
    pub(crate) passes: u32,
    pub(crate) capabilities: Capabilities,
}

impl Job<'_> {
    /// Renders; `tell` hears after every pass how many samples there are.
    pub(crate) fn render(
        &self,
        scene: &mut dyn BuiltScene,
        mut tell: impl FnMut(u32),
    ) -> Result<Rendered, CoreError> {
        let RenderSettings { width, height, .. } = *self.settings;
        let mut sums = Sums::new(width as usize, height as usize);
        for pass in 0..self.passes {
            let settings = self.of_pass(pass);
            let mut film = Film::blank(width, height, self.capabilities);
            let answer = scene.render(self.camera, &settings, &mut film);
            sums.breach = sums.breach.or(unless_whole(answer, &film, self.settings)?);
            sums.add(&film, settings.samples_per_pixel);
            sums.counts = settings.adaptive.map(|_| counts(&film));
            tell(sums.samples);
        }
        Ok(sums.rendered())
    }

    fn of_pass(&self, pass: u32) -> RenderSettings {
        let all = self.settings.samples_per_pixel;
        let samples_per_pixel = all / self.passes + u32::from(pass < all % self.passes);
        let mut settings = RenderSettings { samples_per_pixel, ..self.settings.clone() };
        // One call has the seed that was asked for: it is the call that a run would make.
        if self.passes > 1 {
            settings.integrator.seed = Seed(self.settings.integrator.seed).child(pass).0;
        }
        settings
    }
}

fn counts(film: &Film) -> Vec<f32> {
    film.sample_counts.iter().map(|count| *count as f32).collect()
}

/// An image with pixels that are not radiance is an image all the same, for people to see where they are.
fn unless_whole(
    answer: Result<(), CoreError>,
    film: &Film,
    settings: &RenderSettings,
) -> Result<Option<CoreError>, CoreError> {
    // A worker hands on no answer that breaks the contract: nothing of it is here to be shown.
    let is_here = film.pixels.as_flattened().iter().any(|value| value.is_finite());
    let has_all =
        is_here && film.pixels.len() == settings.width as usize * settings.height as usize;
    match answer {
        Ok(()) => Ok(None),
        Err(error @ CoreError::BrokeContract(_)) if has_all => Ok(Some(error)),
        Err(error) => Err(error),
    }
}

/// Means and squared deviations over passes, weighted by their samples, and what the core says of its variance.
struct Sums {
    size: [usize; 2],
    passes: u32,
    samples: u32,
    mean: Vec<[f64; 3]>,
    squares: Vec<[f64; 3]>,
    /// Of the sum over samples; none where the core does not report it, or a pass has one sample.
    reported: Option<Vec<[f64; 3]>>,
    breach: Option<CoreError>,
    counts: Option<Vec<f32>>,
}

impl Sums {
    fn new(width: usize, height: usize) -> Self {
        let zeros = || vec![[0.0; 3]; width * height];
        Self {
            size: [width, height],
            passes: 0,
            samples: 0,
            mean: zeros(),
            squares: zeros(),
            reported: Some(zeros()),
            breach: None,
            counts: None,
        }
    }

    /// Welford's update, each pass weighing as much as its samples.
    fn add(&mut self, film: &Film, samples: u32) {
        self.passes += 1;
        self.samples += samples;
        let (weight, all) = (f64::from(samples), f64::from(self.samples));
        let sums = self.mean.iter_mut().zip(&mut self.squares).zip(&film.pixels);
        for ((mean, squares), pixel) in sums {
            for c in 0..3 {
                let off = f64::from(pixel[c]) - mean[c];
                mean[c] += off * weight / all;
                squares[c] += weight * off * (f64::from(pixel[c]) - mean[c]);
            }
        }
        let says = samples > 1 && film.variances.len() == film.pixels.len();
        self.reported = self.reported.take().filter(|_| says);
        for (sum, variance) in self.reported.iter_mut().flatten().zip(&film.variances) {
            *sum = std::array::from_fn(|c| sum[c] + weight * weight * f64::from(variance[c]));
        }
    }

    fn rendered(self) -> Rendered {
        let image = self.image(&self.mean, |value| value);
        let standard_error = if self.breach.is_some() { None } else { self.standard_error() };
        Rendered {
            image,
            standard_error,
            breach: self.breach,
            samples: self.counts,
            curve: Curve::Srgb,
            passes: self.passes,
        }
    }

    /// Where no value differs between passes, their spread says nothing: the core may not use its seed.
    fn standard_error(&self) -> Option<(Image, Source)> {
        let all = f64::from(self.samples);
        let has_spread = self.squares.as_flattened().iter().any(|square| *square > 0.0);
        if self.passes >= FEWEST && has_spread {
            let freedom = f64::from(self.passes - 1);
            let error = self.image(&self.squares, |square| (square / freedom / all).sqrt());
            return Some((error, Source::Spread));
        }
        let reported = self.reported.as_ref().filter(|_| self.passes < FEWEST)?;
        Some((self.image(reported, |variance| variance.sqrt() / all), Source::Core))
    }

    fn image(&self, values: &[[f64; 3]], value: impl Fn(f64) -> f64) -> Image {
        let [width, height] = self.size;
        #[expect(clippy::cast_possible_truncation, reason = "images are in single precision")]
        let pixels = values.iter().map(|pixel| pixel.map(|sum| value(sum) as f32)).collect();
        Image { width, height, pixels }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::{BuildStats, Result};
    use crate::math::rng::uniform;

    /// A scene of one value, with noise of variance 1/12 a sample.
    struct Noise {
        is_seeded: bool,
        seeds: Vec<u64>,
    }

    impl BuiltScene for Noise {
        fn stats(&self) -> BuildStats {
            BuildStats::default()
        }

        fn render(&mut self, _: &Camera, settings: &RenderSettings, film: &mut Film) -> Result<()> {
            self.seeds.push(settings.integrator.seed);
            let mut stream =
                Seed(if self.is_seeded { settings.integrator.seed } else { 7 }).stream();
            let samples = settings.samples_per_pixel;
            for (pixel, variance) in film.pixels.iter_mut().zip(&mut film.variances) {
                let sum: f64 = (0..samples).map(|_| uniform(&mut stream)).sum();
                *pixel = [(sum / f64::from(samples)) as f32; 3];
                *variance = [(1.0 / 12.0 / f64::from(samples)) as f32; 3];
            }
            Ok(())
        }
    }

    fn camera() -> Camera {
        let [position, target, up] = [[0.0, 0.0, 1.0], [0.0; 3], [0.0, 1.0, 0.0]];
        Camera::look_at(position.into(), target.into(), up.into(), 1.0, [8, 8])
    }

    fn rendered(scene: &mut Noise, samples: u32, passes: u32) -> Rendered {
        let capabilities = Capabilities::REPORTED_VARIANCE;
        let settings = RenderSettings {
            width: 32,
            height: 32,
            samples_per_pixel: samples,
            ..Default::default()
        };
        let job = Job { camera: &camera(), settings: &settings, passes, capabilities };
        job.render(scene, |_| {}).unwrap()
    }

    #[test]
    fn standard_errors_are_those_of_the_mean_whoever_tells_them() {
        for (samples, passes, source) in [(70, 16, Source::Spread), (70, 3, Source::Core)] {
            let mut scene = Noise { is_seeded: true, seeds: Vec::new() };
            let found = rendered(&mut scene, samples, passes);
            let (errors, by) = found.standard_error.unwrap();
            assert_eq!(by, source);
            let mean = |values: &mut dyn Iterator<Item = f64>| values.sum::<f64>() / 1024.0;
            let told = mean(&mut errors.pixels.iter().map(|e| f64::from(e[0]).powi(2)));
            let real =
                mean(&mut found.image.pixels.iter().map(|v| (f64::from(v[0]) - 0.5).powi(2)));
            let expected = 1.0 / 12.0 / f64::from(samples);
            // 1,024 pixels tell a variance to 4.4 %, 15 degrees of freedom each to 1.2 %.
            assert!((real / expected - 1.0).abs() < 0.2, "{real} {expected}");
            assert!((told / expected - 1.0).abs() < 0.06, "{told} {expected}");
            scene.seeds.dedup();
            assert_eq!(scene.seeds.len(), passes as usize);
        }
    }

    #[test]
    fn a_core_that_does_not_use_its_seed_tells_no_noise() {
        let found = rendered(&mut Noise { is_seeded: false, seeds: Vec::new() }, 64, 16);
        assert!(found.standard_error.is_none());
    }

    /// A core that answers with this error, and whether its film is filled by then.
    struct Fails(CoreError, bool);

    impl BuiltScene for Fails {
        fn stats(&self) -> BuildStats {
            BuildStats::default()
        }

        fn render(&mut self, _: &Camera, _: &RenderSettings, film: &mut Film) -> Result<()> {
            if self.1 {
                film.pixels.fill([0.5; 3]);
                film.pixels[3] = [f32::NAN; 3];
            }
            Err(self.0.clone())
        }
    }

    #[test]
    fn pixels_that_are_not_radiance_are_shown_and_told_and_a_refusal_is_no_image() {
        let settings =
            RenderSettings { width: 4, height: 2, samples_per_pixel: 8, ..Default::default() };
        let job = Job {
            camera: &camera(),
            settings: &settings,
            passes: 4,
            capabilities: Capabilities::empty(),
        };
        let breach = || CoreError::breach("pixel (3, 0) is NaN");
        let mut tells = Fails(breach(), true);
        let found = job.render(&mut tells, |_| {}).unwrap();
        assert!(found.image.pixels[3][0].is_nan() && found.image.pixels[4] == [0.5; 3]);
        assert!(found.breach.is_some() && found.standard_error.is_none());
        for mut fails in [Fails(CoreError::Refused("no".to_owned()), true), Fails(breach(), false)]
        {
            assert!(job.render(&mut fails, |_| {}).is_err());
        }
    }

    #[test]
    fn one_call_has_the_seed_that_was_asked_for() {
        let mut scene = Noise { is_seeded: true, seeds: Vec::new() };
        rendered(&mut scene, 4, 1);
        assert_eq!(scene.seeds, [0]);
    }
}
