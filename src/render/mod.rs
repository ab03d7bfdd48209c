//! One image of one scene by one core: what is asked for, in the words of `furnace render`, and what comes of it. A
//! write-up is many of them.

mod normals;
mod output;
mod passes;
mod shot;

pub(crate) use normals::camera_rays;
pub(crate) use output::{Output, SAMPLES};
pub(crate) use shot::{Shot, size};

use crate::contract::validate::Validated;
use crate::contract::{BuiltScene, Capabilities, Core, CoreError, CoreInfo, RenderSettings};
use crate::image::png::Picture;
use crate::scene::{Camera, SceneDescription};
use passes::{Job, Rendered};
use std::time::Instant;

/// An image as a core has made it.
pub(crate) struct Made {
    pub(crate) shown: Shown,
    /// Of the core alone, without the build.
    pub(crate) seconds: f64,
}

/// What a core answers with.
pub(crate) enum Shown {
    Radiance(Rendered),
    /// 8 bits, of a core that has nothing else.
    Codes(Picture),
}

impl Made {
    /// What is wrong with the form of its pixels.
    pub(crate) fn breach(&self) -> Option<&CoreError> {
        match &self.shown {
            Shown::Codes(_) => None,
            Shown::Radiance(rendered) => rendered.breach.as_ref(),
        }
    }
}

/// What is rendered, and how: a [`Shot`] of a scene that has been read.
pub(crate) struct Request<'a> {
    pub(crate) shot: &'a Shot,
    pub(crate) scene: &'a SceneDescription,
    pub(crate) camera: &'a Camera,
    pub(crate) settings: &'a RenderSettings,
    /// Calls that the samples are split over.
    pub(crate) passes: u32,
}

impl Request<'_> {
    /// Has it rendered; `tell` hears how many samples of a pixel there are.
    ///
    /// # Errors
    /// If the core makes no image.
    pub(crate) fn put_to(
        &self,
        core: &mut dyn Core,
        tell: impl FnMut(u32),
    ) -> Result<Made, CoreError> {
        let info = core.info();
        let missing = missing(self.shot, &info);
        if !missing.is_empty() {
            return Err(CoreError::Unsupported(missing));
        }
        if self.shot.normals {
            return self.normals(core, info.capabilities);
        }
        let mut core = Validated::new(core);
        let mut built = core.build_scene(self.scene, self.shot.acceleration())?;
        let begun = Instant::now();
        let shown = match renders_codes_alone(&info) {
            true => self.codes(built.as_mut())?,
            false => Shown::Radiance(self.job(info.capabilities).render(built.as_mut(), tell)?),
        };
        Ok(Made { shown, seconds: begun.elapsed().as_secs_f64() })
    }

    fn job(&self, capabilities: Capabilities) -> Job<'_> {
        let Self { camera, settings, passes, .. } = *self;
        Job { camera, settings, passes, capabilities }
    }

    fn codes(&self, scene: &mut dyn BuiltScene) -> Result<Shown, CoreError> {
        let mut codes = Picture::default();
        scene.render_codes(self.camera, self.settings, &mut codes)?;
        Ok(Shown::Codes(codes))
    }

    /// Normals that are not unit are shown in their directions, and said.
    fn normals(&self, core: &mut dyn Core, capabilities: Capabilities) -> Result<Made, CoreError> {
        let render = |mut core: Validated<'_>| normals::render(&mut core, capabilities, self);
        let ((image, seconds), breach) = match render(Validated::new(core)) {
            Err(CoreError::BrokeContract(breach)) if breach.can_be_mended() => {
                (render(Validated::mending(core))?, Some(CoreError::BrokeContract(breach)))
            }
            answer => (answer?, None),
        };
        let shown = Rendered { breach, ..Rendered::of_values(image) };
        Ok(Made { shown: Shown::Radiance(shown), seconds })
    }
}

/// What a core cannot do of what a shot needs.
pub(crate) fn missing(shot: &Shot, info: &CoreInfo) -> Capabilities {
    let renders = match shot.normals || renders_codes_alone(info) {
        true => Capabilities::empty(),
        false => Capabilities::RENDER,
    };
    (shot.needs() | renders).difference(info.capabilities)
}

/// Whether a core writes 8 bits and nothing else.
pub(crate) fn renders_codes_alone(info: &CoreInfo) -> bool {
    let can = |one| info.capabilities.contains(one);
    can(Capabilities::RENDER_CODES) && !can(Capabilities::RENDER)
}
