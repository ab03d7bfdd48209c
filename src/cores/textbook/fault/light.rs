//! Part 3: lights and direct light.

use super::faults;
use crate::cause::{convention, integrator, light};
use crate::contract::{DirectSampling, Ray};
use crate::cores::textbook as lesson;
use glam::{DVec2, DVec3};
use lesson::vertex::shadow_ray;
use std::f64::consts::{FRAC_1_PI, PI};

/// What a rough conductor shows of lights that light sampling and BSDF sampling both find.
const GLOSSY: &str = "light/lights-over-rough-conductor-match-quadrature";
const SLANTED: &str = "light/rectangle-light-slanted-matches-closed-form";
const RECTANGLE: &str = "light/rectangle-light-samples-reach-the-light";

faults! { part 3;
    "light-pdf-by-distance":
        "the pdf of a light sample lacks a factor of the distance, as in the course's base code",
        fails RECTANGLE, told light::LIGHT_DISTANCE_NOT_SQUARED,
        area_per_steradian = |distance_squared, cosine| distance_squared.sqrt() / cosine;
    "light-pdf-without-cosine": "distance²/area, without the cosine at the light",
        fails RECTANGLE, told light::LIGHT_COSINE_FORGOTTEN,
        area_per_steradian = |distance_squared, _| distance_squared;
    "light-pdf-per-area": "1/area, as if it were a pdf over directions",
        fails RECTANGLE, told light::LIGHT_PDF_PER_AREA,
        area_per_steradian = |_, _| 1.0;
    "light-area-forgotten": "distance²/cos θ, without the area",
        fails RECTANGLE, told light::LIGHT_AREA_FORGOTTEN,
        mesh_pdf = |area_per_steradian, _, _| area_per_steradian;
    "light-area-of-one-triangle":
        "distance²/(cos θ · area of the triangle): that it was picked among several is forgotten",
        fails RECTANGLE, told light::LIGHT_TRIANGLE_NOT_PICKED,
        mesh_pdf = |area_per_steradian, area, triangles| {
            area_per_steradian / area * triangles as f64
        };
    "sphere-light-as-disk": "1/(π sin² θ) for directions to a sphere: the solid angle of its cone as if it were small",
        fails "light/sphere-light-samples-reach-the-light", told light::SPHERE_LIGHT_AS_DISK,
        cone_pdf = |height| FRAC_1_PI / (height * (2.0 - height));
    "back-of-surface-unlit": "max(0, cos θ) at a surface that is seen from its back",
        fails "light/back-of-a-surface-is-lit-like-its-front", told light::BACK_UNLIT,
        light_cosine = |local, _| local.z.max(0.0);
    "light-cosine-moved":
        "the cosine at the light in the radiance, not in the pdf: the picture is right",
        fails RECTANGLE, told light::LIGHT_COSINE_FORGOTTEN,
        area_per_steradian = |distance_squared, _| distance_squared,
        mesh_radiance = |radiance, to_light, normal| {
            let cosine = (-to_light).normalize().dot(normal);
            radiance.map(|radiance| radiance * cosine.max(0.0))
        };
    "light-shines-backwards": "|cos θ| at the light: it shines to its back too",
        fails RECTANGLE, told light::LIGHT_SHINES_BACKWARDS,
        cosine_at_light = |to_light, normal| {
            lesson::area_light::cosine_at_light(to_light, normal).abs()
        };
    "light-points-uneven": "u in place of √u for points of a triangle",
        fails "light/triangle-light-samples-reach-the-light", told light::LIGHT_POINTS_UNEVEN,
        triangle_point = |point| DVec2::new(point.x * (1.0 - point.y), point.x * point.y);
    "point-light-unweakened":
        "a point light is as bright at every distance, while its falloff is declared",
        fails "light/point-light-follows-the-inverse-square-law", told convention::NO_FALLOFF,
        point_light_radiance = |intensity, _| intensity;
    "directional-flipped": "wi is the direction in which the light travels",
        fails "light/directional-light-samples-lead-to-the-light", told light::DIRECTIONAL_FLIPPED,
        towards_directional = |direction| direction;
    "sky-pdf-of-hemisphere": "1/2π for directions of the whole sphere",
        fails "light/environment-samples-cover-the-sphere", told light::ENVIRONMENT_PDF_OF_HEMISPHERE,
        sky_pdf = || 2.0 * lesson::light::sky_pdf();
    "hemisphere-not-divided": "the sum is not divided by num_samples",
        fails "light/rectangle-light-slanted-by-hemisphere-sampling-matches-closed-form",
        told light::NOT_DIVIDED_BY_SAMPLES,
        hemisphere_mean = |total, _| total;
    "hemisphere-in-world": "w_in is traced without o2w",
        fails "light/rectangle-light-slanted-by-hemisphere-sampling-matches-closed-form",
        told light::HEMISPHERE_IN_WORLD,
        hemisphere_direction = |_, wi| wi;
    "hemisphere-ignored": "light is always sampled: -H has no effect",
        fails "light/hemisphere-sampling-variance-matches-closed-form",
        told light::HEMISPHERE_IGNORED,
        direct_sampling = |_| DirectSampling::Lights;
    "hemisphere-without-lights": "0/0 where there is no light",
        fails "light/scene-without-lights-is-black", told light::DIVIDED_BY_ZERO_LIGHTS,
        hemisphere_samples = |per_light, lights| per_light * lights;
    "frame-of-geometric-normal": "make_coord_space(o2w, cross(e1, e2)): shaded flat, whatever isect.n says",
        fails "light/smooth-mesh-is-lit-by-its-shading-normals",
        told light::FRAME_OF_GEOMETRIC_NORMAL,
        frame_normal = |_, hit, _| hit.geometric_normal;
    "world-cosine": "wi.z for cos θ, in the world",
        fails "light/rectangle-light-slanted-matches-closed-form", told light::WORLD_COSINE,
        light_cosine = |_, world| world.z.abs();
    "light-from-below-subtracted":
        "neither a test for cos θ > 0 nor |cos θ|, and f is the same for every direction",
        fails "light/light-below-the-horizon-adds-nothing", told light::LIGHT_FROM_BELOW_SUBTRACTED,
        lit_direction = |wi, wo| DVec3 { z: wi.z.abs().copysign(wo.z), ..wi },
        light_cosine = |local, _| local.z;
    "light-from-below-added": "|cos θ| > 0 in place of cos θ > 0, and f is the same for every direction",
        fails "light/light-below-the-horizon-adds-nothing", told light::LIGHT_FROM_BELOW_ADDED,
        lit_direction = |wi, wo| DVec3 { z: wi.z.abs().copysign(wo.z), ..wi };
    "light-times-pdf": "× pdf in place of / pdf",
        fails "light/rectangle-light-slanted-matches-closed-form", told light::TIMES_PDF,
        light_estimate = |light, pdf| light * pdf;
    "emitter-shadows-itself": "the shadow ray ends at the light, and meets it",
        fails "light/rectangle-light-slanted-matches-closed-form", told light::EMITTER_SHADOWS_ITSELF,
        shadow_ray = |vertex, sample| {
            let t_max = sample.distance + vertex.clearance;
            Ray { t_max, ..shadow_ray(vertex, sample) }
        };
    "emitter-shadows-itself-at-times":
        "the shadow ray starts EPS ahead and ends EPS before the light: rounding decides",
        fails "light/rectangle-light-overhead-matches-closed-form", told light::EMITTER_SHADOWS_ITSELF,
        shadow_ray = |vertex, sample| {
            let origin = vertex.point + vertex.clearance * sample.wi;
            let t_max = sample.distance - vertex.clearance;
            Ray { origin, t_max, ..shadow_ray(vertex, sample) }
        };
    "no-shadows": "Ray(o, d, EPS, distance): max_t is EPS, and nothing is ever in the way",
        fails "light/occluder-hides-just-what-is-behind-it", told light::NO_SHADOWS,
        shadow_ray = |vertex, sample| Ray {
            t_max: vertex.clearance,
            ..shadow_ray(vertex, sample)
        };
    "shadow-without-end": "the shadow ray to a point light has no max_t",
        fails "light/surfaces-behind-a-light-cast-no-shadow", told light::SHADOW_BEYOND_LIGHT,
        shadow_ray = |vertex, sample| match sample.is_delta {
            1 => Ray { t_max: f64::INFINITY, ..shadow_ray(vertex, sample) },
            _ => shadow_ray(vertex, sample),
        };
    "shadow-acne": "rays that leave a surface have no min_t",
        fails "light/point-light-at-the-camera-sees-no-shadows", told light::SHADOW_ACNE,
        clearance = |_| 0.0;
    "offset-of-fixed-length": "rays start 1e-3 ahead, however large the scene is",
        fails "integrator/radiance-is-the-same-at-every-size", told integrator::FIXED_LENGTH,
        clearance = |_| 1e-3;
    "divided-in-loop": "`L_out /= n` inside the loop over lights",
        fails "light/every-light-is-divided-by-its-own-samples", told light::DIVIDED_IN_LOOP,
        sum_over_lights = |each, samples| {
            each.fold(DVec3::ZERO, |total, radiance| total / f64::from(samples) + radiance)
        };
    "divided-by-lights": "the sum is divided by the number of lights",
        fails "light/radiance-is-linear-in-emission", told light::DIVIDED_BY_LIGHTS,
        sum_over_lights = |each, _| {
            let mut lights = 0.0_f64;
            let total: DVec3 = each.inspect(|_| lights += 1.0).sum();
            total / lights.max(1.0)
        };
    "delta-light-divided": "a point light is sampled once and divided by -l",
        fails "light/point-light-does-not-depend-on-sample-count", told light::DELTA_DIVIDED,
        light_mean = |total, _, asked_for| total / f64::from(asked_for);
    "mis-surface-in-full":
        "light that BSDF sampling meets is not weighted, light samples are",
        fails GLOSSY, told light::MIS_SURFACE_IN_FULL,
        mis_surface_weight = |_, _| 1.0;
    "mis-surface-in-full-everywhere":
        "light that BSDF sampling meets is not weighted, light samples are, at diffuse surfaces too",
        fails SLANTED, told light::MIS_SURFACE_IN_FULL,
        combines = |_| true,
        mis_surface_weight = |_, _| 1.0;
    "mis-light-in-full":
        "light samples are not weighted, light that BSDF sampling meets is",
        fails GLOSSY, told light::MIS_LIGHT_IN_FULL,
        mis_light_weight = |_, _| 1.0;
    "mis-light-in-full-everywhere":
        "light samples are not weighted, light that BSDF sampling meets is, at diffuse surfaces too",
        fails "light/constant-environment-lights-a-plane-by-its-albedo", told light::MIS_LIGHT_IN_FULL,
        combines = |_| true,
        mis_light_weight = |_, _| 1.0;
    "mis-heuristics-differ":
        "the balance heuristic for light samples, the power heuristic for the others",
        fails GLOSSY, told light::MIS_HEURISTICS_DIFFER,
        mis_light_weight = |own, other| own / (own + other);
    "mis-heuristics-differ-everywhere":
        "the balance heuristic for light samples, the power heuristic for the others, at diffuse surfaces too",
        fails SLANTED, told light::MIS_HEURISTICS_DIFFER,
        combines = |_| true,
        mis_light_weight = |own, other| own / (own + other);
    "last-light-only": "an inner variable hides the sum",
        fails "light/radiance-is-linear-in-emission", told light::LAST_LIGHT_ONLY,
        sum_over_lights = |each, _| each.last().unwrap_or(DVec3::ZERO);
    "bounce-range-kept": "max_t of the new ray is the length of the ray before",
        fails "light/rectangle-light-slanted-by-hemisphere-sampling-matches-closed-form",
        told light::T_MAX_NOT_RESET,
        ray_from = |vertex, direction| Ray {
            t_max: vertex.travelled,
            ..lesson::vertex::ray_from(vertex, direction)
        };
    "light-distance-forgotten": "1/(cos θ · area), without the squared distance",
        fails RECTANGLE, told light::LIGHT_DISTANCE_FORGOTTEN,
        area_per_steradian = |_, cosine| cosine.recip();
    "light-area-multiplied": "· area in place of / area",
        fails RECTANGLE, told light::LIGHT_AREA_MULTIPLIED,
        mesh_pdf = |area_per_steradian, area, _| area_per_steradian * area;
    "light-pdf-inverted": "the pdf is upside down",
        fails RECTANGLE, told light::LIGHT_PDF_INVERTED,
        mesh_pdf = |area_per_steradian, area, _| area / area_per_steradian;
    "point-light-by-distance": "intensity / distance",
        fails "light/point-light-follows-the-inverse-square-law", told light::FADES_WITH_DISTANCE,
        point_light_radiance = |intensity, distance| intensity.map(|i| i / distance);
    "light-cosine-missing": "f · radiance / pdf, without cos θ",
        fails "light/rectangle-light-slanted-matches-closed-form", told light::COSINE_FORGOTTEN,
        light_cosine = |_, _| 1.0;
    "light-cosine-twice": "f · cos² θ · radiance / pdf",
        fails "light/rectangle-light-slanted-matches-closed-form", told light::COSINE_TWICE,
        light_cosine = |local, _| local.z * local.z;
    "light-without-pdf": "the sample is not divided by its pdf",
        fails "light/rectangle-light-slanted-matches-closed-form", told light::PDF_FORGOTTEN,
        light_estimate = |light, _| light;
    "light-twice": "a sample is added twice",
        fails "light/rectangle-light-slanted-matches-closed-form", told light::TWICE_AS_BRIGHT,
        light_estimate = |light, pdf| 2.0 * light / pdf;
    "light-halved": "half of two estimators that are each complete",
        fails "light/rectangle-light-slanted-matches-closed-form", told light::HALF_AS_BRIGHT,
        light_estimate = |light, pdf| 0.5 * light / pdf;
    "light-over-pi": "emission is taken for radiosity",
        fails "light/rectangle-light-slanted-matches-closed-form", told light::EMISSION_OVER_PI,
        light_estimate = |light, pdf| light / (PI * pdf);
    "light-divided-twice": "the sum of a light is divided by the number of its samples twice",
        fails "light/rectangle-light-tilted-matches-closed-form",
        told light::DIVIDED_TWICE_BY_SAMPLES,
        light_mean = |total, drawn, _| total / f64::from(drawn * drawn);
}
