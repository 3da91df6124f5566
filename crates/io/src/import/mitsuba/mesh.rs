//! Meshes as Mitsuba makes them: without normals they get smooth ones, unless their faces are to be flat.
use std::{rc::Rc, sync::Arc};

use durer_core::{
    Id,
    glam::{DAffine3, DVec3},
    math::{Normal3, Point2, Point3},
};
use durer_scene::{Assets, Mesh, ShapeSource};

use super::{
    object::{Object, What},
    serialized,
    shape::Parts,
    world::World,
};
use crate::import::{obj, ply};

/// `obj`, `ply`, `serialized`: the meshes of a file.
pub(super) fn file(world: &mut World<'_>, object: &Object) -> Option<Parts> {
    let path = world.path(object, "filename")?;
    let index = object.number_or("shape_index", 0.0, world.said);
    if !(0.0..=1e9).contains(&index) {
        world.said.error(object.at, format!("\"shape_index\" is {index}, expected 0 or more"));
        return None;
    }
    // OBJ files count v upwards, as pictures of Mitsuba do not: it turns it around. So do we, for the others.
    let flip = !object.truth("flip_tex_coords", object.plugin == "obj", world.said);
    let flat = object.truth("face_normals", false, world.said);
    let paint = if object.plugin == "ply" { paint(world, object) } else { ply::Paint::Vertices };
    let key = format!("{path}\0{}\0{index}\0{flip}\0{flat}\0{paint:?}", object.plugin);
    if let Some(known) = world.meshes.get(&key) {
        return Some(parts(known));
    }
    let limits = world.assets.limits();
    let read = world.assets.bytes(&path).and_then(|bytes| match object.plugin.as_str() {
        "obj" => obj::meshes(&bytes, &path, limits),
        "ply" => ply::painted(&bytes, &path, paint).map(|mesh| vec![Arc::new(mesh)]),
        _ => serialized::mesh(&bytes, &path, index as usize, limits).map(|mesh| vec![Arc::new(mesh)]),
    });
    let meshes = match read {
        Ok(meshes) => meshes,
        Err(error) => {
            let hint = world.assets.advice(&error);
            let at = object.get("filename").map_or(object.at, |p| p.at);
            let said = world.said.error(at, error.to_string());
            if let Some(hint) = hint {
                said.hint(hint);
            }
            return None;
        }
    };
    let mut ids = Vec::with_capacity(meshes.len());
    for mesh in meshes {
        let mut mesh = Arc::unwrap_or_clone(mesh);
        if flip {
            mesh.uvs.iter_mut().for_each(|uv| uv.y = 1.0 - uv.y);
        }
        match flat {
            true => mesh.normals.clear(),
            false if mesh.normals.is_empty() => mesh.normals = smooth(&mesh),
            false => {}
        }
        ids.push(world.mesh(mesh));
    }
    let made = parts(&ids);
    world.meshes.insert(key, ids);
    Some(made)
}

fn parts(meshes: &[Id<Mesh>]) -> Parts {
    meshes.iter().map(|id| (ShapeSource::Mesh(*id), DAffine3::IDENTITY)).collect()
}

/// Whose colours the textures of a shape's material ask for.
fn paint(world: &mut World<'_>, shape: &Object) -> ply::Paint {
    let mut left: Vec<_> = world.of_tag(shape, "bsdf");
    let mut faces = false;
    for _ in 0..1 << 10 {
        let Some(object) = left.pop() else { break };
        if object.plugin == "mesh_attribute" {
            let name = object.text("name", world.said).unwrap_or_default();
            faces |= name.starts_with("face_");
        }
        // Objects that are not there are told where they are used.
        let inner = object.children.iter().filter_map(|c| match &c.what {
            What::Object(o) => Some(Rc::clone(o)),
            What::Ref(id) => world.ids.get(id).cloned(),
        });
        left.extend(inner);
    }
    if faces { ply::Paint::Faces } else { ply::Paint::Vertices }
}

/// The sum of the normals of the faces around each vertex, each weighted with its angle there.
fn smooth(mesh: &Mesh) -> Vec<Normal3> {
    let mut sums = vec![DVec3::ZERO; mesh.positions.len()];
    for triangle in &mesh.indices {
        let corners = triangle.map(|v| mesh.positions.get(v as usize).map_or(DVec3::ZERO, |p| p.to_f64()));
        for (v, weighted) in triangle.iter().zip(obj::weighted_normals(&corners)) {
            if let Some(sum) = sums.get_mut(*v as usize) {
                *sum += weighted;
            }
        }
    }
    sums.iter().map(|n| Normal3::from_f64(n.normalize_or_zero())).collect()
}

/// The square from -1 to 1 in the xy plane, which faces +z.
pub(super) fn rectangle(world: &mut World<'_>, _: &Object) -> Option<Parts> {
    let key = "\0rectangle".to_owned();
    if let Some(known) = world.meshes.get(&key) {
        return Some(parts(known));
    }
    let mut mesh = Mesh::default();
    face(&mut mesh, DVec3::X, DVec3::Y);
    mesh.positions.iter_mut().for_each(|p| p.z = 0.0);
    let id = world.mesh(mesh);
    world.meshes.insert(key, vec![id]);
    Some(parts(&[id]))
}

/// The cube from -1 to 1, each face with all of texture space.
pub(super) fn cube(world: &mut World<'_>, _: &Object) -> Option<Parts> {
    let key = "\0cube".to_owned();
    if let Some(known) = world.meshes.get(&key) {
        return Some(parts(known));
    }
    let mut mesh = Mesh::default();
    for (x, y) in [
        (DVec3::X, DVec3::Y),
        (DVec3::NEG_X, DVec3::Y),
        (DVec3::NEG_Z, DVec3::Y),
        (DVec3::Z, DVec3::Y),
        (DVec3::X, DVec3::NEG_Z),
        (DVec3::X, DVec3::Z),
    ] {
        face(&mut mesh, x, y);
    }
    let id = world.mesh(mesh);
    world.meshes.insert(key, vec![id]);
    Some(parts(&[id]))
}

/// A face of the cube along `x` and `y`; its v grows downwards as seen by ours.
fn face(mesh: &mut Mesh, x: DVec3, y: DVec3) {
    let normal = x.cross(y);
    let first = mesh.positions.len() as u32;
    for (u, v) in [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)] {
        mesh.positions.push(Point3::from_f64(normal + x * (2.0 * u - 1.0) + y * (2.0 * v - 1.0)));
        mesh.normals.push(Normal3::from_f64(normal));
        mesh.uvs.push(Point2::new(u as f32, 1.0 - v as f32));
    }
    mesh.indices.extend([[0, 1, 2], [0, 2, 3]].map(|t: [u32; 3]| t.map(|i| first + i)));
}
