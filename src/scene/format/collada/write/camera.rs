//! The camera: in the scene's file as COLLADA has it, of which the course takes only the direction, and in
//! the file for its `-c`, which is taken as it is.

use super::super::read::degrees_for;
use super::Node;
use crate::scene::Camera;
use crate::scene::format::numbers;
use crate::scene::format::xml::XmlWriter;
use glam::DAffine3;

pub(super) fn write(xml: &mut XmlWriter, camera: &Camera) -> Vec<Node> {
    xml.open("library_cameras", &[]);
    xml.open("camera", &[("id", "eye-camera"), ("name", "eye")]);
    xml.open("optics", &[]);
    xml.open("technique_common", &[]);
    xml.open("perspective", &[]);
    let values = [
        ("xfov", camera.horizontal_fov.to_degrees()),
        ("yfov", camera.vertical_fov.to_degrees()),
        ("znear", camera.near),
        ("zfar", camera.far),
    ];
    for (name, value) in values {
        xml.text(name, &[], &numbers([value]));
    }
    (0..5).for_each(|_| xml.close());
    let transform = DAffine3 { matrix3: camera.camera_to_world, translation: camera.position };
    let [id, of] = ["eye", "eye-camera"].map(str::to_owned);
    vec![Node { id, transform, instance: "instance_camera", of, material: None }]
}

/// The file for `-c`: numbers in the order in which the course's program saves them.
pub(super) fn settings(camera: &Camera) -> String {
    let [width, height] = camera.film.map(f64::from);
    let backward = camera.camera_to_world.z_axis;
    let distance = height / (2.0 * (camera.vertical_fov / 2.0).tan());
    let fovs = [camera.horizontal_fov, camera.vertical_fov].map(degrees_for);
    let rows = (0..3).flat_map(|row| camera.camera_to_world.row(row).to_array());
    let angles = [backward.y.acos(), backward.x.atan2(backward.z)];
    [
        numbers([fovs[0], fovs[1], width / height, camera.near, camera.far]),
        numbers(camera.position.to_array()),
        numbers((camera.position - backward).to_array()),
        // Angles and distance from what is looked at, and how near and far the mouse may go.
        numbers([angles[0], angles[1], 1.0, 0.1, 10.0]),
        numbers(rows),
        numbers([width, height, distance]),
        // Of a lens, which the course's pinhole does not look at.
        numbers([4.7, 0.0]),
        String::new(),
    ]
    .join("\n")
}
