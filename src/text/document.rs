//! TOML as the types that it stands for, with the place of whatever is wrong.
//!
//! Derived code is compiled once for each kind of map and list that it may meet. Here there is one
//! of each, for a hundred and ninety types; the parser's own deserialiser has four.

use serde::de::value::SeqDeserializer;
use serde::de::{
    self, DeserializeOwned, DeserializeSeed, Deserializer, EnumAccess, Error as _, Expected,
    IntoDeserializer, MapAccess, Unexpected, VariantAccess, Visitor,
};
use serde::{Deserialize, forward_to_deserialize_any};
use std::cell::{Cell, RefCell};
use std::fmt;
use std::ops::Range;
use toml::de::{DeTable, DeValue};

/// The text of a file as a `T`.
pub(crate) fn read_toml<T: DeserializeOwned>(text: &str) -> Result<T, TomlError> {
    read_table(&DeTable::parse(text)?)
}

/// What stands under `key` as a `T`.
pub(crate) fn read_key<T: DeserializeOwned>(text: &str, key: &'static str) -> Result<T, TomlError> {
    let document = DeTable::parse(text)?;
    let value = document.get_ref().get(key).ok_or_else(|| TomlError::missing_field(key))?;
    T::deserialize(Node::of(value))
}

/// A parsed text as a `T`.
pub(crate) fn read_table<T: DeserializeOwned>(
    table: &toml::Spanned<DeTable<'_>>,
) -> Result<T, TomlError> {
    T::deserialize(Node { content: Content::Map(table.get_ref()), span: table.span() })
}

/// A value and where it stands. Only the functions of this module can read one.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(from = "Placed<T>")]
pub(crate) struct Spanned<T> {
    value: T,
    span: Range<usize>,
}

impl<T> Spanned<T> {
    /// The bytes of the text that the value was read from.
    pub(crate) fn span(&self) -> Range<usize> {
        self.span.clone()
    }

    pub(crate) fn get_ref(&self) -> &T {
        &self.value
    }

    pub(crate) fn into_inner(self) -> T {
        self.value
    }
}

/// How [`Node`] hands over a [`Spanned`]: first byte, end, value.
#[derive(Deserialize)]
#[serde(rename = "$furnace::Placed")]
struct Placed<T>(usize, usize, T);

const PLACED: &str = "$furnace::Placed";

impl<T> From<Placed<T>> for Spanned<T> {
    fn from(Placed(start, end, value): Placed<T>) -> Self {
        Self { value, span: start..end }
    }
}

/// What is wrong with a text, and where, if that is known.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct TomlError(Box<(String, Option<Range<usize>>)>);

impl TomlError {
    pub(crate) fn message(&self) -> &str {
        &self.0.0
    }

    pub(crate) fn span(&self) -> Option<Range<usize>> {
        self.0.1.clone()
    }

    /// The same complaint, about `span` unless it has a narrower place already.
    fn within(mut self, span: Range<usize>) -> Self {
        self.0.1.get_or_insert(span);
        self
    }
}

impl From<toml::de::Error> for TomlError {
    fn from(error: toml::de::Error) -> Self {
        Self(Box::new((error.message().to_owned(), error.span())))
    }
}

impl de::Error for TomlError {
    fn custom<T: fmt::Display>(message: T) -> Self {
        Self(Box::new((message.to_string(), None)))
    }
}

impl fmt::Display for TomlError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.message())
    }
}

impl std::error::Error for TomlError {}

/// A value, a key, or an end of a span: whatever a visitor may meet.
struct Node<'a> {
    content: Content<'a>,
    span: Range<usize>,
}

enum Content<'a> {
    /// No file: what is asked of it is noted.
    Probe(&'a Probe<'a>, &'a [Step]),
    Text(&'a str),
    Signed(i64),
    Unsigned(u64),
    Float(f64),
    Boolean(bool),
    Date(String),
    List(&'a [toml::Spanned<DeValue<'a>>]),
    Map(&'a DeTable<'a>),
    /// A number that nothing here can hold.
    Overflow(&'static str),
}

impl<'a> Node<'a> {
    fn of(value: &'a toml::Spanned<DeValue<'a>>) -> Self {
        Self { content: Content::of(value.get_ref()), span: value.span() }
    }

    fn text(text: &'a str, span: Range<usize>) -> Self {
        Self { content: Content::Text(text), span }
    }

    /// The complaint that this is not `what`.
    fn other_than(self, what: &dyn Expected) -> TomlError {
        let error = match &self.content {
            Content::Overflow(message) => TomlError::custom(message),
            content => TomlError::invalid_type(content.unexpected(), what),
        };
        error.within(self.span)
    }

    /// The name of a variant, and what stands beside it.
    fn variant(self) -> Result<Variant<'a>, TomlError> {
        let wrong = match self.content {
            Content::Text(name) => return Ok(Variant { name, span: self.span, payload: None }),
            Content::Map(table) => match (table.len(), table.iter().next()) {
                (1, Some((name, value))) => {
                    let payload = Some(Node::of(value));
                    return Ok(Variant { name: name.get_ref(), span: name.span(), payload });
                }
                (0, _) => "wanted exactly 1 element, found 0 elements",
                _ => "wanted exactly 1 element, more than 1 element",
            },
            _ => "wanted string or table",
        };
        Err(TomlError::custom(wrong).within(self.span))
    }
}

impl<'a> Content<'a> {
    fn of(value: &'a DeValue<'a>) -> Self {
        match value {
            DeValue::String(text) => Self::Text(text),
            DeValue::Integer(number) => {
                let (digits, radix) = (number.as_str(), number.radix());
                let unsigned = || u64::from_str_radix(digits, radix).map(Self::Unsigned);
                i64::from_str_radix(digits, radix)
                    .map(Self::Signed)
                    .or_else(|_| unsigned())
                    .unwrap_or(Self::Overflow("integer number overflowed"))
            }
            DeValue::Float(number) => match number.as_str().parse::<f64>() {
                Ok(value) if value.is_finite() || !number.as_str().contains(char::is_numeric) => {
                    Self::Float(value)
                }
                _ => Self::Overflow("floating-point number overflowed"),
            },
            DeValue::Boolean(value) => Self::Boolean(*value),
            DeValue::Datetime(date) => Self::Date(date.to_string()),
            DeValue::Array(items) => Self::List(items),
            DeValue::Table(table) => Self::Map(table),
        }
    }

    fn unexpected(&self) -> Unexpected<'_> {
        match self {
            Self::Text(text) => Unexpected::Str(text),
            Self::Signed(number) => Unexpected::Signed(*number),
            Self::Unsigned(number) => Unexpected::Unsigned(*number),
            Self::Float(number) => Unexpected::Float(*number),
            Self::Boolean(value) => Unexpected::Bool(*value),
            Self::Date(_) => Unexpected::Other("date"),
            Self::List(_) => Unexpected::Seq,
            Self::Map(_) => Unexpected::Map,
            Self::Probe(..) => Unexpected::Other("a probe"),
            Self::Overflow(message) => Unexpected::Other(message),
        }
    }
}

impl<'de> Deserializer<'de> for Node<'de> {
    type Error = TomlError;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, TomlError> {
        let span = self.span.clone();
        let value = match self.content {
            Content::Probe(probe, _) => return Err(probe.expects(&visitor)),
            Content::Text(text) => visitor.visit_str(text),
            Content::Date(date) => visitor.visit_str(&date),
            Content::Signed(number) => visitor.visit_i64(number),
            Content::Unsigned(number) => visitor.visit_u64(number),
            Content::Float(number) => visitor.visit_f64(number),
            Content::Boolean(value) => visitor.visit_bool(value),
            Content::List(items) => visitor.visit_seq(list(items)),
            Content::Map(table) => visitor.visit_map(Entries::of(table)),
            Content::Overflow(_) => return Err(self.other_than(&visitor)),
        };
        value.map_err(|error| error.within(span))
    }

    fn deserialize_map<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, TomlError> {
        match self.content {
            Content::Probe(probe, steps) => probe.table(steps, Level::Map, visitor),
            Content::Map(table) => {
                visitor.visit_map(Entries::of(table)).map_err(|error| error.within(self.span))
            }
            _ => Err(self.other_than(&visitor)),
        }
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        keys: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, TomlError> {
        match self.content {
            Content::Probe(probe, steps) => probe.table(steps, Level::Keys(keys), visitor),
            _ => self.deserialize_map(visitor),
        }
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, TomlError> {
        match self.content {
            Content::Probe(probe, [Step::Item, steps @ ..]) => {
                visitor.visit_seq(SeqDeserializer::new(vec![probe.node(steps)].into_iter()))
            }
            Content::Probe(probe, _) => Err(probe.is(Level::List)),
            Content::List(items) => {
                visitor.visit_seq(list(items)).map_err(|error| error.within(self.span))
            }
            _ => Err(self.other_than(&visitor)),
        }
    }

    fn deserialize_tuple<V: Visitor<'de>>(
        self,
        _: usize,
        visitor: V,
    ) -> Result<V::Value, TomlError> {
        self.deserialize_seq(visitor)
    }

    fn deserialize_tuple_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        _: usize,
        visitor: V,
    ) -> Result<V::Value, TomlError> {
        match name {
            PLACED => visitor.visit_seq(placed(self)),
            _ => self.deserialize_seq(visitor),
        }
    }

    fn deserialize_str<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, TomlError> {
        match self.content {
            Content::Probe(probe, _) => Err(probe.is(Level::Text)),
            Content::Text(text) => {
                visitor.visit_str(text).map_err(|error: TomlError| error.within(self.span))
            }
            _ => Err(self.other_than(&visitor)),
        }
    }

    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, TomlError> {
        self.deserialize_str(visitor)
    }

    fn deserialize_identifier<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, TomlError> {
        self.deserialize_str(visitor)
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, TomlError> {
        if let Content::Probe(probe, []) = self.content {
            probe.is_optional.set(true);
        }
        visitor.visit_some(self)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Result<V::Value, TomlError> {
        let span = self.span.clone();
        visitor.visit_newtype_struct(self).map_err(|error| error.within(span))
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        words: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, TomlError> {
        let span = self.span.clone();
        if let Content::Probe(probe, steps) = self.content {
            let [Step::Key(name), steps @ ..] = steps else {
                return Err(probe.is(Level::Variants(words)));
            };
            let payload = Some(probe.node(steps));
            return visitor.visit_enum(Variant { name, span, payload });
        }
        visitor.visit_enum(self.variant()?).map_err(|error| error.within(span))
    }

    fn deserialize_ignored_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, TomlError> {
        visitor.visit_unit()
    }

    forward_to_deserialize_any! {
        bool u8 u16 u32 u64 i8 i16 i32 i64 u128 i128 f32 f64 char bytes byte_buf unit unit_struct
    }
}

/// One way down in what a type is read from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Step {
    /// Of a table, or the word of a variant.
    Key(&'static str),
    /// Of a list.
    Item,
}

/// What stands at the end of a way.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Level {
    /// A table with these keys.
    Keys(&'static [&'static str]),
    /// A table with keys of the writer's own.
    Map,
    List,
    /// One of these words.
    Variants(&'static [&'static str]),
    Text,
    /// A variant that is a word alone.
    Nothing,
    /// Anything, as far as its reader says in words.
    Other(String),
}

/// Stands in the place of a file, and notes what its reader asks for at the end of a way.
pub(crate) struct Probe<'a> {
    steps: &'a [Step],
    found: RefCell<Option<Level>>,
    is_optional: Cell<bool>,
}

impl<'a> Probe<'a> {
    pub(crate) fn new(steps: &'a [Step]) -> Self {
        Self { steps, found: RefCell::new(None), is_optional: Cell::new(false) }
    }

    /// What was asked for; where nobody came there, anything.
    pub(crate) fn found(self) -> Level {
        self.found.into_inner().unwrap_or(Level::Other(String::new()))
    }

    /// Whether what was found may be left out.
    pub(crate) fn is_optional(&self) -> bool {
        self.is_optional.get()
    }

    fn node<'b>(&'b self, steps: &'b [Step]) -> Node<'b> {
        Node { content: Content::Probe(self, steps), span: 0..0 }
    }

    /// Ends the reading.
    fn is(&self, level: Level) -> TomlError {
        self.found.borrow_mut().get_or_insert(level);
        TomlError::custom("a probe has come to its end")
    }

    fn expects(&self, what: &dyn Expected) -> TomlError {
        self.is(Level::Other(what.to_string()))
    }

    fn table<'b, V: Visitor<'b>>(
        &'b self,
        steps: &'b [Step],
        level: Level,
        visitor: V,
    ) -> Result<V::Value, TomlError> {
        let [Step::Key(key), steps @ ..] = steps else { return Err(self.is(level)) };
        let entry = (Node::text(key, 0..0), self.node(steps));
        visitor.visit_map(Entries(vec![entry].into_iter(), None))
    }
}

/// Lets a type be read from a probe.
pub(crate) fn trace<T: DeserializeOwned>(probe: &Probe<'_>) -> Option<TomlError> {
    T::deserialize(probe.node(probe.steps)).err()
}

type List<'a> = SeqDeserializer<std::vec::IntoIter<Node<'a>>, TomlError>;

impl<'de> IntoDeserializer<'de, TomlError> for Node<'de> {
    type Deserializer = Self;

    fn into_deserializer(self) -> Self {
        self
    }
}

fn list<'a>(items: &'a [toml::Spanned<DeValue<'a>>]) -> List<'a> {
    SeqDeserializer::new(items.iter().map(Node::of).collect::<Vec<_>>().into_iter())
}

fn placed(node: Node<'_>) -> List<'_> {
    let end = |place: usize| Node { content: Content::Unsigned(place as u64), span: 0..0 };
    SeqDeserializer::new(vec![end(node.span.start), end(node.span.end), node].into_iter())
}

struct Entries<'a>(std::vec::IntoIter<(Node<'a>, Node<'a>)>, Option<Node<'a>>);

impl<'a> Entries<'a> {
    fn of(table: &'a DeTable<'a>) -> Self {
        let entry = |(key, value): (&'a toml::Spanned<_>, _)| {
            let name: &'a std::borrow::Cow<'a, str> = key.get_ref();
            (Node::text(name, key.span()), Node::of(value))
        };
        Self(table.iter().map(entry).collect::<Vec<_>>().into_iter(), None)
    }
}

impl<'de> MapAccess<'de> for Entries<'de> {
    type Error = TomlError;

    fn next_key_seed<K: DeserializeSeed<'de>>(
        &mut self,
        seed: K,
    ) -> Result<Option<K::Value>, TomlError> {
        let Some((key, value)) = self.0.next() else { return Ok(None) };
        self.1 = Some(value);
        seed.deserialize(key).map(Some)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, TomlError> {
        let value = self.1.take().ok_or_else(|| TomlError::custom("a value without a key"))?;
        let span = value.span.clone();
        seed.deserialize(value).map_err(|error| error.within(span))
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.0.len())
    }
}

/// `"word"`, or `{ word = payload }`.
struct Variant<'a> {
    name: &'a str,
    span: Range<usize>,
    payload: Option<Node<'a>>,
}

impl<'a> Variant<'a> {
    fn payload(self, what: &dyn Expected) -> Result<Node<'a>, TomlError> {
        let alone = || TomlError::invalid_type(Unexpected::UnitVariant, what);
        self.payload.ok_or_else(|| alone().within(self.span))
    }
}

impl<'de> EnumAccess<'de> for Variant<'de> {
    type Error = TomlError;
    type Variant = Self;

    fn variant_seed<V: DeserializeSeed<'de>>(self, seed: V) -> Result<(V::Value, Self), TomlError> {
        let name = seed.deserialize(Node::text(self.name, self.span.clone()))?;
        Ok((name, self))
    }
}

impl<'de> VariantAccess<'de> for Variant<'de> {
    type Error = TomlError;

    fn unit_variant(self) -> Result<(), TomlError> {
        match self.payload {
            Some(Node { content: Content::Probe(probe, _), .. }) => Err(probe.is(Level::Nothing)),
            Some(Node { content: Content::List([]), .. }) | None => Ok(()),
            Some(Node { content: Content::Map(table), .. }) if table.is_empty() => Ok(()),
            Some(payload) => Err(payload.other_than(&"empty table")),
        }
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, TomlError> {
        seed.deserialize(self.payload(&"newtype variant")?)
    }

    fn tuple_variant<V: Visitor<'de>>(self, _: usize, visitor: V) -> Result<V::Value, TomlError> {
        self.payload(&"tuple variant")?.deserialize_seq(visitor)
    }

    fn struct_variant<V: Visitor<'de>>(
        self,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, TomlError> {
        let payload = self.payload(&"struct variant")?;
        if let Content::Probe(probe, steps) = payload.content {
            return probe.table(steps, Level::Keys(fields), visitor);
        }
        if let Content::Map(table) = payload.content {
            known_keys(table, fields)?;
        }
        payload.deserialize_map(visitor)
    }
}

/// A variant's unknown key is a mistake even where the enum does not say so.
fn known_keys(table: &DeTable<'_>, fields: &'static [&'static str]) -> Result<(), TomlError> {
    match table.keys().find(|key| !fields.contains(&key.get_ref().as_ref())) {
        None => Ok(()),
        Some(key) => {
            let error = TomlError::unknown_field(key.get_ref(), fields);
            Err(error.within(key.span()))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    #[derive(Debug, PartialEq, Deserialize)]
    #[serde(rename_all = "kebab-case")]
    enum Kind {
        Plain,
        Wrapped(f64),
        Named { radius: f64 },
    }

    #[derive(Debug, PartialEq, Deserialize)]
    #[serde(deny_unknown_fields)]
    struct File {
        name: Spanned<String>,
        kind: Kind,
        corner: Option<[f64; 3]>,
        #[serde(default)]
        rest: BTreeMap<String, toml::Value>,
    }

    /// The message, and the text that it underlines.
    fn complaint(text: &str) -> (String, &str) {
        let error = read_toml::<File>(text).unwrap_err();
        (error.message().to_owned(), &text[error.span().unwrap()])
    }

    #[test]
    fn every_kind_of_value_is_read() {
        let text = "name = 'a'\nkind = { named = { radius = 2 } }\ncorner = [1, 2.5, -inf]\n\
                    [rest]\nlist = [true, 0x10, { deep = 'word' }]";
        let file = read_toml::<File>(text).unwrap();
        assert_eq!((file.name.get_ref().as_str(), &text[file.name.span()]), ("a", "'a'"));
        assert_eq!(file.kind, Kind::Named { radius: 2.0 });
        assert_eq!(file.corner, Some([1.0, 2.5, f64::NEG_INFINITY]));
        assert_eq!(file.rest["list"].to_string(), "[true, 16, { deep = \"word\" }]");
        for (written, kind) in [("'plain'", Kind::Plain), ("{ wrapped = 3 }", Kind::Wrapped(3.0))] {
            let file = read_toml::<File>(&format!("name = ''\nkind = {written}")).unwrap();
            assert_eq!(file.kind, kind);
        }
    }

    #[test]
    fn what_stands_under_a_key_knows_its_place_in_the_whole_text() {
        let text = "other = 1\n[part]\nx = 'one'";
        let error = read_key::<BTreeMap<String, f64>>(text, "part").unwrap_err();
        assert_eq!(&text[error.span().unwrap()], "'one'");
        let missing = read_key::<f64>(text, "whole").unwrap_err();
        assert_eq!(missing.to_string(), "missing field `whole`");
    }

    /// What stands in a file after its name, what is said of it, and what that underlines.
    const COMPLAINTS: &str = r#"
kind = 'plane'                          | unknown variant `plane`, expected one of `plain`, `wrapped`, `named` | 'plane'
kind = 7                                | wanted string or table | 7
kind = { plain = 1, named = 2 }         | wanted exactly 1 element, more than 1 element | { plain = 1, named = 2 }
kind = 'wrapped'                        | invalid type: unit variant, expected newtype variant | 'wrapped'
kind = { named = { radios = 1 } }       | unknown field `radios`, expected `radius` | radios
kind = { wrapped = 1e999 }              | floating-point number overflowed | 1e999
kind = 'plain'; corner = [0, 'up', 0]   | invalid type: string "up", expected f64 | 'up'
kind = 'plain'; corner = [0, 1]         | invalid length 2, expected an array of length 3 | [0, 1]
kind = 'plain'; corner = 1979-05-27     | invalid type: date, expected an array of length 3 | 1979-05-27
kind = 'plain'; colour = 1              | unknown field `colour`, expected one of `name`, `kind`, `corner`, `rest` | colour
"#;

    #[test]
    fn a_complaint_underlines_what_it_is_about() {
        for row in COMPLAINTS.trim().lines() {
            let [rest, message, place] = row.split('|').map(str::trim).collect::<Vec<_>>()[..]
            else {
                panic!("{row}")
            };
            let text = format!("name = 'a'\n{}", rest.replace("; ", "\n"));
            assert_eq!(complaint(&text), (message.to_owned(), place));
        }
        assert_eq!(complaint("name = 'a'").0, "missing field `kind`");
    }
}
