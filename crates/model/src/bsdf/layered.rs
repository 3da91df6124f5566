//! Something under a coat that has no closed form: metal where either is rough, or anything where light scatters in the coat.
//! What light does below the coat's upper side is a random walk (Guo, Hasan and Zhao 2018, "Position-Free Monte Carlo
//! Simulation for Arbitrary Layered BSDFs"; pbrt-v4's model).
//!
//! There is no closed form, so [`Layered::eval`] is an estimate, with numbers that follow from the two directions: the same
//! pair always gives the same value, and over many pairs the mean is right. Way out of the coat: both the coat's facets seen
//! from `wi` and the metal's seen from below are asked, weighted by the power heuristic (Veach and Guibas 1995). Directions
//! are drawn from something simpler of about the same width, whose density is exact. What the coat itself reflects is a lobe
//! of its own.
mod below;
mod cloud;

use std::f32::consts::FRAC_1_PI;

use durer_core::{
    math::{
        Normal3, Point2, Vector3,
        float::{exp, sqr},
    },
    sampling::cosine_hemisphere,
    spectrum::Spectrum,
};

pub use self::{below::Below, cloud::Cloud};
use super::{
    Branch, BranchKind, Distribution, Drawn, Facets, Glossy, Reflectance, coat::faded, fresnel_dielectric,
    refract,
};

/// Light that enters a coat, walks between it and what is below, and leaves it again.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layered {
    /// Index of the coat, relative to the outside.
    pub eta: f32,
    /// Its facets.
    pub coat: Facets,
    /// Of the coat, in units of the mean free path of what is in it.
    pub thickness: f32,
    /// What is in it.
    pub cloud: Cloud,
    /// What is below it.
    pub below: Below,
    /// How often a walk meets what is below at most; it meets twice as many surfaces and particles.
    pub bounces: u16,
    /// Walks per value.
    pub walks: u16,
    /// Factor on the whole lobe, in `[0, 1]`.
    pub scale: f32,
}

/// Numbers that follow from two directions (the mixing function is that of Steele, Lea and Flood 2014, "Fast Splittable
/// Pseudorandom Number Generators").
struct Dice(u64);

impl Dice {
    fn new(wo: Vector3, wi: Vector3) -> Self {
        let mut dice = Self(0);
        for v in [wo.x, wo.y, wo.z, wi.x, wi.y, wi.z] {
            dice.0 ^= u64::from(v.to_bits());
            dice.0 = dice.next();
        }
        dice
    }
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }
    /// In `[0, 1)`.
    fn unit(&mut self) -> f32 {
        (self.next() >> 40) as f32 * (1.0 / (1 << 24) as f32)
    }
    fn point(&mut self) -> Point2 {
        Point2::new(self.unit(), self.unit())
    }
}

fn flipped(w: Vector3) -> Vector3 {
    Vector3::new(w.x, w.y, -w.z)
}

fn square_share(own: f32, other: f32) -> f32 {
    if own > 0.0 && own.is_finite() { sqr(own) / (sqr(own) + sqr(other)) } else { 0.0 }
}

impl Layered {
    /// Whether nothing spreads: with two smooth layers everything leaves in the mirror direction.
    fn is_sharp(&self) -> bool {
        self.coat.is_smooth() && self.below.is_smooth() && !self.cloud.scatters()
    }
    /// Shares of the narrow and the wide microfacets that directions are drawn from; the rest is spread by the cosine. All
    /// are tenths, as the lobe's draws choose by tenths.
    fn shares(&self) -> [f32; 2] {
        match self.below {
            Below::Matte { .. } => [0.0, 0.0],
            // Only particles spread.
            Below::Metal { .. } if self.coat.is_smooth() && self.below.is_smooth() => [0.0, 0.0],
            Below::Metal { .. } if self.cloud.scatters() => [0.3, 0.2],
            Below::Metal { .. } => [0.7, 0.2],
        }
    }

    /// An estimate of the value without the cosine, 1/sr; the same from both sides.
    pub fn eval(&self, wo: Vector3, wi: Vector3) -> Spectrum {
        if wo.z * wi.z <= 0.0 || self.is_sharp() {
            return Spectrum::BLACK;
        }
        let (o, i) = if wo.z < 0.0 { (-wo, -wi) } else { (wo, wi) };
        let mut dice = Dice::new(o, i);
        let sum = (0..self.walks).fold(Spectrum::BLACK, |sum, _| sum + self.walk(o, i, &mut dice));
        sum * (self.scale / (f32::from(self.walks) * sqr(self.eta)))
    }

    fn walk(&self, o: Vector3, i: Vector3, dice: &mut Dice) -> Spectrum {
        if self.cloud.scatters() {
            return self.clouded_walk(o, i, dice);
        }
        let Some((down, share)) = self.entered(o, dice.point()) else { return Spectrum::BLACK };
        // The way out, walked backwards.
        let exit = self.entered(i, dice.point());
        let mut beta = Spectrum::splat(share * faded(self.thickness, down));
        let mut from = -down;
        let mut sum = Spectrum::BLACK;
        for bounce in 0..self.bounces {
            if let Some((out, share)) = exit.filter(|_| !self.below.is_smooth()) {
                let kept = match self.coat.is_smooth() {
                    true => 1.0,
                    false => square_share(self.entering(i, out).1, self.below.density(from, -out)),
                };
                let passed = share * faded(self.thickness, out) * kept;
                sum += beta * self.below.value(from, -out) * passed;
            }
            let Some((up, weight)) = self.below.reflected(from, dice.point()) else { break };
            beta *= weight;
            if !self.coat.is_smooth() {
                let (value, density) = self.entering(i, -up);
                let kept = match self.below.is_smooth() {
                    true => 1.0,
                    false => square_share(self.below.density(from, up), density),
                };
                sum += beta * (value * faded(self.thickness, up) * kept);
            }
            let Some((next, share)) = self.sent_back(up, dice.point()) else { break };
            beta = beta * (share * faded(self.thickness, up) * faded(self.thickness, next));
            from = -next;
            // Walks that carry little end by chance.
            let kept = if bounce > 0 { (4.0 * beta.max()).min(1.0) } else { 1.0 };
            if kept < 1.0 && dice.unit() >= kept {
                break;
            }
            beta = beta / kept;
        }
        sum
    }

    /// The direction that light from `o` takes below the coat at a point of the unit square, and its share.
    fn entered(&self, o: Vector3, u: Point2) -> Option<(Vector3, f32)> {
        let smooth = self.coat.is_smooth();
        let h = if smooth { Vector3::new(0.0, 0.0, 1.0) } else { self.coat.visible_normal(o, u) };
        let down = refract(o, Normal3::from(h), 1.0 / self.eta).filter(|d| d.z < 0.0)?;
        let share = 1.0 - fresnel_dielectric(o.dot(h).clamp(0.0, 1.0), self.eta);
        Some((down, if smooth { share } else { share * self.coat.seen_by_both(o, down) }))
    }

    /// Of a rough coat: what of light from `o` goes on towards `down`, per solid angle there and without the cosine, and the
    /// density with which [`Layered::entered`] takes that direction.
    fn entering(&self, o: Vector3, down: Vector3) -> (f32, f32) {
        let h = o + down * self.eta;
        if h.length_squared() == 0.0 || down.z >= 0.0 {
            return (0.0, 0.0);
        }
        let h = h.normalize();
        let h = if h.z < 0.0 { -h } else { h };
        let (co, ci) = (o.dot(h), down.dot(h));
        if co <= 0.0 || ci >= 0.0 {
            return (0.0, 0.0);
        }
        let across = ci + co / self.eta;
        let density = self.coat.visible_density(o, h) * ci.abs() / sqr(across);
        let share = (1.0 - fresnel_dielectric(co.min(1.0), self.eta)) * self.coat.seen_by_both(o, down);
        (share * density / down.z.abs(), density)
    }

    /// The direction in which the coat sends back what travels towards `up`, and its share.
    fn sent_back(&self, up: Vector3, u: Point2) -> Option<(Vector3, f32)> {
        // Turned over, so that the inside is above; -up is where the light comes from.
        let o = flipped(-up);
        let smooth = self.coat.is_smooth();
        let h = if smooth { Vector3::new(0.0, 0.0, 1.0) } else { self.coat.visible_normal(o, u) };
        let back = h * (2.0 * o.dot(h)) - o;
        let f = fresnel_dielectric(o.dot(h).clamp(0.0, 1.0), 1.0 / self.eta);
        let share = if smooth { f } else { f * self.coat.seen_by_both(o, back) };
        (back.z > 0.0 && share > 0.0).then(|| (flipped(back), share))
    }

    /// Reflection that looks about the same: what integrators see that draw no directions.
    pub(super) fn look(&self) -> Option<Glossy> {
        let [facets, _] = self.widths()?;
        let outside = Spectrum::splat(sqr(1.0 - fresnel_dielectric(1.0, self.eta)));
        let f0 = self.below.fresnel(1.0) * outside * (1.0 - self.clouded());
        let reflectance = Reflectance::Schlick { f0, f90: Spectrum::BLACK };
        Some(Glossy { reflectance, facets, scale: self.scale })
    }
    /// Share of light that meets a particle on its way down or up, if particles scatter; more or less.
    fn clouded(&self) -> f32 {
        if self.cloud.scatters() { 1.0 - exp(-2.0 * self.thickness) } else { 0.0 }
    }
    /// Share of light that it spreads widely, more or less.
    pub(super) fn albedo(&self) -> Spectrum {
        let clouded = self.clouded();
        let body = match self.below {
            Below::Matte { albedo } => albedo,
            Below::Metal { .. } => Spectrum::BLACK,
        };
        let inside = self.cloud.albedo * clouded + body * (1.0 - clouded);
        inside * (self.scale * (1.0 - fresnel_dielectric(1.0, self.eta)))
    }
    /// Share of light that it sends towards `wo`, more or less.
    pub(super) fn strength(&self, wo: Vector3) -> f32 {
        let narrow = self.look().map_or(0.0, |glossy| glossy.reflectance.ends().0.mean() * glossy.scale);
        (narrow + self.albedo().mean()) * self.passed(wo)
    }

    /// Share of light that passes a smooth coat from `wo` and out again, more or less.
    fn passed(&self, wo: Vector3) -> f32 {
        (1.0 - fresnel_dielectric(wo.z.abs().min(1.0), self.eta)) / (1.0 - fresnel_dielectric(1.0, self.eta))
    }

    /// Facets of about the width of what leaves after one and after several bounces between metal and coat: slopes of the metal
    /// count `eta` times outside, those of the coat `(eta - 1) / 2` times on each of the two ways, and `eta` times when it
    /// sends light back.
    fn widths(&self) -> Option<[Facets; 2]> {
        let facets = self.below.facets()?;
        let eta2 = sqr(self.eta);
        let through = 0.5 * sqr(self.eta - 1.0);
        let width = |metal: f32, coat: f32, more: f32| {
            let metal = sqr(metal) * (1.0 + more);
            (eta2 * metal + (through + eta2 * more) * sqr(coat)).sqrt().clamp(0.01, 1.0)
        };
        let base = if facets.x == facets.y { self.coat } else { facets };
        // Of Beckmann's facets GGX finds all directions too.
        let base = base.distributed(Distribution::Ggx);
        Some([0.0, 1.5].map(|more| {
            base.of_widths(width(facets.x, self.coat.x, more), width(facets.y, self.coat.y, more))
        }))
    }

    /// A direction at a point of the unit square, of the kind that `choice` chooses. `None` if it leads into the surface.
    pub(super) fn draw(&self, wo: Vector3, choice: f32, u: Point2) -> Option<Drawn> {
        let wi = self.direction(wo, choice, u)?;
        let pdf = self.pdf(wo, wi);
        let weight = self.eval(wo, wi) * (wi.z.abs() / pdf);
        let branch = Branch { kind: BranchKind::Reflection, wi, weight };
        (pdf > 0.0).then_some(Drawn { branch, pdf })
    }

    /// The direction of [`Layered::draw`].
    pub(super) fn direction(&self, wo: Vector3, choice: f32, u: Point2) -> Option<Vector3> {
        if wo.z == 0.0 || self.is_sharp() {
            return None;
        }
        let o = if wo.z < 0.0 { -wo } else { wo };
        let shares = self.shares();
        let facets = match choice {
            c if c < shares[0] => self.widths().map(|widths| widths[0]),
            c if c < shares[0] + shares[1] => self.widths().map(|widths| widths[1]),
            _ => None,
        };
        let i = match facets {
            Some(facets) => {
                let h = facets.visible_normal(o, u);
                h * (2.0 * o.dot(h)) - o
            }
            None => cosine_hemisphere(u),
        };
        (i.z > 0.0).then(|| if wo.z < 0.0 { -i } else { i })
    }

    /// Density of [`Layered::draw`] at `wi`, 1/sr.
    pub(super) fn pdf(&self, wo: Vector3, wi: Vector3) -> f32 {
        if wo.z * wi.z <= 0.0 || self.is_sharp() {
            return 0.0;
        }
        let (o, i) = if wo.z < 0.0 { (-wo, -wi) } else { (wo, wi) };
        let h = (o + i).normalize();
        let of = |facets: &Facets| facets.masking(o) * facets.density(h) / (4.0 * o.z);
        let shares = self.shares();
        let even = (1.0 - shares[0] - shares[1]) * i.z * FRAC_1_PI;
        self.widths().map_or(even, |[narrow, wide]| shares[0] * of(&narrow) + shares[1] * of(&wide) + even)
    }
}

/// Share of light that two smooth layers send in the mirror direction, seen under `cos`: the walk's closed form. Light that
/// particles scatter is another lobe's.
pub fn mirrored_by_layers(cos: f32, eta: f32, thickness: f32, metal: Reflectance, bounces: u32) -> Spectrum {
    let o = Vector3::new((1.0 - sqr(cos)).max(0.0).sqrt(), 0.0, cos.min(1.0));
    let outside = fresnel_dielectric(o.z, eta);
    let Some(down) = refract(o, Normal3::new(0.0, 0.0, 1.0), 1.0 / eta) else { return Spectrum::ONE };
    let once = metal.at(down.z.abs()) * sqr(faded(thickness, down));
    // From below the coat reflects as much as from above.
    let ratio = once * outside;
    let mut sum = Spectrum::BLACK;
    let mut term = once * sqr(1.0 - outside);
    for _ in 0..bounces {
        sum += term;
        term *= ratio;
    }
    sum + Spectrum::splat(outside)
}
