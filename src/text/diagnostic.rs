//! A message that points into a file: what is wrong, where, and what would have been right.

use super::document::{TomlError, read_toml};
use super::suggestion::{did_you_mean, quoted_words};
use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};
use serde::de::DeserializeOwned;
use std::fmt;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

/// A text and the name it goes by in messages. Cheap to clone.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Source {
    /// What messages call it: a path as the user would type it.
    pub(crate) name: Arc<str>,
    /// The whole text; spans count its bytes.
    pub(crate) text: Arc<str>,
}

impl Source {
    pub(crate) fn new(name: impl Into<Arc<str>>, text: impl Into<Arc<str>>) -> Self {
        Self { name: name.into(), text: text.into() }
    }

    pub(crate) fn read(path: &Path) -> std::io::Result<Self> {
        Ok(Self::new(path.display().to_string(), std::fs::read_to_string(path)?))
    }

    /// A complaint about the bytes of `span`.
    pub(crate) fn diagnostic(&self, span: Range<usize>, message: impl Into<String>) -> Diagnostic {
        Diagnostic { source: self.clone(), span, message: message.into(), hint: None }
    }

    /// The text as TOML of a given shape. Unknown keys and variants come back with the word that was probably meant.
    pub(crate) fn parse_toml<T: DeserializeOwned>(&self) -> Result<T, Diagnostic> {
        read_toml(&self.text).map_err(|error| self.toml_diagnostic(error))
    }

    /// What the TOML parser or a deserialiser says, pointing at the place it speaks of.
    pub(crate) fn toml_diagnostic(&self, error: impl Into<TomlError>) -> Diagnostic {
        let error = error.into();
        let message = error.message();
        let hint =
            message.starts_with("unknown ").then(|| quoted_words(message)).and_then(|words| {
                words
                    .split_first()
                    .and_then(|(word, valid)| did_you_mean(word, valid.iter().copied()))
            });
        let span = error.span().unwrap_or(0..0);
        Diagnostic { hint, ..self.diagnostic(span, message) }
    }
}

/// A complaint about a place in a text. Displays as a snippet with a caret.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    pub(crate) source: Source,
    pub(crate) span: Range<usize>,
    /// What is wrong: a lowercase fragment, names in backticks.
    pub(crate) message: String,
    pub(crate) hint: Option<String>,
}

impl Diagnostic {
    pub(crate) fn with_hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(hint.into());
        self
    }

    pub(crate) fn with_hint_if_any(mut self, hint: Option<String>) -> Self {
        self.hint = hint.or(self.hint);
        self
    }

    /// The line the complaint points at, counted from 1.
    pub(crate) fn line(&self) -> usize {
        let start = self.visible_span().start;
        self.source.text.as_bytes()[..start].iter().filter(|byte| **byte == b'\n').count() + 1
    }

    /// The span, moved inside the text and cut at the end of its first line: a caret under ten
    /// lines of an array says less than one under its first.
    fn visible_span(&self) -> Range<usize> {
        let text = &self.source.text;
        let start = char_boundary(text, self.span.start);
        let end = char_boundary(text, self.span.end).max(start);
        let line = text[start..end].find('\n').filter(|length| *length > 0).unwrap_or(end - start);
        start..start + line
    }
}

/// The last place at or before `index` where a character of `text` begins.
fn char_boundary(text: &str, index: usize) -> usize {
    (0..=index.min(text.len())).rev().find(|at| text.is_char_boundary(*at)).unwrap_or(0)
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let snippet = Snippet::source(&*self.source.text)
            .path(&*self.source.name)
            .annotation(AnnotationKind::Primary.span(self.visible_span()));
        let mut report = Level::ERROR.primary_title(&self.message).element(snippet);
        if let Some(hint) = &self.hint {
            report = report.element(Level::HELP.message(hint));
        }
        f.write_str(&Renderer::plain().render(&[report]))
    }
}

impl std::error::Error for Diagnostic {}

#[cfg(test)]
mod tests {
    use super::*;
    use serde::Deserialize;

    #[derive(Debug, Deserialize)]
    #[serde(deny_unknown_fields, rename_all = "kebab-case")]
    struct Camera {
        #[serde(rename = "look-at")]
        _look_at: [f64; 3],
    }

    fn complaint(text: &str) -> String {
        Source::new("scenes/box.toml", text).parse_toml::<Camera>().unwrap_err().to_string()
    }

    #[test]
    fn an_unknown_key_is_answered_with_file_line_caret_and_the_valid_words() {
        let expected = "\
error: unknown field `lok-at`, expected `look-at`
 --> scenes/box.toml:2:1
  |
2 | lok-at = [0, 0, 0]
  | ^^^^^^
  |
  = help: did you mean `look-at`?";
        assert_eq!(complaint("# a box\nlok-at = [0, 0, 0]\n"), expected);
    }

    #[test]
    fn a_syntax_error_points_at_the_place() {
        let message = complaint("look-at = [0, 0,\n");
        assert!(message.contains("scenes/box.toml:"), "{message}");
        assert!(message.contains('^'), "{message}");
    }

    #[test]
    fn a_wrong_value_is_underlined() {
        let message = complaint("look-at = [0, \"up\", 0]\n");
        assert!(message.contains("look-at = [0, \"up\", 0]"), "{message}");
        assert!(message.contains("invalid type: string \"up\""), "{message}");
    }

    #[test]
    fn spans_beyond_the_text_do_no_harm() {
        let source = Source::new("a", "é");
        for span in [0..1, 1..9, 7..9, 2..2] {
            assert!(source.diagnostic(span, "wrong").to_string().contains("wrong"));
        }
        assert!(Source::new("a", "").diagnostic(0..3, "empty").to_string().contains("empty"));
    }

    #[test]
    fn only_the_first_line_of_a_long_span_is_underlined() {
        let diagnostic = Source::new("a", "x = [\n1,\n2]\n").diagnostic(4..12, "too long");
        assert_eq!(diagnostic.visible_span(), 4..5);
    }
}
