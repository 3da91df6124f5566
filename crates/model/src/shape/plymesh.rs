//! Triangles from a file of their own.
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{ALPHA, Geometry};

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
            ParamSpec::new(
                "displacement",
                ParamType::FloatTexture,
                ParamDefault::Unset,
                "Not supported yet.",
            ),
            ParamSpec::float("edgelength", 1.0, "Of displaced triangles; not supported yet.").unit("m"),
            ParamSpec::float("displacement.edgelength", 1.0, "The same in pbrt's words; not supported yet.")
                .unit("m"),
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Geometry> {
        if !args.is_sound() {
            return None;
        }
        for name in ["displacement", "displacement.edgelength"] {
            if args.is_set(name) {
                args.warning(name, format!("\"{name}\" is not supported yet and has no effect"));
            }
        }
        let mesh = args.mesh("filename");
        // A file that may be missing leaves an empty mesh.
        args.is_sound().then(|| Geometry::Mesh(mesh.unwrap_or_default()))
    }
}
