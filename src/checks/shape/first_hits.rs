//! What the pixels of a picture see first: depth, normals and shapes at pixel centres against a loop over everything in
//! double precision. It finds what stands in the wrong place, or faces the wrong way, before radiance is blamed for it.

use super::view::{Pixel, View};
use crate::checks::bvh::comparison::hits_with;
use crate::checks::oracle::nearest;
use crate::checks::rendering::places;
use crate::checks::{Check, CheckError, Context, Finding, PictureRole, camera_of, check};
use crate::contract::{Acceleration, Ray};
use crate::image::Image;
use crate::scene::{Camera, SceneDescription};
use crate::text::Size;
use glam::{DVec2, DVec3};
use rayon::prelude::*;

check! {
    /// Depth, normals and shapes of a picture.
    pub(crate) struct FirstHits {
        /// Columns and rows.
        size: Size,
    }
    name: "first-hits",
    summary: "depth, normals and shapes at pixel centres",
    needs: BUILD_SCENE | INTERSECT | GENERATE_RAYS,
}

impl Check for FirstHits {
    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let scene = context.scene()?;
        let camera = camera_of(&scene)?;
        let film = self.centres();
        let mut rays = vec![Ray::new(DVec3::ZERO, DVec3::ZERO); film.len()];
        context.core.generate_rays(&camera, &film, &mut rays)?;
        let hits = hits_with(context, &scene, Acceleration::DEFAULT, &rays)?;
        let view = View { scene: &scene, camera, size: self.size.0 };
        let pixels: Vec<_> =
            film.iter().zip(hits).map(|(point, hit)| view.pixel(*point, hit)).collect();
        self.show(context, &pixels);
        Ok(view.judge(&pixels, context.info.precision))
    }
}

impl FirstHits {
    /// Of all pixels, row by row from the top, in film coordinates.
    fn centres(&self) -> Vec<DVec2> {
        let [width, height] = self.size.0;
        let centre = |[x, y]: [u32; 2]| {
            let from_top = (f64::from(y) + 0.5) / f64::from(height);
            DVec2::new((f64::from(x) + 0.5) / f64::from(width), 1.0 - from_top)
        };
        places(self.size.0).map(centre).collect()
    }

    /// Normals as colours.
    fn show(&self, context: &mut Context<'_>, pixels: &[Pixel]) {
        let [width, height] = self.size.0.map(|n| n as usize);
        let colour = |normal: Option<DVec3>| {
            normal.map_or([0.0; 3], |normal| (0.5 * (normal + 1.0)).as_vec3().to_array())
        };
        let image = |normals: Vec<Option<DVec3>>| Image {
            width,
            height,
            pixels: normals.into_iter().map(colour).collect(),
        };
        let found = |pixel: &Pixel| pixel.found.is_hit().then_some(pixel.found.shading_normal);
        let right = |pixel: &Pixel| pixel.right.map(|met| met.answer.shading_normal);
        let found = image(pixels.iter().map(found).collect());
        let right = image(pixels.iter().map(right).collect());
        context.show(PictureRole::Reference, "shading normals, in double precision", right);
        context.show(PictureRole::Render, "shading normals of the core", found);
    }
}

/// What stands at the centre of each pixel of the film, row by row from the top: distance from the
/// camera and unit shading normal; infinity and 0 where nothing does.
pub(crate) fn first_hits(scene: &SceneDescription, camera: &Camera) -> Vec<(f64, DVec3)> {
    let view = View { scene, camera: *camera, size: camera.film };
    let seen = |film: &DVec2| {
        let met = nearest(scene, &view.ray(*film));
        met.map_or((f64::INFINITY, DVec3::ZERO), |met| (met.answer.t, met.answer.shading_normal))
    };
    FirstHits { size: Size(camera.film) }.centres().par_iter().map(seen).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::camera::projection;
    use crate::checks::fake::Fake;
    use crate::checks::shape::as_hit;
    use crate::checks::testing::{assert_passes, causes, check_of, failure, try_judge};
    use crate::contract::Hit;
    use crate::scene::Library;

    fn scene(name: &str) -> SceneDescription {
        let scene = Library::new("scenes").load(name, &toml::Table::new()).unwrap();
        SceneDescription::clone(&scene)
    }

    fn found(change: fn(&mut SceneDescription), spoil: fn(&Ray, &mut Hit)) -> Finding {
        let check: FirstHits = check_of("[expect]\nsize = [32, 24]");
        let right = scene("cornell-diffuse-spheres");
        let mut seen = right.clone();
        change(&mut seen);
        let hit = move |ray: &Ray| {
            let mut hit = as_hit(nearest(&seen, ray).map(|met| met.answer));
            if let Some(met) = nearest(&seen, ray) {
                hit = Hit { shape: met.shape, primitive: met.primitive, ..hit };
            }
            spoil(ray, &mut hit);
            hit
        };
        let ray =
            |camera: &Camera, film| Ray::new(camera.position, projection(camera, film).normalize());
        let mut core = Fake { ray: Box::new(ray), hit: Box::new(hit), ..Fake::default() };
        try_judge(&check, &mut core, Some(right)).unwrap()
    }

    #[test]
    fn what_is_there_passes() {
        assert_passes(&found(|_| (), |_, _| ()));
    }

    #[test]
    fn a_sphere_that_is_missing_is_named() {
        let finding = found(|scene| scene.spheres[1].radius = 1e-6, |_, _| ());
        let told = "another shape's, for example back instead of right-ball";
        assert!(failure(&finding).contains(told), "{finding:?}");
    }

    #[test]
    fn a_sphere_that_stands_a_thousandth_further_back_is_seen() {
        let finding = found(|scene| scene.spheres[0].centre.z -= 1e-3, |_, _| ());
        assert!(failure(&finding).contains(" depths are wrong"), "{}", finding.statement);
        assert!(finding.clues.is_empty());
    }

    #[test]
    fn normals_that_are_turned_have_names() {
        let finding = found(
            |_| (),
            |_, hit| {
                hit.geometric_normal = -hit.geometric_normal;
                hit.shading_normal = -hit.shading_normal;
            },
        );
        assert_eq!(causes(&finding), ["normals-inside-out"]);
        let finding = found(
            |_| (),
            |_, hit| hit.shading_normal = (hit.shading_normal + DVec3::Y * 0.1).normalize(),
        );
        assert!(causes(&finding).is_empty());
    }
}
