//! A cone of light from one point: intensity `I` inside the inner cone, fading to 0 at the outer one.
//!
//! pbrt-v4's falloff: `smoothstep` of the cosine to the axis, from `cos(coneangle)` (0) to
//! `cos(coneangle - conedeltaangle)` (1). As the mean of smoothstep is 1/2, the power is
//! `2 pi I ((1 - cos inner) + (cos inner - cos outer) / 2)`.
use std::f32::consts::{PI, TAU};

use durer_core::{
    math::{
        Normal3, Point3,
        float::{acos, cos},
    },
    sampling::Sampler,
    spectrum::LightColor,
};
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{
    INTENSITY_SCALE, Light, LightBound, LightBounds, LightCx, LightSample, POSITION, POWER, Track, axis,
    falloff::Falloff, scaled, track::Anchor,
};

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

impl Light for Spot {
    fn place(&mut self, track: &Track) {
        self.anchor.place(track);
    }
    fn sample(&self, cx: &LightCx, p: Point3, _sampler: &Sampler) -> Option<LightSample> {
        let (position, axis) = self.anchor.at(cx.time);
        let (wi, irradiance) = self.falloff.towards(position, p)?;
        let weight = cx.basis.light(&self.intensity) * (irradiance * self.share(-wi.dot(axis)));
        (!weight.is_black()).then_some(LightSample { wi, point: Some(position), weight, pdf: None })
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
