//! Elements that are parameters: numbers, words, colours, spectra, transforms.
use durer_core::glam::DAffine3;
use durer_scene::Assets;
use roxmltree::Node;

use super::{
    object::{Prop, Value},
    reader::{Place, Reader},
    transform, upgrade,
    value::{self, told},
};

impl Reader<'_> {
    /// A parameter.
    pub(super) fn prop(&mut self, node: Node<'_, '_>, place: Place) -> Option<Prop> {
        let tag = node.tag_name().name();
        let name = self.needed(node, "name", place)?;
        let name = if place.old { upgrade::name(&name) } else { name };
        let at = match node.attribute_node("value").or(node.attribute_node("name")) {
            Some(attribute) => place.value(&attribute),
            None => place.tag(node),
        };
        let parsed = match tag {
            "transform" => {
                return self.transform(node, place).map(|t| Prop { name, value: Value::Transform(t), at });
            }
            "point" | "vector" => {
                self.attributes(node, &["name", "value", "x", "y", "z"], place);
                transform::step("translate", |a| self.attribute(node, a))
                    .map(|t| Value::Triple(t.translation.into()))
            }
            "spectrum" => {
                self.attributes(node, &["name", "value", "filename", "intent"], place);
                match self.optional(node, "filename", place) {
                    Some(file) => self.spectrum_file(&file),
                    None => value::spectrum(&self.needed(node, "value", place)?),
                }
            }
            _ => {
                self.attributes(node, &["name", "value", "intent"], place);
                let text = self.needed(node, "value", place)?;
                match tag {
                    "float" => value::number(&text).map(Value::Number),
                    "integer" => match value::number(&text) {
                        Ok(v) if v.fract() == 0.0 => Ok(Value::Number(v)),
                        _ => Err(format!("expected a whole number, found \"{text}\"")),
                    },
                    "boolean" => value::truth(&text).map(Value::Truth),
                    "rgb" | "srgb" => value::color(&text, tag == "srgb").map(Value::Color),
                    _ => Ok(Value::Text(text)),
                }
            }
        };
        Some(Prop { name, value: told(parsed, at, self.said)?, at })
    }

    fn spectrum_file(&self, file: &str) -> Result<Value, String> {
        let bytes = self.assets.bytes(&self.found(file)).map_err(|e| e.to_string())?;
        value::spectrum_file(&String::from_utf8_lossy(&bytes)).map_err(|why| format!("{file}: {why}"))
    }

    fn transform(&mut self, node: Node<'_, '_>, place: Place) -> Option<DAffine3> {
        self.attributes(node, &["name"], place);
        let mut all = DAffine3::IDENTITY;
        for inner in node.children().filter(Node::is_element) {
            let word = inner.tag_name().name();
            // 0.x wrote lookAt.
            let step = if word == "lookAt" { "lookat" } else { word };
            if !transform::STEPS.contains(&step) {
                self.said.unknown(place.tag(inner), "step of a transform", word, transform::STEPS);
                return None;
            }
            let known: &[&str] = match step {
                "lookat" => &["origin", "target", "up"],
                "matrix" => &["value"],
                "rotate" => &["value", "x", "y", "z", "angle"],
                _ => &["value", "x", "y", "z"],
            };
            self.attributes(inner, known, place);
            let parsed = transform::step(step, |a| self.attribute(inner, a));
            all = told(parsed, place.tag(inner), self.said)? * all;
        }
        if !all.is_finite() || all.matrix3.determinant() == 0.0 {
            self.said.error(place.tag(node), "this transform makes everything flat");
            return None;
        }
        Some(all)
    }
}
