//! How light scatters at a point: a closed set of lobes, returned by value.
//!
//! Directions `wo` (back along the ray) and `wi` (towards the light) point away from the surface and are of unit
//! length, in a frame whose z axis is the shading normal; z > 0 is the outside. A lobe that is not transparent looks the
//! same from both sides. A new lobe is one file here and one arm in each `match` of [`Lobe`].
//!
//! Lights are reflected through [`Bsdf::eval`]. What is not a light is seen through [`Bsdf::branches`] (rays are
//! spawned), [`Bsdf::ambient`] and [`Bsdf::glossy`] (no ray is spawned: the integrator asks the lights for an average).

mod beckmann;
mod blurred;
mod bounced;
mod branch;
mod burley;
mod coat;
mod draw;
mod facets;
mod fresnel;
mod ggx;
mod gloss;
mod glossy;
mod hair;
mod highlight;
mod interface;
mod layered;
mod leaving;
mod lobe;
mod matte;
mod measured;
mod phong;
mod refract;
mod scatter;
mod sheen_table;
mod sheet;
mod straight;
mod tilted;
mod under;
mod varnish;
mod view;

use durer_core::{
    math::{Point2, Vector3},
    spectrum::Spectrum,
};

pub use blurred::{Blur, Blurred};
pub use bounced::{Bounced, Sheen};
pub use branch::{Branch, BranchKind, Branches, GlossyView};
pub use burley::Burley;
pub use coat::{Again, Body, Coat};
pub use draw::{Drawn, Draws};
pub use facets::{Distribution, Facets, Shadowing};
pub use fresnel::{
    Reflectance, fresnel_conductor, fresnel_dielectric, fresnel_polarized, normal_reflectance, schlick,
};
pub use gloss::Gloss;
pub use glossy::{Glossy, SMOOTH};
pub use hair::{Hair, Strand};
pub use highlight::Highlight;
pub use interface::{Interface, Split};
pub use layered::{Below, Cloud, Layered, mirrored_by_layers};
pub use leaving::Leaving;
pub use lobe::Lobe;
pub use matte::Matte;
pub use measured::{Measured, Measurement};
pub use phong::Phong;
pub use refract::{reflect, refract};
pub use scatter::Scattered;
pub use sheet::Sheet;
pub use straight::Straight;
pub use tilted::Tilted;
pub use under::{Under, Veil};
pub use varnish::Varnish;
pub use view::{FresnelView, LobeView, LostDraw};

/// How rays from a surface may meet a light that is sampled as well; so that nothing counts twice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Seen {
    /// By [`Bsdf::branches`]: mirrored rays show the light, highlights stand for what they do not carry.
    Branches,
    /// By [`Bsdf::draws`]: both count in proportion to their densities (balance heuristic, Veach and Guibas 1995).
    Draws {
        /// Density of sampling the light in this direction times its number of shadow rays, 1/sr.
        pdf: f32,
        /// Rays drawn from each lobe.
        rays: f32,
    },
}

/// The lobes at one point.
#[derive(Clone, Copy, Debug)]
pub struct Bsdf<'a> {
    lobes: [Option<Lobe<'a>>; Bsdf::MOST_LOBES],
    count: usize,
    /// What of all scattered light arrives at the end of `wo`.
    arriving: Spectrum,
    is_led: bool,
}

impl Default for Bsdf<'_> {
    fn default() -> Self {
        Self { lobes: [None; Self::MOST_LOBES], count: 0, arriving: Spectrum::ONE, is_led: false }
    }
}

impl<'a> Bsdf<'a> {
    /// Most lobes a material can return.
    pub const MOST_LOBES: usize = 8;

    /// Those of these lobes that are there. PERF: made where it is to be, where adding one after the other is followed by
    /// a copy of all places (bench render).
    #[inline]
    pub fn of([a, b, c, d]: [Option<Lobe<'a>>; 4]) -> Self {
        Self { lobes: [a, b, c, d, None, None, None, None], count: 4, ..Self::default() }
    }

    /// These lobes and `lobe`; a lobe too many is an error of the material: it is left out, and debug builds stop.
    #[must_use]
    #[inline]
    pub fn with(mut self, lobe: Lobe<'a>) -> Self {
        self.add(lobe);
        self
    }
    /// Adds a lobe, like [`Bsdf::with`].
    #[inline]
    pub fn add(&mut self, lobe: Lobe<'a>) {
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
    /// The share `t` of `other` and the rest of this one; `None` if that is more than [`Bsdf::MOST_LOBES`].
    pub fn mixed(&self, other: &Self, t: f32) -> Option<Self> {
        if self.count + other.count > Self::MOST_LOBES {
            return None;
        }
        let own = self.lobes().map(|lobe| lobe.scaled(1.0 - t));
        let none = Self { is_led: self.is_led || other.is_led, ..Self::default() };
        Some(own.chain(other.lobes().map(|lobe| lobe.scaled(t))).fold(none, Self::with))
    }
    /// Those of the lobes that are wanted.
    #[must_use]
    pub fn only(&self, wanted: impl Fn(&Lobe) -> bool) -> Self {
        let none = Self { lobes: [None; Self::MOST_LOBES], count: 0, ..*self };
        self.lobes().filter(|lobe| wanted(lobe)).fold(none, |bsdf, lobe| bsdf.with(*lobe))
    }
    /// The lobes, in the order they were added.
    pub fn lobes(&self) -> impl Iterator<Item = &Lobe<'a>> {
        self.lobes[..self.count].iter().flatten()
    }
    /// The same lobes, which hold for the leading wavelength only.
    #[must_use]
    pub fn led(self) -> Self {
        Self { is_led: true, ..self }
    }
    /// True if all other wavelengths end here: see [`Basis::collapse`](durer_core::spectrum::Basis::collapse).
    pub fn is_led(&self) -> bool {
        self.is_led
    }
    /// The same lobes seen from afar: of what they scatter the share `arriving` is left, as something on the way along
    /// `wo` absorbs the rest.
    pub fn dim(&mut self, arriving: Spectrum) {
        self.arriving *= arriving;
    }
    /// Sets the index of refraction of interfaces: that on the far side of the surface, seen along `wo`, divided by
    /// that on the near side.
    pub fn set_eta(&mut self, wo: Vector3, far_over_near: f32) {
        for lobe in self.lobes[..self.count].iter_mut().flatten() {
            if let Lobe::Interface(interface) | Lobe::Blurred(Blurred { interface, .. }) = lobe {
                interface.eta = if wo.z > 0.0 { far_over_near } else { 1.0 / far_over_near };
            }
        }
    }
    /// Makes light that was scattered below leave interfaces, seen from below along `wo`, in all directions, unless they
    /// blur it enough by themselves. Seen from above light gets in so.
    pub fn leave(&mut self, wo: Vector3) {
        let mut all = Self { arriving: self.arriving, is_led: self.is_led, ..Self::default() };
        for lobe in self.lobes() {
            match lobe {
                Lobe::Interface(interface) => interface.leave(wo, &mut all),
                Lobe::Blurred(blurred) if blurred.is_narrow() => blurred.interface.leave(wo, &mut all),
                other => all.add(*other),
            }
        }
        *self = all;
    }
    /// Whether [`Bsdf::leave`] changes anything.
    pub fn is_narrow(&self) -> bool {
        self.lobes().any(Lobe::is_narrow)
    }
    /// What [`Bsdf::leave`] makes of boundaries: what gets through if light from `wo` comes from above, what is mirrored if it
    /// comes from below; and what share of all light that is.
    pub fn parted(&self, wo: Vector3) -> Option<(Self, f32)> {
        let mut all = self.only(|lobe| lobe.is_narrow());
        all.leave(wo);
        let own = all.only(|lobe| matches!(lobe, Lobe::Matte(Matte::Leaving(_))) == (wo.z > 0.0));
        let passed: f32 = own.lobes().map(|lobe| lobe.tint().mean()).sum();
        let mirrored: f32 = own.sharp(wo).iter().map(|branch| branch.weight.mean()).sum();
        let share = if wo.z > 0.0 { passed } else { mirrored }.min(1.0);
        (share > 0.0).then_some((own, share))
    }
    /// The density of [`Bsdf::scatter`] at a direction on the other side if there were the boundaries of bodies only, 1/sr;
    /// 0 where they are sharp.
    pub fn crossing_pdf(&self, wo: Vector3, wi: Vector3) -> f32 {
        self.only(|lobe| matches!(lobe, Lobe::Blurred(_))).eval_with_pdf(wo, wi).1
    }
    /// Value of all lobes that are not perfectly sharp, without the cosine. 1/sr.
    pub fn eval(&self, wo: Vector3, wi: Vector3) -> Spectrum {
        self.arriving * self.lobes().fold(Spectrum::BLACK, |sum, lobe| sum + lobe.eval(wo, wi))
    }
    /// The part of [`Bsdf::eval`] that counts for the light of something that rays can meet: each lobe by its share
    /// `keep`, which is asked with the lobe's own answer where rays of its own find the light too (see [`Seen`]).
    pub fn eval_shared(&self, wo: Vector3, wi: Vector3, seen: Seen) -> Spectrum {
        let mirrors = || self.lobes().any(Lobe::shows_lights);
        let sum = self.lobes().fold(Spectrum::BLACK, |sum, lobe| {
            let share = match (lobe, seen) {
                (Lobe::Highlight(_), _) if mirrors() => 0.0,
                (_, Seen::Branches) => lobe.share_beside_branches(),
                (_, Seen::Draws { pdf, rays }) => match lobe.pdf(wo, wi) {
                    Some(own) if own > 0.0 => pdf / (pdf + own * rays),
                    _ => 1.0,
                },
            };
            if share == 0.0 { sum } else { sum + lobe.eval(wo, wi) * share }
        });
        self.arriving * sum
    }
    /// True if light from the other side is scattered to this one.
    pub fn is_frosted(&self) -> bool {
        self.lobes().any(|lobe| match lobe {
            Lobe::Blurred(_) | Lobe::Behind { .. } | Lobe::Sheet(_) | Lobe::Hair(_) => true,
            Lobe::Matte(matte) => matte.is_behind(),
            _ => false,
        })
    }
    /// True if no light without extent is reflected: all lobes are perfectly sharp.
    pub fn is_sharp(&self) -> bool {
        !self.lobes().any(|lobe| {
            matches!(
                lobe,
                Lobe::Diffuse { .. }
                    | Lobe::Highlight(_)
                    | Lobe::Glossy(_)
                    | Lobe::Gloss(_)
                    | Lobe::Blurred(_)
                    | Lobe::Matte(_)
                    | Lobe::Behind { .. }
                    | Lobe::Phong(_)
                    | Lobe::Varnish(_)
                    | Lobe::Layered(_)
                    | Lobe::Tilted(_)
                    | Lobe::Sheet(_)
                    | Lobe::Hair(_)
                    | Lobe::Measured(_)
            )
        })
    }
    /// True if light from anywhere is scattered along `wo`: some lobe is matte, or rough from `alpha` =
    /// [`Glossy::BLURRED`] on. Hair is not: what lies around a point of a strand is no surface.
    pub fn is_broad(&self) -> bool {
        let is_rough = |alpha: f32| alpha >= Glossy::BLURRED;
        // Facets that are about as wide: Walter et al. 2007, section 5.2.
        let is_wide = |exponent: f32| is_rough((2.0 / (exponent + 2.0)).sqrt());
        self.lobes().any(|lobe| match lobe {
            Lobe::Diffuse { .. } | Lobe::Matte(_) | Lobe::Behind { .. } => true,
            Lobe::Layered(layered) => layered.look().is_none_or(|look| is_rough(look.facets.alpha())),
            Lobe::Glossy(glossy) | Lobe::Tilted(Tilted { glossy, .. }) => is_rough(glossy.facets.alpha()),
            Lobe::Sheet(sheet) => is_rough(sheet.glossy().facets.alpha()),
            Lobe::Measured(measured) => is_rough(measured.alpha()),
            Lobe::Varnish(varnish) => is_rough(varnish.alpha),
            Lobe::Gloss(Gloss { exponent, .. }) | Lobe::Phong(Phong { exponent, .. }) => is_wide(*exponent),
            Lobe::Blurred(Blurred { blur: Blur::Microfacet(facets), .. }) => is_rough(facets.alpha()),
            Lobe::Blurred(Blurred { blur: Blur::Cosine { reflection, transmission }, .. }) => {
                is_wide(reflection.min(*transmission))
            }
            Lobe::Ambient { .. }
            | Lobe::Highlight(_)
            | Lobe::Mirror { .. }
            | Lobe::Interface(_)
            | Lobe::Hair(_)
            | Lobe::PassThrough { .. } => false,
        })
    }
    /// Coefficient of the ambient term: diffuse albedo, or the ambient coefficient of a classic material.
    pub fn ambient(&self) -> Spectrum {
        let classic = |lobe: &Lobe| match lobe {
            Lobe::Ambient { coefficient } => Some(*coefficient),
            _ => None,
        };
        let diffuse = |lobe: &Lobe| match lobe {
            Lobe::Diffuse { albedo } | Lobe::Behind { albedo } => Some(*albedo),
            Lobe::Matte(matte) => Some(matte.albedo()),
            Lobe::Layered(layered) => Some(layered.albedo()),
            Lobe::Hair(hair) => Some(hair.tint()),
            _ => None,
        };
        let own = self.lobes().filter_map(classic).reduce(|a, b| a + b);
        let diffuse = || self.lobes().filter_map(diffuse).fold(Spectrum::BLACK, |a, b| a + b);
        self.arriving * own.unwrap_or_else(diffuse)
    }
    /// The share of the glossy lobes that [`Bsdf::branches`] does not carry, if there is any; several lobes are seen as
    /// one whose `alpha` is their weighted mean.
    pub fn glossy(&self, wo: Vector3) -> Option<GlossyView> {
        let views = self.lobes().filter_map(|lobe| lobe.seen_glossy(wo));
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
    /// The perfectly sharp directions only: what is left to follow beside [`Bsdf::draws`].
    pub fn sharp(&self, wo: Vector3) -> Branches {
        let mut branches = Branches::default();
        for lobe in self.lobes() {
            lobe.add_sharp_branches(wo, &mut branches);
        }
        branches.dim(self.arriving);
        branches
    }
    /// Whether rays may follow a lobe: those of [`Bsdf::branches`] or [`Bsdf::draws`].
    pub fn is_followed(&self) -> bool {
        self.lobes().any(Lobe::is_followed)
    }
    /// Whether directions can be drawn from a lobe.
    pub fn spreads(&self) -> bool {
        self.lobes().any(Lobe::spreads)
    }
    /// A direction of every lobe that spreads, at the point of the unit square that `u` gives for it.
    pub fn draws(&self, wo: Vector3, mut u: impl FnMut(u32) -> Point2) -> Draws {
        let mut draws = Draws::default();
        for (number, lobe) in (0..).zip(self.lobes()).filter(|(_, lobe)| lobe.spreads()) {
            lobe.draw(wo, u(number), &mut draws);
        }
        draws.dim(self.arriving);
        draws
    }
    /// The surface's own colour as people would name it, at most 1: diffuse albedo plus the tint of what it reflects at
    /// normal incidence or transmits.
    pub fn albedo(&self) -> Spectrum {
        self.lobes().fold(Spectrum::BLACK, |sum, lobe| sum + lobe.tint()).map(|v| v.clamp(0.0, 1.0))
    }
}
