//! What is written, read again by whoever reads such files here.

use super::*;
use crate::scene::{Library, Light, Material, Overrides, Surface, mesh};
use glam::DVec3;

const REQUEST: Request = Request { last_bounce: 3, samples: 16, seed: 7 };

fn library() -> Library {
    Library::new(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes"))
}

type Files = (tempfile::TempDir, Written);

fn written(name: &str, format: Format) -> Result<Files, String> {
    written_after(name, format, |_| ())
}

/// A scene, changed, and written.
fn written_after(
    name: &str,
    format: Format,
    change: impl Fn(&mut SceneDescription),
) -> Result<Files, String> {
    let mut scene = SceneDescription::clone(&library().load(name, &Overrides::new()).unwrap());
    change(&mut scene);
    let folder = tempfile::tempdir().unwrap();
    let written = write(&scene, format, REQUEST, folder.path());
    written.map(|written| (folder, written)).map_err(|error| error.to_string())
}

/// Every surface is of one kind and dark.
fn all(surface: Surface) -> impl Fn(&mut SceneDescription) {
    move |scene| {
        let dark =
            |material: &mut Material| (material.surface, material.emission) = (surface, None);
        scene.materials.iter_mut().for_each(dark);
    }
}

const GREY: Surface = Surface::Diffuse { reflectance: [0.5; 3] };

/// The scene as our own reader reads back what is written for the course.
fn through_collada(name: &str) -> (SceneDescription, SceneDescription) {
    let scene = library().load(name, &Overrides::new()).unwrap();
    let (_folder, written) = written(name, Format::Collada).unwrap();
    let [width, height] = scene.camera.unwrap().film;
    let overrides = format!("film = [{width}, {height}]\ncamera = \"camera.txt\"");
    let overrides = toml::from_str(&overrides).unwrap();
    let back = crate::scene::load_file(&written.scene, &overrides).unwrap();
    (SceneDescription::clone(&scene), back)
}

/// Every scene that the course can hold.
fn held_by_collada() -> Vec<String> {
    let names = library().names().unwrap();
    names.into_iter().filter(|name| written(name, Format::Collada).is_ok()).collect()
}

#[test]
fn the_camera_comes_back_from_the_course_to_the_last_bit() {
    let names = held_by_collada();
    assert!(names.len() >= 10, "{names:?}");
    for name in names {
        let (scene, back) = through_collada(&name);
        let [meant, read] = [scene.camera.unwrap(), back.camera.unwrap()];
        // The vertical angle is seldom one of degrees: it may come back a last bit away.
        let fov = read.vertical_fov;
        assert_eq!(Camera { vertical_fov: meant.vertical_fov, ..read }, meant, "{name}");
        let neighbours = [meant.vertical_fov.next_down(), meant.vertical_fov.next_up()];
        assert!(neighbours[0] <= fov && fov <= neighbours[1], "{name}");
    }
}

#[test]
fn triangles_come_back_from_the_course_with_their_front_in_front() {
    for name in held_by_collada() {
        let (scene, back) = through_collada(&name);
        assert_eq!(back.meshes.len(), scene.meshes.len(), "{name}");
        for (meant, read) in scene.meshes.iter().zip(&back.meshes) {
            assert_eq!(meant.indices.len(), read.indices.len(), "{name}");
            for triangle in 0..meant.indices.len() {
                let narrow = meant.corners(triangle).map(|corner| corner.as_vec3().as_dvec3());
                assert!(same_triangle(narrow, read.corners(triangle)), "{name} {triangle}");
                let normals = [meant, read].map(|mesh| mesh.corner_normals(triangle)[0]);
                assert!(normals[0].distance(normals[1]) < 1e-3, "{name} {triangle} {normals:?}");
            }
        }
    }
}

/// Whether the corners are the same, from whichever they start, in the same sense of rotation.
fn same_triangle([a, b, c]: [DVec3; 3], other: [DVec3; 3]) -> bool {
    [[a, b, c], [b, c, a], [c, a, b]].contains(&other)
}

#[test]
fn spheres_materials_and_lights_come_back_from_the_course() {
    for name in held_by_collada() {
        let (scene, back) = through_collada(&name);
        let looks = |scene: &SceneDescription| -> Vec<_> {
            let look = |number| {
                let material = scene.material_of(number);
                (narrowed(material.surface), material.emission)
            };
            (0..scene.shape_count() as u32).map(look).collect()
        };
        assert_eq!(looks(&back), looks(&scene), "{name}");
        assert_eq!(back.lights.len(), scene.lights.len(), "{name}");
        for (read, meant) in back.lights.iter().zip(&scene.lights) {
            assert!(same_light(read, meant), "{name}: {read:?} instead of {meant:?}");
        }
        for (meant, read) in scene.spheres.iter().zip(&back.spheres) {
            assert_eq!((read.centre, read.radius), (meant.centre, meant.radius), "{name}");
        }
    }
}

/// The course makes directions unit length once more, which can change a last bit.
fn same_light(read: &Light, meant: &Light) -> bool {
    match (read, meant) {
        (
            Light::Directional { direction: a, irradiance: colour },
            Light::Directional { direction: b, irradiance },
        ) => a.abs_diff_eq(*b, 1e-15) && colour == irradiance,
        (read, meant) => read == meant,
    }
}

/// An index of refraction as the course keeps it.
#[expect(clippy::cast_possible_truncation, reason = "meant: the course keeps it as a float")]
fn narrowed(surface: Surface) -> Surface {
    match surface {
        Surface::Glass { index, reflectance, transmittance } => {
            Surface::Glass { index: f64::from(index as f32), reflectance, transmittance }
        }
        other => other,
    }
}

#[test]
fn an_obj_comes_back_through_the_library_that_reads_obj() {
    let dark = |scene: &mut SceneDescription| scene.lights.clear();
    let (_folder, written) = written_after("teapot", Format::Obj, dark).unwrap();
    let scene = library().load("teapot", &Overrides::new()).unwrap();
    let back = mesh::load(&written.scene, mesh::Format::Obj).unwrap();
    let meant = &scene.meshes[0];
    assert_eq!(back.indices.len(), meant.indices.len());
    for triangle in 0..meant.indices.len() {
        // That library is off by a last bit of single precision now and then.
        for (read, written) in back.corners(triangle).iter().zip(meant.corners(triangle)) {
            assert!(read.abs_diff_eq(written, 1e-6), "{read} instead of {written}");
        }
    }
}

#[test]
fn pbrt_gets_its_depth_its_seed_and_its_left_handed_camera() {
    let grey = |scene: &mut SceneDescription| {
        scene.lights = vec![Light::Point { position: DVec3::Y, intensity: [3.0; 3] }];
        all(GREY)(scene);
    };
    let (_folder, written) = written_after("point-light-plane", Format::Pbrt, grey).unwrap();
    let text = std::fs::read_to_string(&written.scene).unwrap();
    for line in [
        "Integrator \"path\" \"integer maxdepth\" [ 3 ]",
        "\"integer pixelsamples\" [ 16 ] \"integer seed\" [ 7 ]",
        "Scale -1 1 1\nLookAt ",
        "LightSource \"point\" \"rgb I\" [ 3 3 3 ] \"point3 from\" [ 0 1 0 ]",
        "Material \"diffuse\" \"rgb reflectance\" [ 0.5 0.5 0.5 ]",
    ] {
        assert!(text.contains(line), "`{line}` in\n{text}");
    }
}

#[test]
fn rough_glass_is_said_to_mitsuba_and_pbrt_and_to_nobody_else() {
    let rough = |scene: &mut SceneDescription| {
        scene.lights.clear();
        let (reflectance, transmittance) = ([1.0; 3], [1.0; 3]);
        let (index, roughness) = (1.5, 0.25);
        all(Surface::RoughGlass { index, roughness, reflectance, transmittance })(scene);
    };
    for (format, words) in [
        (Format::Mitsuba, "<bsdf type=\"roughdielectric\">"),
        (
            Format::Pbrt,
            "\"float eta\" [ 1.5 ] \"float roughness\" [ 0.25 ] \"bool remaproughness\" [ false ]",
        ),
    ] {
        let (_folder, written) = written_after("point-light-plane", format, rough).unwrap();
        let text = std::fs::read_to_string(&written.scene).unwrap();
        assert!(text.contains(words), "`{words}` in\n{text}");
    }
    for format in [Format::Collada, Format::Obj] {
        let message = written_after("point-light-plane", format, rough).unwrap_err();
        assert!(message.contains("rough glass"), "{message}");
    }
}

#[test]
fn the_course_has_no_rough_metal_and_nothing_that_emits_and_reflects() {
    let metal = all(Surface::Conductor { reflectance: [1.0; 3], roughness: 0.5 });
    let message = written_after("point-light-plane", Format::Collada, metal).unwrap_err();
    assert!(message.contains("is a rough conductor"), "{message}");
    let grey = |scene: &mut SceneDescription| {
        scene.materials.iter_mut().for_each(|material| material.surface = GREY);
    };
    let message = written_after("area-light-plane", Format::Collada, grey).unwrap_err();
    assert!(message.contains("emits and reflects"), "{message}");
}

#[test]
fn what_a_format_cannot_hold_is_named() {
    for (scene, format, words) in [
        ("sky", Format::Collada, "it has an environment light"),
        ("sphere-light", Format::Collada, "area lights are rectangles"),
        ("cornell-diffuse-spheres", Format::Pbrt, "only greys survive"),
        ("gradient-sky", Format::Pbrt, "gradient environment light"),
        ("cornell-diffuse-spheres", Format::Obj, "is a sphere"),
        ("point-light-plane", Format::Obj, "no lights but emissive surfaces"),
        ("cap-cavity", Format::Mitsuba, "emits on a cap only"),
    ] {
        let message = written(scene, format).unwrap_err();
        assert!(message.contains(words), "{scene}, {format}: {message}");
    }
}

#[test]
fn every_format_has_one_word() {
    for (word, format) in Format::ALL {
        assert_eq!(word.parse(), Ok(format));
    }
    assert!("dae".parse::<Format>().unwrap_err().contains("`collada`"));
}
