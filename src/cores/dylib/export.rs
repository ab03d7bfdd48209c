//! A core in Rust as a library: the table of functions that `furnace::export_core!` exports.
//!
//! A panic does not leave the library: it ends the process, as any crash does. Not here: what the functions of questions
//! have in common with those that are lent (`answering`).
#![expect(unsafe_code, reason = "the bench calls through C")]

use super::answering::{Answerer, read_grown, status, table_of, unknown};
use super::{declaration, text};
use crate::contract::abi::given::c_name;
use crate::contract::abi::{self, CoreTable, Status, taken};
use crate::contract::question::*;
use crate::contract::{Acceleration, BuildStats, Built, BuiltScene, Components, Core, Precision};
use crate::scene::{Mesh, Sphere};
use std::ffi::{CString, c_char, c_void};
use std::{ptr, slice};

/// Makes the library of a crate a core: `furnace::export_core!(Mine::new())`.
///
/// The crate has `crate-type = ["cdylib"]`. One of the bench's own cores goes by its name:
/// `furnace::export_core!("textbook:film-y-down+brdf-without-pi")`.
/// `furnace run --core path/to/libmine.so` loads it, and `furnace grade` takes it, or the crate, as what was handed in.
#[macro_export(local_inner_macros)]
macro_rules! export_core {
    ($name:literal) => {
        export_core!(@ {
            let core = $name.parse::<$crate::cores::CoreSpec>();
            let core = core.unwrap_or_else(|unknown| ::std::panic!("{unknown}")).make();
            core.unwrap_or_else(|error| ::std::panic!("{error}"))
        });
    };
    ($core:expr) => {
        export_core!(@ ::std::boxed::Box::new($core));
    };
    (@ $boxed:expr) => {
        /// Asked once, when the library is opened.
        #[unsafe(no_mangle)]
        pub extern "C" fn furnace_core_entry(
            bench_abi: u32,
        ) -> *const $crate::contract::abi::CoreTable {
            $crate::cores::dylib::exported(bench_abi, || $boxed)
        }
    };
}

/// What a library of `export_core!` answers to the bench: null if that speaks another version of the header.
#[must_use]
pub fn exported(bench_abi: u32, make: impl FnOnce() -> Box<dyn Core>) -> *const CoreTable {
    if bench_abi == abi::ABI { table(make()) } else { ptr::null() }
}

/// The table of a core; both stay for as long as the process does.
fn table(core: Box<dyn Core>) -> &'static CoreTable {
    let info = core.info();
    let exported = Exported { core: Box::into_raw(core), built: None, reason: CString::default() };
    let this: *mut Exported = Box::into_raw(Box::new(exported));
    let mut table = table_of::<Exported>(this.cast(), info.capabilities);
    table.traits = declaration::traits(info.capabilities).bits();
    if info.precision == Precision::Single {
        table.traits |= abi::Traits::SINGLE_PRECISION.bits();
    }
    table.conventions = declaration::of_conventions(&info.conventions);
    table.name = c_name(&info.name).into_raw();
    table.version = c_name(&info.version).into_raw();
    table.last_error = Some(last_error);
    if info.capabilities.contains(Capabilities::BUILD_SCENE) {
        table.build = Some(build);
        table.release = Some(release);
    }
    if info.capabilities.contains(Capabilities::RENDER) {
        table.render = Some(render);
    }
    if !info.components.is_empty() {
        table.components = info.components.bits();
        table.take_components = Some(take_components);
    }
    Box::leak(Box::new(table))
}

/// A core, and the one scene that it has taken in.
struct Exported {
    /// Never freed. While there is a scene, that alone may reach it.
    core: *mut dyn Core,
    built: Option<Built<'static>>,
    /// Why the last call was not answered.
    reason: CString,
}

impl Exported {
    fn at_hand(&mut self) -> Result<&'static mut dyn Core> {
        let is_in_use = || CoreError::Refused("the scene before is not released".to_owned());
        // SAFETY: it is never freed, and nobody else reaches it while there is no scene.
        self.built.is_none().then(|| unsafe { &mut *self.core }).ok_or_else(is_in_use)
    }

    fn build(&mut self, scene: &SceneDescription, how: Acceleration) -> Result<BuildStats> {
        let built = self.at_hand()?.build_scene(scene, how)?;
        let stats = built.stats();
        self.built = Some(built);
        Ok(stats)
    }

    /// What C is told; why, it asks later.
    fn told(&mut self, answered: Result<()>) -> Status {
        let status = status(&answered);
        self.reason = c_name(&match answered {
            Ok(()) | Err(CoreError::Unsupported(_)) => String::new(),
            Err(CoreError::Beyond(why) | CoreError::Refused(why)) => why,
            Err(other) => other.to_string(),
        });
        status
    }

    /// SAFETY: `this` is that of the table, and nobody else is in a call.
    unsafe fn of<'a>(this: *mut c_void) -> &'a mut Self {
        // SAFETY: the caller's.
        unsafe { &mut *this.cast() }
    }
}

impl Answerer for Exported {
    unsafe fn core(this: *mut c_void, ask: impl FnOnce(&mut dyn Core) -> Result<()>) -> Status {
        // SAFETY: the caller's.
        let exported = unsafe { Self::of(this) };
        let answered = exported.at_hand().and_then(ask);
        exported.told(answered)
    }

    unsafe fn scene(
        this: *mut c_void,
        _built: *mut abi::Built,
        ask: impl FnOnce(&mut dyn BuiltScene) -> Result<()>,
    ) -> Status {
        // SAFETY: the caller's.
        let exported = unsafe { Self::of(this) };
        let answered = match &mut exported.built {
            Some(scene) => ask(scene.as_mut()),
            None => Err(CoreError::Refused("no scene is built".to_owned())),
        };
        exported.told(answered)
    }
}

unsafe extern "C" fn last_error(this: *mut c_void) -> *const c_char {
    // SAFETY: as the header says.
    unsafe { Exported::of(this) }.reason.as_ptr()
}

unsafe extern "C" fn take_components(this: *mut c_void, asked: *const abi::Taken) -> Status {
    // SAFETY: as the header says.
    unsafe {
        let components = Components::from_bits_truncate(read_grown(asked).taken);
        Exported::core(this, |core| core.take_components(components))
    }
}

unsafe extern "C" fn build(
    this: *mut c_void,
    scene: *const abi::Scene,
    settings: *const abi::Build,
    out: *mut *mut abi::Built,
    stats: *mut BuildStats,
) -> Status {
    // SAFETY: as the header says.
    unsafe {
        let exported = Exported::of(this);
        let asked = scene_in(&read_grown(scene)).zip(taken::acceleration(&read_grown(settings)));
        let asked = asked.ok_or_else(unknown);
        let answered = asked.and_then(|(scene, how)| exported.build(&scene, how));
        // There is one scene at most, which is found by the core's own pointer.
        exported.told(answered.map(|built| (*out, *stats) = (this.cast(), built)))
    }
}

unsafe extern "C" fn release(this: *mut c_void, _built: *mut abi::Built) {
    // SAFETY: as the header says.
    unsafe { Exported::of(this) }.built = None;
}

unsafe extern "C" fn render(
    this: *mut c_void,
    built: *mut abi::Built,
    camera: *const abi::Camera,
    settings: *const abi::Render,
    pixels: *mut [f32; 3],
    sample_counts: *mut u32,
) -> Status {
    // SAFETY: as the header says: `pixels` and the other arrays are of the size that the settings tell.
    unsafe {
        let camera = taken::camera(&read_grown(camera));
        let settings = read_grown(settings);
        let adaptive = settings.adaptive.as_ref().map(|adaptive| read_grown(adaptive));
        let variances = settings.variances;
        let integrator = read_grown(settings.integrator);
        let settings = taken::render(&settings, &integrator, adaptive.as_ref());
        let count = settings.width as usize * settings.height as usize;
        let mut film = Film {
            width: settings.width,
            height: settings.height,
            pixels: list(pixels, count),
            sample_counts: list(sample_counts, count),
            variances: list(variances, count),
        };
        Exported::scene(this, built, |scene| {
            scene.render(&camera, &settings, &mut film)?;
            put(&film.pixels, pixels, count)?;
            put(&film.sample_counts, sample_counts, count)?;
            if variances.is_null() { Ok(()) } else { put(&film.variances, variances, count) }
        })
    }
}

/// Writes an array of a picture.
///
/// SAFETY: there is room for `count` at `to`.
unsafe fn put<T: Copy>(from: &[T], to: *mut T, count: usize) -> Result<()> {
    if from.len() != count {
        let found = from.len();
        return Err(CoreError::breach(format!("a picture of {count} pixels has {found} values")));
    }
    // SAFETY: the caller's.
    unsafe { ptr::copy_nonoverlapping(from.as_ptr(), to, count) };
    Ok(())
}

/// A copy of an array; empty where it is null.
///
/// SAFETY: else there are `count` at `from`.
unsafe fn list<T: Copy>(from: *const T, count: usize) -> Vec<T> {
    // SAFETY: the caller's.
    if from.is_null() { Vec::new() } else { unsafe { slice::from_raw_parts(from, count) }.to_vec() }
}

/// The scene behind the pointers of the boundary; none if a number in it has no meaning.
///
/// SAFETY: they are what the header says.
unsafe fn scene_in(scene: &abi::Scene) -> Option<SceneDescription> {
    // SAFETY: the caller's.
    unsafe {
        let name = |name| text(name).unwrap_or_default();
        let material =
            |it: &abi::Material| Some(Material { name: name(it.name), ..taken::material(it)? });
        let sphere = |it: &abi::Sphere| Sphere { name: name(it.name), ..taken::sphere(it) };
        let materials = list(scene.materials, scene.material_count as usize);
        let meshes = list(scene.meshes, scene.mesh_count as usize);
        let spheres = list(scene.spheres, scene.sphere_count as usize);
        let lights = list(scene.lights, scene.light_count as usize);
        Some(SceneDescription {
            name: name(scene.name),
            camera: scene.camera.as_ref().map(|camera| taken::camera(&read_grown(camera))),
            materials: materials.iter().map(material).collect::<Option<_>>()?,
            meshes: meshes.iter().map(|mesh| mesh_in(mesh)).collect(),
            spheres: spheres.iter().map(sphere).collect(),
            lights: lights.iter().map(taken::light).collect::<Option<_>>()?,
        })
    }
}

/// SAFETY: as above.
unsafe fn mesh_in(mesh: &abi::Mesh) -> Mesh {
    let vertices = mesh.vertex_count as usize;
    // SAFETY: the caller's.
    unsafe {
        Mesh {
            name: text(mesh.name).unwrap_or_default(),
            positions: list(mesh.positions, vertices),
            normals: list(mesh.normals, vertices),
            indices: list(mesh.indices, mesh.triangle_count as usize),
            material: mesh.material,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Dylib;
    use super::*;
    use crate::contract::abi::given::{SceneTables, build as how_in_c};
    use crate::contract::{DirectSampling, Roulette, Split};
    use crate::cores::CoreSpec;
    use crate::math::rng::Seed;
    use crate::project::Project;
    use crate::scene::{Library, Overrides};
    use std::fmt::Debug;
    use std::path::Path;
    use std::sync::Arc;

    const COUNT: usize = 24;

    fn here(word: &str) -> Box<dyn Core> {
        word.parse::<CoreSpec>().unwrap().make().unwrap()
    }

    fn loaded(core: Box<dyn Core>) -> Dylib {
        Dylib::of(Path::new("exported"), exported(abi::ABI, || core), None).unwrap()
    }

    fn scenes() -> impl Iterator<Item = Arc<SceneDescription>> {
        let library = Library::new(Project::at(env!("CARGO_MANIFEST_DIR")).scenes());
        let names = library.names().unwrap();
        names.into_iter().map(move |name| library.load(&name, &Overrides::new()).unwrap())
    }

    #[test]
    fn every_scene_crosses_and_comes_back() {
        for scene in scenes() {
            let tables = SceneTables::new(&scene);
            // SAFETY: its pointers are those of the tables.
            assert_eq!(unsafe { scene_in(&tables.as_abi()) }, Some((*scene).clone()));
        }
    }

    #[test]
    fn what_is_built_crosses_and_comes_back() {
        let splits = [Split::Median, Split::MeanOfCentroids, Split::Midpoint, Split::SurfaceArea];
        let hows =
            splits.map(|split| Acceleration::Bvh { split, max_leaf_size: 3, counted: false });
        for how in hows.into_iter().chain([Acceleration::BruteForce, Acceleration::DEFAULT]) {
            let in_c = how_in_c(how, ptr::null(), ptr::null_mut());
            assert_eq!(taken::acceleration(&in_c), Some(how));
        }
    }

    /// All that a core says, bit by bit: no two numbers print alike.
    struct Said(Vec<String>);

    impl Said {
        fn note<T>(&mut self, told: Result<T>, answer: impl Debug)
        where
            T: Debug,
        {
            self.0.push(format!("{told:?} {answer:?}"));
        }
    }

    fn asked(core: &mut dyn Core, scene: &SceneDescription) -> Said {
        let mut said = Said(Vec::new());
        let mut stream = Seed(7).child(&scene.name).stream();
        let mut number = || rand::RngExt::random::<f64>(&mut stream);
        let points: Vec<_> = (0..COUNT).map(|_| DVec2::new(number(), number())).collect();
        let lobes: Vec<_> = (0..COUNT).map(|_| number()).collect();
        let random = Randomness { points: &points, lobes: &lobes, seed: 3 };
        let camera = scene.camera.unwrap_or_else(|| {
            Camera::look_at(DVec3::new(1.0, -4.0, 2.0), DVec3::ZERO, DVec3::Z, 0.8, [8, 6])
        });
        let mut rays = [Ray::new(camera.position, DVec3::Z); COUNT];
        let told = core.generate_rays(&camera, &points, &mut rays);
        said.note(told, rays);
        let bounds = scene.bounds().unwrap_or(Aabb { min: DVec3::ZERO, max: DVec3::ONE });
        let mut hits = [Hit::MISS; COUNT];
        let positions = [bounds.min, bounds.max, bounds.min.with_z(bounds.max.z)];
        for primitive in [
            Primitive::Triangle { positions, normals: [DVec3::Z; 3] },
            Primitive::Sphere { centre: bounds.max, radius: 1.0 },
        ] {
            let told = core.intersect_primitive(&primitive, &rays, &mut hits);
            said.note(told, hits);
        }
        let mut crossings = [BoxHit { t_enter: 0.0, t_exit: 0.0, hit: 0, reserved: 0 }; COUNT];
        let told = core.intersect_box(&bounds, &rays, &mut crossings);
        said.note(told, crossings);
        for sampler in [Sampler::UniformHemisphere, Sampler::CosineHemisphere] {
            let mut samples = [DirectionSample { direction: DVec3::Z, pdf: 0.0 }; COUNT];
            let told = core.sample_direction(sampler, random, &mut samples);
            said.note(told, samples);
            let mut pdf = [0.0; COUNT];
            let told = core.direction_pdf(sampler, &samples.map(|it| it.direction), &mut pdf);
            said.note(told, pdf);
        }
        let wo = rays.map(|ray| -ray.direction);
        for material in &scene.materials {
            let queries = wo.map(|wo| BsdfQuery { wo, wi: wo.with_x(-wo.x) });
            let mut values = [BsdfValue { f: [0.0; 3], pdf: 0.0 }; COUNT];
            let told = core.eval_bsdf(material, &queries, &mut values);
            said.note(told, values);
            let mut samples = [BsdfSample::NONE; COUNT];
            let told = core.sample_bsdf(material, &wo, random, &mut samples);
            said.note(told, samples);
        }
        let adaptive = AdaptiveSettings { samples_per_batch: 2, max_tolerance: 0.3 };
        let mut means = [AdaptiveMean { mean: 0.0, used: 0, reserved: 0 }; 2];
        let told = core.adaptive_mean(adaptive, &[&lobes, &lobes[..5]], &mut means);
        said.note(told, means);
        for how in [Acceleration::BruteForce, Acceleration::DEFAULT] {
            let mut built = core.build_scene(scene, how).unwrap();
            said.note(Ok(built.stats()), how);
            let told = built.intersect(&rays, &mut hits);
            said.note(told, hits);
            let mut occluded = [false; COUNT];
            let told = built.occluded(&rays, &mut occluded);
            said.note(told, occluded);
            let from = hits.map(|hit| hit.geometric_normal);
            // The last is beyond the scene.
            for light in 0..=scene.lights.len() as u32 {
                let mut samples = [LightSample::NONE; COUNT];
                let told = built.sample_light(light, &from, random, &mut samples);
                said.note(told, samples);
            }
            let roulette = Some(Roulette { stop: 0.3, guaranteed: 1 });
            let once = IntegratorSettings { bounces: 1..=1, seed: 5, ..Default::default() };
            let direct = DirectSampling::Hemisphere;
            let often = IntegratorSettings { bounces: 0..=3, direct, roulette, ..once.clone() };
            for settings in [&once, &often] {
                let mut radiance = [[0.0; 3]; COUNT];
                let told = built.radiance(&rays, settings, &mut radiance);
                said.note(told, radiance);
            }
            let (width, height, samples_per_pixel) = (4, 3, 4);
            let settings = RenderSettings {
                width,
                height,
                samples_per_pixel,
                integrator: often,
                adaptive: Some(adaptive),
                stratified: true,
            };
            let mut film = Film::blank(width, height, Capabilities::all());
            let told = built.render(&camera, &settings, &mut film);
            said.note(told, film);
        }
        said
    }

    /// Whoever it is, and whatever is wrong with it, it says the same through the table.
    #[test]
    fn an_exported_core_answers_as_it_does_at_home() {
        for word in [
            "textbook",
            "builtin",
            "textbook:film-y-down+brdf-without-pi",
            "textbook:single-precision",
            "textbook:schlick-glass+correlated-smith+no-falloff+unscaled-glass",
        ] {
            let (mut at_home, mut away) = (here(word), loaded(here(word)));
            let mut info = at_home.info();
            // C has no question for it.
            info.capabilities -= Capabilities::RENDER_CODES;
            assert_eq!(away.info(), info);
            for scene in scenes().filter(|scene| scene.primitive_count() < 100) {
                let [there, here] = [asked(&mut away, &scene), asked(&mut *at_home, &scene)];
                for (there, here) in there.0.iter().zip(&here.0) {
                    assert_eq!(there, here, "{word} in {}", scene.name);
                }
            }
        }
    }

    #[test]
    fn what_it_takes_of_the_bench_it_takes_at_home_too() {
        let word = "textbook:film-y-down+brdf-without-pi";
        let (mut at_home, mut away) = (here(word), loaded(here(word)));
        let scene = scenes().find(|scene| !scene.materials.is_empty()).unwrap();
        let wrong = asked(&mut away, &scene);
        for components in [Components::CAMERA, Components::all(), Components::empty()] {
            at_home.take_components(components).unwrap();
            away.take_components(components).unwrap();
            let [there, here] = [asked(&mut away, &scene), asked(&mut *at_home, &scene)];
            assert_eq!(there.0, here.0);
            assert_eq!(there.0 == wrong.0, components.is_empty());
        }
    }

    /// Has no function but for a camera, and answers nothing.
    struct Nearly;

    impl Core for Nearly {
        fn info(&self) -> crate::contract::CoreInfo {
            let capabilities = Capabilities::GENERATE_RAYS | Capabilities::DETERMINISTIC;
            crate::contract::CoreInfo {
                name: "nearly".to_owned(),
                capabilities,
                ..Default::default()
            }
        }

        fn generate_rays(&mut self, camera: &Camera, _: &[DVec2], _: &mut [Ray]) -> Result<()> {
            Err(match camera.film {
                [0, 0] => panic!("a film of no size"),
                [0, _] => CoreError::Refused("a film of no width".to_owned()),
                _ => CoreError::Beyond("thin lenses".to_owned()),
            })
        }
    }

    #[test]
    fn what_it_does_not_answer_and_why_crosses() {
        let mut core = loaded(Box::new(Nearly));
        assert_eq!(core.info(), Nearly.info());
        let camera = Camera::look_at(DVec3::X, DVec3::ZERO, DVec3::Z, 1.0, [20, 14]);
        for camera in [camera, Camera { film: [0, 14], ..camera }] {
            let mut rays = [Ray::new(DVec3::ZERO, DVec3::Z)];
            let told = core.generate_rays(&camera, &[DVec2::ZERO], &mut rays);
            assert_eq!(told, Nearly.generate_rays(&camera, &[], &mut []));
        }
        assert!(core.build_scene(&SceneDescription::default(), Acceleration::DEFAULT).is_err());
        assert!(exported(abi::ABI + 1, || panic!("not made")).is_null());
    }

    /// In a process of its own, which is this test again.
    #[test]
    fn a_panic_ends_the_process_and_says_why() {
        const CHILD: &str = "FURNACE_TEST_OF_PANICS";
        if std::env::var_os(CHILD).is_some() {
            let camera = Camera::look_at(DVec3::X, DVec3::ZERO, DVec3::Z, 1.0, [0, 0]);
            let mut core = loaded(Box::new(Nearly));
            let ask = || core.generate_rays(&camera, &[], &mut []);
            _ = std::panic::catch_unwind(std::panic::AssertUnwindSafe(ask));
            std::process::exit(0);
        }
        let mut again = std::process::Command::new(std::env::current_exe().unwrap());
        let name = format!("{}::a_panic_ends_the_process_and_says_why", module_path!());
        let name = name.split_once("::").unwrap().1;
        let output = again.args(["--exact", name, "--nocapture"]).env(CHILD, "1").output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(!output.status.success() && said.contains("a film of no size"), "{said}");
    }
}
