//! Shapes that are not triangles: the tree holds their boxes and calls back.
use durer_core::math::Ray;

use crate::PrimitiveHit;

/// Intersection routines of the boxes given to `AccelBuilder::user`.
///
/// `ray` is in the instance's object space; its direction keeps the scale of the instance's transform, so `t` means
/// the same as in the caller's space. `ray.t_max` is finite and shrinks as nearer hits are found.
pub trait UserGeometry {
    /// The smallest `t` in `[ray.t_min, ray.t_max]` at which `ray` meets the shape. It must not depend on `ray.t_max`
    /// other than through that bound, or results depend on the order of traversal.
    fn intersect(&self, instance: u32, prim: u32, ray: &Ray) -> Option<PrimitiveHit>;
    /// Whether `intersect` would return anything; override it where that is cheaper.
    fn occludes(&self, instance: u32, prim: u32, ray: &Ray) -> bool {
        self.intersect(instance, prim, ray).is_some()
    }
}

/// For scenes of triangles only: boxes, if there are any, are never hit.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoUserGeometry;

impl UserGeometry for NoUserGeometry {
    fn intersect(&self, _: u32, _: u32, _: &Ray) -> Option<PrimitiveHit> {
        None
    }
}
