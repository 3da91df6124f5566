//! The scene doctor: what most often makes a picture black, and can be checked.
use durer::{
    Prepared, Settings, Show,
    drive::Job,
    integrator::Cast,
    math::Point3,
    scene::{Mesh, SceneDesc, Severity, ShapeSource},
};

use crate::number::counted;

/// Eye rays sent per row and column to see what the camera sees.
const LOOKS: [u32; 2] = [24, 16];

/// Up to this share of triangles without area is what modellers leave behind.
const HARMLESS_SHARE: f64 = 0.05;

/// Something odd, in a sentence.
pub(super) type Finding = (Severity, String);

/// What is odd and was not said before.
pub(super) fn findings(desc: &SceneDesc, prepared: &Prepared) -> Vec<Finding> {
    let mut found = Vec::new();
    let plain = desc.shapes.iter().filter(|s| s.material.is_none()).count() as u64;
    if plain > 0 {
        let (shapes, verb) = (counted(plain, "shape", "shapes"), if plain == 1 { "has" } else { "have" });
        found.push((Severity::Note, format!("{shapes} {verb} no material: drawn as grey matte")));
    }
    found.extend(flat_triangles(desc));
    let idle = unused_meshes(desc);
    if idle > 0 {
        let (meshes, verb) = (counted(idle, "mesh", "meshes"), if idle == 1 { "is" } else { "are" });
        found.push((Severity::Note, format!("{meshes} of the file {verb} not drawn: used by no shape")));
    }
    let built = prepared.scene.accel.stats();
    if built.triangles + built.user_primitives > 0 {
        found.extend(first_look(desc, prepared));
    }
    found
}

/// What a few eye rays meet: nothing, or everything from its inside.
fn first_look(desc: &SceneDesc, prepared: &Prepared) -> Option<Finding> {
    let cast = Cast { show: Show::Depth };
    let settings = Settings { samples: 1, ..prepared.settings };
    let job = Job { scene: &prepared.scene, integrator: &cast, settings };
    let (mut hits, mut inside) = (0, 0);
    let view = &prepared.scene.view;
    for y in 0..LOOKS[1] {
        for x in 0..LOOKS[0] {
            let at = |i: u32, of: u32, edge: u32| {
                (u64::from(2 * i + 1) * u64::from(edge) / u64::from(2 * of)) as u32
            };
            let (tree, _) = job.record([at(x, LOOKS[0], view.width), at(y, LOOKS[1], view.height)], 0);
            let hit = tree.nodes.first().and_then(|n| n.hit.as_ref());
            hits += usize::from(hit.is_some());
            inside += usize::from(hit.is_some_and(|h| !h.from_outside));
        }
    }
    let rays = LOOKS[0] * LOOKS[1];
    if hits == 0 {
        let message = format!("the camera seems to look past everything: {rays} eye rays met nothing");
        return Some((Severity::Warning, message));
    }
    let share = 100 * inside / hits;
    let message =
        "of what the camera sees is seen from its inside: it may stand in an object, or normals are turned";
    // The automatic camera stands outside of everything: open or turned surfaces are no fault of its.
    (share > 50 && !desc.cameras.is_empty()).then(|| (Severity::Warning, format!("{share} % {message}")))
}

fn flat_triangles(desc: &SceneDesc) -> Option<Finding> {
    let flat: usize = desc.meshes.iter().map(|m| flat_triangles_of(m)).sum();
    let all: usize = desc.meshes.iter().map(|m| m.indices.len()).sum();
    let (verb, them) = if flat == 1 { ("has", "it") } else { ("have", "them") };
    let triangles = counted(flat as u64, "triangle", "triangles");
    let message = format!("{triangles} {verb} no area, so nothing can hit {them}");
    if flat == 0 {
        None
    } else if flat as f64 <= HARMLESS_SHARE * all as f64 {
        Some((Severity::Note, format!("{message}: harmless, as few as this")))
    } else {
        Some((
            Severity::Warning,
            format!("{message}: {} of all, so part of the model may be missing", percent(flat, all)),
        ))
    }
}

fn percent(part: usize, all: usize) -> String {
    format!("{:.0} %", 100.0 * part as f64 / all.max(1) as f64)
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

fn unused_meshes(desc: &SceneDesc) -> u64 {
    let mut used = vec![false; desc.meshes.len()];
    for shape in &desc.shapes {
        if let ShapeSource::Mesh(id) = shape.source
            && let Some(used) = used.get_mut(id.index())
        {
            *used = true;
        }
    }
    used.into_iter().filter(|used| !used).count() as u64
}
