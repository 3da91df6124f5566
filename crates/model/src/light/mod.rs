//! Light sources.
//!
//! A new light is one file here and one line in [`LIGHTS`].

mod ambient;
mod area;
mod beam;
mod distant;
mod emitted;
mod falloff;
mod goniometric;
mod gradient_sky;
mod ies;
pub(crate) mod infinite;
mod pattern_rays;
mod picture;
mod point;
mod projection;
mod sky;
mod sky_blur;
mod spot;
mod steps;
mod sun;
mod track;
mod tree;

use std::{
    f32::consts::{PI, TAU},
    fmt::Debug,
};

use durer_core::{
    glam::DAffine3,
    math::{
        Normal3, Point2, Point3, Vector3,
        float::{cos, sin, sqr},
    },
    sampling::Sampler,
    spectrum::{Basis, Color, LightColor, Spectrum},
};
use durer_scene::{Args, Entry, ParamDefault, ParamSpec, ParamType};

pub use self::{
    ambient::Ambient,
    area::{Area, Emission, Looks, Materials, Orientation, Textures},
    distant::Distant,
    emitted::{Emitted, Extent, Leaving, Source},
    goniometric::Goniometric,
    gradient_sky::GradientSky,
    ies::Ies,
    infinite::Infinite,
    point::Point,
    projection::Projection,
    sky::Sky,
    spot::Spot,
    steps::Steps,
    sun::Sun,
    track::Track,
    tree::{Cone, LightBounds, LightTree, Picked},
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
    /// The place on a surface that shines.
    pub on: Option<LightHit>,
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
    /// Moves what a light has in world space into render space, after [`Light::place`].
    fn place_portal(&mut self, render_from_world: &DAffine3) {
        let _ = render_from_world;
    }
    /// Light that could arrive at `p`, if nothing is in between; `sampler` picks a point of an extended light. `None` if
    /// nothing can arrive or the light is not sampled this way.
    fn sample(&self, cx: &LightCx, p: Point3, sampler: &Sampler) -> Option<LightSample> {
        let _ = (cx, p, sampler);
        None
    }
    /// Where it is and how it shines, by which one of many lights is chosen; `None` for lights infinitely far away and for
    /// those that do not fade with distance: they are chosen by [`Light::reach`].
    fn bounds(&self) -> Option<LightBounds> {
        None
    }
    /// An estimate of the irradiance at `p` on a surface of unit normal `n`, or facing the light, if it has no bounds: above
    /// 0 wherever [`Light::sample`] may give something. W/m², in luminance.
    fn reach(&self, p: Point3, n: Option<Normal3>, time: f32) -> f32 {
        let _ = (p, n, time);
        1.0
    }
    /// Luminance of all that it sends out, or into a scene of this `radius` if it is infinitely far away. W.
    fn power(&self, radius: f32) -> f32;
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
    /// Whether it is as bright in all directions, with nothing known of where it comes in. Then surfaces choose directions
    /// better than it does, by what they scatter: no path asks it.
    fn is_even(&self) -> bool {
        false
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
    /// A particle that leaves it, of those that may meet something in `within`: `u` chooses place and direction. `None` if
    /// that point is black, or the light does not send any.
    fn emit(&self, cx: &LightCx, within: &Extent, u: [Point2; 2]) -> Option<Emitted> {
        let _ = (cx, within, u);
        None
    }
    /// Densities with which [`Light::emit`] gives the place (1/m², 1 for points) and the direction (1/sr, 1 for parallel
    /// light) of a ray that leaves it; zeros if it gives none.
    fn emission_pdf(&self, cx: &LightCx, within: &Extent, ray: &Leaving) -> [f32; 2] {
        let _ = (cx, within, ray);
        [0.0; 2]
    }
    /// Whether [`Light::emit`] ever gives something.
    fn is_emitter(&self) -> bool {
        false
    }
    /// The most that it can send.
    fn bound(&self) -> LightBound;
    /// Whether it is a disk infinitely far away: sampled as a lamp, and seen by paths that left the scene.
    fn is_disk(&self) -> bool {
        false
    }
    /// Whether it surrounds the scene: it has an ambient term, which stands for shadow rays where no path is drawn, or is
    /// seen by rays that left.
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

/// The most that a light can send, over all directions, moments and channels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LightBound {
    /// Radiance that rays see which meet it or leave the scene, W/(m² sr).
    pub seen: f32,
    /// Its ambient term, W/(m² sr).
    pub ambient: f32,
    /// Of a light without extent: irradiance on a surface that faces it, W/m²; a metre from [`LightBound::fades_from`] if
    /// there is such a place, else anywhere. Infinite if it has no bound.
    pub facing: f32,
    /// The point that the light fades from with the square of the distance.
    pub fades_from: Option<Point3>,
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
    Entry::of::<Projection>(),
    Entry::of::<Goniometric>(),
    Entry::of::<Ies>(),
    Entry::of::<Infinite>(),
    Entry::of::<GradientSky>(),
    Entry::of::<Sky>(),
    Entry::of::<Sun>(),
    Entry::of::<Ambient>(),
];

/// Lights that are all around: what a picture of the surroundings replaces.
pub const SURROUNDINGS: &[&str] = &["infinite", "gradientsky", "sky"];

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
fn scaled(args: &mut Args<'_>, name: &str, total: &str, reach: f32) -> LightColor {
    let (color, scale) = (args.light_color(name), args.float("scale"));
    match args.optional_float(total) {
        Some(_) if color.luminance() <= 0.0 => {
            args.error(name, format!("a light of \"{total}\" needs a colour \"{name}\" that is not black"));
            LightColor::default()
        }
        Some(total) => {
            let factor = scale * total / (reach * color.luminance());
            color * factor
        }
        None => color * scale,
    }
}

/// The share of its mean that a sky counts for at least where its ambient term, which is tabulated, says next to nothing.
const LEAST_REACH: f32 = 0.05;

/// What a sky of this mean radiance sends into a sphere of that radius.
fn sky_power(mean: f32, radius: f32) -> f32 {
    4.0 * sqr(PI * radius) * mean
}

/// Density of directions that are spread evenly over the sphere, 1/sr.
pub const UNIFORM: f32 = 0.25 / PI;

/// One of them and its density; `u` in `[0, 1)²`.
pub(crate) fn uniform_direction(u: Point2) -> (Vector3, f32) {
    let r = 2.0 * (u.x * (1.0 - u.x)).sqrt();
    let azimuth = TAU * u.y;
    (Vector3::new(r * cos(azimuth), r * sin(azimuth), 1.0 - 2.0 * u.x), UNIFORM)
}

/// The largest component.
fn largest(color: Color) -> f32 {
    color.rgb.into_iter().fold(0.0, f32::max)
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
