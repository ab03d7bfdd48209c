//! A render as an 8-bit picture against a Mitsuba reference: codes by their law, and never decoded.

use super::by_codes;
use super::matches_reference::MatchesReference;
use super::told::glance;
use crate::checks::{Check, CheckError, Context, Finding, check};
use crate::contract::{Acceleration, Capabilities};
use crate::image::encoding::Encoding;
use crate::stats::ImageDraw;

check! {
    /// Renders agree with a reference after they have been made pictures of 8 bits, as they are shown and handed in.
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
        let is_gain = gain > 0.0 && gain.is_finite();
        is_gain.then_some(()).ok_or_else(|| "`exposure` is a positive number".to_owned())
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let setup = self.picture.setup(context)?;
        let seed = context.seed;
        let mut built = context.core.build_scene(&setup.scene, Acceleration::DEFAULT)?;
        if context.budget.only_glances {
            return Ok(glance(&setup.shot.render(built.as_mut(), ImageDraw::FIRST.seed(seed))?));
        }
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
    use crate::checks::fake::Fake;
    use crate::checks::testing::{assert_passes, check_of, failure, try_judge};
    use crate::contract::{Conventions, EmissionSides, Falloff, RenderSettings};
    use crate::image::Image;
    use crate::image::encoding::{Curve, Rounding};
    use crate::math::rng::{Seed, uniform};
    use crate::scene::{Library, SceneDescription, reference};
    use crate::stats::Verdict;
    use std::path::Path;

    const SRGB: Encoding = Encoding::of(Curve::Srgb);
    const PICTURE: &str = "reference = 'area-light-plane'\nbounces = [0, 1]\nsamples-per-pixel = 8\n\
                           detects = '2 %'";

    /// A noisy copy of the reference: every pixel the mean of 32 exponential samples.
    fn noisy(mean: &Image, gain: f64, settings: &RenderSettings) -> Image {
        let mut stream = Seed(settings.integrator.seed).stream();
        let pixel = |light: &[f32; 3]| {
            let product: f64 = (0..32).map(|_| 1.0 - uniform(&mut stream)).product();
            let gain = -gain * product.ln() / 32.0;
            light.map(|light| (gain * f64::from(light)) as f32)
        };
        Image { pixels: mean.pixels.iter().map(pixel).collect(), ..*mean }
    }

    /// Of a core that renders the reference, brighter by `gain`; or that writes codes, of which it tells that they are
    /// made in the first way, and makes them in the second.
    fn found<C: Check>(check: &C, gain: f64, writes: Option<[Encoding; 2]>) -> Finding {
        found_of(check, gain, writes, Conventions::default())
    }

    /// The same of a core that declares these conventions.
    fn found_of<C: Check>(
        check: &C,
        gain: f64,
        writes: Option<[Encoding; 2]>,
        conventions: Conventions,
    ) -> Finding {
        let scene = Library::new("scenes").load("area-light-plane", &toml::Table::new()).unwrap();
        let reference = reference::load(Path::new("references"), "area-light-plane", &scene);
        let mean = reference.unwrap().mean;
        let mut core = Fake::default();
        core.info.conventions = conventions;
        core.info.capabilities = Capabilities::BUILD_SCENE;
        match writes {
            None => {
                core.info.capabilities |= Capabilities::RENDER;
                core.film = Box::new(move |settings, film| {
                    film.pixels = noisy(&mean, gain, settings).pixels;
                    film.sample_counts.fill(settings.samples_per_pixel);
                });
            }
            Some([said, done]) => {
                core.info.capabilities |= Capabilities::RENDER_CODES;
                let codes = move |image: &Image| (said, done.picture(image));
                core.codes = Box::new(move |settings| codes(&noisy(&mean, gain, settings)));
            }
        }
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

    /// The scene emits, and has no point light.
    #[test]
    fn light_that_differs_is_open_where_a_declared_convention_matters_and_all_else_fails() {
        let as_png =
            format!("[expect]\nencoding = {{ curve = 'srgb' }}\n[expect.picture]\n{PICTURE}");
        let check: MatchesReference = check_of(&format!("[expect]\n{PICTURE}"));
        let usual = Conventions::default();
        let both = Conventions { emission: EmissionSides::Both, ..usual };
        let unweakened = Conventions { point_light_falloff: Falloff::None, ..usual };
        let bright = found_of(&check, 1.05, None, both);
        assert_eq!(bright.verdict, Verdict::Inconclusive, "{bright:#?}");
        assert!(bright.statement.starts_with("the core declares emission from both sides"));
        assert!(bright.measures.iter().all(|measure| !measure.failed()) && bright.clues.is_empty());
        let coded = found_of(&check_of::<MatchesAsPng>(&as_png), 1.05, None, both);
        assert_eq!(coded.verdict, Verdict::Inconclusive, "{}", coded.statement);
        assert_passes(&found_of(&check, 1.0, None, both));
        failure(&found_of(&check, 1.05, None, unweakened));
        let encoded_otherwise = Some([SRGB, Encoding::of(Curve::Linear)]);
        failure(&found_of(&check, 1.0, encoded_otherwise, both));
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
