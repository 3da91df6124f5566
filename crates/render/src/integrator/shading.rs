//! A hit made ready for shading, and the local terms all integrators share.
use durer_accel::Hit;
use durer_core::{
    Id,
    math::{Frame, Point3, Ray, Vector3},
    sampling::{Dim, Sampler},
    spectrum::Spectrum,
};
use durer_model::{
    Surface,
    bsdf::{BranchKind, Bsdf, Scattered, Seen},
    light::{LightCx, LightHit, LightSample},
    material::Material,
};

use crate::{Object, SampleCx, footprint::Onlooker};

/// Shadow rays use sampler branches from here on; scattered rays use those below.
pub(super) const LIGHT_BRANCH: u32 = 1 << 16;

/// What floats on the way of a ray uses sampler branches from here on.
pub(super) const MEDIUM_BRANCH: u32 = 1 << 14;

/// A surface point with its lobes.
pub(super) struct Shading<'a> {
    /// What was hit.
    pub(super) object: Id<Object>,
    /// Where.
    pub(super) surface: Surface,
    /// How it scatters.
    pub(super) bsdf: Bsdf<'a>,
    /// The frame of the lobes.
    pub(super) frame: Frame,
    /// Unit direction back along the ray.
    pub(super) wo: Vector3,
    /// The same in the frame of the lobes.
    pub(super) wo_local: Vector3,
    /// What the material sends out by itself.
    pub(super) emission: Spectrum,
    /// The light that was hit, if it was one.
    pub(super) lamp: Option<Lamp>,
    /// The ray's moment, in seconds.
    pub(super) time: f32,
}

/// A light that a ray hit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lamp {
    /// Its index in the scene.
    pub(super) light: u32,
    /// Where.
    pub(super) hit: LightHit,
    /// What it sends back along the ray.
    pub(super) radiance: Spectrum,
}

impl<'a> Shading<'a> {
    /// The place where `ray`, of unit direction, hit; without `onlooker` textures are not filtered.
    pub(super) fn at(cx: &SampleCx<'a>, ray: &Ray, hit: &Hit, onlooker: Option<Onlooker>) -> Self {
        let bsdf = |m: &'a dyn Material, s: &mut Surface| m.bsdf(&cx.shade(), s, -ray.d);
        Self::by(cx, (ray, hit), onlooker, bsdf)
    }

    /// The same for paths that follow light below the surface.
    pub(super) fn open(cx: &SampleCx<'a>, ray: &Ray, hit: &Hit, onlooker: Onlooker) -> Self {
        let bsdf = |m: &'a dyn Material, s: &mut Surface| m.open_bsdf(&cx.shade(), s, -ray.d);
        Self::by(cx, (ray, hit), Some(onlooker), bsdf)
    }

    fn by(
        cx: &SampleCx<'a>,
        (ray, hit): (&Ray, &Hit),
        onlooker: Option<Onlooker>,
        bsdf: impl FnOnce(&'a dyn Material, &mut Surface) -> Bsdf<'a>,
    ) -> Self {
        let (object, mut surface) = cx.scene.surface(ray, hit);
        if let Some(onlooker) = onlooker.filter(|o| o.asks(cx.scene.filters)) {
            surface.footprint = onlooker.footprint(&cx.scene.view, ray, hit.t, &surface);
        }
        let lamp = cx.scene.object(object).light.map(|light| {
            let part = cx.scene.resolve(hit).1;
            let radiance = cx.scene.lights[light as usize].emitted(cx.basis, &surface, -ray.d);
            Lamp { light, hit: LightHit { p: surface.p, n: surface.n_g, part }, radiance }
        });
        let material = cx.scene.material(object);
        let wo = -ray.d;
        let emission = material.emission(&cx.shade(), &surface.texture_at());
        let bsdf = bsdf(material, &mut surface);
        let frame = surface.frame();
        Self {
            object,
            bsdf,
            frame,
            wo,
            wo_local: frame.to_local(wo),
            emission,
            lamp,
            time: ray.time,
            surface,
        }
    }

    /// All that leaves the surface by itself: the material's emission, and what it sends out as a light.
    pub(super) fn sent_out(&self) -> Spectrum {
        self.lamp.map_or(self.emission, |lamp| self.emission + lamp.radiance)
    }

    /// The density with which sampling the light that was hit, from the point `from` that the ray came from, would have
    /// given this direction, 1/sr.
    pub(super) fn lamp_pdf(&self, cx: &SampleCx<'_>, lamp: &Lamp, from: Point3) -> f32 {
        let asked = LightCx { basis: cx.basis, time: self.time };
        cx.scene.lights[lamp.light as usize].pdf(&asked, from, &lamp.hit)
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
    /// or is none to cast shadow rays to. Pointless where all lobes are sharp. `seen` tells how other rays meet a light of
    /// which a direction is sampled with a density, so that it does not count twice.
    pub(super) fn light(
        &self,
        cx: &SampleCx<'_>,
        light: usize,
        sampler: &Sampler,
        seen: impl FnOnce(f32) -> Seen,
    ) -> Option<(Spectrum, LightSample)> {
        let asked = LightCx { basis: cx.basis, time: self.time };
        let sample = cx.scene.lights[light].sample(&asked, self.surface.p, sampler)?;
        // Light from the other side of the true surface comes through frosted glass only, whatever the shading normal says.
        if self.side_of(sample.wi) == BranchKind::Transmission && !self.bsdf.is_frosted() {
            return None;
        }
        let wi = self.frame.to_local(sample.wi);
        let f = match sample.pdf {
            None => self.bsdf.eval(self.wo_local, wi),
            Some(pdf) => self.bsdf.eval_shared(self.wo_local, wi, seen(pdf)),
        };
        Some((f * wi.z.abs(), sample))
    }

    /// The sample for which [`Shading::light`] says nothing, if that is because the light lies behind the surface.
    pub(super) fn behind(&self, cx: &SampleCx<'_>, light: usize, sampler: &Sampler) -> Option<LightSample> {
        let asked = LightCx { basis: cx.basis, time: self.time };
        cx.scene.lights[light].sample(&asked, self.surface.p, sampler)
    }

    /// A direction that is drawn from the lobes, if they send any.
    pub(super) fn scattered(&self, sampler: &Sampler) -> Option<Scattered> {
        // PERF: a number that decides nothing is not asked for (bench render).
        let choice = if self.bsdf.has_choice() { sampler.d1(Dim::Lobe) } else { 0.0 };
        self.bsdf.scatter(self.wo_local, choice, sampler.d2(Dim::Scatter))
    }

    /// What of light from `wi` goes to `wo`, as radiance, 1/sr, both in the frame of the lobes; `is_lone` if no path can meet
    /// what sends it.
    pub(super) fn radiance(&self, (wo, wi): (Vector3, Vector3), is_lone: bool) -> Spectrum {
        match is_lone {
            true => self.bsdf.eval_radiance(wo, wi),
            false => self.bsdf.eval_with_pdf(wo, wi).0,
        }
    }

    /// Density of all lobes together of going on along `to` after coming from `from`, 1/sr; both point away.
    pub(super) fn pdf(&self, from: Vector3, to: Vector3) -> f32 {
        let (from, to) = (self.frame.to_local(from), self.frame.to_local(to));
        self.bsdf.eval_with_pdf(from, to).1
    }

    /// Whether a ray that goes on in direction `d` stays on its side of the true surface or goes through.
    pub(super) fn side_of(&self, d: Vector3) -> BranchKind {
        match self.surface.is_outside(d) == self.surface.is_outside(self.wo) {
            true => BranchKind::Reflection,
            false => BranchKind::Transmission,
        }
    }

    /// Near silhouettes a shading normal can send a mirrored ray into the surface, or a refracted one out of it: such a
    /// direction is mirrored at the true surface.
    pub(super) fn keep_side(&self, d: Vector3, kind: BranchKind) -> Vector3 {
        if self.side_of(d) == kind {
            return d;
        }
        let n = Vector3::from(self.surface.n_g);
        d - n * (2.0 * n.dot(d))
    }
}
