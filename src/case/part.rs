//! The subjects of a path tracer, which are the folders of `cases/`, and the parts of the course they belong to.

/// What a case is about: its folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Subject {
    /// From film points to rays, from samples to pixels.
    Camera,
    /// Rays against triangles and spheres.
    Shape,
    /// Boxes, building and traversing the BVH.
    Bvh,
    /// Directions of the hemisphere.
    Sampling,
    /// How surfaces scatter.
    Bsdf,
    /// Light sources and direct light.
    Light,
    /// Paths of many bounces.
    Integrator,
    /// Stopping where a pixel has converged.
    Adaptive,
    /// Whole images.
    Image,
}

impl Subject {
    /// Every subject, in the order in which one rests on another.
    pub(crate) fn all() -> impl Iterator<Item = Self> {
        PARTS.iter().flat_map(|part| part.subjects).copied()
    }

    pub(crate) const fn folder(self) -> &'static str {
        match self {
            Self::Camera => "camera",
            Self::Shape => "shape",
            Self::Bvh => "bvh",
            Self::Sampling => "sampling",
            Self::Bsdf => "bsdf",
            Self::Light => "light",
            Self::Integrator => "integrator",
            Self::Adaptive => "adaptive",
            Self::Image => "image",
        }
    }

    /// What the case called `case` is about.
    pub(crate) fn of_case(case: &str) -> Option<Self> {
        let folder = case.split('/').next()?;
        Self::all().find(|subject| subject.folder() == folder)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Part {
    /// 1 to 5 as in the course; 6 is images as a whole.
    pub number: u32,
    /// As reports call it.
    pub title: &'static str,
    pub subjects: &'static [Subject],
}

/// Every part, in the order in which one rests on another.
pub(crate) static PARTS: &[Part] = &[
    Part {
        number: 1,
        title: "rays and intersections",
        subjects: &[Subject::Camera, Subject::Shape],
    },
    Part { number: 2, title: "BVH", subjects: &[Subject::Bvh] },
    Part {
        number: 3,
        title: "direct light",
        subjects: &[Subject::Sampling, Subject::Bsdf, Subject::Light],
    },
    Part { number: 4, title: "global illumination", subjects: &[Subject::Integrator] },
    Part { number: 5, title: "adaptive sampling", subjects: &[Subject::Adaptive] },
    Part { number: 6, title: "images against Mitsuba", subjects: &[Subject::Image] },
];

impl Part {
    /// The number of the part that builds and traverses the BVH.
    pub(crate) const BVH: u32 = 2;

    /// The part that a case belongs to, by its folder.
    pub(crate) fn of_case(case: &str) -> Option<&'static Part> {
        let subject = Subject::of_case(case)?;
        PARTS.iter().find(|part| part.subjects.contains(&subject))
    }

    /// Where a case stands in the order of subjects.
    pub(crate) fn position(case: &str) -> usize {
        let subject = Subject::of_case(case);
        Subject::all().position(|known| Some(known) == subject).unwrap_or(usize::MAX)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_case_is_of_the_part_of_its_folder() {
        let number = |case| Part::of_case(case).map(|part| part.number);
        assert_eq!(number("camera/rays-go-through-the-film"), Some(1));
        assert_eq!(number("elsewhere/claim"), None);
        assert!(Subject::all().all(|subject| number(subject.folder()).is_some()));
    }

    #[test]
    fn shapes_come_before_images() {
        assert!(Part::position("shape/a") < Part::position("image/a"));
    }
}
