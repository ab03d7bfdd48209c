//! What a scene file says, and what it is told when it is wrong.

use super::*;
use crate::scene::{Emission, Light, Surface};
use glam::DVec3;

const ROOM: &str = r#"
title  = "A room"
source = "By hand"

[parameters]
albedo = 0.5

[camera]
position       = [0, 0, 0]
look-at        = [0, 0, -1]
horizontal-fov = "90 deg"
film           = [128, 96]

[material.wall]
diffuse  = "$albedo"
emission = 1

[[shape]]
name     = "room"
material = "wall"
sphere   = { radius = 1, inward = true }
"#;

fn load(text: &str, overrides: &str) -> Result<SceneDescription, SceneError> {
    let source = Source::new("scenes/room.toml", text);
    parse("room", &source, Path::new("scenes"), &toml::from_str(overrides).unwrap())
}

/// The room with one part of its text replaced.
fn altered(from: &str, to: &str) -> Result<SceneDescription, SceneError> {
    assert!(ROOM.contains(from), "`{from}`");
    load(&ROOM.replacen(from, to, 1), "")
}

/// The complaint about an altered room.
fn complaint(from: &str, to: &str) -> String {
    altered(from, to).unwrap_err().to_string()
}

const SPHERE: &str = "sphere   = { radius = 1, inward = true }";

/// The room with a shape of another kind.
fn with_shape(geometry: &str) -> Result<SceneDescription, SceneError> {
    altered(SPHERE, geometry)
}

fn triangle_count(geometry: &str) -> usize {
    let scene = with_shape(geometry).unwrap_or_else(|error| panic!("{geometry}: {error}"));
    scene.primitive_count()
}

#[test]
fn a_file_becomes_camera_material_shape_and_light() {
    let scene = load(ROOM, "").unwrap();
    let camera = scene.camera.unwrap();
    assert_eq!(camera.film, [128, 96]);
    assert!((camera.horizontal_fov.to_degrees() - 90.0).abs() < 1e-12);
    assert!(((camera.vertical_fov / 2.0).tan() - 0.75).abs() < 1e-12, "square pixels");
    assert_eq!(scene.materials[0].surface, Surface::Diffuse { reflectance: [0.5; 3] });
    assert_eq!(scene.materials[0].emission, Some(Emission { radiance: [1.0; 3], cap: None }));
    assert!(scene.spheres[0].inward);
    assert_eq!(scene.lights, [Light::Area { shape: 0 }]);
}

#[test]
fn a_case_overrides_a_parameter_with_a_number_or_a_colour() {
    let albedo = |overrides| load(ROOM, overrides).unwrap().materials[0].surface;
    assert_eq!(albedo("albedo = 0.8"), Surface::Diffuse { reflectance: [0.8; 3] });
    let coloured = albedo("albedo = [0.1, 0.2, 0.3]");
    assert_eq!(coloured, Surface::Diffuse { reflectance: [0.1, 0.2, 0.3] });
}

#[test]
fn a_parameter_may_be_a_table_or_part_of_a_list() {
    let table = ROOM
        .replace("albedo = 0.5", "albedo = 0.5\nball = { radius = 3, inward = true }\nz = 4")
        .replace("{ radius = 1, inward = true }", "\"$ball\"")
        .replace("look-at        = [0, 0, -1]", "look-at = [0, 0, \"$z\"]");
    let scene = load(&table, "").unwrap();
    assert_eq!(scene.spheres[0].radius, 3.0);
    assert_eq!(scene.camera.unwrap().camera_to_world.z_axis, DVec3::NEG_Z);
}

#[test]
fn an_unknown_parameter_is_answered_with_the_known_ones() {
    let message = load(ROOM, "albeto = 1").unwrap_err().to_string();
    let told =
        "scene `room` has no parameter `albeto`, only `albedo`\nhint: did you mean `albedo`?";
    assert_eq!(message, told);
    let expected = "\
error: there is no parameter `albeto`, only `albedo`
  --> scenes/room.toml:15:12
   |
15 | diffuse  = \"$albeto\"
   |            ^^^^^^^^^
   |
   = help: did you mean `albedo`?";
    assert_eq!(complaint("$albedo", "$albeto"), expected);
}

#[test]
fn a_wrong_override_is_shown_where_it_is_used() {
    let expected = "\
error: invalid reflectance or transmittance 1.5: must be in [0, 1]
  --> scenes/room.toml:15:12
   |
15 | diffuse  = \"$albedo\"
   |            ^^^^^^^^^
   |
   = help: here `$albedo` is 1.5";
    assert_eq!(load(ROOM, "albedo = 1.5").unwrap_err().to_string(), expected);
}

/// What the room says, what is said instead, and words of the complaint about it.
const COMPLAINTS: &[(&str, &str, &[&str])] = &[
    ("\"$albedo\"", "0.5", &["parameter `albedo` is unused", "room.toml:6:1"]),
    (
        "look-at  ",
        "lok-at",
        &["unknown field `lok-at`, expected one of `position`", "10 | lok-at", "mean `look-at`?"],
    ),
    (
        "material = \"wall\"",
        "material = \"wal\"",
        &["no material `wal`, only `wall`", "20 | material = \"wal\"", "did you mean `wall`?"],
    ),
    ("[material.wall]", "[material.x]\nmirror = 1\n[material.wall]", &["material `x` is unused"]),
    ("albedo = 0.5", "albedo = -0.1", &[" -0.1: must be"]),
    ("albedo = 0.5", "albedo = 1.5", &[" 1.5: must be"]),
    ("albedo = 0.5", "albedo = [0, 2, 0]", &[" 2: must be"]),
    ("albedo = 0.5", "albedo = nan", &[" NaN: must be"]),
    (
        "\"90 deg\"",
        "90",
        &["an angle with its unit, such as \"45 deg\"", "11 | horizontal-fov = 90"],
    ),
    ("\"90 deg\"", "\"180 deg\"", &["between 0 and 180 deg"]),
    ("[0, 0, -1]", "[0, 0, 0]", &["`look-at` equals the position, or lies along `up`"]),
    ("[0, 0, -1]", "[0, 5, 0]", &["`look-at` equals the position, or lies along `up`"]),
    ("emission = 1", "mirror = 1", &["one thing, not `diffuse` and `mirror`"]),
    (SPHERE, "", &["a shape needs one of `quad`, `box`"]),
    (SPHERE, "obj = \"cow.obj\"", &["`scenes/cow.obj` cannot be read", "21 | obj = \"cow.obj\""]),
    ("emission = 1", "emission = -1", &["must be finite and not negative"]),
    ("emission = 1", "emission = inf", &["must be finite and not negative"]),
    ("emission = 1", "emission = [1, 1, nan]", &["must be finite and not negative"]),
];

#[test]
fn what_is_wrong_is_said_with_its_line_and_the_words_that_are_right() {
    for (from, to, words) in COMPLAINTS {
        let message = complaint(from, to);
        words.iter().for_each(|words| assert!(message.contains(words), "{words}: {message}"));
    }
}

#[test]
fn a_direction_has_a_direction() {
    let light = |direction| {
        let light = format!("directional = {{ direction = {direction}, irradiance = 1 }}");
        load(&format!("{ROOM}\n[[light]]\n{light}"), "")
    };
    let scene = light("[0, -2, 0]").unwrap();
    let sun = Light::Directional { direction: DVec3::NEG_Y, irradiance: [1.0; 3] };
    assert_eq!(scene.lights, [sun, Light::Area { shape: 0 }]);
    assert!(light("[0, 0, 0]").unwrap_err().to_string().contains("invalid direction"));
}

#[test]
fn every_kind_of_shape_makes_its_triangles() {
    assert_eq!(triangle_count("quad = { centre = [0, 0, 0], edges = [[1, 0, 0], [0, 1, 0]] }"), 2);
    assert_eq!(triangle_count("quad = { corner = [0, 0, 0], edges = [[1, 0, 0], [0, 1, 0]] }"), 2);
    assert_eq!(triangle_count("box = { min = [0, 0, 0], max = [1, 1, 1], inward = true }"), 12);
    assert_eq!(triangle_count("icosphere = { radius = 2, subdivisions = 1 }"), 80);
    assert_eq!(triangle_count("bumpy-sphere = { subdivisions = 2 }\nshading = \"smooth\""), 320);
    assert_eq!(triangle_count("sphereflake = { depth = 1, subdivisions = 0 }"), 200);
    assert_eq!(triangle_count("sphereflake = { depth = 1 }"), 10);
    assert_eq!(triangle_count("teapot = { segments = 2 }"), 240);
    assert_eq!(triangle_count("soup = { triangles = 7, seed = 1 }"), 7);
    assert_eq!(triangle_count("pathological = { layout = \"size-ratio\", triangles = 9 }"), 9);
    let inline = "{ positions = [[0, 0, 0], [1, 0, 0], [0, 1, 0]], indices = [[0, 1, 2]] }";
    assert_eq!(triangle_count(&format!("triangles = {inline}")), 1);
}

#[test]
fn impossible_shapes_are_refused() {
    let refused = |geometry: &str, because: &str| {
        let message = with_shape(geometry).unwrap_err().to_string();
        assert!(message.contains(because), "{geometry}: {message}");
    };
    refused(
        "quad = { centre = [0, 0, 0], edges = [[1, 0, 0], [2, 0, 0]] }",
        "must not be parallel",
    );
    refused("quad = { edges = [[1, 0, 0], [0, 1, 0]] }", "one of `corner` or `centre`");
    refused("box = { min = [0, 0, 0], max = [1, 0, 1] }", "below that of `max`");
    refused("sphere = { radius = 0 }", "must be positive");
    refused("icosphere = { radius = 1, subdivisions = 40 }", "an integer from 0 to 9");
    refused("sphere = { radius = 1 }\nshading = \"flat\"", "`shading` is for triangles");
    refused("shading = \"smoth\"", "did you mean `smooth`?");
    refused("pathological = { layout = \"line\", triangles = 9 }", "unknown variant `line`");
    let triangles = |indices: &str, rest: &str| {
        let positions = "[[0, 0, 0], [1, 0, 0], [0, 1, 0]]";
        format!("triangles = {{ positions = {positions}, indices = [{indices}]{rest} }}")
    };
    refused(&triangles("[0, 1, 3]", ""), "refers to vertex 3, but there are only 3 vertices");
    refused(&triangles("[0, 1, 2]", ", normals = [[0, 0, 1]]"), "1 normals for 3 vertices");
    refused(&triangles("[0, 1, 1]", ""), "a shape without area cannot emit");
}

#[test]
fn transforms_scale_then_rotate_then_translate() {
    let turn = "rotate = { axis = [0, 1, 0], angle = \"90 deg\" }";
    let transform = format!("transform = {{ scale = 2, {turn}, translate = [0, 0, 1] }}");
    let sphere = format!("sphere = {{ centre = [0, 0, 1], radius = 1 }}\n{transform}");
    let scene = with_shape(&sphere).unwrap();
    assert!(scene.spheres[0].centre.abs_diff_eq(DVec3::new(2.0, 0.0, 1.0), 1e-15));
    assert_eq!(scene.spheres[0].radius, 2.0);
    let quad = "quad = { corner = [0, 0, 1], edges = [[0, 1, 0], [0, 0, 1]] }";
    let scene = with_shape(&format!("{quad}\n{transform}")).unwrap();
    assert!(scene.meshes[0].positions[0].abs_diff_eq(DVec3::new(2.0, 0.0, 1.0), 1e-15));
    assert!(scene.meshes[0].corner_normals(0)[0].abs_diff_eq(DVec3::NEG_Z, 1e-15));
}

#[test]
fn two_skies_and_two_shapes_of_one_name_are_refused() {
    let sky = "\n[[light]]\nconstant-sky = { radiance = 1 }";
    assert!(load(&format!("{ROOM}{sky}"), "").is_ok());
    let message = load(&format!("{ROOM}{sky}{sky}"), "").unwrap_err().to_string();
    assert!(message.contains("at most one"), "{message}");
    let again = ROOM.split_once("[[shape]]").unwrap().1;
    let message = load(&format!("{ROOM}[[shape]]{again}"), "").unwrap_err().to_string();
    assert!(message.contains("duplicate shape `room`"), "{message}");
}

#[test]
fn an_emission_of_zero_puts_the_light_out() {
    let scene = altered("emission = 1", "emission = 0").unwrap();
    assert!(scene.lights.is_empty() && scene.materials[0].emission.is_none());
}

#[test]
fn a_cap_needs_something_that_emits_and_is_round() {
    let cap = "cap = { axis = [0, 0, 1], half-angle = \"40 deg\" }";
    let scene = altered("emission = 1", &format!("emission = 1\n{cap}")).unwrap();
    let half_angle = scene.materials[0].emission.unwrap().cap.unwrap().half_angle;
    assert!((half_angle.to_degrees() - 40.0).abs() < 1e-12);
    assert!(complaint("emission = 1", cap).contains("add `emission`"));
    let flat = ROOM
        .replace("emission = 1", &format!("emission = 1\n{cap}"))
        .replace(SPHERE, "teapot = { segments = 1 }");
    assert!(load(&flat, "").unwrap_err().to_string().contains("only spheres can have"));
}

#[test]
fn rough_glass_bends_light() {
    let wall = "diffuse  = \"$albedo\"";
    let glass = "rough-glass = { index = 1.5, roughness = \"$albedo\", transmittance = 0.8 }";
    let scene = altered(wall, glass).unwrap();
    assert_eq!(
        scene.materials[0].surface,
        Surface::RoughGlass {
            index: 1.5,
            roughness: 0.5,
            reflectance: [1.0; 3],
            transmittance: [0.8; 3]
        }
    );
    let flat = glass.replace("1.5", "1");
    assert!(complaint(wall, &flat).contains("invalid index of refraction 1"));
    let wide = "rough-glass = { index = 1.5, roughness = 1.5, transmittance = \"$albedo\" }";
    assert!(complaint(wall, wide).contains("must be in (0, 1]"));
}
