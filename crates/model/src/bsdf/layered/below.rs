//! What lies below a coat: metal, or a matte body.
use std::f32::consts::FRAC_1_PI;

use durer_core::{
    math::{Point2, Vector3},
    sampling::cosine_hemisphere,
    spectrum::Spectrum,
};

use crate::bsdf::{Facets, Glossy, Reflectance};

/// What lies below a coat, seen from above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Below {
    /// Metal.
    Metal {
        /// Index, relative to the coat.
        eta: Spectrum,
        /// Extinction, divided by the coat's index.
        k: Spectrum,
        /// Facets.
        facets: Facets,
    },
    /// Lambert's body.
    Matte {
        /// Share of light reflected, in `[0, 1]`.
        albedo: Spectrum,
    },
}

impl Below {
    pub(super) fn is_smooth(&self) -> bool {
        matches!(self, Self::Metal { facets, .. } if facets.is_smooth())
    }
    /// The facets of metal.
    pub(super) fn facets(&self) -> Option<Facets> {
        match self {
            Self::Metal { facets, .. } => Some(*facets),
            Self::Matte { .. } => None,
        }
    }
    /// The same with facets changed.
    pub(in super::super) fn map(self, change: impl Fn(f32) -> f32) -> Self {
        match self {
            Self::Metal { eta, k, facets } => Self::Metal { eta, k, facets: facets.map(change) },
            Self::Matte { albedo } => Self::Matte { albedo },
        }
    }
    fn lobe(&self) -> Option<Glossy> {
        match *self {
            Self::Metal { eta, k, facets } => {
                Some(Glossy { reflectance: Reflectance::Index { eta, k }, facets, scale: 1.0 })
            }
            Self::Matte { .. } => None,
        }
    }
    /// Reflectance of metal at a cosine.
    pub(super) fn fresnel(&self, cos: f32) -> Spectrum {
        self.lobe().map_or(Spectrum::BLACK, |metal| metal.reflectance.at(cos))
    }
    /// Value without the cosine, 1/sr; black for smooth metal.
    pub(super) fn value(&self, from: Vector3, to: Vector3) -> Spectrum {
        match self {
            Self::Metal { .. } => self.lobe().map_or(Spectrum::BLACK, |metal| metal.eval(from, to)),
            Self::Matte { albedo } => *albedo * FRAC_1_PI,
        }
    }
    /// Density of [`Below::reflected`], 1/sr; 0 for smooth metal.
    pub(super) fn density(&self, from: Vector3, to: Vector3) -> f32 {
        match self {
            Self::Metal { .. } if self.is_smooth() => 0.0,
            Self::Metal { .. } => self.lobe().map_or(0.0, |metal| metal.pdf(from, to)),
            Self::Matte { .. } => to.z.max(0.0) * FRAC_1_PI,
        }
    }
    /// The direction in which light from `from` goes on, and `f cos / density`.
    pub(super) fn reflected(&self, from: Vector3, u: Point2) -> Option<(Vector3, Spectrum)> {
        match self {
            Self::Metal { .. } if self.is_smooth() => {
                Some((Vector3::new(-from.x, -from.y, from.z), self.fresnel(from.z.min(1.0))))
            }
            Self::Metal { .. } => self.lobe()?.draw(from, u).map(|d| (d.branch.wi, d.branch.weight)),
            Self::Matte { albedo } => Some((cosine_hemisphere(u), *albedo)),
        }
    }
}
