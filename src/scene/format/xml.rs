//! XML as our exporters write it: elements with attributes, indented, through a library that escapes.

use quick_xml::Writer;
use quick_xml::events::{BytesEnd, BytesStart, BytesText, Event};

/// Spaces that an element stands further in than the one around it.
const INDENT: usize = 4;

/// A document in the making.
pub(super) struct XmlWriter {
    writer: Writer<Vec<u8>>,
    open: Vec<&'static str>,
}

impl Default for XmlWriter {
    fn default() -> Self {
        Self { writer: Writer::new_with_indent(Vec::new(), b' ', INDENT), open: Vec::new() }
    }
}

impl XmlWriter {
    /// Begins an element that others go into.
    pub(crate) fn open(&mut self, element: &'static str, attributes: &[(&str, &str)]) {
        self.write(Event::Start(tag(element, attributes)));
        self.open.push(element);
    }

    /// Ends the element begun last.
    pub(crate) fn close(&mut self) {
        if let Some(element) = self.open.pop() {
            self.write(Event::End(BytesEnd::new(element)));
        }
    }

    /// An element that nothing goes into.
    pub(crate) fn leaf(&mut self, element: &str, attributes: &[(&str, &str)]) {
        self.write(Event::Empty(tag(element, attributes)));
    }

    /// An element with a text and nothing else.
    pub(crate) fn text(&mut self, element: &str, attributes: &[(&str, &str)], text: &str) {
        self.write(Event::Start(tag(element, attributes)));
        self.write(Event::Text(BytesText::new(text)));
        self.write(Event::End(BytesEnd::new(element)));
    }

    /// The text of the document.
    pub(crate) fn finish(mut self) -> String {
        while !self.open.is_empty() {
            self.close();
        }
        let mut text = String::from_utf8_lossy(&self.writer.into_inner()).into_owned();
        text.push('\n');
        text
    }

    fn write(&mut self, event: Event<'_>) {
        self.writer.write_event(event).expect("memory can be written to");
    }
}

fn tag<'a>(element: &'a str, attributes: &[(&'a str, &'a str)]) -> BytesStart<'a> {
    BytesStart::new(element).with_attributes(attributes.iter().copied())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_are_indented_closed_and_escaped() {
        let mut xml = XmlWriter::default();
        xml.open("a", &[("name", "<\"&\">")]);
        xml.text("b", &[], "1 < 2");
        xml.leaf("c", &[]);
        let text = xml.finish();
        let expected =
            "<a name=\"&lt;&quot;&amp;&quot;&gt;\">\n    <b>1 &lt; 2</b>\n    <c/>\n</a>\n";
        assert_eq!(text, expected);
        let read = roxmltree::Document::parse(&text).unwrap();
        assert_eq!(read.root_element().attribute("name"), Some("<\"&\">"));
    }
}
