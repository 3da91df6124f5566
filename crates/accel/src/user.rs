//! The caller's part of a query: shapes that are not triangles, whose boxes the tree holds, and hits that do not count.
use durer_core::math::Ray;

use crate::{Hit, PrimitiveHit};

/// Intersection routines of the boxes given to `AccelBuilder::user`.
///
/// `ray` is in the instance's object space; its direction keeps the scale of the instance's transform, so `t` means
/// the same as in the caller's space. It ends at `t_max`, which is finite and shrinks as nearer hits are found, whatever
/// `ray.t_max` says.
///
/// ```
/// use durer_accel::math::{Bounds3, Point3, Ray, Vector3};
/// use durer_accel::{AccelBuilder, BuildOptions, Placement, PrimitiveHit, UserGeometry};
///
/// /// Floors at these heights.
/// struct Floors(Vec<f32>);
///
/// impl UserGeometry for Floors {
///     fn intersect(&self, _instance: u32, prim: u32, ray: &Ray, t_max: f32) -> Option<PrimitiveHit> {
///         let t = (self.0[prim as usize] - ray.o.y) / ray.d.y;
///         (ray.t_min <= t && t <= t_max).then_some(PrimitiveHit { t, u: ray.at(t).x, v: ray.at(t).z })
///     }
/// }
///
/// let floors = Floors(vec![0.0, 3.0, 6.0]);
/// let around = |y: f32| Bounds3::new(Point3::new(-10.0, y, -10.0), Point3::new(10.0, y, 10.0));
/// let mut builder = AccelBuilder::new(BuildOptions::default());
/// let boxes = builder.user(floors.0.iter().map(|y| around(*y)).collect())?;
/// builder.instance(boxes, Placement::Identity)?;
/// let accel = builder.build()?;
///
/// let down = Ray::new(Point3::new(1.0, 5.0, 2.0), Vector3::new(0.0, -1.0, 0.0));
/// let hit = accel.query(&down).user(&floors).closest().expect("the floor at 3");
/// assert_eq!((hit.prim, hit.t, hit.u), (1, 2.0, 1.0));
/// # Ok::<(), durer_accel::BuildError>(())
/// ```
pub trait UserGeometry {
    /// True if hits are put to [`UserGeometry::accepts`].
    const FILTERS: bool = false;

    /// The smallest `t` in `[ray.t_min, t_max]` at which `ray` meets the shape. It must not depend on `t_max` other than
    /// through that bound, or results depend on the order of traversal.
    fn intersect(&self, instance: u32, prim: u32, ray: &Ray, t_max: f32) -> Option<PrimitiveHit>;
    /// Whether `intersect` would return anything; override it where that is cheaper.
    fn occludes(&self, instance: u32, prim: u32, ray: &Ray, t_max: f32) -> bool {
        self.intersect(instance, prim, ray, t_max).is_some()
    }
    /// Whether a hit, on a triangle or a shape, counts: false in the holes of a cut-out texture. The ray goes on through
    /// what it is refused, and meets other things at the same `t`; a shape that is refused is not asked again for a second
    /// meeting further on. Asked only if [`UserGeometry::FILTERS`], and of instances with `Visibility::is_filtered`.
    /// [`Hit::n_g`] is not known yet and zero.
    fn accepts(&self, hit: &Hit) -> bool {
        let _ = hit;
        true
    }
}

/// For scenes without shapes of the caller: boxes, if there are any, are never hit.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoUserGeometry;

impl UserGeometry for NoUserGeometry {
    fn intersect(&self, _: u32, _: u32, _: &Ray, _: f32) -> Option<PrimitiveHit> {
        None
    }
}

/// The same behind a pointer: traversal is compiled once, not for every caller.
pub(crate) trait Callback {
    fn intersect(&self, instance: u32, prim: u32, ray: &Ray, t_max: f32) -> Option<PrimitiveHit>;
    fn occludes(&self, instance: u32, prim: u32, ray: &Ray, t_max: f32) -> bool;
    fn accepts(&self, hit: &Hit) -> bool;
}

impl<U: UserGeometry> Callback for U {
    fn intersect(&self, instance: u32, prim: u32, ray: &Ray, t_max: f32) -> Option<PrimitiveHit> {
        UserGeometry::intersect(self, instance, prim, ray, t_max)
    }
    fn occludes(&self, instance: u32, prim: u32, ray: &Ray, t_max: f32) -> bool {
        UserGeometry::occludes(self, instance, prim, ray, t_max)
    }
    fn accepts(&self, hit: &Hit) -> bool {
        UserGeometry::accepts(self, hit)
    }
}
