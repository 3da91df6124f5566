//! A light without extent that shines equally in all directions: irradiance `E = I cos / d²`, power `4 pi I`.
use std::f32::consts::PI;

use durer_core::{
    math::{Normal3, Point2, Point3, Vector3},
    sampling::Sampler,
    spectrum::LightColor,
};
use durer_scene::{Args, Kind, ParamSpec, Schema};

use super::{
    Cone, Emitted, Extent, INTENSITY_SCALE, Leaving, Light, LightBound, LightBounds, LightCx, LightSample,
    POSITION, POWER, Source, Track, UNIFORM, falloff::Falloff, scaled, track::Anchor, uniform_direction,
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
        (!weight.is_black()).then_some(LightSample { wi, point: Some(position), weight, pdf: None, on: None })
    }
    fn emit(&self, cx: &LightCx, _within: &Extent, [_, u]: [Point2; 2]) -> Option<Emitted> {
        let (p, light) = (self.anchor.at(cx.time).0, cx.basis.light(&self.intensity));
        let (d, pdf_direction) = uniform_direction(u);
        (self.is_emitter() && !light.is_black()).then_some(Emitted {
            p,
            d,
            source: Source::Point,
            light,
            pdf_place: 1.0,
            pdf_direction,
        })
    }
    fn emission_pdf(&self, _cx: &LightCx, _within: &Extent, _ray: &Leaving) -> [f32; 2] {
        if self.is_emitter() { [1.0, UNIFORM] } else { [0.0; 2] }
    }
    /// Light that does not fade is no particles.
    fn is_emitter(&self) -> bool {
        self.falloff == Falloff::InverseSquare
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
