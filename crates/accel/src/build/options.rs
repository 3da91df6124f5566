//! Choices of a build.
use crate::{Isa, grow::Preset};

/// How rays find their hits. Both give the same ones, bit for bit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Engine {
    /// Walk trees of boxes.
    #[default]
    Bvh,
    /// Test every primitive of every instance with every ray, shadow rays too, never stopping early: the lecture's
    /// loop, whose cost is exactly primitives times rays.
    BruteForce,
}

/// What rounding may do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Precision {
    /// Watertight: no ray slips between triangles that share an edge, none that starts off a surface by the error of
    /// its origin meets that again by rounding, no box hides a hit.
    #[default]
    Robust,
    /// A little faster, without these promises.
    Fast,
}

/// Choices of a build.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BuildOptions {
    /// How rays find their hits.
    pub engine: Engine,
    /// How much work goes into the trees.
    pub preset: Preset,
    /// What rounding may do.
    pub precision: Precision,
    /// Which instructions walk; `None` for the widest the processor has.
    pub isa: Option<Isa>,
}

/// How an instance is seen.
///
/// ```
/// use durer_accel::Visibility;
///
/// const SHADOWS: u32 = 0b100;
/// // Throws no shadow, and is a wall with one side only.
/// let seen = Visibility { mask: !SHADOWS, hides_backs: true, ..Visibility::default() };
/// assert_eq!(seen.mask & SHADOWS, 0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Visibility {
    /// Rays whose mask shares no bit with this one pass by.
    pub mask: u32,
    /// Rays that cull backs pass triangles whose vertices they see clockwise in object space: a placement that mirrors
    /// does not change which side is the back.
    pub hides_backs: bool,
    /// The other side is the back.
    pub is_reversed: bool,
    /// Hits are put to `UserGeometry::accepts` of queries that filter; false where it would let all of them count.
    pub is_filtered: bool,
}

impl Default for Visibility {
    fn default() -> Self {
        Self { mask: u32::MAX, hides_backs: false, is_reversed: false, is_filtered: true }
    }
}
