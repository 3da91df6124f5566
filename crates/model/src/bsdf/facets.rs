//! How rough a surface is: the distribution of its microfacets, and their widths along two directions.
//!
//! With equal widths the formulas of GGX are those of `ggx.rs`; else `D = 1 / (pi a_x a_y (x²/a_x² + y²/a_y² + z²)²)` and
//! `sqrt(a_x² x² + a_y² y² + z²)` for the root in Smith's terms (Heitz 2014, "Understanding the Masking-Shadowing Function
//! in Microfacet-Based BRDFs"). Beckmann's are in `beckmann.rs`.
use std::f32::consts::PI;

use durer_core::math::{
    Point2, Vector3,
    float::{cos, sin, sqr},
};

use super::{SMOOTH, beckmann, ggx};

/// Least width of facets that are not smooth: below it floats lose the lobe.
const LEAST: f32 = 1e-4;

/// How the normals of microfacets are distributed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Distribution {
    /// Trowbridge and Reitz: some facets are steep on the smoothest of surfaces.
    #[default]
    Ggx,
    /// Beckmann: slopes are normally distributed.
    Beckmann,
}

/// How microfacets hide each other from two directions at once.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shadowing {
    /// By their heights: what is high up is seen from both (Heitz 2014, equation 99).
    #[default]
    Correlated,
    /// The share seen from either, multiplied (Walter et al. 2007).
    Separable,
}

/// Which formulas hold.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Form {
    /// GGX of equal widths.
    Round,
    /// GGX.
    Long,
    Beckmann,
}

/// Microfacets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facets {
    /// Width along the tangent, in `[0, 1]`.
    pub x: f32,
    /// Width across it, in `[0, 1]`.
    pub y: f32,
    /// Tangent of half the angle from the x axis of the frame of the lobes to the direction of `x`, in `[-1, 1]`.
    // PERF: less than the direction itself, so that lobes do not grow (bench render).
    half_turn: f32,
    form: Form,
    shadowing: Shadowing,
}

impl Facets {
    /// GGX, the same in all directions.
    pub const fn round(alpha: f32) -> Self {
        Self { x: alpha, y: alpha, half_turn: 0.0, form: Form::Round, shadowing: Shadowing::Correlated }
    }
    /// GGX of two widths, along and across a direction of the surface given in the frame of the lobes.
    pub fn along(tangent: Vector3, x: f32, y: f32) -> Self {
        let length = (sqr(tangent.x) + sqr(tangent.y)).sqrt();
        if x == y || length.is_nan() || length <= 0.0 || x.max(y) < SMOOTH {
            return Self { form: form(x, y), y, ..Self::round(x) };
        }
        // A tangent and its opposite are the same.
        let half_turn = tangent.y * if tangent.x < 0.0 { -1.0 } else { 1.0 } / (length + tangent.x.abs());
        Self { y: y.max(LEAST), half_turn, form: Form::Long, ..Self::round(x.max(LEAST)) }
    }
    /// With normals distributed like this.
    #[must_use]
    pub fn distributed(self, like: Distribution) -> Self {
        match like {
            Distribution::Ggx => Self { form: form(self.x, self.y), ..self },
            Distribution::Beckmann => Self { form: Form::Beckmann, ..self },
        }
    }
    /// That hide each other like this.
    #[must_use]
    pub fn shadowed(self, shadowing: Shadowing) -> Self {
        Self { shadowing, ..self }
    }
    /// How their normals are distributed.
    pub fn distribution(&self) -> Distribution {
        if self.form == Form::Beckmann { Distribution::Beckmann } else { Distribution::Ggx }
    }
    /// Whether they are so flat that light is reflected sharply.
    pub fn is_smooth(&self) -> bool {
        self.x.max(self.y) < SMOOTH
    }
    /// One width that stands for both: their geometric mean.
    pub fn alpha(&self) -> f32 {
        if self.x == self.y { self.x } else { (self.x * self.y).sqrt() }
    }
    /// With both widths changed.
    #[must_use]
    pub fn map(self, f: impl Fn(f32) -> f32) -> Self {
        self.of_widths(f(self.x), f(self.y))
    }
    /// With other widths.
    #[must_use]
    pub(super) fn of_widths(self, x: f32, y: f32) -> Self {
        Self { x, y, ..self }.distributed(self.distribution())
    }
    fn widths(&self) -> [f32; 2] {
        [self.x, self.y]
    }
    /// Cosine and sine of the angle to the direction of `x`.
    fn tangent(&self) -> [f32; 2] {
        let squared = sqr(self.half_turn);
        [(1.0 - squared) / (1.0 + squared), 2.0 * self.half_turn / (1.0 + squared)]
    }
    /// A direction in the frame of the tangent.
    fn turned(&self, w: Vector3) -> Vector3 {
        let [c, s] = self.tangent();
        Vector3::new(c * w.x + s * w.y, c * w.y - s * w.x, w.z)
    }
    fn turned_back(&self, w: Vector3) -> Vector3 {
        let [c, s] = self.tangent();
        Vector3::new(c * w.x - s * w.y, c * w.y + s * w.x, w.z)
    }
    /// `sqrt(a_x² x² + a_y² y² + z²)`.
    fn root(&self, w: Vector3) -> f32 {
        let w = self.turned(w);
        (sqr(self.x * w.x) + sqr(self.y * w.y) + sqr(w.z)).sqrt()
    }
    /// Density of microfacet normals at the unit vector `h`; 1/sr.
    #[inline]
    pub(super) fn density(&self, h: Vector3) -> f32 {
        match self.form {
            Form::Round => ggx::distribution(h, self.x),
            Form::Long => {
                let h = self.turned(h);
                let q = sqr(h.x / self.x) + sqr(h.y / self.y) + sqr(h.z);
                1.0 / (PI * self.x * self.y * sqr(q))
            }
            Form::Beckmann => beckmann::distribution(self.turned(h), self.widths()),
        }
    }
    /// Shadowing and masking divided by four cosines, which are given as well: above 0.
    #[inline]
    pub(super) fn visibility(&self, (o, cos_o): (Vector3, f32), (i, cos_i): (Vector3, f32)) -> f32 {
        if self.shadowing == Shadowing::Separable {
            return 0.25 * self.seen((o, cos_o)) * self.seen((i, cos_i)) / (cos_o * cos_i);
        }
        match self.form {
            Form::Round => ggx::visibility(cos_o, cos_i, self.x),
            Form::Long => 0.5 / (cos_i * self.root(o) + cos_o * self.root(i)),
            Form::Beckmann => {
                beckmann::visibility((self.turned(o), cos_o), (self.turned(i), cos_i), self.widths())
            }
        }
    }
    /// Smith's masking of a direction with z above 0: the share of microfacets seen from it.
    #[inline]
    pub(super) fn masking(&self, o: Vector3) -> f32 {
        self.seen((o, o.z))
    }
    /// The same of any direction, whose cosine is given as well: above 0.
    #[inline]
    fn seen(&self, (w, cos): (Vector3, f32)) -> f32 {
        match self.form {
            Form::Round => ggx::masking(cos, self.x),
            Form::Long => 2.0 * cos / (cos + self.root(w)),
            Form::Beckmann => beckmann::masking(self.turned(w), self.widths()),
        }
    }
    /// `G2 / G1(o)`, of directions with z above 0 and any z: the share of the facets seen from `o` that `i` sees too.
    pub(super) fn seen_by_both(&self, o: Vector3, i: Vector3) -> f32 {
        let (co, ci) = (o.z, i.z.abs());
        4.0 * co * ci * self.visibility((o, co), (i, ci)) / self.masking(o)
    }
    /// Density of the normals that [`Facets::visible_normal`] draws, 1/sr: `D G1(wo) (wo . h) / cos_o`.
    pub(super) fn visible_density(&self, o: Vector3, h: Vector3) -> f32 {
        self.masking(o) * o.dot(h).max(0.0) * self.density(h) / o.z
    }
    /// The microfacet normal seen from `o` (z above 0) at a point of the unit square: see [`ggx::visible_normal`].
    pub(super) fn visible_normal(&self, o: Vector3, u: Point2) -> Vector3 {
        match self.form {
            Form::Round => ggx::visible_normal(o, self.x, u),
            Form::Long => {
                let stretched = |v: Vector3| Vector3::new(self.x * v.x, self.y * v.y, v.z).normalize();
                let o = stretched(self.turned(o));
                let z = 1.0 - u.y * (1.0 + o.z);
                let r = (1.0 - z * z).max(0.0).sqrt();
                let phi = 2.0 * PI * u.x;
                self.turned_back(stretched(Vector3::new(r * cos(phi), r * sin(phi), z) + o))
            }
            Form::Beckmann => self.turned_back(beckmann::visible_normal(self.turned(o), self.widths(), u)),
        }
    }
}

/// The formulas for GGX of these widths.
fn form(x: f32, y: f32) -> Form {
    if x == y { Form::Round } else { Form::Long }
}
