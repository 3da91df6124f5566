//! A material out of the database of Dupuy and Jakob 2018 (<https://rgl.epfl.ch/materials>), or of that format.
use std::sync::Arc;

use durer_core::{math::Vector3, spectrum::Spectrum};
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{Material, detail::Detail, roughness::tangent};
use crate::{
    ShadeCx, Surface,
    bsdf::{Bsdf, Lobe, Measured as MeasuredLobe, Measurement},
};

/// Reflects what the placeholder of a missing file does: half of all light.
const PLACEHOLDER: f32 = 0.5;

/// Something measured.
#[derive(Debug)]
pub struct Measured {
    /// Matte and grey without.
    measurement: Option<Arc<Measurement>>,
    detail: Detail,
}

impl Kind for Measured {
    type Output = Box<dyn Material>;
    const SCHEMA: Schema = Schema {
        name: "measured",
        aliases: &[],
        doc: "Reflects as something that was measured; the same from both sides.",
        params: &[
            ParamSpec::new(
                "filename",
                ParamType::File,
                ParamDefault::Required,
                "The file, .bsdf of the RGL material database; of wavelengths or of red, green and blue.",
            ),
            Detail::DISPLACEMENT,
            Detail::NORMAL_MAP,
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let tensors = args.tensors("filename");
        let detail = Detail::read(args);
        if !args.is_sound() {
            return None;
        }
        let path = args.text("filename");
        let measurement = match tensors.map(|tensors| tensors.made(Measurement::new)).transpose() {
            Ok(measurement) => measurement,
            Err(reason) => {
                args.error("filename", format!("{path}: {reason}"));
                return None;
            }
        };
        if let Some(damaged) = measurement.as_deref().map(Measurement::damaged).filter(|n| *n > 0) {
            let what = durer_scene::counted(damaged, "colour value");
            args.warning("filename", format!("{path}: {what} not finite; 0 is used"));
        }
        Some(Box::new(Self { measurement, detail }))
    }
}

impl Material for Measured {
    fn bsdf(&self, cx: &ShadeCx<'_>, surface: &mut Surface, wo: Vector3) -> Bsdf<'_> {
        self.detail.tilt(cx, surface, wo);
        Bsdf::default().with(match &self.measurement {
            Some(of) => Lobe::Measured(MeasuredLobe::new(of, cx.basis, tangent(surface))),
            None => Lobe::Diffuse { albedo: Spectrum::splat(PLACEHOLDER) },
        })
    }
    fn measurement(&self) -> Option<&Arc<Measurement>> {
        self.measurement.as_ref()
    }
}
