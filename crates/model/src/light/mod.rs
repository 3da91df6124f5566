//! Light sources.
//!
//! A new light is one file here and one line in [`LIGHTS`].

mod ambient;
mod area;
mod distant;
mod falloff;
mod gradient_sky;
pub(crate) mod infinite;
mod point;
mod sky_blur;
mod spot;
mod track;

use std::fmt::Debug;

use durer_core::{
    math::{Normal3, Point3, Vector3},
    sampling::Sampler,
    spectrum::{Basis, Color, Spectrum},
};
use durer_scene::{Args, Entry, ParamDefault, ParamSpec, ParamType};

pub use self::{
    ambient::Ambient,
    area::{Area, Emission, Orientation},
    distant::Distant,
    gradient_sky::GradientSky,
    infinite::Infinite,
    point::Point,
    spot::Spot,
    track::Track,
};
use crate::Surface;

/// Light arriving at a point from one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSample {
    /// Unit direction towards the light.
    pub wi: Vector3,
    /// The point on the light; `None` if it is infinitely far away.
    pub point: Option<Point3>,
    /// Incident radiance divided by the density of sampling `wi`; for lights without extent the irradiance on a plane
    /// facing `wi`. Reflected radiance is `f cos weight`. W/m² (of a unit scene).
    pub weight: Spectrum,
    /// Density of sampling `wi`, 1/sr; `None` for lights without extent, which no scattered ray can meet.
    pub pdf: Option<f32>,
}

/// What lights need to know of a ray.
#[derive(Clone, Copy, Debug)]
pub struct LightCx {
    /// Meaning of the lanes.
    pub basis: Basis,
    /// The moment, in seconds.
    pub time: f32,
}

/// A light, in render space once placed.
pub trait Light: Debug + Send + Sync {
    /// Moves the light from its own space into render space, where `track` goes. Lights that surround the scene stand
    /// still where it begins.
    fn place(&mut self, track: &Track);
    /// Light that could arrive at `p`, if nothing is in between; `sampler` picks a point of an extended light. `None` if
    /// nothing can arrive or the light is not sampled this way.
    fn sample(&self, cx: &LightCx, p: Point3, sampler: &Sampler) -> Option<LightSample> {
        let _ = (cx, p, sampler);
        None
    }
    /// A cheap estimate of the irradiance at `p` on a surface that faces the light, by which one light is chosen among
    /// several: above 0 wherever [`Light::sample`] may give something. W/m², in luminance.
    fn reach(&self, p: Point3, time: f32) -> f32 {
        let _ = (p, time);
        1.0
    }
    /// The density with which [`Light::sample`], asked at `from`, gives the direction of a point of this light, 1/sr; 0 if
    /// that side of it does not shine, and for lights that rays cannot meet.
    fn pdf(&self, cx: &LightCx, from: Point3, hit: &LightHit) -> f32 {
        let _ = (cx, from, hit);
        0.0
    }
    /// Whether [`Light::sample`] ever gives something.
    fn is_sampled(&self) -> bool {
        true
    }
    /// The density with which [`Light::sample`], asked at `from`, gives the direction `d` of a ray that left the scene,
    /// 1/sr; 0 for lights that do not surround it.
    fn pdf_escaped(&self, cx: &LightCx, from: Point3, d: Vector3) -> f32 {
        let _ = (cx, from, d);
        0.0
    }
    /// Radiance that leaves a point of this light in unit direction `wo`; black for lights that rays cannot meet.
    fn emitted(&self, basis: Basis, surface: &Surface, wo: Vector3) -> Spectrum {
        let _ = (basis, surface, wo);
        Spectrum::BLACK
    }
    /// Whether it surrounds the scene: it is not sampled, but has an ambient term or is seen by rays that left.
    fn surrounds(&self) -> bool {
        false
    }
    /// The ambient term: unoccluded irradiance on a surface facing `n`, divided by pi.
    fn ambient(&self, basis: Basis, n: Normal3) -> Spectrum {
        let _ = (basis, n);
        Spectrum::BLACK
    }
    /// The unoccluded radiance arriving about unit direction `d`, blurred as a glossy reflection of the given GGX
    /// `alpha` in `[0, 1]` sees it.
    fn glossy_ambient(&self, basis: Basis, d: Vector3, alpha: f32) -> Spectrum {
        let _ = (basis, d, alpha);
        Spectrum::BLACK
    }
    /// Radiance along a ray of unit direction `d` that left the scene.
    fn escaped(&self, basis: Basis, d: Vector3) -> Spectrum {
        let _ = (basis, d);
        Spectrum::BLACK
    }
}

/// A point of a light that a ray met.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightHit {
    /// The point.
    pub p: Point3,
    /// Unit geometric normal, on the outside.
    pub n: Normal3,
    /// Which triangle or patch of the shape it belongs to.
    pub part: u32,
}

/// All kinds of light that shapes can be.
pub const AREA_LIGHTS: &[Entry<Emission>] = &[Entry::of::<Emission>()];

/// All kinds of light.
pub const LIGHTS: &[Entry<Box<dyn Light>>] = &[
    Entry::of::<Point>(),
    Entry::of::<Distant>(),
    Entry::of::<Spot>(),
    Entry::of::<Infinite>(),
    Entry::of::<GradientSky>(),
    Entry::of::<Ambient>(),
];

/// Words of pbrt-v4 that are known but not built yet.
pub const NOT_YET: &[&str] = &["goniometric", "projection"];

/// Lights that are all around: what a picture of the surroundings replaces.
pub const SURROUNDINGS: &[&str] = &["infinite", "gradientsky"];

/// Factor on the intensity of lights without extent.
const INTENSITY_SCALE: ParamSpec =
    ParamSpec::float("scale", 1.0, "Factor on the intensity.").range(0.0, f32::INFINITY);
/// Power of lights without extent.
const POWER: ParamSpec = ParamSpec::new(
    "power",
    ParamType::Float,
    ParamDefault::Unset,
    "Total power; replaces the magnitude of I, scale still applies.",
)
.unit("W")
.range(0.0, f32::INFINITY);
/// Position of lights without extent.
const POSITION: ParamSpec =
    ParamSpec::new("from", ParamType::Point3, ParamDefault::Triple([0.0; 3]), "Position.").unit("m");

/// The colour parameter `name` times `scale`. If `total` is given, it is the luminance that the quantity reached by the
/// factor `reach` shall have before `scale` (pbrt-v4's `power` and `illuminance`): it replaces the colour's magnitude.
fn scaled(args: &mut Args<'_>, name: &str, total: &str, reach: f32) -> Color {
    let (color, scale) = (args.color(name), args.float("scale"));
    match args.optional_float(total) {
        Some(_) if color.luminance() <= 0.0 => {
            args.error(name, format!("a light of \"{total}\" needs a colour \"{name}\" that is not black"));
            Color::BLACK
        }
        Some(total) => color * (scale * total / (reach * color.luminance())),
        None => color * scale,
    }
}

/// The unit vector from `from` to `to`; complains if they are equal.
fn axis(args: &mut Args<'_>, from: Point3, to: Point3) -> Option<Vector3> {
    let d = to - from;
    if d.length_squared() == 0.0 {
        args.error("to", "\"from\" and \"to\" are the same point: the light has no direction");
        return None;
    }
    Some(d.normalize())
}
