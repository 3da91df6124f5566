//! What integrators tell their observers beside rays and hits.
use durer_core::{
    Id,
    math::{Point3, Vector3},
    sampling::Dim,
    spectrum::Spectrum,
};
use durer_model::{Fill, bsdf::Bsdf};

use crate::{MediumStack, Object};

/// What a shadow ray found out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightEvent {
    /// Index of the light in the scene.
    pub light: u32,
    /// The point on the light, in render space; `None` if it is infinitely far away.
    pub point: Option<Point3>,
    /// What arrives if nothing is in between: radiance divided by the density of the direction, or of lights without
    /// extent the irradiance on a plane that faces them.
    pub unoccluded: Spectrum,
    /// The share of it that passes what is in between: 1 where nothing is.
    pub passed: Spectrum,
    /// Something of it arrives.
    pub visible: bool,
    /// What keeps all of it, if something does; only looked for if the probe [`RECORDS`](super::Probe::RECORDS).
    pub blocker: Option<Id<Object>>,
}

/// A hit as it is shaded.
#[derive(Clone, Copy, Debug)]
pub struct Shaded<'a> {
    /// Unit direction back along the ray in the frame of the lobes, whose z axis is the shading normal.
    pub wo: Vector3,
    /// How the surface scatters, with the index of refraction that counts here.
    pub bsdf: &'a Bsdf<'a>,
    /// The transparent bodies before the surface.
    pub before: MediumStack,
    /// Those behind it.
    pub after: MediumStack,
    /// The share of light that is left at the start of the ray of what leaves the surface: 1 where nothing absorbs.
    pub arrived: Spectrum,
    /// Radiance that the surface sends out by itself, `arrived` included.
    pub emission: Spectrum,
    /// The ambient term, `arrived` included.
    pub ambient: Spectrum,
    /// The sky's blurred image in glossy lobes that no ray is drawn from, `arrived` included.
    pub blurred_sky: Spectrum,
}

/// What was on the way of a ray among what floats.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Floating {
    /// What it is.
    pub fill: Fill,
    /// What light from the end of the way is multiplied with: what is left of it, or scattered, by the density of this end.
    pub weight: Spectrum,
    /// What the volume sends out towards the start of the ray: part of its own light.
    pub sent: Spectrum,
    /// The probability of getting as far, over all lanes; 1 where nothing is drawn.
    pub passed: f32,
    /// The particle that the ray met, if it met one.
    pub particle: Option<Particle>,
}

/// Light that photons brought to a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gathered {
    /// Photons within the disc.
    pub photons: u32,
    /// Radius of the disc, in metres.
    pub radius: f32,
    /// What the surface scatters of it along the ray, as the ray's start sees it: part of its own light.
    pub radiance: Spectrum,
}

/// A place where light is scattered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Particle {
    /// Parameter of the ray.
    pub t: f32,
    /// Where it is, in render space.
    pub p: Point3,
    /// Absorption coefficient there, 1/m.
    pub sigma_a: Spectrum,
    /// Scattering coefficient there, 1/m.
    pub sigma_s: Spectrum,
    /// Mean cosine of the deflection.
    pub g: f32,
}

/// Random numbers of one decision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RandomNumbers {
    /// Which decision.
    pub dim: Dim,
    /// The numbers, in `[0, 1)`. Of decisions with one number the second is 0.
    pub u: [f32; 2],
    /// How many there are: 1 or 2.
    pub count: u8,
}

impl RandomNumbers {
    /// One number.
    pub fn one(dim: Dim, u: f32) -> Self {
        Self { dim, u: [u, 0.0], count: 1 }
    }
    /// Two numbers.
    pub fn two(dim: Dim, u: [f32; 2]) -> Self {
        Self { dim, u, count: 2 }
    }
    /// The numbers.
    pub fn numbers(&self) -> &[f32] {
        &self.u[..usize::from(self.count.min(2))]
    }
}

/// What chose the direction of a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChosenBy {
    /// A light was sampled, after it was chosen among all with [`Choice::chance`].
    Light,
    /// A lobe has but this direction: mirrors, smooth interfaces.
    Sharp,
    /// It was drawn from a lobe that spreads.
    Lobe,
    /// It was drawn from the phase function of a particle.
    Phase,
    /// It leads to a vertex of a walk from the other end.
    Joined,
}

/// How a ray and its weight came about:
///
/// - [`ChosenBy::Light`]: `weight = f cos mis / (rays chance)`. It multiplies [`LightEvent::unoccluded`], which holds the
///   division by `pdf`.
/// - [`ChosenBy::Sharp`]: `weight` is what the lobe reflects or transmits; `f`, `cos`, `pdf` do not apply.
/// - [`ChosenBy::Lobe`]: `weight = f cos / (pdf rays)`; `chance` is 1.
/// - [`ChosenBy::Phase`]: `weight = f / pdf`.
///
/// - [`ChosenBy::Joined`]: `weight = f cos mis cos' / d²`, with the cosine at the other vertex and the distance; it multiplies
///   what that vertex sends. Of particles `weight` is 0: what they bring is part of other rays.
///
/// Whatever is lost on the way along the parent ray is part of `f`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Choice {
    /// What chose.
    pub by: ChosenBy,
    /// Name of the lobe; `None` if lights were sampled, which all lobes reflect.
    pub lobe: Option<&'static str>,
    /// Value of all lobes for this direction if a light was sampled, else of the one, 1/sr. If `mis` differs from lobe to
    /// lobe it holds each by its share, with the same mean over the lanes.
    pub f: Option<Spectrum>,
    /// Cosine between the direction and the shading normal, 0 to 1; 1 at particles, which have none.
    pub cos: Option<f32>,
    /// Density of choosing this direction, 1/sr; `None` for lights without extent and sharp directions.
    pub pdf: Option<f32>,
    /// Density with which the other strategy would have chosen it, 1/sr: the lobe, if a light was sampled; sampling the
    /// light, if a drawn ray met one. `None` where there is no other.
    pub other_pdf: Option<f32>,
    /// Weight of multiple importance sampling, 0 to 1: of a sampled light over all lobes, by what they reflect; of a drawn
    /// ray that of the emission of the light it met. `None` where there is one strategy.
    pub mis: Option<f32>,
    /// Probability with which this light was chosen among all, above 0 up to 1; 1 where there was no choice.
    pub chance: f32,
    /// Probability with which chance let the ray live (Russian roulette); 1 where it was not asked.
    pub kept: f32,
    /// The number that chose the light.
    pub light_choice: Option<RandomNumbers>,
    /// How many rays share this one's place.
    pub rays: u32,
    /// The random numbers that decided; `None` if there was nothing to decide.
    pub random: Option<RandomNumbers>,
}

impl Choice {
    /// That of the only direction of a sharp lobe without a name.
    pub fn sharp() -> Self {
        Self {
            by: ChosenBy::Sharp,
            lobe: None,
            f: None,
            cos: None,
            pdf: None,
            other_pdf: None,
            mis: None,
            chance: 1.0,
            kept: 1.0,
            light_choice: None,
            rays: 1,
            random: None,
        }
    }
}
