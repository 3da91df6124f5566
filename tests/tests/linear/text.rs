//! pbrt scenes with many of one thing.
use std::fmt::Write;

use super::{Case, alone, model::grid};

/// A light of its own, so that none is made up.
const BEGIN: &str = "WorldBegin\nLightSource \"point\"\n";

pub(crate) fn cases() -> Vec<Case> {
    let case = |name, size, write| Case { name, suffix: "pbrt", size, write };
    vec![
        case("pbrt, shapes", 2000, |n| {
            alone(scene(n, |i| format!("Shape \"sphere\" \"float radius\" {}\n", i + 1)))
        }),
        case("pbrt, nested blocks of attributes", 3000, |n| {
            let block = "AttributeBegin\nAttributeBegin\nTranslate 1 0 0\nAttributeEnd\nAttributeEnd\n";
            alone(scene(n, |_| block.to_owned()) + "Shape \"sphere\"\n")
        }),
        case("pbrt, instances", 2000, |n| {
            let object = "ObjectBegin \"a\"\nShape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \
                          \"integer indices\" [0 1 2]\nObjectEnd\n";
            alone(scene(n, |i| {
                let object = if i == 0 { object } else { "" };
                format!("{object}Translate 2 0 0\nObjectInstance \"a\"\n")
            }))
        }),
        case("pbrt, objects", 2000, |n| {
            alone(scene(n, |i| {
                format!(
                    "ObjectBegin \"object {i}\"\nShape \"sphere\"\nObjectEnd\nTranslate 2 0 0\n\
                     ObjectInstance \"object {i}\"\n"
                )
            }))
        }),
        case("pbrt, materials", 2000, |n| {
            alone(scene(n, |i| {
                format!(
                    "MakeNamedMaterial \"material {i}\" \"string type\" \"diffuse\"\nNamedMaterial \"material {i}\"\n\
                     Shape \"sphere\"\n"
                )
            }))
        }),
        case("pbrt, textures", 2000, |n| {
            alone(scene(n, |i| {
                format!(
                    "Texture \"texture {i}\" \"spectrum\" \"constant\" \"rgb value\" [1 0 0]\n\
                     Material \"diffuse\" \"texture reflectance\" \"texture {i}\"\nShape \"sphere\"\n"
                )
            }))
        }),
        case("pbrt, lights", 2000, |n| {
            alone(scene(n, |_| "LightSource \"point\"\n".to_owned()) + "Shape \"sphere\"\n")
        }),
        case("pbrt, triangles of a mesh", 8000, |n| {
            let mesh = grid(n);
            let mut text = format!("{BEGIN}Shape \"trianglemesh\" \"point3 P\" [");
            mesh.points.iter().flatten().for_each(|v| write!(text, "{v} ").expect("text"));
            text.push_str("] \"integer indices\" [");
            mesh.triangles.iter().flatten().for_each(|v| write!(text, "{v} ").expect("text"));
            text.push_str("]\n");
            alone(text)
        }),
    ]
}

fn scene(n: usize, part: impl Fn(usize) -> String) -> String {
    (0..n).fold(BEGIN.to_owned(), |text, i| text + &part(i))
}
