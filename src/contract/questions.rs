//! Every question that a core can be asked, in one table.
//!
//! From it follow the methods of [`super::Core`] and [`super::BuiltScene`] with their defaults, the bits of
//! [`super::Capabilities`], the table of functions that C fills ([`super::abi`]), what stands between checks and a
//! core ([`super::validate`]), and both ends of a worker's channel. A question that C, Python and the protocol do not
//! know in the same words fails `tests/contract.rs`.
//!
//! An entry reads:
//!
//! ```text
//! Core (generate_rays: plain) {            who is asked; its functions of furnace_core.h
//!     /// What it asks.
//!     GENERATE_RAYS = 0                    its capability, and the bit of that where it is named first
//!     fn generate_rays(camera: &Camera, film: &[DVec2]; rays: &mut [Ray]) -> ();
//! }                                        what is given; what is filled; what is told besides
//! ```
//!
//! `plain` is a function of C with just these arguments; of others the type is named, and `cores::dylib` calls them.
//! How a type of argument crosses is said in [`super::crossing`], what an answer has to be in [`super::answer`].

/// Hands the whole table to a macro, after what else it needs. Entries are in the order of `furnace_core.h`: what is
/// new comes last.
macro_rules! questions {
    ($then:path, $with:tt) => {
        $then! { $with
            Core (generate_rays: plain) {
                /// World-space rays through `film` points: unit directions, origin at the camera,
                /// `t_min` and `t_max` at its clip distances.
                GENERATE_RAYS = 0
                fn generate_rays(camera: &Camera, film: &[DVec2]; rays: &mut [Ray]) -> ();
            }
            Core (intersect_triangle: IntersectTriangle, intersect_sphere: IntersectSphere) {
                /// Nearest hit of each ray with one primitive, no acceleration structure involved.
                /// `shape` and `primitive` of a hit are 0.
                INTERSECT_PRIMITIVE = 1
                fn intersect_primitive(primitive: &Primitive, rays: &[Ray]; hits: &mut [Hit]) -> ();
            }
            Core (intersect_box: IntersectBox) {
                /// Whether each ray segment meets the closed box.
                INTERSECT_BOX = 13
                fn intersect_box(bounds: &Aabb, rays: &[Ray]; box_hits: &mut [BoxHit]) -> ();
            }
            Core (sample_direction: plain) {
                /// One direction of the hemisphere around +z for each element of `random`, with its pdf.
                SAMPLE_DIRECTION = 14
                fn sample_direction(
                    sampler: Sampler, random: Randomness<'_>; samples: &mut [DirectionSample]
                ) -> ();
            }
            Core (direction_pdf: plain) {
                /// The pdf (per steradian) with which `sampler` draws each direction; 0 where it never goes.
                SAMPLE_DIRECTION
                fn direction_pdf(sampler: Sampler, directions: &[DVec3]; pdf: &mut [f64]) -> ();
            }
            Core (eval_bsdf: plain) {
                /// `f` and `pdf` for given pairs of directions. Delta lobes answer zero.
                EVAL_BSDF = 7
                fn eval_bsdf(
                    material: &Material, queries: &[BsdfQuery]; values: &mut [BsdfValue]
                ) -> ();
            }
            Core (sample_bsdf: plain) {
                /// One incident direction for each outgoing direction.
                SAMPLE_BSDF = 8
                fn sample_bsdf(
                    material: &Material, wo: &[DVec3], random: Randomness<'_>;
                    samples: &mut [BsdfSample]
                ) -> ();
            }
            Core (adaptive_mean: plain) {
                /// Runs the adaptive stopping rule over given streams of sample luminances, and answers the mean it
                /// would have written and how many samples it took. A stream is as long as the sample cap.
                ADAPTIVE_MEAN = 15
                fn adaptive_mean(
                    settings: AdaptiveSettings, streams: &[&[f64]]; means: &mut [AdaptiveMean]
                ) -> ();
            }
            Build (build: BuildScene, release: Release) {
                BUILD_SCENE = 2
            }
            Scene (intersect: plain) {
                /// Nearest hits in the scene.
                INTERSECT = 3
                fn intersect(rays: &[Ray]; hits: &mut [Hit]) -> TraversalStats;
            }
            Scene (occluded: plain) {
                /// Whether anything lies on each segment: the any-hit query of shadow rays.
                OCCLUDED = 4
                fn occluded(rays: &[Ray]; occluded: &mut [bool]) -> TraversalStats;
            }
            Scene (sample_light: plain) {
                /// One direction from each point towards light `light` of [`SceneDescription::lights`].
                /// Visibility is not tested.
                SAMPLE_LIGHT = 9
                fn sample_light(
                    light: u32, from: &[DVec3], random: Randomness<'_>; samples: &mut [LightSample]
                ) -> ();
            }
            Scene (radiance: plain) {
                /// One radiance estimate per ray: the integrator without camera or film. Ray `i` of a call draws its
                /// own random numbers, so that equal rays give independent estimates.
                RADIANCE = 10
                fn radiance(
                    rays: &[Ray], settings: &IntegratorSettings; radiance: &mut [[f64; 3]]
                ) -> ();
            }
            Scene (render: RenderPicture) {
                /// A picture: `film` arrives with the size asked for and every pixel set to NaN.
                RENDER = 11
                fn render(camera: &Camera, settings: &RenderSettings; film: &mut Film) -> ();
            }
            Scene () {
                /// A picture of 8 bits, from a core that writes nothing else, and how its codes are made.
                RENDER_CODES = 20
                fn render_codes(
                    camera: &Camera, settings: &RenderSettings; codes: &mut Picture
                ) -> Encoding;
            }
            Components (take_components: TakeComponents) {
                COMPONENTS
            }
        }
    };
}
pub(crate) use questions;

/// Hands the questions of one kind to a macro, one after another: `Core` and `Scene` are those of the two traits,
/// `PlainCore` and `PlainScene` those of them that C is asked with the same arguments.
macro_rules! each_question {
    ($wanted:ident $then:ident $with:tt) => {
        $crate::contract::questions::questions! {
            $crate::contract::questions::pick_questions, ($wanted $then $with)
        }
    };
}
pub(crate) use each_question;

macro_rules! pick_questions {
    (($wanted:ident $then:ident $with:tt) $($kind:ident $c:tt $entry:tt)*) => {
        $($crate::contract::questions::pick_question! {
            $wanted $kind $then $with $c $entry
        })*
    };
}
pub(crate) use pick_questions;

macro_rules! pick_question {
    (Core Core $then:ident $with:tt $c:tt $entry:tt) => {
        $then! { $with $entry }
    };
    (Scene Scene $then:ident $with:tt $c:tt $entry:tt) => {
        $then! { $with $entry }
    };
    (PlainCore Core $then:ident $with:tt ($c:ident: plain) $entry:tt) => {
        $then! { $with $entry }
    };
    (PlainScene Scene $then:ident $with:tt ($c:ident: plain) $entry:tt) => {
        $then! { $with $entry }
    };
    ($($other:tt)*) => {};
}
pub(crate) use pick_question;
