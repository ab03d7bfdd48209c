//! What a case rests on: if spheres are not hit where they are, a dark picture of spheres says nothing about light.
//!
//! Some cases *prove* a foundation (`proves = ["spheres"]`). Others rest on foundations: those their file names
//! (`rests-on`), and those that follow from what they ask and from their scene. A case whose foundation has been
//! found broken may pass on it all the same; if not it is blocked, and not failed: that would blame the wrong line.

use super::{Case, Subject};
use crate::contract::{Capabilities, Components};
use crate::scene::{Light, SceneDescription, Shape, Surface};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// Every foundation, and how people read it.
macro_rules! foundations {
    ($($(#[$meta:meta])* $name:ident = $word:literal,)*) => {
        /// Something that other things rest on. The order is that of the course: a foundation rests on earlier ones only.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        #[serde(rename_all = "kebab-case")]
        pub enum Foundation { $($(#[$meta])* $name,)* }

        impl Foundation {
            pub(crate) const fn word(self) -> &'static str {
                match self { $(Self::$name => $word,)* }
            }
        }
    };
}

foundations! {
    /// Different seeds give different, independent numbers: whatever is judged by its mean rests on it.
    Seeds = "random numbers",
    /// Rays leave the camera through their film points.
    Camera = "camera rays",
    /// A ray meets a triangle where it should.
    Triangles = "triangles",
    /// Normals are interpolated between the vertices of a smooth mesh.
    ShadingNormals = "shading normals",
    /// A ray meets a sphere where it should.
    Spheres = "spheres",
    /// No box is missed: what is in it would be lost.
    Boxes = "boxes",
    /// No box is hit for nothing: that loses time alone.
    TightBoxes = "boxes that a ray misses",
    /// The BVH finds the hits that brute force finds.
    Hits = "hits in the BVH",
    /// Uniform directions of the hemisphere, and their pdf.
    UniformDirections = "uniform directions",
    /// Cosine-weighted directions, and their pdf.
    CosineDirections = "cosine-weighted directions",
    Diffuse = "diffuse surfaces",
    Mirror = "the mirror",
    Glass = "glass",
    Metal = "rough metal",
    RoughGlass = "rough glass",
    /// Directly visible.
    Emission = "emission",
    /// A mesh lights a surface in general position.
    DirectLight = "direct light",
    MeshLight = "mesh lights",
    SphereLight = "sphere lights",
    PointLight = "point lights",
    DirectionalLight = "directional lights",
    Sky = "skies",
    Bounces = "paths of many bounces",
}

impl Foundation {
    /// What stands for it: where it was found broken, and a core takes these from the bench, what rests on it can
    /// be judged all the same.
    pub(crate) const fn components(self) -> Components {
        match self {
            Self::Seeds => Components::RANDOM_NUMBERS,
            Self::Camera => Components::CAMERA,
            Self::Triangles | Self::ShadingNormals => Components::TRIANGLE_TEST,
            Self::Spheres => Components::SPHERE_TEST,
            Self::Boxes | Self::TightBoxes => Components::BOX_TEST,
            Self::Hits => Components::TRAVERSAL,
            Self::UniformDirections | Self::CosineDirections => Components::DIRECTION_SAMPLING,
            Self::Diffuse | Self::Mirror | Self::Glass | Self::Metal | Self::RoughGlass => {
                Components::BSDF
            }
            Self::Emission => Components::EMISSION,
            Self::DirectLight
            | Self::MeshLight
            | Self::SphereLight
            | Self::PointLight
            | Self::DirectionalLight
            | Self::Sky => Components::LIGHT_SAMPLING.union(Components::DIRECT_LIGHTING),
            Self::Bounces => Components::PATH,
        }
    }
}

/// What `case` itself asks about: with these of the bench's, it would judge the bench.
pub(crate) fn asked_about(case: &Case) -> Components {
    match Subject::of_case(&case.id) {
        // What becomes of the samples of a pixel can be told through any camera.
        Some(Subject::Camera) if case.prepared.needs().contains(Capabilities::RENDER) => {
            Components::PIXEL
        }
        Some(Subject::Camera) => Components::CAMERA,
        subject => subject.map_or(Components::empty(), asked_by),
    }
}

/// What cases about `subject` ask about.
pub(crate) fn asked_by(subject: Subject) -> Components {
    match subject {
        Subject::Camera => Components::CAMERA | Components::PIXEL,
        Subject::Shape => Components::TRIANGLE_TEST | Components::SPHERE_TEST,
        Subject::Bvh => Components::TRAVERSAL,
        Subject::Sampling => Components::DIRECTION_SAMPLING,
        Subject::Bsdf => Components::BSDF,
        Subject::Light => Components::LIGHT_SAMPLING | Components::DIRECT_LIGHTING,
        Subject::Integrator => Components::PATH,
        Subject::Adaptive => Components::PIXEL,
        Subject::Image => Components::empty(),
    }
}

/// What `case` rests on, in `scene` if it names one. Never what it proves itself, nor what comes later.
pub(crate) fn foundations(case: &Case, scene: Option<&SceneDescription>) -> BTreeSet<Foundation> {
    let mut found: BTreeSet<_> = case.rests_on.iter().copied().collect();
    let needs = case.prepared.needs();
    if needs.intersects(Capabilities::RADIANCE | Capabilities::RENDER) {
        found.extend(scene.into_iter().flat_map(seen_in));
        found.extend(beneath(case, scene));
        found.insert(Foundation::Seeds);
    }
    if needs.intersects(Capabilities::RENDER) {
        found.insert(Foundation::Camera);
    }
    if needs.intersects(Capabilities::HEMISPHERE_SAMPLING) {
        found.insert(Foundation::UniformDirections);
    }
    let own = case.proves.iter().min();
    found.retain(|foundation| own.is_none_or(|own| foundation < own));
    found
}

/// Shapes and surfaces of a scene.
fn seen_in(scene: &SceneDescription) -> BTreeSet<Foundation> {
    let mut found = BTreeSet::new();
    for number in 0..scene.shape_count() as u32 {
        match scene.shape(number) {
            Shape::Mesh(mesh) => {
                found.insert(Foundation::Triangles);
                if !mesh.normals.is_empty() {
                    found.insert(Foundation::ShadingNormals);
                }
            }
            Shape::Sphere(_) => {
                found.insert(Foundation::Spheres);
            }
        }
        found.insert(match scene.material_of(number).surface {
            Surface::Diffuse { .. } => Foundation::Diffuse,
            Surface::Mirror { .. } => Foundation::Mirror,
            Surface::Glass { .. } => Foundation::Glass,
            Surface::Conductor { .. } => Foundation::Metal,
            Surface::RoughGlass { .. } => Foundation::RoughGlass,
        });
    }
    if scene.shape_count() > 0 {
        found.insert(Foundation::Hits);
    }
    found
}

/// What later parts of a path tracer take for granted.
fn beneath(case: &Case, scene: Option<&SceneDescription>) -> BTreeSet<Foundation> {
    let mut found = BTreeSet::new();
    if case.proves.contains(&Foundation::Bounces) {
        // These are judged whatever else is wrong with light: they tell which bounce it is.
        return found;
    }
    let subject = Subject::of_case(&case.id);
    if matches!(subject, Some(Subject::Integrator | Subject::Image)) {
        found.extend([Foundation::Emission, Foundation::DirectLight]);
        found.extend(scene.into_iter().flat_map(lights_of));
    }
    if subject == Some(Subject::Image) {
        found.insert(Foundation::Bounces);
    }
    found
}

fn lights_of(scene: &SceneDescription) -> BTreeSet<Foundation> {
    let kind = |light: &Light| match light {
        Light::Point { .. } => Foundation::PointLight,
        Light::Directional { .. } => Foundation::DirectionalLight,
        Light::ConstantSky { .. } | Light::GradientSky { .. } => Foundation::Sky,
        Light::Area { shape } => match scene.shape(*shape) {
            Shape::Mesh(_) => Foundation::MeshLight,
            Shape::Sphere(_) => Foundation::SphereLight,
        },
    };
    scene.lights.iter().map(kind).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::project::Project;
    use crate::scene::Library;
    use std::path::Path;

    fn of(id: &str) -> BTreeSet<Foundation> {
        let project = Project::at(Path::new(env!("CARGO_MANIFEST_DIR")));
        let case = super::super::load_one(&project.cases(), id).unwrap();
        let library = Library::new(project.scenes());
        let scene = case.scene.as_ref().map(|choice| choice.load(&library).unwrap());
        foundations(&case, scene.as_deref())
    }

    #[test]
    fn a_furnace_rests_on_what_it_is_made_of_and_on_direct_light() {
        use Foundation::UniformDirections;
        use Foundation::{Diffuse, DirectLight, Emission, Hits, Seeds, SphereLight, Spheres};
        let expected =
            [Seeds, Spheres, Hits, Diffuse, UniformDirections, Emission, DirectLight, SphereLight];
        let found = of("integrator/rough-conductor-in-constant-environment-shows-its-albedo");
        assert!(found.contains(&Foundation::Metal) && !found.contains(&Foundation::Camera));
        assert!(!of("integrator/isolated-bounces-sum-to-the-image").contains(&Foundation::Bounces));
        let hemisphere = of("integrator/furnace-by-hemisphere-sampling-matches-geometric-series");
        assert_eq!(hemisphere, expected.into());
        assert_eq!(
            of("integrator/furnace-matches-geometric-series"),
            expected[..4].iter().copied().collect()
        );
    }

    #[test]
    fn questions_about_one_function_rest_on_nothing_they_do_not_name() {
        assert!(of("shape/ray-triangle-hits-are-right").is_empty());
        assert!(of("sampling/uniform-samples-match-their-pdf").is_empty());
    }

    #[test]
    fn what_proves_a_foundation_rests_on_earlier_ones_only() {
        let found = of("light/rectangle-light-slanted-matches-closed-form");
        assert!(found.contains(&Foundation::Diffuse) && found.contains(&Foundation::Triangles));
        assert!(found.iter().all(|foundation| *foundation < Foundation::DirectLight));
    }

    #[test]
    fn only_smooth_meshes_rest_on_shading_normals() {
        assert!(of("image/teapot-matches-mitsuba").contains(&Foundation::ShadingNormals));
        let flat = of("image/cornell-diffuse-spheres-matches-mitsuba");
        assert!(flat.contains(&Foundation::Triangles));
        assert!(!flat.contains(&Foundation::ShadingNormals));
    }

    #[test]
    fn pictures_rest_on_everything_else() {
        let found = of("image/cornell-mirror-glass-matches-mitsuba");
        for foundation in [Foundation::Camera, Foundation::Glass, Foundation::Bounces] {
            assert!(found.contains(&foundation), "{foundation:?}");
        }
    }
}
