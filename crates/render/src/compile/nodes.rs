//! Nodes to things: the registries of `durer-model` and of the integrators, applied to a description.
use std::{collections::HashMap, sync::Arc};

use durer_model::{
    camera::{CAMERAS, Camera},
    filter::{FILTERS, Filter},
    material::{ForceDiffuse, MATERIALS, Material},
    shape::{Geometry, SHAPES},
    texture::{self, Texture},
};
use durer_scene::{
    Args, Assets, Data, Diagnostics, Entry, Missing, NamedNode, Node, Params, SceneDesc, ShapeDesc,
    ShapeSource, TextureDesc, TextureNames, ValueType, find,
};

use rayon::prelude::*;

use crate::integrator::{INTEGRATORS, Integrator};

/// Most textures that are asked for the value of one, itself and those that it is made of, each as often as it is asked.
const MOST_ASKED: u64 = 1 << 12;

/// Builds nodes and collects complaints about them.
pub(super) struct Builder<'a> {
    pub(super) desc: &'a SceneDesc,
    pub(super) assets: &'a dyn Assets,
    pub(super) missing: Missing,
    pub(super) names: &'a TextureNames<'a>,
    pub(super) diagnostics: &'a mut Diagnostics,
}

impl Builder<'_> {
    pub(super) fn build<T>(
        &mut self,
        registry: &[Entry<T>],
        family: &str,
        node: &Node,
        textures: &[TextureDesc],
    ) -> Option<T> {
        let (built, said) = self.apart(registry, family, node, (textures, &[]));
        self.diagnostics.append(said);
        built
    }

    /// The same with complaints of its own, so that several nodes can be built at the same time.
    fn apart<T>(
        &self,
        registry: &[Entry<T>],
        family: &str,
        node: &Node,
        (textures, before): (&[TextureDesc], &[NamedNode]),
    ) -> (Option<T>, Diagnostics) {
        let mut said = Diagnostics::default();
        let built = find(registry, family, node, &mut said).and_then(|entry| {
            let mut args = Args::check(node, entry.schema, textures, &mut said)
                .with_assets(self.assets, self.missing)
                .with_before(before)
                .with_names(self.names);
            let built = (entry.build)(&mut args);
            args.is_sound().then_some(built).flatten()
        });
        (built, said)
    }

    /// Builds all of `nodes` at the same time; complaints come in the order of the nodes.
    fn build_all<'n, T: Send, N: Sync>(
        &mut self,
        nodes: &'n [N],
        build: impl Fn(&Self, usize, &'n N) -> (Option<T>, Diagnostics) + Sync,
    ) -> Vec<Option<T>>
    where
        Self: Sync,
    {
        let this = &*self;
        let built: Vec<_> = nodes.par_iter().enumerate().map(|(i, node)| build(this, i, node)).collect();
        let (things, said): (Vec<_>, Vec<_>) = built.into_iter().unzip();
        said.into_iter().for_each(|said| self.diagnostics.append(said));
        things
    }

    /// The textures that could be built; a texture may use only those described before it, so there are no loops.
    pub(super) fn textures(&mut self) -> Vec<Box<dyn Texture>> {
        let all = &self.desc.textures;
        if !self.are_few_asked() {
            return Vec::new();
        }
        let built = self.build_all(all, |this, i, t| {
            let before = all.get(..i).unwrap_or_default();
            this.apart(texture::textures(t.value), "texture", &t.node, (before, &[]))
        });
        built.into_iter().flatten().collect()
    }

    /// Complains about a texture that asks too many others: those that ask one before them twice double its work.
    fn are_few_asked(&mut self) -> bool {
        let mut asked: HashMap<&str, u64> = HashMap::new();
        for texture in &self.desc.textures {
            let inputs = texture.node.params.iter().filter(|param| param.ty == ValueType::Texture);
            let names = inputs.flat_map(|param| match &param.data {
                Data::Strings(names) => names.as_slice(),
                _ => &[],
            });
            let own = 1 + names.filter_map(|name| asked.get(name.as_str())).sum::<u64>();
            if own > MOST_ASKED {
                let name = &texture.name;
                let message = format!("texture \"{name}\" asks more than {MOST_ASKED} others for each value");
                let hint = "a texture that uses another one twice asks it twice, and so on down";
                self.diagnostics.error(texture.node.at.clone(), message).hint(hint);
                return false;
            }
            asked.insert(&texture.name, own);
        }
        true
    }

    pub(super) fn materials(&mut self) -> Vec<Box<dyn Material>> {
        let mut materials = Vec::new();
        let all = &self.desc.materials;
        for (i, named) in all.iter().enumerate() {
            let before = all.get(..i).unwrap_or_default();
            let (built, said) = self.apart(MATERIALS, "material", &named.node, (&self.desc.textures, before));
            self.diagnostics.append(said);
            materials.extend(built);
        }
        if self.desc.options.force_diffuse {
            return materials.into_iter().map(|own| Box::new(ForceDiffuse(own)) as _).collect();
        }
        materials
    }

    /// The geometry of each shape; `None` where it is a mesh of the description, or could not be built.
    pub(super) fn shapes(&mut self) -> Vec<Option<Geometry>> {
        let shapes = &self.desc.shapes;
        // A node that several shapes share is built once.
        let mut numbers: HashMap<*const Node, usize> = HashMap::new();
        let mut distinct: Vec<(&Node, &ShapeDesc)> = Vec::new();
        let mut number_of = Vec::with_capacity(shapes.len());
        for shape in shapes {
            number_of.push(match &shape.source {
                ShapeSource::Node(node) => Some(*numbers.entry(Arc::as_ptr(node)).or_insert_with(|| {
                    distinct.push((node, shape));
                    distinct.len() - 1
                })),
                ShapeSource::Mesh(_) => None,
            });
        }
        let textures = &self.desc.textures;
        let built = self
            .build_all(&distinct, |this, _, (node, _)| this.apart(SHAPES, "shape", node, (textures, &[])));
        let built = self.displaced(&distinct, built);
        number_of.into_iter().map(|number: Option<usize>| built[number?].clone()).collect()
    }

    pub(super) fn camera(&mut self, node: &Node) -> Option<Box<dyn Camera>> {
        self.build(CAMERAS, "camera", node, &self.desc.textures)
    }

    /// The filter of the description, or the usual one.
    pub(super) fn filter(&mut self) -> Option<Filter> {
        match &self.desc.filter {
            Some(node) => self.build(FILTERS, "filter", node, &[]),
            None => Some(Filter::usual()),
        }
    }
}

/// The material of shapes that name none: grey matte.
pub(super) fn default_material(diagnostics: &mut Diagnostics) -> Option<Box<dyn Material>> {
    let node = Node::new("diffuse", Params::new());
    let entry = find(MATERIALS, "material", &node, diagnostics)?;
    (entry.build)(&mut Args::check(&node, entry.schema, &[], diagnostics))
}

/// Builds an integrator.
pub fn integrator(node: &Node, diagnostics: &mut Diagnostics) -> Option<Box<dyn Integrator>> {
    let entry = find(INTEGRATORS, "integrator", node, diagnostics)?;
    let mut args = Args::check(node, entry.schema, &[], diagnostics);
    let built = (entry.build)(&mut args);
    args.is_sound().then_some(built).flatten()
}
