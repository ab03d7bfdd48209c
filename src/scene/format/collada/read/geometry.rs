//! Meshes and spheres of the file, in world space.

use super::normals::vertex_normals;
use super::xml::{Element, Instance, Reader, Result, children, first_child};
use crate::scene::{Mesh, Sphere};
use glam::{DMat4, DVec3, DVec4};
use std::collections::BTreeSet;

/// Meanings of an index that the course counts when it steps through the list of indices.
const COUNTED: [&str; 3] = ["VERTEX", "NORMAL", "TEXCOORD"];

struct Polygons {
    corners: Vec<Vec<u32>>,
    /// How many have more than three corners.
    cut: usize,
}

/// A mesh, and what the course makes of it that its author may not have meant.
pub(super) struct ReadMesh {
    pub(super) mesh: Mesh,
    pub(super) differences: Vec<String>,
}

/// Reads a `geometry` with a `mesh`; material 0.
pub(super) fn read_mesh<'a>(reader: &Reader<'a>, geometry: &Instance<'a>) -> Result<ReadMesh> {
    let Instance { name, element, transform } = geometry;
    reader.name_of(*element)?;
    let element = reader.need(*element, "mesh")?;
    let vertices = reader.need(element, "vertices")?;
    let positions = read_positions(reader, element, vertices, transform)?;
    let list = polygon_list(reader, element)?;
    let polygons = read_polygons(reader, list, vertices, positions.len())?;
    let normals = vertex_normals(&positions, &polygons.corners)
        .map_err(|complaint| reader.wrong(list, format!("mesh `{name}` {complaint}")))?;
    let mut differences = Vec::new();
    if polygons.cut > 0 {
        differences.push(format!(
            "mesh `{name}`: the course makes one triangle of each of {} polygons with more corners",
            polygons.cut
        ));
    }
    let indices = polygons.corners.iter().map(|corners| course_triangle(corners)).collect();
    let name = (*name).to_owned();
    let mut mesh = Mesh { name, positions, normals, indices, material: 0 };
    turn_to_normals(&mut mesh);
    Ok(ReadMesh { mesh, differences })
}

/// The triangle that the course makes of a polygon: it starts at the last corner.
fn course_triangle(corners: &[u32]) -> [u32; 3] {
    [corners[corners.len() - 1], corners[0], corners[1]]
}

/// Lets the front of each triangle be the side of its shading normals. The course knows no other
/// normal, so that winding means nothing to it.
fn turn_to_normals(mesh: &mut Mesh) {
    for triangle in 0..mesh.indices.len() {
        let [a, b, c] = mesh.corners(triangle);
        let shading: DVec3 = mesh.corner_normals(triangle).iter().sum();
        if (b - a).cross(c - a).dot(shading) < 0.0 {
            mesh.indices[triangle].swap(1, 2);
        }
    }
}

/// Numbers are read in single precision and transformed in double precision.
fn read_positions<'a>(
    reader: &Reader<'a>,
    mesh: Element<'a>,
    vertices: Element<'a>,
    transform: &DMat4,
) -> Result<Vec<DVec3>> {
    let input = children(vertices, "input")
        .find(|input| input.attribute("semantic") == Some("POSITION"))
        .ok_or_else(|| reader.wrong(vertices, "has no input `POSITION`"))?;
    let source = reader.follow(input, "source")?;
    if source.parent() != Some(mesh) {
        return Err(reader.wrong(input, "the course looks for sources in the same mesh only"));
    }
    let array = reader.need(source, "float_array")?;
    let count = reader.count(array, "count")?;
    let numbers: Vec<f32> = reader.first_numbers(array, count)?;
    let (points, rest) = numbers.as_chunks::<3>();
    if !rest.is_empty() {
        return Err(reader.wrong(array, format!("{count} numbers are not a list of points")));
    }
    let positions: Vec<_> = points.iter().map(|p| in_world(transform, p.map(f64::from))).collect();
    match positions.iter().position(|position| !position.is_finite()) {
        Some(vertex) => Err(reader
            .wrong(array, format!("vertex {vertex} is not finite"))
            .with_hint("the last row of the node's matrix should be `0 0 0 1`")),
        None => Ok(positions),
    }
}

fn in_world(transform: &DMat4, local: [f64; 3]) -> DVec3 {
    let point = *transform * DVec4::new(local[0], local[1], local[2], 1.0);
    point.truncate() * (1.0 / point.w)
}

/// The first `polylist` or else the first `triangles`: the course looks at no other list.
fn polygon_list<'a>(reader: &Reader<'a>, mesh: Element<'a>) -> Result<Element<'a>> {
    let list = ["polylist", "triangles"].into_iter().find_map(|name| first_child(mesh, name));
    list.ok_or_else(|| {
        reader
            .wrong(mesh, "has neither a `polylist` nor `triangles`")
            .with_hint("the course reads no other kind of list")
    })
}

fn read_polygons<'a>(
    reader: &Reader<'a>,
    list: Element<'a>,
    vertices: Element<'a>,
    vertex_count: usize,
) -> Result<Polygons> {
    let (offset, stride) = index_layout(reader, list, vertices)?;
    let sizes = polygon_sizes(reader, list)?;
    let indices: Vec<u32> = {
        let needed = sizes.iter().map(|size| *size as usize * stride).sum();
        reader.first_numbers(reader.need(list, "p")?, needed)?
    };
    let mut of_vertices = indices.iter().skip(offset).step_by(stride).copied();
    let corners: Vec<Vec<u32>> =
        sizes.iter().map(|size| of_vertices.by_ref().take(*size as usize).collect()).collect();
    for (polygon, corners) in corners.iter().enumerate() {
        check_polygon(corners, vertex_count)
            .map_err(|complaint| reader.wrong(list, format!("polygon {polygon} {complaint}")))?;
    }
    Ok(Polygons { corners, cut: sizes.iter().filter(|size| **size > 3).count() })
}

fn check_polygon(corners: &[u32], vertices: usize) -> std::result::Result<(), String> {
    if corners.len() < 3 {
        return Err(format!("has {} corners", corners.len()));
    }
    if let Some(index) = corners.iter().find(|index| **index as usize >= vertices) {
        return Err(format!("refers to vertex {index}, but there are only {vertices} vertices"));
    }
    if corners.iter().collect::<BTreeSet<_>>().len() < corners.len() {
        return Err("uses the same vertex twice".to_owned());
    }
    Ok(())
}

/// Which of the indices of a corner is the vertex, and how many there are.
fn index_layout<'a>(
    reader: &Reader<'a>,
    list: Element<'a>,
    vertices: Element<'a>,
) -> Result<(usize, usize)> {
    let (mut offset, mut meanings, mut last) = (None, BTreeSet::new(), 0);
    for input in children(list, "input") {
        let meaning = reader.attribute(input, "semantic")?;
        let at = reader.count(input, "offset")?;
        last = last.max(at);
        if COUNTED.contains(&meaning) {
            meanings.insert(meaning);
        }
        if meaning == "VERTEX" {
            if reader.follow(input, "source")? != vertices {
                return Err(reader.wrong(input, "the vertices are those of another mesh"));
            }
            offset = Some(at);
        }
    }
    let offset = offset.ok_or_else(|| reader.wrong(list, "has no input `VERTEX`"))?;
    if last.saturating_add(1) == meanings.len() {
        return Ok((offset, meanings.len()));
    }
    let message = format!(
        "a corner has {} indices here, and the course steps by {}: one for each of {}",
        last.saturating_add(1),
        meanings.len(),
        COUNTED.join(", ")
    );
    Err(reader.wrong(list, message).with_hint("take out colours and further texture coordinates"))
}

fn polygon_sizes<'a>(reader: &Reader<'a>, list: Element<'a>) -> Result<Vec<u32>> {
    let count = reader.count(list, "count")?;
    match reader.find(list, "vcount")? {
        Some(sizes) => reader.first_numbers(sizes, count),
        None if list.tag_name().name() == "triangles" => triangle_sizes(reader, list, count),
        None => Err(reader.wrong(list, "`polylist` has no `vcount`")),
    }
}

/// No more triangles than the text has letters: a count may say anything.
fn triangle_sizes<'a>(reader: &Reader<'a>, list: Element<'a>, count: usize) -> Result<Vec<u32>> {
    let letters = reader.need(list, "p")?.text().map_or(0, str::len);
    if count > letters {
        return Err(reader.wrong(list, format!("has no indices for {count} triangles")));
    }
    Ok(vec![3; count])
}

/// Reads a `geometry` that is a sphere of the CGL profile; material 0.
pub(super) fn read_sphere<'a>(reader: &Reader<'a>, geometry: &Instance<'a>) -> Result<Sphere> {
    let Instance { name, element, transform } = *geometry;
    reader.name_of(element)?;
    let technique = reader.technique(element, "CGL").ok_or_else(|| {
        reader.wrong(element, "is neither a mesh nor a sphere of the CGL profile")
    })?;
    let element = reader.need(technique, "sphere/radius")?;
    let radius = f64::from(reader.narrowed(element)?);
    let scale = (transform * DVec4::X).truncate().length();
    let sphere = Sphere {
        name: name.to_owned(),
        centre: in_world(&transform, [0.0; 3]),
        radius: radius * scale,
        inward: false,
        material: 0,
    };
    match sphere.centre.is_finite() && sphere.radius.is_finite() && sphere.radius > 0.0 {
        true => Ok(sphere),
        false => {
            Err(reader
                .wrong(element, format!("invalid radius {}: must be positive", sphere.radius)))
        }
    }
}
