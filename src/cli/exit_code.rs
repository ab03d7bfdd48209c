//! How the process ends. Scripts rely on these numbers.

use crate::run::{Status, Tally};

/// How the process ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExitCode {
    /// 0: something passed, and nothing failed.
    Good,
    /// 1: something failed, crashed or timed out.
    Failed,
    /// 2: the request or a case is wrong.
    BadRequest,
    /// 3: the harness or a case is broken; with `--strict` also if something is inconclusive, skipped or blocked.
    Broken,
    /// 4: nothing was selected.
    NothingSelected,
    /// 5: nothing failed and nothing passed: all was skipped, blocked, inconclusive or not graded.
    NothingProven,
    /// 130: interrupted, as by ctrl-c.
    Interrupted,
}

impl ExitCode {
    /// The code for a run whose graded trials ended so.
    pub(crate) fn of(graded: &Tally, strict: bool) -> Self {
        let undecided = [Status::Inconclusive, Status::Skipped, Status::Blocked];
        let are_undecided = || undecided.iter().any(|status| graded.count(*status) > 0);
        if graded.failures() > 0 {
            Self::Failed
        } else if graded.count(Status::Broken) > 0 || strict && are_undecided() {
            Self::Broken
        } else if graded.count(Status::Pass) == 0 {
            Self::NothingProven
        } else {
            Self::Good
        }
    }

    /// The number that the shell sees.
    pub(crate) const fn number(self) -> u8 {
        match self {
            Self::Good => 0,
            Self::Failed => 1,
            Self::BadRequest => 2,
            Self::Broken => 3,
            Self::NothingSelected => 4,
            Self::NothingProven => 5,
            Self::Interrupted => 130,
        }
    }
}

impl From<ExitCode> for std::process::ExitCode {
    fn from(code: ExitCode) -> Self {
        Self::from(code.number())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use Status::{Broken, Fail, Inconclusive, Pass, Skipped};

    #[test]
    fn the_worst_of_a_run_decides_and_where_nothing_is_proven_it_is_no_success() {
        let rows: [(&[Status], bool, ExitCode); 9] = [
            (&[Pass, Broken, Fail], false, ExitCode::Failed),
            (&[Pass, Inconclusive, Skipped], false, ExitCode::Good),
            (&[Pass, Inconclusive], true, ExitCode::Broken),
            (&[Pass, Skipped], true, ExitCode::Broken),
            (&[], false, ExitCode::NothingProven),
            (&[Skipped, Skipped], false, ExitCode::NothingProven),
            (&[Inconclusive], false, ExitCode::NothingProven),
            (&[Skipped], true, ExitCode::Broken),
            (&[Pass, Broken], false, ExitCode::Broken),
        ];
        for (statuses, strict, code) in rows {
            let tally = statuses.iter().copied().collect();
            assert_eq!(ExitCode::of(&tally, strict), code, "{statuses:?}");
        }
    }
}
