//! The C boundary is what its header says: it compiles as C99 and C++17, its sizes and offsets are Rust's, and a core
//! written with either header answers.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod support;

use furnace::contract::abi::{self, Traits};
use furnace::contract::crossing::{Element, Layout};
use furnace::contract::validate::Validated;
use furnace::contract::{
    Acceleration, AdaptiveMean, BoxHit, BsdfQuery, BsdfSample, BsdfValue, BuildStats, Capabilities,
    Components, Core, CoreError, DirectionSample, Hit, IntegratorSettings, LightSample, Primitive,
    Randomness, Ray, Sampler, TraversalStats,
};
use furnace::cores::dylib::Dylib;
use furnace::scene::{Camera, Light, Material, Mesh, SceneDescription, Surface};
use glam::{DVec2, DVec3};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::mem::offset_of;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;
use support::{compile, compile_core, compiler, cpp_compiler};

const STRICT: &[&str] = &["-pedantic", "-Wall", "-Wextra", "-Werror"];

#[test]
fn the_headers_are_c99_and_cpp17_and_that_of_c_has_no_padding() {
    let cpp = cpp_compiler();
    let cc = compiler("CC", "cc", "C");
    compile_header(&cc, "furnace_core.h", "c", &["-std=c99", "-Wpadded"]);
    compile_header(&cpp, "furnace_core.h", "c++", &["-std=c++17", "-Wpadded"]);
    compile_header(&cpp, "furnace_core.hpp", "c++", &["-std=c++17"]);
}

fn compile_header(compiler: &Path, header: &str, language: &str, more: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let source = write(folder.path(), "header.txt", &format!("#include \"{header}\"\n"));
    let object = folder.path().join("header.o").to_string_lossy().into_owned();
    let source = source.to_string_lossy();
    let what = ["-x", language, "-c", &source, "-o", &object];
    compile(compiler, &[STRICT, more, &what].concat());
}

fn write(folder: &Path, name: &str, text: &str) -> PathBuf {
    let path = folder.join(name);
    std::fs::write(&path, text).unwrap();
    path
}

/// A size or an offset, as C writes it and as Rust has it.
struct Compared {
    c: String,
    rust: usize,
}

/// The size of a struct, and the offsets of its fields, some of which Rust cannot name as C does.
fn layout(of: &Layout) -> Vec<Compared> {
    let name = format!("furnace_{}", of.name.replace('-', "_"));
    let name = name.replace("furnace_furnace_", "furnace_");
    let field = |(field, rust): &(&str, usize)| {
        let field = field.trim_start_matches("r#").replace("this", "self");
        Compared { c: format!("offsetof({name}, {field})"), rust: *rust }
    };
    let whole = Compared { c: format!("sizeof({name})"), rust: of.size };
    [whole].into_iter().chain(of.fields.iter().map(field)).collect()
}

/// The layout of a struct that is neither of the header alone nor an element.
macro_rules! plain {
    ($name:literal, $type:ty: $($field:ident),*) => {
        Layout {
            name: $name,
            size: size_of::<$type>(),
            fields: &[$((stringify!($field), offset_of!($type, $field))),*],
        }
    };
}

fn layouts() -> Vec<Compared> {
    let structs = abi::STRUCTS.iter().chain([&abi::CORE]).copied();
    let elements = [
        DVec2::LAYOUT,
        DVec3::LAYOUT,
        <[f64; 3]>::LAYOUT,
        Ray::LAYOUT,
        Hit::LAYOUT,
        BoxHit::LAYOUT,
        DirectionSample::LAYOUT,
        BsdfQuery::LAYOUT,
        BsdfValue::LAYOUT,
        BsdfSample::LAYOUT,
        LightSample::LAYOUT,
        AdaptiveMean::LAYOUT,
    ];
    let stats = [
        plain!("traversal-stats", TraversalStats: rays, box_tests, primitive_tests),
        plain!("build-stats", BuildStats: nodes, leaves, max_depth, bytes),
    ];
    structs.chain(elements).chain(stats).flat_map(|of| layout(&of)).collect()
}

/// What C thinks the value of each expression is.
fn values_in_c(compiler: &Path, expressions: &[String]) -> Vec<usize> {
    let folder = tempfile::tempdir().unwrap();
    let mut program = "#include <stdio.h>\n#include \"furnace_core.h\"\n".to_owned();
    program += "int main(void) {\n";
    for expression in expressions {
        writeln!(program, "   printf(\"%zu\\n\", (size_t)({expression}));").unwrap();
    }
    program += "   return 0;\n}\n";
    let source = write(folder.path(), "values.c", &program);
    let binary = folder.path().join("values");
    compile(compiler, &["-std=c99", &source.to_string_lossy(), "-o", &binary.to_string_lossy()]);
    let output = Command::new(&binary).output().unwrap();
    let lines = String::from_utf8(output.stdout).unwrap();
    let values: Vec<_> = lines.lines().map(|line| line.parse().unwrap()).collect();
    assert_eq!(values.len(), expressions.len());
    values
}

#[test]
fn sizes_and_offsets_are_the_same_on_both_sides() {
    let cc = compiler("CC", "cc", "C");
    let layouts = layouts();
    let expressions: Vec<_> = layouts.iter().map(|layout| layout.c.clone()).collect();
    for (layout, of_c) in layouts.iter().zip(values_in_c(&cc, &expressions)) {
        assert_eq!(layout.rust, of_c, "{} in Rust and in C", layout.c);
    }
}

#[test]
fn words_have_the_same_numbers_on_both_sides() {
    let cc = compiler("CC", "cc", "C");
    let traits = Traits::all().iter_names().map(|(name, flag)| (name, flag.bits()));
    let traits: Vec<_> = traits.map(|(name, bits)| (format!("FURNACE_{name}"), bits)).collect();
    let numbers = abi::NUMBERS.iter().map(|(name, number)| ((*name).to_owned(), *number));
    let components = Components::all().iter_names().map(|(name, flag)| (name, flag.bits()));
    let components = components.map(|(name, bits)| (format!("FURNACE_TAKES_{name}"), bits));
    let all: Vec<_> = numbers.chain(traits).chain(components).collect();
    let expressions: Vec<_> = all.iter().map(|(name, _)| name.clone()).collect();
    for ((name, number), of_c) in all.iter().zip(values_in_c(&cc, &expressions)) {
        assert_eq!(*number as usize, of_c, "{name} in Rust and in C");
    }
}

#[test]
fn every_struct_of_the_header_is_compared() {
    let header = std::fs::read_to_string(support::root().join("include/furnace_core.h")).unwrap();
    let structs = header.matches("typedef struct furnace_").count();
    // `furnace_built` is opaque.
    let compared = layouts().iter().filter(|layout| layout.c.starts_with("sizeof")).count();
    assert_eq!(compared, structs - 1, "structs of the header");
}

/// A core of `tests/fixtures/abi`, compiled once for all tests.
fn load(name: &'static str) -> Dylib {
    static COMPILED: Mutex<BTreeMap<&str, PathBuf>> = Mutex::new(BTreeMap::new());
    let cpp = cpp_compiler();
    let mut compiled = COMPILED.lock().unwrap();
    let library = compiled.entry(name).or_insert_with(|| {
        let library = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("lib{name}.so"));
        let source = support::root().join(format!("tests/fixtures/abi/{name}.cpp"));
        compile_core(&cpp, &[], &source, &library);
        library
    });
    Dylib::load(library).unwrap()
}

fn camera() -> Camera {
    Camera::look_at(DVec3::new(1.0, 2.0, 3.0), DVec3::ZERO, DVec3::Y, 0.8, [64, 48])
}

/// Two triangles, a material, a light: everything that `echo.cpp` adds up.
fn scene() -> SceneDescription {
    let floor = Mesh {
        name: "floor".to_owned(),
        positions: vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(1.0, 1.0, 0.0)],
        normals: Vec::new(),
        indices: vec![[0, 1, 2], [1, 3, 2]],
        material: 0,
    };
    let grey = Material {
        name: "grey".to_owned(),
        surface: Surface::Diffuse { reflectance: [0.25, 0.5, 0.75] },
        emission: None,
    };
    SceneDescription {
        name: "two triangles".to_owned(),
        camera: Some(camera()),
        materials: vec![grey],
        meshes: vec![floor],
        lights: vec![Light::Point { position: DVec3::Z, intensity: [7.0, 8.0, 9.0] }],
        ..SceneDescription::default()
    }
}

#[test]
fn a_cpp_core_has_exactly_the_methods_it_has() {
    let core = load("echo");
    let info = core.info();
    assert_eq!((info.name.as_str(), info.version.as_str()), ("echo", "1.2"));
    let expected = Capabilities::GENERATE_RAYS
        | Capabilities::INTERSECT_PRIMITIVE
        | Capabilities::SAMPLE_DIRECTION
        | Capabilities::EVAL_BSDF
        | Capabilities::BUILD_SCENE
        | Capabilities::BRUTE_FORCE
        | Capabilities::INTERSECT
        | Capabilities::TRAVERSAL_STATS
        | Capabilities::OCCLUDED
        | Capabilities::RADIANCE
        | Capabilities::DETERMINISTIC;
    assert_eq!(info.capabilities, expected);
}

#[test]
fn a_cpp_core_is_handed_what_was_asked_and_its_answers_come_back() {
    let mut core = load("echo");
    let mut core = Validated::new(&mut core);
    let camera = camera();
    let mut rays = [Ray::new(DVec3::ZERO, DVec3::Z); 2];
    core.generate_rays(&camera, &[DVec2::new(0.25, 0.5), DVec2::new(1.0, 0.0)], &mut rays).unwrap();
    assert_eq!(rays[1].origin, camera.position);
    assert_eq!(rays[1].direction, -camera.camera_to_world.z_axis);
    assert_eq!((rays[0].t_min, rays[0].t_max), (0.25, camera.horizontal_fov));

    let mut samples = [DirectionSample { direction: DVec3::Z, pdf: 0.0 }; 2];
    let random = Randomness { points: &[DVec2::ZERO; 2], lobes: &[0.125, 0.375], seed: 11 };
    core.sample_direction(Sampler::CosineHemisphere, random, &mut samples).unwrap();
    // Sampler number 1, the lobe number, and the seed that was told before the batch.
    assert_eq!(samples.map(|sample| sample.pdf), [1.0 + 0.125 + 11.0, 1.0 + 0.375 + 11.0]);
}

#[test]
fn an_exception_is_a_refusal_in_its_own_words() {
    let mut core = load("echo");
    let sphere = Primitive::Sphere { centre: DVec3::ZERO, radius: -1.0 };
    let rays = [Ray::new(DVec3::ZERO, DVec3::Z)];
    let error = core.intersect_primitive(&sphere, &rays, &mut [Hit::MISS]).unwrap_err();
    assert_eq!(error, CoreError::Refused("a sphere of radius -1".to_owned()));
}

#[test]
fn what_a_core_throws_as_unsupported_is_skipped() {
    let mut core = load("echo");
    let glass = Material {
        name: "glass".to_owned(),
        surface: Surface::Glass { index: 1.5, reflectance: [1.0; 3], transmittance: [1.0; 3] },
        emission: None,
    };
    let queries = [BsdfQuery { wo: DVec3::Z, wi: DVec3::Z }];
    let mut values = [BsdfValue { f: [0.0; 3], pdf: 0.0 }];
    let error = core.eval_bsdf(&glass, &queries, &mut values).unwrap_err();
    assert_eq!(error, CoreError::Beyond("only diffuse surfaces".to_owned()));
    let triangle = Primitive::Triangle { positions: [DVec3::X; 3], normals: [DVec3::Z; 3] };
    let error = core.intersect_primitive(&triangle, &[], &mut []).unwrap_err();
    assert_eq!(error, CoreError::Unsupported(Capabilities::INTERSECT_PRIMITIVE));
}

#[test]
fn a_scene_arrives_whole() {
    let mut core = load("echo");
    let scene = scene();
    let mut built = core.build_scene(&scene, Acceleration::BruteForce).unwrap();
    assert_eq!((built.stats().nodes, built.stats().max_depth), (2, 0));
    let settings = IntegratorSettings { bounces: 2..=5, seed: u64::MAX, ..Default::default() };
    let mut radiance = [[0.0; 3]; 2];
    built.radiance(&[Ray::new(DVec3::ZERO, DVec3::Z); 2], &settings, &mut radiance).unwrap();
    // The sum of the coordinates, of the indices, and the light's green: see echo.cpp.
    assert_eq!(radiance[0], [4.0, 9.0, 8.0]);
    // The index of the ray, the last bounce, and whether the seed came whole.
    assert_eq!(radiance[1], [4.0 + 1.0, 9.0 + 5.0 - 5.0, 8.0]);
}

#[test]
fn counts_of_the_benchs_own_tests_cannot_lie() {
    let mut core = load("echo");
    let scene = scene();
    let mut built = core.build_scene(&scene, Acceleration::BruteForce).unwrap();
    let rays = [Ray::new(DVec3::new(0.2, 0.2, 1.0), DVec3::NEG_Z); 3];
    let mut hits = [Hit::MISS; 3];
    let stats = built.intersect(&rays, &mut hits).unwrap();
    assert_eq!((hits[2].t, hits[2].shape, hits[2].primitive), (1.0, 0, 0));
    // The core says it made a million tests of each kind; it made two of primitives a ray, and one of a box.
    assert_eq!((stats.rays, stats.box_tests, stats.primitive_tests), (3, 3, 6));
}

#[test]
fn a_flag_that_is_neither_0_nor_1_breaks_the_contract() {
    let mut core = load("flags");
    let scene = scene();
    let mut built = core.build_scene(&scene, Acceleration::DEFAULT).unwrap();
    let error = built.occluded(&[Ray::new(DVec3::ZERO, DVec3::Z); 2], &mut [false; 2]).unwrap_err();
    assert!(error.to_string().contains("occluded 1 of 2: it is 255"), "{error}");
}

#[test]
fn what_a_core_is_lent_lives_as_long_as_the_scene() {
    let mut core = load("keeper");
    assert_eq!(core.info().components, Components::TRAVERSAL);
    let down = |x: f64, y: f64| Ray::new(DVec3::new(x, y, 1.0), DVec3::NEG_Z);
    let rays = [down(0.2, 0.3), down(0.7, 0.8)];
    let mut hits_with = |taken: Components, how: Acceleration| {
        core.take_components(taken).unwrap();
        let mut built = core.build_scene(&scene(), how).unwrap();
        let mut hits = [Hit::MISS; 2];
        let stats = built.intersect(&rays, &mut hits).unwrap();
        (hits.map(|hit| hit.primitive), stats.primitive_tests)
    };
    let own = Components::empty();
    let counted = hits_with(own, Acceleration::COUNTED);
    assert_eq!(counted, ([0, u32::MAX], 2), "counted, the first alone");
    let uncounted = hits_with(own, Acceleration::DEFAULT);
    assert_eq!(uncounted.0, [u32::MAX; 2], "its own tests, of which it has none");
    let of_bench = hits_with(Components::TRAVERSAL, Acceleration::DEFAULT);
    assert_eq!(of_bench.0, [0, 1], "the bench's own scene");
}

/// What a crate of somebody else's has in its `lib.rs`.
mod exporting {
    furnace::export_core!("textbook:film-y-down+brdf-without-pi");
}

#[test]
fn a_crate_exports_a_core_to_who_speaks_its_version() {
    assert!(!exporting::furnace_core_entry(1).is_null());
    assert!(exporting::furnace_core_entry(2).is_null());
}

#[test]
fn a_core_without_the_function_takes_nothing() {
    let mut core = load("echo");
    assert_eq!(core.info().components, Components::empty());
    let refusal = core.take_components(Components::BSDF);
    assert_eq!(refusal, Err(CoreError::Unsupported(Capabilities::empty())));
}
