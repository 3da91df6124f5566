//! A light infinitely far away: parallel rays, the same irradiance `E = L cos` everywhere. The sun.
use std::f32::consts::PI;

use durer_core::{
    math::{Normal3, Point3, float::sqr},
    sampling::Sampler,
    spectrum::Color,
};
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{Light, LightBound, LightCx, LightSample, Track, axis, largest, scaled, track::Anchor};

/// A distant light.
#[derive(Debug)]
pub struct Distant {
    /// The direction in which the light travels.
    anchor: Anchor,
    irradiance: Color,
}

impl Kind for Distant {
    type Output = Box<dyn Light>;
    const SCHEMA: Schema = Schema {
        name: "distant",
        aliases: &["directional"],
        doc: "Parallel light from infinitely far away, like the sun's.",
        params: &[
            ParamSpec::color("L", [1.0; 3], "Irradiance on a plane that faces the light.")
                .unit("W/m²")
                .range(0.0, f32::INFINITY),
            ParamSpec::float("scale", 1.0, "Factor on L.").range(0.0, f32::INFINITY),
            ParamSpec::new(
                "illuminance",
                ParamType::Float,
                ParamDefault::Unset,
                "Luminance of that irradiance; replaces the magnitude of L, scale still applies.",
            )
            .range(0.0, f32::INFINITY),
            ParamSpec::new(
                "from",
                ParamType::Point3,
                ParamDefault::Triple([0.0; 3]),
                "Light travels from here",
            )
            .unit("m"),
            ParamSpec::new("to", ParamType::Point3, ParamDefault::Triple([0.0, 0.0, 1.0]), "towards here.")
                .unit("m"),
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let irradiance = scaled(args, "L", "illuminance", 1.0);
        let (from, to): (Point3, Point3) = (args.triple("from").into(), args.triple("to").into());
        let anchor = Anchor::new(from, axis(args, from, to)?);
        Some(Box::new(Self { anchor, irradiance }))
    }
}

impl Light for Distant {
    fn place(&mut self, track: &Track) {
        self.anchor.place(track);
    }
    fn sample(&self, cx: &LightCx, _p: Point3, _sampler: &Sampler) -> Option<LightSample> {
        let weight = cx.basis.emission(self.irradiance);
        let (_, direction) = self.anchor.at(cx.time);
        (!weight.is_black()).then_some(LightSample { wi: -direction, point: None, weight, pdf: None })
    }
    fn bound(&self) -> LightBound {
        LightBound { facing: largest(self.irradiance), ..LightBound::default() }
    }
    fn reach(&self, _p: Point3, n: Option<Normal3>, time: f32) -> f32 {
        let (_, direction) = self.anchor.at(time);
        self.irradiance.luminance() * n.map_or(1.0, |n| (-n.dot(direction)).max(0.0))
    }
    fn power(&self, radius: f32) -> f32 {
        PI * sqr(radius) * self.irradiance.luminance()
    }
}
