//! A matte body below layers that reflect: what they leave of light on its way in and on its way out.
//!
//! Albedo scaling by both directions (Kelemen and Szirmay-Kalos 2001, "A Microfacet Based Coupled Specular-Matte BRDF Model
//! with Importance Sampling"): with `t(w)` the share that passes the layers along `w` and `<t>` its mean by the cosine,
//! `f = c / pi t(o) t(i) / <t>`. It is reciprocal, and of a uniform sky `c t(o)` leaves towards `o`: together with what the
//! layers reflect no more than arrives.
use std::f32::consts::FRAC_1_PI;

use durer_core::{math::Vector3, spectrum::Spectrum};

use super::{Glossy, Sheen};

/// Points of the mean over cosines, where coats or fibres are there too.
const STEPS: usize = 8;

/// What lies on top of everything else: a clear coat, then fibres below it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Veil {
    /// Share of the surface that is coated.
    pub coat: f32,
    /// Width of the coat's facets.
    pub coat_alpha: f32,
    /// Its normal in the frame of the lobes.
    pub coat_normal: Vector3,
    /// The largest component of the fibres' colour.
    pub sheen: f32,
    /// Their width.
    pub sheen_alpha: f32,
}

impl Veil {
    /// Nothing on top.
    pub const NONE: Self = Self {
        coat: 0.0,
        coat_alpha: 0.0,
        coat_normal: Vector3::new(0.0, 0.0, 1.0),
        sheen: 0.0,
        sheen_alpha: 0.0,
    };

    /// Reflectance of the coat at normal incidence: an index of 1.5.
    const COAT: f32 = 0.04;

    /// Share of light that is left for what lies below, along a direction on either side.
    pub fn left(&self, w: Vector3) -> f32 {
        let mut left = 1.0;
        if self.coat > 0.0 {
            let cos = (w.dot(self.coat_normal) * w.z.signum()).clamp(0.0, 1.0);
            left -= self.coat * Glossy::clear(Self::COAT, self.coat_alpha).albedo_at(cos).max();
        }
        if self.sheen > 0.0 {
            left *= 1.0 - self.sheen * Sheen::hides(self.sheen_alpha, w.z.abs().min(1.0));
        }
        left.max(0.0)
    }
    fn is_none(&self) -> bool {
        self.coat == 0.0 && self.sheen == 0.0
    }
    /// The coat by itself, reflecting about the normal of the lobes.
    pub fn coat(&self) -> Glossy {
        Glossy { scale: self.coat, ..Glossy::clear(Self::COAT, self.coat_alpha) }
    }
}

/// A matte body under a layer of facets and a veil.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Under {
    /// `c / <t>`.
    color: Spectrum,
    /// The facets' reflectance at normal and at grazing incidence, and their width.
    ends: (Spectrum, Spectrum),
    alpha: f32,
    veil: Veil,
    /// `t` towards the viewer times `<t>`.
    towards: Spectrum,
    /// Its light leaves on the side that it does not come from.
    pub(super) is_behind: bool,
}

impl Under {
    /// A body of this colour below `above`, of which all is there, and a veil; seen from `wo`. It reflects on the side of the
    /// light, or what shines through it.
    pub fn new(color: Spectrum, above: &Glossy, veil: Veil, wo: Vector3) -> Self {
        let (ends, alpha) = (above.reflectance.ends(), above.facets.alpha());
        let mut under = Self { color, ends, alpha, veil, towards: Spectrum::ONE, is_behind: false };
        let mean = match veil.is_none() {
            true => above.mean_albedo().map(|e| 1.0 - e),
            false => {
                let at = |i: usize| {
                    let cos = ((i as f32 + 0.5) / STEPS as f32).sqrt();
                    under.passes(Vector3::new((1.0 - cos * cos).sqrt(), 0.0, cos))
                };
                (0..STEPS).fold(Spectrum::BLACK, |sum, i| sum + at(i)) / STEPS as f32
            }
        };
        // What lets nothing through has no body.
        under.color = color.zip(mean, |c, mean| if mean > 1e-4 { c / mean } else { 0.0 });
        under.towards = under.passes(wo) * mean;
        under
    }
    /// The same body seen against the light.
    #[must_use]
    pub fn seen_through(self) -> Self {
        Self { is_behind: true, ..self }
    }
    /// `t`.
    fn passes(&self, w: Vector3) -> Spectrum {
        let below = Glossy::albedo_of(self.ends, self.alpha, w.z.abs().min(1.0)).map(|e| (1.0 - e).max(0.0));
        if self.veil.is_none() { below } else { below * self.veil.left(w) }
    }
    pub(super) fn eval(&self, wo: Vector3, wi: Vector3) -> Spectrum {
        self.color * self.passes(wo) * self.passes(wi) * FRAC_1_PI
    }
    /// Share of the light of a uniform sky that leaves towards the viewer.
    pub fn albedo(&self) -> Spectrum {
        self.color * self.towards
    }
    pub(super) fn scaled(self, by: f32) -> Self {
        Self { color: self.color * by, ..self }
    }
}
