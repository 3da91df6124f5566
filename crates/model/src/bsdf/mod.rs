//! How light scatters at a point: a closed set of lobes, returned by value.
//!
//! Directions `wo` (back along the ray) and `wi` (towards the light) point away from the surface and are of unit
//! length, in a frame whose z axis is the shading normal; z > 0 is the outside. A lobe that is not transparent looks the
//! same from both sides. A new lobe is one file here and one arm in each `match` of [`Lobe`].
//!
//! Lights are reflected through [`Bsdf::eval`]. What is not a light is seen through [`Bsdf::branches`] (rays are
//! spawned), [`Bsdf::ambient`] and [`Bsdf::glossy`] (no ray is spawned: the integrator asks the lights for an average).

mod branch;
mod fresnel;
mod ggx;
mod glossy;
mod highlight;
mod interface;
mod lobe;
mod refract;
mod straight;

use durer_core::{math::Vector3, spectrum::Spectrum};

pub use branch::{Branch, BranchKind, Branches, GlossyView};
pub use fresnel::{fresnel_dielectric, fresnel_polarized, normal_reflectance, schlick};
pub use glossy::Glossy;
pub use highlight::Highlight;
pub use interface::{Interface, Split};
pub use lobe::Lobe;
pub use refract::{reflect, refract};
pub use straight::Straight;

/// The lobes at one point.
#[derive(Clone, Copy, Debug)]
pub struct Bsdf {
    lobes: [Option<Lobe>; Bsdf::MOST_LOBES],
    count: usize,
    /// What of all scattered light arrives at the end of `wo`.
    arriving: Spectrum,
}

impl Default for Bsdf {
    fn default() -> Self {
        Self { lobes: [None; Self::MOST_LOBES], count: 0, arriving: Spectrum::ONE }
    }
}

impl Bsdf {
    /// Most lobes a material can return.
    pub const MOST_LOBES: usize = 4;

    /// These lobes and `lobe`; a lobe too many is an error of the material: it is left out, and debug builds stop.
    #[must_use]
    #[inline]
    pub fn with(mut self, lobe: Lobe) -> Self {
        self.add(lobe);
        self
    }
    /// Adds a lobe, like [`Bsdf::with`].
    #[inline]
    pub fn add(&mut self, lobe: Lobe) {
        debug_assert!(
            self.count < Self::MOST_LOBES,
            "a material returns more than {} lobes",
            Self::MOST_LOBES
        );
        if let Some(place) = self.lobes.get_mut(self.count) {
            *place = Some(lobe);
            self.count += 1;
        }
    }
    /// The lobes, in the order they were added.
    pub fn lobes(&self) -> impl Iterator<Item = &Lobe> {
        self.lobes[..self.count].iter().flatten()
    }
    /// The same lobes seen from afar: of what they scatter the share `arriving` is left, as something on the way along
    /// `wo` absorbs the rest.
    pub fn dim(&mut self, arriving: Spectrum) {
        self.arriving *= arriving;
    }
    /// Sets the index of refraction of smooth interfaces: that on the far side of the surface, seen along `wo`, divided by
    /// that on the near side.
    pub fn set_eta(&mut self, wo: Vector3, far_over_near: f32) {
        for lobe in self.lobes[..self.count].iter_mut().flatten() {
            if let Lobe::Interface(interface) = lobe {
                interface.eta = if wo.z > 0.0 { far_over_near } else { 1.0 / far_over_near };
            }
        }
    }
    /// Value of all lobes that are not perfectly sharp, without the cosine. 1/sr.
    pub fn eval(&self, wo: Vector3, wi: Vector3) -> Spectrum {
        self.arriving * self.lobes().fold(Spectrum::BLACK, |sum, lobe| sum + lobe.eval(wo, wi))
    }
    /// True if no light without extent is reflected: all lobes are perfectly sharp.
    pub fn is_sharp(&self) -> bool {
        !self.lobes().any(|lobe| matches!(lobe, Lobe::Diffuse { .. } | Lobe::Highlight(_) | Lobe::Glossy(_)))
    }
    /// Coefficient of the ambient term: diffuse albedo, or the ambient coefficient of a classic material.
    pub fn ambient(&self) -> Spectrum {
        let classic = |lobe: &Lobe| match lobe {
            Lobe::Ambient { coefficient } => Some(*coefficient),
            _ => None,
        };
        let diffuse = |lobe: &Lobe| match lobe {
            Lobe::Diffuse { albedo } => Some(*albedo),
            _ => None,
        };
        let own = self.lobes().filter_map(classic).reduce(|a, b| a + b);
        let diffuse = || self.lobes().filter_map(diffuse).fold(Spectrum::BLACK, |a, b| a + b);
        self.arriving * own.unwrap_or_else(diffuse)
    }
    /// The share of the glossy lobes that [`Bsdf::branches`] does not carry, if there is any; several lobes are seen as
    /// one whose `alpha` is their weighted mean.
    pub fn glossy(&self, wo: Vector3) -> Option<GlossyView> {
        let views = self.lobes().filter_map(|lobe| match lobe {
            Lobe::Glossy(glossy) => glossy.view(wo),
            _ => None,
        });
        let seen = views.reduce(|a, b| {
            let (wa, wb) = (a.weight.mean(), b.weight.mean());
            let alpha = (a.alpha * wa + b.alpha * wb) / (wa + wb);
            GlossyView { wi: a.wi, weight: a.weight + b.weight, alpha }
        });
        seen.map(|view| GlossyView { weight: self.arriving * view.weight, ..view })
    }
    /// The perfectly sharp directions, and those of nearly smooth glossy lobes (see [`Glossy`]).
    pub fn branches(&self, wo: Vector3) -> Branches {
        let mut branches = Branches::default();
        for lobe in self.lobes() {
            lobe.add_branches(wo, &mut branches);
        }
        branches.dim(self.arriving);
        branches
    }
    /// The surface's own colour as people would name it, at most 1: diffuse albedo plus the tint of what it reflects at
    /// normal incidence or transmits.
    pub fn albedo(&self) -> Spectrum {
        self.lobes().fold(Spectrum::BLACK, |sum, lobe| sum + lobe.tint()).map(|v| v.clamp(0.0, 1.0))
    }
}
