//! What compiling found and took: sizes of the geometry, and wall time per phase.
use std::{collections::HashMap, sync::Arc, time::Duration};

use durer_model::shape::Geometry;
use durer_scene::{Mesh, SceneDesc, ShapeSource};

use super::geometry::Placed;

/// Bytes in the kernel for each thing of a kind, with its share in the boxes above it: in the finished trees, and at
/// most while they are built, trees included.
///
/// Measured as `Accel::stats` and as the growth of resident memory until the trees were done, with 16 and with 8 boxes a
/// node, for spheres of 8192 and 524288 triangles, a scanned dragon of 871414, a million small and 300000 large random
/// triangles: balanced trees keep 67 to 97 bytes for each and take 100 to 181 to build. Of 200000 meshes of a triangle
/// each took 562 and 846, of 100000 placements of a mesh 272 and 510, of a million small shapes 189 and 388.
struct Cost {
    kept: u64,
    building: u64,
}

/// The scene: the node at the root and lists.
const SCENE: Cost = Cost { kept: 1024, building: 4096 };
/// A triangle: packets of 8 have 320 bytes, and are mostly filled with 4 to 6.
const TRIANGLE: Cost = Cost { kept: 100, building: 192 };
/// A shape that is no triangle: it is alone in its leaf.
const SHAPE: Cost = Cost { kept: 192, building: 400 };
/// A mesh beside its triangles.
const MESH: Cost = Cost { kept: 544, building: 800 };
/// A placement of a mesh that is placed several times; those that move take the most.
const PLACEMENT: Cost = Cost { kept: 448, building: 704 };

/// Facts about a compilation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Report {
    /// Sizes of what was described.
    pub geometry: GeometryCounts,
    /// Heap memory of the copies of meshes that were moved to where they stand, in bytes.
    pub placed_mesh_bytes: u64,
    /// Heap memory that textures take beside their images: smaller copies of them, in bytes.
    pub texture_bytes: u64,
    /// Heap memory of what was measured of materials, a shared file once, in bytes.
    pub measured_bytes: u64,
    /// Bytes that the kernel was expected to take, guessed from the counts before it was built. Most scenes take less.
    pub expected_bytes: u64,
    /// The same at most while it was built, the finished kernel included.
    pub building_bytes: u64,
    /// Wall time per phase.
    pub times: Times,
}

/// Wall time of the phases of compilation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Times {
    /// Images decoded; textures and materials built.
    pub textures: Duration,
    /// Shapes built from their parameters and files, meshes placed.
    pub geometry: Duration,
    /// Trees built over triangles, shapes and instances.
    pub acceleration: Duration,
}

/// Triangles and other shapes of a scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GeometryCounts {
    /// Triangles of all meshes, a shared mesh once.
    pub triangles: u64,
    /// Triangles of meshes that bend, as often as there are pairs of keys; a shared mesh once.
    pub moving_triangles: u64,
    /// Triangles of all placed meshes, a shared mesh as often as it is placed.
    pub triangles_placed: u64,
    /// Vertices of all meshes, a shared mesh once.
    pub vertices: u64,
    /// Shapes that are no meshes, as often as they are placed.
    pub other_shapes: u64,
    /// Meshes, a shared one once.
    pub meshes: u64,
    /// Placements of meshes that are placed several times.
    pub shared_placements: u64,
    /// Heap memory of the meshes, a shared one once, in bytes.
    pub mesh_bytes: u64,
}

impl Report {
    /// Puts together what was counted; `geometry` is the time of shapes and of placing them with the trees above them.
    pub(super) fn new(
        counts: GeometryCounts,
        placed: &Placed,
        textures: Duration,
        geometry: Duration,
    ) -> Self {
        let acceleration = placed.building;
        Self {
            geometry: counts,
            placed_mesh_bytes: placed.placed_mesh_bytes,
            texture_bytes: 0,
            measured_bytes: 0,
            expected_bytes: counts.bytes(|cost| cost.kept),
            building_bytes: counts.bytes(|cost| cost.building),
            times: Times { textures, geometry: geometry.saturating_sub(acceleration), acceleration },
        }
    }
}

impl GeometryCounts {
    /// Counts what a description's shapes have become: built from their nodes, or meshes of the description.
    pub(super) fn of(desc: &SceneDesc, built: &[Option<Geometry>]) -> Self {
        let mut counts = Self::default();
        let mut uses: HashMap<*const Mesh, u64> = HashMap::new();
        for (shape, built) in desc.shapes.iter().zip(built) {
            let mesh = match (&shape.source, built) {
                (ShapeSource::Mesh(id), _) => desc.meshes.get(id.index()),
                (ShapeSource::Node(_), Some(Geometry::Mesh(mesh))) => Some(mesh),
                (ShapeSource::Node(_), Some(Geometry::Shapes(parts))) => {
                    counts.other_shapes += parts.len() as u64;
                    None
                }
                (ShapeSource::Node(_), Some(Geometry::Strands(strands))) => {
                    counts.other_shapes += strands.count() as u64;
                    None
                }
                (ShapeSource::Node(_), None) => None,
            };
            let Some(mesh) = mesh else { continue };
            counts.triangles_placed += mesh.indices.len() as u64;
            let uses = uses.entry(Arc::as_ptr(mesh)).or_default();
            *uses += 1;
            if *uses == 1 {
                counts.meshes += 1;
                counts.triangles += mesh.indices.len() as u64;
                counts.moving_triangles += (mesh.indices.len() * mesh.later.len()) as u64;
                counts.vertices += mesh.positions.len() as u64;
                counts.mesh_bytes += mesh_bytes(mesh);
            }
        }
        counts.shared_placements = uses.values().filter(|&&uses| uses > 1).sum();
        counts
    }

    /// Bytes that the kernel will take, of one side of [`Cost`].
    fn bytes(&self, of: impl Fn(&Cost) -> u64) -> u64 {
        // Triangles that move have two places, in a tree for each pair of keys.
        let triangles = self.triangles + 2 * self.moving_triangles;
        of(&SCENE)
            + triangles * of(&TRIANGLE)
            + self.other_shapes * of(&SHAPE)
            + self.meshes * of(&MESH)
            + self.shared_placements * of(&PLACEMENT)
    }
}

/// Heap memory of a mesh.
pub(super) fn mesh_bytes(mesh: &Mesh) -> u64 {
    let later: usize = mesh.later.iter().map(|key| size_of_val(key.positions.as_slice())).sum();
    let total = size_of_val(mesh.positions.as_slice())
        + size_of_val(mesh.indices.as_slice())
        + size_of_val(mesh.normals.as_slice())
        + size_of_val(mesh.uvs.as_slice())
        + size_of_val(mesh.second_uvs.as_slice())
        + size_of_val(mesh.faces.as_slice())
        + size_of_val(mesh.tangents.as_slice())
        + size_of_val(mesh.colors.as_slice())
        + later;
    total as u64
}
