//! Light from surfaces: every point sends out the same radiance in all directions of its outside.
//!
//! Light is gathered by choosing a point of the surface: spheres by their cone, rectangles and triangles by solid angle,
//! everything else by area, with `p(direction) = p(area) distance² / cos`. Which of these it is does not change the mean,
//! only the noise. The power is `pi L A`, twice that if both sides shine.
mod cone;
mod emitter;
mod form;
mod known;
mod piece;
mod placed;
mod rectangle;
mod triangle;

use std::f64::consts::PI;

use durer_core::{
    glam::DVec3,
    math::{
        Normal3, Point3, Vector3,
        error::{gamma, offset_ray_origin},
    },
    sampling::{Dim, Sampler},
    spectrum::{Basis, Color, Spectrum},
};
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{Light, LightBounds, LightCx, LightHit, LightSample, POWER, Track};
use crate::{Surface, shape::Geometry};
use emitter::Emitter;

/// What a surface sends out, before it is known which: the word `diffuse` of `AreaLightSource`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Emission {
    /// Radiance, or, if `power` is given, its colour.
    radiance: Color,
    /// Luminance of the whole power, W.
    power: Option<f32>,
    sides: Sides,
}

/// Which sides of a surface shine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sides {
    Outside,
    Both,
}

impl Kind for Emission {
    type Output = Self;
    const SCHEMA: Schema = Schema {
        name: "diffuse",
        aliases: &["area"],
        doc: "The shapes that follow, up to the end of the block, shine from every point of their outside equally in all \
              directions.",
        params: &[
            ParamSpec::color("L", [1.0; 3], "Radiance.").unit("W/(m² sr)").range(0.0, f32::INFINITY),
            ParamSpec::float("scale", 1.0, "Factor on the radiance.").range(0.0, f32::INFINITY),
            ParamSpec {
                doc: "Total power of each shape; replaces the magnitude of L, scale still applies.",
                ..POWER
            },
            ParamSpec::new("twosided", ParamType::Bool, ParamDefault::Bool(false), "The inside shines too."),
            ParamSpec::new("filename", ParamType::File, ParamDefault::Unset, "Not supported yet."),
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self> {
        if args.is_set("filename") {
            args.warning("filename", "images of area lights are not supported yet: the shape shines evenly");
        }
        let sides = if args.bool("twosided") { Sides::Both } else { Sides::Outside };
        let power = args.optional_float("power");
        // The area is not known yet: radiance is that of a power of 1 W from 1 m².
        let radiance = super::scaled(args, "L", "power", 1.0);
        let power = power.filter(|power| *power > 0.0);
        Some(Self { radiance, power, sides })
    }
}

/// A shape that shines, in its place.
#[derive(Debug)]
pub struct Area {
    emitter: Emitter,
    radiance: Color,
    sides: Sides,
}

impl Area {
    /// The light of `geometry` placed by `track`; `reversed` if its normals are turned.
    ///
    /// # Errors
    /// Why it cannot shine: it is infinite, or has no area.
    pub fn new(
        emission: &Emission,
        geometry: &Geometry,
        track: Track,
        orientation: Orientation,
    ) -> Result<Self, &'static str> {
        let emitter = Emitter::new(geometry, track, emission.sides, orientation == Orientation::Reversed)?;
        let sides = if emission.sides == Sides::Both { 2.0 } else { 1.0 };
        let factor = emission.power.map_or(1.0, |_| 1.0 / (PI * sides * emitter.area));
        Ok(Self { emitter, radiance: emission.radiance * factor as f32, sides: emission.sides })
    }

    /// Whether the side on which direction `w` lies shines, where the normal is `n`.
    fn shines(&self, n: DVec3, w: DVec3) -> bool {
        let cos = n.dot(w);
        cos > 0.0 || self.sides == Sides::Both && cos < 0.0
    }
}

/// Whether normals are as the shape has them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Orientation {
    /// They are.
    #[default]
    AsMade,
    /// They are turned.
    Reversed,
}

impl Light for Area {
    /// It was placed when it was made.
    fn place(&mut self, _track: &Track) {}

    fn sample(&self, cx: &LightCx, p: Point3, sampler: &Sampler) -> Option<LightSample> {
        let from = p.to_f64();
        let u = sampler.d2(Dim::Light);
        let (chosen, magnitude) = self.emitter.choose(from, cx.time, [u.x.into(), u.y.into()])?;
        let towards = chosen.p - from;
        let distance = towards.length();
        let weight = cx.basis.emission(self.radiance) * (1.0 / chosen.density) as f32;
        if !self.shines(chosen.n, -towards) || weight.is_black() || distance == 0.0 {
            return None;
        }
        // Shadow rays end before the surface by more than rounding can be wrong: that of the ray, which grows with its
        // length, and that of the placement.
        let rounded = Point3::from_f64(chosen.p);
        let slack = ((distance + magnitude) as f32) * gamma(8);
        let error = (rounded - Point3::ZERO).abs() * gamma(8) + Vector3::splat(slack);
        let back = Vector3::from_f64(-towards);
        let point = offset_ray_origin(rounded, error, Normal3::from_f64(chosen.n), back);
        let wi = Vector3::from_f64(towards / distance);
        Some(LightSample { wi, point: Some(point), weight, pdf: Some(chosen.density as f32) })
    }

    fn bounds(&self) -> Option<LightBounds> {
        let known = self.emitter.known;
        Some(LightBounds { intensity: known.intensity * self.radiance.luminance(), ..known })
    }

    fn power(&self, _radius: f32) -> f32 {
        let sides = if self.sides == Sides::Both { 2.0 } else { 1.0 };
        self.radiance.luminance() * (PI * sides * self.emitter.area) as f32
    }

    fn pdf(&self, cx: &LightCx, from: Point3, hit: &LightHit) -> f32 {
        let (from, p, n) = (from.to_f64(), hit.p.to_f64(), hit.n.to_f64());
        if !self.shines(n, from - p) {
            return 0.0;
        }
        self.emitter.density(from, cx.time, (p, n, hit.part)) as f32
    }

    fn emitted(&self, basis: Basis, surface: &Surface, wo: Vector3) -> Spectrum {
        let shines = self.shines(surface.n_g.to_f64(), wo.to_f64());
        if shines { basis.emission(self.radiance) } else { Spectrum::BLACK }
    }
}

/// The angle between two vectors, in `[0, pi]`, to full accuracy also near both ends.
fn between(a: DVec3, b: DVec3) -> f64 {
    libm::atan2(a.cross(b).length(), a.dot(b))
}

/// Two unit vectors perpendicular to unit `z` and each other (Duff et al. 2017).
fn frame(z: DVec3) -> [DVec3; 2] {
    let sign = 1f64.copysign(z.z);
    let a = -1.0 / (sign + z.z);
    let b = z.x * z.y * a;
    [DVec3::new(1.0 + sign * z.x * z.x * a, sign * b, -sign * z.x), DVec3::new(b, sign + z.y * z.y * a, -z.y)]
}
