//! Lights of a description, and shapes that shine, placed in render space.
use std::{collections::HashMap, sync::Arc};

use durer_accel::Placement;
use durer_core::{
    Id,
    glam::DAffine3,
    math::{Interval, Motion, Transform},
};
use durer_model::{
    light::{AREA_LIGHTS, Area, Emission, LIGHTS, Light, Looks, Orientation, Track},
    material::Material,
    shape::Geometry,
    texture::Texture,
};
use durer_scene::{LightDesc, Node, ShapeDesc, ShapeSource};

use super::nodes::Builder;
use crate::Object;

/// The lights of a scene.
pub(super) struct Lights {
    /// Those of the description, then the shapes that shine.
    pub(super) lights: Vec<Box<dyn Light>>,
    /// Their names.
    pub(super) names: Vec<String>,
    /// The light of each shape of the description.
    pub(super) of_shapes: Vec<Option<u32>>,
}

/// What there is to say of the surfaces of a scene.
pub(super) struct Surfaces<'a> {
    pub(super) textures: &'a Arc<[Box<dyn Texture>]>,
    pub(super) materials: &'a Arc<[Box<dyn Material>]>,
}

impl Surfaces<'_> {
    /// The looks of a light of this material.
    fn of(&self, material: Option<u32>) -> Looks {
        let has_holes = |m: &u32| self.materials.get(*m as usize).is_some_and(|m| m.has_holes());
        let holes = material.filter(has_holes).map(|m| (Arc::clone(self.materials), m));
        Looks { textures: Arc::clone(self.textures), holes }
    }
}

impl Builder<'_> {
    /// The lights `described`, and those of the description's shapes, which have become `geometry`.
    pub(super) fn lights(
        &mut self,
        described: &[LightDesc],
        shining: (&[Option<Geometry>], &Surfaces<'_>),
        render_from_world: &DAffine3,
        shutter: Interval,
    ) -> Lights {
        let mut all = Lights { lights: Vec::new(), names: Vec::new(), of_shapes: Vec::new() };
        for desc in described {
            let Some(mut light) = self.build(LIGHTS, "light", &desc.node, &self.desc.textures) else {
                continue;
            };
            let motion = desc.world_from_light.within(render_from_world);
            if motion.keys().iter().any(|(_, m)| !Transform::from_f64(m).is_invertible()) {
                self.diagnostics.error(desc.node.at.clone(), "the light's transform cannot be inverted");
                continue;
            }
            let moves = shutter.min != shutter.max && !motion.is_still();
            if moves && light.surrounds() {
                let message =
                    "moving skies are not supported: it stands still where it is when the shutter opens";
                self.diagnostics.warning(desc.node.at.clone(), message);
            }
            light.place(&match light.surrounds() {
                true => Track::still(motion.at(shutter.min.into())),
                false => track(&motion),
            });
            light.place_portal(render_from_world);
            let name = match desc.name.as_str() {
                "" => format!("{} {}", desc.node.kind, all.lights.len()),
                name => name.to_owned(),
            };
            all.lights.push(light);
            all.names.push(name);
        }
        self.shining(shining, render_from_world, &mut all);
        all
    }

    /// Adds the lights of shapes that shine.
    fn shining(
        &mut self,
        (geometry, surfaces): (&[Option<Geometry>], &Surfaces<'_>),
        render_from_world: &DAffine3,
        all: &mut Lights,
    ) {
        let mut known: HashMap<*const Node, Option<Emission>> = HashMap::new();
        for (index, (shape, built)) in self.desc.shapes.iter().zip(geometry).enumerate() {
            all.of_shapes.push(None);
            let Some(node) = &shape.area_light else { continue };
            let emission = known
                .entry(Arc::as_ptr(node))
                .or_insert_with(|| self.build(AREA_LIGHTS, "area light", node, &self.desc.textures))
                .clone();
            let (Some(emission), Some(geometry)) = (emission, self.geometry(shape, built.as_ref())) else {
                continue;
            };
            let motion = shape.world_from_object.within(render_from_world);
            let orientation = match shape.reverse_orientation {
                true => Orientation::Reversed,
                false => Orientation::AsMade,
            };
            match Area::new(&emission, &geometry, track(&motion), orientation) {
                Ok(light) => {
                    all.of_shapes[index] = Some(all.lights.len() as u32);
                    let material = shape.material.map(|m| m.index() as u32);
                    all.lights.push(Box::new(light.with_looks(surfaces.of(material))));
                    all.names.push(Object::name(shape, index));
                }
                Err(message) => {
                    let at = match &shape.source {
                        ShapeSource::Node(node) => node.at.clone(),
                        ShapeSource::Mesh(_) => node.at.clone(),
                    };
                    self.diagnostics.error(at, message);
                }
            }
        }
    }

    /// What a shape has become.
    fn geometry(&self, shape: &ShapeDesc, built: Option<&Geometry>) -> Option<Geometry> {
        let mesh = |id: Id<_>| self.desc.meshes.get(id.index()).cloned().map(Geometry::Mesh);
        match shape.source {
            ShapeSource::Mesh(id) => mesh(id),
            ShapeSource::Node(_) => built.cloned(),
        }
    }
}

/// The way of a motion as the kernel takes it.
fn track(render_from_light: &Motion) -> Track {
    match Placement::from_motion(render_from_light) {
        Placement::Moving(keys) => {
            Track::keyed(keys.into_iter().map(|(time, m)| (time, m.to_f64())).collect())
        }
        Placement::Identity | Placement::Still(_) => Track::still(render_from_light.at(0.0)),
    }
}
