//! What of the description cannot be seen: triangles without area, placements that squash, meshes without a place.
use durer_core::{Id, glam::DAffine3, math::Point3};
use durer_scene::{Mesh, SceneDesc, ShapeDesc, ShapeSource};

use super::Finding;
use crate::{Form, Object, Prepared};

/// Up to this share of triangles without area is what modellers leave behind.
const HARMLESS_SHARE: f64 = 0.05;

pub(super) fn findings(desc: &SceneDesc, prepared: &Prepared) -> Vec<Finding> {
    let mut found = Vec::new();
    let plain = desc.shapes.iter().filter(|s| s.material.is_none()).count();
    if plain > 0 {
        let (shapes, verb) = (counted(plain, "shape", "shapes"), if plain == 1 { "has" } else { "have" });
        found.push(Finding::note(format!("{shapes} {verb} no material: drawn as grey matte")));
    }
    found.extend(flat_triangles(&meshes(prepared)));
    found.extend(squashed(desc));
    let idle = unused_meshes(desc);
    if idle > 0 {
        let (meshes, verb) = (counted(idle, "mesh", "meshes"), if idle == 1 { "is" } else { "are" });
        found.push(Finding::note(format!("{meshes} of the file {verb} not drawn: used by no shape")));
    }
    found
}

/// A number with its noun.
pub(super) fn counted(n: usize, one: &str, many: &str) -> String {
    format!("{n} {}", if n == 1 { one } else { many })
}

/// The meshes of a scene with an object that each is part of; of those that are placed many times the first.
pub(super) fn meshes(prepared: &Prepared) -> Vec<(Id<Object>, &Mesh)> {
    let scene = &prepared.scene;
    let mut meshes = Vec::new();
    for piece in scene.pieces(scene.view.shutter.interval().min) {
        if let Form::Mesh(mesh) = piece.form {
            meshes.push((piece.object, mesh));
        }
    }
    meshes.sort_by_key(|&(object, mesh)| (std::ptr::from_ref::<Mesh>(mesh), object.index()));
    meshes.dedup_by_key(|&mut (_, mesh)| std::ptr::from_ref::<Mesh>(mesh));
    meshes.sort_by_key(|(object, _)| object.index());
    meshes
}

fn flat_triangles(meshes: &[(Id<Object>, &Mesh)]) -> Option<Finding> {
    let flat: usize = meshes.iter().map(|(_, mesh)| flat_triangles_of(mesh)).sum();
    let all: usize = meshes.iter().map(|(_, mesh)| mesh.indices.len()).sum();
    let (verb, them) = if flat == 1 { ("has", "it") } else { ("have", "them") };
    let triangles = counted(flat, "triangle", "triangles");
    let message = format!("{triangles} {verb} no area, so nothing can hit {them}");
    if flat == 0 {
        None
    } else if flat as f64 <= HARMLESS_SHARE * all as f64 {
        Some(Finding::note(format!("{message}: harmless, as few as this")))
    } else {
        let share = 100.0 * flat as f64 / all.max(1) as f64;
        let message = format!("{message}: {share:.0} % of all, so part of the model may be missing");
        Some(Finding::warning(message).remedy("export the model anew, without merging its vertices"))
    }
}

fn flat_triangles_of(mesh: &Mesh) -> usize {
    let corner = |i: u32| mesh.positions.get(i as usize).copied().map(Point3::to_f64);
    let is_flat = |t: &&[u32; 3]| {
        let (Some(a), Some(b), Some(c)) = (corner(t[0]), corner(t[1]), corner(t[2])) else {
            return false;
        };
        (b - a).cross(c - a).length_squared() == 0.0
    };
    mesh.indices.iter().filter(is_flat).count()
}

/// Shapes whose placement has no inverse at some key.
fn squashed(desc: &SceneDesc) -> Option<Finding> {
    let is_squashed = |shape: &&ShapeDesc| shape.world_from_object.keys().iter().any(|(_, m)| is_singular(m));
    let squashed: Vec<&ShapeDesc> = desc.shapes.iter().filter(is_squashed).collect();
    let first = squashed.first()?;
    let name = if first.name.is_empty() { "a shape".to_owned() } else { format!("\"{}\"", first.name) };
    let more = match squashed.len() {
        1 => String::new(),
        n => format!(" and those of {} more", n - 1),
    };
    let message = format!("the placement of {name}{more} squashes it flat: a scale is 0");
    Some(Finding::warning(message).remedy("give it a scale above 0 along every axis"))
}

/// Relative to its columns, so that a small scale is no reason.
fn is_singular(m: &DAffine3) -> bool {
    let lengths = m.matrix3.x_axis.length() * m.matrix3.y_axis.length() * m.matrix3.z_axis.length();
    m.matrix3.determinant().abs() <= 1e-12 * lengths
}

fn unused_meshes(desc: &SceneDesc) -> usize {
    let mut used = vec![false; desc.meshes.len()];
    for shape in &desc.shapes {
        if let ShapeSource::Mesh(id) = shape.source
            && let Some(used) = used.get_mut(id.index())
        {
            *used = true;
        }
    }
    used.into_iter().filter(|used| !used).count()
}
