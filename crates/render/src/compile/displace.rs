//! Meshes that textures displace: before they are placed, with textures where they stand in the world.
use durer_core::{
    math::{Point3, Transform},
    spectrum::Basis,
};
use durer_model::{
    ShadeCx,
    shape::{Displacement, Geometry, SHAPES, Vertex, displaced},
    texture::{Footprint, Texture, TextureAt},
};
use durer_scene::{
    Args, Data, Diagnostics, FloatInput, Location, Node, ShapeDesc, TextureDesc, ValueType, find,
};

use super::nodes::Builder;

impl Builder<'_> {
    /// The geometries of these nodes, displaced where they say so. What a node's edges measure is up to the first shape that it
    /// stands for.
    pub(super) fn displaced(
        &mut self,
        nodes: &[(&Node, &ShapeDesc)],
        mut built: Vec<Option<Geometry>>,
    ) -> Vec<Option<Geometry>> {
        let asks = |node: &Node| node.params.get("displacement").is_some();
        if !nodes.iter().any(|(node, _)| asks(node)) {
            return built;
        }
        let Some(textures) = self.standing_textures() else { return built };
        for ((node, shape), geometry) in nodes.iter().zip(&mut built) {
            let Some(Geometry::Mesh(mesh)) = geometry else { continue };
            // Who built it has complained already.
            let mut said = Diagnostics::default();
            let Some(entry) = find(SHAPES, "shape", node, &mut said) else { continue };
            let mut args =
                Args::check(node, entry.schema, &self.desc.textures, &mut said).with_names(self.names);
            let Some(displacement) = Displacement::read(&mut args).filter(|_| asks(node)) else { continue };
            let at = node.params.get("displacement").map_or(Location::None, |param| param.at.clone());
            if mesh.uvs.is_empty() && wants_uv(&self.desc.textures, displacement.by) {
                let message = "this \"displacement\" needs texture coordinates, which the mesh has not";
                let hint = "textures that fill space need none: \"fbm\", \"wrinkled\", \"marble\", or a \"mapping\" by place";
                self.diagnostics.error(at, message).hint(hint);
                continue;
            }
            let edge_length =
                displacement.edge_length * self.desc.options.displacement_edge_scale.unwrap_or(1.0);
            let world_from_object =
                shape.world_from_object.keys().first().map(|key| key.1).unwrap_or_default();
            let length =
                |a: Point3, b: Point3| world_from_object.transform_vector3((a - b).to_f64()).length() as f32;
            let to_world = Transform::from_f64(&world_from_object);
            let cx = ShadeCx { basis: Basis::Rgb, textures: &textures, log: None };
            let by = |vertex: &Vertex| cx.float(displacement.by, &looked_at(vertex, &to_world));
            match displaced(mesh, length, edge_length, by) {
                Ok(fine) => *geometry = Some(Geometry::Mesh(fine.into())),
                Err(message) => {
                    self.diagnostics.error(at, message);
                }
            }
        }
        built
    }

    /// The textures where they are in the world; `None` if one of them cannot be built, which somebody else complains about.
    fn standing_textures(&self) -> Option<Vec<Box<dyn Texture>>> {
        let mut said = Diagnostics::default();
        let mut textures = Builder { diagnostics: &mut said, ..*self }.textures();
        for (texture, described) in textures.iter_mut().zip(&self.desc.textures) {
            texture.place(&described.world_from_texture);
        }
        (textures.len() == self.desc.textures.len()).then_some(textures)
    }
}

/// Whether a texture, or one that it is made of, looks at texture coordinates.
fn wants_uv(textures: &[TextureDesc], input: FloatInput) -> bool {
    let FloatInput::Texture(index) = input else { return false };
    let Some(texture) = textures.get(index as usize) else { return false };
    let params = &texture.node.params;
    let is = |name: &str, data: &Data| params.get(name).is_some_and(|param| param.data == *data);
    match texture.node.kind.as_str() {
        "fbm" | "wrinkled" | "windy" | "marble" => false,
        "constant" | "directionmix" | "mix" | "scale" => {
            // Those that it is made of come before it.
            let names = params.iter().filter_map(|param| match (&param.ty, &param.data) {
                (ValueType::Texture, Data::Strings(names)) => names.first(),
                _ => None,
            });
            names.into_iter().any(|name| {
                let of = |t: &TextureDesc| t.value == texture.value && t.name == *name;
                let found = textures[..index as usize].iter().position(of);
                found.is_some_and(|found| wants_uv(textures, FloatInput::Texture(found as u32)))
            })
        }
        "checkerboard" if is("dimension", &Data::Ints(vec![3])) => false,
        _ => params.get("mapping").is_none() || is("mapping", &Data::Strings(vec!["uv".to_owned()])),
    }
}

/// Where textures are asked.
fn looked_at(vertex: &Vertex, to_world: &Transform) -> TextureAt {
    TextureAt {
        uv: vertex.uv,
        second_uv: vertex.second_uv,
        face: 0,
        p: to_world.point(vertex.p),
        n: to_world.normal(vertex.n),
        vertex_color: vertex.color,
        footprint: Footprint::POINT,
    }
}
