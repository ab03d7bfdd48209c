//! A scene as a camera sees it: what stands at the centre of each pixel.

use crate::cause::{Cause, shape};
use crate::checks::camera::projection;
use crate::checks::law::{Answered, Terms, law_of};
use crate::checks::oracle::{Met, nearest};
use crate::checks::phrase::{figure, some_are};
use crate::checks::{Finding, Measure};
use crate::contract::{Hit, Precision, Ray};
use crate::scene::{Camera, SceneDescription, Shape};
use crate::stats::{Compared, Tolerance, Verdict, judge_exact};
use glam::{DVec2, DVec3};
use std::collections::BTreeMap;

/// Pixels whose view changes within this much of their centre, in pixels, lie on an edge and are not graded.
const EDGE: f64 = 0.05;

/// A share of graded pixels below which a picture is all edges.
const FEWEST: f64 = 0.25;

/// A pixel: what the core finds at its centre, and what is there.
pub(super) struct Pixel {
    pub(super) ray: Ray,
    pub(super) found: Hit,
    pub(super) right: Option<Met>,
    /// Nothing changes within [`EDGE`].
    pub(super) is_clear: bool,
}

/// A scene and where it is seen from.
pub(super) struct View<'a> {
    pub(super) scene: &'a SceneDescription,
    pub(super) camera: Camera,
    pub(super) size: [u32; 2],
}

impl View<'_> {
    pub(super) fn ray(&self, film: DVec2) -> Ray {
        let Camera { position, near, far, .. } = self.camera;
        let direction = projection(&self.camera, film).normalize();
        Ray { origin: position, t_min: near, direction, t_max: far }
    }

    pub(super) fn pixel(&self, film: DVec2, found: Hit) -> Pixel {
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
    pub(super) fn allowed(&self, met: &Met, precision: Precision) -> f64 {
        let cosine = met.answer.geometric_normal.dot(self.ray.direction).abs();
        let far = self.ray.origin.length() + met.answer.t;
        Tolerance::DIRECTION.of(precision) * far / cosine
    }

    /// Core and truth, where both hit the same shape.
    pub(super) fn both(&self) -> Option<(&Hit, &Met)> {
        let met = self.right.as_ref()?;
        (self.found.is_hit() && self.found.shape == met.shape).then_some((&self.found, met))
    }

    fn sees_another_shape(&self) -> bool {
        let found = self.found.is_hit().then_some(self.found.shape);
        found != self.right.map(|met| met.shape)
    }
}

impl View<'_> {
    pub(super) fn judge(&self, pixels: &[Pixel], precision: Precision) -> Finding {
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
        let reports = [
            ("depth", "depths", depth),
            (
                "geometric normal off by",
                "geometric normals",
                normals(|hit| hit.geometric_normal, |met| met.answer.geometric_normal),
            ),
            (
                "shading normal off by",
                "shading normals",
                normals(|hit| hit.shading_normal, |met| met.answer.shading_normal),
            ),
        ];
        let shapes = format!("pixels that see another shape, of {}", clear.len());
        let mut measures = vec![Measure::none(shapes, wrong.len())];
        measures.extend(reports.iter().map(|(name, _, report)| Measure::worst(name, report)));
        if (clear.len() as f64) < FEWEST * pixels.len() as f64 {
            measures.iter_mut().for_each(|measure| measure.verdict = Verdict::Inconclusive);
        }
        let another = wrong.first().map(|first| {
            let name = |shape: Option<u32>| shape.map_or("nothing".to_owned(), |s| self.name_of(s));
            let found = name(first.found.is_hit().then_some(first.found.shape));
            let right = name(first.right.map(|met| met.shape));
            let some = some_are(wrong.len(), clear.len(), "pixels");
            format!("{some} another shape's, for example {found} instead of {right}")
        });
        let off = reports.iter().filter(|(_, _, report)| report.disagree > 0);
        let off = off.map(|(_, what, report)| {
            format!("{} wrong", some_are(report.disagree, report.compared, what))
        });
        let complaints: Vec<_> = another.into_iter().chain(off).collect();
        let right = format!("{} pixels see what stands before them", clear.len());
        let allowed = both().map(|(pixel, (_, met))| pixel.allowed(met, precision));
        let away = figure(allowed.fold(0.0, f64::max));
        let resolution = format!("would have caught a surface {away} away from its place");
        let causes = if complaints.is_empty() { Vec::new() } else { causes(&clear) };
        let laws = if causes.is_empty() { self.laws(&clear, precision) } else { Vec::new() };
        let all = both().count();
        Finding::of(right, resolution, measures)
            .complaining(complaints)
            .because_each(
                causes,
                &format!("predicts the normals of all {all} pixels that see a surface"),
            )
            .by_law(laws)
    }

    /// What depths and normals are where they are wrong.
    fn laws(&self, pixels: &[&Pixel], precision: Precision) -> Vec<String> {
        let both = || pixels.iter().filter_map(|pixel| Some((&pixel.ray, pixel.both()?)));
        let law = |what: &str, of: &dyn Fn(&Hit, &Met) -> [f64; 2]| {
            let answered = |(ray, (hit, met)): (&Ray, (&Hit, &Met))| {
                let [found, right] = of(hit, met);
                let is_mesh = matches!(self.scene.shape(met.shape), Shape::Mesh(_));
                let behind = met.answer.geometric_normal.dot(ray.direction) > 0.0;
                let quantities = vec![met.answer.t];
                Answered { found, right, quantities, places: vec![is_mesh, behind] }
            };
            let answers: Vec<_> = both().map(answered).collect();
            let allowed = Tolerance::FORMULA.of(precision);
            Some((what.to_owned(), law_of(TERMS, &answers, allowed)?))
        };
        let along = |found: DVec3, right: DVec3| [found.dot(right), 1.0];
        let laws = [
            law("depth", &|hit, met| [hit.t, met.answer.t]),
            law("the geometric normal", &|hit, met| {
                along(hit.geometric_normal, met.answer.geometric_normal)
            }),
            law("the shading normal", &|hit, met| {
                along(hit.shading_normal, met.answer.shading_normal)
            }),
        ];
        // What is wrong with all three is told once.
        let laws: BTreeMap<_, _> =
            laws.into_iter().flatten().rev().map(|(what, law)| (law, what)).collect();
        laws.into_iter().map(|(law, what)| format!("{what} {law}")).collect()
    }
}

const TERMS: Terms = Terms {
    quantities: &["the distance"],
    places: &[["on meshes", "on spheres"], ["seen from behind", "seen from the front"]],
    right: "what it should be",
};

/// A way to get normals wrong: what comes out of the right ones for a ray.
type Normals = fn(&Met, &Ray) -> [DVec3; 2];

const MISTAKES: [(&Cause, Normals); 4] = [
    (&shape::NORMALS_INSIDE_OUT, |met, _| right_normals(met).map(|normal| -normal)),
    (&shape::NORMALS_FACE_RAY, |met, ray| {
        right_normals(met)
            .map(|normal| if normal.dot(ray.direction) > 0.0 { -normal } else { normal })
    }),
    (&shape::FLAT_SHADING_NORMAL, |met, _| [met.answer.geometric_normal; 2]),
    (&shape::GEOMETRIC_NORMAL_INTERPOLATED, |met, _| [met.answer.shading_normal; 2]),
];

/// Geometric and shading.
fn right_normals(met: &Met) -> [DVec3; 2] {
    [met.answer.geometric_normal, met.answer.shading_normal]
}

/// How far a normal may be from what a mistake makes of it: mistakes are a hundred times as far apart.
const EXPLAINED: f64 = 1e-3;

fn causes(pixels: &[&Pixel]) -> Vec<&'static Cause> {
    let both = || pixels.iter().filter_map(|pixel| Some((&pixel.ray, pixel.both()?)));
    let is_like = |found: &Hit, normals: [DVec3; 2]| {
        found.geometric_normal.distance(normals[0]) <= EXPLAINED
            && found.shading_normal.distance(normals[1]) <= EXPLAINED
    };
    let fits =
        |normals: Normals| both().all(|(ray, (found, met))| is_like(found, normals(met, ray)));
    if both().count() == 0 || fits(|met, _| right_normals(met)) {
        return Vec::new();
    }
    MISTAKES.iter().filter(|(_, normals)| fits(*normals)).map(|(cause, _)| *cause).collect()
}
