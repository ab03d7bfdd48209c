//! The components of a path tracer that a core may take from the bench, to be judged as if its own were right.
//!
//! What is transplanted is taken out of the question: a case that fails with a core's own box test and passes with
//! the bench's is the box test's failure, by experiment. `docs/decisions/0012-transplants.md` says how.

use super::names::by_names;
use bitflags::bitflags;

bitflags! {
    /// Components of a path tracer, each after those that it is made of.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
    pub struct Components: u32 {
        /// Where random numbers come from.
        const RANDOM_NUMBERS = 1 << 0;
        /// From a film point to a ray.
        const CAMERA = 1 << 1;
        /// A ray against one triangle, and the normals of the hit.
        const TRIANGLE_TEST = 1 << 2;
        /// A ray against one sphere, and the normal of the hit.
        const SPHERE_TEST = 1 << 3;
        /// A ray against one box.
        const BOX_TEST = 1 << 4;
        /// The nearest hit and any hit of a built scene.
        const TRAVERSAL = 1 << 5;
        /// Directions of the hemisphere, and their pdf.
        const DIRECTION_SAMPLING = 1 << 6;
        /// f, pdf and samples of every surface.
        const BSDF = 1 << 7;
        /// Directions towards lights, their radiance and pdf.
        const LIGHT_SAMPLING = 1 << 8;
        /// Emission that a ray meets.
        const EMISSION = 1 << 9;
        /// Light scattered once.
        const DIRECT_LIGHTING = 1 << 10;
        /// From bounce to bounce.
        const PATH = 1 << 11;
        /// From samples to a pixel, and when there are enough of them.
        const PIXEL = 1 << 12;
    }
}
by_names! { Components, "component" }

impl Components {
    /// As people read them: `box test and BSDF`.
    pub(crate) fn in_words(self) -> String {
        let words: Vec<_> = self.iter().map(Self::word).collect();
        match words.split_last() {
            Some((last, [])) => (*last).to_owned(),
            Some((last, others)) => format!("{} and {last}", others.join(", ")),
            None => String::new(),
        }
    }

    /// What a core that takes `takes` has to take so that these are the bench's: themselves, or else the larger
    /// components that are made of them and bring them along. None where neither is taken.
    pub(crate) fn within(self, takes: Self) -> Option<Self> {
        let stand_in = |one: Self| [one, one.larger()].into_iter().find(|it| takes.contains(*it));
        self.iter().map(stand_in).collect()
    }

    /// The components that are made of one and bring the bench's along. Itself where there are none.
    fn larger(self) -> Self {
        match self {
            Self::TRIANGLE_TEST | Self::SPHERE_TEST | Self::BOX_TEST => Self::TRAVERSAL,
            Self::DIRECTION_SAMPLING => Self::BSDF.union(Self::DIRECT_LIGHTING),
            Self::LIGHT_SAMPLING => Self::DIRECT_LIGHTING,
            other => other,
        }
    }

    /// Whether one is among those that this one is made of.
    pub(crate) fn is_made_of(self, one: Self) -> bool {
        let of_geometry = Self::TRIANGLE_TEST | Self::SPHERE_TEST | Self::BOX_TEST;
        let parts = match self {
            Self::TRAVERSAL => of_geometry,
            Self::BSDF => Self::DIRECTION_SAMPLING,
            Self::DIRECT_LIGHTING => Self::below(self) - Self::CAMERA,
            Self::PATH | Self::PIXEL => Self::below(self),
            _ => Self::empty(),
        };
        parts.intersects(one)
    }

    /// Those that a request of the protocol asks for, any of them where bounces say which. None for a picture: with the
    /// bench's as a whole nothing would be the core's own.
    pub(crate) fn of_request(name: &str) -> Self {
        match name {
            "generate-rays" => Self::CAMERA,
            "intersect-triangle" => Self::TRIANGLE_TEST,
            "intersect-sphere" => Self::SPHERE_TEST,
            "intersect-box" => Self::BOX_TEST,
            "intersect" | "occluded" => Self::TRAVERSAL,
            "sample-direction" | "direction-pdf" => Self::DIRECTION_SAMPLING,
            "eval-bsdf" | "sample-bsdf" => Self::BSDF,
            "sample-light" => Self::LIGHT_SAMPLING,
            "radiance" => Self::EMISSION | Self::DIRECT_LIGHTING | Self::PATH,
            "adaptive-mean" => Self::PIXEL,
            _ => Self::empty(),
        }
    }

    /// All that come before one.
    fn below(self) -> Self {
        Self::from_bits_truncate(self.bits() - 1)
    }

    /// The words for one.
    fn word(self) -> &'static str {
        match self {
            Self::RANDOM_NUMBERS => "random numbers",
            Self::CAMERA => "camera",
            Self::TRIANGLE_TEST => "triangle test",
            Self::SPHERE_TEST => "sphere test",
            Self::BOX_TEST => "box test",
            // With the traversal comes the tree that it walks.
            Self::TRAVERSAL => "BVH",
            Self::DIRECTION_SAMPLING => "direction sampling",
            Self::BSDF => "BSDF",
            Self::LIGHT_SAMPLING => "light sampling",
            Self::EMISSION => "emission",
            Self::DIRECT_LIGHTING => "direct lighting",
            Self::PATH => "path",
            _ => "pixel",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_core_without_light_sampling_takes_direct_lighting_for_it() {
        let needed = Components::LIGHT_SAMPLING | Components::BSDF;
        let takes = Components::BSDF | Components::DIRECT_LIGHTING;
        assert_eq!(needed.within(takes), Some(takes));
        assert_eq!(needed.within(Components::all()), Some(needed));
        assert_eq!(needed.within(Components::BSDF), None);
        assert_eq!(Components::BOX_TEST.within(Components::TRAVERSAL), Some(Components::TRAVERSAL));
        assert_eq!(Components::RANDOM_NUMBERS.within(takes), None);
    }

    #[test]
    fn every_question_but_that_for_a_picture_asks_for_a_component() {
        let requests = crate::contract::question::QUESTIONS.iter().flat_map(|it| it.requests());
        let [lent, whole]: [Vec<_>; 2] =
            requests.partition::<Vec<_>, _>(|it| !Components::of_request(it).is_empty()).into();
        assert_eq!(whole, ["render", "render-codes"]);
        let asked_for: Components = lent.iter().map(|it| Components::of_request(it)).collect();
        assert_eq!(asked_for, Components::all() - Components::RANDOM_NUMBERS);
    }

    #[test]
    fn components_are_named_for_files_and_for_people() {
        let two = Components::BOX_TEST | Components::BSDF;
        assert_eq!(two.names(), ["box-test", "bsdf"]);
        assert_eq!(Components::from_names(&two.names()), Ok(two));
        assert_eq!(two.in_words(), "box test and BSDF");
        let unknown = Components::from_names(&["box".to_owned()]);
        assert_eq!(unknown, Err("there is no component `box`".to_owned()));
        let words: std::collections::BTreeSet<_> =
            Components::all().iter().map(Components::word).collect();
        assert_eq!(words.len(), Components::all().iter().count());
    }
}
