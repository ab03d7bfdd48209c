//! What a type can be read from, found out by reading: each key is asked for what it would take, and answers in the very
//! code that reads files. So a schema knows the keys that a file may have, and no list has to be kept beside the types.

use super::document::{Level, Probe, Step, TomlError};
use serde_json::{Map, Value, json};

/// Tables within tables that are followed; files have six at most.
const DEEPEST: usize = 12;

/// Reads a type from a probe, which notes what is asked of it. Written by [`super::document::trace`].
pub(crate) type Trace = fn(&Probe<'_>) -> Option<TomlError>;

/// What may stand in the place of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Instead {
    /// Only what is read.
    Nothing,
    /// `"$name"`, a parameter of a scene.
    Parameter,
    /// `null`, where a value is optional.
    Null,
}

/// The JSON Schema of what `trace` reads.
pub(crate) fn of(trace: Trace, instead: Instead) -> Value {
    Tracer { trace, instead }.at(&mut Vec::new())
}

struct Tracer {
    trace: Trace,
    instead: Instead,
}

impl Tracer {
    fn at(&self, path: &mut Vec<Step>) -> Value {
        if path.len() > DEEPEST {
            return json!({});
        }
        let probe = Probe::new(path);
        let _ = (self.trace)(&probe);
        let is_optional = probe.is_optional();
        let schema = match probe.found() {
            Level::Keys(keys) => self.table(keys, path),
            Level::Map => {
                json!({ "type": "object", "additionalProperties": self.below(path, Step::Key("any")) })
            }
            Level::List => json!({ "type": "array", "items": self.below(path, Step::Item) }),
            Level::Variants(words) => self.variants(words, path),
            Level::Text => json!({ "type": "string" }),
            Level::Nothing => return Value::Null,
            Level::Other(expected) => other(&expected),
        };
        match self.instead {
            Instead::Parameter if !path.is_empty() => {
                json!({ "anyOf": [schema, { "type": "string", "pattern": "^\\$" }] })
            }
            Instead::Null if is_optional => json!({ "anyOf": [schema, { "type": "null" }] }),
            _ => schema,
        }
    }

    fn below(&self, path: &mut Vec<Step>, step: Step) -> Value {
        path.push(step);
        let schema = self.at(path);
        path.pop();
        schema
    }

    fn table(&self, keys: &'static [&'static str], path: &mut Vec<Step>) -> Value {
        let entry = |&key: &&'static str| (key.to_owned(), self.below(path, Step::Key(key)));
        let properties: Map<_, _> = keys.iter().map(entry).collect();
        json!({ "type": "object", "properties": properties, "additionalProperties": false })
    }

    /// A word, or a table with one key and what belongs to it.
    fn variants(&self, words: &'static [&'static str], path: &mut Vec<Step>) -> Value {
        let (mut alone, mut with) = (Vec::new(), Vec::new());
        for word in words {
            match self.below(path, Step::Key(word)) {
                Value::Null => alone.push(*word),
                payload => with.push(json!({
                    "type": "object",
                    "properties": { (*word): payload },
                    "required": [*word],
                    "additionalProperties": false,
                })),
            }
        }
        if with.is_empty() {
            return json!({ "enum": alone });
        }
        if !alone.is_empty() {
            with.push(json!({ "enum": alone }));
        }
        json!({ "anyOf": with })
    }
}

/// What reads any value says in words what it expects; of plain numbers those are their types.
fn other(expected: &str) -> Value {
    match expected {
        "a boolean" => json!({ "type": "boolean" }),
        "a string" => json!({ "type": "string" }),
        "f32" | "f64" => json!({ "type": "number" }),
        "u8" | "u16" | "u32" | "u64" | "usize" => json!({ "type": "integer", "minimum": 0 }),
        "i8" | "i16" | "i32" | "i64" | "isize" => json!({ "type": "integer" }),
        "" => json!({}),
        words => json!({ "description": words }),
    }
}

#[cfg(test)]
mod tests {
    use super::super::document::trace;
    use super::*;
    use crate::text::{Angle, Spanned};
    use serde::Deserialize;
    use std::collections::BTreeMap;

    #[derive(Deserialize)]
    #[serde(deny_unknown_fields, rename_all = "kebab-case")]
    #[expect(dead_code, reason = "only its shape counts")]
    struct File {
        is_on: bool,
        #[serde(default)]
        rows: Vec<Spanned<Row>>,
        by_name: BTreeMap<String, f64>,
        way: Option<Way>,
        angle: Angle,
    }

    #[derive(Deserialize)]
    #[serde(deny_unknown_fields)]
    #[expect(dead_code, reason = "only its shape counts")]
    struct Row {
        count: u32,
    }

    #[derive(Deserialize)]
    #[serde(rename_all = "kebab-case")]
    #[expect(dead_code, reason = "only its shape counts")]
    enum Way {
        ByHand,
        By(String),
    }

    #[test]
    fn a_type_tells_its_keys_and_what_they_hold() {
        let schema = of(trace::<File>, Instead::Nothing);
        assert_eq!(schema["additionalProperties"], false);
        let at = |key: &str| &schema["properties"][key];
        assert_eq!(at("is-on")["type"], "boolean");
        assert_eq!(at("rows")["items"]["properties"]["count"]["type"], "integer");
        assert_eq!(at("rows")["items"]["additionalProperties"], false);
        assert_eq!(at("by-name")["additionalProperties"]["type"], "number");
        let by = json!({ "type": "string" });
        assert_eq!(at("way")["anyOf"][0]["properties"]["by"], by);
        assert_eq!(at("way")["anyOf"][1]["enum"], json!(["by-hand"]));
        assert!(at("angle")["description"].as_str().unwrap().contains("deg"), "{schema}");
    }

    #[test]
    fn a_parameter_or_null_may_stand_where_they_may() {
        let parameters = of(trace::<File>, Instead::Parameter);
        assert_eq!(parameters["properties"]["is-on"]["anyOf"][1]["pattern"], "^\\$");
        let nulls = of(trace::<File>, Instead::Null);
        assert_eq!(nulls["properties"]["way"]["anyOf"][1]["type"], "null");
        assert_eq!(nulls["properties"]["is-on"]["type"], "boolean");
    }
}
