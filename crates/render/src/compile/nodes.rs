//! Nodes to things: the registries of `durer-model` and of the integrators, applied to a description.
use durer_core::{
    glam::{DAffine3, DVec3},
    math::Transform,
};
use durer_model::{
    camera::{CAMERAS, Camera},
    light::{self, LIGHTS, Light},
    material::{self, MATERIALS, Material},
    shape::{Geometry, SHAPES},
    texture::{self, Texture},
};
use durer_scene::{
    Args, Assets, Diagnostics, Entry, LightDesc, Missing, Node, Params, SceneDesc, ShapeSource, TextureDesc,
    find,
};

use crate::integrator::{INTEGRATORS, Integrator, NOT_YET};

/// Builds nodes and collects complaints about them.
pub(super) struct Builder<'a> {
    pub(super) desc: &'a SceneDesc,
    pub(super) assets: &'a dyn Assets,
    pub(super) missing: Missing,
    pub(super) diagnostics: &'a mut Diagnostics,
}

impl Builder<'_> {
    fn build<T>(
        &mut self,
        registry: &[Entry<T>],
        family: &str,
        node: &Node,
        textures: &[TextureDesc],
    ) -> Option<T> {
        let entry = find(registry, family, node, self.diagnostics)?;
        let mut args = Args::check(node, entry.schema, textures, self.diagnostics)
            .with_assets(self.assets, self.missing);
        let built = (entry.build)(&mut args);
        args.is_sound().then_some(built).flatten()
    }

    /// The textures that could be built; a texture may use only those described before it, so there are no loops.
    pub(super) fn textures(&mut self) -> Vec<Box<dyn Texture>> {
        let all = &self.desc.textures;
        let built = all.iter().enumerate().map(|(i, t)| {
            let before = all.get(..i).unwrap_or_default();
            self.build(texture::textures(t.value), "texture", &t.node, before)
        });
        built.collect::<Vec<_>>().into_iter().flatten().collect()
    }

    pub(super) fn materials(&mut self) -> Vec<Box<dyn Material>> {
        let mut materials = Vec::new();
        for named in &self.desc.materials {
            let node = stand_in(&named.node, "material", material::NOT_YET, self.diagnostics);
            materials.extend(self.build(MATERIALS, "material", &node, &self.desc.textures));
        }
        materials
    }

    /// The geometry of each shape; `None` where it is a mesh of the description, or could not be built.
    pub(super) fn shapes(&mut self) -> Vec<Option<Geometry>> {
        let shapes = self.desc.shapes.iter().map(|shape| match &shape.source {
            ShapeSource::Node(node) => self.build(SHAPES, "shape", node, &self.desc.textures),
            ShapeSource::Mesh(_) => None,
        });
        shapes.collect()
    }

    pub(super) fn camera(&mut self, node: &Node) -> Option<Box<dyn Camera>> {
        self.build(CAMERAS, "camera", node, &self.desc.textures)
    }

    /// The lights with their names, placed in render space, which is the world moved by `to_render`.
    pub(super) fn lights(&mut self, lights: &[LightDesc], to_render: DVec3) -> Vec<(Box<dyn Light>, String)> {
        let mut built = Vec::new();
        for desc in lights {
            if light::NOT_YET.contains(&desc.node.kind.as_str()) {
                let message = format!("light \"{}\" is not supported yet: it gives no light", desc.node.kind);
                self.diagnostics.warning(desc.node.at.clone(), message);
                continue;
            }
            let Some(mut light) = self.build(LIGHTS, "light", &desc.node, &self.desc.textures) else {
                continue;
            };
            let world_from_light = desc.world_from_light.at(0.0);
            let transform = Transform::from_f64(&(DAffine3::from_translation(to_render) * world_from_light));
            if !transform.is_invertible() {
                self.diagnostics.error(desc.node.at.clone(), "the light's transform cannot be inverted");
                continue;
            }
            light.place(&transform);
            let name = match desc.name.as_str() {
                "" => format!("{} {}", desc.node.kind, built.len()),
                name => name.to_owned(),
            };
            built.push((light, name));
        }
        built
    }
}

/// The node itself, or the registered kind that is used until we have this one.
fn stand_in(node: &Node, family: &str, not_yet: &[(&str, &str)], diagnostics: &mut Diagnostics) -> Node {
    let Some((_, instead)) = not_yet.iter().find(|(word, _)| *word == node.kind) else { return node.clone() };
    let message = format!("{family} \"{}\" is not supported yet; \"{instead}\" is used", node.kind);
    diagnostics.warning(node.at.clone(), message);
    let params =
        node.params.iter().filter(|p| p.name == "reflectance").cloned().fold(Params::new(), |mut all, p| {
            all.push(p);
            all
        });
    Node { kind: (*instead).to_owned(), params, at: node.at.clone() }
}

/// The material of shapes that name none: grey matte.
pub(super) fn default_material(diagnostics: &mut Diagnostics) -> Option<Box<dyn Material>> {
    let node = Node::new("diffuse", Params::new());
    let entry = find(MATERIALS, "material", &node, diagnostics)?;
    (entry.build)(&mut Args::check(&node, entry.schema, &[], diagnostics))
}

/// Builds an integrator; those of pbrt that we do not have are replaced by the default one, with a warning.
pub fn integrator(node: &Node, diagnostics: &mut Diagnostics) -> Option<Box<dyn Integrator>> {
    let default = super::default_integrator();
    let node = if NOT_YET.contains(&node.kind.as_str()) {
        let message =
            format!("integrator \"{}\" is not supported yet; \"{}\" is used", node.kind, default.kind);
        diagnostics.warning(node.at.clone(), message);
        &default
    } else {
        node
    };
    let entry = find(INTEGRATORS, "integrator", node, diagnostics)?;
    let mut args = Args::check(node, entry.schema, &[], diagnostics);
    let built = (entry.build)(&mut args);
    args.is_sound().then_some(built).flatten()
}
