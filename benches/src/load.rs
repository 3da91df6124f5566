//! The scenes by name: files read by durer's importers, and one that is generated.
use std::{
    collections::HashMap,
    path::{Path, PathBuf},
    sync::Arc,
};

use anyhow::{Context, bail};
use durer::{
    import::Imported,
    math::{Bounds3, Point3, Transform, Vector3},
    open,
    scene::{Data, Node, SceneDesc, ShapeSource},
};

use crate::{
    scene::{Instance, Mesh, Scene},
    terrain,
    view::View,
};

/// Name, file below the folder of test files, and for some where to look from and at and the angle in degrees. Without it
/// the file's own camera looks, or a view from the front is made up. No file: generated.
type Listed = (&'static str, Option<&'static str>, Option<([f32; 3], [f32; 3], f32)>);

/// All scenes, in the order of the tables.
const LIST: &[Listed] = &[
    ("atrium", Some("bench/atrium.ply"), Some(([-15.5, 4.2, 0.6], [2.0, 3.6, -0.6], 70.0))),
    ("sponza", Some("ply/sponza_dabrovic.ply"), Some(([14.4499, 6.89415, -1.18547], [0.0, 5.3, -0.8], 90.0))),
    ("sphere8", Some("bench/sphere8.ply.gz"), Some(([0.3, 0.5, 1.9], [0.0; 3], 50.0))),
    ("dragon", Some("ply/dragon_vrip.ply.gz"), None),
    ("buddha", Some("pbrt/buddha-fractal/buddha-fractal.pbrt"), None),
    ("terrain", None, None),
];

/// The names of all scenes.
pub fn names() -> impl Iterator<Item = &'static str> {
    LIST.iter().map(|(name, ..)| *name)
}

/// The scene of that name; `None` if its file is not below `folder`.
///
/// # Errors
/// No scene has the name, or the file cannot be read.
pub fn scene(name: &str, folder: &Path) -> anyhow::Result<Option<Scene>> {
    let listed = LIST.iter().find(|(known, ..)| *known == name);
    let (name, file, view) = listed.with_context(|| format!("no scene is called \"{name}\""))?;
    let Some(file) = file else {
        return Ok(Some(terrain::scene(name)));
    };
    let path = folder.join(file);
    if !path.exists() {
        return Ok(None);
    }
    let Imported { desc, .. } = import(&path)?;
    let beside = path.parent().context("a file lies in a folder")?;
    let (meshes, instances) = Gathered::of(&desc, beside)?.finish();
    let mut scene = Scene {
        name: (*name).to_owned(),
        meshes,
        instances,
        view: View::looking(Point3::ZERO, Point3::new(0.0, 0.0, -1.0), 45.0),
    };
    scene.view = match view {
        Some((eye, at, fov)) => View::looking((*eye).into(), (*at).into(), *fov),
        None => own_view(&desc, &scene.bounds()),
    };
    Ok(Some(scene))
}

fn import(path: &Path) -> anyhow::Result<Imported> {
    let imported = open(&path.to_string_lossy());
    if imported.diagnostics.has_errors() {
        bail!("{} cannot be read; `durer info` says why", path.display());
    }
    Ok(imported)
}

/// What the first camera of the file sees, or all from the front.
fn own_view(desc: &SceneDesc, bounds: &Bounds3) -> View {
    let Some(camera) = desc.cameras.first() else {
        return View::from_front(bounds);
    };
    let fov = camera.node.params.get("fov").and_then(|param| match &param.data {
        Data::Floats(values) => values.first().copied(),
        _ => None,
    });
    let placed = Transform::from_f64(&camera.world_from_camera.at(0.0));
    let axis = |x, y, z| placed.vector(Vector3::new(x, y, z)).normalize();
    View {
        eye: placed.point(Point3::ZERO),
        forward: axis(0.0, 0.0, 1.0),
        right: axis(1.0, 0.0, 0.0),
        up: axis(0.0, 1.0, 0.0),
        fov_degrees: fov.unwrap_or(90.0),
    }
}

/// The shapes of a description: each mesh once, with all its places.
struct Gathered {
    meshes: Vec<(Mesh, Vec<Transform>)>,
}

impl Gathered {
    fn of(desc: &SceneDesc, folder: &Path) -> anyhow::Result<Self> {
        let mut meshes: Vec<(Mesh, Vec<Transform>)> = Vec::new();
        let mut known: HashMap<usize, usize> = HashMap::new();
        for shape in &desc.shapes {
            // Shapes share what they are made of by sharing an allocation.
            let key = match &shape.source {
                ShapeSource::Mesh(id) => Arc::as_ptr(&desc.meshes[id.index()]).addr(),
                ShapeSource::Node(node) => Arc::as_ptr(node).addr(),
            };
            let index = match known.get(&key) {
                Some(index) => *index,
                None => {
                    let mesh = match &shape.source {
                        ShapeSource::Mesh(id) => plain(&desc.meshes[id.index()]),
                        ShapeSource::Node(node) => built(node, folder)?,
                    };
                    known.insert(key, meshes.len());
                    meshes.push((mesh, Vec::new()));
                    meshes.len() - 1
                }
            };
            meshes[index].1.push(Transform::from_f64(&shape.world_from_object.at(0.0)));
        }
        Ok(Self { meshes })
    }

    /// Meshes with one place are merged in world space, as durer does before it renders; the others are placed.
    fn finish(self) -> (Vec<Mesh>, Vec<Instance>) {
        let (mut merged, mut others) = (Mesh::default(), Vec::new());
        let mut instances = Vec::new();
        for (mesh, places) in self.meshes {
            if let [only] = places.as_slice() {
                let base = merged.positions.len() as u32;
                merged.positions.extend(mesh.positions.iter().map(|p| only.point(*p)));
                merged.indices.extend(mesh.indices.iter().map(|t| t.map(|vertex| vertex + base)));
            } else {
                others.push(mesh);
                instances
                    .extend(places.into_iter().map(|m| Instance { mesh: others.len(), placed: Some(m) }));
            }
        }
        instances.insert(0, Instance { mesh: 0, placed: None });
        others.insert(0, merged);
        (others, instances)
    }
}

fn plain(mesh: &durer::scene::Mesh) -> Mesh {
    Mesh { positions: mesh.positions.clone(), indices: mesh.indices.clone() }
}

/// The mesh that a node describes.
fn built(node: &Node, folder: &Path) -> anyhow::Result<Mesh> {
    let data = |name: &str| node.params.get(name).map(|param| &param.data);
    match (node.kind.as_str(), data("filename"), data("P"), data("indices")) {
        ("plymesh", Some(Data::Strings(files)), ..) => {
            let file: PathBuf = folder.join(files.first().context("plymesh names no file")?);
            let Imported { desc, .. } = import(&file)?;
            Ok(plain(desc.meshes.first().context("a PLY file without triangles")?))
        }
        ("trianglemesh", _, Some(Data::Floats(p)), Some(Data::Ints(indices))) => Ok(Mesh {
            positions: p.chunks_exact(3).map(|p| Point3::new(p[0], p[1], p[2])).collect(),
            indices: indices.chunks_exact(3).map(|t| [t[0] as u32, t[1] as u32, t[2] as u32]).collect(),
        }),
        (kind, ..) => bail!("shapes of kind \"{kind}\" are not traced here"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn meshes_used_twice_become_instances() {
        let mesh = |x: f32| Mesh { positions: vec![Point3::new(x, 0.0, 0.0); 3], indices: vec![[0, 1, 2]] };
        let up = Transform::translate(Vector3::new(0.0, 1.0, 0.0));
        let meshes =
            vec![(mesh(1.0), vec![up]), (mesh(2.0), vec![up, Transform::IDENTITY]), (mesh(3.0), vec![up])];
        let (meshes, instances) = Gathered { meshes }.finish();
        assert_eq!(meshes[0].indices, [[0, 1, 2], [3, 4, 5]]);
        assert_eq!(meshes[0].positions[3], Point3::new(3.0, 1.0, 0.0));
        let placed: Vec<_> = instances.iter().map(|i| (i.mesh, i.placed.is_some())).collect();
        assert_eq!(placed, [(0, false), (1, true), (1, true)]);
    }

    #[test]
    fn an_unknown_scene_is_refused() {
        assert!(scene("teapot", Path::new(".")).is_err());
        assert!(scene("atrium", Path::new("no such folder")).is_ok_and(|scene| scene.is_none()));
    }
}
