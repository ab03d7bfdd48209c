//! Made-up runs for the tests of the reports: no core is asked, every number is invented.

use super::tree::RunTree;
use crate::case::Tier;
use crate::checks::{Finding, Measure, PictureRole, RejectedCell};
use crate::contract::{Capabilities, Circumstances, Components, CoreInfo, Precision};
use crate::image::exr::{Exr, Storage};
use crate::image::{CHANNELS, Channel, Image, exr};
use crate::math::rng::{Seed, uniform};
use crate::run::record::{
    CoreRecord, Machine, PictureFile, RunTiming, SceneStamp, TrialTiming, VERSION, sidecar_path,
    write_json,
};
use crate::run::{Outcome, RunRecord, TrialRecord};
use crate::stats::{Budget, Hypothesis, TestKind, Verdict};
use std::fmt::Display;
use std::path::Path;

/// A case that fails on `builtin` in [`Example::mixed`].
pub(crate) const FAILING: &str = "integrator/roulette-leaves-every-mean-as-it-is";
/// What a core could say to deceive a reader.
pub(crate) const HOSTILE: &str = "<script>alert('pass')</script> & \x1b[2J";

/// Folder, claim, title, whether it draws random numbers.
const CASES: [(&str, &str, bool); 12] = [
    (
        "camera/rays-go-through-their-film-points",
        "Camera rays pass through their film points",
        false,
    ),
    ("shape/rays-in-the-plane-miss", "Rays in the plane of a triangle miss it", false),
    ("shape/the-nearer-root-wins", "The smaller root of the quadratic is the hit", false),
    ("bvh/same-hits-as-brute-force", "BVH hits match brute force", false),
    ("bvh/a-flat-box-is-hit", "A flat box is hit", false),
    ("bsdf/cosine-samples-follow-their-density", "Samples are distributed by their pdf", true),
    (
        "light/a-rectangle-lights-a-plane",
        "A rectangle light on a plane matches the closed form",
        true,
    ),
    ("light/delta-lights-are-sampled-once", "A point light costs one shadow ray", false),
    ("integrator/furnace-bounce-by-bounce", "The furnace matches its geometric series", true),
    (FAILING, "Russian roulette leaves every mean unchanged", true),
    ("adaptive/adaptive-counts-are-true", "Adaptive sampling says how many samples it took", true),
    ("image/cornell-spheres", "The Cornell box agrees with Mitsuba", true),
];

/// A run that is not yet on disk.
pub(crate) struct Example {
    pub(crate) run: RunRecord,
    pub(crate) trials: Vec<TrialRecord>,
    /// Width and height of pictures, pixels.
    pub(crate) picture_size: (usize, usize),
}

impl Example {
    /// Twelve cases on two cores; everything passes.
    pub(crate) fn green() -> Self {
        Self::of_cases(CASES.iter().map(|(case, ..)| (*case).to_owned()))
    }

    /// As many cases and pictures as the default suite has.
    pub(crate) fn of_default_size() -> Self {
        let numbered = |round: usize| {
            let copies = if round == 0 { &CASES[..] } else { &CASES[..11] };
            copies.iter().map(move |(case, ..)| format!("{case}-{round}"))
        };
        let pictures =
            ["cornell-glass", "point-light", "area-light", "veach-plates", "closed-furnace"];
        let pictures = pictures.map(|name| format!("image/{name}"));
        Self::of_cases((0..17).flat_map(numbered).chain(pictures))
    }

    /// [`Example::green`] with every other way to end.
    pub(crate) fn mixed() -> Self {
        let crash = "signal 11 (segmentation fault)".to_owned();
        let missing = "references/cornell-spheres/mean.exr is missing\n\
                       hint: furnace reference make cornell-spheres";
        let nan = vec![Measure::exact("t", f64::NAN, 1.0, 1e-6)];
        let furnace = "integrator/furnace-bounce-by-bounce";
        let intersect = || "intersect".to_owned();
        let ends = [
            ("builtin", FAILING, wrong_roulette()),
            ("builtin", "image/cornell-spheres", wrong_picture()),
            (
                "textbook",
                "bvh/a-flat-box-is-hit",
                Outcome::Crashed { how: crash, during: intersect() },
            ),
            (
                "textbook",
                "bvh/same-hits-as-brute-force",
                Outcome::TimedOut { limit: 30.0, during: intersect() },
            ),
            ("textbook", FAILING, Outcome::Blocked { by: furnace.to_owned() }),
            ("textbook", furnace, undecided()),
            (
                "textbook",
                "adaptive/adaptive-counts-are-true",
                Outcome::Skipped { missing: vec!["adaptive-sampling".to_owned()] },
            ),
            ("textbook", "image/cornell-spheres", Outcome::Broken { why: missing.to_owned() }),
            (
                "textbook",
                "shape/the-nearer-root-wins",
                Outcome::Judged { finding: Finding::of(HOSTILE, HOSTILE, nan) },
            ),
        ];
        let mut example = Self::green();
        for (core, case, outcome) in ends {
            example.set(core, case, outcome);
        }
        example
    }

    fn of_cases(cases: impl Iterator<Item = String>) -> Self {
        let mut cases: Vec<_> = cases.collect();
        cases.sort();
        let cores = [core("builtin", Precision::Single), core("textbook", Precision::Double)];
        let trials: Vec<_> = cores
            .iter()
            .flat_map(|core| cases.iter().map(|case| trial(&core.spec, case)))
            .collect();
        let run = RunRecord {
            version: VERSION,
            furnace: "0.1.0".to_owned(),
            cores: cores.to_vec(),
            filters: Vec::new(),
            suite: None,
            budget: Budget::Default,
            seed: 1,
            trials: trials.len(),
            counts: None,
            fail_fast: false,
            with: Components::empty(),
            machine: Machine {
                system: "linux".to_owned(),
                architecture: "x86_64".to_owned(),
                threads: 2,
            },
            timing: RunTiming { started: 1_795_230_840, seconds: Some(71.3) },
        };
        Self { run, trials, picture_size: (24, 16) }
    }

    pub(crate) fn set(&mut self, core: &str, case: &str, outcome: Outcome) {
        let trial = self.trials.iter_mut().find(|t| t.core == core && t.case == case).unwrap();
        trial.outcome = outcome;
    }

    pub(crate) fn rename_core(&mut self, spec: &str, name: &str) {
        for core in self.run.cores.iter_mut().filter(|core| core.spec == spec) {
            (core.spec, core.name) = (name.to_owned(), name.to_owned());
        }
        for trial in self.trials.iter_mut().filter(|trial| trial.core == spec) {
            name.clone_into(&mut trial.core);
        }
    }

    pub(crate) fn write(&self, folder: &Path) {
        self.write_records(folder);
        for trial in &self.trials {
            let sidecar = sidecar_path(folder, &trial.core, &trial.case);
            for picture in &trial.pictures {
                let image = draw(trial, picture.role, self.picture_size);
                let file = with_layers(Exr::from_image(&image), &image, picture.role);
                exr::write(&sidecar.with_file_name(&picture.file), &file).unwrap();
            }
        }
    }

    /// Writes `run.json` and the sidecars; the pictures stay missing.
    pub(crate) fn write_records(&self, folder: &Path) {
        write_json(&folder.join("run.json"), &self.run).unwrap();
        for trial in &self.trials {
            write_json(&sidecar_path(folder, &trial.core, &trial.case), trial).unwrap();
        }
    }

    /// As it would read back; its folder does not exist.
    pub(crate) fn tree(self) -> RunTree {
        let folder = "no-such-folder".into();
        RunTree { run: self.run, trials: self.trials, folder }.diagnosed()
    }
}

fn core(spec: &str, precision: Precision) -> CoreRecord {
    let (name, version) = (spec.to_owned(), "0.1.0".to_owned());
    let capabilities = Capabilities::GENERATE_RAYS | Capabilities::RENDER;
    CoreRecord::new(
        spec,
        &CoreInfo { name, version, precision, capabilities, ..Default::default() },
    )
}

pub(crate) fn trial(core: &str, case: &str) -> TrialRecord {
    let seed = Seed::SUITE.child(core).child(case);
    let known = CASES.iter().find(|(name, ..)| case.starts_with(name));
    let (title, is_random) = known.map_or(("An image agrees", true), |case| (case.1, case.2));
    let name = case.rsplit('/').next().unwrap_or(case);
    TrialRecord {
        version: VERSION,
        case: case.to_owned(),
        core: core.to_owned(),
        title: title.to_owned(),
        teaches: "The throughput of a survivor of Russian roulette is divided by the survival probability.".to_owned(),
        source: "By hand: L = Le (1 - rho^(m+1)) / (1 - rho); Le = 0.7, rho = 0.37.".to_owned(),
        check: "mean-radiance".to_owned(),
        tier: Tier::Graded,
        role: None,
        rests_on: Vec::new(),
        proves: Vec::new(),
        case_hash: format!("{:064x}", seed.child("case").0),
        with: Components::empty(),
        scene: is_random
            .then(|| SceneStamp { name: name.to_owned(), hash: format!("{:064x}", seed.0), shown: "[-y, x, z]".to_owned(), is_specular: false }),
        budget: Budget::Default,
        seed: seed.0,
        outcome: Outcome::Judged { finding: if is_random { agreeing(seed) } else { exact(seed) } },
        work: 0,
        circumstances: Circumstances::empty(),
        pictures: if case.starts_with("image/") { pictures(name) } else { Vec::new() },
        printed: String::new(),
        rerun: format!("cargo furnace run {case} --core {core}"),
        timing: TrialTiming { seconds: uniform(&mut seed.child("time").stream()).powi(3) * 8.0 },
    }
}

fn exact(seed: Seed) -> Finding {
    let error = uniform(&mut seed.stream()) * 1e-6;
    let measures = vec![
        Measure::exact("largest distance to the film point", error, 0.0, 2e-6).in_unit("film"),
        Measure::exact("rays that hit", 4096.0, 4096.0, 0.0),
    ];
    Finding::of(
        "4096 rays have the expected directions",
        "would have caught a ray off by 2e-6 of the film's width",
        measures,
    )
}

/// A measure that is right, made noisy: about as far from its expectation as noise brings it.
fn noisy(right: Measure, factor: f64, seed: Seed) -> Measure {
    let error = (uniform(&mut seed.child(right.name()).stream()) - 0.5) * 0.004;
    let measured = right.expected * (factor + error);
    let half = 0.003 * right.expected;
    let is_wrong = (factor - 1.0).abs() >= 0.01;
    Measure {
        measured,
        interval: Some([measured - half, measured + half]),
        resolution: Some(0.012 + error.abs()),
        p_value: Some(if is_wrong { 1e-9 } else { uniform(&mut seed.child("p").stream()) }),
        verdict: Verdict::pass_if(!is_wrong),
        hypothesis: Some(Hypothesis::new(TestKind::Mean, is_wrong)),
        ..right
    }
}

/// A row whose number is this.
fn row(name: impl Display, value: f64) -> Measure {
    Measure::exact("", value, value, 0.001 * value).of_row(name)
}

fn bounces(seed: Seed, factor: f64) -> Vec<Measure> {
    let albedos = [0.37, 0.53, 0.71];
    let channel = |bounce: i32| {
        CHANNELS.map(|channel| {
            let expected = 0.7 * f64::powi(albedos[channel.index()], bounce);
            let right = row(format!("bounce {bounce}"), expected).of_channel(channel);
            noisy(right, factor.powi((bounce - 1).max(0)), seed)
        })
    };
    (0..4).flat_map(channel).collect()
}

fn agreeing(seed: Seed) -> Finding {
    let resolution = "would have caught an error of 1.4 % in any bounce";
    Finding::of("every bounce agrees within 0.2 %", resolution, bounces(seed, 1.0))
}

fn wrong_roulette() -> Outcome {
    let finding = Finding::of(
        "bounce 2 is 0.70 times the expected value and bounce 3 0.49 times: every bounce after the first loses the same factor in all channels",
        "would have caught an error of 1.4 % in any bounce",
        bounces(Seed::SUITE, 0.7),
    );
    Outcome::Judged { finding }
}

fn wrong_picture() -> Outcome {
    let whole = noisy(row("whole image, luminance", 0.42), 0.905, Seed::SUITE);
    let tiles = Measure::exact("tiles that disagree", 887.0, 0.0, 0.0);
    let finding = Finding::of(
        "the image is 9.5 % too dark, most of all on the ceiling; 887 of 900 tiles disagree",
        "would have caught an error of 0.4 % of the whole image, or of 11 % in one 8 x 8 tile",
        vec![whole, tiles],
    );
    Outcome::Judged { finding }
}

fn undecided() -> Outcome {
    let mut measure = noisy(row("bounce 3", 0.0354).of_channel(Channel::Red), 1.0, Seed::SUITE);
    measure.verdict = Verdict::Inconclusive;
    let finding = Finding::of(
        "nothing disagrees, but the noise could hide an error of 6 %, and 2 % should be detected",
        "an error of 6 % or more would have been caught; 2 % takes 9 times the samples",
        vec![measure],
    );
    Outcome::Judged { finding }
}

fn pictures(name: &str) -> Vec<PictureFile> {
    let picture = |(number, role, caption): (usize, _, &str)| PictureFile {
        role,
        caption: caption.to_owned(),
        file: format!("{name}.{number}.exr"),
        rejected: if role == PictureRole::Render { rejected() } else { Vec::new() },
    };
    [
        (0, PictureRole::Reference, "Mitsuba 3.9.1, 131072 samples per pixel"),
        (1, PictureRole::Render, "mean of 8 runs of 32 samples per pixel"),
        (2, PictureRole::SignedError, "relative error; the ends of the scale are 25 % off"),
        (3, PictureRole::SampleRate, "samples, as a fraction of 2048"),
    ]
    .map(picture)
    .to_vec()
}

fn rejected() -> Vec<RejectedCell> {
    let cell = |scale: &str, extent| RejectedCell {
        scale: scale.to_owned(),
        component: "luminance".to_owned(),
        extent,
        measured: 0.38,
        expected: 0.42,
        t: -14.3,
        p: 2e-46,
    };
    vec![cell("tile of 8 x 8", [8, 0, 8, 8]), cell("whole picture", [0, 0, 24, 16])]
}

/// With three bounces, each of half the image, and both ways of sampling of a render.
fn with_layers(file: Exr, image: &Image, role: PictureRole) -> Exr {
    let names: &[&str] = match role {
        PictureRole::Reference => &["bounce.0.", "bounce.1.", "bounce.2."],
        PictureRole::Render => {
            &["bounce.0.", "bounce.1.", "bounce.2.", "light-sampling.", "hemisphere-sampling."]
        }
        PictureRole::SignedError | PictureRole::SampleRate => &[],
    };
    let half = image.map(|pixel| pixel.map(|value| 0.5 * value));
    names.iter().fold(file, |file, name| file.with_colours(name, &half, Storage::Half))
}

/// A box with a red and a green wall and a light, noisy where it was rendered, dark where it is to fail.
fn draw(trial: &TrialRecord, role: PictureRole, (width, height): (usize, usize)) -> Image {
    let mut image = Image::new(width, height, [0.0; 3]);
    let is_wrong = trial.outcome == wrong_picture();
    let mut noise = Seed(7).child(&trial.core).child(&trial.case).stream();
    for (number, pixel) in image.pixels.iter_mut().enumerate() {
        let x = (number % width) as f64 / width as f64;
        let y = (number / width) as f64 / height as f64;
        let bias = if is_wrong { 0.6 + 0.4 * y } else { 1.0 };
        let mut value = |channel: usize| {
            let random = uniform(&mut noise) + uniform(&mut noise) - 1.0;
            match role {
                PictureRole::Reference => walls(x, y, channel),
                PictureRole::Render => walls(x, y, channel) * bias * (1.0 + 0.15 * random),
                PictureRole::SignedError => (bias - 1.0) * 2.0 + 0.3 * random,
                PictureRole::SampleRate => (x * 9.0).sin().abs() * y + 0.05 * random.abs(),
            }
        };
        *pixel = std::array::from_fn(|channel| value(channel) as f32);
    }
    if role == PictureRole::Render && is_wrong {
        image.pixels[width + 1] = [f32::NAN; 3];
    }
    image
}

fn walls(x: f64, y: f64, channel: usize) -> f64 {
    let wall = match () {
        () if x < 0.18 => [0.57, 0.04, 0.04],
        () if x > 0.82 => [0.05, 0.33, 0.08],
        () => [0.73, 0.72, 0.68],
    };
    let light = (x - 0.5).abs() < 0.12 && (0.04..0.1).contains(&y);
    let sphere = (x - 0.38).powi(2) + (y - 0.7).powi(2);
    let shade = if sphere < 0.02 { 0.25 + 8.0 * (0.02 - sphere) } else { 0.9 - 0.5 * y };
    if light { 12.0 } else { wall[channel] * shade * (0.5 + x * (1.0 - x)) }
}
