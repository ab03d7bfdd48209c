//! How far a renderer is from the references, as a table: brightness of the whole picture with its standard error,
//! and blocks of 8 x 8 pixels. It informs; verdicts are what `furnace run` gives.
//!
//! It needs nothing but pictures, and takes those of 8 bits too: there the pixels that are clipped in any run, or nearly
//! so in the reference, are left out on both sides. What is left is decoded, so that noise looks
//! darker than it is: by 0.4 % at 64 samples of relative deviation 1. `furnace compare` and the cases go by the law of the codes ([`crate::stats::judge_codes`]).

use crate::contract::{
    Acceleration, CoreError, DirectSampling, Film, IntegratorSettings, RenderSettings,
};
use crate::cores::command::Picture;
use crate::cores::{CoreSpec, Hosting};
use crate::image::{Image, luminance};
use crate::project::Project;
use crate::scene::reference::{self, Provenance, Reference};
use crate::scene::{Camera, Library, SceneDescription};
use std::fmt;

/// Pixels along the side of a block.
const BLOCK: usize = 8;
/// Where 8 bits end at 0.707, as the course's do, noise has to stay below.
const NEARLY_CLIPPED: f32 = 0.6;

/// How much is rendered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// Independent pictures, at least two.
    pub(crate) runs: u32,
    /// Samples a pixel in each.
    pub(crate) samples: u32,
    /// Directions over the hemisphere in place of points on lights.
    pub(crate) by_hemisphere: bool,
}

/// One reference and one renderer.
#[derive(Clone, Debug)]
pub struct Row {
    /// Relative difference of the whole picture, red, green and blue.
    pub(crate) whole: [Difference; 3],
    /// Root mean square of the blocks' differences in standard errors. With few runs it is above one by
    /// itself: √((n − 1)/(n − 3)) for n runs.
    pub(crate) blocks: f64,
    /// The largest relative difference of a block.
    pub(crate) worst: f64,
    /// Share of the pixels that were compared.
    pub(crate) compared: f64,
    /// Seconds of a run, as the renderer's log has it.
    pub(crate) seconds: Option<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Difference {
    /// Of the renderer from the reference.
    pub(crate) mean: f64,
    /// Of both together.
    pub(crate) standard_error: f64,
}

impl Difference {
    /// In standard errors.
    pub(crate) fn sigmas(self) -> f64 {
        if self.mean == 0.0 { 0.0 } else { self.mean / self.standard_error }
    }
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let agrees = self.sigmas().abs() <= 3.0;
        let mark = if agrees { "" } else { " **" };
        write!(f, "{:+.1e} ({:.0e}){mark}", self.mean, self.standard_error)
    }
}

/// Why there is no row.
#[derive(Debug, thiserror::Error)]
pub enum AgreementError {
    /// The reference or its scene cannot be had.
    #[error("{0}")]
    Reference(String),
    /// The renderer did not answer.
    #[error("{0}")]
    Core(#[from] CoreError),
}

/// The names of the references of a project, in the order of the alphabet.
pub(crate) fn references(project: &Project) -> Vec<String> {
    let folders = project.layers("references");
    let entries = folders.iter().filter_map(|folder| std::fs::read_dir(folder).ok());
    let entries = entries.flatten().flatten();
    let with_provenance = entries.filter(|entry| entry.path().join("provenance.toml").is_file());
    let mut names: Vec<_> =
        with_provenance.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.sort_unstable();
    names.dedup();
    names
}

/// Renders what a reference is of, and compares.
///
/// # Errors
/// If the reference cannot be had or the renderer does not answer.
pub(crate) fn compare(
    project: &Project,
    core: &CoreSpec,
    name: &str,
    effort: Effort,
) -> Result<Row, AgreementError> {
    let broken = |error: &dyn fmt::Display| AgreementError::Reference(error.to_string());
    let folders = project.layers("references");
    let path = reference::provenance_path(reference::folder_of(&folders, name), name);
    let text = std::fs::read_to_string(&path).map_err(|error| broken(&error))?;
    let provenance: Provenance = crate::text::read_toml(&text).map_err(|error| broken(&error))?;
    let library = Library::of(project);
    let scene =
        library.load(&provenance.scene, &provenance.parameters).map_err(|error| broken(&error))?;
    let reference = reference::load_from(&folders, name, &scene).map_err(|error| broken(&error))?;
    let camera = scene.camera.ok_or_else(|| broken(&"the scene has no camera"))?;
    let shots = render_all(core, &scene, camera, &reference, effort)?;
    Ok(row(&reference, &shots))
}

struct Shots {
    pictures: Vec<Picture>,
    seconds: Vec<f64>,
}

fn render_all(
    core: &CoreSpec,
    scene: &SceneDescription,
    camera: Camera,
    reference: &Reference,
    effort: Effort,
) -> Result<Shots, CoreError> {
    let program =
        core.program().transpose().map_err(|error| CoreError::Refused(error.to_string()))?;
    let mut shots = Shots { pictures: Vec::new(), seconds: Vec::new() };
    for run in 0..effort.runs {
        let settings = settings(camera, reference, effort, run);
        match &program {
            Some(program) => {
                let rendered = program.render(scene, &camera, &settings)?;
                shots.pictures.push(rendered.picture);
                shots.seconds.extend(rendered.log.seconds);
            }
            None => shots.pictures.push(render(core, scene, camera, &settings)?),
        }
    }
    Ok(shots)
}

fn settings(camera: Camera, reference: &Reference, effort: Effort, run: u32) -> RenderSettings {
    let [width, height] = camera.film;
    let [first, last] = reference.provenance.bounces;
    let direct = match effort.by_hemisphere {
        true => DirectSampling::Hemisphere,
        false => DirectSampling::Lights,
    };
    let seed = u64::from(run) + 1;
    let integrator =
        IntegratorSettings { bounces: first..=last, direct, seed, ..IntegratorSettings::default() };
    RenderSettings {
        width,
        height,
        samples_per_pixel: effort.samples,
        integrator,
        ..Default::default()
    }
}

fn render(
    core: &CoreSpec,
    scene: &SceneDescription,
    camera: Camera,
    settings: &RenderSettings,
) -> Result<Picture, CoreError> {
    let hosted = Hosting::default().host(core);
    let mut hosted = hosted.map_err(|error| CoreError::Refused(error.to_string()))?;
    let capabilities = hosted.core_mut().info().capabilities;
    let mut film = Film::blank(settings.width, settings.height, capabilities);
    let mut built = hosted.core_mut().build_scene(scene, Acceleration::DEFAULT)?;
    built.render(&camera, settings, &mut film)?;
    drop(built);
    let image =
        Image { width: film.width as usize, height: film.height as usize, pixels: film.pixels };
    Ok(Picture::linear(image))
}

fn row(reference: &Reference, shots: &Shots) -> Row {
    let count = reference.mean.pixels.len();
    let can_clip = shots.pictures.iter().any(|picture| picture.clipped.contains(&true));
    let is_compared: Vec<bool> = (0..count)
        .map(|pixel| {
            let is_bright = reference.mean.pixels[pixel].iter().any(|v| *v > NEARLY_CLIPPED);
            let is_clipped = shots.pictures.iter().any(|picture| picture.clipped[pixel]);
            !(is_clipped || can_clip && is_bright)
        })
        .collect();
    let compared: Vec<usize> = (0..count).filter(|pixel| is_compared[*pixel]).collect();
    let whole = std::array::from_fn(|channel| {
        difference(reference, shots, &compared, |pixel| f64::from(pixel[channel]))
    });
    let blocks: Vec<_> = blocks_of(reference.mean.width, &compared)
        .into_iter()
        .map(|block| difference(reference, shots, &block, luminance))
        .filter(|difference| difference.mean.is_finite() && difference.standard_error > 0.0)
        .collect();
    let squares: f64 = blocks.iter().map(|block| block.sigmas().powi(2)).sum();
    let seconds = shots.seconds.iter().sum::<f64>() / shots.seconds.len() as f64;
    Row {
        whole,
        blocks: (squares / blocks.len() as f64).sqrt(),
        worst: blocks.iter().map(|block| block.mean).fold(0.0, larger),
        compared: compared.len() as f64 / count as f64,
        seconds: Some(seconds).filter(|seconds| seconds.is_finite()),
    }
}

/// The one that is further from zero.
fn larger(a: f64, b: f64) -> f64 {
    if a.abs() > b.abs() { a } else { b }
}

fn blocks_of(width: usize, pixels: &[usize]) -> Vec<Vec<usize>> {
    let across = width.div_ceil(BLOCK);
    let block_of = |pixel: &usize| pixel / width / BLOCK * across + pixel % width / BLOCK;
    let mut blocks = vec![Vec::new(); pixels.iter().map(block_of).max().map_or(0, |last| last + 1)];
    for pixel in pixels {
        blocks[block_of(pixel)].push(*pixel);
    }
    blocks.retain(|block| !block.is_empty());
    blocks
}

/// Of the sum over some pixels, with the noise of both sides.
fn difference(
    reference: &Reference,
    shots: &Shots,
    pixels: &[usize],
    value: impl Fn([f32; 3]) -> f64,
) -> Difference {
    let sum = |image: &Image| pixels.iter().map(|pixel| value(image.pixels[*pixel])).sum::<f64>();
    let sums: Vec<f64> = shots.pictures.iter().map(|picture| sum(&picture.image)).collect();
    let runs = sums.len() as f64;
    let mean = sums.iter().sum::<f64>() / runs;
    let variance = sums.iter().map(|sum| (sum - mean).powi(2)).sum::<f64>() / (runs - 1.0) / runs;
    let errors = pixels.iter().map(|pixel| value(reference.standard_error.pixels[*pixel]).powi(2));
    let expected = sum(&reference.mean);
    Difference {
        mean: mean / expected - 1.0,
        standard_error: (variance + errors.sum::<f64>()).sqrt() / expected,
    }
}

/// Rows of Markdown, with a head.
pub(crate) fn table(core: &str, rows: &[(String, Result<Row, AgreementError>)]) -> String {
    let mut text = format!(
        "| {core} | red | green | blue | blocks, σ | worst block | compared | s |\n|---|---|---|---|---|---|---|---|\n"
    );
    for (name, row) in rows {
        text += &match row {
            Ok(row) => format!(
                "| {name} | {} | {} | {} | {:.2} | {:+.2} % | {:.0} % | {} |\n",
                row.whole[0],
                row.whole[1],
                row.whole[2],
                row.blocks,
                100.0 * row.worst,
                100.0 * row.compared,
                row.seconds.map_or_else(|| "–".to_owned(), |seconds| format!("{seconds:.1}")),
            ),
            Err(error) => format!("| {name} | {error} |\n"),
        };
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn builtin(name: &str, effort: Effort) -> Row {
        let project = Project::at(env!("CARGO_MANIFEST_DIR"));
        compare(&project, &"builtin".parse().unwrap(), name, effort).unwrap()
    }

    #[test]
    fn a_right_core_agrees_within_its_noise() {
        let row =
            builtin("point-light-plane", Effort { runs: 4, samples: 4, by_hemisphere: false });
        assert!(row.whole.iter().all(|whole| whole.mean.abs() < 1e-3), "{row:?}");
        assert_eq!(row.compared, 1.0);
        let text = table("builtin", &[("point-light-plane".to_owned(), Ok(row))]);
        assert!(text.contains("| point-light-plane | "), "{text}");
    }

    #[test]
    fn a_difference_that_is_no_number_is_marked() {
        let told = |mean| Difference { mean, standard_error: 0.01 }.to_string();
        assert!(told(f64::NAN).ends_with("**"));
        assert!(told(0.031).ends_with("**"));
        assert!(!told(0.029).ends_with("**"));
    }

    #[test]
    fn blocks_cover_every_pixel_once() {
        let pixels: Vec<_> = (0..20 * 9).filter(|pixel| pixel % 7 != 0).collect();
        let blocks = blocks_of(20, &pixels);
        assert_eq!(blocks.len(), 6);
        let mut all: Vec<_> = blocks.into_iter().flatten().collect();
        all.sort_unstable();
        assert_eq!(all, pixels);
    }

    #[test]
    fn clipped_pixels_are_left_out_on_both_sides() {
        let flat = |value| Image::new(2, 1, [value; 3]);
        let provenance = Project::at(env!("CARGO_MANIFEST_DIR")).references();
        let provenance = provenance.join("point-light-plane/provenance.toml");
        let reference = Reference {
            name: "two".to_owned(),
            mean: Image { pixels: vec![[0.5; 3], [4.0; 3]], ..flat(0.0) },
            standard_error: flat(0.001),
            layers: Default::default(),
            provenance: crate::text::read_toml(&std::fs::read_to_string(provenance).unwrap())
                .unwrap(),
        };
        let picture = |value| Picture {
            image: Image { pixels: vec![[value; 3], [0.7; 3]], ..flat(0.0) },
            clipped: vec![false, true],
            codes: None,
        };
        let shots = Shots { pictures: vec![picture(0.49), picture(0.51)], seconds: vec![] };
        let row = row(&reference, &shots);
        assert_eq!(row.compared, 0.5);
        assert!(row.whole[0].mean.abs() < 1e-6, "{row:?}");
        // Two runs 0.02 apart, and 0.001 of the reference, of 0.5.
        assert!((row.whole[0].standard_error - 0.01_f64.hypot(0.001) / 0.5).abs() < 1e-6);
    }
}
