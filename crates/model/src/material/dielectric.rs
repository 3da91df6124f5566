//! Glass or water, smooth or frosted: reflection and refraction, divided by Fresnel's equations.
use durer_core::math::Vector3;
use durer_scene::{Args, Kind, Schema};

use super::{Arriving, Material, Sent, detail::Detail, roughness::Roughness};
use crate::{
    Medium, ShadeCx, Surface,
    bsdf::{Bsdf, Interface, Lobe, SMOOTH},
};

/// An interface; the outside is where the normal points.
#[derive(Debug)]
pub struct Dielectric {
    medium: Medium,
    roughness: Roughness,
    detail: Detail,
}

impl Kind for Dielectric {
    type Output = Box<dyn Material>;
    const SCHEMA: Schema = Schema {
        name: "dielectric",
        aliases: &["glass"],
        doc: "Glass, water or the like, smooth or frosted: reflects and refracts as Fresnel's equations say.",
        params: &[
            Medium::ETA,
            Medium::CAUCHY,
            Medium::DISPERSION,
            Medium::PRIORITY,
            Medium::ABSORPTION,
            Medium::INSIDE,
            Roughness::BOTH,
            Roughness::U,
            Roughness::V,
            Roughness::REMAP,
            Roughness::DISTRIBUTION,
            Detail::DISPLACEMENT,
            Detail::NORMAL_MAP,
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        Some(Box::new(Self {
            medium: Medium::read(args),
            roughness: Roughness::read(args),
            detail: Detail::read(args),
        }))
    }
}

impl Material for Dielectric {
    fn bsdf(&self, cx: &ShadeCx<'_>, surface: &mut Surface, wo: Vector3) -> Bsdf {
        self.detail.tilt(cx, surface, wo);
        let interface = Interface::clear(self.medium.eta(&cx.basis));
        let facets = self.roughness.facets(cx, surface);
        Bsdf::default().with(Lobe::boundary(interface, facets))
    }
    fn medium(&self) -> Option<Medium> {
        Some(self.medium.clone())
    }
    /// Of light without extent seen through frosted glass there is no bound: where indices are nearly the same, nearly
    /// all directions are one.
    fn sent(&self, _: &ShadeCx<'_>, arriving: &Arriving) -> Sent {
        match self.roughness.constant() {
            Some(alpha) if alpha < SMOOTH => Sent { followed: 1.0, ..Sent::default() },
            _ => Sent {
                own: arriving.highlight(f32::INFINITY),
                scattered: arriving.sky + arriving.lamps,
                followed: 1.0,
            },
        }
    }
}
