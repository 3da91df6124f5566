//! Glass or water, smooth or frosted: reflection and refraction, divided by Fresnel's equations.
use durer_core::{math::Vector3, spectrum::Spectrum};
use durer_scene::{Args, ColorInput, Kind, Schema};

use super::{
    Arriving, Material, REFLECTION, Sent, TRANSMISSION, detail::Detail, read_factor, roughness::Roughness,
    share,
};
use crate::{
    Medium, ShadeCx, Surface,
    bsdf::{Bsdf, Interface, Lobe, SMOOTH, Split},
};

/// An interface; the outside is where the normal points.
#[derive(Debug)]
pub struct Dielectric {
    medium: Medium,
    roughness: Roughness,
    /// On what is reflected and let through.
    factors: [Option<ColorInput>; 2],
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
            Roughness::SHADOWING,
            REFLECTION,
            TRANSMISSION,
            Detail::DISPLACEMENT,
            Detail::NORMAL_MAP,
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        Some(Box::new(Self {
            medium: Medium::read(args),
            roughness: Roughness::read(args),
            factors: [&REFLECTION, &TRANSMISSION].map(|spec| read_factor(args, spec)),
            detail: Detail::read(args),
        }))
    }
}

impl Material for Dielectric {
    fn bsdf(&self, cx: &ShadeCx<'_>, surface: &mut Surface, wo: Vector3) -> Bsdf<'_> {
        self.detail.tilt(cx, surface, wo);
        let mut interface = Interface::clear(self.medium.eta(&cx.basis));
        if self.factors.iter().any(Option::is_some) {
            let at = surface.texture_at();
            let of = |factor: &Option<ColorInput>| {
                factor.as_ref().map_or(Spectrum::ONE, |factor| share(cx, factor, &at))
            };
            let [reflection, transmission] = self.factors.each_ref().map(of);
            interface.split = Split::Fresnel { reflection, transmission };
        }
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
