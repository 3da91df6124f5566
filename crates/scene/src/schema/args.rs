//! Checked access to the parameters of a node.
mod nested;
mod voxels;

use std::sync::Arc;

use super::{ParamDefault, ParamSpec, ParamType, Schema, TextureNames};
use crate::{
    AssetError, Assets, Data, Diagnostics, Image, Location, Mesh, NamedNode, Node, Param, TextureDesc,
    TextureValue, ValueType,
};

/// A number, or the index of the float texture that gives it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FloatInput {
    /// The same everywhere.
    Constant(f32),
    /// Index in [`crate::SceneDesc::textures`].
    Texture(u32),
}

/// What becomes of an image or mesh that is missing or damaged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Missing {
    /// An error: no picture.
    #[default]
    Refuse,
    /// A warning, and `None` where the file was asked for: the kind shows a placeholder.
    Warn,
}

/// The parameters of one node, checked against a schema; what [`super::Kind::build`] reads.
pub struct Args<'a> {
    node: &'a Node,
    schema: Schema,
    textures: &'a [TextureDesc],
    names: Option<&'a TextureNames<'a>>,
    /// Nodes that parameters may name; those described before this one.
    before: &'a [NamedNode],
    /// How many nodes that name others lead here.
    nested: u32,
    diagnostics: &'a mut Diagnostics,
    assets: Option<(&'a dyn Assets, Missing)>,
    sound: bool,
}

impl<'a> Args<'a> {
    /// Checks `node` against `schema`: every parameter known, well-typed and in range, none required missing.
    pub fn check(
        node: &'a Node,
        schema: Schema,
        textures: &'a [TextureDesc],
        diagnostics: &'a mut Diagnostics,
    ) -> Self {
        let mut args = Self {
            node,
            schema,
            textures,
            names: None,
            before: &[],
            nested: 0,
            diagnostics,
            assets: None,
            sound: true,
        };
        for param in node.params.iter() {
            match schema.params.iter().find(|s| s.name == param.name) {
                Some(spec) => args.check_param(param, spec),
                None => {
                    args.sound = false;
                    let what = format!("parameter of {}", schema.name);
                    let names = schema.params.iter().map(|s| s.name);
                    args.diagnostics.unknown(param.at.clone(), &what, &param.name, names);
                }
            }
        }
        for spec in schema.params.iter().filter(|s| s.default == ParamDefault::Required) {
            if node.params.get(spec.name).is_none() {
                let ty = spec.ty.accepts().first().map_or("", |t| t.word());
                let message = format!("{} needs the parameter \"{ty} {}\"", schema.name, spec.name);
                args.error_at(node.at.clone(), message).hint(spec.doc);
            }
        }
        args
    }

    /// The same, with the names of a list that begins with these textures: they are found faster.
    #[must_use]
    pub fn with_names(mut self, names: &'a TextureNames<'a>) -> Self {
        self.names = Some(names);
        self
    }

    /// The same, with the nodes that a node of a family may name: those described before it.
    #[must_use]
    pub fn with_before(mut self, before: &'a [NamedNode]) -> Self {
        self.before = before;
        self
    }

    /// The same, with files at hand.
    #[must_use]
    pub fn with_assets(mut self, assets: &'a dyn Assets, missing: Missing) -> Self {
        self.assets = Some((assets, missing));
        self
    }

    pub(super) fn error_at(&mut self, at: Location, message: String) -> &mut crate::Diagnostic {
        self.sound = false;
        self.diagnostics.error(at, message)
    }

    fn check_param(&mut self, param: &Param, spec: &ParamSpec) {
        let name = &param.name;
        if !spec.ty.accepts().contains(&param.ty) {
            let wanted: Vec<_> = spec.ty.accepts().iter().map(|t| t.word()).collect();
            let message =
                format!("\"{name}\" is declared {}, expected {}", param.ty.word(), wanted.join(" or "));
            self.error_at(param.at.clone(), message);
            return;
        }
        let named = matches!(param.data, Data::Strings(_));
        let arity = if named { 1 } else { param.ty.arity() };
        let count = param.data.len();
        let fits = match param.ty {
            ValueType::Spectrum if !named => count > 0 && count.is_multiple_of(2),
            _ if spec.ty.is_list() => count.is_multiple_of(arity),
            _ => count == arity,
        };
        if !fits {
            let wanted = if spec.ty.is_list() { format!("a multiple of {arity}") } else { arity.to_string() };
            self.error_at(
                param.at.clone(),
                format!("\"{name}\" has {}, expected {wanted}", crate::counted(count, "value")),
            );
            return;
        }
        match &param.data {
            Data::Floats(values) => {
                // Of an index given as a spectrum, the one value that is taken from it is checked.
                let spectrum = param.ty == ValueType::Spectrum && spec.ty == ParamType::Index;
                let wrong = |v: &&f32| !(spec.allows(**v) && v.is_finite());
                if let Some(v) = values.iter().find(wrong).filter(|_| !spectrum) {
                    let message = format!("\"{name}\" is {v}, expected {}", spec.expected());
                    self.error_at(param.at.clone(), message);
                }
            }
            Data::Ints(values) => {
                if let Some(v) = values.iter().find(|v| !spec.allows(**v as f32)) {
                    let message = format!("\"{name}\" is {v}, expected {}", spec.expected());
                    self.error_at(param.at.clone(), message);
                }
            }
            Data::Strings(values) => {
                if let (ParamType::Choice(words), Some(word)) = (spec.ty, values.first())
                    && !words.contains(&word.as_str())
                {
                    self.sound = false;
                    self.diagnostics.unknown(param.at.clone(), name, word, words.iter().copied());
                }
            }
            Data::Bools(_) => {}
        }
    }

    /// False if a parameter was wrong: the kind is then not built.
    pub fn is_sound(&self) -> bool {
        self.sound
    }

    /// Where the node was named, for complaints that concern no single parameter.
    pub fn at(&self) -> Location {
        self.node.at.clone()
    }

    /// Where parameter `name` was written; where the node was, if no text names it.
    fn place(&self, name: &str) -> Location {
        let own = self.node.params.get(name).map(|param| param.at.clone());
        own.filter(|at| *at != Location::None).unwrap_or_else(|| self.node.at.clone())
    }

    /// Complains about parameter `name`, or about the node if it is not given.
    pub fn error(&mut self, name: &str, message: impl Into<String>) {
        let at = self.place(name);
        self.error_at(at, message.into());
    }

    /// Complains that the text of parameter `name` is none of `known`; `what` is what messages call it.
    pub fn unknown(&mut self, name: &str, what: &str, known: impl IntoIterator<Item = &'static str>) {
        self.sound = false;
        let at = self.place(name);
        self.diagnostics.unknown(at, what, self.text(name), known);
    }

    /// Warns about parameter `name`, or about the node if it is not given.
    pub fn warning(&mut self, name: &str, message: impl Into<String>) {
        let at = self.place(name);
        self.diagnostics.warning(at, message);
    }

    /// True if the file gives the parameter.
    pub fn is_set(&self, name: &str) -> bool {
        self.node.params.get(name).is_some()
    }

    pub(super) fn spec(&self, name: &str) -> Option<&'static ParamSpec> {
        let spec = self.schema.params.iter().find(|s| s.name == name);
        debug_assert!(spec.is_some(), "{} has no parameter {name}", self.schema.name);
        spec
    }

    pub(super) fn default(&self, name: &str) -> ParamDefault {
        self.spec(name).map_or(ParamDefault::Unset, |s| s.default)
    }

    fn floats_of(&self, name: &str) -> Option<&'a [f32]> {
        match &self.node.params.get(name)?.data {
            Data::Floats(v) => Some(v),
            _ => None,
        }
    }

    fn string_of(&self, name: &str) -> Option<&'a str> {
        match &self.node.params.get(name)?.data {
            Data::Strings(v) => v.first().map(String::as_str),
            _ => None,
        }
    }

    /// A truth value.
    pub fn bool(&self, name: &str) -> bool {
        match (self.node.params.get(name).map(|p| &p.data), self.default(name)) {
            (Some(Data::Bools(v)), _) => v.first().copied().unwrap_or(false),
            (_, ParamDefault::Bool(v)) => v,
            _ => false,
        }
    }
    /// A whole number.
    pub fn int(&self, name: &str) -> i32 {
        match (self.ints(name).first(), self.default(name)) {
            (Some(v), _) => *v,
            (_, ParamDefault::Int(v)) => v,
            _ => 0,
        }
    }
    /// A number.
    pub fn float(&self, name: &str) -> f32 {
        match (self.floats_of(name).and_then(|v| v.first()), self.default(name)) {
            (Some(v), _) => *v,
            (_, ParamDefault::Float(v)) => v,
            _ => 0.0,
        }
    }
    /// A number that may be left out.
    pub fn optional_float(&self, name: &str) -> Option<f32> {
        self.floats_of(name).and_then(|v| v.first()).copied()
    }
    /// Three numbers: a point or vector.
    pub fn triple(&self, name: &str) -> [f32; 3] {
        match (self.floats_of(name), self.default(name)) {
            (Some([x, y, z, ..]), _) => [*x, *y, *z],
            (_, ParamDefault::Triple(v)) => v,
            _ => [0.0; 3],
        }
    }
    /// Whole numbers; empty if left out.
    pub fn ints(&self, name: &str) -> &'a [i32] {
        match self.node.params.get(name).map(|p| &p.data) {
            Some(Data::Ints(v)) => v,
            _ => &[],
        }
    }
    /// Numbers, flattened; empty if left out.
    pub fn floats(&self, name: &str) -> &'a [f32] {
        self.floats_of(name).unwrap_or(&[])
    }
    /// Positions, vectors or normals; empty if left out.
    pub fn triples(&self, name: &str) -> Vec<[f32; 3]> {
        self.floats(name).as_chunks::<3>().0.to_vec()
    }
    /// 2D points; empty if left out.
    pub fn pairs(&self, name: &str) -> Vec<[f32; 2]> {
        self.floats(name).as_chunks::<2>().0.to_vec()
    }
    /// Texts; empty if left out.
    pub fn texts(&self, name: &str) -> &'a [String] {
        match self.node.params.get(name).map(|p| &p.data) {
            Some(Data::Strings(v)) => v,
            _ => &[],
        }
    }
    /// A text, choice or path; empty if left out without default.
    pub fn text(&self, name: &str) -> &'a str {
        match (self.string_of(name), self.default(name)) {
            (Some(v), _) => v,
            (_, ParamDefault::Text(v)) => v,
            _ => "",
        }
    }
    /// A number or a float texture; complains about a texture that does not exist.
    pub fn float_input(&mut self, name: &str) -> FloatInput {
        match self.node.params.get(name) {
            Some(param @ Param { ty: ValueType::Texture, data: Data::Strings(v), .. }) => self
                .texture(param, v, TextureValue::Float)
                .map_or(FloatInput::Constant(0.0), FloatInput::Texture),
            _ => FloatInput::Constant(self.float(name)),
        }
    }

    /// The image that a [`ParamType::File`] names; `None` if it cannot be had, which was then complained about.
    pub fn image(&mut self, name: &str) -> Option<Arc<Image>> {
        let Some((assets, _)) = self.assets else {
            self.error(name, "no files can be read here");
            return None;
        };
        self.found(name, assets.image(self.text(name)), "a placeholder is shown")
    }

    /// The mesh in the file that a [`ParamType::File`] names; `None` if it cannot be had, which was then complained
    /// about.
    pub fn mesh(&mut self, name: &str) -> Option<Arc<Mesh>> {
        let Some((assets, _)) = self.assets else {
            self.error(name, "no files can be read here");
            return None;
        };
        self.found(name, assets.mesh(self.text(name)), "nothing is shown")
    }

    /// The contents of the file that a [`ParamType::File`] names; `None` if they cannot be had, which was then complained
    /// about.
    pub fn file(&mut self, name: &str) -> Option<Arc<[u8]>> {
        let Some((assets, _)) = self.assets else {
            self.error(name, "no files can be read here");
            return None;
        };
        self.found(name, assets.bytes(self.text(name)), "a placeholder is shown")
    }

    fn found<T>(&mut self, name: &str, asked: Result<T, AssetError>, instead: &str) -> Option<T> {
        let (assets, missing) = self.assets?;
        let error = match asked {
            Ok(found) => return Some(found),
            Err(error) => error,
        };
        let advice = assets.advice(&error);
        let at = self.place(name);
        let said = match missing {
            Missing::Warn => self.diagnostics.warning(at, format!("{error}; {instead}")),
            Missing::Refuse => self.error_at(at, error.to_string()),
        };
        said.hint = advice;
        None
    }

    /// The contents of the file at `path`, or why they cannot be had; `None` where no files can be read.
    pub(super) fn bytes(&self, path: &str) -> Option<Result<Arc<[u8]>, AssetError>> {
        self.assets.map(|(assets, _)| assets.bytes(path))
    }

    pub(super) fn param(&self, name: &str) -> Option<&'a Param> {
        self.node.params.get(name)
    }

    pub(super) fn texture(&mut self, param: &Param, names: &[String], value: TextureValue) -> Option<u32> {
        let name = names.first()?;
        let found = match self.names {
            Some(names) => names.find(value, name).filter(|&index| index < self.textures.len()),
            None => self.textures.iter().position(|t| t.value == value && &t.name == name),
        };
        if found.is_none() {
            self.sound = false;
            let what = match value {
                TextureValue::Float => "float texture",
                TextureValue::Color => "spectrum texture",
            };
            let names = self.textures.iter().filter(|t| t.value == value).map(|t| t.name.as_str());
            self.diagnostics.unknown(param.at.clone(), what, name, names);
        }
        found.map(|i| i as u32)
    }
}
