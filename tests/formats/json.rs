//! As much of JSON Schema as the fixture and `furnace schema` use; any other keyword is not understood, and that is said.

use regex_lite::Regex;
use serde_json::Value;

/// What is wrong with a value by a schema; `root` holds the definitions that it refers to.
pub fn complaint(value: &Value, schema: &Value, root: &Value) -> Option<String> {
    for (keyword, rule) in schema.as_object().unwrap() {
        let wrong = match keyword.as_str() {
            "$schema" | "$comment" | "$defs" | "title" | "description" | "then" => None,
            "type" => (!is_of_type(value, rule)).then(|| format!("{value} is no {rule}")),
            "enum" => (!rule.as_array().unwrap().contains(value))
                .then(|| format!("{value} is none of {rule}")),
            "required" => {
                let missing = rule.as_array().unwrap().iter();
                let mut missing = missing.filter(|key| value.get(key.as_str().unwrap()).is_none());
                missing.next().map(|key| format!("{key} is missing"))
            }
            "properties" => in_properties(value, rule, root),
            "additionalProperties" => in_others(value, &schema["properties"], rule, root),
            "const" => (value != rule).then(|| format!("{value} is not {rule}")),
            "minimum" => {
                let is_less = value.as_f64().is_some_and(|it| it < rule.as_f64().unwrap());
                is_less.then(|| format!("{value} is less than {rule}"))
            }
            "pattern" => {
                let pattern = Regex::new(rule.as_str().unwrap()).unwrap();
                let is_like = |text: &str| pattern.is_match(text);
                (!value.as_str().is_none_or(is_like)).then(|| format!("{value} is not like {rule}"))
            }
            "allOf" => rule.as_array().unwrap().iter().find_map(|all| complaint(value, all, root)),
            "anyOf" => {
                let ways = rule.as_array().unwrap().iter();
                let complaints: Option<Vec<_>> =
                    ways.map(|way| complaint(value, way, root)).collect();
                complaints.map(|complaints| complaints.join(", and "))
            }
            "if" => match complaint(value, rule, root) {
                None => complaint(value, &schema["then"], root),
                Some(_) => None,
            },
            "items" => value
                .as_array()
                .and_then(|items| items.iter().find_map(|item| complaint(item, rule, root))),
            "$ref" => {
                let pointer = rule.as_str().unwrap().trim_start_matches('#');
                complaint(value, root.pointer(pointer).unwrap(), root)
            }
            other => panic!("the schema says `{other}`, which is not understood"),
        };
        if wrong.is_some() {
            return wrong;
        }
    }
    None
}

fn in_properties(value: &Value, rules: &Value, root: &Value) -> Option<String> {
    let rules = rules.as_object().unwrap().iter();
    let mut complaints = rules.filter_map(|(key, rule)| {
        let wrong = complaint(value.get(key)?, rule, root)?;
        Some(format!("{key}: {wrong}"))
    });
    complaints.next()
}

/// What is wrong with the properties that have no rule of their own: the rule is theirs, or `false`.
fn in_others(value: &Value, known: &Value, rule: &Value, root: &Value) -> Option<String> {
    let mut others = value.as_object()?.iter().filter(|(key, _)| known.get(key.as_str()).is_none());
    match rule {
        Value::Bool(true) => None,
        Value::Bool(false) => others.next().map(|(key, _)| format!("`{key}` is not known")),
        rule => others.find_map(|(key, it)| Some(format!("{key}: {}", complaint(it, rule, root)?))),
    }
}

fn is_of_type(value: &Value, rule: &Value) -> bool {
    let is = |name: &Value| match name.as_str().unwrap() {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "number" => value.is_number(),
        "integer" => value.is_i64() || value.is_u64(),
        "boolean" => value.is_boolean(),
        "null" => value.is_null(),
        other => panic!("the schema says type `{other}`, which is not understood"),
    };
    rule.as_array().map_or_else(|| is(rule), |names| names.iter().any(is))
}

#[test]
fn wrong_values_are_found() {
    let schema = serde_json::json!({
        "type": "object", "additionalProperties": false, "required": ["a"],
        "properties": { "a": { "$ref": "#/$defs/word" }, "b": { "type": "array", "items": { "type": "number" } } },
        "$defs": { "word": { "enum": ["x", "y"] } }
    });
    let is_right = |value: Value| complaint(&value, &schema, &schema).is_none();
    assert!(is_right(serde_json::json!({ "a": "x", "b": [1, 2.5] })));
    for wrong in [
        serde_json::json!([]),
        serde_json::json!({}),
        serde_json::json!({ "a": "z" }),
        serde_json::json!({ "a": "x", "b": ["1"] }),
        serde_json::json!({ "a": "x", "c": 1 }),
    ] {
        assert!(!is_right(wrong.clone()), "{wrong}");
    }
    let schema = serde_json::json!({
        "type": "object", "additionalProperties": { "type": "integer", "minimum": 0 },
        "properties": { "way": { "anyOf": [{ "enum": ["up"] }, { "type": "string", "pattern": "^\\$" }] } },
        "allOf": [{ "if": { "properties": { "n": { "const": 1 } } }, "then": { "required": ["m"] } }]
    });
    let is_right = |value: Value| complaint(&value, &schema, &schema).is_none();
    assert!(is_right(serde_json::json!({ "way": "$up", "n": 2, "other": 3 })));
    for wrong in [
        serde_json::json!({ "way": "down", "n": 2 }),
        serde_json::json!({ "way": "up", "n": 1 }),
        serde_json::json!({ "way": "up", "n": 2, "other": -3 }),
        serde_json::json!({ "way": "up", "n": 2, "other": 0.5 }),
    ] {
        assert!(!is_right(wrong.clone()), "{wrong}");
    }
}
