//! What parameters a kind takes: the one source of defaults, checks, help and documentation.

mod args;
mod color;
mod names;
mod param;

pub use args::{Args, FloatInput, Missing};
pub use color::{ColorInput, LightInput};
pub use names::TextureNames;
pub use param::{ParamDefault, ParamSpec, ParamType};

use crate::{Diagnostics, Node};

/// Name, story and parameters of a kind.
#[derive(Clone, Copy, Debug)]
pub struct Schema {
    /// The word in scene files.
    pub name: &'static str,
    /// Other words for it: those of older pbrt versions or of the literature.
    pub aliases: &'static [&'static str],
    /// One or two sentences.
    pub doc: &'static str,
    /// Its parameters.
    pub params: &'static [ParamSpec],
}

/// A kind of shape, material, light, texture, camera or integrator: one type in one file.
pub trait Kind {
    /// What it builds.
    type Output;
    /// Its parameters.
    const SCHEMA: Schema;
    /// Makes one from checked parameters; complains to `args` and returns `None` if they contradict each other.
    fn build(args: &mut Args<'_>) -> Option<Self::Output>;
}

/// A line of a registry: a [`Kind`] whose type is forgotten.
#[derive(Debug)]
pub struct Entry<T> {
    /// Its parameters.
    pub schema: Schema,
    /// Its constructor.
    pub build: fn(&mut Args<'_>) -> Option<T>,
}

impl<T> Entry<T> {
    /// The entry of `K`.
    pub const fn of<K: Kind<Output = T>>() -> Self {
        Self { schema: K::SCHEMA, build: K::build }
    }
    /// True if `word` names this kind.
    pub fn answers_to(&self, word: &str) -> bool {
        self.schema.name == word || self.schema.aliases.contains(&word)
    }
}

/// The entry of `registry` that `node` names; complains about an unknown word. `family` is what messages call it.
pub fn find<'r, T>(
    registry: &'r [Entry<T>],
    family: &str,
    node: &Node,
    diagnostics: &mut Diagnostics,
) -> Option<&'r Entry<T>> {
    let entry = registry.iter().find(|e| e.answers_to(&node.kind));
    if entry.is_none() {
        let names = registry.iter().flat_map(|e| e.schema.aliases.iter().copied().chain([e.schema.name]));
        diagnostics.unknown(node.at.clone(), family, &node.kind, names);
    }
    entry
}
