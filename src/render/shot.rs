//! What an image is of, in the words of `furnace render`: all but the core and the file.

use crate::contract::{
    Acceleration, AdaptiveSettings, Capabilities, DirectSampling, IntegratorSettings,
    RenderSettings, Roulette,
};
use crate::scene::{Camera, Library, Overrides, SceneDescription, SceneError};
use clap::Args;
use clap::value_parser;
use std::ops::RangeInclusive;
use std::sync::Arc;

/// Calls that samples are split over, unless that is said.
const PASSES: u32 = 16;

/// What an image shows.
#[derive(Clone, Debug, PartialEq, Args)]
pub(crate) struct Shot {
    /// A scene of the project, or a `.toml` or `.dae` file.
    pub(crate) scene: String,
    /// Samples per pixel.
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = value_parser!(u32).range(1..))]
    pub(crate) spp: u32,
    /// Columns and rows [default: those of the scene's camera].
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub(crate) size: Option<[u32; 2]>,
    /// Seed of the random numbers.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) seed: u64,
    /// Maximum depth: the last bounce [default: that of the scene's reference, or 5]; 2..5 for
    /// indirect light alone, 3..3 for one bounce alone.
    #[arg(long, value_name = "N", value_parser = bounces)]
    pub(crate) bounces: Option<RangeInclusive<u32>>,
    /// Shadow rays to each area light; with --hemisphere, directions for each light.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = value_parser!(u32).range(1..))]
    pub(crate) light_samples: u32,
    /// Use hemisphere sampling instead of light sampling.
    #[arg(long)]
    pub(crate) hemisphere: bool,
    /// Russian roulette: the probability to stop at a bounce, and how many bounces are guaranteed
    /// before it is played (0.3,1).
    #[arg(long, value_name = "STOP[,BOUNCES]", value_parser = roulette)]
    pub(crate) roulette: Option<Roulette>,
    /// Adaptive sampling: samples of a batch, and the tolerance (32,0.05). --spp is the most a
    /// pixel takes; .exr keeps what each took in the channel `samples`.
    #[arg(long, value_name = "BATCH,TOLERANCE", value_parser = adaptive)]
    pub(crate) adaptive: Option<AdaptiveSettings>,
    /// Show shading normals at pixel centres, (n + 1) / 2, instead of radiance.
    #[arg(long)]
    pub(crate) normals: bool,
    /// Trace without a BVH: every ray against every primitive.
    #[arg(long)]
    pub(crate) brute_force: bool,
    /// Calls that the samples are split over; how four or more differ gives the standard errors
    /// [default: 16, and 1 with --adaptive or of a program that is started for each image].
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..), conflicts_with = "adaptive")]
    pub(crate) passes: Option<u32>,
    /// A parameter of the scene, such as albedo=0.5 or camera="camera.txt"; may be repeated.
    #[arg(long, value_name = "NAME=VALUE", value_parser = parameter)]
    pub(crate) set: Vec<(String, toml::Value)>,
}

impl Shot {
    /// With everything as `furnace render` has it where nothing is said.
    pub(crate) fn of(scene: impl Into<String>) -> Self {
        Self {
            scene: scene.into(),
            spp: 64,
            size: None,
            seed: 0,
            bounces: None,
            light_samples: 1,
            hemisphere: false,
            roulette: None,
            adaptive: None,
            normals: false,
            brute_force: false,
            passes: None,
            set: Vec::new(),
        }
    }

    /// The words that ask for it, after `furnace render`. Read again they are this shot.
    pub(crate) fn words(&self) -> Vec<String> {
        let mut words = vec![self.scene.clone()];
        let mut say = |flag: &str, value: Option<String>| {
            words.extend(value.into_iter().flat_map(|value| [format!("--{flag}"), value]));
        };
        let unless = |usual: u64, value: u64| (value != usual).then(|| value.to_string());
        say("size", self.size.map(|[width, height]| format!("{width}x{height}")));
        say("spp", unless(64, self.spp.into()));
        say("seed", unless(0, self.seed));
        say("bounces", self.bounces.as_ref().map(written));
        say("light-samples", unless(1, self.light_samples.into()));
        say("roulette", self.roulette.map(|r| format!("{},{}", r.stop, r.guaranteed)));
        let adaptive = |a: AdaptiveSettings| format!("{},{}", a.samples_per_batch, a.max_tolerance);
        say("adaptive", self.adaptive.map(adaptive));
        say("passes", self.passes.map(|passes| passes.to_string()));
        self.set.iter().for_each(|(name, value)| say("set", Some(format!("{name}={value}"))));
        let flags = [
            ("--hemisphere", self.hemisphere),
            ("--normals", self.normals),
            ("--brute-force", self.brute_force),
        ];
        words.extend(flags.iter().filter(|(_, is_on)| *is_on).map(|(flag, _)| (*flag).to_owned()));
        words
    }

    /// What a core has to be able to do.
    pub(crate) fn needs(&self) -> Capabilities {
        let is_isolated = self.bounces.as_ref().is_some_and(|bounces| *bounces.start() > 0);
        let brute = (self.brute_force, Capabilities::BRUTE_FORCE);
        let of_normals = [brute, (true, Capabilities::INTERSECT)];
        let of_radiance = [
            brute,
            (self.hemisphere, Capabilities::HEMISPHERE_SAMPLING),
            (is_isolated, Capabilities::ISOLATED_BOUNCES),
            (self.roulette.is_some(), Capabilities::ROULETTE),
            (self.adaptive.is_some(), Capabilities::ADAPTIVE_SAMPLING),
        ];
        let asked = if self.normals { &of_normals[..] } else { &of_radiance[..] };
        let needed = asked.iter().filter(|(is_asked, _)| *is_asked);
        needed.fold(Capabilities::BUILD_SCENE, |all, (_, needed)| all | *needed)
    }

    /// What stands between its rays and the primitives.
    pub(crate) fn acceleration(&self) -> Acceleration {
        if self.brute_force { Acceleration::BruteForce } else { Acceleration::DEFAULT }
    }

    /// Its scene, with its parameters.
    ///
    /// # Errors
    /// If it cannot be read.
    pub(crate) fn load(&self, library: &Library) -> Result<Arc<SceneDescription>, SceneError> {
        let overrides: Overrides = self.set.iter().cloned().collect();
        library.load(&self.scene, &overrides)
    }

    /// The camera of the scene, at the size that is asked for: rows are added or taken, pixels stay square.
    ///
    /// # Errors
    /// If there is none.
    pub(crate) fn camera(&self, scene: &SceneDescription) -> Result<Camera, String> {
        let camera = scene.camera.ok_or_else(|| {
            format!(
                "scene `{}` has no camera to render from: add a `[camera]` to it, or for a .dae file \
                 --set 'camera=\"FILE\"'",
                scene.name
            )
        })?;
        Ok(self.size.map_or(camera, |film| camera.with_film(film)))
    }

    /// As a core is told; up to `last` where no bounces are asked for.
    pub(crate) fn settings(&self, camera: &Camera, last: u32) -> RenderSettings {
        let direct = match self.hemisphere {
            true => DirectSampling::Hemisphere,
            false => DirectSampling::Lights,
        };
        let integrator = IntegratorSettings {
            samples_per_light: self.light_samples,
            bounces: self.bounces.clone().unwrap_or(0..=last),
            direct,
            roulette: self.roulette,
            seed: self.seed,
            ..IntegratorSettings::default()
        };
        let [width, height] = camera.film;
        RenderSettings {
            width,
            height,
            samples_per_pixel: self.spp,
            integrator,
            adaptive: self.adaptive,
            ..Default::default()
        }
    }

    /// Calls, no more than there are samples. A program is started for every call, which may take longer than the
    /// call; and the rule of adaptive sampling is about all samples of a pixel.
    pub(crate) fn passes(&self, is_program: bool) -> u32 {
        let usual = if is_program { 1 } else { PASSES };
        let passes = if self.adaptive.is_some() { 1 } else { self.passes.unwrap_or(usual) };
        passes.min(self.spp)
    }
}

/// `640x480`
pub(crate) fn size(word: &str) -> Result<[u32; 2], String> {
    let sides = word.split_once(['x', 'X', '×']).and_then(|(width, height)| {
        Some([width.trim().parse().ok()?, height.trim().parse().ok()?])
    });
    let sides =
        sides.filter(|sides: &[u32; 2]| sides.iter().all(|side| (1..=16_384).contains(side)));
    sides.ok_or_else(|| "not a size: write columns and rows from 1 to 16384, as 640x480".to_owned())
}

/// `5`, or `2..5`
fn bounces(word: &str) -> Result<RangeInclusive<u32>, String> {
    let (first, last) = word.split_once("..").unwrap_or(("0", word));
    let bounces = first.trim().parse().ok().zip(last.trim_start_matches('=').trim().parse().ok());
    let bounces = bounces.map(|(first, last)| first..=last).filter(|bounces| !bounces.is_empty());
    bounces
        .ok_or_else(|| "write the last bounce, as 5, or the first and the last, as 2..5".to_owned())
}

fn written(bounces: &RangeInclusive<u32>) -> String {
    match bounces.start() {
        0 => bounces.end().to_string(),
        first => format!("{first}..{}", bounces.end()),
    }
}

/// `0.3`, or `0.3,1`
fn roulette(word: &str) -> Result<Roulette, String> {
    let (stop, guaranteed) = word.split_once(',').unwrap_or((word, "0"));
    let numbers = stop.trim().parse().ok().zip(guaranteed.trim().parse().ok());
    let numbers = numbers.filter(|(stop, _)| (0.0..1.0).contains(stop));
    let roulette = numbers.map(|(stop, guaranteed)| Roulette { stop, guaranteed });
    roulette.ok_or_else(|| {
        "write the probability to stop, from 0 to less than 1, and the bounces before, as 0.3,1"
            .to_owned()
    })
}

/// `32,0.05`
fn adaptive(word: &str) -> Result<AdaptiveSettings, String> {
    let numbers = word.split_once(',').and_then(|(batch, tolerance)| {
        Some((batch.trim().parse().ok()?, tolerance.trim().parse().ok()?))
    });
    let numbers = numbers.filter(|(batch, tolerance): &(u32, f64)| {
        *batch > 0 && tolerance.is_finite() && *tolerance >= 0.0
    });
    let settings = numbers.map(|(samples_per_batch, max_tolerance)| AdaptiveSettings {
        samples_per_batch,
        max_tolerance,
    });
    settings.ok_or_else(|| "write the samples of a batch and the tolerance, as 32,0.05".to_owned())
}

/// `name=value`, the value as in TOML.
fn parameter(word: &str) -> Result<(String, toml::Value), String> {
    let (name, _) = word.split_once('=').ok_or("write NAME=VALUE")?;
    let table: toml::Table = word.parse().map_err(|_| {
        "the value is not TOML: write 0.5, [1, 2, 3] or, with quotes, \"words\"".to_owned()
    })?;
    let value = table.into_iter().next();
    value.filter(|(key, _)| key == name.trim()).ok_or_else(|| "write NAME=VALUE".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        shot: Shot,
    }

    fn read(words: &[String]) -> Result<Shot, clap::Error> {
        let all = std::iter::once("render").chain(words.iter().map(String::as_str));
        Line::try_parse_from(all).map(|line| line.shot)
    }

    #[test]
    fn the_words_of_a_shot_are_read_as_that_shot() {
        let plain = Shot::of("teapot");
        let all = Shot {
            spp: 7,
            size: Some([64, 48]),
            seed: 5,
            bounces: Some(2..=5),
            light_samples: 16,
            hemisphere: true,
            roulette: Some(Roulette { stop: 0.3, guaranteed: 1 }),
            passes: Some(2),
            set: vec![("camera".to_owned(), "a b.txt".into()), ("albedo".to_owned(), 0.5.into())],
            ..plain.clone()
        };
        let adaptive = Shot {
            adaptive: Some(AdaptiveSettings::default()),
            bounces: Some(0..=3),
            normals: true,
            brute_force: true,
            ..plain.clone()
        };
        for shot in [plain, all, adaptive] {
            assert_eq!(read(&shot.words()).unwrap(), shot);
        }
    }

    #[test]
    fn what_no_integrator_can_do_is_refused() {
        for wrong in
            ["--bounces=5..2", "--roulette=1", "--roulette=x", "--adaptive=32", "--adaptive=0,1"]
        {
            assert!(read(&["teapot".to_owned(), wrong.to_owned()]).is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_shot_needs_what_it_asks_for() {
        let shot = Shot { bounces: Some(2..=5), hemisphere: true, ..Shot::of("teapot") };
        let needed = Capabilities::ISOLATED_BOUNCES | Capabilities::HEMISPHERE_SAMPLING;
        assert_eq!(shot.needs(), needed | Capabilities::BUILD_SCENE);
    }
}
