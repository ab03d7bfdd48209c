//! The parts of a path tracer, as the course numbers them, and the folders of cases that belong to each.

/// A part of a path tracer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    /// 1 to 5 as in the course; 6 is pictures as a whole.
    pub number: u32,
    /// As reports call it.
    pub title: &'static str,
    /// The folders of `cases/` that belong to it.
    pub folders: &'static [&'static str],
}

/// Every part, in the order in which one rests on another.
pub static PARTS: &[Part] = &[
    Part { number: 1, title: "rays and intersections", folders: &["camera", "shape"] },
    Part { number: 2, title: "BVH", folders: &["bvh"] },
    Part { number: 3, title: "direct light", folders: &["sampling", "bsdf", "light"] },
    Part { number: 4, title: "global illumination", folders: &["integrator"] },
    Part { number: 5, title: "adaptive sampling", folders: &["adaptive"] },
    Part { number: 6, title: "images against Mitsuba", folders: &["image"] },
];

impl Part {
    /// The number of the part that builds and traverses the BVH.
    pub const HIERARCHY: u32 = 2;

    /// The part that a case belongs to, by its folder.
    pub fn of_case(case: &str) -> Option<&'static Part> {
        let folder = case.split('/').next().unwrap_or(case);
        PARTS.iter().find(|part| part.folders.contains(&folder))
    }

    /// Where a case stands in the order of parts and folders.
    pub fn position(case: &str) -> usize {
        let folder = case.split('/').next().unwrap_or(case);
        PARTS
            .iter()
            .flat_map(|part| part.folders)
            .position(|known| *known == folder)
            .unwrap_or(usize::MAX)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_case_is_of_the_part_of_its_folder() {
        assert_eq!(
            Part::of_case("camera/rays-go-through-the-film").map(|part| part.number),
            Some(1)
        );
        assert_eq!(Part::of_case("elsewhere/claim"), None);
    }

    #[test]
    fn intersections_come_before_pictures() {
        assert!(Part::position("shape/a") < Part::position("image/a"));
    }
}
