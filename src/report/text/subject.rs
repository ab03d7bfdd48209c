//! What counts against the cores, one thing after the other: causes with their failures, and failures without a cause.

use crate::diagnosis::Headline;
use crate::report::digest::failures;
use crate::report::tree::RunTree;
use crate::run::TrialRecord;

/// What is told by itself.
#[derive(Clone, Copy, Debug)]
pub(super) enum Subject<'a> {
    /// Of this core.
    Cause(&'a str, &'a Headline),
    /// A failure that nothing explains: its trial says all there is.
    Alone(&'a TrialRecord),
}

impl<'a> Subject<'a> {
    /// The trial that shows it first.
    pub(super) fn witness(&self, tree: &'a RunTree) -> Option<&'a TrialRecord> {
        match self {
            Self::Alone(trial) => Some(trial),
            Self::Cause(core, headline) => {
                let case = headline.explains.first()?;
                tree.trials_of(core).find(|trial| trial.case == *case)
            }
        }
    }
}

/// The one to look at first in front: core by core the causes, graded ones before the others; then what no headline
/// accounts for.
pub(super) fn subjects(tree: &RunTree) -> Vec<Subject<'_>> {
    let headlines = tree.diagnoses().into_iter();
    let mut headlines: Vec<(&str, &Headline)> =
        headlines.flat_map(|(core, d)| d.headlines.iter().map(move |h| (core, h))).collect();
    headlines.sort_by_key(|(_, headline)| !headline.tier.is_graded());
    let failures = failures(tree);
    let alone = |core: &str, headline: &Headline| {
        let of = |trial: &&&TrialRecord| trial.core == core && headline.explains[0] == trial.case;
        failures.iter().find(of).map(|trial| Subject::Alone(trial))
    };
    let told = headlines.iter().filter_map(|(core, headline)| match headline.is_alone() {
        true => alone(core, headline),
        false => Some(Subject::Cause(core, headline)),
    });
    let is_told = |trial: &&&TrialRecord| {
        let tells = |(core, headline): &(&str, &Headline)| {
            *core == trial.core && headline.accounts_for(&trial.case)
        };
        headlines.iter().any(tells)
    };
    let others = failures.iter().filter(|trial| !is_told(trial)).map(|trial| Subject::Alone(trial));
    told.chain(others).collect()
}
