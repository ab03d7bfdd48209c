//! The text that Mitsuba reads. That it answers alike is shown by the references.

use super::*;
use crate::scene::procedural::parallelogram;
use crate::scene::{Library, Light, Material, Mesh, Overrides, Surface};
use glam::DVec3;

fn exported(name: &str) -> Result<Exported, ExportError> {
    let library = Library::new(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes"));
    export(&library.load(name, &Overrides::new()).unwrap(), 5)
}

/// The text of `scene.xml`.
fn xml(scene: &Exported) -> &str {
    match &scene.files[0].1 {
        Content::Text(xml) => xml,
        other => panic!("{other:?} is no text"),
    }
}

#[test]
fn a_whole_scene_is_written_as_mitsuba_reads_it() {
    let grey = Surface::Diffuse { reflectance: [0.37; 3] };
    let scene = SceneDescription {
        camera: Some(Camera::look_at(3.0 * DVec3::Z, DVec3::ZERO, DVec3::Y, 1.0, [128, 96])),
        materials: vec![Material { name: "grey".to_owned(), surface: grey, emission: None }],
        meshes: vec![Mesh {
            name: "wall".to_owned(),
            ..parallelogram(DVec3::ZERO, [4.0 * DVec3::X, 2.0 * DVec3::Y])
        }],
        lights: vec![Light::Point { position: DVec3::ONE, intensity: [1.5, 2.0, 3.0] }],
        ..SceneDescription::default()
    };
    let scene = export(&scene, 5).unwrap();
    let expected = r#"<scene version="3.9.1">
    <integrator type="path">
        <integer name="max_depth" value="6"/>
        <integer name="rr_depth" value="1000000"/>
        <integer name="block_size" value="32"/>
    </integrator>
    <sensor type="perspective">
        <string name="fov_axis" value="x"/>
        <float name="fov" value="57.29577951308232"/>
        <float name="near_clip" value="0.001"/>
        <float name="far_clip" value="1000000"/>
        <transform name="to_world">
            <lookat origin="0, 0, 3" target="0, 0, 2" up="0, 1, 0"/>
        </transform>
        <film type="hdrfilm">
            <integer name="width" value="128"/>
            <integer name="height" value="96"/>
            <string name="pixel_format" value="rgb"/>
            <string name="component_format" value="float32"/>
            <rfilter type="box"/>
        </film>
        <sampler type="multijitter"/>
    </sensor>
    <shape type="rectangle" id="wall">
        <transform name="to_world">
            <matrix value="2 0 0 2 0 1 0 1 0 0 1 0 0 0 0 1"/>
        </transform>
        <bsdf type="twosided">
            <bsdf type="diffuse">
                <rgb name="reflectance" value="0.37 0.37 0.37"/>
            </bsdf>
        </bsdf>
    </shape>
    <emitter type="point">
        <point name="position" x="1" y="1" z="1"/>
        <rgb name="intensity" value="1.5 2 3"/>
    </emitter>
</scene>
"#;
    assert_eq!(xml(&scene), expected);
    assert_eq!(scene.files.len(), 1);
}

#[test]
fn each_scene_says_what_makes_it_the_same_question() {
    let said: [(&str, &[&str]); 5] = [
        (
            "glass-sphere-in-sky",
            &[
                r#"<float name="int_ior" value="1.5"/>"#,
                r#"<float name="ext_ior" value="1"/>"#,
                r#"<emitter type="constant">"#,
            ],
        ),
        (
            "veach-plates",
            &[
                r#"<bsdf type="roughconductor">"#,
                r#"<string name="distribution" value="ggx"/>"#,
                r#"<float name="alpha" value="0.15"/>"#,
            ],
        ),
        (
            "sphere-furnace",
            &[r#"<boolean name="flip_normals" value="true"/>"#, r#"<emitter type="area">"#],
        ),
        ("soup", &[r#"<boolean name="face_normals" value="true"/>"#]),
        ("teapot", &[r#"<boolean name="face_normals" value="false"/>"#]),
    ];
    for (name, lines) in said {
        let scene = exported(name).unwrap();
        let xml = xml(&scene);
        lines.iter().for_each(|line| assert!(xml.contains(line), "{name}: {line} in {xml}"));
    }
}

#[test]
fn glass_is_one_sided_and_metals_are_two_sided() {
    let sides = |name| xml(&exported(name).unwrap()).matches("twosided").count();
    assert_eq!(sides("glass-sphere-in-sky"), 0);
    assert_eq!(sides("veach-plates"), 8, "every shape but none of glass");
}

#[test]
fn flat_meshes_have_no_normals_and_smooth_ones_have() {
    let flat = exported("soup").unwrap();
    assert_eq!(flat.files[1].0, "mesh-0.ply");
    assert!(!ply_header(&flat).contains("float nx"));
    assert!(ply_header(&exported("teapot").unwrap()).contains("float nx"));
}

fn ply_header(scene: &Exported) -> String {
    match &scene.files[1].1 {
        Content::Bytes(bytes) => String::from_utf8_lossy(&bytes[..250]).into_owned(),
        other => panic!("{other:?} is no mesh"),
    }
}

#[test]
fn meshes_come_back_from_their_files() {
    let library = Library::new(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes"));
    let scene = library.load("teapot", &Overrides::new()).unwrap();
    let folder = tempfile::tempdir().unwrap();
    export(&scene, 1).unwrap().write_to(folder.path()).unwrap();
    let path = folder.path().join("mesh-0.ply");
    let back = crate::scene::mesh::load(&path, crate::scene::mesh::Format::Ply).unwrap();
    let mesh = &scene.meshes[0];
    assert_eq!(back.indices, mesh.indices);
    for (written, read) in mesh.positions.iter().zip(&back.positions) {
        assert!(written.abs_diff_eq(*read, 1e-6));
    }
}

#[test]
fn a_gradient_sky_is_a_picture_with_its_zenith_on_top() {
    let scene = exported("gradient-sky").unwrap();
    let (name, Content::Picture(picture)) = &scene.files[1] else { panic!("no picture") };
    assert_eq!(name, "sky.exr");
    let row = |row: usize| picture.pixels[picture.width * row][0];
    assert!((row(0) - 1.3).abs() < 1e-6, "zenith");
    assert!((row(512) - 0.4).abs() < 1e-6 && row(1024) == 0.4, "horizon and below");
    let middle = 0.4 + 0.9 * std::f32::consts::FRAC_1_SQRT_2;
    assert!((row(256) - middle).abs() < 1e-6, "half way down");
}

#[test]
fn what_mitsuba_cannot_do_is_said() {
    let message = |scene: Result<Exported, ExportError>| scene.unwrap_err().to_string();
    assert!(message(exported("cap-cavity")).contains("its closed form is its reference"));
    let oblong = message(exported("sphere-in-view"));
    assert!(oblong.contains("pixels are not square, and Mitsuba's are"), "{oblong}");
    let empty = message(export(&SceneDescription::default(), 1));
    assert!(empty.ends_with("it has no camera"), "{empty}");
}
