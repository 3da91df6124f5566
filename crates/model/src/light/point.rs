//! A light without extent that shines equally in all directions: irradiance `E = I cos / d²`, power `4 pi I`.
use std::f32::consts::PI;

use durer_core::{
    math::{Point3, Transform},
    sampling::Sampler,
    spectrum::Color,
};
use durer_scene::{Args, Kind, ParamSpec, Schema};

use super::{INTENSITY_SCALE, Light, LightCx, LightSample, POSITION, POWER, falloff::Falloff, scaled};

/// A point light.
#[derive(Debug)]
pub struct Point {
    position: Point3,
    intensity: Color,
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
        let position = args.triple("from").into();
        Some(Box::new(Self { position, intensity, falloff: Falloff::from_args(args) }))
    }
}

impl Light for Point {
    fn place(&mut self, render_from_light: &Transform) {
        self.position = render_from_light.point(self.position);
    }
    fn sample(&self, cx: &LightCx, p: Point3, _sampler: &Sampler) -> Option<LightSample> {
        let (wi, irradiance) = self.falloff.towards(self.position, p)?;
        let weight = cx.basis.emission(self.intensity) * irradiance;
        (!weight.is_black()).then_some(LightSample { wi, point: Some(self.position), weight, pdf: None })
    }
}
