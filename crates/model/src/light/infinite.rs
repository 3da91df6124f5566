//! A sky of the same radiance everywhere: it is seen, and it is its own ambient term (irradiance `pi L`).
use std::f32::consts::PI;

use durer_core::{
    math::{Normal3, Point3, Transform, Vector3},
    sampling::Sampler,
    spectrum::{Basis, Color, Spectrum},
};
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{Light, LightSample, scaled};

/// A constant sky.
#[derive(Debug)]
pub struct Infinite {
    radiance: Color,
}

impl Kind for Infinite {
    type Output = Box<dyn Light>;
    const SCHEMA: Schema = Schema {
        name: "infinite",
        aliases: &[],
        doc: "A sky all around, of the same radiance everywhere.",
        params: &[
            ParamSpec::color("L", [1.0; 3], "Radiance.").unit("W/(m² sr)").range(0.0, f32::INFINITY),
            ParamSpec::float("scale", 1.0, "Factor on the radiance.").range(0.0, f32::INFINITY),
            ParamSpec::new(
                "illuminance",
                ParamType::Float,
                ParamDefault::Unset,
                "Luminance of the irradiance of a plane; replaces the magnitude of L, scale still applies.",
            )
            .range(0.0, f32::INFINITY),
            ParamSpec::new("filename", ParamType::File, ParamDefault::Unset, "Not supported yet."),
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        if args.is_set("filename") {
            args.error("filename", "image environment maps are not supported yet");
            return None;
        }
        Some(Box::new(Self { radiance: scaled(args, "L", "illuminance", PI) }))
    }
}

impl Light for Infinite {
    fn place(&mut self, _render_from_light: &Transform) {}
    fn is_sampled(&self) -> bool {
        false
    }
    fn surrounds(&self) -> bool {
        true
    }
    fn sample(&self, _basis: Basis, _p: Point3, _sampler: &Sampler) -> Option<LightSample> {
        None
    }
    fn ambient(&self, basis: Basis, _n: Normal3) -> Spectrum {
        basis.emission(self.radiance)
    }
    fn glossy_ambient(&self, basis: Basis, _d: Vector3, _alpha: f32) -> Spectrum {
        basis.emission(self.radiance)
    }
    fn escaped(&self, basis: Basis, _d: Vector3) -> Spectrum {
        basis.emission(self.radiance)
    }
}
