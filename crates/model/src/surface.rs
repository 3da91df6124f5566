//! The place where a ray met something.
use durer_core::math::{Normal3, Point2, Point3, Ray, Transform, Vector3, error::offset_ray_origin};

use crate::texture::TextureAt;

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
    /// Derivative of `p` by `uv.x`; not normalised.
    pub dpdu: Vector3,
    /// Derivative of `p` by `uv.y`; not normalised.
    pub dpdv: Vector3,
    /// Linear RGBA factor of the vertices; ones where a mesh has none.
    pub vertex_color: [f32; 4],
}

impl Surface {
    /// This surface of object space, placed by `m`; `reverse` turns the normals.
    #[must_use]
    pub fn placed(self, m: &Transform, reverse: bool) -> Self {
        let (p, p_error) = m.point_with_error(self.p, self.p_error);
        let turn = |n: Normal3| {
            let n = m.normal(n).normalize();
            if reverse { -n } else { n }
        };
        let (n_g, n_s) = (turn(self.n_g), turn(self.n_s));
        Self { p, p_error, n_g, n_s, dpdu: m.vector(self.dpdu), dpdv: m.vector(self.dpdv), ..self }
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
        TextureAt { uv: self.uv, p: self.p, vertex_color: self.vertex_color }
    }
}
