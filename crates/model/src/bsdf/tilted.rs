//! A reflecting layer whose normal is not that of the surface below it: a clear coat over a normal map, or with one of its own.
//!
//! It reflects as if its normal were that of the surface, `f cos = f_p <i,p>` with `f_p` the lobe about the normal `p`, so that
//! a coat over a rugged body looks as smooth as it is. With `n` the normal of the lobes, `f = f_p <i,p> / <i,n>`: where the two
//! normals differ it is `f <i,n> / <i,p>` that is reciprocal, as with all shading normals. No more leaves than arrives.
use durer_core::{
    math::{Frame, Normal3, Point2, Vector3},
    spectrum::Spectrum,
};

use super::{Branch, BranchKind, Drawn, Glossy, GlossyView, lobe::mirrored};

/// Least cosine of a direction that is reflected.
const LEAST: f32 = 1e-6;

/// A glossy lobe about a normal of its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tilted {
    /// The lobe, about `normal`.
    pub glossy: Glossy,
    /// Unit, in the frame of the lobes; z is above 0.
    pub normal: Vector3,
}

impl Tilted {
    fn frame(&self) -> Frame {
        Frame::from_z(Normal3::from(self.normal))
    }
    /// Both directions about the own normal; `None` if they are not both on the same side of both normals.
    fn local(&self, wo: Vector3, wi: Vector3) -> Option<(Vector3, Vector3)> {
        let up = wo.z.signum();
        let frame = self.frame();
        let (o, i) = (frame.to_local(wo * up), frame.to_local(wi * up));
        (wi.z * up > LEAST && o.z > 0.0 && i.z > 0.0).then_some((o, i))
    }
    /// Value without the cosine, 1/sr.
    pub fn eval(&self, wo: Vector3, wi: Vector3) -> Spectrum {
        match self.local(wo, wi) {
            Some((o, i)) => self.glossy.eval(o, i) * (i.z / wi.z.abs()),
            None => Spectrum::BLACK,
        }
    }
    /// Density of [`Tilted::draw`] at `wi`, 1/sr.
    pub fn pdf(&self, wo: Vector3, wi: Vector3) -> f32 {
        self.local(wo, wi).map_or(0.0, |(o, i)| self.glossy.pdf(o, i))
    }
    /// The direction at a point of the unit square; `None` if it goes into the surface.
    pub(super) fn draw(&self, wo: Vector3, u: Point2) -> Option<Drawn> {
        let up = wo.z.signum();
        let frame = self.frame();
        let o = frame.to_local(wo * up);
        let drawn = if o.z > 0.0 { self.glossy.draw(o, u)? } else { return None };
        let i = frame.to_world(drawn.branch.wi);
        let branch = Branch { wi: i * up, ..drawn.branch };
        (i.z > LEAST).then_some(Drawn { branch, ..drawn })
    }
    /// Share of the light from a uniform sky that leaves towards `wo`, at most, without the factor of its scale.
    pub fn directional_albedo(&self, wo: Vector3) -> Spectrum {
        let cos = wo.dot(self.normal) * wo.z.signum();
        if cos > 0.0 { self.glossy.albedo_at(cos.min(1.0)) } else { Spectrum::BLACK }
    }
    /// The direction that it mirrors sharply, and the one it comes from about the own normal; `None` if it leads into the
    /// surface.
    fn mirror(&self, wo: Vector3) -> Option<(Vector3, Vector3)> {
        let up = wo.z.signum();
        let frame = self.frame();
        let o = frame.to_local(wo * up);
        let i = frame.to_world(mirrored(o));
        (o.z > 0.0 && i.z > 0.0).then_some((i * up, o))
    }
    /// The mirrored ray of integrators that draw no directions.
    pub(super) fn branch(&self, wo: Vector3) -> Option<Branch> {
        let (wi, o) = self.mirror(wo)?;
        Some(Branch { kind: BranchKind::Reflection, wi, weight: self.glossy.branch_weight(o) })
    }
    pub(super) fn view(&self, wo: Vector3) -> Option<GlossyView> {
        let (wi, o) = self.mirror(wo)?;
        self.glossy.view(o).map(|view| GlossyView { wi, ..view })
    }
}
