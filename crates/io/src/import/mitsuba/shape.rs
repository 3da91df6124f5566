//! Shapes: meshes of files, quadrics, groups and their instances.
use std::{rc::Rc, sync::Arc};

use durer_core::{
    glam::{DAffine3, DMat3, DVec3},
    math::Motion,
};
use durer_scene::{Data, MaterialRef, MediumInterface, Node, Params, ShapeDesc, ShapeSource, ValueType};

use super::{
    bsdf, curve, emitter, medium, mesh,
    object::Object,
    volume,
    world::{Plugin, World, node},
};

/// The geometry of a shape, each part with its place in the shape's own space.
pub(super) type Parts = Vec<(ShapeSource, DAffine3)>;
/// Makes the geometry.
pub(super) type Build = fn(&mut World<'_>, &Object) -> Option<Parts>;

/// Shapes with geometry of their own.
const SHAPES: &[Plugin<Build>] = &[
    Plugin {
        name: "obj",
        takes: &["filename", "to_world", "flip_normals", "face_normals", "flip_tex_coords"],
        lacks: &["collapse", "max_smooth_angle"],
        build: mesh::file,
    },
    Plugin {
        name: "ply",
        takes: &["filename", "to_world", "flip_normals", "face_normals", "flip_tex_coords"],
        lacks: &["srgb", "max_smooth_angle"],
        build: mesh::file,
    },
    Plugin {
        name: "serialized",
        takes: &["filename", "to_world", "flip_normals", "face_normals", "flip_tex_coords", "shape_index"],
        lacks: &["max_smooth_angle"],
        build: mesh::file,
    },
    Plugin { name: "rectangle", takes: &["to_world", "flip_normals"], lacks: &[], build: mesh::rectangle },
    Plugin { name: "cube", takes: &["to_world", "flip_normals"], lacks: &[], build: mesh::cube },
    Plugin {
        name: "sphere",
        takes: &["to_world", "flip_normals", "center", "radius"],
        lacks: &[],
        build: sphere,
    },
    Plugin { name: "disk", takes: &["to_world", "flip_normals"], lacks: &[], build: disk },
    Plugin {
        name: "cylinder",
        takes: &["to_world", "flip_normals", "p0", "p1", "radius"],
        lacks: &[],
        build: cylinder,
    },
    Plugin { name: "bsplinecurve", takes: STRANDS, lacks: &[], build: curve::strands },
    Plugin { name: "linearcurve", takes: STRANDS, lacks: &[], build: curve::strands },
    Plugin {
        name: "sdfgrid",
        takes: &["filename", "normals", "to_world", "flip_normals"],
        lacks: &[],
        build: distances,
    },
];

/// What strands have.
const STRANDS: &[&str] = &["filename", "to_world", "flip_normals", "silhouette_sampling_weight"];

/// Adds the shape that `object` is, placed by what it is in.
pub(super) fn add(world: &mut World<'_>, object: &Rc<Object>, outer: DAffine3) {
    let _: Option<()> = world.deeper(object, |world| placed(world, object, outer));
}

fn placed(world: &mut World<'_>, object: &Rc<Object>, outer: DAffine3) -> Option<()> {
    match object.plugin.as_str() {
        // It is seen where instances of it are.
        "shapegroup" => world.check(object, &[], &[]),
        "merge" => {
            world.check(object, &[], &[]);
            world.of_tag(object, "shape").iter().for_each(|inner| add(world, inner, outer));
        }
        "instance" => {
            world.check(object, &["to_world", "shapegroup"], &[]);
            let here = outer * object.transform("to_world", world.said);
            let groups = world.of_tag(object, "shape");
            let [group] = groups.as_slice() else {
                world
                    .said
                    .error(object.at, format!("instance has {} shapegroups in it, expected 1", groups.len()));
                return None;
            };
            if group.plugin != "shapegroup" {
                world
                    .said
                    .error(object.at, format!("an instance is of a shapegroup, not of {}", group.shown()));
                return None;
            }
            world.of_tag(group, "shape").iter().for_each(|inner| add(world, inner, here));
        }
        _ => return single(world, object, outer),
    }
    Some(())
}

fn single(world: &mut World<'_>, object: &Rc<Object>, outer: DAffine3) -> Option<()> {
    let Some(plugin) = SHAPES.iter().find(|p| p.name == object.plugin) else {
        let known = SHAPES.iter().map(|p| p.name).chain(["shapegroup", "instance", "merge"]);
        world.said.unknown(object.at, "shape", &object.plugin, known);
        return None;
    };
    world.check(object, plugin.takes, plugin.lacks);
    let here = outer * object.transform("to_world", world.said);
    let reverse_orientation = object.truth("flip_normals", false, world.said);
    let area_light = emitter::area(world, object);
    let material = material(world, object, area_light.is_some());
    let media = media(world, object);
    let parts = (plugin.build)(world, object)?;
    let name = if object.id.is_empty() { object.plugin.clone() } else { object.id.clone() };
    for (source, world_from_part) in parts {
        world.desc.shapes.push(ShapeDesc {
            name: name.clone(),
            source,
            world_from_object: Motion::still(here * world_from_part),
            material,
            reverse_orientation,
            area_light: area_light.clone(),
            media,
        });
    }
    Some(())
}

/// The material of a shape: grey without one, black if it shines.
fn material(world: &mut World<'_>, object: &Object, shines: bool) -> Option<MaterialRef> {
    let own = world.of_tag(object, "bsdf");
    if own.len() > 1 {
        world.said.error(object.at, format!("{} has {} bsdfs in it, expected 1", object.shown(), own.len()));
    }
    if !world.of_tag(object, "subsurface").is_empty() {
        let message = "light that goes on below a surface (subsurface) is left out";
        world.once(object.at, message.to_owned());
    }
    match own.first() {
        Some(own) => bsdf::material(world, own),
        None => {
            let name = if shines { "a black light" } else { "grey" };
            let known = world.desc.materials.iter().position(|m| m.name == name);
            let color = if shines { 0.0 } else { 0.5 };
            Some(known.map_or_else(
                || world.material(name, "diffuse", Params::new().rgb("reflectance", [color; 3]), object.at),
                |i| MaterialRef::new(i as u32),
            ))
        }
    }
}

fn media(world: &mut World<'_>, object: &Object) -> Option<MediumInterface> {
    let all = world.inner(object);
    let mut of = |side: &str| {
        let found = all.iter().find(|(name, o)| o.tag == "medium" && name == side)?;
        medium::medium(world, &found.1)
    };
    let (inside, outside) = (of("interior"), of("exterior"));
    (inside.is_some() || outside.is_some()).then_some(MediumInterface { inside, outside })
}

fn of_node(kind: &str, params: Params, object: &Object) -> ShapeSource {
    let node: Node = node(kind, params, object.at);
    ShapeSource::Node(Arc::new(node))
}

/// A number that must be above 0.
fn above_zero(world: &mut World<'_>, object: &Object, name: &str) -> f64 {
    let v = object.number_or(name, 1.0, world.said);
    if v > 0.0 {
        return v;
    }
    let at = object.get(name).map_or(object.at, |p| p.at);
    world.said.error(at, format!("\"{name}\" is {v}, expected a number above 0"));
    1.0
}

fn sphere(world: &mut World<'_>, object: &Object) -> Option<Parts> {
    let center = object.triple("center", world.said).map_or(DVec3::ZERO, DVec3::from);
    let radius = above_zero(world, object, "radius") as f32;
    let source = of_node("sphere", Params::new().float("radius", radius), object);
    Some(vec![(source, DAffine3::from_translation(center))])
}

/// A surface between the distances of a volume, whose outermost values lie on the sides of the unit cube.
fn distances(world: &mut World<'_>, object: &Object) -> Option<Parts> {
    let (volume::Grid { size, values, .. }, _) = volume::file::<1>(world, object)?;
    let normals = object.word("normals", &["smooth", "analytic"], world.said);
    let params = Params::new().string("normals", normals);
    let params = params.with("distance", ValueType::Float, Data::Floats(values.concat()));
    let params = ["nx", "ny", "nz"].into_iter().zip(size).fold(params, |p, (name, n)| p.int(name, n as i32));
    Some(vec![(of_node("sdfgrid", params, object), DAffine3::IDENTITY)])
}

fn disk(_: &mut World<'_>, object: &Object) -> Option<Parts> {
    Some(vec![(of_node("disk", Params::new(), object), DAffine3::IDENTITY)])
}

fn cylinder(world: &mut World<'_>, object: &Object) -> Option<Parts> {
    let from = object.triple("p0", world.said).map_or(DVec3::ZERO, DVec3::from);
    let to = object.triple("p1", world.said).map_or(DVec3::Z, DVec3::from);
    let radius = above_zero(world, object, "radius") as f32;
    let Some(z) = (to - from).try_normalize() else {
        world.said.error(object.at, "\"p0\" and \"p1\" of a cylinder are the same");
        return None;
    };
    let length = (to - from).length() as f32;
    let params = Params::new().float("radius", radius).float("zmin", 0.0).float("zmax", length);
    let (x, y) = z.any_orthonormal_pair();
    let turned = DAffine3::from_mat3_translation(DMat3::from_cols(x, y, z), from);
    Some(vec![(of_node("cylinder", params, object), turned)])
}
