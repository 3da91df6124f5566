//! `docs/reference.md` is generated from the registries: it cannot be out of date. `DURER_BLESS=1` writes it anew.
use std::{fmt::Write, path::Path};

use durer::{
    integrator::INTEGRATORS,
    model::{
        camera::CAMERAS,
        filter::FILTERS,
        light::{AREA_LIGHTS, LIGHTS},
        material::MATERIALS,
        shape::SHAPES,
        texture::{COLOR_TEXTURES, FLOAT_TEXTURES},
    },
    scene::{Entry, ParamDefault, ParamSpec, ParamType, Schema},
};

fn schemas<T>(registry: &[Entry<T>]) -> Vec<Schema> {
    registry.iter().map(|e| e.schema).collect()
}

fn default_text(spec: &ParamSpec) -> String {
    match spec.default {
        ParamDefault::Required => "required".to_owned(),
        ParamDefault::Unset => "see left".to_owned(),
        ParamDefault::Bool(v) => v.to_string(),
        ParamDefault::Int(v) => v.to_string(),
        ParamDefault::Float(v) => v.to_string(),
        ParamDefault::Triple([x, y, z]) => format!("{x} {y} {z}"),
        ParamDefault::Text(v) => format!("`{v}`"),
    }
}

fn type_text(spec: &ParamSpec) -> String {
    if let ParamType::Choice(words) = spec.ty {
        return words.iter().map(|w| format!("`{w}`")).collect::<Vec<_>>().join(", ");
    }
    let words: Vec<_> = spec.ty.accepts().iter().map(|t| t.word()).collect();
    words.join(" or ") + if spec.ty.is_list() { ", any number" } else { "" }
}

fn range_text(spec: &ParamSpec) -> String {
    let unit = if spec.unit.is_empty() { String::new() } else { format!(" {}", spec.unit) };
    match spec.range {
        (f32::NEG_INFINITY, f32::INFINITY) => unit.trim().to_owned(),
        (min, f32::INFINITY) if spec.open => format!("> {min}{unit}"),
        (min, f32::INFINITY) => format!("≥ {min}{unit}"),
        (f32::NEG_INFINITY, max) => format!("≤ {max}{unit}"),
        (min, max) if spec.open => format!("> {min}, ≤ {max}{unit}"),
        (min, max) => format!("{min} to {max}{unit}"),
    }
}

fn page() -> String {
    let mut out = String::from(
        "# Kinds and their parameters\n\nGenerated from the registries by `DURER_BLESS=1 cargo test -p durer-tests --test \
         reference`; do not edit. The language around them is described in [pbrt-language.md](pbrt-language.md).\n",
    );
    let families = [
        ("Shape", schemas(SHAPES)),
        ("Material", schemas(MATERIALS)),
        ("Texture (spectrum)", schemas(COLOR_TEXTURES)),
        ("Texture (float)", schemas(FLOAT_TEXTURES)),
        ("LightSource", schemas(LIGHTS)),
        ("AreaLightSource", schemas(AREA_LIGHTS)),
        ("Camera", schemas(CAMERAS)),
        ("PixelFilter", schemas(FILTERS)),
        ("Integrator", schemas(INTEGRATORS)),
    ];
    for (directive, schemas) in families {
        let _ = write!(out, "\n## {directive}\n");
        for schema in schemas {
            let _ = write!(out, "\n### `{}`\n\n{}\n", schema.name, schema.doc);
            if !schema.aliases.is_empty() {
                let _ = write!(out, "\nAlso called: {}.\n", schema.aliases.join(", "));
            }
            if schema.params.is_empty() {
                continue;
            }
            out += "\n| parameter | type | default | range, unit | meaning |\n|---|---|---|---|---|\n";
            for p in schema.params {
                let row =
                    [format!("`{}`", p.name), type_text(p), default_text(p), range_text(p), p.doc.to_owned()];
                let _ = writeln!(out, "| {} |", row.join(" | "));
            }
        }
    }
    out
}

#[test]
fn the_reference_page_matches_the_registries() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/reference.md");
    let page = page();
    if std::env::var_os("DURER_BLESS").is_some() {
        std::fs::write(&path, &page).expect("docs/reference.md can be written");
    }
    let found = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(found == page, "docs/reference.md is out of date: run this test with DURER_BLESS=1");
}

#[test]
fn no_two_kinds_of_a_family_answer_to_the_same_word() {
    for family in [
        schemas(SHAPES),
        schemas(MATERIALS),
        schemas(COLOR_TEXTURES),
        schemas(FLOAT_TEXTURES),
        schemas(LIGHTS),
        schemas(AREA_LIGHTS),
        schemas(CAMERAS),
        schemas(FILTERS),
    ] {
        let mut words: Vec<_> = family.iter().flat_map(|s| s.aliases.iter().chain([&s.name])).collect();
        let all = words.len();
        words.sort();
        words.dedup();
        assert_eq!(words.len(), all);
        for schema in family {
            assert!(
                !schema.doc.is_empty() && schema.params.iter().all(|p| !p.doc.is_empty()),
                "{}",
                schema.name
            );
        }
    }
}
