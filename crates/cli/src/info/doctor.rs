//! The scene doctor: what most often makes a picture black, and can be checked.
use durer::{
    Prepared, Settings, Show,
    drive::Job,
    integrator::Cast,
    math::Point3,
    scene::{Mesh, SceneDesc, ShapeSource},
};

/// Eye rays sent per row and column to see what the camera sees.
const LOOKS: [u32; 2] = [24, 16];

/// What is odd, a sentence each.
pub(super) fn findings(desc: &SceneDesc, prepared: &Prepared) -> Vec<String> {
    let mut found = Vec::new();
    let mut check = |odd: bool, what: &str| {
        if odd {
            found.push(what.to_owned());
        }
    };
    check(desc.shapes.is_empty(), "the scene has no shapes");
    check(desc.cameras.is_empty(), "the scene has no camera: one that frames everything is used");
    check(desc.lights.is_empty(), "the scene has no light: a neutral studio light is used");
    let plain = desc.shapes.iter().filter(|s| s.material.is_none()).count();
    check(plain > 0, &format!("shapes without material, shown as grey matte: {plain}"));
    let flat: usize = desc.meshes.iter().map(|m| flat_triangles(m)).sum();
    check(flat > 0, &format!("triangles without area, which nothing can hit: {flat}"));
    let idle = unused_meshes(desc);
    check(idle > 0, &format!("meshes that no shape uses: {idle}"));
    if !desc.shapes.is_empty() {
        found.extend(first_look(prepared));
    }
    found
}

/// What a few eye rays meet: nothing, or everything from its inside.
fn first_look(prepared: &Prepared) -> Option<String> {
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
        return Some(format!("the camera seems to look past everything: {rays} eye rays met nothing"));
    }
    let share = 100 * inside / hits;
    let message =
        "of what the camera sees is seen from its inside: it may stand in an object, or normals are turned";
    (share > 50).then(|| format!("{share} % {message}"))
}

fn flat_triangles(mesh: &Mesh) -> usize {
    let corner = |i: u32| mesh.positions.get(i as usize).copied().map(Point3::to_f64);
    let is_flat = |t: &&[u32; 3]| {
        let (Some(a), Some(b), Some(c)) = (corner(t[0]), corner(t[1]), corner(t[2])) else {
            return false;
        };
        (b - a).cross(c - a).length_squared() == 0.0
    };
    mesh.indices.iter().filter(is_flat).count()
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
