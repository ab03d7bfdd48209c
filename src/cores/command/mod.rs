//! A core that is any program which turns a scene into a picture, described by a file of `adapters/command/`.
//!
//! It lives in a worker, which starts the program anew for every picture, in a folder of its own. The program gets
//! the scene in one of the formats of [`crate::scene::format`]. It can be asked for pictures only. One that
//! writes 8 bits is asked for its codes, which are judged by their law and never decoded: what 8 bits cut off is
//! not to be held against a renderer.
//!
//! Pictures are never kept for another time: a core that is asked twice for one seed has to answer twice.

pub(crate) mod adapter;
mod picture;
pub(crate) mod process;
mod program;

pub(crate) use picture::Picture;
pub(crate) use process::found;
pub(crate) use program::{AdapterError, Program};

use crate::contract::{
    Acceleration, BuildStats, Built, BuiltScene, Capabilities, Components, Core, CoreError,
    CoreInfo, Film, Precision, RenderSettings, Result,
};
use crate::image::encoding::Encoding;
use crate::image::png::Picture as Codes;
use crate::scene::{Camera, SceneDescription};

/// A program as a core.
#[derive(Debug)]
pub(crate) struct CommandCore(pub(crate) Program);

impl Core for CommandCore {
    fn info(&self) -> CoreInfo {
        let adapter = self.0.adapter();
        let capabilities = [
            (self.0.is_linear(), Capabilities::RENDER),
            (!self.0.is_linear(), Capabilities::RENDER_CODES),
            (adapter.can.isolated_bounces, Capabilities::ISOLATED_BOUNCES),
            (adapter.can.hemisphere.is_some(), Capabilities::HEMISPHERE_SAMPLING),
            (adapter.can.deterministic, Capabilities::DETERMINISTIC),
        ];
        let has = capabilities.into_iter().filter(|(has, _)| *has).map(|(_, it)| it);
        CoreInfo {
            name: adapter.name.clone(),
            version: adapter.version.clone(),
            // What a program lacks is said of the scene that has it.
            capabilities: has
                .fold(Capabilities::BUILD_SCENE | Capabilities::ROUGH_GLASS, Capabilities::union),
            components: Components::empty(),
            precision: Precision::Single,
            conventions: adapter.conventions,
        }
    }

    /// Nothing happens yet: the scene is written with each picture, for its camera is part of it.
    fn build_scene(&mut self, scene: &SceneDescription, _: Acceleration) -> Result<Built<'_>> {
        Ok(Box::new(BuiltCommand { program: &self.0, scene: scene.clone() }))
    }
}

struct BuiltCommand<'a> {
    program: &'a Program,
    scene: SceneDescription,
}

impl BuiltScene for BuiltCommand<'_> {
    fn stats(&self) -> BuildStats {
        BuildStats::default()
    }

    fn render(
        &mut self,
        camera: &Camera,
        settings: &RenderSettings,
        film: &mut Film,
    ) -> Result<()> {
        let rendered = self.program.render(&self.scene, camera, settings)?;
        film.pixels = rendered.picture.image.pixels;
        film.sample_counts.fill(settings.samples_per_pixel);
        Ok(())
    }

    fn render_codes(
        &mut self,
        camera: &Camera,
        settings: &RenderSettings,
        codes: &mut Codes,
    ) -> Result<Encoding> {
        let unsupported = CoreError::Unsupported(Capabilities::RENDER_CODES);
        let Some(encoding) = self.program.adapter().output.encoding.of_codes() else {
            return Err(unsupported);
        };
        let rendered = self.program.render(&self.scene, camera, settings)?;
        *codes = rendered.picture.codes.ok_or(unsupported)?;
        Ok(encoding)
    }
}

#[cfg(test)]
#[cfg(unix)]
mod tests;
