//! Ray against curve: cubic strands with a radius at every control point, for hair, fur, grass and threads.
//!
//! In the frame of the ray, in f64, each kind of curve becomes a polynomial in the parameter along the curve, and all of
//! its roots in `[0, 1]` are found: [`CurveKind::Round`] one of degree 6, [`CurveKind::Flat`] one of degree 5,
//! [`CurveKind::Oriented`] one of degree 8. No curve is cut into cones or quads, so silhouettes are smooth at any
//! distance and results do not depend on a tessellation rate. A hit lies on its surface, and nothing of the surface lies
//! before it, within `1e-6` of the radius and the rounding of `t` to f32 (tests `curves`, against dense sampling).
//!
//! Radii and positions are in the units of the space the ray is in. Iterations are bounded whatever the input is.
mod basis;
mod bernstein;
mod bounds;
mod bracket;
mod check;
mod error;
mod flat;
mod joint;
mod lowest;
mod oriented;
mod ray_frame;
mod round;
mod strand;
mod surface;

use durer_core::{
    glam::DVec3,
    math::{Bounds3, Point3, Ray, Vector3},
};

pub use basis::CurveBasis;
pub(crate) use bounds::parts;
pub use error::CurveError;
pub use ray_frame::RayFrame;
pub use surface::CurveSurface;

use strand::Strand;

/// What surface a curve has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CurveKind {
    /// The solid union of the balls around all points of the curve: a tube with half balls at both ends. A ray that
    /// starts inside meets the surface on its way out. Segments that follow one another in [`Curves::segments`], the first
    /// ending with the ball that the second begins with, are one solid without walls between them, as long as the strand runs through itself at its joints only.
    Round,
    /// A ribbon, twice the radius wide, that faces every ray. Its ends are cut straight: segments that meet at an angle
    /// leave a wedge open outside of the bend, and those that continue one another smoothly do not. Hits no more than two radii away
    /// from the ray's origin do not count, because a ribbon that turns with the ray passes through almost any point of
    /// the strand.
    Flat,
    /// A ribbon, twice the radius wide, across [`Curves::normals`] and the curve's direction.
    Oriented,
}

/// Curves of one kind: segments over shared control points.
#[derive(Clone, Debug, PartialEq)]
pub struct Curves {
    /// What surface they have.
    pub kind: CurveKind,
    /// How control points make a segment.
    pub basis: CurveBasis,
    /// Control points.
    pub points: Vec<Point3>,
    /// Half the thickness at each control point, 0 or more, blended like the points. A strand is not hit where that makes
    /// 0, or less than 0, as Catmull and Rom's spline can.
    pub radii: Vec<f32>,
    /// [`CurveKind::Oriented`]: a normal at each control point, of any length, blended like the points. Else empty.
    pub normals: Vec<Vector3>,
    /// The first control point of each segment; the others follow it.
    pub segments: Vec<u32>,
}

/// A meeting of ray and curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveHit {
    /// Ray parameter.
    pub t: f32,
    /// Along the segment, in `[0, 1]`.
    pub u: f32,
    /// Across, in `[-1, 1]`: where between both edges. Round and flat curves: edges as the ray sees them, positive on the
    /// side of the ray's direction times the curve's; what hair scattering calls `h`. Oriented curves: positive on the
    /// side of the normal times the curve's direction.
    pub v: f32,
    /// Unit normal of the surface. Round: out of the solid. Flat: towards the ray's origin, as far as a perpendicular of
    /// the curve can be. Oriented: on the side of the given normals.
    pub n_g: Vector3,
}

impl Curves {
    /// The box around a segment: contains every ball around its points, and so all kinds of surface. Infinite where
    /// that leaves the range of f32.
    ///
    /// # Panics
    /// If there is no such segment, or the curves are not sound ([`Self::check`]).
    pub fn bounds(&self, segment: u32) -> Bounds3 {
        bounds::bounds(self, segment)
    }

    /// The nearest place with `t` in `[ray.t_min, t_max]` where the ray meets the segment, further from the origin than
    /// its own error bound. `ray.t_max` is not looked at. `None` for rays that can hit nothing.
    ///
    /// # Panics
    /// If there is no such segment, or the curves are not sound ([`Self::check`]).
    pub fn intersect(&self, segment: u32, ray: &Ray, t_max: f32) -> Option<CurveHit> {
        self.intersect_in(&RayFrame::new(ray)?, segment, t_max)
    }
    /// [`Self::intersect`] for many segments and one ray, whose constants are computed once.
    ///
    /// # Panics
    /// As that does.
    pub fn intersect_in(&self, frame: &RayFrame, segment: u32, t_max: f32) -> Option<CurveHit> {
        let strand = Strand::near(self, segment, frame, t_max)?;
        match self.kind {
            CurveKind::Round => round::intersect(self, segment, &strand, frame, t_max),
            CurveKind::Flat => flat::intersect(&strand, frame, t_max),
            CurveKind::Oriented => oriented::intersect(self, segment, &strand, frame, t_max),
        }
    }

    /// The `i`th control value of a segment; the last one again for those that a basis does not have.
    fn control<T: Copy>(&self, values: &[T], segment: u32, i: usize) -> T {
        let first = self.segments[segment as usize] as usize;
        values[first + i.min(self.basis.points() - 1)]
    }
    fn bezier<T: Copy>(&self, values: &[T], segment: u32, mut turn: impl FnMut(T) -> DVec3) -> [[f64; 4]; 3] {
        let p: [DVec3; 4] = std::array::from_fn(|i| turn(self.control(values, segment, i)));
        std::array::from_fn(|axis| self.basis.to_bezier(p.map(|p| p[axis])))
    }
    /// Bezier control values of each coordinate, the points moved by `place` first.
    fn bezier_points(&self, segment: u32, place: impl FnMut(Point3) -> DVec3) -> [[f64; 4]; 3] {
        self.bezier(&self.points, segment, place)
    }
    fn bezier_normals(&self, segment: u32, turn: impl Fn(Vector3) -> DVec3) -> [[f64; 4]; 3] {
        self.bezier(&self.normals, segment, turn)
    }
    fn bezier_radii(&self, segment: u32) -> [f64; 4] {
        let radii = std::array::from_fn(|i| f64::from(self.control(&self.radii, segment, i)));
        self.basis.to_bezier(radii)
    }
}
