//! `docs/ray-tree.schema.json` and the tables of `docs/ray-tree.md` are what the types say; `DURER_BLESS=1` writes them.
use std::{fs, path::PathBuf};

use serde_json::Value;

use super::Page;

const MARK: &str = "<!-- What follows is written by DURER_BLESS=1 cargo test -p durer schema -->\n";

fn docs(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../docs").join(name)
}

fn schema() -> Value {
    let mut schema = serde_json::to_value(schemars::schema_for!(Page)).expect("a schema");
    without_defaults(&mut schema);
    schema["title"] = "The page of a ray tree, version 1".into();
    schema
}

/// Defaults are for readers of old documents, and noise in a schema.
fn without_defaults(value: &mut Value) {
    match value {
        Value::Object(keys) => {
            let is_type =
                keys.contains_key("type") || keys.contains_key("$ref") || keys.contains_key("anyOf");
            if is_type {
                keys.remove("default");
            }
            keys.values_mut().for_each(without_defaults);
        }
        Value::Array(list) => list.iter_mut().for_each(without_defaults),
        _ => {}
    }
}

/// What a value of a key is.
fn type_of(value: &Value) -> String {
    if let Some(reference) = value["$ref"].as_str() {
        let name = reference.rsplit('/').next().expect("a name");
        return match name {
            "Number" | "Metres" => "number".to_owned(),
            name => format!("[{name}](#{})", name.to_lowercase()),
        };
    }
    if let Some(options) = value["anyOf"].as_array() {
        let names: Vec<String> = options.iter().map(type_of).collect();
        return names.join(" or ");
    }
    let one = |word: &str| match word {
        "array" => match value["maxItems"].as_u64() {
            Some(n) => format!("{n} x {}", type_of(&value["items"])),
            None => format!("list of {}", type_of(&value["items"])),
        },
        "boolean" => "true or false".to_owned(),
        "string" => "text".to_owned(),
        other => other.to_owned(),
    };
    match &value["type"] {
        Value::String(word) => one(word),
        Value::Array(words) => {
            let words: Vec<String> = words.iter().filter_map(Value::as_str).map(one).collect();
            words.join(" or ")
        }
        _ => "any".to_owned(),
    }
}

fn table(text: &mut String, name: &str, schema: &Value) {
    let doc = |value: &Value| value["description"].as_str().unwrap_or_default().replace('\n', " ");
    *text += &format!("\n## {name}\n\n{}\n\n| key | value | meaning |\n|---|---|---|\n", doc(schema));
    for (key, value) in schema["properties"].as_object().expect("keys") {
        assert!(!doc(value).is_empty(), "{name}.{key} has no documentation");
        *text += &format!("| `{key}` | {} | {} |\n", type_of(value), doc(value).replace('|', "\\|"));
    }
}

fn tables(schema: &Value) -> String {
    let mut text = String::new();
    table(&mut text, "Page", schema);
    let parts = schema["$defs"].as_object().expect("definitions");
    let order = ["Tree", "Node"];
    let first = order.iter().filter_map(|name| parts.get_key_value(*name));
    let rest = parts.iter().filter(|(name, _)| !order.contains(&name.as_str()));
    for (name, part) in first.chain(rest).filter(|(_, part)| part["properties"].is_object()) {
        table(&mut text, name, part);
    }
    text
}

#[test]
fn schema_and_documentation_are_those_of_the_types() {
    let schema = schema();
    let json = serde_json::to_string_pretty(&schema).expect("JSON") + "\n";
    let page = fs::read_to_string(docs("ray-tree.md")).expect("the documentation");
    let (head, _) = page.split_once(MARK).expect("the mark before the tables");
    let page_now = format!("{head}{MARK}{}", tables(&schema));
    if std::env::var_os("DURER_BLESS").is_some() {
        fs::write(docs("ray-tree.schema.json"), &json).expect("a schema");
        fs::write(docs("ray-tree.md"), &page_now).expect("a page");
        return;
    }
    assert_eq!(
        fs::read_to_string(docs("ray-tree.schema.json")).expect("a schema"),
        json,
        "DURER_BLESS=1 writes it"
    );
    assert_eq!(page, page_now, "DURER_BLESS=1 writes it");
}
