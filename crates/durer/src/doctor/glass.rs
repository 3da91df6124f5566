//! Transparent bodies that are inside out: light would leave them where it enters.
//!
//! The volume of a closed mesh is a sixth of the sum of its triangles' spat products, and below 0 if they face inwards.
use durer_core::{Id, glam::DVec3, math::Point3};
use durer_scene::Mesh;

use super::{Finding, geometry::meshes};
use crate::{Object, Prepared};

/// The triangles of an open mesh have normals that do not cancel: a share of its area above this.
const OPEN: f64 = 1e-3;

pub(super) fn turned(prepared: &Prepared) -> Option<Finding> {
    let scene = &prepared.scene;
    let is_turned = |(object, mesh): &(Id<Object>, &Mesh)| {
        let reverse = scene.object(*object).reverse_orientation;
        scene.material(*object).medium().is_some() && volume(mesh).is_some_and(|v| (v < 0.0) != reverse)
    };
    let meshes = meshes(prepared);
    let mut turned = meshes.iter().filter(|mesh| is_turned(mesh));
    let first = &scene.object(turned.next()?.0).name;
    let rest = turned.count();
    let more = if rest == 0 { String::new() } else { format!(" and {rest} more") };
    let message =
        format!("inside out: the triangles of \"{first}\"{more} face into the glass that they enclose");
    Some(Finding::warning(message).remedy("turn its normals: ReverseOrientation, or in the modeller"))
}

/// The volume that a mesh encloses; `None` if it is open or flat.
fn volume(mesh: &Mesh) -> Option<f64> {
    let origin = mesh.positions.first()?.to_f64();
    let (mut normals, mut area, mut volume) = (DVec3::ZERO, 0.0, 0.0);
    for triangle in &mesh.indices {
        let [a, b, c] = triangle.map(|i| mesh.positions.get(i as usize).copied().map(Point3::to_f64));
        let (a, b, c) = (a? - origin, b? - origin, c? - origin);
        let n = (b - a).cross(c - a);
        (normals, area, volume) = (normals + n, area + n.length(), volume + a.dot(b.cross(c)) / 6.0);
    }
    (normals.length() <= OPEN * area && volume != 0.0).then_some(volume)
}
