//! Ray against box: the slab test, rounded so that it misses nothing and is monotone in the box.
//!
//! A plane at `x` is met at `(x - o) * (1 / d)`. Each step of that is a monotone function of `x` in floating point, so a
//! box inside another is never entered earlier nor left later, bit for bit. Instead of bounding the error of every
//! result (Ize 2013, "Robust BVH Ray Traversal") the origin is moved once per ray, one way for lower and the other way
//! for upper planes, far enough to cover both these roundings and those of the shear in the triangle test (Woop,
//! Benthin, Wald 2013, "Watertight Ray/Triangle Intersection", section 4, does the same).
use durer_core::math::{Bounds3, Ray, error::gamma};
use wide::f32x4;

/// A ray's constants for testing boxes inside a known region.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slab {
    /// Origin to subtract from lower planes: moved up.
    o_lower: [f32; 3],
    /// Origin to subtract from upper planes: moved down.
    o_upper: [f32; 3],
    /// Reciprocal direction, never infinite.
    inverse: [f32; 3],
}

/// `min` and `max` in one instruction each; no argument is ever NaN.
#[inline(always)]
fn lesser(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}
#[inline(always)]
pub(crate) fn greater(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// Three coordinates in a vector; the fourth lane repeats the third.
#[inline(always)]
fn lanes([x, y, z]: [f32; 3]) -> f32x4 {
    f32x4::new([x, y, z, z])
}

impl Slab {
    /// For boxes inside `region` (which may be empty). `None` for a ray that can hit nothing: a zero or non-finite
    /// direction or a non-finite origin.
    pub(crate) fn new(ray: &Ray, region: &Bounds3) -> Option<Self> {
        let (o, d) = (lanes(ray.o.to_array()), lanes(ray.d.to_array()));
        let largest = greater(greater(ray.d.x.abs(), ray.d.y.abs()), ray.d.z.abs());
        // 0 x is 0 only for finite x: one comparison instead of six.
        let finite = (o * 0.0 + d * 0.0).simd_eq(f32x4::ZERO).all();
        if !(finite && largest > 0.0 && (1.0 / largest).is_finite()) {
            return None;
        }
        // A direction this much smaller than the largest moves the ray by less than the padding within the region;
        // the floor keeps products finite, so there is no 0 * infinity.
        let floor = 1e-18 * largest;
        let magnitude = d.abs().fast_max(f32x4::splat(floor)).copysign(d);
        let most = f32x4::splat(f32::MAX);
        let inverse = (f32x4::ONE / magnitude).fast_min(most).fast_max(-most);
        let (below, above) = (lanes(region.min.to_array()) - o, lanes(region.max.to_array()) - o);
        let reach = below.abs().fast_max(above.abs());
        // An empty region has no reach.
        let reach = reach.simd_le(most) & reach;
        let along = reach.to_array()[ray.d.max_axis()];
        // 3 roundings here, 3 in the shear of either triangle test, doubled; then that of moving the origin itself.
        let pad = (reach + along) * gamma(13) + (o.abs() * f32::EPSILON + f32::MIN_POSITIVE);
        let three = |v: f32x4| {
            let [x, y, z, _] = v.to_array();
            [x, y, z]
        };
        Some(Self { o_lower: three(o + pad), o_upper: three(o - pad), inverse: three(inverse) })
    }

    /// Where the ray enters and leaves a box; it misses if the first is greater.
    #[inline(always)]
    pub(crate) fn window(&self, min: &[f32; 3], max: &[f32; 3]) -> Window {
        let lower = |a: usize| (min[a] - self.o_lower[a]) * self.inverse[a];
        let upper = |a: usize| (max[a] - self.o_upper[a]) * self.inverse[a];
        let (x0, x1) = (lower(0), upper(0));
        let (y0, y1) = (lower(1), upper(1));
        let (z0, z1) = (lower(2), upper(2));
        Window {
            near: greater(greater(lesser(x0, x1), lesser(y0, y1)), lesser(z0, z1)),
            far: lesser(lesser(greater(x0, x1), greater(y0, y1)), greater(z0, z1)),
        }
    }
    /// The same for a box as the rest of the renderer knows it.
    pub(crate) fn window_of(&self, b: &Bounds3) -> Window {
        self.window(&b.min.to_array(), &b.max.to_array())
    }
}

/// The stretch of a ray inside a box.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Window {
    /// Entry.
    pub(crate) near: f32,
    /// Exit.
    pub(crate) far: f32,
}

impl Window {
    /// Of all of space.
    pub(crate) const ALL: Self = Self { near: f32::NEG_INFINITY, far: f32::INFINITY };

    /// Whether a hit in `[t_min, t_max]` is possible. Equality counts: ties are decided by id, not by traversal.
    #[inline(always)]
    pub(crate) fn admits(&self, t_min: f32, t_max: f32) -> bool {
        self.near <= self.far && self.near <= t_max && self.far >= t_min
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_core::math::{Point3, Vector3};

    fn unit() -> Bounds3 {
        Bounds3::new(Point3::ZERO, Point3::splat(1.0))
    }
    fn admits(o: [f32; 3], d: [f32; 3]) -> bool {
        let slab = Slab::new(&Ray::new(o.into(), d.into()), &unit()).expect("valid ray");
        slab.window_of(&unit()).admits(0.0, f32::INFINITY)
    }

    #[test]
    fn rays_in_planes_along_edges_and_through_corners_enter() {
        assert!(admits([-1.0, 0.0, 0.5], [1.0, 0.0, 0.0]), "in a face");
        assert!(admits([-1.0, 0.0, 1.0], [1.0, 0.0, -0.0]), "along an edge");
        assert!(admits([-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]), "through a corner");
        assert!(admits([1.0, 1.0, 1.0], [1.0, 1.0, 1.0]), "starting at a corner, leaving");
        assert!(!admits([-1.0, -1e-5, 0.5], [1.0, 0.0, 0.0]), "beside a face");
        assert!(!admits([2.0, 0.5, 0.5], [1.0, 0.0, 0.0]), "behind");
    }

    #[test]
    fn impossible_rays_are_refused() {
        for d in [[0.0; 3], [f32::NAN, 0.0, 0.0], [f32::INFINITY, 0.0, 0.0], [1e-44, 0.0, 0.0]] {
            assert!(Slab::new(&Ray::new(Point3::ZERO, d.into()), &unit()).is_none(), "{d:?}");
        }
        let far = Ray::new(Point3::splat(f32::INFINITY), Vector3::splat(1.0));
        assert!(Slab::new(&far, &unit()).is_none());
    }

    #[test]
    fn all_of_space_is_always_entered() {
        for d in [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.3, -0.2, 0.0]] {
            let slab =
                Slab::new(&Ray::new(Point3::splat(3.0), d.into()), &Bounds3::EMPTY).expect("valid ray");
            assert!(slab.window_of(&Bounds3::UNBOUNDED).admits(0.0, 0.0));
        }
    }
}
