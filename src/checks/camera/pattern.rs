//! A scene that tells where in a pixel its samples lie, though all that can be seen of them is
//! their mean.
//!
//! Every second pixel of every second row shows five by five cells of light; all else is
//! background. Each cell glows with powers of 4, so that the sum of three samples, written in base
//! 4, has in each digit how many of them fell where: in which column of cells, which row, and which
//! diagonal either way. The diagonals tell two independent numbers from the same one used twice.
//! Pixels that show background alone tell whether samples leave their pixel.

use crate::checks::camera::projection;
use crate::scene::{Camera, Emission, Material, Mesh, SceneDescription, Surface};
use glam::{DVec2, DVec3};

/// Columns and rows of the film; odd, so that every pixel of the border is dark.
pub const FILM: [u32; 2] = [17, 13];
/// Camera rays per pixel: one less than the base of the digits.
pub(crate) const SAMPLES: u32 = 3;
/// Cells in a row, and digits of a number; odd, so that the middle of a pixel is in the middle of
/// one.
pub(crate) const CELLS: usize = 5;
/// Between the border of a pixel and its cells, in pixels: no rounding carries a sample across.
pub(crate) const MARGIN: f64 = 0.002;

const BASE: f64 = 4.0;
/// The digit of red that counts samples of the background.
const BACKGROUND: usize = CELLS;
/// How far from a whole number a decoded sum may be: roundings of single precision make a tenth of
/// that.
const WHOLE: f64 = 0.25;

fn digit(place: usize) -> f64 {
    BASE.powi(i32::try_from(place).unwrap_or(i32::MAX))
}

/// What a cell glows with: its column in red, its row in green, its two diagonals in blue.
fn cell_radiance([column, row]: [usize; 2]) -> [f64; 3] {
    let [falling, rising] = diagonals([column, row]);
    [digit(column), digit(row), digit(falling) + digit(CELLS + rising)]
}

fn diagonals([column, row]: [usize; 2]) -> [usize; 2] {
    [(column + CELLS - row) % CELLS, (column + row) % CELLS]
}

const BACKGROUND_RADIANCE: [f64; 3] = [1024.0, 0.0, 0.0];
const _: () = assert!(BACKGROUND == 5, "1024 is the fifth power of 4");

/// Whether a pixel shows cells.
pub(crate) fn is_lit([x, y]: [u32; 2]) -> bool {
    x % 2 == 1 && y % 2 == 1
}

/// Pixels that show cells.
pub(crate) fn lit_pixels() -> u64 {
    u64::from(FILM[0] / 2) * u64::from(FILM[1] / 2)
}

/// The share of uniform samples that falls in one column of cells.
pub(crate) fn share() -> f64 {
    let side = 1.0 - 2.0 * MARGIN;
    side * side / CELLS as f64
}

/// The cell at a film point in pixels from the top left, if one is there.
pub(crate) fn cell_at(point: DVec2) -> Option<[usize; 2]> {
    let corner = point.floor();
    let inside = corner.cmpge(DVec2::ZERO).all() && corner.cmplt(FILM.map(f64::from).into()).all();
    let within = (point - corner - MARGIN) / (1.0 - 2.0 * MARGIN);
    let in_cells = within.cmpge(DVec2::ZERO).all() && within.cmplt(DVec2::ONE).all();
    let is_cell = inside && in_cells && is_lit([corner.x as u32, corner.y as u32]);
    is_cell.then(|| (within * CELLS as f64).to_array().map(|cell| cell as usize))
}

/// What a ray through a film point brings home.
#[cfg(test)]
pub(crate) fn radiance_at(point: DVec2) -> [f64; 3] {
    cell_at(point).map_or(BACKGROUND_RADIANCE, cell_radiance)
}

/// How many of the samples of a pixel fell where.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Decoded {
    /// In each column, row, falling and rising diagonal of cells.
    pub(crate) lines: [[u32; CELLS]; 4],
    /// Samples of the background.
    pub(crate) background: u32,
}

/// Reads a pixel; `None` if it is no mean of [`SAMPLES`] radiances of the pattern.
pub(crate) fn decode(pixel: [f32; 3]) -> Option<Decoded> {
    let [red, green, blue] = pixel.map(|mean| digits(f64::from(mean) * f64::from(SAMPLES)));
    let (red, green, blue) = (red?, green?, blue?);
    let low = |digits: [u32; 10]| std::array::from_fn(|place| digits[place]);
    let high = |digits: [u32; 10]| std::array::from_fn(|place| digits[CELLS + place]);
    let decoded = Decoded {
        lines: [low(red), low(green), low(blue), high(blue)],
        background: red[BACKGROUND],
    };
    let in_cells = SAMPLES.checked_sub(decoded.background)?;
    let is_whole = decoded.lines.iter().all(|line| line.iter().sum::<u32>() == in_cells);
    is_whole.then_some(decoded)
}

/// The digits of a sum, the lowest first.
fn digits(sum: f64) -> Option<[u32; 10]> {
    let whole = sum.round();
    let is_readable = (sum - whole).abs() <= WHOLE && (0.0..digit(10)).contains(&whole);
    is_readable.then(|| std::array::from_fn(|place| ((whole / digit(place)) % BASE) as u32))
}

/// A camera that stands and looks in no special way.
pub(crate) fn view() -> Camera {
    Camera::look_at(
        DVec3::new(1.3, -2.1, 0.7),
        DVec3::new(-0.4, 0.2, 1.9),
        DVec3::new(0.1, 0.2, 1.0),
        50f64.to_radians(),
        FILM,
    )
}

/// The scene as [`view`] sees it.
pub(crate) fn scene() -> SceneDescription {
    let camera = view();
    let mut meshes = vec![background(&camera)];
    let mut materials = vec![glowing("background", BACKGROUND_RADIANCE)];
    for cell in (0..CELLS).flat_map(|row| (0..CELLS).map(move |column| [column, row])) {
        let material = u32::try_from(materials.len()).unwrap_or(u32::MAX);
        let [column, row] = cell;
        materials.push(glowing(&format!("cell {column}, {row}"), cell_radiance(cell)));
        meshes.push(Mesh { material, ..cells(&camera, cell) });
    }
    let scene = SceneDescription {
        name: "pixel-pattern".to_owned(),
        camera: Some(camera),
        materials,
        meshes,
        ..Default::default()
    };
    scene.with_area_lights()
}

/// A black surface of this radiance.
pub(crate) fn glowing(name: &str, radiance: [f64; 3]) -> Material {
    Material {
        name: name.to_owned(),
        surface: Surface::Diffuse { reflectance: [0.0; 3] },
        emission: Some(Emission { radiance, cap: None }),
    }
}

/// The point at this depth that is seen at a film point in pixels from the top left.
fn seen_at(camera: &Camera, point: DVec2, depth: f64) -> DVec3 {
    let from_top = point / DVec2::from(FILM.map(f64::from));
    let film = DVec2::new(from_top.x, 1.0 - from_top.y);
    camera.position + depth * projection(camera, film)
}

/// Quads between pairs of film points, at a depth, facing the camera.
pub(crate) fn quads(
    camera: &Camera,
    corners: impl Iterator<Item = [DVec2; 2]>,
    depth: f64,
) -> Mesh {
    let mut mesh = Mesh::default();
    for [top_left, bottom_right] in corners {
        let first = u32::try_from(mesh.positions.len()).unwrap_or(u32::MAX);
        let bottom_left = DVec2::new(top_left.x, bottom_right.y);
        let top_right = DVec2::new(bottom_right.x, top_left.y);
        let around = [top_left, bottom_left, bottom_right, top_right];
        mesh.positions.extend(around.map(|point| seen_at(camera, point, depth)));
        mesh.indices.extend([[0, 1, 2], [0, 2, 3]].map(|corners| corners.map(|c| first + c)));
    }
    mesh
}

/// Behind the cells, beyond the film on every side.
pub(crate) fn background(camera: &Camera) -> Mesh {
    let corners = [DVec2::splat(-4.0), DVec2::from(FILM.map(f64::from)) + 4.0];
    quads(camera, [corners].into_iter(), 1.01)
}

/// The same cell of every lit pixel.
fn cells(camera: &Camera, cell: [usize; 2]) -> Mesh {
    let size = (1.0 - 2.0 * MARGIN) / CELLS as f64;
    let offset = DVec2::from(cell.map(|number| number as f64)) * size + MARGIN;
    let pixels = (0..FILM[1]).flat_map(|y| (0..FILM[0]).map(move |x| [x, y]));
    let corners = pixels.filter(|at| is_lit(*at)).map(|at| {
        let corner = DVec2::from(at.map(f64::from)) + offset;
        [corner, corner + size]
    });
    quads(camera, corners, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::oracle;
    use crate::contract::Ray;
    use crate::math::rng::{Seed, uniform};

    #[test]
    fn the_scene_shows_the_pattern() {
        let (scene, mut stream) = (scene(), Seed(1).stream());
        let camera = scene.camera.unwrap();
        for _ in 0..300 {
            let point = DVec2::new(uniform(&mut stream), uniform(&mut stream));
            let pixels = point * DVec2::from(FILM.map(f64::from));
            let direction = seen_at(&camera, pixels, 1.0) - camera.position;
            let ray = Ray::new(camera.position, direction.normalize());
            let met = oracle::nearest(&scene, &ray).unwrap();
            assert!(met.answer.geometric_normal.dot(ray.direction) < 0.0, "seen from behind");
            let emission = scene.material_of(met.shape).emission.unwrap();
            assert_eq!(emission.radiance, radiance_at(pixels), "{pixels}");
        }
    }

    #[test]
    fn what_is_written_can_be_read() {
        let of = |cells: [Option<[usize; 2]>; 3]| {
            let radiances = cells.map(|cell| cell.map_or(BACKGROUND_RADIANCE, cell_radiance));
            decode(std::array::from_fn(|c| {
                (radiances.iter().map(|radiance| radiance[c]).sum::<f64>() / 3.0) as f32
            }))
        };
        let decoded = of([Some([4, 4]), Some([4, 4]), Some([0, 1])]).unwrap();
        assert_eq!(decoded.lines[0], [1, 0, 0, 0, 2]);
        assert_eq!(decoded.lines[1], [0, 1, 0, 0, 2]);
        assert_eq!(decoded.lines[2], [2, 0, 0, 0, 1]);
        assert_eq!(decoded.lines[3], [0, 1, 0, 2, 0]);
        assert_eq!(of([None, None, None]).unwrap().background, 3);
        assert_eq!(of([None, None, Some([2, 2])]).unwrap().background, 2);
    }

    #[test]
    fn other_pixels_cannot() {
        assert_eq!(decode([0.0; 3]), None);
        assert_eq!(decode([1024.0, 1.0, 0.0]), None);
        assert_eq!(decode([f32::NAN; 3]), None);
        assert_eq!(decode([f32::INFINITY; 3]), None);
        assert_eq!(decode([512.0, 0.0, 0.0]), None);
    }
}
