//! How the summary looks: colours where they help, marks that say the same without them, lines as wide as the terminal.

use crate::run::Status;

/// The narrowest column of text that is still read as sentences.
const NARROWEST: usize = 20;

/// What the terminal can show, and how much the user wants to read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Style {
    /// No line is longer, but for commands and paths, which must stay whole.
    pub(crate) columns: usize,
    /// Whether to colour. Everything is readable without.
    pub(crate) colour: bool,
    pub(crate) detail: Detail,
    /// Whether to say of which core something is: there are several.
    pub(crate) names_cores: bool,
}

/// How much is told.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Detail {
    /// The counts.
    Counts,
    #[default]
    Usual,
    /// All that is known of each failure, what every case would have caught, and the ledger.
    Everything,
}

/// What a piece of text is, as far as colour goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Paint {
    Good,
    /// Counts against a core.
    Bad,
    /// Nothing is known.
    Unknown,
    Faint,
    Strong,
}

impl Style {
    /// Plain text: files, pipes, tests.
    pub const PLAIN: Self =
        Self { columns: 80, colour: false, detail: Detail::Usual, names_cores: false };

    pub(crate) fn is_verbose(self) -> bool {
        self.detail == Detail::Everything
    }

    pub(crate) fn paint(self, paint: Paint, text: &str) -> String {
        if !self.colour || text.is_empty() {
            return text.to_owned();
        }
        let code = match paint {
            Paint::Good => "32",
            Paint::Bad => "1;31",
            Paint::Unknown => "33",
            Paint::Faint => "2",
            Paint::Strong => "1",
        };
        format!("\x1b[{code}m{text}\x1b[0m")
    }

    /// Breaks `text` at spaces so that lines stay within the columns when they are indented by `indent`. Lines of the
    /// text stay lines, and what is drawn of a file stays as it is. What would move the cursor or change colours is made
    /// visible.
    pub(crate) fn wrap(self, text: &str, indent: usize) -> Vec<String> {
        let width = self.columns.saturating_sub(indent).max(NARROWEST);
        clean(text).lines().flat_map(|line| wrap_line(line, width)).collect()
    }
}

/// The one character that stands for a trial in a bar of cells.
pub(crate) const fn mark(status: Status) -> char {
    match status {
        Status::Pass => '#',
        Status::Fail => 'x',
        Status::Inconclusive => '?',
        Status::Skipped => '-',
        Status::Blocked => '~',
        Status::Crashed => '!',
        Status::TimedOut => '@',
        Status::Broken => '*',
    }
}

/// What colour a status has.
pub(crate) const fn paint_of(status: Status) -> Paint {
    match status {
        Status::Pass => Paint::Good,
        Status::Fail | Status::Crashed | Status::TimedOut => Paint::Bad,
        Status::Inconclusive | Status::Broken => Paint::Unknown,
        Status::Skipped | Status::Blocked => Paint::Faint,
    }
}

fn wrap_line(line: &str, width: usize) -> Vec<String> {
    if is_drawn(line) || line.chars().count() <= width {
        return vec![line.trim_end().to_owned()];
    }
    let mut lines = vec![String::new()];
    for word in line.split_whitespace() {
        let last = lines.len() - 1;
        let taken = lines[last].chars().count();
        if taken == 0 {
            lines[last].push_str(word);
        } else if taken + 1 + word.chars().count() <= width {
            lines[last].push(' ');
            lines[last].push_str(word);
        } else {
            lines.push(word.to_owned());
        }
    }
    lines
}

/// A line of a diagnostic: ` --> scenes/box.toml:12`, `12 | albedo = 1.37`, or a caret below it.
pub(super) fn is_drawn(line: &str) -> bool {
    let drawn = line.trim_start_matches(|c: char| c.is_ascii_digit() || c == ' ');
    ["|", "-->", "="].iter().any(|begin| drawn.starts_with(begin))
}

/// `text` without control characters: what comes from a core must not steer the terminal.
pub(crate) fn clean(text: &str) -> String {
    let visible = |c: char| if c.is_control() && c != '\n' { '\u{fffd}' } else { c };
    text.chars().map(visible).collect()
}

/// `text` cut to `width` columns, with dots where something is missing.
pub(crate) fn cut(text: &str, width: usize) -> String {
    let text = clean(text).replace('\n', " ");
    if text.chars().count() <= width {
        return text;
    }
    let kept: String = text.chars().take(width.saturating_sub(3)).collect();
    format!("{}...", kept.trim_end())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_status_has_its_own_mark() {
        let mut marks: Vec<_> = Status::ALL.into_iter().map(mark).collect();
        marks.sort_unstable();
        marks.dedup();
        assert_eq!(marks.len(), Status::ALL.len());
    }

    #[test]
    fn lines_are_broken_at_spaces() {
        let lines = Style::PLAIN.wrap(&"radiance ".repeat(30), 8);
        assert!(lines.len() > 1);
        assert!(lines.iter().all(|line| line.len() <= Style::PLAIN.columns - 8));
        assert_eq!(lines.join(" ").split(' ').count(), 30);
    }

    #[test]
    fn what_is_drawn_of_a_file_stays_as_it_is() {
        let drawn = format!("12 | scene = {}\n   |         ^^^^", "a, ".repeat(40).trim_end());
        assert_eq!(Style::PLAIN.wrap(&drawn, 8).join("\n"), drawn);
    }

    #[test]
    fn a_core_cannot_steer_the_terminal() {
        assert!(!Style::PLAIN.wrap("\x1b[2J\rall pass", 0).concat().contains(['\x1b', '\r']));
    }

    #[test]
    fn without_colour_nothing_but_text() {
        assert_eq!(Style::PLAIN.paint(Paint::Bad, "FAIL"), "FAIL");
    }

    #[test]
    fn what_is_cut_says_so() {
        assert_eq!(cut("bounce 2, red", 9), "bounce...");
        assert_eq!(cut("red", 9), "red");
    }
}
