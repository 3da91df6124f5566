//! Triangles from a file of their own.
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{
    ALPHA, Displacement, Geometry,
    displace::{DISPLACEMENT, DISPLACEMENT_EDGE_LENGTH, EDGE_LENGTH},
};

/// The word `plymesh`.
#[derive(Clone, Copy, Debug)]
pub struct PlyMesh;

impl Kind for PlyMesh {
    type Output = Geometry;
    const SCHEMA: Schema = Schema {
        name: "plymesh",
        aliases: &[],
        doc: "Triangles and quadrilaterals of a PLY file, which may be compressed with gzip. The outside is where vertices are seen \
              counter-clockwise, unless vertex normals say otherwise.",
        params: &[
            ParamSpec::new("filename", ParamType::File, ParamDefault::Required, "The file."),
            ALPHA,
            DISPLACEMENT,
            EDGE_LENGTH,
            DISPLACEMENT_EDGE_LENGTH,
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Geometry> {
        if !args.is_sound() {
            return None;
        }
        // Textures are there once all shapes are built.
        Displacement::read(args);
        let mesh = args.mesh("filename");
        // A file that may be missing leaves an empty mesh.
        args.is_sound().then(|| Geometry::Mesh(mesh.unwrap_or_default()))
    }
}
