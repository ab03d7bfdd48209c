//! `furnace`: a test bench for path tracers. It puts questions with known answers to a renderer and says what is
//! wrong, by how much, and where.
//!
//! # The layers
//!
//! A module names only modules further down; two modules of one line do not name each other (`tests/architecture.rs`).
//!
//! ```text
//!                         cli   harness
//!                             grade
//!      report    reference    faults    agreement    bench    writeup
//!                              run
//!                           diagnosis
//!                             case     render
//!              checks                   cores
//!                 │                     worker
//!                 └──── contract ─────────┘
//!                             scene
//!                             stats
//!                    cause    image    project
//!                       math    text    disk
//! ```
//!
//! # The words
//!
//! A **core** is a renderer under test: whatever implements [`contract::Core`]. A **case** is a claim that can be false, one
//! TOML file of `cases/`; a **check** is the way in which it is judged. A check answers a **finding**: a **verdict** (pass,
//! fail, inconclusive), a sentence and the numbers. One case on one core is a **trial**, which has an **outcome**; many
//! trials are a **run**, a folder with one **sidecar** each. A **cause** is a mistake that furnace can name, a
//! **diagnosis** goes from the findings of a run to causes. A **fault** is a mistake planted on purpose. The README
//! has all of them.
//!
//! # Where to begin
//!
//! - To put a renderer of yours to the bench: implement [`contract::Core`], which begins with one method, and hand it to
//!   [`trials`]: five lines make every case a test of your crate. What to implement, task by task: `cores::textbook`
//!   is the model to read, one function a task, in the order of a course.
//! - To follow a verdict: [`run`] brings case and core together, a check of [`checks`] asks, [`stats`] decides.
//! - To see how a mistake gets its name: [`cause`] is the glossary, [`diagnosis`] has one rule a file.

#![cfg_attr(
    not(feature = "cli"),
    expect(dead_code, unused_imports, reason = "much is for the command line alone")
)]

// The order of the layers, from below.
pub mod disk;
pub mod math;
pub mod text;

pub mod cause;
pub mod image;
pub mod project;

pub mod stats;

pub mod scene;

pub mod contract;

pub mod worker;

pub mod checks;
pub mod cores;

pub mod case;
#[cfg(feature = "cli")]
pub(crate) mod render;

pub mod diagnosis;

pub mod run;

pub mod agreement;
pub mod bench;
pub mod faults;
pub mod reference;
pub mod report;
#[cfg(feature = "cli")]
pub(crate) mod writeup;

pub(crate) mod grade;

#[cfg(feature = "cli")]
pub mod cli;

mod harness;

pub use diagnosis::Degree;
pub use glam;
pub use grade::{CaseGrade, Entry, Grade, PartGrade, Points, Standing, Told, Warning};
pub use harness::{Trials, TrialsError, grade, trials};
