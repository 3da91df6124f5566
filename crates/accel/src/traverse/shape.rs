//! Shapes that are not triangles: curves and points are met here, all others by the caller.
use durer_core::math::{Ray, Vector3};

use super::Cx;
use crate::{PrimitiveHit, geometry::Items};

impl Cx<'_> {
    /// Where `ray`, in object space, first meets a shape with `t` in `[ray.t_min, t_max]`.
    #[inline(never)]
    pub(crate) fn meet(&self, instance: u32, prim: u32, ray: &Ray, t_max: f32) -> Option<PrimitiveHit> {
        match self.accel.items(instance) {
            Items::Curves(curves, _) => {
                let hit = curves.intersect(prim, ray, t_max)?;
                Some(PrimitiveHit { t: hit.t, u: hit.u, v: hit.v })
            }
            Items::Points(points, _) => {
                let hit = points.intersect(prim, ray, t_max)?;
                Some(PrimitiveHit { t: hit.t, u: 0.0, v: 0.0 })
            }
            _ => self.callback.intersect(instance, prim, ray, t_max),
        }
    }

    /// Whether [`Self::meet`] would return anything.
    #[inline(never)]
    pub(crate) fn is_met(&self, instance: u32, prim: u32, ray: &Ray, t_max: f32) -> bool {
        match self.accel.items(instance) {
            Items::Curves(..) | Items::Points(..) => self.meet(instance, prim, ray, t_max).is_some(),
            _ => self.callback.occludes(instance, prim, ray, t_max),
        }
    }

    /// The normal where `ray`, in render space, first meets a shape; zero for those of the caller. The shape is met once
    /// more: its normal need not be kept for hits that nearer ones beat.
    #[inline(never)]
    pub(crate) fn shape_normal(&self, instance: u32, prim: u32, ray: &Ray) -> Vector3 {
        let pose = &self.accel.instances[instance as usize].pose;
        let object_ray = || pose.object_ray(ray).unwrap_or(*ray);
        let found = match self.accel.items(instance) {
            Items::Curves(curves, _) => curves.intersect(prim, &object_ray(), f32::MAX).map(|hit| hit.n_g),
            Items::Points(points, _) => points.intersect(prim, &object_ray(), f32::MAX).map(|hit| hit.n_g),
            _ => None,
        };
        found.unwrap_or(Vector3::ZERO)
    }
}
