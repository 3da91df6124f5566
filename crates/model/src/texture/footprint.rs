//! The part of a surface that a sample stands for, as textures see it: a parallelogram around the point that is looked
//! up, spanned by what a step to the right and a step down in the picture make of it (Igehy 1999, "Tracing Ray
//! Differentials").
use durer_core::math::Vector3;

use crate::Surface;

/// A derivative of texture coordinates is never larger: near the horizon of a plane it would be infinite.
const MOST: f32 = 1e8;

/// Which textures are to average over a footprint.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Habit {
    /// Those that were told to by a parameter.
    #[default]
    Asked,
    /// Those too that pbrt-v4 filters unasked.
    AsPbrt,
}

/// A footprint; all zero where none is known, which makes every texture a look-up of one point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Footprint {
    /// What a step to the right adds to the point, in metres of render space.
    pub dpdx: Vector3,
    /// What a step down adds.
    pub dpdy: Vector3,
    /// What these steps add to the surface coordinates.
    pub duvdx: [f32; 2],
    /// The same of the step down.
    pub duvdy: [f32; 2],
    /// Who is to use it.
    pub habit: Habit,
}

impl Footprint {
    /// A single point.
    pub const POINT: Self = Self {
        dpdx: Vector3::ZERO,
        dpdy: Vector3::ZERO,
        duvdx: [0.0; 2],
        duvdy: [0.0; 2],
        habit: Habit::Asked,
    };

    /// The footprint on `surface` that two tangents of it span, in metres of render space. Steps in surface coordinates are
    /// those whose points come nearest to the tangents (least squares); 0 where the surface has no such coordinates.
    pub fn on(surface: &Surface, [dpdx, dpdy]: [Vector3; 2], habit: Habit) -> Self {
        let (u, v) = (surface.dpdu.to_f64(), surface.dpdv.to_f64());
        let (uu, uv, vv) = (u.dot(u), u.dot(v), v.dot(v));
        let determinant = uu * vv - uv * uv;
        let steps = |d: Vector3| {
            let d = d.to_f64();
            let (du, dv) = (u.dot(d), v.dot(d));
            [(vv * du - uv * dv) / determinant, (uu * dv - uv * du) / determinant].map(|c| sound(c as f32))
        };
        let finite = |d: Vector3| if d.is_finite() { d } else { Vector3::ZERO };
        Self { duvdx: steps(dpdx), duvdy: steps(dpdy), dpdx: finite(dpdx), dpdy: finite(dpdy), habit }
    }

    /// Whether it is but a point.
    pub fn is_point(&self) -> bool {
        self.dpdx == Vector3::ZERO && self.dpdy == Vector3::ZERO
    }

    /// What a texture shall use that nobody told whether to filter.
    pub(super) fn usual(&self) -> &Self {
        if self.habit == Habit::AsPbrt { self } else { &Self::POINT }
    }
}

fn sound(c: f32) -> f32 {
    if c.is_finite() { c.clamp(-MOST, MOST) } else { 0.0 }
}
