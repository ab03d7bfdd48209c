//! `furnace run --failed`: what failed in the last run, which alone is tried again.

use super::Failure;
use super::report::newest;
use crate::cores::CoreSpec;
use crate::report::RunTree;
use crate::run::{Plan, Request, Trial, TrialRecord};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// The failures of a run, each by its core and case.
pub(super) struct Failures {
    run: PathBuf,
    trials: BTreeSet<(String, String)>,
}

impl Failures {
    /// Those of the newest run in a folder of runs.
    pub(super) fn of_the_last(runs: &Path) -> Result<Self, Failure> {
        let run = newest(runs)?;
        let tree = RunTree::load(&run).map_err(Failure::request)?;
        let failing = tree.trials.into_iter().filter(TrialRecord::fails_the_core);
        let trials: BTreeSet<_> = failing.map(|trial| (trial.core, trial.case)).collect();
        if trials.is_empty() {
            return Err(Failure::nothing(format!(
                "nothing failed in the last run, {}",
                run.display()
            )));
        }
        Ok(Self { run, trials })
    }

    /// The same request of the cores that failed.
    pub(super) fn request(&self, request: Request) -> Result<Request, Failure> {
        let cores: BTreeSet<_> = self.trials.iter().map(|(core, _)| core).collect();
        let cores = cores.into_iter().map(|core| core.parse::<CoreSpec>());
        let cores = cores.collect::<Result<_, _>>().map_err(Failure::request)?;
        Ok(Request { cores, ..request })
    }

    /// Leaves only these, and says so in the request, so that the run can be resumed.
    pub(super) fn restrict(&self, plan: &mut Plan) -> Result<(), Failure> {
        let failed =
            |trial: &Trial| self.trials.contains(&(trial.core.to_string(), trial.case.id.clone()));
        plan.trials.retain(failed);
        let cases: BTreeSet<_> = plan.trials.iter().map(|trial| trial.case.id.clone()).collect();
        if cases.is_empty() {
            let run = self.run.display();
            return Err(Failure::nothing(format!("none of these failed in the last run, {run}")));
        }
        plan.request.filters = cases.into_iter().collect();
        Ok(())
    }
}
