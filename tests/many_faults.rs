//! Many mistakes at once, as real renderers have them: random sets of 2 to 8 faults in one core. How many of them are
//! named, and is what is told there?
//!
//! ```sh
//! FURNACE_SETS=200 cargo test --test many_faults -- --ignored --nocapture
//! FURNACE_SHARD=1/4 ...                      # the first of four parts, for other machines
//! FURNACE_BRIEF=1 ...                        # only the cases that faults have to fail, and those that rules look at
//! ```
//!
//! What images alone tell of one fault, as of a program that only writes images:
//!
//! ```sh
//! FURNACE_SHARD=1/8 cargo test --test many_faults -- --ignored --nocapture on_images
//! ```
//!
//! A set is drawn fault by fault. One that excludes another of the set, or that cannot be seen beside it though everything
//! else is the bench's, is left out, and the next is drawn.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

#[path = "support/audit.rs"]
mod audit;

use audit::{number, shard};
use furnace::case;
use furnace::faults::{Fault, Matrix, Together, Told, select};
use furnace::math::rng::{Seed, uniform};
use furnace::project::Project;
use furnace::stats::Budget;
use std::collections::BTreeMap;

/// Sets for a look in passing.
const IN_PASSING: u32 = 8;
/// Sets of two faults, which a test run can afford.
const IN_A_TEST_RUN: [u32; 2] = [102, 192];

fn matrix() -> Matrix {
    let project = Project::at(env!("CARGO_MANIFEST_DIR"));
    let cases = case::load_all(&project.cases()).unwrap();
    Matrix::new(project, &cases, Budget::Quick, 0)
}

/// A set of faults that can be seen beside each other.
fn draw(matrix: &Matrix, number: u32) -> Vec<&'static Fault> {
    let mut stream = Seed::SUITE.child("many faults").child(number).stream();
    let mut below = |end: usize| (uniform(&mut stream) * end as f64) as usize;
    let size = 2 + below(7);
    let (mut faults, _) = select(&[]).unwrap();
    let mut set = Vec::new();
    while set.len() < size {
        set.push(faults.swap_remove(below(faults.len())));
        if !matrix.are_in_sight(&set) {
            set.pop();
        }
    }
    set
}

/// What came of all sets.
#[derive(Default)]
struct Audit {
    faults: BTreeMap<String, u32>,
    told: BTreeMap<(String, bool), u32>,
    askable: usize,
    judged: usize,
}

impl Audit {
    fn take(&mut self, set: &Together) {
        for (_, degree) in &set.faults {
            *self.faults.entry(degree.clone()).or_default() += 1;
        }
        for told in &set.told {
            *self.told.entry((told.degree.clone(), told.is_there)).or_default() += 1;
        }
        self.askable += set.askable;
        self.judged += set.judged;
    }

    fn told(&self, degree: &str, is_there: bool) -> u32 {
        self.told.get(&(degree.to_owned(), is_there)).copied().unwrap_or(0)
    }

    fn print(&self) {
        let all: u32 = self.faults.values().sum();
        let share = |count: u32, of: u32| 100.0 * f64::from(count) / f64::from(of.max(1));
        println!("\n| of {all} faults present | | % |\n|---|---|---|");
        for (degree, count) in &self.faults {
            let degree = if degree.is_empty() { "not told" } else { degree };
            println!("| {degree} | {count} | {:.1} |", share(*count, all));
        }
        println!("\n| told as | causes | not there | % |\n|---|---|---|---|");
        for degree in ["named", "looks like"] {
            let (right, wrong) = (self.told(degree, true), self.told(degree, false));
            let of = right + wrong;
            println!("| {degree} | {of} | {wrong} | {:.1} |", share(wrong, of));
        }
        let judged = share(self.judged as u32, self.askable as u32);
        println!("\n{} of {} askable cases judged: {judged:.1} %", self.judged, self.askable);
    }
}

fn print(number: u32, set: &Together) {
    let faults: Vec<_> = set.faults.iter().map(|(name, degree)| mark(name, degree)).collect();
    let wrong = set.told.iter().filter(|told| !told.is_there);
    let of_cases =
        |told: &Told| format!("{} of {}", mark(&told.cause, &told.degree), told.explains.join(" "));
    let wrong: Vec<_> = wrong.map(of_cases).collect();
    let (judged, askable, seconds) = (set.judged, set.askable, set.seconds);
    println!(
        "| {number} | {} | {} | {judged}/{askable} | {seconds:.0} |",
        faults.join(", "),
        wrong.join(", ")
    );
}

/// **named**, *looks like*, not told.
fn mark(name: &str, degree: &str) -> String {
    match degree {
        "named" => format!("**{name}**"),
        "looks like" => format!("*{name}*"),
        _ => name.to_owned(),
    }
}

fn audit(matrix: &Matrix, sets: impl Iterator<Item = (u32, Vec<&'static Fault>)>) -> Audit {
    let mut audit = Audit::default();
    println!(
        "| set | faults: **named**, *looks like*, not told | told and not there | judged | s |"
    );
    println!("|---|---|---|---|---|");
    for (number, faults) in sets {
        let set = matrix.try_together(&faults).unwrap();
        print(number, &set);
        audit.take(&set);
    }
    audit.print();
    audit
}

#[test]
fn of_two_sets_something_is_named_and_nothing_that_is_not_there() {
    let matrix = matrix().of_telling_cases();
    let audit =
        audit(&matrix, IN_A_TEST_RUN.map(|number| (number, draw(&matrix, number))).into_iter());
    assert!(audit.told("named", true) > 0);
    assert_eq!(audit.told("named", false), 0);
    assert_eq!(audit.judged, audit.askable);
}

#[test]
#[ignore = "minutes: the suite many times over"]
fn no_cause_is_named_that_is_not_there() {
    let matrix = matrix().of_telling_cases();
    let audit = audit(&matrix, (0..IN_PASSING).map(|number| (number, draw(&matrix, number))));
    assert!(audit.told("named", true) > 0);
    assert_eq!(audit.told("named", false), 0);
}

#[test]
#[ignore = "an hour: every fault through all images, for audits"]
fn on_images_alone_nothing_is_named_that_is_not_there() {
    let (part, of) = shard();
    let project = Project::at(env!("CARGO_MANIFEST_DIR"));
    let cases = case::load_all(&project.cases()).unwrap();
    let matrix = Matrix::on_images_alone(project, &cases, Budget::Quick, 0);
    let (faults, _) = select(&[]).unwrap();
    let alone = (0..).zip(faults.into_iter().map(|fault| vec![fault]));
    let audit = audit(&matrix, alone.filter(|(number, _)| number % of == part - 1));
    assert_eq!(audit.told("named", false), 0);
}

/// The cases that an audit looks at: all, or those that tell.
fn matrix_of_audit() -> Matrix {
    match std::env::var_os("FURNACE_BRIEF") {
        None => matrix(),
        Some(_) => matrix().of_telling_cases(),
    }
}

#[test]
#[ignore = "an hour: 200 sets, for audits"]
fn most_of_many_faults_are_named_and_little_else() {
    let (part, of) = shard();
    let matrix = matrix_of_audit();
    let numbers = (0..number("FURNACE_SETS", 200)).filter(|set| set % of == part - 1);
    audit(&matrix, numbers.map(|number| (number, draw(&matrix, number))));
}

#[test]
#[ignore = "a quarter of an hour: every fault through a whole run, for audits"]
fn a_fault_alone_is_named_and_nothing_else() {
    let (part, of) = shard();
    let (faults, _) = select(&[]).unwrap();
    let alone = (0..).zip(faults.into_iter().map(|fault| vec![fault]));
    audit(&matrix_of_audit(), alone.filter(|(number, _)| number % of == part - 1));
}
