//! What a reference holds beside its image: each bounce alone, and what stands at the centre of each pixel.
//!
//! Bounces are channels `bounce.0.R` and so on: 0 is directly visible emission. What is seen
//! first are `depth.Z`, the distance from the camera, infinite where nothing is hit, and
//! `normal.X`, `normal.Y`, `normal.Z`, the unit shading normal in world space, 0 where nothing is.

use crate::image::Image;
use crate::image::exr::{Channel, Exr, Storage};
use crate::image::pair::Plane;

const DEPTH: &str = "depth.Z";
const NORMAL: [&str; 3] = ["normal.X", "normal.Y", "normal.Z"];

/// What a reference holds beside its image; nothing, where nobody has added it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Layers {
    /// The mean radiance of each bounce alone, from bounce 0.
    pub(crate) bounces: Vec<Image>,
    /// What stands at the centre of each pixel.
    pub(crate) first_hits: Option<FirstHits>,
}

/// What stands at the centre of each pixel, exactly.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct FirstHits {
    /// Distance from the camera in units of the scene; infinite where nothing is hit.
    pub(crate) depth: Plane,
    /// Unit shading normal in world space; 0 where nothing is hit.
    pub(crate) normal: Image,
}

impl Layers {
    /// The layers in a file; those that it lacks are not there.
    pub(crate) fn read(file: &Exr) -> Self {
        let bounces = (0..).map_while(|bounce| file.colours(&prefix(bounce)).ok()).collect();
        Self { bounces, first_hits: FirstHits::read(file) }
    }

    /// The file with these layers more.
    #[must_use]
    pub(crate) fn added_to(&self, mut file: Exr) -> Exr {
        for (bounce, light) in self.bounces.iter().enumerate() {
            file = file.with_colours(&prefix(bounce), light, Storage::Half);
        }
        if let Some(first_hits) = &self.first_hits {
            file.channels.extend(first_hits.channels());
        }
        file
    }
}

fn prefix(bounce: usize) -> String {
    format!("{}.", bounce_layer(bounce))
}

/// What the layer of a bounce is called.
pub(crate) fn bounce_layer(bounce: usize) -> String {
    format!("bounce.{bounce}")
}

impl FirstHits {
    fn read(file: &Exr) -> Option<Self> {
        let values = |name: &str| Some(&file.channel(name).ok()?.values);
        let (width, height) = (file.width, file.height);
        let depth = Plane { width, height, values: values(DEPTH)?.clone() };
        let [x, y, z] = [values(NORMAL[0])?, values(NORMAL[1])?, values(NORMAL[2])?];
        let pixels = (0..x.len()).map(|i| [x[i], y[i], z[i]]).collect();
        Some(Self { depth, normal: Image { width, height, pixels } })
    }

    fn channels(&self) -> impl Iterator<Item = Channel> + '_ {
        let of_normal = |axis: usize| Channel {
            name: NORMAL[axis].to_owned(),
            values: self.normal.pixels.iter().map(|normal| normal[axis]).collect(),
            storage: Storage::Half,
        };
        let values = self.depth.values.clone();
        let depth = Channel { name: DEPTH.to_owned(), values, storage: Storage::Single };
        [depth].into_iter().chain((0..3).map(of_normal))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_come_back_from_a_file_and_a_file_without_has_none() {
        let picture = Image::new(2, 1, [0.5; 3]);
        let layers = Layers {
            bounces: vec![Image::new(2, 1, [0.25; 3]), Image::new(2, 1, [0.125, 0.0, 1.0])],
            first_hits: Some(FirstHits {
                depth: Plane { width: 2, height: 1, values: vec![3.7, f32::INFINITY] },
                normal: Image { width: 2, height: 1, pixels: vec![[0.0, 1.0, 0.0], [0.0; 3]] },
            }),
        };
        let file = Exr::from_image(&picture);
        assert_eq!(Layers::read(&file), Layers::default());
        let file = layers.added_to(file);
        assert_eq!(Layers::read(&file), layers);
        assert_eq!(file.image().unwrap(), picture);
    }
}
