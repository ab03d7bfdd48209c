//! The numbers that cases state, worked out again from their scenes.

use super::by_convention::ConventionEntry;
use super::estimate::{RayEntry, RouletteEntry};
use crate::checks::bsdf::albedo::masking;
use crate::checks::oracle::{Met, nearest};
use crate::contract::{Conventions, Falloff, GlassFresnel, GlassRadiance, Ray};
use crate::math::closed_form::cavity::{ConcentricSpheres, cap_cavity, furnace};
use crate::math::closed_form::configuration_factor::{gradient_sky, polygon, sphere};
use crate::math::closed_form::delta_light::{directional_light, point_light};
use crate::math::closed_form::form_factor::{parallel_rectangles, perpendicular_rectangles};
use crate::math::closed_form::rough_dielectric::Shares;
use crate::math::closed_form::roulette::RouletteFurnace;
use crate::math::closed_form::witness::{kernel, over, over_unit_square};
use crate::math::closed_form::{coverage, fresnel, microfacet};
use crate::scene::{Library, Light, Material, SceneDescription, Shape, Surface};
use crate::text::{Colour, Vector};
use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};
use std::path::Path;
use std::sync::Arc;
use toml::{Table, Value};

/// Ten digits are printed.
const PRINTED: f64 = 1e-9;
/// Six digits are printed of what is integrated numerically.
const INTEGRATED: f64 = 2e-6;

/// In barycentric weights: far above roundings of single precision.
const BORDER: f64 = 1e-3;
/// Mirrors that a ray is followed over.
const REFLECTIONS: usize = 8;
/// Beyond every scene.
const FAR: f64 = 1e3;

/// From this bounce on a case between two spheres means all of them: the rest is a part in 500,000.
const REST: u32 = 24;

/// A case as its file has it.
struct Case {
    name: String,
    source: String,
    check: String,
    expect: Table,
    scene: Arc<SceneDescription>,
}

/// A number that a case states, and what it should be.
struct Stated {
    what: String,
    number: f64,
    form: Option<f64>,
}

/// A row of a case, for cores that have chosen so.
struct Row<'a> {
    scene: &'a SceneDescription,
    ray: Option<Ray>,
    bounces: [u32; 2],
    conventions: Conventions,
}

#[test]
fn the_numbers_of_every_case_follow_from_its_scene() {
    let (mut bound, mut wrong) = (0, Vec::new());
    for case in cases() {
        for stated in case.numbers() {
            bound += usize::from(stated.form.is_some());
            wrong.extend(stated.complaint(&case));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(bound > 250, "{bound} numbers");
}

/// A ray that runs along the border of two triangles may pass between them in a right core, by a rounding.
#[test]
fn no_ray_of_a_case_meets_the_border_of_a_triangle() {
    let mut met = Vec::new();
    for case in cases() {
        for ray in case.rays() {
            let borders = borders_along(&case.scene, ray).into_iter();
            met.extend(borders.map(|(shape, at)| format!("{}: shape {shape} at {at}", case.name)));
        }
    }
    assert!(met.is_empty(), "{}", met.join("\n"));
}

impl Stated {
    fn new(what: impl Into<String>, number: f64, form: Option<f64>) -> Self {
        Self { what: what.into(), number, form }
    }

    /// What is wrong with the number. Where a case names a form there has to be one, but for what is dark.
    fn complaint(&self, case: &Case) -> Option<String> {
        let integrated = case.source.starts_with("Quadrature");
        let is_short = integrated || case.check == "variance-is-known";
        let allowed = if is_short { INTEGRATED } else { PRINTED };
        let place = format!("{}, {}", case.name, self.what);
        match self.form {
            Some(form) => ((self.number - form).abs() > allowed * form.abs())
                .then(|| format!("{place}: {} is {form} by its form", self.number)),
            None => ((integrated || case.source.starts_with("Closed form")) && self.number != 0.0)
                .then(|| format!("{place}: nothing says why it is {}", self.number)),
        }
    }
}

fn cases() -> Vec<Case> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let scenes = Library::new(root.join("scenes"));
    let files = walkdir::WalkDir::new(root.join("cases")).into_iter().map(|entry| entry.unwrap());
    let files = files.filter(|entry| entry.path().extension().is_some_and(|e| e == "toml"));
    files.filter_map(|entry| Case::read(entry.path(), &scenes)).collect()
}

impl Case {
    /// None without a scene: the numbers of such cases are checked by their own checks.
    fn read(path: &Path, scenes: &Library) -> Option<Self> {
        let mut table: Table = toml::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
        let mut text = |key: &str| table.remove(key).unwrap().as_str().unwrap().to_owned();
        let (source, check) = (text("source"), text("check"));
        let (scene, parameters) = match table.remove("scene")? {
            Value::Table(mut table) => (table.remove("name").unwrap(), table),
            name => (name, Table::new()),
        };
        let scene = scenes.load(scene.as_str().unwrap(), &parameters).unwrap();
        let expect = table["expect"].as_table().unwrap().clone();
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        Some(Self { name, source, check, expect, scene })
    }

    fn numbers(&self) -> Vec<Stated> {
        match self.check.as_str() {
            "mean-radiance" => self.rows().flat_map(|row| self.radiances(row)).collect(),
            "error-falls-as-root-n" => self.radiances(&self.expect),
            "variance-is-known" => self.rows().flat_map(|row| self.variances(row)).collect(),
            "light-samples-reach-light" => self.tables("point").flat_map(|p| self.lit(p)).collect(),
            "view-coverage" => self.coverage(),
            _ => Vec::new(),
        }
    }

    fn tables(&self, key: &str) -> impl Iterator<Item = &Table> {
        self.expect.get(key).unwrap().as_array().unwrap().iter().map(|row| row.as_table().unwrap())
    }

    fn rows(&self) -> impl Iterator<Item = &Table> {
        self.tables("row")
    }

    /// The camera rays of its estimates.
    fn rays(&self) -> impl Iterator<Item = Ray> {
        let rows = self.expect.get("row").and_then(Value::as_array).into_iter().flatten();
        let tables = rows.filter_map(Value::as_table).chain([&self.expect]);
        let rays = tables.filter_map(|table| table.get("ray")).flat_map(|ray| match ray {
            Value::Array(several) => several.clone(),
            one => vec![one.clone()],
        });
        rays.filter_map(|ray| ray.try_into::<RayEntry>().ok()).map(|ray| ray.ray())
    }

    /// Of a row, and of those who have chosen otherwise.
    fn radiances(&self, row: &Table) -> Vec<Stated> {
        let ray = row.get("ray").or(self.expect.get("ray"));
        let ray = ray.map(|ray| read::<RayEntry>(ray).ray());
        let bounces = read(&row["bounces"]);
        let usual = [(Conventions::default(), colour(&row["radiance"]))];
        let others = row.get("by-convention").into_iter().flat_map(|entries| {
            let entries: Vec<ConventionEntry> = read(entries);
            entries.into_iter().map(|entry| (entry.over(Conventions::default()), entry.radiance.0))
        });
        let all = usual.into_iter().chain(others);
        all.flat_map(|(conventions, stated)| {
            let row = Row { scene: &self.scene, ray, bounces, conventions };
            (0..3).map(move |c| {
                let form = if stated[c] == 0.0 { None } else { row.radiance(c) };
                Stated::new(format!("bounces {bounces:?}, channel {c}"), stated[c], form)
            })
        })
        .collect()
    }

    /// Of one estimate: of paths with roulette among mirrors, or of direct light from a rectangle.
    fn variances(&self, row: &Table) -> Vec<Stated> {
        let samples = row.get("samples-per-light").map_or(1, |n| n.as_integer().unwrap());
        let by_hemisphere = self.expect.contains_key("direct");
        let relative = direct_variance(&self.scene, by_hemisphere);
        let form = |c: usize| match (&self.scene.material_of(0).surface, row.get("roulette")) {
            (Surface::Mirror { reflectance }, Some(roulette)) => {
                let RouletteEntry { stop, guaranteed } = read(roulette);
                let (albedo, survival) = (reflectance[c], 1.0 - stop.0);
                let emission = emission(&self.scene, 0, c);
                RouletteFurnace { emission, albedo, survival, guaranteed }.variance()
            }
            (Surface::Diffuse { reflectance }, _) => {
                (reflectance[c] * emission(&self.scene, 1, c)).powi(2) * relative / samples as f64
            }
            _ => f64::NAN,
        };
        let stated = colour(&row["variance"]);
        let name = row["name"].as_str().unwrap();
        (0..3).map(|c| Stated::new(name, stated[c], Some(form(c)))).collect()
    }

    /// How large the light looks from a point.
    fn lit(&self, point: &Table) -> Vec<Stated> {
        let [from, normal] = ["from", "normal"].map(|key| read::<Vector>(&point[key]).0);
        let stated = |what: &str, form: f64| {
            let number = point.get(what)?.as_float().unwrap();
            Some(Stated::new(what, number, (number != 0.0).then_some(form)))
        };
        let Some(&Light::Area { shape }) = self.scene.lights.first() else { return Vec::new() };
        let factor = form_factor(self.scene.shape(shape), from, normal);
        let angle = stated("solid-angle", solid_angle(self.scene.shape(shape), from));
        angle.into_iter().chain(stated("form-factor", factor)).collect()
    }

    /// The share of a picture, and the middle of what covers it.
    fn coverage(&self) -> Vec<Stated> {
        let camera = self.scene.camera.unwrap();
        let fields = [camera.horizontal_fov, camera.vertical_fov];
        let (share, [x, y]) = match self.scene.shape(0) {
            Shape::Sphere(sphere) => {
                let distance = sphere.centre.distance(camera.position);
                (coverage::sphere_on_axis(sphere.radius, distance, fields), [0.5; 2])
            }
            Shape::Mesh(mesh) => {
                let rectangle = mesh.as_rectangle().unwrap();
                let middle = rectangle.centre;
                let [u, v] = rectangle.sides.map(|side| side.abs().max_element());
                let ends = |at: f64, side: f64| [at - side / 2.0, at + side / 2.0];
                let (x, y) = (ends(middle.x, u), ends(middle.y, v));
                let place =
                    |at: f64, field: f64| 0.5 + at / (-2.0 * middle.z * (field / 2.0).tan());
                let centroid = [place(middle.x, fields[0]), place(middle.y, fields[1])];
                (coverage::rectangle(x, y, -middle.z, fields), centroid)
            }
        };
        let [of_x, of_y]: [f64; 2] = read(&self.expect["centroid"]);
        let of_share = self.expect["share"].as_float().unwrap();
        let numbers = [("share", of_share, share), ("x", of_x, x), ("y", of_y, y)];
        numbers.map(|(what, number, form)| Stated::new(what, number, Some(form))).into()
    }
}

/// Where a camera ray and what follows from it without chance meet the border of a triangle: what mirrors reflect, and
/// shadow rays to lights without size.
fn borders_along(scene: &SceneDescription, mut ray: Ray) -> Vec<(u32, DVec3)> {
    let mut found = Vec::new();
    for _ in 0..REFLECTIONS {
        let Some(met) = nearest(scene, &ray) else {
            found.extend(borders(scene, &ray, f64::INFINITY));
            break;
        };
        found.extend(borders(scene, &ray, met.answer.t * (1.0 + BORDER)));
        let at = ray.origin + met.answer.t * ray.direction;
        let to_lights = scene.lights.iter().filter_map(|light| match light {
            Light::Point { position, .. } => Some(*position - at),
            Light::Directional { direction, .. } => Some(-FAR * *direction),
            _ => None,
        });
        let on = |direction: DVec3| Ray::new(at + BORDER * direction, direction);
        found.extend(to_lights.flat_map(|to_light| borders(scene, &on(to_light), 1.0)));
        if !matches!(scene.material_of(met.shape).surface, Surface::Mirror { .. }) {
            break;
        }
        ray = on(ray.direction.reflect(met.answer.shading_normal));
    }
    found
}

/// Where a ray meets borders before its end.
fn borders(scene: &SceneDescription, ray: &Ray, end: f64) -> Vec<(u32, DVec3)> {
    let of_shape = |shape: u32| {
        let Shape::Mesh(mesh) = scene.shape(shape) else { return Vec::new() };
        let triangles = (0..mesh.indices.len()).map(|number| mesh.corners(number));
        triangles.filter_map(|corners| Some((shape, on_border(corners, ray, end)?))).collect()
    };
    (0..scene.shape_count() as u32).flat_map(of_shape).collect()
}

/// Where a ray crosses the plane of a triangle so near to its border.
fn on_border([a, b, c]: [DVec3; 3], ray: &Ray, end: f64) -> Option<DVec3> {
    let normal = (b - a).cross(c - a);
    let t = (a - ray.origin).dot(normal) / ray.direction.dot(normal);
    let at = ray.origin + t * ray.direction;
    let weight = |one: DVec3, other: DVec3| {
        (one - at).cross(other - at).dot(normal) / normal.length_squared()
    };
    let least = weight(a, b).min(weight(b, c)).min(weight(c, a));
    (t > 0.0 && t <= end && least.abs() < BORDER).then_some(at)
}

fn read<'de, T: serde::Deserialize<'de>>(value: &Value) -> T {
    value.clone().try_into().unwrap()
}

fn colour(value: &Value) -> [f64; 3] {
    read::<Colour>(value).0
}

impl Row<'_> {
    /// The mean radiance of a channel, if a form of this file knows it.
    fn radiance(&self, c: usize) -> Option<f64> {
        match self.scene.name.as_str() {
            "facing-squares" => Some(self.between_squares(parallel_rectangles(1.0, 1.0), c)),
            "upright-squares" => Some(self.between_squares(perpendicular_rectangles(1.0, 1.0), c)),
            _ => self.along_ray(c),
        }
    }

    /// The mean over a square, lit by the other one of two.
    fn between_squares(&self, factor: f64, c: usize) -> f64 {
        let share = |shape: u32| match self.scene.material_of(shape) {
            Material { surface: Surface::Diffuse { reflectance }, emission: None, .. } => {
                reflectance[c]
            }
            _ => emission(self.scene, shape, c),
        };
        factor * share(0) * share(1)
    }

    fn along_ray(&self, c: usize) -> Option<f64> {
        let ray = self.ray.unwrap_or_else(|| middle_of_picture(self.scene));
        let met = nearest(self.scene, &ray)?;
        let material = self.scene.material_of(met.shape);
        let cosine = met.answer.geometric_normal.dot(ray.direction).abs();
        match (&material.surface, self.scene.shape(met.shape)) {
            (Surface::Diffuse { reflectance }, Shape::Mesh(_)) => {
                let lit = self.direct(&ray, &met, c);
                (self.bounces[0] == 1).then_some(reflectance[c] * lit)
            }
            (Surface::Diffuse { .. }, Shape::Sphere(_)) => Some(self.cavity(&met, c)),
            // What refracts meets the dark half of the sky.
            (Surface::Glass { index, .. }, Shape::Mesh(mesh)) if !mesh.normals.is_empty() => {
                let normal = met.answer.shading_normal;
                let cosine = normal.dot(ray.direction);
                let reflected = ray.direction - 2.0 * cosine * normal;
                let sky = self.scene.lights.iter().map(|light| light.sky_radiance(reflected)[c]);
                Some(self.faces(cosine.abs(), *index)[0] * sky.sum::<f64>())
            }
            (Surface::Glass { index, .. }, Shape::Mesh(_)) => {
                let [outside, inside] = self.faces(cosine, *index);
                Some(fresnel::slab_transmittance(outside, inside))
            }
            (Surface::Glass { index, .. }, Shape::Sphere(sphere)) => Some(self.sphere(
                sphere.centre.distance(ray.origin) < sphere.radius,
                cosine,
                *index,
            )),
            (Surface::Conductor { reflectance, roughness }, Shape::Mesh(_))
                if self.scene.lights.iter().any(|light| matches!(light, Light::Area { .. })) =>
            {
                Some(reflectance[c] * self.glossy(&ray, &met, *roughness, c))
            }
            (Surface::Conductor { reflectance, roughness }, _) => {
                let form = masking(self.conventions.smith_term);
                Some(reflectance[c] * microfacet::albedo(cosine, *roughness, form))
            }
            (Surface::RoughGlass { index, roughness, .. }, _) => {
                let is_above = met.answer.geometric_normal.dot(ray.direction) < 0.0;
                let ratio = if is_above { *index } else { index.recip() };
                let form = masking(self.conventions.smith_term);
                let shares = Shares::of(cosine, ratio, *roughness, form);
                Some(shares.reflected + shares.refracted * self.scaled(ratio.powi(-2)))
            }
            (Surface::Mirror { reflectance }, _) => {
                Some(reflectance[c] * self.mirrored(&ray, &met, c)?)
            }
        }
    }

    /// What a mirror shows of the light that is scattered once more, where what it shows emits none.
    fn mirrored(&self, ray: &Ray, met: &Met, c: usize) -> Option<f64> {
        let direction = ray.direction.reflect(met.answer.shading_normal);
        let ray = Ray::new(ray.at(met.answer.t) + BORDER * direction, direction);
        let shown = nearest(self.scene, &ray)?;
        let bounces = [self.bounces[0].max(2) - 1, self.bounces[1].checked_sub(1)?];
        let is_dark = self.scene.material_of(shown.shape).emission.is_none();
        let row = Row { scene: self.scene, ray: Some(ray), bounces, conventions: self.conventions };
        is_dark.then(|| row.along_ray(c)).flatten()
    }

    /// What refraction does to radiance, for whoever declares that it does.
    fn scaled(&self, factor: f64) -> f64 {
        if self.conventions.glass_radiance == GlassRadiance::Scaled { factor } else { 1.0 }
    }

    /// Irradiance over π at what a ray meets. What is dark hides what it covers of a light, which is all of it or lies
    /// within the light; mirrors stand aside.
    fn direct(&self, ray: &Ray, met: &Met, c: usize) -> f64 {
        let point = ray.at(met.answer.t);
        let normal = met.answer.shading_normal;
        let normal = if normal.dot(ray.direction) < 0.0 { normal } else { -normal };
        let shapes = (0..self.scene.shape_count() as u32).filter(|shape| *shape != met.shape);
        let is_in_the_way = |material: &Material| {
            material.emission.is_none() && !matches!(material.surface, Surface::Mirror { .. })
        };
        let dark = shapes.filter(|shape| is_in_the_way(self.scene.material_of(*shape)));
        let hidden: f64 = dark.map(|shape| covers(self.scene.shape(shape), point, normal)).sum();
        let lights = self.scene.lights.iter().map(|light| match light {
            Light::Area { shape } => {
                let emitted = self.scene.material_of(*shape).emission;
                let factor = match emitted.and_then(|emitted| emitted.cap) {
                    Some(_) => over_light(self.scene, *shape, point, normal, |_| 1.0),
                    None => form_factor(self.scene.shape(*shape), point, normal),
                };
                emission(self.scene, *shape, c) * (factor - hidden)
            }
            Light::Point { position, intensity } => {
                let to = *position - point;
                let way = Ray { t_min: BORDER, t_max: 1.0 - BORDER, ..Ray::new(point, to) };
                if nearest(self.scene, &way).is_some() {
                    return 0.0;
                }
                let (height, distance) = (to.dot(normal), to.length());
                let aside = (distance * distance - height * height).sqrt();
                let falloff = match self.conventions.point_light_falloff {
                    Falloff::InverseSquare => 1.0,
                    Falloff::None => distance * distance,
                };
                falloff * point_light(intensity[c], 1.0, height, aside)
            }
            Light::Directional { direction, irradiance } => {
                directional_light(irradiance[c], 1.0, -direction.dot(normal))
            }
            Light::ConstantSky { radiance } => radiance[c],
            Light::GradientSky { up, horizon, zenith } => {
                gradient_sky(horizon[c], zenith[c] - horizon[c], up.angle_between(normal))
            }
        });
        lights.sum()
    }

    /// What a conductor of reflectance 1 sends back of the area lights, which nothing hides.
    fn glossy(&self, ray: &Ray, met: &Met, roughness: f64, c: usize) -> f64 {
        let (point, normal, wo) = (ray.at(met.answer.t), met.answer.shading_normal, -ray.direction);
        let form = masking(self.conventions.smith_term);
        let times_pi = |wi: DVec3| {
            let [o, i] = [wo, wi].map(|w| w.dot(normal));
            let d = microfacet::distribution((wo + wi).normalize().dot(normal), roughness);
            PI * d * microfacet::masking_shadowing(o, i, roughness, form) / (4.0 * o * i)
        };
        let lights = self.scene.lights.iter().map(|light| match light {
            Light::Area { shape } => {
                let seen = over_light(self.scene, *shape, point, normal, times_pi);
                emission(self.scene, *shape, c) * seen
            }
            _ => f64::NAN,
        });
        lights.sum()
    }

    /// Inside diffuse spheres.
    fn cavity(&self, met: &Met, c: usize) -> f64 {
        let albedo = |shape: u32| match self.scene.material_of(shape).surface {
            Surface::Diffuse { reflectance } => reflectance[c],
            _ => f64::NAN,
        };
        let [first, last] = self.bounces;
        let emitted = self.scene.material_of(met.shape).emission;
        let cap = emitted.and_then(|emitted| emitted.cap);
        match (self.scene.shape_count(), cap) {
            (1, None) => furnace(emission(self.scene, 0, c), albedo(0), first..=last),
            (1, Some(cap)) => {
                let from_centre = -met.answer.geometric_normal;
                let seen = emitted.map_or(0.0, |own| own.at_sphere_point(from_centre)[c]);
                let seen = if first == 0 { seen } else { 0.0 };
                let light = emission(self.scene, 0, c);
                seen + cap_cavity(light, albedo(0), cap.half_angle, first..=last)
            }
            _ => {
                let spheres = ConcentricSpheres {
                    emission: emission(self.scene, 1, c),
                    radius_ratio: radius(self.scene, 0) / radius(self.scene, 1),
                    inner_albedo: albedo(0),
                    outer_albedo: albedo(1),
                };
                let up_to = |bounce: u32| {
                    let light = spheres.up_to(if bounce < REST { bounce } else { 10 * REST });
                    if met.shape == 0 { light.inner } else { light.outer }
                };
                up_to(last) - first.checked_sub(1).map_or(0.0, up_to)
            }
        }
    }

    /// What a face of glass reflects, of light from outside and of the same light within.
    fn faces(&self, cos_outside: f64, index: f64) -> [f64; 2] {
        let sine = (1.0 - cos_outside * cos_outside).sqrt() / index;
        let cos_inside = (1.0 - sine * sine).sqrt();
        let reflectance = match self.conventions.glass_fresnel {
            GlassFresnel::Exact => fresnel::reflectance,
            GlassFresnel::Schlick => fresnel::schlick_of_view,
            GlassFresnel::SchlickOutside => fresnel::schlick,
        };
        [reflectance(cos_outside, index), reflectance(cos_inside, index.recip())]
    }

    /// A sphere of glass in a sky of radiance 1, or with a light of radiance 1 in its middle.
    fn sphere(&self, from_inside: bool, cosine: f64, index: f64) -> f64 {
        let [outside, inside] = self.faces(cosine, index);
        match (from_inside, self.scene.shape_count()) {
            (true, _) => self.scaled(index * index),
            (false, 1) => fresnel::sphere_in_furnace(outside, inside, self.bounces[1] - 1),
            (false, _) => (1.0 - outside) * self.scaled(index.powi(-2)),
        }
    }
}

fn middle_of_picture(scene: &SceneDescription) -> Ray {
    let camera = scene.camera.unwrap();
    Ray::new(camera.position, -camera.camera_to_world.z_axis)
}

/// Of a light as seen by a surface; the back of a light is dark.
fn form_factor(shape: Shape<'_>, point: DVec3, normal: DVec3) -> f64 {
    match shape {
        Shape::Mesh(mesh) => triangles(mesh)
            .filter(|[a, b, c]| (*b - *a).cross(*c - *a).dot(point - *a) > 0.0)
            .map(|corners| polygon(&corners.map(|corner| corner - point), normal))
            .sum(),
        Shape::Sphere(light) => {
            let to = light.centre - point;
            sphere(light.radius, to.length(), to.angle_between(normal))
        }
    }
}

/// The form factor of an area light above the horizon, each direction weighted, by quadrature.
fn over_light(
    scene: &SceneDescription,
    shape: u32,
    point: DVec3,
    normal: DVec3,
    weight: impl Fn(DVec3) -> f64,
) -> f64 {
    let from = |at: DVec3, leaving: DVec3| {
        kernel(normal, at - point, leaving) * weight((at - point).normalize())
    };
    let around = |axis: DVec3, [cosine, azimuth]: [f64; 2]| {
        let (x, y) = axis.any_orthonormal_pair();
        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
        sine * azimuth.cos() * x + sine * azimuth.sin() * y + cosine * axis
    };
    let cap = scene.material_of(shape).emission.and_then(|emitted| emitted.cap);
    match (scene.shape(shape), cap) {
        (Shape::Mesh(mesh), _) => triangles(mesh)
            .map(|[a, b, c]| {
                let across = (b - a).cross(c - a);
                over_unit_square(|uv| {
                    let at = a + uv.x * (b - a) + uv.x * uv.y * (c - b);
                    uv.x * across.length() * from(at, across.normalize())
                })
            })
            .sum(),
        (Shape::Sphere(sphere), Some(cap)) => {
            let low = DVec2::new(cap.half_angle.cos(), 0.0);
            sphere.radius.powi(2)
                * over(low, DVec2::new(1.0, TAU), |at| {
                    let outward = around(cap.axis, at.into());
                    from(sphere.centre + sphere.radius * outward, outward)
                })
        }
        (Shape::Sphere(sphere), None) => {
            let to = sphere.centre - point;
            let low = DVec2::new((1.0 - (sphere.radius / to.length()).powi(2)).sqrt(), 0.0);
            over(low, DVec2::new(1.0, TAU), |at| {
                let wi = around(to.normalize(), at.into());
                wi.dot(normal) / PI * weight(wi)
            })
        }
    }
}

/// The same of what is dark, from whichever side.
fn covers(shape: Shape<'_>, point: DVec3, normal: DVec3) -> f64 {
    let Shape::Mesh(mesh) = shape else { return 0.0 };
    triangles(mesh).map(|corners| polygon(&corners.map(|at| at - point), normal)).sum()
}

fn emission(scene: &SceneDescription, shape: u32, c: usize) -> f64 {
    scene.material_of(shape).emission.map_or(0.0, |emission| emission.radiance[c])
}

fn radius(scene: &SceneDescription, shape: u32) -> f64 {
    if let Shape::Sphere(sphere) = scene.shape(shape) { sphere.radius } else { f64::NAN }
}

fn triangles(mesh: &crate::scene::Mesh) -> impl Iterator<Item = [DVec3; 3]> + '_ {
    (0..mesh.indices.len()).map(|number| mesh.corners(number))
}

/// Of a triangle: Van Oosterom and Strackee (1983).
fn solid_angle(shape: Shape<'_>, point: DVec3) -> f64 {
    match shape {
        Shape::Mesh(mesh) => triangles(mesh)
            .map(|corners| {
                let [a, b, c] = corners.map(|corner| (corner - point).normalize());
                2.0 * a.dot(b.cross(c)).abs().atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a))
            })
            .sum(),
        Shape::Sphere(sphere) => {
            let sine = sphere.radius / sphere.centre.distance(point);
            2.0 * PI * (1.0 - (1.0 - sine * sine).sqrt())
        }
    }
}

/// Of one sample of a rectangle's light of radiance 1 at a white origin below it, by hemisphere or light
/// sampling: second moment less the square of the mean.
fn direct_variance(scene: &SceneDescription, by_hemisphere: bool) -> f64 {
    let Some(&Light::Area { shape }) = scene.lights.first() else { return f64::NAN };
    let Shape::Mesh(light) = scene.shape(shape) else { return f64::NAN };
    let [corner, side, other] = [0, 1, 3].map(|number| light.positions[number]);
    let (side, other) = (side - corner, other - corner);
    let normal = side.cross(other).normalize();
    let area = side.cross(other).length();
    let second_moment = over_unit_square(|p| {
        let point = corner + p.x * side + p.y * other;
        let arriving = kernel(DVec3::Z, point, normal);
        let cosine = point.normalize().z;
        // Twice the radiance for a uniform direction, or the area times the kernel for a point.
        if by_hemisphere { 2.0 * area * cosine * arriving } else { (area * arriving).powi(2) }
    });
    let mean = form_factor(scene.shape(shape), DVec3::ZERO, DVec3::Z);
    second_moment - mean * mean
}
