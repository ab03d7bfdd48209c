//! Shading normals at pixel centres as colours: (n + 1) / 2, black where nothing is hit.

use super::Request;
use crate::contract::{Capabilities, Core, CoreError, Hit, Ray};
use crate::image::Image;
use crate::scene::Camera;
use glam::{DVec2, DVec3};
use std::time::Instant;

/// The image, and the seconds that its rays took.
///
/// # Errors
/// If the core does not answer.
pub(super) fn render(
    core: &mut dyn Core,
    capabilities: Capabilities,
    request: &Request<'_>,
) -> Result<(Image, f64), CoreError> {
    let camera = request.camera;
    let rays = match capabilities.contains(Capabilities::GENERATE_RAYS) {
        true => cores_rays(core, camera)?,
        false => camera_rays(camera),
    };
    let mut hits = vec![Hit::MISS; rays.len()];
    let mut built = core.build_scene(request.scene, request.shot.acceleration())?;
    let begun = Instant::now();
    built.intersect(&rays, &mut hits)?;
    let seconds = begun.elapsed().as_secs_f64();
    let [width, height] = camera.film.map(|side| side as usize);
    Ok((Image { width, height, pixels: hits.iter().map(colour).collect() }, seconds))
}

/// Through every pixel's centre, by the formula of [`Camera`].
pub(crate) fn camera_rays(camera: &Camera) -> Vec<Ray> {
    let Camera { position, near, far, .. } = *camera;
    let towards = |film| camera.towards(film);
    let ray = |direction| Ray { origin: position, t_min: near, direction, t_max: far };
    camera.pixel_centres().map(towards).map(ray).collect()
}

/// Whatever the core takes for a camera is seen in the image.
fn cores_rays(core: &mut dyn Core, camera: &Camera) -> Result<Vec<Ray>, CoreError> {
    let film: Vec<DVec2> = camera.pixel_centres().collect();
    let mut rays = vec![Ray::new(DVec3::ZERO, DVec3::Z); film.len()];
    core.generate_rays(camera, &film, &mut rays)?;
    Ok(rays)
}

fn colour(hit: &Hit) -> [f32; 3] {
    match hit.is_hit() {
        true => (0.5 * (hit.shading_normal + 1.0)).as_vec3().to_array(),
        false => [0.0; 3],
    }
}
