//! Triangle meshes as plain arrays.
use durer_core::math::{Normal3, Point2, Point3};
use serde::Serialize;

/// An indexed triangle mesh in object space. Optional arrays are empty or as long as `positions`.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Mesh {
    /// Vertices.
    pub positions: Vec<Point3>,
    /// Triangles, counter-clockwise seen from the side the normal points to.
    pub indices: Vec<[u32; 3]>,
    /// Vertex normals; need not be of unit length.
    pub normals: Vec<Normal3>,
    /// Texture coordinates; `v` grows upwards, (0, 0) is an image's lower left corner.
    pub uvs: Vec<Point2>,
    /// Tangents with handedness in the fourth number (glTF): bitangent = w * cross(normal, tangent).
    pub tangents: Vec<[f32; 4]>,
    /// Linear RGBA factors per vertex.
    pub colors: Vec<[f32; 4]>,
}

/// Why arrays make no mesh.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MeshError {
    /// A triangle names a vertex that is not there.
    #[error("triangle {triangle} refers to vertex {vertex}, but there are only {vertices} vertices")]
    Index {
        /// Which triangle.
        triangle: usize,
        /// The index it holds.
        vertex: u32,
        /// How many there are.
        vertices: usize,
    },
    /// An attribute array has the wrong length.
    #[error("{attribute} has {found} entries for {vertices} vertices")]
    Length {
        /// Which array.
        attribute: &'static str,
        /// Its length.
        found: usize,
        /// The length wanted.
        vertices: usize,
    },
    /// A position is infinite or NaN.
    #[error("vertex {vertex} is not finite")]
    NotFinite {
        /// Which vertex.
        vertex: usize,
    },
}

impl Mesh {
    /// Checks array lengths, indices and positions.
    ///
    /// # Errors
    /// The first thing found wrong.
    pub fn validate(&self) -> Result<(), MeshError> {
        let vertices = self.positions.len();
        let lengths = [
            ("normals", self.normals.len()),
            ("texture coordinates", self.uvs.len()),
            ("tangents", self.tangents.len()),
            ("colors", self.colors.len()),
        ];
        for (attribute, found) in lengths {
            if found != 0 && found != vertices {
                return Err(MeshError::Length { attribute, found, vertices });
            }
        }
        if let Some(vertex) = self.positions.iter().position(|p| !p.is_finite()) {
            return Err(MeshError::NotFinite { vertex });
        }
        for (triangle, t) in self.indices.iter().enumerate() {
            if let Some(&vertex) = t.iter().find(|&&i| i as usize >= vertices) {
                return Err(MeshError::Index { triangle, vertex, vertices });
            }
        }
        Ok(())
    }
}
