//! Triangle meshes as plain arrays.
use durer_core::math::{Normal3, Point2, Point3, Segment};
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
    /// A number of each triangle's face, for textures that ask for it; empty if there are none.
    pub faces: Vec<u32>,
    /// A second set of them, for textures that ask for it.
    pub second_uvs: Vec<Point2>,
    /// Tangents with handedness in the fourth number (glTF): bitangent = w * cross(normal, tangent).
    pub tangents: Vec<[f32; 4]>,
    /// Linear RGBA factors per vertex.
    pub colors: Vec<[f32; 4]>,
    /// The moment of `positions` in seconds; of no account for a mesh that keeps its shape.
    pub time: f32,
    /// Where the vertices are later: between keys each moves on a straight line, before the first and after the last it
    /// stands still. Empty for a mesh that keeps its shape.
    pub later: Vec<VertexKey>,
}

/// All vertices of a mesh at another moment.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct VertexKey {
    /// In seconds, after that of the key before.
    pub time: f32,
    /// As many as the mesh has.
    pub positions: Vec<Point3>,
    /// As many; between keys they change evenly. Empty if they are those of the first key.
    pub normals: Vec<Normal3>,
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
    /// There are numbers of faces, but not one for each triangle.
    #[error("there are {found} numbers of faces for {triangles} triangles")]
    Faces {
        /// How many.
        found: usize,
        /// Triangles.
        triangles: usize,
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
    /// The moments of the vertex keys do not rise.
    #[error("vertex key {key} is not later than the one before it")]
    Time {
        /// Which key, counted from 1.
        key: usize,
    },
    /// A position is infinite or NaN.
    #[error("vertex {vertex} is not finite")]
    NotFinite {
        /// Which vertex.
        vertex: usize,
    },
}

impl Mesh {
    /// Whether it changes its shape.
    pub fn is_still(&self) -> bool {
        self.later.is_empty()
    }
    /// How many keys it has: 1 if it keeps its shape.
    pub fn keys(&self) -> usize {
        1 + self.later.len()
    }
    /// The moment of a key, in seconds, and where the vertices are then; the last key if there are fewer.
    pub fn key(&self, key: usize) -> (f32, &[Point3]) {
        let found = key.checked_sub(1).and_then(|later| self.later.get(later).or(self.later.last()));
        found.map_or((self.time, &self.positions), |k| (k.time, &k.positions))
    }
    /// Where `vertices` are at `time` seconds; the origin for one that is not there.
    pub fn corners(&self, vertices: [usize; 3], time: f32) -> [Point3; 3] {
        let of = |positions: &[Point3], i: usize| positions.get(i).copied().unwrap_or(Point3::ZERO);
        if self.is_still() {
            return vertices.map(|i| of(&self.positions, i));
        }
        let segment = Segment::at(time, self.keys(), |key| self.key(key).0);
        let (a, b) = (self.key(segment.key).1, self.key(segment.key + 1).1);
        vertices.map(|i| segment.point(of(a, i), of(b, i)))
    }
    /// The normals of `vertices` at `time` seconds; `None` if the mesh has none. Not of unit length.
    pub fn corner_normals(&self, vertices: [usize; 3], time: f32) -> Option<[Normal3; 3]> {
        let of = |normals: &[Normal3]| {
            let [p, q, r] = vertices.map(|i| normals.get(i).copied());
            Some([p?, q?, r?])
        };
        if self.later.iter().all(|key| key.normals.is_empty()) {
            return of(&self.normals);
        }
        let at = |key: usize| {
            let own = key.checked_sub(1).and_then(|later| self.later.get(later)).map(|key| &key.normals);
            of(own.filter(|normals| !normals.is_empty()).unwrap_or(&self.normals))
        };
        let Segment { key, u } = Segment::at(time, self.keys(), |key| self.key(key).0);
        let ([a0, a1, a2], [b0, b1, b2]) = (at(key)?, at(key + 1)?);
        Some([(a0, b0), (a1, b1), (a2, b2)].map(|(a, b)| a * (1.0 - u) + b * u))
    }
    /// Checks array lengths, indices and positions.
    ///
    /// # Errors
    /// The first thing found wrong.
    pub fn validate(&self) -> Result<(), MeshError> {
        let vertices = self.positions.len();
        let lengths = [
            ("normals", self.normals.len()),
            ("texture coordinates", self.uvs.len()),
            ("second texture coordinates", self.second_uvs.len()),
            ("tangents", self.tangents.len()),
            ("colors", self.colors.len()),
        ];
        for (attribute, found) in lengths {
            if found != 0 && found != vertices {
                return Err(MeshError::Length { attribute, found, vertices });
            }
        }
        let (found, triangles) = (self.faces.len(), self.indices.len());
        if found != 0 && found != triangles {
            return Err(MeshError::Faces { found, triangles });
        }
        let mut before = self.time;
        for (key, VertexKey { time, positions, normals }) in (1..).zip(&self.later) {
            if positions.len() != vertices {
                return Err(MeshError::Length { attribute: "vertex key", found: positions.len(), vertices });
            }
            // Where the first key has none there is nothing to change.
            let wanted = self.normals.len();
            if !normals.is_empty() && normals.len() != wanted {
                let attribute = "normals of a vertex key";
                return Err(MeshError::Length { attribute, found: normals.len(), vertices: wanted });
            }
            if !(before < *time && time.is_finite() && before.is_finite()) {
                return Err(MeshError::Time { key });
            }
            before = *time;
        }
        let of_keys = self.later.iter().map(|k| &k.positions);
        for positions in std::iter::once(&self.positions).chain(of_keys) {
            if let Some(vertex) = positions.iter().position(|p| !p.is_finite()) {
                return Err(MeshError::NotFinite { vertex });
            }
        }
        for (triangle, t) in self.indices.iter().enumerate() {
            if let Some(&vertex) = t.iter().find(|&&i| i as usize >= vertices) {
                return Err(MeshError::Index { triangle, vertex, vertices });
            }
        }
        Ok(())
    }
}
