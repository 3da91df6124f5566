//! A hair: a rough dielectric cylinder, coloured inside, with tilted scales.
//!
//! Marschner and others 2003, "Light Scattering from Human Hair Fibers"; d'Eon and others 2011, "An Energy-Conserving Hair
//! Reflectance Model"; Chiang and others 2016, "A Practical and Controllable Hair and Fur Model for Production Path
//! Tracing", whose fits to roughness are used (Physically Based Rendering, 4th edition, section 9.9):
//! `f cos = sum of M_p(theta_o, theta_i) A_p(theta_o) N_p(phi)` over light that is reflected (`p = 0`), passes (1), passes
//! after one reflection inside (2), and all the rest. Nothing is lost but what `sigma_a` absorbs. Attenuations depend on
//! `theta_o` alone: the model is not reciprocal.
use std::f32::consts::{PI, TAU};

use durer_core::{
    math::{
        Point2, Vector3,
        float::{asin, atan2, cos, exp, ln, sin, sqr},
    },
    spectrum::Spectrum,
};

use super::fresnel_dielectric;

/// Orders of scattering that have a lobe of their own; one more stands for the rest.
const ORDERS: usize = 3;
/// `sqrt(pi / 8)`: from a width of Chiang's fit to the scale of a logistic distribution.
const SQRT_PI_BY_8: f32 = 0.626_657_07;
/// Least roughness: narrower lobes leave the range of single precision.
const LEAST_BETA: f32 = 0.01;

/// Where a hair was hit, in the frame of the lobes: along the hair, and across to where `h` grows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strand {
    /// Unit vector along the hair, perpendicular to the normal.
    pub along: Vector3,
    /// Whether across is to the left of it, seen from outside.
    pub is_left: bool,
    /// Distance of the ray from the axis by the radius, in `[-1, 1]`.
    pub h: f32,
}

/// The surface of a hair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hair {
    /// Absorption per radius of the hair.
    sigma_a: Spectrum,
    eta: f32,
    h: f32,
    /// Longitudinal variance of the reflection.
    variance: f32,
    /// Scale of the azimuthal distributions.
    logistic: f32,
    /// Sine and cosine of the scales' tilt.
    tilt: [f32; 2],
    /// Along the hair, in the tangent plane.
    along: [f32; 2],
    /// 1 or -1: across, as seen with `along`.
    side: f32,
    scale: f32,
}

/// A direction in the frame of a hair.
struct Angles {
    sin_theta: f64,
    cos_theta: f64,
    phi: f32,
}

/// What a hair does with light that leaves along one direction.
struct Orders {
    /// Sines and cosines of `theta_o` as the scales see it, for each order and the rest.
    tilted: [[f64; 2]; ORDERS + 1],
    attenuation: [Spectrum; ORDERS + 1],
    /// Azimuth that each order would leave at were it not rough, from that of `wo`.
    phi: [f32; ORDERS],
}

/// `c` squared by the polynomial of Chiang's fit: what a reflectance of many hairs asks of one.
fn fit(beta_n: f32) -> f32 {
    let b = beta_n;
    ((((0.245 * b + 5.574) * b - 10.73) * b + 2.532) * b - 0.215) * b + 5.969
}

impl Hair {
    /// Absorption of one lane at which hairs of azimuthal roughness `beta_n` together have colour `c`, in `[0, 1]`.
    pub fn absorption(c: f32, beta_n: f32) -> f32 {
        // Black would absorb without bound.
        sqr(ln(c.max(1e-6)) / fit(beta_n.clamp(LEAST_BETA, 1.0)))
    }

    /// With absorption per radius, index of refraction, roughness along and across the hair in `[0, 1]`, and tilt of the
    /// scales in radians.
    pub fn new(strand: &Strand, sigma_a: Spectrum, eta: f32, [beta_m, beta_n]: [f32; 2], tilt: f32) -> Self {
        let [m, n] = [beta_m, beta_n].map(|beta| beta.clamp(LEAST_BETA, 1.0));
        let power = |b: f32, n: i32| (0..n).fold(1.0, |all, _| all * b);
        let along = Vector3::new(strand.along.x, strand.along.y, 0.0);
        let along =
            if along.length_squared() > 0.0 { along.normalize() } else { Vector3::new(1.0, 0.0, 0.0) };
        Self {
            sigma_a,
            eta,
            h: strand.h.clamp(-1.0, 1.0),
            variance: sqr(0.726 * m + 0.812 * m * m + 3.7 * power(m, 20)),
            logistic: SQRT_PI_BY_8 * (0.265 * n + 1.194 * n * n + 5.372 * power(n, 22)),
            tilt: [sin(tilt), cos(tilt)],
            along: [along.x, along.y],
            side: if strand.is_left { 1.0 } else { -1.0 },
            scale: 1.0,
        }
    }
    pub(super) fn scaled(self, by: f32) -> Self {
        Self { scale: self.scale * by, ..self }
    }
    /// Colour of many such hairs, for azimuthal roughness 0.3.
    pub(super) fn tint(&self) -> Spectrum {
        self.sigma_a.map(|sigma| exp(-sigma.sqrt() * fit(0.3))) * self.scale
    }

    /// The share of light that leaves along `wo`.
    pub(super) fn strength(&self, wo: Vector3) -> f32 {
        let orders = self.orders(&self.angles(wo));
        orders.attenuation.iter().map(|a| a.mean()).sum::<f32>() * self.scale
    }

    fn variance(&self, order: usize) -> f64 {
        f64::from(self.variance) * [1.0, 0.25, 4.0, 4.0][order.min(ORDERS)]
    }

    fn angles(&self, w: Vector3) -> Angles {
        let [x, y] = self.along;
        let along = (w.x * x + w.y * y).clamp(-1.0, 1.0);
        let across = (w.y * x - w.x * y) * self.side;
        let sin_theta = f64::from(along);
        Angles {
            sin_theta,
            cos_theta: (1.0 - sin_theta * sin_theta).max(0.0).sqrt(),
            phi: atan2(w.z, across),
        }
    }
    fn direction(&self, sin_theta: f32, cos_theta: f32, phi: f32) -> Vector3 {
        let [x, y] = self.along;
        let across = cos_theta * cos(phi) * self.side;
        Vector3::new(sin_theta * x - across * y, sin_theta * y + across * x, cos_theta * sin(phi)).normalize()
    }

    fn orders(&self, wo: &Angles) -> Orders {
        let (sin_o, cos_o) = (wo.sin_theta as f32, wo.cos_theta as f32);
        let cos_theta_t = (1.0 - sqr(sin_o / self.eta)).max(0.0).sqrt();
        let eta_seen = (sqr(self.eta) - sqr(sin_o)).max(0.0).sqrt() / cos_o.max(1e-6);
        let sin_gamma_t = (self.h / eta_seen).clamp(-1.0, 1.0);
        let way = 2.0 * (1.0 - sqr(sin_gamma_t)).max(0.0).sqrt() / cos_theta_t.max(1e-6);
        let passed = self.sigma_a.map(|sigma| exp(-sigma * way));
        let f = fresnel_dielectric(cos_o * (1.0 - sqr(self.h)).max(0.0).sqrt(), self.eta);
        let through = passed * sqr(1.0 - f);
        let again = passed * f;
        let rest = again.map(|a| if a < 1.0 { a / (1.0 - a) } else { 0.0 });
        let attenuation = [Spectrum::splat(f), through, through * again, through * again * rest];
        let [s, c] = self.tilt.map(f64::from);
        let (twice, four) = ([2.0 * s * c, c * c - s * s], |[s, c]: [f64; 2]| [2.0 * s * c, c * c - s * s]);
        // Scales lean towards the root: reflection turns by twice the tilt, the others the other way.
        let turned = |[s, c]: [f64; 2]| {
            [wo.sin_theta * c + wo.cos_theta * s, (wo.cos_theta * c - wo.sin_theta * s).abs()]
        };
        let back = [-twice[0], twice[1]];
        let tilted = [turned(back), turned([s, c]), turned(four(twice)), [wo.sin_theta, wo.cos_theta]];
        let (gamma_o, gamma_t) = (asin(self.h), asin(sin_gamma_t));
        let phi = std::array::from_fn(|p| 2.0 * p as f32 * gamma_t - 2.0 * gamma_o + p as f32 * PI);
        Orders { tilted, attenuation, phi }
    }

    /// Sum over the orders of what `weigh` makes of their attenuation, times their distributions.
    fn sum<T: std::ops::Add<Output = T> + std::ops::Mul<f32, Output = T>>(
        &self,
        orders: &Orders,
        (wo, wi): (&Angles, &Angles),
        weigh: impl Fn(usize) -> T,
    ) -> T {
        let dphi = wi.phi - wo.phi;
        let of = |p: usize| {
            let across = orders.phi.get(p).map_or(1.0 / TAU, |phi| trimmed(dphi - phi, self.logistic));
            weigh(p) * (longitudinal(wi, orders.tilted[p], self.variance(p)) * across)
        };
        (1..=ORDERS).fold(of(0), |sum, p| sum + of(p))
    }

    /// The share of each order in what leaves.
    fn shares(orders: &Orders) -> [f32; ORDERS + 1] {
        let means = orders.attenuation.map(|a| a.mean());
        let all: f32 = means.iter().sum();
        means.map(|mean| mean / all)
    }

    /// Value without the cosine, 1/sr.
    pub fn eval(&self, wo: Vector3, wi: Vector3) -> Spectrum {
        let cosine = wi.z.abs();
        if cosine == 0.0 {
            return Spectrum::BLACK;
        }
        let (wo, wi) = (self.angles(wo), self.angles(wi));
        let orders = self.orders(&wo);
        self.sum(&orders, (&wo, &wi), |p| orders.attenuation[p]) * (self.scale / cosine)
    }

    /// Density of [`Hair::draw`], 1/sr.
    pub fn pdf(&self, wo: Vector3, wi: Vector3) -> f32 {
        let (wo, wi) = (self.angles(wo), self.angles(wi));
        let orders = self.orders(&wo);
        let shares = Self::shares(&orders);
        self.sum(&orders, (&wo, &wi), |p| shares[p])
    }

    /// A direction, spread as the hair scatters light.
    pub fn draw(&self, wo: Vector3, choice: f32, u: Point2) -> Vector3 {
        let wo = self.angles(wo);
        let orders = self.orders(&wo);
        let shares = Self::shares(&orders);
        let (mut left, mut order) = (choice, 0);
        while order < ORDERS && left >= shares[order] {
            left -= shares[order];
            order += 1;
        }
        let part = (left / shares[order]).clamp(0.0, 1.0 - f32::EPSILON / 2.0);
        let v = self.variance(order) as f32;
        let [sin_o, cos_o] = orders.tilted[order].map(|x| x as f32);
        let cos_theta = 1.0 + v * ln(u.x.max(1e-5) + (1.0 - u.x) * exp(-2.0 / v));
        let sin_theta = (1.0 - sqr(cos_theta)).max(0.0).sqrt();
        let sin_i = (-cos_theta * sin_o + sin_theta * cos(TAU * u.y) * cos_o).clamp(-1.0, 1.0);
        let cos_i = (1.0 - sqr(sin_i)).max(0.0).sqrt();
        let dphi = orders.phi.get(order).map_or(TAU * part, |phi| phi + drawn(part, self.logistic));
        self.direction(sin_i, cos_i, wo.phi + dphi)
    }
}

/// `M_p`, the distribution of d'Eon: a von Mises-Fisher lobe averaged around the hair. Per sin(theta_i).
fn longitudinal(wi: &Angles, [sin_o, cos_o]: [f64; 2], v: f64) -> f32 {
    let a = wi.cos_theta * cos_o / v;
    let b = wi.sin_theta * sin_o / v;
    // NUMERICS: for narrow lobes a, b and 1 / v are large and their difference is not (white_hair_sums_to_one).
    if v <= 0.1 {
        // ln(2) + ln(1 / 2v) with sinh(1/v) = exp(1/v) / 2.
        let (large, rest) = ln_bessel(a);
        let exponent = (large - b - 1.0 / v) as f32 + rest;
        exp(exponent) / v as f32
    } else {
        let inverse = (1.0 / v) as f32;
        exp(-b as f32) * bessel(a) / ((exp(inverse) - exp(-inverse)) * v as f32)
    }
}

/// The modified Bessel function `I_0` by its series, for arguments up to 12.
fn bessel(x: f64) -> f32 {
    let quarter = x * x * 0.25;
    let (mut term, mut sum) = (1.0, 1.0);
    for k in 1..30 {
        term *= quarter / f64::from(k * k);
        sum += term;
    }
    sum as f32
}

/// `ln I_0` as a large and a small part.
fn ln_bessel(x: f64) -> (f64, f32) {
    if x > 12.0 {
        let series = 1.0 + 1.0 / (8.0 * x) * (1.0 + 9.0 / (16.0 * x) * (1.0 + 25.0 / (24.0 * x)));
        (x, ln(series as f32) - 0.5 * ln((f64::from(TAU) * x) as f32))
    } else {
        (0.0, ln(bessel(x)))
    }
}

/// The logistic distribution of an angle, cut off at half a turn. 1/rad.
fn trimmed(x: f32, s: f32) -> f32 {
    let turns = ((x + PI) / TAU).floor();
    let away = (x - turns * TAU).abs();
    let e = exp(-away / s);
    e / (s * sqr(1.0 + e)) / inside(s)
}

/// The share of the logistic distribution that is not cut off.
fn inside(s: f32) -> f32 {
    let e = exp(-PI / s);
    (1.0 - e) / (1.0 + e)
}

/// An angle of that distribution.
fn drawn(u: f32, s: f32) -> f32 {
    let k = inside(s);
    let cut = 0.5 - 0.5 * k;
    let share = (u * k + cut).clamp(f32::MIN_POSITIVE, 1.0 - f32::EPSILON / 2.0);
    (-s * ln(1.0 / share - 1.0)).clamp(-PI, PI)
}
