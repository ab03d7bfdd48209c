//! As much of JSON Schema as the fixture uses; a keyword that is not known is a mistake of the fixture.

use serde_json::Value;

/// What is wrong with a value by a schema; `root` holds the definitions that it refers to.
pub fn complaint(value: &Value, schema: &Value, root: &Value) -> Option<String> {
    for (keyword, rule) in schema.as_object().unwrap() {
        let wrong = match keyword.as_str() {
            "$schema" | "$comment" | "$defs" | "title" => None,
            "type" => (!is_of_type(value, rule)).then(|| format!("{value} is no {rule}")),
            "enum" => (!rule.as_array().unwrap().contains(value))
                .then(|| format!("{value} is none of {rule}")),
            "required" => {
                let missing = rule.as_array().unwrap().iter();
                let mut missing = missing.filter(|key| value.get(key.as_str().unwrap()).is_none());
                missing.next().map(|key| format!("{key} is missing"))
            }
            "properties" => in_properties(value, rule, root),
            "additionalProperties" => unknown_key(value, &schema["properties"]),
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

fn unknown_key(value: &Value, known: &Value) -> Option<String> {
    let mut keys = value.as_object()?.keys();
    keys.find(|key| known.get(key.as_str()).is_none()).map(|key| format!("`{key}` is not known"))
}

fn is_of_type(value: &Value, rule: &Value) -> bool {
    let is = |name: &Value| match name.as_str().unwrap() {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "number" => value.is_number(),
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
}
