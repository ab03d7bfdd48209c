//! How answers are judged: one check a file, its name the `check = "…"` of cases, its struct their
//! `[expect]`.
//!
//! A check sees a `&mut dyn Core` and never a particular core; it draws its random numbers from the
//! trial's seed; it leaves every verdict to [`crate::stats`]. To add one: write the file, add a
//! line to [`CHECKS`].

pub mod adaptive;
pub mod breach;
pub mod bsdf;
pub mod bvh;
pub mod camera;
mod context;
mod finding;
mod form;
pub mod image;
pub mod integrator;
pub mod light;
mod numbers;
mod oracle;
mod phrase;
mod rendering;
pub mod sampling;
pub mod shape;
mod surface;
#[cfg(test)]
mod testing;

pub use context::{CheckError, Context, Picture, PictureRole, camera_of};
pub use finding::{Clue, Finding, Measure, number};

use crate::contract::Capabilities;
use crate::text::{TomlError, read_key};
use serde::de::DeserializeOwned;

/// A way to judge a core. The struct that implements it is the `[expect]` of its cases.
pub trait Check: DeserializeOwned + Send + Sync + 'static {
    /// The word in `check = "…"`.
    const NAME: &'static str;
    /// One line for `furnace list checks`.
    const SUMMARY: &'static str;

    /// What the core must be able to do; a core without it skips the trial.
    fn needs(&self) -> Capabilities;

    /// Other capabilities that do as well, if any do.
    fn needs_instead(&self) -> Option<Capabilities> {
        None
    }

    /// What is wrong with the settings themselves, before any core is asked.
    ///
    /// # Errors
    /// A sentence for the author of the case.
    fn validate(&self) -> Result<(), String> {
        Ok(())
    }

    /// Scenes that the settings name, beside that of the case.
    fn scenes(&self) -> &[String] {
        &[]
    }

    /// Asks the core and judges.
    ///
    /// # Errors
    /// If the core did not answer, or the case or harness is at fault.
    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError>;
}

/// A check with its settings read, ready to run.
pub trait Prepared: Send + Sync {
    /// What the core must be able to do.
    fn needs(&self) -> Capabilities;

    /// What of that it cannot do, if it has these capabilities; nothing where others do as well.
    fn missing(&self, has: Capabilities) -> Capabilities;

    /// Scenes that the settings name, beside that of the case.
    fn scenes(&self) -> &[String];

    /// Asks the core and judges.
    ///
    /// # Errors
    /// If the core did not answer, or the case or harness is at fault.
    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError>;
}

impl<C: Check> Prepared for C {
    fn needs(&self) -> Capabilities {
        Check::needs(self)
    }

    fn missing(&self, has: Capabilities) -> Capabilities {
        match Check::needs_instead(self) {
            Some(instead) if has.contains(instead) => Capabilities::empty(),
            _ => Check::needs(self) - has,
        }
    }

    fn scenes(&self) -> &[String] {
        Check::scenes(self)
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        Check::run(self, context)
    }
}

/// Why a case's text did not become a check.
#[derive(Debug)]
pub enum PrepareError {
    /// The `[expect]` table is not what the check wants; carries the place in the text.
    Toml(TomlError),
    /// The values make no sense together.
    Invalid(String),
}

/// A line of [`CHECKS`].
pub struct CheckKind {
    /// The word in `check = "…"`.
    pub name: &'static str,
    /// One line for `furnace list checks`.
    pub summary: &'static str,
    /// Reads the `[expect]` table out of the whole text of a case, so that errors know their line.
    pub prepare: fn(&str) -> Result<Box<dyn Prepared>, PrepareError>,
}

impl CheckKind {
    /// The line for check `C`.
    pub const fn of<C: Check>() -> Self {
        Self { name: C::NAME, summary: C::SUMMARY, prepare: prepare::<C> }
    }
}

fn prepare<C: Check>(text: &str) -> Result<Box<dyn Prepared>, PrepareError> {
    let check: C = read_key(text, "expect").map_err(PrepareError::Toml)?;
    check.validate().map_err(PrepareError::Invalid)?;
    Ok(Box::new(check))
}

/// Every check there is, in the order of the parts of a path tracer.
pub static CHECKS: &[CheckKind] = &[
    CheckKind::of::<camera::RaysThroughFilm>(),
    CheckKind::of::<camera::ConstantFilm>(),
    CheckKind::of::<camera::PictureOrientation>(),
    CheckKind::of::<camera::PixelSamples>(),
    CheckKind::of::<camera::StratifiedSamples>(),
    CheckKind::of::<camera::ViewCoverage>(),
    CheckKind::of::<shape::HitsPrimitive>(),
    CheckKind::of::<shape::AgreesWithExactArithmetic>(),
    CheckKind::of::<shape::FarSpheres>(),
    CheckKind::of::<shape::DegenerateTriangles>(),
    CheckKind::of::<shape::LeavesItsSurface>(),
    CheckKind::of::<bvh::OverlapsBox>(),
    CheckKind::of::<shape::SharedEdges>(),
    CheckKind::of::<bvh::BoxesAreNeverMissed>(),
    CheckKind::of::<bsdf::AgreesWithItself>(),
    CheckKind::of::<bsdf::Reciprocal>(),
    CheckKind::of::<bsdf::ConservesEnergy>(),
    CheckKind::of::<bsdf::WeightsMakeTheAlbedo>(),
    CheckKind::of::<bsdf::FollowsGgx>(),
    CheckKind::of::<bsdf::ReflectsAndRefracts>(),
    CheckKind::of::<bvh::SameHitsAsBruteForce>(),
    CheckKind::of::<bvh::OrderDoesNotMatter>(),
    CheckKind::of::<shape::NoRayLeaks>(),
    CheckKind::of::<bvh::SizesAddUp>(),
    CheckKind::of::<bvh::BuildsComeToAnEnd>(),
    CheckKind::of::<bvh::VisitsFewNodes>(),
    CheckKind::of::<bvh::StopsBehindHits>(),
    CheckKind::of::<bvh::DividesLongScenes>(),
    CheckKind::of::<bvh::IsFaster>(),
    CheckKind::of::<light::LightSamplesReachLight>(),
    CheckKind::of::<light::LightNumbers>(),
    CheckKind::of::<light::OpenLightSamples>(),
    CheckKind::of::<light::LampAtTheEye>(),
    CheckKind::of::<sampling::NumbersAsGiven>(),
    CheckKind::of::<sampling::ExtremeNumbers>(),
    CheckKind::of::<sampling::PdfIntegratesToOne>(),
    CheckKind::of::<sampling::SampleJacobian>(),
    CheckKind::of::<sampling::SamplesFollowPdf>(),
    CheckKind::of::<sampling::MomentsFollowPdf>(),
    CheckKind::of::<sampling::WeightsIntegrate>(),
    CheckKind::of::<sampling::ConsecutiveSamples>(),
    CheckKind::of::<integrator::MeanRadiance>(),
    CheckKind::of::<integrator::EstimatorsAgree>(),
    CheckKind::of::<integrator::RadianceIsLinear>(),
    CheckKind::of::<integrator::BouncesAddUp>(),
    CheckKind::of::<integrator::RouletteStopsPaths>(),
    CheckKind::of::<adaptive::StopsWhereItShould>(),
    CheckKind::of::<adaptive::StopsByItsLaw>(),
    CheckKind::of::<adaptive::SampleCounts>(),
    CheckKind::of::<integrator::SameSeedSamePicture>(),
    CheckKind::of::<integrator::SeedsMatter>(),
    CheckKind::of::<integrator::NeighbouringSeeds>(),
    CheckKind::of::<integrator::RadianceIsFinite>(),
    CheckKind::of::<integrator::VarianceIsKnown>(),
    CheckKind::of::<integrator::ErrorFallsAsRootN>(),
    CheckKind::of::<integrator::ReportsItsVariance>(),
    CheckKind::of::<shape::FirstHits>(),
    CheckKind::of::<image::MatchesReference>(),
    CheckKind::of::<image::MatchesAsPng>(),
];

/// The check called `name`.
pub fn find(name: &str) -> Option<&'static CheckKind> {
    CHECKS.iter().find(|kind| kind.name == name)
}
