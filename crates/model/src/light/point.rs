//! A light without extent that shines equally in all directions: irradiance `E = I cos / d²`, power `4 pi I`.
use std::f32::consts::PI;

use durer_core::{
    math::{Normal3, Point3, Vector3},
    sampling::Sampler,
    spectrum::LightColor,
};
use durer_scene::{Args, Kind, ParamSpec, Schema};

use super::{
    Cone, INTENSITY_SCALE, Light, LightBound, LightBounds, LightCx, LightSample, POSITION, POWER, Track,
    falloff::Falloff, scaled, track::Anchor,
};

/// A point light.
#[derive(Debug)]
pub struct Point {
    anchor: Anchor,
    intensity: LightColor,
    falloff: Falloff,
}

impl Kind for Point {
    type Output = Box<dyn Light>;
    const SCHEMA: Schema = Schema {
        name: "point",
        aliases: &[],
        doc: "Shines equally in all directions from one point.",
        params: &[
            ParamSpec::color("I", [1.0; 3], "Intensity.").unit("W/sr").range(0.0, f32::INFINITY),
            INTENSITY_SCALE,
            POWER,
            POSITION,
            Falloff::SPEC,
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let intensity = scaled(args, "I", "power", 4.0 * PI);
        let from: Point3 = args.triple("from").into();
        let anchor = Anchor::new(from, Vector3::new(0.0, 0.0, 1.0));
        Some(Box::new(Self { anchor, intensity, falloff: Falloff::from_args(args) }))
    }
}

impl Light for Point {
    fn place(&mut self, track: &Track) {
        self.anchor.place(track);
    }
    fn sample(&self, cx: &LightCx, p: Point3, _sampler: &Sampler) -> Option<LightSample> {
        let (position, _) = self.anchor.at(cx.time);
        let (wi, irradiance) = self.falloff.towards(position, p)?;
        let weight = cx.basis.light(&self.intensity) * irradiance;
        (!weight.is_black()).then_some(LightSample { wi, point: Some(position), weight, pdf: None })
    }
    fn bound(&self) -> LightBound {
        self.falloff.bound(&self.anchor, self.intensity.color)
    }
    fn bounds(&self) -> Option<LightBounds> {
        (self.falloff == Falloff::InverseSquare).then(|| LightBounds {
            bounds: self.anchor.bounds(),
            normals: Cone::ALL,
            end: 0.0,
            both_sides: false,
            intensity: self.intensity.luminance(),
        })
    }
    fn reach(&self, p: Point3, n: Option<Normal3>, time: f32) -> f32 {
        self.falloff.reach(self.anchor.at(time).0, p, n) * self.intensity.luminance()
    }
    fn power(&self, _radius: f32) -> f32 {
        4.0 * PI * self.intensity.luminance()
    }
}
