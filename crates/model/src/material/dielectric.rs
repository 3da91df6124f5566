//! Smooth glass or water: reflection and refraction, divided by Fresnel's equations.
use durer_core::math::Vector3;
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{Material, warn_unsupported};
use crate::{
    Medium, ShadeCx, Surface,
    bsdf::{Bsdf, Interface, Lobe},
};

/// A smooth interface; the outside is where the normal points.
#[derive(Debug)]
pub struct Dielectric {
    medium: Medium,
}

/// Parameters of pbrt's rough dielectric and its surface detail.
const UNSUPPORTED: &[&str] = &["uroughness", "vroughness", "remaproughness", "displacement", "normalmap"];

impl Kind for Dielectric {
    type Output = Box<dyn Material>;
    const SCHEMA: Schema = Schema {
        name: "dielectric",
        aliases: &["glass"],
        doc: "Smooth glass, water or the like: reflects and refracts as Fresnel's equations say.",
        params: &[
            ParamSpec::new(
                "eta",
                ParamType::Index,
                ParamDefault::Float(1.5),
                "Index of refraction inside, relative to the outside.",
            )
            .range(0.1, 10.0),
            Medium::PRIORITY,
            Medium::ABSORPTION,
            ParamSpec::float("roughness", 0.0, "Only 0 is supported yet.").range(0.0, 1.0),
            ParamSpec::new("uroughness", ParamType::FloatTexture, ParamDefault::Unset, "Not supported yet."),
            ParamSpec::new("vroughness", ParamType::FloatTexture, ParamDefault::Unset, "Not supported yet."),
            ParamSpec::new("remaproughness", ParamType::Bool, ParamDefault::Unset, "Not supported yet."),
            ParamSpec::new(
                "displacement",
                ParamType::FloatTexture,
                ParamDefault::Unset,
                "Not supported yet.",
            ),
            ParamSpec::new("normalmap", ParamType::Text, ParamDefault::Unset, "Not supported yet."),
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        warn_unsupported(args, UNSUPPORTED);
        if args.float("roughness") > 0.0 {
            args.warning("roughness", "rough dielectrics are not supported yet; smooth is used");
        }
        let eta = args.index("eta");
        Some(Box::new(Self { medium: Medium::read(args, eta) }))
    }
}

impl Material for Dielectric {
    fn bsdf(&self, _cx: &ShadeCx<'_>, _surface: &mut Surface, _wo: Vector3) -> Bsdf {
        Bsdf::default().with(Lobe::Interface(Interface::clear(self.medium.eta)))
    }
    fn medium(&self) -> Option<Medium> {
        Some(self.medium)
    }
}
