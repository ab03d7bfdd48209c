//! Whether to colour what is printed: as the user says, or the environment, or else wherever there is a terminal.

use std::ffi::OsString;
use std::sync::OnceLock;

/// What the user said of colours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
pub(crate) enum Colour {
    /// On a terminal, unless NO_COLOR is set; anywhere, if CLICOLOR_FORCE is.
    #[default]
    Auto,
    /// Everywhere.
    Always,
    /// Nowhere.
    Never,
}

static CHOSEN: OnceLock<Colour> = OnceLock::new();

impl Colour {
    /// What holds from now on. The first word counts.
    pub(crate) fn choose(self) {
        let _ = CHOSEN.set(self);
    }

    /// Whether to colour what goes to a terminal, or to something else.
    pub(crate) fn is_wanted(on_terminal: bool) -> bool {
        CHOSEN.get().copied().unwrap_or_default().allows(on_terminal, |name| std::env::var_os(name))
    }

    /// <https://no-color.org>, <https://bixense.com/clicolors>: what forbids is stronger.
    fn allows(self, on_terminal: bool, variable: impl Fn(&str) -> Option<OsString>) -> bool {
        let is_set = |name| variable(name).is_some_and(|value| !value.is_empty());
        let is_forced = || variable("CLICOLOR_FORCE").is_some_and(|v| !v.is_empty() && v != "0");
        match self {
            Self::Always => true,
            Self::Never => false,
            Self::Auto => !is_set("NO_COLOR") && (on_terminal || is_forced()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_user_counts_more_than_variables_and_those_more_than_the_terminal() {
        let allows = |colour: Colour, terminal, variables: &[(&str, &str)]| {
            let value = |name: &str| {
                let found = variables.iter().find(|(known, _)| *known == name);
                found.map(|(_, value)| OsString::from(value))
            };
            colour.allows(terminal, value)
        };
        let (no, force) = (("NO_COLOR", "1"), ("CLICOLOR_FORCE", "1"));
        assert!(allows(Colour::Auto, true, &[]) && !allows(Colour::Auto, false, &[]));
        assert!(!allows(Colour::Auto, true, &[no]) && allows(Colour::Auto, false, &[force]));
        assert!(!allows(Colour::Auto, true, &[no, force]));
        assert!(allows(Colour::Auto, true, &[("NO_COLOR", "")]));
        assert!(!allows(Colour::Auto, false, &[("CLICOLOR_FORCE", "0")]));
        assert!(allows(Colour::Always, false, &[no]) && !allows(Colour::Never, true, &[force]));
    }
}
