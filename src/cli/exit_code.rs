//! How the process ends. Scripts rely on these numbers.

use crate::run::Status;

/// How the process ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExitCode {
    /// 0: nothing failed.
    Good,
    /// 1: something failed, crashed or timed out.
    Failed,
    /// 2: the request or a case is wrong.
    BadRequest,
    /// 3: the harness or a case is broken; with `--strict` also if something is inconclusive, skipped or blocked.
    Broken,
    /// 4: nothing was selected.
    NothingSelected,
}

impl ExitCode {
    /// The code for a run whose trials ended so.
    pub(crate) fn of(statuses: impl IntoIterator<Item = Status>, strict: bool) -> Self {
        let statuses: Vec<_> = statuses.into_iter().collect();
        let any = |wanted: &dyn Fn(Status) -> bool| statuses.iter().any(|status| wanted(*status));
        let undecided = [Status::Inconclusive, Status::Skipped, Status::Blocked];
        if statuses.is_empty() {
            Self::NothingSelected
        } else if any(&Status::is_failure) {
            Self::Failed
        } else if any(&|status| status == Status::Broken)
            || strict && any(&|status| undecided.contains(&status))
        {
            Self::Broken
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
    fn the_worst_of_a_run_decides_and_what_was_not_decided_counts_only_when_strict() {
        let rows: [(&[Status], bool, ExitCode); 6] = [
            (&[Pass, Broken, Fail], false, ExitCode::Failed),
            (&[Pass, Inconclusive, Skipped], false, ExitCode::Good),
            (&[Pass, Inconclusive], true, ExitCode::Broken),
            (&[Pass, Skipped], true, ExitCode::Broken),
            (&[], false, ExitCode::NothingSelected),
            (&[Pass, Broken], false, ExitCode::Broken),
        ];
        for (statuses, strict, code) in rows {
            assert_eq!(ExitCode::of(statuses.iter().copied(), strict), code, "{statuses:?}");
        }
    }
}
