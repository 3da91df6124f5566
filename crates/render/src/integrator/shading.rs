//! A hit made ready for shading, and the local terms all integrators share.
use durer_accel::Hit;
use durer_core::{
    Id,
    math::{Frame, Ray, Vector3},
    sampling::Sampler,
    spectrum::Spectrum,
};
use durer_model::{
    Surface,
    bsdf::{BranchKind, Bsdf},
    light::{LightCx, LightSample},
};

use crate::{Object, SampleCx};

/// A surface point with its lobes.
pub(super) struct Shading {
    /// What was hit.
    pub(super) object: Id<Object>,
    /// Where.
    pub(super) surface: Surface,
    /// How it scatters.
    pub(super) bsdf: Bsdf,
    /// The frame of the lobes.
    pub(super) frame: Frame,
    /// Unit direction back along the ray.
    pub(super) wo: Vector3,
    /// The same in the frame of the lobes.
    pub(super) wo_local: Vector3,
    /// What the surface sends out by itself.
    pub(super) emission: Spectrum,
    /// The ray's moment, in seconds.
    pub(super) time: f32,
}

impl Shading {
    /// The place where `ray`, of unit direction, hit.
    pub(super) fn at(cx: &SampleCx<'_>, ray: &Ray, hit: &Hit) -> Self {
        let (object, mut surface) = cx.scene.surface(ray, hit);
        let material = cx.scene.material(object);
        let wo = -ray.d;
        let emission = material.emission(&cx.shade(), &surface.texture_at());
        let bsdf = material.bsdf(&cx.shade(), &mut surface, wo);
        let frame = surface.frame();
        Self { object, bsdf, frame, wo, wo_local: frame.to_local(wo), emission, time: ray.time, surface }
    }

    /// The ambient term.
    pub(super) fn ambient(&self, cx: &SampleCx<'_>) -> Spectrum {
        let n = self.surface.n_s.face_forward(self.wo);
        let coefficient = self.bsdf.ambient();
        let mut sum = Spectrum::BLACK;
        if !coefficient.is_black() {
            for light in cx.scene.surroundings() {
                sum += coefficient * light.ambient(cx.basis, n);
            }
        }
        sum
    }

    /// The sky's blurred image in glossy lobes that no ray is drawn from.
    pub(super) fn blurred_sky(&self, cx: &SampleCx<'_>) -> Spectrum {
        let mut sum = Spectrum::BLACK;
        if let Some(glossy) = self.bsdf.glossy(self.wo_local) {
            let d = self.frame.to_world(glossy.wi);
            for light in cx.scene.surroundings() {
                sum += glossy.weight * light.glossy_ambient(cx.basis, d, glossy.alpha);
            }
        }
        sum
    }

    /// A sample of one light and what its arriving light is multiplied with; `None` if the light lies behind the surface
    /// or is none to cast shadow rays to. Pointless where all lobes are sharp.
    pub(super) fn light(
        &self,
        cx: &SampleCx<'_>,
        light: usize,
        sampler: &Sampler,
    ) -> Option<(Spectrum, LightSample)> {
        let asked = LightCx { basis: cx.basis, time: self.time };
        let sample = cx.scene.lights[light].sample(&asked, self.surface.p, sampler)?;
        // Light from the other side of the true surface does not come through, whatever the shading normal says.
        if self.surface.is_outside(sample.wi) != self.surface.is_outside(self.wo) {
            return None;
        }
        let wi = self.frame.to_local(sample.wi);
        Some((self.bsdf.eval(self.wo_local, wi) * wi.z.abs(), sample))
    }

    /// Near silhouettes a shading normal can send a mirrored ray into the surface, or a refracted one out of it: such a
    /// direction is mirrored at the true surface.
    pub(super) fn keep_side(&self, d: Vector3, kind: BranchKind) -> Vector3 {
        let same_side = self.surface.is_outside(d) == self.surface.is_outside(self.wo);
        if same_side == (kind == BranchKind::Reflection) {
            return d;
        }
        let n = Vector3::from(self.surface.n_g);
        d - n * (2.0 * n.dot(d))
    }
}
