//! What a page shows of which run, and how it reaches the other pages from where it stands.

use crate::report::digest::CaseGroup;
use crate::report::tree::RunTree;
use crate::run::TrialRecord;
use maud::{Markup, html};
use std::path::Path;

/// Where a page stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    /// In the folder of the report.
    Top,
    /// So many folders below it.
    Below(usize),
    /// Anywhere, with no other page beside it.
    Alone,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct View<'a> {
    pub(crate) tree: &'a RunTree,
    /// The folder of the report.
    pub(crate) folder: &'a Path,
    pub(crate) place: Place,
    /// Images with a longer side are made smaller, pixels.
    pub(crate) longest: usize,
    /// Whether what stands beside an image, its bounces and an earlier run, is shown too.
    pub(crate) whole: bool,
}

impl<'a> View<'a> {
    pub(super) const fn new(tree: &'a RunTree, folder: &'a Path, place: Place) -> Self {
        Self { tree, folder, place, longest: usize::MAX, whole: true }
    }

    /// Whether a row has to say which core it is of.
    pub(super) fn has_several_cores(&self) -> bool {
        self.tree.run.cores.len() > 1
    }

    /// The way to the folder of the report.
    pub(super) fn up(&self) -> String {
        match self.place {
            Place::Below(depth) => "../".repeat(depth),
            Place::Top | Place::Alone => String::new(),
        }
    }

    /// A link to a page beside the index; the words alone where there is none.
    pub(super) fn way(&self, file: &str, words: &str) -> Markup {
        html! {
            @match self.place {
                Place::Alone => { (words) }
                _ => { a href={ (self.up()) (file) } { (words) } }
            }
        }
    }

    /// Where the page on a case stands below the folder of the report.
    pub(super) fn file_of(case: &str) -> String {
        format!("case/{case}.html")
    }

    /// The address of a trial; none where the page that stands alone leaves it out.
    pub(super) fn link(&self, trial: &TrialRecord) -> Option<String> {
        let is_shown = || self.tree.trials.iter().any(|t| t.case == trial.case && is_told(t));
        let anchor = format!("#{}", escaped(&anchor(trial)));
        match self.place {
            Place::Alone => is_shown().then_some(anchor),
            Place::Top | Place::Below(_) => {
                let file = escaped(&Self::file_of(&trial.case));
                // The page of a case begins with its first core.
                let is_first = self.tree.run.cores.first().is_some_and(|c| c.spec == trial.core);
                let anchor = if is_first { "" } else { &anchor };
                Some(format!("{}{file}{anchor}", self.up()))
            }
        }
    }
}

/// Whether the single file tells of a trial.
pub(super) fn is_told(trial: &TrialRecord) -> bool {
    trial.outcome.status().is_failure()
}

/// Whether the single file tells of a case.
pub(super) fn has_failed(case: &CaseGroup<'_>) -> bool {
    case.trials.iter().any(|trial| is_told(trial))
}

/// The anchor of a trial: case and core. It has a slash, as no section has.
pub(super) fn anchor(trial: &TrialRecord) -> String {
    format!("{}@{}", trial.case, trial.core)
}

/// `text` as it may stand in an address.
pub(super) fn escaped(text: &str) -> String {
    let escape = |byte: u8| match byte {
        b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'/' | b'@' | b'-' | b'_' | b'.' => {
            char::from(byte).to_string()
        }
        _ => format!("%{byte:02X}"),
    };
    text.bytes().map(escape).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_holds_no_quote_and_no_space() {
        assert_eq!(escaped("a b\"<%/c"), "a%20b%22%3C%25/c");
    }
}
