//! What the XML of a scene says: objects of plugins, with parameters and with other objects in them.
use std::rc::Rc;

use durer_core::glam::DAffine3;
use durer_scene::{Diagnostics, Span};

/// A value that stands in the file.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Value {
    /// Of `float` and `integer`.
    Number(f64),
    /// Of `boolean`.
    Truth(bool),
    /// Of `string`.
    Text(String),
    /// Of `point` and `vector`.
    Triple([f64; 3]),
    /// Of `rgb`: linear Rec. 709.
    Color([f32; 3]),
    /// Of `spectrum`: the same at all wavelengths.
    Even(f32),
    /// Of `spectrum`: wavelength in nm and value in turn.
    Curve(Vec<f32>),
    /// Of `transform`.
    Transform(DAffine3),
}

impl Value {
    /// For messages.
    pub(super) fn word(&self) -> &'static str {
        match self {
            Self::Number(_) => "a number",
            Self::Truth(_) => "a truth value",
            Self::Text(_) => "a string",
            Self::Triple(_) => "a point or vector",
            Self::Color(_) => "a colour",
            Self::Even(_) | Self::Curve(_) => "a spectrum",
            Self::Transform(_) => "a transform",
        }
    }
}

/// A parameter.
#[derive(Clone, Debug)]
pub(super) struct Prop {
    /// As Mitsuba 3 calls it.
    pub(super) name: String,
    pub(super) value: Value,
    pub(super) at: Span,
}

/// An object within another, or the name of one.
#[derive(Clone, Debug)]
pub(super) struct Child {
    /// The parameter it is for; empty where its kind says so.
    pub(super) name: String,
    pub(super) what: What,
    pub(super) at: Span,
}

/// See [`Child`].
#[derive(Clone, Debug)]
pub(super) enum What {
    /// It stands there.
    Object(Rc<Object>),
    /// It has this `id`.
    Ref(String),
}

/// An instance of a plugin.
#[derive(Clone, Debug)]
pub(super) struct Object {
    /// The element: `shape`, `bsdf`, ...
    pub(super) tag: String,
    /// Its `type`.
    pub(super) plugin: String,
    /// Its `id`; may be empty.
    pub(super) id: String,
    /// Where the plugin is named.
    pub(super) at: Span,
    pub(super) props: Vec<Prop>,
    pub(super) children: Vec<Child>,
}

impl Object {
    /// The parameter `name`.
    pub(super) fn get(&self, name: &str) -> Option<&Prop> {
        self.props.iter().find(|p| p.name == name)
    }
    /// For messages: `bsdf "plastic"`.
    pub(super) fn shown(&self) -> String {
        format!("{} \"{}\"", self.tag, self.plugin)
    }
    fn wrong(&self, name: &str, expected: &str, said: &mut Diagnostics) {
        if let Some(prop) = self.get(name) {
            let found = prop.value.word();
            said.error(prop.at, format!("\"{name}\" is {found}, expected {expected}"));
        }
    }
    /// A number, if it is given.
    pub(super) fn number(&self, name: &str, said: &mut Diagnostics) -> Option<f64> {
        match self.get(name)?.value {
            Value::Number(v) => return Some(v),
            Value::Even(v) => return Some(v.into()),
            _ => self.wrong(name, "a number", said),
        }
        None
    }
    /// A number.
    pub(super) fn number_or(&self, name: &str, usual: f64, said: &mut Diagnostics) -> f64 {
        self.number(name, said).unwrap_or(usual)
    }
    /// A truth value.
    pub(super) fn truth(&self, name: &str, usual: bool, said: &mut Diagnostics) -> bool {
        match self.get(name).map(|p| &p.value) {
            Some(Value::Truth(v)) => return *v,
            Some(_) => self.wrong(name, "a truth value", said),
            None => {}
        }
        usual
    }
    /// A string, if it is given.
    pub(super) fn text(&self, name: &str, said: &mut Diagnostics) -> Option<&str> {
        match &self.get(name)?.value {
            Value::Text(v) => return Some(v),
            _ => self.wrong(name, "a string", said),
        }
        None
    }
    /// One of some words, the first if it is not given; complains about others.
    pub(super) fn word(&self, name: &str, words: &[&'static str], said: &mut Diagnostics) -> &'static str {
        let usual = words.first().copied().unwrap_or_default();
        let Some(text) = self.text(name, said) else { return usual };
        let lower = text.to_lowercase();
        if let Some(word) = words.iter().find(|w| **w == lower) {
            return word;
        }
        let at = self.get(name).map_or(self.at, |p| p.at);
        said.unknown(at, &format!("\"{name}\""), text, words.iter().copied());
        usual
    }
    /// A point or vector, if it is given.
    pub(super) fn triple(&self, name: &str, said: &mut Diagnostics) -> Option<[f64; 3]> {
        match self.get(name)?.value {
            Value::Triple(v) => return Some(v),
            _ => self.wrong(name, "a point or vector", said),
        }
        None
    }
    /// A transform; the identity if it is not given.
    pub(super) fn transform(&self, name: &str, said: &mut Diagnostics) -> DAffine3 {
        match self.get(name).map(|p| &p.value) {
            Some(Value::Transform(t)) => return *t,
            Some(_) => self.wrong(name, "a transform", said),
            None => {}
        }
        DAffine3::IDENTITY
    }
}
