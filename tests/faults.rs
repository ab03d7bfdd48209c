//! The kill matrix: every planted mistake is caught by the case that is named for it and told by its cause, here or
//! in a run, and cores that are right but different pass. One trial each; `cargo furnace faults` shows the same as a table.
//!
//! Budgets are quick, and each fault is put to the case named for it first: this is the part of the matrix that a test
//! run can afford. `cargo furnace faults` without `--brief` puts each fault to the whole suite.

use furnace::case::{self, NothingSelected};
use furnace::faults::{Matrix, select};
use furnace::project::Project;
use furnace::stats::Budget;
use libtest_mimic::{Arguments, Failed, Trial};
use std::process::ExitCode;
use std::sync::Arc;

/// Caught here, and named by a run: there causes are put to the proof, and what no rule foretells is searched for among the
/// mistakes that the bench can plant, which here would be the mistake itself.
const NAMED_BY_A_RUN: &[&str] = &[
    // The rules alone take them for another that gives the same numbers somewhere.
    "light-halved",
    "light-area-of-one-triangle",
    "light-pdf-inverted",
    "first-bounce-left-out",
    // What it adds or takes away is what the scene has below the horizon.
    "light-from-below-added",
    "light-from-below-subtracted",
    // What wrong MIS weights give depends on the scene's pdfs, and no rule foretells it.
    "mis-surface-in-full",
    "mis-surface-in-full-everywhere",
    "mis-light-in-full",
    "mis-light-in-full-everywhere",
    "mis-heuristics-differ",
    "mis-heuristics-differ-everywhere",
    // No rule looks for them.
    "back-of-surface-unlit",
    "bounce-world-cosine",
    "light-met-for-ever-after-a-mirror",
    "metal-pdf-of-all-normals",
    "mirror-shows-no-sky",
    "sphere-light-as-disk",
];

fn main() -> ExitCode {
    let arguments = Arguments::from_args();
    let project = Project::at(env!("CARGO_MANIFEST_DIR"));
    let cases = match case::load_all(&project.cases()) {
        Ok(cases) => cases,
        Err(error) => {
            eprintln!("{error}");
            return ExitCode::from(2);
        }
    };
    let matrix = Arc::new(Matrix::new(project, &cases, Budget::Quick, 1));
    match trials(&matrix) {
        Ok(trials) => libtest_mimic::run(&arguments, trials).exit_code(),
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(2)
        }
    }
}

fn trials(matrix: &Arc<Matrix>) -> Result<Vec<Trial>, NothingSelected> {
    let (faults, different) = select(&[])?;
    let faults = faults.into_iter().map(|fault| {
        let matrix = Arc::clone(matrix);
        Trial::test(format!("fault::{}", fault.name), move || {
            let not_caught = || Err(Failed::from(format!("not caught by {}", fault.caught_by)));
            if NAMED_BY_A_RUN.contains(&fault.name) {
                return if matrix.is_caught(fault)? { Ok(()) } else { not_caught() };
            }
            let tried = matrix.try_fault_briefly(fault)?;
            match (tried.caught, tried.named) {
                (true, true) => Ok(()),
                (false, _) => not_caught(),
                (true, false) => Err(Failed::from(format!(
                    "told as {}, not as {}",
                    tried.told.unwrap_or("nothing"),
                    fault.cause.name
                ))),
            }
        })
    });
    // A quarter of the cases each: the whole suite is for audits.
    let different = different.into_iter().enumerate().map(|(number, core)| {
        let matrix = Arc::clone(matrix);
        Trial::test(format!("different::{}", core.name), move || {
            let spared = matrix.quarter_touched_by(core, number).try_different(core)?;
            match spared.is_good() {
                true => Ok(()),
                false => Err(Failed::from(spared.statements.join("; "))),
            }
        })
    });
    Ok(faults.chain(different).collect())
}
