//! The XML of a COLLADA file: looking things up as the course's reader does, and saying where they are missing.

use crate::scene::Rgb;
use crate::text::{Diagnostic, Source};
use glam::DMat4;
use std::collections::HashMap;
use std::ops::Range;
use std::str::FromStr;

pub(super) type Element<'a> = roxmltree::Node<'a, 'a>;

pub(super) type Result<T> = std::result::Result<T, Diagnostic>;

/// What a node instances: the node's name, and where it stands.
pub(super) struct Instance<'a> {
    pub(super) name: &'a str,
    pub(super) element: Element<'a>,
    pub(super) transform: DMat4,
}

/// A document, and every element that has an id.
pub(super) struct Reader<'a> {
    source: &'a Source,
    pub(super) root: Element<'a>,
    ids: HashMap<&'a str, Element<'a>>,
}

pub(super) fn parse(source: &Source) -> Result<roxmltree::Document<'_>> {
    roxmltree::Document::parse(&source.text).map_err(|problem| {
        let at = offset_of(&source.text, problem.pos());
        source.diagnostic(at..at + 1, format!("is not valid XML: {problem}"))
    })
}

/// The byte at a line and column.
fn offset_of(text: &str, position: roxmltree::TextPos) -> usize {
    let line = position.row.saturating_sub(1) as usize;
    let before: usize = text.split_inclusive('\n').take(line).map(str::len).sum();
    before + position.col.saturating_sub(1) as usize
}

impl<'a> Reader<'a> {
    /// Of two elements with the same id the later one counts.
    pub(super) fn new(source: &'a Source, document: &'a roxmltree::Document<'a>) -> Self {
        let root = document.root_element();
        let ids =
            root.descendants().filter_map(|element| Some((element.attribute("id")?, element)));
        Self { source, root, ids: ids.collect() }
    }

    pub(super) fn wrong(&self, element: Element<'_>, message: impl Into<String>) -> Diagnostic {
        self.source.diagnostic(start_tag(element, &self.source.text), message)
    }

    /// The first element along a path of names, and then what its `url` points to, if it has one.
    pub(super) fn find(&self, element: Element<'a>, path: &str) -> Result<Option<Element<'a>>> {
        match path.split('/').try_fold(element, first_child) {
            Some(found) if found.has_attribute("url") => self.follow(found, "url").map(Some),
            found => Ok(found),
        }
    }

    /// The same, where there is no going on without it.
    pub(super) fn need(&self, element: Element<'a>, path: &str) -> Result<Element<'a>> {
        self.find(element, path)?.ok_or_else(|| {
            self.wrong(element, format!("`{}` has no `{path}`", element.tag_name().name()))
        })
    }

    /// The element whose id an attribute names, after one character (`#`) that is not looked at.
    pub(super) fn follow(&self, element: Element<'a>, attribute: &str) -> Result<Element<'a>> {
        let reference = self.attribute(element, attribute)?;
        let id = reference.get(1..).unwrap_or_default();
        self.ids
            .get(id)
            .copied()
            .ok_or_else(|| self.wrong(element, format!("there is no element with the id `{id}`")))
    }

    /// An attribute without which the course's program would crash.
    pub(super) fn attribute(&self, element: Element<'a>, name: &str) -> Result<&'a str> {
        element.attribute(name).ok_or_else(|| {
            let tag = element.tag_name().name();
            self.wrong(element, format!("`{tag}` has no attribute `{name}`"))
        })
    }

    /// The name of an element that the course's program looks up by its id.
    pub(super) fn name_of(&self, element: Element<'a>) -> Result<&'a str> {
        self.attribute(element, "id")?;
        self.attribute(element, "name")
    }

    /// An attribute that counts something.
    pub(super) fn count(&self, element: Element<'a>, name: &str) -> Result<usize> {
        let text = self.attribute(element, name)?;
        text.trim()
            .parse()
            .map_err(|_| self.wrong(element, format!("`{name}` is `{text}`, not a count")))
    }

    /// All finite numbers of an element's text.
    pub(super) fn numbers<T: Number>(&self, element: Element<'a>) -> Result<Vec<T>> {
        let text = element.text().unwrap_or_default();
        let number = |word: &str| {
            word.parse()
                .ok()
                .filter(T::is_a_number)
                .ok_or_else(|| self.wrong(element, format!("`{word}` is not {}", T::WHAT)))
        };
        text.split_ascii_whitespace().map(number).collect()
    }

    /// The first numbers of an element's text, which must be as many.
    pub(super) fn first_numbers<T: Number>(
        &self,
        element: Element<'a>,
        count: usize,
    ) -> Result<Vec<T>> {
        let mut numbers = self.numbers(element)?;
        if numbers.len() < count {
            let message = format!("here are {} numbers; it takes {count}", numbers.len());
            return Err(self.wrong(element, message));
        }
        numbers.truncate(count);
        Ok(numbers)
    }

    /// The only number of an element.
    pub(super) fn number(&self, element: Element<'a>) -> Result<f64> {
        Ok(self.first_numbers(element, 1)?[0])
    }

    /// The only number of an element, read in double precision and kept in single precision: not always
    /// the single-precision number nearest to the text.
    #[expect(clippy::cast_possible_truncation, reason = "meant: the course keeps these as floats")]
    pub(super) fn narrowed(&self, element: Element<'a>) -> Result<f32> {
        Ok(self.number(element)? as f32)
    }

    /// A colour, which the course reads in double precision; alpha is not looked at.
    pub(super) fn colour(&self, element: Element<'a>) -> Result<Rgb> {
        let rgb: Vec<f64> = self.first_numbers(element, 3)?;
        if rgb.iter().all(|value| *value >= 0.0) {
            Ok([rgb[0], rgb[1], rgb[2]])
        } else {
            Err(self.wrong(element, "a colour cannot be negative"))
        }
    }

    /// The technique of a profile in the first `extra`.
    pub(super) fn technique(&self, element: Element<'a>, profile: &str) -> Option<Element<'a>> {
        let extra = first_child(element, "extra")?;
        children(extra, "technique").find(|child| child.attribute("profile") == Some(profile))
    }

    /// The technique that every COLLADA reader understands.
    pub(super) fn common_technique(&self, element: Element<'a>) -> Option<Element<'a>> {
        let profile = first_child(element, "profile_COMMON");
        profile
            .and_then(|profile| {
                children(profile, "technique")
                    .find(|child| child.attribute("sid") == Some("common"))
            })
            .or_else(|| first_child(element, "technique_common"))
    }
}

pub(super) fn children<'a>(
    element: Element<'a>,
    name: &'a str,
) -> impl Iterator<Item = Element<'a>> {
    element.children().filter(move |child| child.tag_name().name() == name)
}

pub(super) fn first_child<'a>(element: Element<'a>, name: &str) -> Option<Element<'a>> {
    element.children().find(|child| child.tag_name().name() == name)
}

/// What a message underlines: `<node id="…">`, not the thousand lines after it.
fn start_tag(element: Element<'_>, text: &str) -> Range<usize> {
    let range = element.range();
    let length = text[range.clone()].find('>').map_or(range.len(), |end| end + 1);
    range.start..range.start + length
}

/// A number as it stands in the text: what messages call it, and whether it can be reckoned with.
pub(super) trait Number: FromStr + Copy {
    const WHAT: &str;
    fn is_a_number(&self) -> bool;
}

macro_rules! numbers {
    ($($type:ty: $what:literal, $is_a_number:expr;)*) => {$(
        impl Number for $type {
            const WHAT: &str = $what;
            fn is_a_number(&self) -> bool {
                $is_a_number(self)
            }
        }
    )*};
}
numbers! {
    f64: "a number", |number: &f64| number.is_finite();
    f32: "a number of single precision", |number: &f32| number.is_finite();
    u32: "an index", |_| true;
}
