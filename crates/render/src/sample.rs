//! What travels through light transport: the context of a sample, its rays and what it yields.
use durer_core::{
    math::{Point2, Point3, Ray},
    sampling::Sampler,
    spectrum::{Basis, Spectrum},
};
use durer_model::{ShadeCx, medium::Inside};

use crate::{Imbalances, Lit, MediumStack, Scene};

/// What every function of light transport needs; the first argument everywhere.
#[derive(Clone, Copy)]
pub struct SampleCx<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Meaning of the spectral lanes of this sample.
    pub basis: Basis,
}

impl<'a> SampleCx<'a> {
    /// The part that materials need.
    pub fn shade(&self) -> ShadeCx<'a> {
        ShadeCx { basis: self.basis, textures: &self.scene.textures, log: None }
    }
}

/// A walk below a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Below {
    /// What it walks in.
    pub inside: Inside,
    /// Rays of the walk before this one.
    pub rays: u32,
    /// It met a particle.
    pub is_scattered: bool,
}

/// A ray with its place in the ray tree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathRay {
    /// The ray, in render space, with a direction of unit length unless it is a shadow ray.
    pub ray: Ray,
    /// What the parent multiplies this ray's radiance with.
    pub weight: Spectrum,
    /// Product of the weights from the eye to here: this ray's share in the pixel.
    pub throughput: Spectrum,
    /// Number of bounces before this ray; 0 for eye rays.
    pub depth: u32,
    /// The random numbers of this place in the tree.
    pub sampler: Sampler,
    /// How many rays share the place of one, over all bounces: 1 unless rays were distributed.
    pub siblings: f32,
    /// The density of all draws together of the lobe that the direction was drawn from, 1/sr, which weighs a light that is
    /// met against sampling the light; `None` where there was no choice. Behind what floats it is that of getting so far,
    /// too. Of rays to lights: the share of the light that is left to scattered rays, if nothing is in the way.
    pub density: Option<f32>,
    /// The density with which each lane would have drawn the path so far, by the mean over the lanes: 1 where nothing
    /// scatters them differently. See [`durer_model::medium::Flight`].
    pub lanes: Spectrum,
    /// Where lights were asked that the ray may meet.
    pub lit: Lit,
    /// What became of radiance by the index of refraction, from the eye to here; see [`durer_model::bsdf::Scattered::compression`].
    pub compression: f32,
    /// Some bounce before was blurred.
    pub is_blurred: bool,
    /// It went where only the leading wavelength goes: the others carry nothing.
    pub is_collapsed: bool,
    /// The point of a surface that the ray leaves; rounding errors before its origin, on the way all the same. The origin
    /// if it leaves none.
    pub from: Point3,
    /// The transparent bodies that the ray starts in.
    pub media: MediumStack,
    /// What walk below a surface the ray belongs to, if it belongs to one.
    pub below: Option<Below>,
    /// Metres since the last bounce: above 0 for rays that passed a surface which is not there.
    pub walked: f32,
    /// Such surfaces since the last bounce.
    pub passed: u32,
}

impl PathRay {
    /// The eye ray of a sample, in empty space.
    pub fn eye(ray: Ray, sampler: Sampler) -> Self {
        Self {
            ray,
            weight: Spectrum::ONE,
            throughput: Spectrum::ONE,
            depth: 0,
            sampler,
            siblings: 1.0,
            density: None,
            lanes: Spectrum::ONE,
            lit: Lit { p: ray.o, n: None, time: ray.time },
            compression: 1.0,
            is_blurred: false,
            is_collapsed: false,
            from: ray.o,
            media: MediumStack::default(),
            below: None,
            walked: 0.0,
            passed: 0,
        }
    }
    /// The `branch`-th ray spawned where this one ended, at `from`, in the same bodies.
    #[must_use]
    #[inline]
    pub fn child(&self, (from, ray): (Point3, Ray), weight: Spectrum, branch: u32) -> Self {
        Self {
            ray,
            weight,
            throughput: self.throughput * weight,
            depth: self.depth + 1,
            sampler: self.sampler.fork(branch),
            siblings: self.siblings,
            density: None,
            lit: Lit { p: from, n: None, time: ray.time },
            from,
            media: self.media,
            walked: 0.0,
            passed: 0,
            ..*self
        }
    }
    /// The continuation behind a surface that is not there, `walked` metres from where this one started: no bounce, and
    /// with the same random numbers.
    #[must_use]
    pub fn passing(
        &self,
        (from, ray): (Point3, Ray),
        weight: Spectrum,
        media: MediumStack,
        walked: f32,
    ) -> Self {
        Self {
            from,
            ray,
            weight,
            throughput: self.throughput * weight,
            media,
            walked: self.walked + walked,
            passed: self.passed + 1,
            ..*self
        }
    }
}

/// What the film stores of a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// Light, in the lanes of the sample's basis.
    Radiance(Spectrum),
    /// Up to three numbers that are no light: depth, normal, uv, id. `None` where nothing was hit.
    Data(Option<[f32; 3]>),
}

/// Light that a sample found for a place of the picture which is not its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Splat {
    /// The place, in pixels from the upper left corner; some lie around the picture.
    pub film: Point2,
    /// Radiance, for a picture of area 1: its mean over the samples of all pixels is that of the picture.
    pub radiance: Spectrum,
}

/// What one sample yields; one reusable buffer per worker.
#[derive(Clone, Debug, PartialEq)]
pub struct Contribution {
    /// The value.
    pub value: Value,
    /// Rays traced for it, shadow rays included.
    pub rays: u64,
    /// What was wrong with the bodies it went through.
    pub imbalances: Imbalances,
    /// What it found for other places. Whoever takes a sample empties it before the next.
    pub splats: Vec<Splat>,
}

impl Default for Contribution {
    fn default() -> Self {
        Self { value: Value::Data(None), rays: 0, imbalances: Imbalances::default(), splats: Vec::new() }
    }
}
