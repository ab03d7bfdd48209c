//! Mistakes that students make, each beside the step of the lesson that it replaces.
//!
//! A fault says which case has to catch it and which cause the diagnosis has to name. Faults that
//! no question to the core can tell apart share a cause. Bounded here are those that would not come
//! back: a recursion without end is answered as one that is far too deep.
//!
//! To plant one, add an entry to the table of its subject. What goes wrong is a step, or a few: if
//! there is none yet, make the line a function of the lesson and add its row to `steps`.

mod adaptive;
mod bsdf;
mod bvh;
mod camera;
pub(crate) mod integrator;
mod light;
mod sampling;
mod shape;

use super::steps::{LESSON, Steps};
use crate::cause::Cause;
use crate::contract::Components;

/// One mistake of one or two lines.
#[derive(Debug)]
pub struct Fault {
    /// Kebab-case, unique: `textbook:NAME` is the core that makes it.
    pub name: &'static str,
    /// Of the course, 1 to 5.
    pub part: u32,
    /// What the student wrote, in one line.
    pub summary: &'static str,
    /// The case that has to fail.
    pub caught_by: &'static str,
    /// What the diagnosis has to name first.
    pub cause: &'static Cause,
    /// What it puts in place of steps of the lesson.
    pub(super) steps: Steps,
}

impl Fault {
    /// What of a path tracer it is made in.
    pub(crate) fn components(&self) -> Components {
        self.steps.components()
    }

    /// Whether it changes which bounces count, so that what comes of isolated bounces depends on how a core comes by them.
    pub(crate) const fn is_of_ranges(&self) -> bool {
        let Steps { first_bounce, last_bounce, counts, .. } = &self.steps;
        let Steps { shows_emission, path_meets_light, .. } = &self.steps;
        let of_sums = first_bounce.is_some() || last_bounce.is_some() || counts.is_some();
        of_sums || shows_emission.is_some() || path_meets_light.is_some()
    }
}

/// A table of faults: `"name": "what the student wrote", fails CASE, told CAUSE, STEP = what stands in its place;`.
macro_rules! faults {
    (part $part:literal; $(
        $name:literal: $summary:literal, fails $caught_by:expr, told $cause:expr,
        $($step:ident = $wrong:expr),+;
    )*) => {
        /// In the order of the lecture.
        pub(crate) const FAULTS: &[super::Fault] = &[$(super::Fault {
            name: $name,
            part: $part,
            summary: $summary,
            caught_by: $caught_by,
            cause: &$cause,
            steps: super::Steps { $($step: Some($wrong),)+ ..super::LESSON },
        }),*];
    };
}
use faults;

/// Every fault, part by part.
pub(crate) fn all() -> impl Iterator<Item = &'static Fault> {
    let subjects = [
        camera::FAULTS,
        shape::FAULTS,
        bvh::FAULTS,
        sampling::FAULTS,
        bsdf::FAULTS,
        light::FAULTS,
        integrator::FAULTS,
        adaptive::FAULTS,
    ];
    subjects.into_iter().flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_part_of_the_course_has_a_dozen() {
        for part in 1..=5 {
            let count = all().filter(|fault| fault.part == part).count();
            assert!(count >= 12, "part {part} has {count}");
        }
    }

    #[test]
    fn every_cause_stands_in_the_glossary() {
        for fault in all() {
            assert_eq!(crate::cause::find(fault.cause.name), Some(fault.cause), "{}", fault.name);
        }
    }
}
