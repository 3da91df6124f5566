//! Meshes from files, which a stand-in for a folder holds.
use std::sync::Arc;

use durer_core::math::Point3;
use durer_model::shape::Geometry;
use durer_scene::{AssetError, Assets, Image, Mesh, Params};

use super::build;

/// A folder that holds `square.ply` and the damaged `bad.ply`.
pub(crate) struct Files;

fn missing<T>(path: &str) -> Result<T, AssetError> {
    Err(AssetError::Missing { path: path.to_owned() })
}

impl Assets for Files {
    fn bytes(&self, path: &str) -> Result<Arc<[u8]>, AssetError> {
        missing(path)
    }
    fn image(&self, path: &str) -> Result<Arc<Image>, AssetError> {
        missing(path)
    }
    fn mesh(&self, path: &str) -> Result<Arc<Mesh>, AssetError> {
        let corner = |x: f32, y: f32| Point3::new(x, y, 0.5);
        match path {
            "square.ply" => Ok(Arc::new(Mesh {
                positions: vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0)],
                indices: vec![[0, 1, 2]],
                ..Mesh::default()
            })),
            "bad.ply" => Err(AssetError::Format { path: path.to_owned(), reason: "line 3: no".to_owned() }),
            _ => missing(path),
        }
    }
}

#[test]
fn the_mesh_is_that_of_the_file() {
    let Ok(Geometry::Mesh(mesh)) = build("plymesh", Params::new().string("filename", "square.ply")) else {
        panic!("a mesh")
    };
    assert_eq!(mesh.indices, [[0, 1, 2]]);
}

#[test]
fn files_that_cannot_be_read_are_told() {
    let said = |name: &str| build("plymesh", Params::new().string("filename", name));
    assert!(
        build("plymesh", Params::new()).is_err_and(|m| m.contains("needs the parameter \"string filename\""))
    );
    // Where missing and damaged files are forgiven, nothing is shown.
    for name in ["none.ply", "bad.ply"] {
        assert!(said(name).is_ok_and(|g| matches!(g, Geometry::Mesh(m) if m.indices.is_empty())), "{name}");
    }
}
