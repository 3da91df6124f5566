//! A cone of light from one point: intensity `I` inside the inner cone, fading to 0 at the outer one.
//!
//! pbrt-v4's falloff: `smoothstep` of the cosine to the axis, from `cos(coneangle)` (0) to
//! `cos(coneangle - conedeltaangle)` (1). As the mean of smoothstep is 1/2, the power is
//! `2 pi I ((1 - cos inner) + (cos inner - cos outer) / 2)`.
use std::f32::consts::{PI, TAU};

use durer_core::{
    math::{
        Frame, Normal3, Point2, Point3, Vector3,
        float::{acos, cos, lerp, sin, sqr},
    },
    sampling::Sampler,
    spectrum::LightColor,
};
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{
    Emitted, Extent, INTENSITY_SCALE, Leaving, Light, LightBound, LightBounds, LightCx, LightSample,
    POSITION, POWER, Source, Track, axis, falloff::Falloff, scaled, track::Anchor,
};

/// Halvings that find a place in the rim.
const HALVINGS: u32 = 26;

/// A spot light.
#[derive(Debug)]
pub struct Spot {
    /// The position, and the direction of the cone's axis.
    anchor: Anchor,
    cos_inner: f32,
    cos_outer: f32,
    intensity: LightColor,
    falloff: Falloff,
}

/// The integral of the share of the intensity over all directions.
fn solid_angle(cos_inner: f32, cos_outer: f32) -> f32 {
    TAU * ((1.0 - cos_inner) + 0.5 * (cos_inner - cos_outer))
}

impl Kind for Spot {
    type Output = Box<dyn Light>;
    const SCHEMA: Schema = Schema {
        name: "spot",
        aliases: &[],
        doc: "A cone of light from one point.",
        params: &[
            ParamSpec::color("I", [1.0; 3], "Intensity on the axis.").unit("W/sr").range(0.0, f32::INFINITY),
            INTENSITY_SCALE,
            POWER,
            POSITION,
            ParamSpec::new(
                "to",
                ParamType::Point3,
                ParamDefault::Triple([0.0, 0.0, 1.0]),
                "A point on the axis.",
            )
            .unit("m"),
            ParamSpec::float("coneangle", 30.0, "Angle between axis and outer cone.")
                .unit("degrees")
                .range(0.0, 180.0),
            ParamSpec::float("conedeltaangle", 5.0, "Width of the fading rim inside the outer cone.")
                .unit("degrees")
                .range(0.0, 180.0),
            Falloff::SPEC,
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let outer = args.float("coneangle");
        let inner = (outer - args.float("conedeltaangle")).max(0.0);
        let radians = PI / 180.0;
        let (cos_inner, cos_outer) = (cos(inner * radians), cos(outer * radians));
        let reach = solid_angle(cos_inner, cos_outer).max(f32::MIN_POSITIVE);
        let intensity = scaled(args, "I", "power", reach);
        let (from, to): (Point3, Point3) = (args.triple("from").into(), args.triple("to").into());
        let anchor = Anchor::new(from, axis(args, from, to)?);
        let falloff = Falloff::from_args(args);
        Some(Box::new(Self { anchor, cos_inner, cos_outer, intensity, falloff }))
    }
}

impl Spot {
    /// Share of the intensity that leaves at this cosine to the axis.
    fn share(&self, cos: f32) -> f32 {
        if cos >= self.cos_inner {
            1.0
        } else if cos <= self.cos_outer {
            0.0
        } else {
            let t = (cos - self.cos_outer) / (self.cos_inner - self.cos_outer);
            t * t * (3.0 - 2.0 * t)
        }
    }
}

impl Spot {
    /// Density of the directions of particles at this cosine to the axis, 1/sr: even within the inner cone, which is
    /// chosen by the power it has, and in the rim by what smoothstep has there.
    fn density(&self, cos: f32) -> f32 {
        self.share(cos) / solid_angle(self.cos_inner, self.cos_outer)
    }
    /// The cosine that `u` in `[0, 1)` chooses.
    fn cos_at(&self, u: f32) -> f32 {
        let (inner, rim) = (1.0 - self.cos_inner, 0.5 * (self.cos_inner - self.cos_outer));
        let inside = u * (inner + rim);
        if inside < inner {
            return 1.0 - inside;
        }
        // The integral of smoothstep is t³ - t⁴ / 2; it rises, so halving finds its inverse.
        let wanted = (1.0 - (inside - inner) / rim).clamp(0.0, 1.0) * 0.5;
        let (mut low, mut high) = (0.0f32, 1.0f32);
        for _ in 0..HALVINGS {
            let t = 0.5 * (low + high);
            if t * t * t * (1.0 - 0.5 * t) < wanted { low = t } else { high = t }
        }
        lerp(0.5 * (low + high), self.cos_outer, self.cos_inner)
    }
}

impl Light for Spot {
    fn place(&mut self, track: &Track) {
        self.anchor.place(track);
    }
    fn sample(&self, cx: &LightCx, p: Point3, _sampler: &Sampler) -> Option<LightSample> {
        let (position, axis) = self.anchor.at(cx.time);
        let (wi, irradiance) = self.falloff.towards(position, p)?;
        let weight = cx.basis.light(&self.intensity) * (irradiance * self.share(-wi.dot(axis)));
        (!weight.is_black()).then_some(LightSample { wi, point: Some(position), weight, pdf: None, on: None })
    }
    fn emit(&self, cx: &LightCx, _within: &Extent, [_, u]: [Point2; 2]) -> Option<Emitted> {
        let (p, axis) = self.anchor.at(cx.time);
        let cos_axis = self.cos_at(u.x);
        let (r, azimuth) = ((1.0 - sqr(cos_axis)).max(0.0).sqrt(), TAU * u.y);
        let local = Vector3::new(r * cos(azimuth), r * sin(azimuth), cos_axis);
        let d = Frame::from_z(Normal3::from(axis)).to_world(local).normalize();
        let light = cx.basis.light(&self.intensity) * self.share(d.dot(axis));
        let pdf_direction = self.density(d.dot(axis));
        (self.is_emitter() && !light.is_black()).then_some(Emitted {
            p,
            d,
            source: Source::Point,
            light,
            pdf_place: 1.0,
            pdf_direction,
        })
    }
    fn emission_pdf(&self, cx: &LightCx, _within: &Extent, ray: &Leaving) -> [f32; 2] {
        let cos = ray.d.dot(self.anchor.at(cx.time).1);
        if self.is_emitter() { [1.0, self.density(cos)] } else { [0.0; 2] }
    }
    /// Light that does not fade is no particles.
    fn is_emitter(&self) -> bool {
        self.falloff == Falloff::InverseSquare && solid_angle(self.cos_inner, self.cos_outer) > 0.0
    }
    fn bound(&self) -> LightBound {
        self.falloff.bound(&self.anchor, self.intensity.color)
    }
    fn bounds(&self) -> Option<LightBounds> {
        (self.falloff == Falloff::InverseSquare).then(|| LightBounds {
            bounds: self.anchor.bounds(),
            normals: self.anchor.directions(acos(self.cos_outer)),
            end: 0.0,
            both_sides: false,
            intensity: self.intensity.luminance(),
        })
    }
    fn reach(&self, p: Point3, n: Option<Normal3>, time: f32) -> f32 {
        let (position, axis) = self.anchor.at(time);
        let share = self.falloff.towards(position, p).map_or(0.0, |(wi, _)| self.share(-wi.dot(axis)));
        self.falloff.reach(position, p, n) * self.intensity.luminance() * share
    }
    fn power(&self, _radius: f32) -> f32 {
        solid_angle(self.cos_inner, self.cos_outer) * self.intensity.luminance()
    }
}
