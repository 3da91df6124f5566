//! What compiling found and took: sizes of the geometry, and wall time per phase.
use std::{collections::HashMap, sync::Arc, time::Duration};

use durer_model::shape::Geometry;
use durer_scene::{Mesh, SceneDesc, ShapeSource};

use super::geometry::Placed;

/// What a triangle costs in the kernel, in bytes: its vertices and number (44), and its share in the boxes above it,
/// which lie in pairs of 64 bytes with about two triangles in a leaf.
const BYTES_OF_TRIANGLE: u64 = 44 + 32;

/// The same for an instance, with its placement.
const BYTES_OF_INSTANCE: u64 = 320;

/// Facts about a compilation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Report {
    /// Sizes of what was described.
    pub geometry: GeometryCounts,
    /// Heap memory of the copies of meshes that were moved to where they stand, in bytes.
    pub placed_mesh_bytes: u64,
    /// Bytes that the kernel was expected to take, guessed from the counts before it was built.
    pub expected_bytes: u64,
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
            expected_bytes: counts.expected_bytes(),
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
                (ShapeSource::Node(_), None) => None,
            };
            let Some(mesh) = mesh else { continue };
            counts.triangles_placed += mesh.indices.len() as u64;
            let uses = uses.entry(Arc::as_ptr(mesh)).or_default();
            *uses += 1;
            if *uses == 1 {
                counts.meshes += 1;
                counts.triangles += mesh.indices.len() as u64;
                counts.vertices += mesh.positions.len() as u64;
                counts.mesh_bytes += mesh_bytes(mesh);
            }
        }
        counts.shared_placements = uses.values().filter(|&&uses| uses > 1).sum();
        counts
    }

    /// Bytes the kernel will take, roughly.
    fn expected_bytes(&self) -> u64 {
        let items = self.triangles + self.other_shapes;
        items * BYTES_OF_TRIANGLE + self.shared_placements * BYTES_OF_INSTANCE
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
        + size_of_val(mesh.tangents.as_slice())
        + size_of_val(mesh.colors.as_slice())
        + later;
    total as u64
}
