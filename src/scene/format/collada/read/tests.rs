//! What is read is held against what the course's own program (summer 2025) makes of the same file:
//! the bits below were printed by it.

use super::*;
use crate::scene::{Camera, Emission, Light, Surface};
use glam::DVec3;

const ROOM: &str = include_str!("../../../../../tests/fixtures/collada/room.dae");

fn read(text: &str) -> Result<Reading, SceneError> {
    parse("room", &Source::new("room.dae", text), FILM)
}

/// The room with one part of its text replaced.
fn altered(from: &str, to: &str) -> Result<Reading, SceneError> {
    assert!(ROOM.contains(from), "`{from}`");
    read(&ROOM.replacen(from, to, 1))
}

fn scene() -> SceneDescription {
    read(ROOM).unwrap().scene
}

fn camera(film: [u32; 2]) -> Camera {
    let source = Source::new("room.dae", ROOM);
    parse("room", &source, film).unwrap().scene.camera.unwrap()
}

// Elsewhere the sine of an angle may differ in its last bit.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
#[test]
fn the_camera_is_the_courses_to_the_last_bit() {
    let camera = camera([480, 360]);
    let axes = camera.camera_to_world.to_cols_array();
    let angles = [camera.horizontal_fov, camera.vertical_fov, camera.near, camera.far];
    let numbers = camera.position.to_array().into_iter().chain(axes).chain(angles);
    let bits: Vec<u64> = numbers.map(f64::to_bits).collect();
    #[rustfmt::skip]
    let expected = [
        0xc00d_3207_8f08_b29f, 0x3ff2_3d27_62cd_c9cf, 0x4009_875b_ed37_2f4f, 0x3fe5_3a79_556d_d8b9,
        0x8000_0000_0000_0000, 0x3fe7_f1df_c69c_f30b, 0x3fb1_7244_3453_974e, 0x3fef_ddf4_27b8_d7fe,
        0xbfae_ef2f_c65d_d497, 0xbfe7_d865_ebdf_1aed, 0x3fb7_50be_adbd_b3e8, 0x3fe5_23e3_58ef_775c,
        0x3fdc_c1ab_c393_73ea, 0x3fd5_ba04_afb2_7d1e, 0x3fb9_9999_a000_0000, 0x4059_0000_0000_0000,
    ];
    assert_eq!(bits, expected);
}

#[test]
fn a_smaller_picture_is_cut_out_of_the_middle() {
    let (whole, half) = (camera([800, 600]), camera([400, 300]));
    assert_eq!(whole.position, half.position);
    let ratio = (half.horizontal_fov / 2.0).tan() / (whole.horizontal_fov / 2.0).tan();
    assert!((ratio - 0.5).abs() < 1e-15);
}

#[test]
fn a_scene_without_camera_is_seen_from_the_front() {
    let text = "<instance_camera url=\"#eye-camera\"/>";
    let scene = altered(text, "<instance_geometry url=\"#ball-geometry\"/>").unwrap().scene;
    let backward = scene.camera.unwrap().camera_to_world.z_axis;
    assert!(backward.distance(DVec3::Z) < 1e-15, "{backward}");
}

#[test]
fn a_camera_straight_above_is_moved_off_the_vertical() {
    let from = "1 0 0 9 0 0.2 -0.979 7 0 0.979 0.2 1.3 0 0 0 1";
    let above = altered(from, "1 0 0 0 0 1 0 0 0 0 1 3 0 0 0 1").unwrap().scene.camera.unwrap();
    assert!(above.camera_to_world.is_finite());
    assert!(above.camera_to_world.z_axis.y < 1.0);
}

#[test]
fn vertices_and_normals_of_an_open_mesh_are_the_courses_to_the_last_bit() {
    let scene = scene();
    let tent = &scene.meshes[2];
    let bits = |vector: DVec3| vector.to_array().map(f64::to_bits);
    let [first, ..] = tent.indices[0];
    assert_eq!(first, 4, "a face (0, 1, 4) starts at its last vertex");
    let position = [0x3fd8_f5c2_8f99_999a, 0x3fe0_0000_0333_3333, 0xbfc7_0a3d_7199_999a];
    let normals = [
        [0x3fd8_a125_8423_56dc, 0xbfeb_9db9_60f7_b3bb, 0x3fd4_f284_47d8_37ed],
        [0x3fd9_d4bd_2fed_b52d, 0xbfea_79cd_c632_e23e, 0xbfd8_ff6c_d077_9f7a],
        [0xbfd8_dfeb_7a35_0d71, 0xbfeb_1762_2e90_cb69, 0xbfd7_4516_093f_7619],
        [0xbfd9_769c_8a4b_48a6, 0xbfeb_6ca3_0b12_6dad, 0x3fd4_f53d_3886_3cd4],
        [0x3c86_3769_ce17_db2f, 0x3fef_fb99_b5c3_49d4, 0x3fa0_c722_6ba3_74a7],
    ];
    assert_eq!(bits(tent.positions[4]), position);
    assert_eq!(tent.normals.iter().copied().map(bits).collect::<Vec<_>>(), normals);
}

#[test]
fn the_front_of_a_triangle_is_the_side_of_its_normals() {
    let scene = scene();
    for (mesh, up) in [(0, -DVec3::Y), (1, DVec3::Y)] {
        let mesh = &scene.meshes[mesh];
        for triangle in 0..2 {
            let [a, b, c] = mesh.corners(triangle);
            assert_eq!((b - a).cross(c - a).normalize(), up, "{}", mesh.name);
            assert_eq!(mesh.corner_normals(triangle), [up; 3], "{}", mesh.name);
        }
    }
}

#[test]
fn the_radius_of_a_sphere_is_rounded_and_then_scaled() {
    let scene = scene();
    assert_eq!(scene.spheres[0].radius, f64::from(0.3_f32) * 1.1);
    assert_eq!(scene.spheres[0].centre, DVec3::new(-0.4, 0.33, 0.3));
}

#[test]
fn the_profile_beats_the_common_material_and_no_material_is_grey() {
    let scene = scene();
    let glass = Surface::Glass {
        index: f64::from(1.45_f32),
        reflectance: [0.9; 3],
        transmittance: [1.0; 3],
    };
    assert_eq!(scene.material_of(3).surface, glass);
    assert_eq!(scene.material_of(1).surface, Surface::Diffuse { reflectance: [0.6, 0.2, 0.1] });
    assert_eq!(scene.material_of(2).surface, Surface::Diffuse { reflectance: [0.5; 3] });
    let emission = Some(Emission { radiance: [7.0, 6.0, 5.0], cap: None });
    assert_eq!(scene.material_of(0).emission, emission);
}

#[test]
fn a_light_in_a_emissive_mesh_is_that_mesh() {
    let reading = read(ROOM).unwrap();
    assert_eq!(reading.scene.lights, [Light::Area { shape: 0 }]);
    assert_eq!(reading.differences.len(), 1);
    assert!(reading.differences[0].contains("`lamp` lies in `panel`"), "{:?}", reading.differences);
}

#[test]
fn an_emissive_mesh_shines_where_its_light_does() {
    let [down, up] = ["0 -0.2 0 0 0 0 -1 1.4", "0 0.2 0 0 0 0 1 1.4"];
    let turned = ROOM.replacen(down, up, 1);
    let front = |text: &str| {
        let scene = read(text).unwrap().scene;
        let [a, b, c] = scene.meshes[0].corners(0);
        assert_eq!(scene.meshes[0].corner_normals(0)[0], (b - a).cross(c - a).normalize());
        scene.meshes[0].corner_normals(0)[0]
    };
    assert_eq!([ROOM, &turned].map(front), [-DVec3::Y; 2]);
    // Without a light in it, it is as its normals are.
    let alone = turned.replacen("0 1 1.4 0 0 0 1", "0 1 1.2 0 0 0 1", 1);
    assert_eq!(front(&alone), DVec3::Y);
}

#[test]
fn an_area_light_without_mesh_gets_one_that_faces_as_the_light_does() {
    let scene = altered("0 1 1.4 0 0 0 1", "0 1 1.2 0 0 0 1").unwrap().scene;
    assert_eq!(scene.lights, [Light::Area { shape: 0 }, Light::Area { shape: 3 }]);
    let light = &scene.meshes[3];
    assert!((light.area(0) + light.area(1) - 0.4 * 0.6).abs() < 1e-15);
    assert_eq!(light.corner_normals(0)[0], -DVec3::Y);
    let bounds = scene.bounds().unwrap();
    assert!(bounds.min.x <= -1.1 && scene.camera == self::scene().camera, "lights do not count");
}

#[test]
fn lights_of_other_kinds_are_lights_of_their_own() {
    let lights = |light: &str| {
        let reading = altered("<area>", &format!("<{light}>"));
        let text = ROOM.replacen("<area>", &format!("<{light}>"), 1);
        let text = text.replacen("</area>", &format!("</{light}>"), 1);
        assert!(reading.is_err(), "tags must match");
        read(&text.replacen("0 1 1.4 0 0 0 1", "0 1 1.2 0 0 0 1", 1)).unwrap()
    };
    let sun = Light::Directional { direction: -DVec3::Y, irradiance: [7.0, 6.0, 5.0] };
    assert_eq!(lights("directional").scene.lights[0], sun);
    for dark in ["spot", "ambient"] {
        let reading = lights(dark);
        assert_eq!(reading.scene.lights, [Light::Area { shape: 0 }]);
        assert!(reading.differences[0].contains("left out"), "{:?}", reading.differences);
    }
}

#[test]
fn a_point_light_keeps_its_intensity() {
    let profile = ROOM.find("<extra>").unwrap()..ROOM.find("</light>").unwrap();
    let mut text = ROOM.to_owned();
    text.replace_range(profile, "");
    let text = text.replacen("0 1 1.4 0 0 0 1", "0 1 1.2 0 0 0 1", 1);
    let position = DVec3::new(0.0, 1.2, 0.0);
    let light = Light::Point { position, intensity: [9.0; 3] };
    assert_eq!(read(&text).unwrap().scene.lights[0], light);
}

#[test]
fn a_polygon_of_four_corners_becomes_one_triangle_and_that_is_said() {
    let from = "<vcount>3 3 </vcount>\n          <p>0 0 1 0 2 0 2 0 3 0 0 0</p>";
    let quad = ROOM.replacen(from, "<vcount>4</vcount><p>0 0 1 0 2 0 3 0</p>", 1);
    let quad = quad.replacen("<polylist count=\"2\">", "<polylist count=\"1\">", 1);
    let reading = read(&quad).unwrap();
    assert_eq!(reading.scene.meshes[1].indices, [[3, 1, 0]]);
    assert!(reading.differences[0].contains("one triangle of each of 1 polygons"));
}

#[test]
fn nested_nodes_are_read_only_where_there_is_one_way_to_read_them() {
    let nested = |matrix: &str| {
        let parent = "<node id=\"tent\" name=\"tent\">";
        let child =
            "<node id=\"child\" name=\"child\"><instance_geometry url=\"#ball-geometry\"/></node>";
        let text = ROOM.replacen(parent, &format!("{parent}{child}"), 1);
        read(&text.replacen("1 0 0 -0.4 0 1 0 -0.2 0 0 1 0.1 0 0 0 1", matrix, 1))
    };
    assert!(nested("1 0 0 0 0 1 0 0 0 0 1 2 0 0 0 1").is_err());
    // Here Z_UP makes a symmetric matrix of a symmetric one.
    let twice = nested("2 0 0 0 0 2 0 0 0 0 2 0 0 0 0 1").unwrap().scene;
    assert_eq!(twice.spheres[1].radius, f64::from(0.6_f32));
}

const TENT: &str = "0 1 4 1 2 4 2 3 4 3 0 4";
const FOUR: &str = "<triangles count=\"4\">";
const ARRAY: &str = "count=\"15\">0.3 0 0";
const NORMALS: &str = "<input semantic=\"NORMAL\" source=\"#quad-normals\" offset=\"1\"/>";
const COLOURS: &str = "<input semantic=\"COLOR\" source=\"#quad-normals\" offset=\"1\"/>";
const PANEL: &str = "<node id=\"panel\" name=\"panel\">";
const MATRIX: &str = "<matrix>0.4 0 0 0 0 0.6 0 0 0 0 1 1.4 0 0 0 1</matrix>";

/// What the room says, what is said instead, how that is refused, and how the line begins at which it is.
#[rustfmt::skip]
const REFUSED: &[[&str; 4]] = &[
    // What crashes the course.
    [PANEL, "<node id=\"panel\">", "`node` has no attribute `name`", "<node id=\"panel\">"],
    ["<instance_geometry url=\"#tent-geometry\"/>", "", "this node instances nothing", "name=\"tent\""],
    ["<up_axis>Z_UP", "<up_axis>UP", "no other axis", "<up_axis>"],
    ["url=\"#eye-camera\"", "url=\"#nose\"", "there is no element with the id `nose`", "instance_camera"],
    [MATRIX, "<translate>0 0 1</translate>", "multiplies by zero here", "<translate>"],
    // Meshes that are none.
    [TENT, "0 1 4 1 2 4 2 3 4 0 3 4", "is no oriented manifold", "<triangles"],
    [TENT, "0 1 4 1 2 4 2 0 4 2 4 0", "is no oriented manifold", "<triangles"],
    [FOUR, "<triangles count=\"2\">", "does not use vertex 3", "<triangles"],
    [TENT, "0 1 4 1 2 4 2 3 9 3 0 4", "there are only 5 vertices", "<triangles"],
    [TENT, "0 1 4 1 2 4 2 3 2 3 0 4", "uses the same vertex twice", "<triangles"],
    // Numbers that are not there, too many or impossible.
    [ARRAY, "count=\"15\">0.3 0 x", "`x` is not a number of single", "float_array"],
    [ARRAY, "count=\"18\">0.3 0 0", "here are 15 numbers; it takes 18", "float_array"],
    [ARRAY, "count=\"14\">0.3 0 0", "14 numbers are not a list of points", "float_array"],
    ["<color>7 6 5", "<color>7 -6 5", "cannot be negative", "<color>"],
    ["<xfov>41.7", "<xfov>1e9", "invalid field of view of 1000000000", "<camera"],
    ["<radius>.3", "<radius>0", "invalid radius 0: must be positive", "<radius>"],
    // An index list that the course steps through wrongly.
    [NORMALS, COLOURS, "2 indices here, and the course steps by 1", "<polylist"],
    ["</asset>", "</asse>", "is not valid XML", "</asse>"],
    ["<COLLADA ", "<KML ", "is not valid XML", ""],
];

#[test]
fn what_the_course_does_not_render_is_refused_with_the_place() {
    for [from, to, message, line] in REFUSED {
        let error = altered(from, to).expect_err(message).to_string();
        assert!(error.contains(message) && error.contains("room.dae:"), "{error}");
        assert!(error.contains(line), "{error}");
    }
    for (text, message) in [("", "is not valid XML"), ("<kml/>", "is not a COLLADA file")] {
        let error = read(text).unwrap_err().to_string();
        assert!(error.contains(message), "{error}");
    }
}

#[test]
fn two_fans_that_touch_in_a_vertex_are_no_manifold() {
    let text = ROOM.replacen(FOUR, "<triangles count=\"2\">", 1).replacen(TENT, "0 1 4 2 3 4", 1);
    let error = read(&text).unwrap_err().to_string();
    assert!(error.contains("do not form one fan around vertex 4"), "{error}");
}

#[test]
fn materials_without_counterpart_are_named() {
    let glass = ROOM.replacen("<glass>", "<microfacet>", 1);
    let error = read(&glass.replacen("</glass>", "</microfacet>", 1)).unwrap_err().to_string();
    assert!(error.contains("`microfacet` has no counterpart in `furnace`"), "{error}");
}

#[test]
#[ignore = "needs the course's scenes: a folder `../shared/scenes`, or one that COURSE_SCENES names"]
fn the_courses_own_scenes_are_read() {
    let folder = std::env::var("COURSE_SCENES").unwrap_or_else(|_| "../shared/scenes".to_owned());
    let scene = |name: &str| {
        let path = Path::new(&folder).join(format!("{name}.dae"));
        load(&path, [480, 360]).unwrap_or_else(|error| panic!("{error}")).scene
    };
    let spheres = scene("CBspheres_lambertian");
    let camera = spheres.camera.unwrap();
    assert_eq!(camera.position.z.to_bits(), 0x4013_3599_c022_8dce, "{camera:?}");
    assert!((camera.horizontal_fov.to_degrees() - 30.68).abs() < 0.005, "{camera:?}");
    assert_eq!((spheres.primitive_count(), spheres.lights.len()), (14, 1));
    assert_eq!(scene("CBbunny").primitive_count(), 28588);
    assert_eq!(scene("maxplanck").primitive_count(), 50801);
    assert_eq!(scene("bunny").lights.len(), 0);
}
