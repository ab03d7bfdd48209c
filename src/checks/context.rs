//! What a check is handed: the core, the scene, the seed, the budget.

use crate::contract::{Core, CoreError, CoreInfo};
use crate::image::Image;
use crate::math::rng::Seed;
use crate::scene::{Camera, Library, SceneDescription};
use crate::stats::{Allowance, Effort};
use crate::text::{Count, Percent};
use std::path::PathBuf;
use std::sync::Arc;

/// What a check is handed.
pub struct Context<'a> {
    /// The core under test; its answers already have the contract's form.
    pub(crate) core: &'a mut dyn Core,
    /// Who the core is, what it can do and which conventions it declares.
    pub(crate) info: CoreInfo,
    /// The scene that the case names, if it names one.
    pub(crate) scene: Option<Arc<SceneDescription>>,
    /// All scenes, for checks that name their own.
    pub(crate) scenes: &'a Library,
    /// The folders of references; the first that has one counts.
    pub(crate) references: &'a [PathBuf],
    /// Seed of the trial: the same for every core, so that a core gets the same verdict on every machine.
    pub(crate) seed: Seed,
    /// How much may be spent, and so how small an error is looked for; and whether a gross one may end the trial early.
    pub(crate) budget: Allowance,
    /// Pictures for the report.
    pub(crate) pictures: Vec<Picture>,
}

impl Context<'_> {
    /// How small an error must be seen, in at most so many samples: both under the budget.
    pub(crate) fn effort(&self, detects: Percent, at_most: Count) -> Effort {
        self.budget.scale(Effort::new(detects.0).with_most_samples(at_most.0))
    }

    /// The scene that the case names.
    ///
    /// # Errors
    /// [`CheckError::Broken`] if it names none.
    pub(crate) fn scene(&self) -> Result<Arc<SceneDescription>> {
        self.scene.clone().ok_or_else(|| {
            CheckError::Broken("the case names no scene; add `scene = \"…\"`".to_owned())
        })
    }

    /// A scene that the settings name.
    pub(crate) fn load(&self, name: &str) -> Result<Arc<SceneDescription>> {
        let broken = |error: crate::scene::SceneError| CheckError::Broken(error.to_string());
        self.scenes.load(name, &toml::Table::new()).map_err(broken)
    }

    /// Keeps a picture for the report.
    pub(crate) fn show(&mut self, role: PictureRole, caption: impl Into<String>, image: Image) {
        self.pictures.push(Picture::of(role, caption, image));
    }
}

/// The camera of a scene.
///
/// # Errors
/// [`CheckError::Broken`] if it has none.
pub(crate) fn camera_of(scene: &SceneDescription) -> Result<Camera> {
    scene
        .camera
        .ok_or_else(|| CheckError::Broken(format!("scene `{}` has no `[camera]`", scene.name)))
}

#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// What it shows.
    pub(crate) role: PictureRole,
    pub(crate) caption: String,
    /// Linear RGB radiance.
    pub(crate) image: Image,
    /// The standard error of each value, if it is known.
    pub(crate) standard_error: Option<Image>,
    pub(crate) rejected: Vec<RejectedCell>,
    /// What its file holds besides.
    pub(crate) layers: Vec<Layer>,
}

/// Another image in the file of a picture: the light of one bounce, or the same by one way of sampling direct light.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Layer {
    /// Of its channels, before `.R`: `bounce.2`, `light-sampling`.
    pub(crate) name: String,
    /// Linear RGB radiance.
    pub(crate) image: Image,
}

impl Picture {
    pub(crate) fn of(role: PictureRole, caption: impl Into<String>, image: Image) -> Self {
        let caption = caption.into();
        Self {
            role,
            caption,
            image,
            standard_error: None,
            rejected: Vec::new(),
            layers: Vec::new(),
        }
    }

    pub(crate) fn with_standard_error(self, standard_error: Image) -> Self {
        Self { standard_error: Some(standard_error), ..self }
    }

    pub(crate) fn with_layers(self, layers: Vec<Layer>) -> Self {
        Self { layers, ..self }
    }
}

/// Pixels of a picture whose mean is not what it should be.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RejectedCell {
    /// `8 × 8 pixels`
    pub(crate) scale: String,
    /// `red`, `luminance`
    pub(crate) component: String,
    /// Column, row, width and height.
    pub(crate) extent: [usize; 4],
    pub(crate) measured: f64,
    pub(crate) expected: f64,
    /// How far outside what is allowed, in standard errors.
    pub(crate) t: f64,
    /// How often a correct core would be so far off in this cell.
    pub(crate) p: f64,
}

/// What a picture shows, so that the report knows how to draw it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PictureRole {
    /// What the core rendered.
    Render,
    /// What it should have rendered.
    Reference,
    /// Signed, in units where ±1 is the end of the scale.
    SignedError,
    /// Samples spent on each pixel, as a share of the cap.
    SampleRate,
}

/// What asking a core comes to: an error if it does not answer.
pub(crate) type Result<T, E = CheckError> = std::result::Result<T, E>;

/// Why a check came to no finding.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CheckError {
    /// The core did not answer.
    #[error(transparent)]
    Core(#[from] CoreError),
    /// The case or the harness is at fault: a missing reference, a scene that cannot be read.
    #[error("{0}")]
    Broken(String),
}
