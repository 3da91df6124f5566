//! What a build made.

/// Size and shape of an `Accel`. No times: this crate reads no clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BuildStats {
    /// Triangles stored, each geometry once; a quad is two.
    pub triangles: u64,
    /// Boxes of user geometry stored, each geometry once.
    pub user_primitives: u64,
    /// Segments of curves stored, each geometry once.
    pub curve_segments: u64,
    /// Points stored, each geometry once.
    pub points: u64,
    /// Placed instances.
    pub instances: u64,
    /// Nodes of all trees; 0 for brute force.
    pub nodes: u64,
    /// Heap memory held.
    pub bytes: u64,
    /// Longest way from the root of the instance tree down to a leaf of a geometry's tree, in edges.
    pub max_depth: u32,
}
