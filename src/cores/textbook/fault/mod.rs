//! Mistakes that students make, each planted at the line of this core where they make it.
//!
//! A fault says which case has to catch it and which cause the diagnosis has to name. Faults that no
//! question to the core can tell apart share a cause. Bounded here are those that would not come
//! back: a recursion without end is answered as one that is far too deep.
//!
//! To plant one: a variant of `Change`, the wrong line beside the right one, and an entry in the
//! table of its part.

mod adaptive;
mod camera;
mod hierarchy;
mod light;
mod path;
mod shape;
mod surface;

use super::change::Change;
use crate::cause::Cause;

/// One mistake of one or two lines.
#[derive(Debug)]
pub struct Fault {
    pub(super) change: Change,
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
}

/// Every fault, part by part.
pub fn all() -> impl Iterator<Item = &'static Fault> {
    let parts = [
        camera::FAULTS,
        shape::FAULTS,
        hierarchy::FAULTS,
        surface::FAULTS,
        light::FAULTS,
        path::FAULTS,
        adaptive::FAULTS,
    ];
    parts.into_iter().flatten()
}

#[cfg(test)]
mod tests {
    use super::super::different;
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_change_has_one_name_and_every_name_one_change() {
        let mut names = BTreeSet::new();
        let mut changes = BTreeSet::new();
        let faults = all().map(|fault| (fault.name, fault.change));
        let different = different::DIFFERENT.iter().map(|core| (core.name, core.change));
        for (name, change) in faults.chain(different) {
            assert!(names.insert(name), "{name} stands there twice");
            assert!(changes.insert(format!("{change:?}")), "{change:?} stands there twice");
            let proper = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
            assert!(name.chars().all(proper), "{name}");
        }
    }

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
