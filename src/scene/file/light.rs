//! `[[light]]`: the lights that are not shapes.

use super::{Context, exactly_one};
use crate::scene::Light;
use crate::text::{Colour, Diagnostic, Direction, Spanned, Vector};
use serde::Deserialize;

tables! {
    pub(super) struct Entry {
        /// Shines from a point equally in all directions.
        point: Option<Point>,
        /// Shines from infinitely far away.
        directional: Option<Directional>,
        /// The same radiance from every direction that meets no shape.
        constant_sky: Option<ConstantSky>,
        /// Radiance from direction w: horizon + (zenith − horizon) · max(0, w · up).
        gradient_sky: Option<GradientSky>,
    }

    struct Point {
        position: Vector,
        /// Watts per steradian.
        intensity: Colour,
    }
    struct Directional {
        /// The way the light travels.
        direction: Direction,
        /// Watts per square unit on a surface that faces the light.
        irradiance: Colour,
    }
    struct ConstantSky { radiance: Colour }
    struct GradientSky {
        up: Direction,
        /// Radiance at and below the horizon.
        horizon: Colour,
        /// Radiance straight above.
        zenith: Colour,
    }
}

pub(super) fn resolve_all(
    entries: Vec<Spanned<Entry>>,
    context: &Context<'_>,
) -> Result<Vec<Light>, Diagnostic> {
    let mut lights: Vec<Light> = Vec::new();
    for entry in entries {
        let span = entry.span();
        let light = entry.into_inner().light();
        let light = light.map_err(|problem| context.wrong(span.clone(), problem))?;
        if is_sky(&light) && lights.iter().any(is_sky) {
            return Err(context.wrong(span, "second environment light: a scene has at most one"));
        }
        lights.push(light);
    }
    Ok(lights)
}

fn is_sky(light: &Light) -> bool {
    matches!(light, Light::ConstantSky { .. } | Light::GradientSky { .. })
}

impl Entry {
    fn light(self) -> Result<Light, String> {
        let point = |Point { position, intensity }| Light::Point {
            position: position.0,
            intensity: intensity.0,
        };
        let directional = |Directional { direction, irradiance }| Light::Directional {
            direction: direction.0,
            irradiance: irradiance.0,
        };
        let constant = |ConstantSky { radiance }| Light::ConstantSky { radiance: radiance.0 };
        let gradient = |GradientSky { up, horizon, zenith }| Light::GradientSky {
            up: up.0,
            horizon: horizon.0,
            zenith: zenith.0,
        };
        let kinds = [
            ("point", self.point.map(point)),
            ("directional", self.directional.map(directional)),
            ("constant-sky", self.constant_sky.map(constant)),
            ("gradient-sky", self.gradient_sky.map(gradient)),
        ];
        exactly_one("a light", kinds)
    }
}
