//! What the pixels of a picture see first: depth, normals and shapes at pixel centres against a
//! loop over everything in double precision. It finds what stands in the wrong place, or faces the
//! wrong way, before radiance is blamed for it.

use crate::cause::{Cause, shape};
use crate::checks::camera::projection;
use crate::checks::oracle::{Met, nearest};
use crate::checks::phrase::{figure, some_are};
use crate::checks::{Check, CheckError, Context, Finding, Measure, PictureRole, camera_of};
use crate::contract::{Acceleration, Capabilities, Hit, Precision, Ray};
use crate::image::Image;
use crate::scene::{Camera, SceneDescription, Shape};
use crate::stats::{Compared, Tolerance, Verdict, judge_exact};
use crate::text::Size;
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use serde::Deserialize;

/// Pixels whose view changes within this much of their centre, in pixels, lie on an edge and are
/// not graded.
const EDGE: f64 = 0.05;
/// A share of graded pixels below which a picture is all edges.
const FEWEST: f64 = 0.25;

/// Depth, normals and shapes of a picture.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct FirstHits {
    /// Columns and rows.
    size: Size,
}

impl Check for FirstHits {
    const NAME: &'static str = "first-hits";
    const SUMMARY: &'static str = "depth, normals and shapes at pixel centres";

    fn needs(&self) -> Capabilities {
        Capabilities::BUILD_SCENE | Capabilities::INTERSECT | Capabilities::GENERATE_RAYS
    }

    fn run(&self, context: &mut Context<'_>) -> Result<Finding, CheckError> {
        let scene = context.scene()?;
        let camera = camera_of(&scene)?;
        let film = self.centres();
        let mut rays = vec![Ray::new(DVec3::ZERO, DVec3::ZERO); film.len()];
        context.core.generate_rays(&camera, &film, &mut rays)?;
        let mut hits = vec![Hit::MISS; film.len()];
        let mut built = context.core.build_scene(&scene, Acceleration::DEFAULT)?;
        built.intersect(&rays, &mut hits)?;
        drop(built);
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
        let centre = |x: u32, y: u32| {
            let from_top = (f64::from(y) + 0.5) / f64::from(height);
            DVec2::new((f64::from(x) + 0.5) / f64::from(width), 1.0 - from_top)
        };
        (0..height).flat_map(|y| (0..width).map(move |x| centre(x, y))).collect()
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
pub fn first_hits(scene: &SceneDescription, camera: &Camera) -> Vec<(f64, DVec3)> {
    let view = View { scene, camera: *camera, size: camera.film };
    let seen = |film: &DVec2| {
        let met = nearest(scene, &view.ray(*film));
        met.map_or((f64::INFINITY, DVec3::ZERO), |met| (met.answer.t, met.answer.shading_normal))
    };
    FirstHits { size: Size(camera.film) }.centres().par_iter().map(seen).collect()
}

/// A pixel: what the core finds at its centre, and what is there.
struct Pixel {
    ray: Ray,
    found: Hit,
    right: Option<Met>,
    /// Nothing changes within [`EDGE`].
    is_clear: bool,
}

/// A scene and where it is seen from.
struct View<'a> {
    scene: &'a SceneDescription,
    camera: Camera,
    size: [u32; 2],
}

impl View<'_> {
    fn ray(&self, film: DVec2) -> Ray {
        let Camera { position, near, far, .. } = self.camera;
        let direction = projection(&self.camera, film).normalize();
        Ray { origin: position, t_min: near, direction, t_max: far }
    }

    fn pixel(&self, film: DVec2, found: Hit) -> Pixel {
        let step = EDGE / DVec2::new(f64::from(self.size[0]), f64::from(self.size[1]));
        let ray = self.ray(film);
        let right = nearest(self.scene, &ray);
        let named = |met: Option<Met>| met.map(|met| (met.shape, met.primitive));
        let around = [DVec2::ONE, DVec2::NEG_ONE, DVec2::new(1.0, -1.0), DVec2::new(-1.0, 1.0)];
        let is_clear = around.into_iter().all(|corner| {
            named(nearest(self.scene, &self.ray(film + corner * step))) == named(right)
        });
        Pixel { ray, found, right, is_clear }
    }

    fn name_of(&self, shape: u32) -> String {
        match self.scene.shape(shape) {
            Shape::Mesh(mesh) => mesh.name.clone(),
            Shape::Sphere(sphere) => sphere.name.clone(),
        }
    }

    /// The size of what is hit: a normal changes by about 1 over it.
    fn size_of(&self, met: &Met) -> f64 {
        match self.scene.shape(met.shape) {
            Shape::Mesh(mesh) => mesh.area(met.primitive as usize).sqrt(),
            Shape::Sphere(sphere) => sphere.radius,
        }
    }
}

impl Pixel {
    /// How far the hit point may be off along the ray: more where the surface is seen at a slant.
    fn allowed(&self, met: &Met, precision: Precision) -> f64 {
        let cosine = met.answer.geometric_normal.dot(self.ray.direction).abs();
        let far = self.ray.origin.length() + met.answer.t;
        Tolerance::DIRECTION.of(precision) * far / cosine
    }

    /// Core and truth, where both hit the same shape.
    fn both(&self) -> Option<(&Hit, &Met)> {
        let met = self.right.as_ref()?;
        (self.found.is_hit() && self.found.shape == met.shape).then_some((&self.found, met))
    }

    fn sees_another_shape(&self) -> bool {
        let found = self.found.is_hit().then_some(self.found.shape);
        found != self.right.map(|met| met.shape)
    }
}

impl View<'_> {
    fn judge(&self, pixels: &[Pixel], precision: Precision) -> Finding {
        let clear: Vec<_> = pixels.iter().filter(|pixel| pixel.is_clear).collect();
        let wrong: Vec<_> = clear.iter().filter(|pixel| pixel.sees_another_shape()).collect();
        let both = || clear.iter().filter_map(|pixel| Some((*pixel, pixel.both()?)));
        let depth = judge_exact(both().map(|(pixel, (found, met))| {
            Compared::within(found.t, met.answer.t, pixel.allowed(met, precision))
        }));
        let normals = |of: fn(&Hit) -> DVec3, right: fn(&Met) -> DVec3| {
            judge_exact(both().map(|(pixel, (found, met))| {
                let place = pixel.allowed(met, precision) / self.size_of(met);
                let allowed = Tolerance::DIRECTION.of(precision) + place;
                Compared::within(of(found).distance(right(met)), 0.0, allowed)
            }))
        };
        let geometric = normals(|hit| hit.geometric_normal, |met| met.answer.geometric_normal);
        let shading = normals(|hit| hit.shading_normal, |met| met.answer.shading_normal);
        let shapes = format!("pixels that see another shape, of {}", clear.len());
        let mut measures = vec![
            Measure::none(shapes, wrong.len()),
            Measure::worst("depth", &depth),
            Measure::worst("geometric normal off by", &geometric),
            Measure::worst("shading normal off by", &shading),
        ];
        if (clear.len() as f64) < FEWEST * pixels.len() as f64 {
            measures.iter_mut().for_each(|measure| measure.verdict = Verdict::Inconclusive);
        }
        let mut complaints = Vec::new();
        if let Some(first) = wrong.first() {
            let name = |shape: Option<u32>| shape.map_or("nothing".to_owned(), |s| self.name_of(s));
            let found = name(first.found.is_hit().then_some(first.found.shape));
            let right = name(first.right.map(|met| met.shape));
            let some = some_are(wrong.len(), clear.len(), "pixels");
            complaints
                .push(format!("{some} another shape's, for example {found} instead of {right}"));
        }
        for (report, what) in
            [(depth, "depths"), (geometric, "geometric normals"), (shading, "shading normals")]
        {
            if report.disagree > 0 {
                complaints
                    .push(format!("{} wrong", some_are(report.disagree, report.compared, what)));
            }
        }
        let right = format!("{} pixels see what stands before them", clear.len());
        let allowed = both().map(|(pixel, (_, met))| pixel.allowed(met, precision));
        let resolution = format!(
            "would have caught a surface {} away from its place",
            figure(allowed.fold(0.0, f64::max))
        );
        let causes = if complaints.is_empty() { Vec::new() } else { causes(&clear) };
        let evidence =
            format!("predicts the normals of all {} pixels that see a surface", both().count());
        Finding::of(right, resolution, measures)
            .complaining(complaints)
            .because_each(causes, &evidence)
    }
}

/// A way to get normals wrong: what comes out of the right ones for a ray.
type Normals = fn(&Met, &Ray) -> [DVec3; 2];

const MISTAKES: [(&Cause, Normals); 4] = [
    (&shape::NORMALS_INSIDE_OUT, |met, _| {
        [-met.answer.geometric_normal, -met.answer.shading_normal]
    }),
    (&shape::NORMALS_FACE_RAY, |met, ray| {
        [met.answer.geometric_normal, met.answer.shading_normal]
            .map(|normal| if normal.dot(ray.direction) > 0.0 { -normal } else { normal })
    }),
    (&shape::FLAT_SHADING_NORMAL, |met, _| [met.answer.geometric_normal; 2]),
    (&shape::GEOMETRIC_NORMAL_INTERPOLATED, |met, _| [met.answer.shading_normal; 2]),
];

/// How far a normal may be from what a mistake makes of it: mistakes are a hundred times as far
/// apart.
const EXPLAINED: f64 = 1e-3;

fn causes(pixels: &[&Pixel]) -> Vec<&'static Cause> {
    let both = || pixels.iter().filter_map(|pixel| Some((&pixel.ray, pixel.both()?)));
    let is_like = |found: &Hit, normals: [DVec3; 2]| {
        found.geometric_normal.distance(normals[0]) <= EXPLAINED
            && found.shading_normal.distance(normals[1]) <= EXPLAINED
    };
    let right: Normals = |met, _| [met.answer.geometric_normal, met.answer.shading_normal];
    let fits =
        |normals: Normals| both().all(|(ray, (found, met))| is_like(found, normals(met, ray)));
    if both().count() == 0 || fits(right) {
        return Vec::new();
    }
    MISTAKES.iter().filter(|(_, normals)| fits(*normals)).map(|(cause, _)| *cause).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::fake::Fake;
    use crate::checks::shape::as_hit;
    use crate::checks::testing::{assert_passes, check_of, failure, try_judge};
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

    fn cause(spoil: fn(&Ray, &mut Hit)) -> String {
        let finding = found(|_| (), spoil);
        failure(&finding);
        finding.clues.iter().map(|clue| clue.cause.clone()).collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn what_is_there_passes() {
        assert_passes(&found(|_| (), |_, _| ()));
    }

    #[test]
    fn a_ball_that_is_missing_is_named() {
        let finding = found(|scene| scene.spheres[1].radius = 1e-6, |_, _| ());
        let statement = failure(&finding);
        assert!(
            statement.contains("another shape's, for example back instead of right-ball"),
            "{statement}"
        );
    }

    #[test]
    fn a_ball_that_stands_a_thousandth_further_back_is_seen() {
        let finding = found(|scene| scene.spheres[0].centre.z -= 1e-3, |_, _| ());
        assert!(failure(&finding).contains(" depths are wrong"), "{}", finding.statement);
        assert!(finding.clues.is_empty());
    }

    #[test]
    fn normals_that_are_turned_have_names() {
        assert_eq!(
            cause(|_, hit| {
                hit.geometric_normal = -hit.geometric_normal;
                hit.shading_normal = -hit.shading_normal;
            }),
            "normals-inside-out"
        );
        let name =
            cause(|_, hit| hit.shading_normal = (hit.shading_normal + DVec3::Y * 0.1).normalize());
        assert_eq!(name, "");
    }
}
