//! The place where a ray met something.
use durer_core::math::{Frame, Normal3, Point2, Point3, Ray, Transform, Vector3, error::offset_ray_origin};

use crate::texture::{Footprint, TextureAt};

/// A point on a surface with everything shading needs; made once per hit, lazily.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// The point.
    pub p: Point3,
    /// Bound on the absolute error of each coordinate of `p`.
    pub p_error: Vector3,
    /// Geometric normal, unit, pointing to the outside.
    pub n_g: Normal3,
    /// Shading normal, unit: interpolated or from a normal map, in the hemisphere of `n_g`.
    pub n_s: Normal3,
    /// Surface coordinates for textures.
    pub uv: Point2,
    /// The second set of a mesh; the first where there is none.
    pub second_uv: Point2,
    /// The number that a mesh gives its face; 0 where it gives none.
    pub face: u32,
    /// Derivative of `p` by `uv.x`; not normalised.
    pub dpdu: Vector3,
    /// Derivative of `p` by `uv.y`; not normalised.
    pub dpdv: Vector3,
    /// Linear RGBA factor of the vertices; ones where a mesh has none.
    pub vertex_color: [f32; 4],
    /// The part of the surface that a sample stands for, where textures want to know it; a point elsewhere.
    pub footprint: Footprint,
}

impl Surface {
    /// This surface of object space, placed by `m`; `reverse` turns the normals.
    ///
    /// The error bound covers the way here and the way back: a spawned ray is mapped into object space again before it
    /// is intersected, which rounds its origin once more.
    #[must_use]
    pub fn placed(self, m: &Transform, reverse: bool) -> Self {
        let (p, there) = m.point_with_error(self.p, self.p_error);
        let (_, back) = m.point_back_with_error(p, Vector3::ZERO);
        // NUMERICS: twice, because the coefficients of both matrices are rounded too
        // (grazing_rays_never_meet_the_surface_they_leave).
        let p_error = there + m.reach(back * 2.0);
        let turn = |n: Normal3| {
            let n = m.normal(n).normalize();
            if reverse { -n } else { n }
        };
        let n_g = turn(self.n_g);
        let n_s = if self.n_s == self.n_g { n_g } else { turn(self.n_s) };
        Self { p, p_error, n_g, n_s, dpdu: m.vector(self.dpdu), dpdv: m.vector(self.dpdv), ..self }
    }
    /// The same place with its normals turned.
    #[must_use]
    pub fn reversed(self) -> Self {
        Self { n_g: -self.n_g, n_s: -self.n_s, ..self }
    }
    /// The frame that lobes live in: z is the shading normal.
    pub fn frame(&self) -> Frame {
        Frame::from_z(self.n_s)
    }
    /// True if direction `w`, pointing away from the surface, lies on its outside.
    pub fn is_outside(&self, w: Vector3) -> bool {
        self.n_g.dot(w) > 0.0
    }
    /// The ray that leaves towards `d`, started beyond the error of `p` so that it cannot meet this surface by rounding.
    pub fn spawn(&self, d: Vector3, time: f32) -> Ray {
        Ray { time, ..Ray::new(offset_ray_origin(self.p, self.p_error, self.n_g, d), d) }
    }
    /// The segment from here to `to`, which is meant to be visible: it ends one rounding error before it.
    pub fn spawn_to(&self, to: Point3, time: f32) -> Ray {
        let o = offset_ray_origin(self.p, self.p_error, self.n_g, to - self.p);
        Ray { t_max: 1.0f32.next_down(), time, ..Ray::new(o, to - o) }
    }
    /// Where textures are looked up.
    pub fn texture_at(&self) -> TextureAt {
        TextureAt {
            uv: self.uv,
            second_uv: self.second_uv,
            face: self.face,
            p: self.p,
            n: self.n_g,
            vertex_color: self.vertex_color,
            footprint: self.footprint,
        }
    }
}
