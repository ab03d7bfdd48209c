//! A render as an 8-bit picture against a Mitsuba reference: codes by their law, and never decoded.

use super::by_codes;
use super::matches_reference::MatchesReference;
use crate::checks::{Check, CheckError, Context, Finding, check};
use crate::contract::{Acceleration, Capabilities};
use crate::image::encoding::Encoding;

check! {
    /// Renders agree with a reference after they have been made pictures of 8 bits, as they are shown
    /// and handed in.
    pub(crate) struct MatchesAsPng {
        /// How light becomes codes.
        encoding: Encoding,
        /// What is rendered, and with what it has to agree.
        picture: MatchesReference,
    }
    name: "matches-as-png",
    summary: "renders as 8-bit pictures against a Mitsuba reference, code by code",
}

impl Check for MatchesAsPng {
    fn needs_besides(&self) -> Capabilities {
        self.picture.needs_besides()
    }

    fn validate(&self) -> Result<(), String> {
        let gain = self.encoding.exposure;
        match gain > 0.0 && gain.is_finite() {
            true => Ok(()),
            false => Err("`exposure` is a positive number".to_owned()),
        }
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let setup = self.picture.setup(context)?;
        let seed = context.seed;
        let mut built = context.core.build_scene(&setup.scene, Acceleration::DEFAULT)?;
        let judged = by_codes::judge(&setup, self.encoding, &mut |draw| {
            let image = setup.shot.render(built.as_mut(), draw.seed(seed))?;
            Ok(self.encoding.picture(&image))
        })?;
        drop(built);
        Ok(judged.shown(&setup, context))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::testing::{assert_passes, check_of, failure, info, try_judge};
    use crate::contract::{
        BuildStats, BuiltScene, Core, CoreInfo, Film, Precision, RenderSettings, Result,
    };
    use crate::image::Image;
    use crate::image::encoding::{Curve, Rounding};
    use crate::image::png::Picture;
    use crate::math::rng::{Seed, uniform};
    use crate::scene::{Camera, Library, SceneDescription, reference};
    use std::path::Path;

    const SRGB: Encoding = Encoding::of(Curve::Srgb);
    const PICTURE: &str = "reference = 'area-light-plane'\nbounces = [0, 1]\nsamples-per-pixel = 8\n\
                           detects = '2 %'";

    /// A core that renders noisy copies of the reference, and then spoils them.
    struct Develops {
        mean: Image,
        gain: f64,
        /// What it says of its codes, and what it does, if it writes nothing else.
        writes: Option<[Encoding; 2]>,
    }

    impl Core for Develops {
        fn info(&self) -> CoreInfo {
            let render = match self.writes {
                None => Capabilities::RENDER,
                Some(_) => Capabilities::RENDER_CODES,
            };
            let capabilities = Capabilities::BUILD_SCENE | render;
            CoreInfo { capabilities, ..info(Precision::Double) }
        }

        fn build_scene(
            &mut self,
            _: &SceneDescription,
            _: Acceleration,
        ) -> Result<Box<dyn BuiltScene + '_>> {
            Ok(Box::new(Film8(self)))
        }
    }

    struct Film8<'a>(&'a Develops);

    impl Film8<'_> {
        /// Every pixel the mean of 32 exponential samples.
        fn picture(&self, settings: &RenderSettings) -> Image {
            let mut stream = Seed(settings.integrator.seed).stream();
            let pixel = |light: &[f32; 3]| {
                let product: f64 = (0..32).map(|_| 1.0 - uniform(&mut stream)).product();
                let gain = -self.0.gain * product.ln() / 32.0;
                light.map(|light| (gain * f64::from(light)) as f32)
            };
            let mean = &self.0.mean;
            Image { pixels: mean.pixels.iter().map(pixel).collect(), ..*mean }
        }
    }

    impl BuiltScene for Film8<'_> {
        fn stats(&self) -> BuildStats {
            BuildStats::default()
        }

        fn render(&mut self, _: &Camera, settings: &RenderSettings, film: &mut Film) -> Result<()> {
            film.pixels = self.picture(settings).pixels;
            film.sample_counts.fill(settings.samples_per_pixel);
            Ok(())
        }

        fn render_codes(
            &mut self,
            _: &Camera,
            settings: &RenderSettings,
            codes: &mut Picture,
        ) -> Result<Encoding> {
            let [said, done] = self.0.writes.unwrap();
            *codes = done.picture(&self.picture(settings));
            Ok(said)
        }
    }

    fn found<C: Check>(check: &C, gain: f64, writes: Option<[Encoding; 2]>) -> Finding {
        let scene = Library::new("scenes").load("area-light-plane", &toml::Table::new()).unwrap();
        let reference = reference::load(Path::new("references"), "area-light-plane", &scene);
        let mut core = Develops { mean: reference.unwrap().mean, gain, writes };
        try_judge(check, &mut core, Some(SceneDescription::clone(&scene))).unwrap()
    }

    #[test]
    fn a_right_picture_passes_and_a_brighter_one_fails() {
        let text =
            format!("[expect]\nencoding = {{ curve = 'srgb' }}\n[expect.picture]\n{PICTURE}");
        let check: MatchesAsPng = check_of(&text);
        let right = found(&check, 1.0, None);
        assert_passes(&right);
        assert!(right.statement.starts_with("in codes (sRGB, rounded): agrees"), "{right:#?}");
        let bright = found(&check, 1.05, None);
        assert!(failure(&bright).contains("the picture has 1.0"), "{}", bright.statement);
    }

    #[test]
    fn a_core_that_writes_8_bits_is_put_to_the_reference_by_its_codes() {
        let check: MatchesReference = check_of(&format!("[expect]\n{PICTURE}"));
        assert_passes(&found(&check, 1.0, Some([Encoding::COURSE; 2])));
        failure(&found(&check, 0.95, Some([Encoding::COURSE; 2])));
    }

    #[test]
    fn what_is_wrong_with_an_encoding_has_a_name() {
        let check: MatchesReference = check_of(&format!("[expect]\n{PICTURE}"));
        let cut = Encoding { rounding: Rounding::Down, ..SRGB };
        for (done, cause) in [
            (cut, "codes-rounded-otherwise"),
            (Encoding::of(Curve::Gamma(2.2)), "encoded-otherwise"),
            (Encoding::of(Curve::Linear), "encoded-otherwise"),
        ] {
            let finding = found(&check, 1.0, Some([SRGB, done]));
            assert!(failure(&finding).starts_with("encoding mismatch"), "{}", finding.statement);
            assert_eq!(finding.clues[0].cause, cause, "{}", finding.statement);
        }
    }
}
