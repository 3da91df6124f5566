//! Light that was scattered below a boundary and leaves it, where that is smooth or its facets are narrow.
//!
//! One direction below belongs to one above, or to few, and hardly any light would ever be found from there. As in pbrt-v4 what
//! leaves is spread as an even light from below would be: `f = (1 - F(o)) (1 - F(i)) / (pi (1 - mean of F))`, with `F(o)` the
//! reflectance below and `F(i)` that above. What is kept on the whole is as it would be; directions are those of even light.
//! Seen from above, it is how particles get in that shall be met by that: the same `f`, turned round.
use std::f32::consts::FRAC_1_PI;

use durer_core::{
    math::{
        Vector3,
        float::{ln, sqr},
    },
    spectrum::Spectrum,
};

use super::{Bsdf, Interface, Lobe, Matte, Split, fresnel_dielectric};

/// What leaves, as a lobe seen from below, or what gets in, seen from above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leaving {
    /// What gets through towards the viewer.
    passed: Spectrum,
    /// Index on the viewer's side, divided by that on the other.
    pub(super) eta: f32,
    /// `1 - mean of F` above.
    mean: f32,
}

impl Leaving {
    pub(super) fn eval(&self, wi: Vector3) -> Spectrum {
        let passed = 1.0 - fresnel_dielectric(wi.z.abs().min(1.0), self.eta);
        self.passed * (FRAC_1_PI * passed / self.mean)
    }
    /// All that leaves.
    pub(super) fn albedo(&self) -> Spectrum {
        self.passed
    }
    pub(super) fn scaled(self, by: f32) -> Self {
        Self { passed: self.passed * by, ..self }
    }
}

impl Interface {
    /// Adds this interface without what passes it, and that apart, spread as even light would be; seen along `wo`.
    pub(super) fn leave(&self, wo: Vector3, bsdf: &mut Bsdf) {
        let far_over_near = self.eta_seen(wo);
        let (_, passed) = self.shares(wo.z.abs(), far_over_near);
        let split = match self.split {
            Split::Fresnel { reflection, .. } => Split::Fresnel { reflection, transmission: Spectrum::BLACK },
            Split::Constant { reflection, .. } => {
                Split::Constant { reflection, transmission: Spectrum::BLACK }
            }
        };
        let eta = 1.0 / far_over_near;
        let above = if wo.z > 0.0 { far_over_near } else { eta };
        bsdf.add(Lobe::Interface(Self { split, ..*self }));
        bsdf.add(Lobe::Matte(Matte::Leaving(Leaving { passed, eta, mean: 1.0 - fresnel_mean(above) })));
    }
}

/// Share of an even light that a smooth boundary reflects, by the index on its far side divided by that on the near side
/// (Walsh 1926, "The Reflection Factor of a Polished Glass Surface for Diffused Light").
fn fresnel_mean(eta: f32) -> f32 {
    /// Below it the formula loses its digits, and the share grows evenly.
    const LEAST: f32 = 1.002;
    match eta {
        _ if eta < 1.0 => 1.0 - sqr(eta) * (1.0 - fresnel_mean(1.0 / eta)),
        _ if eta < LEAST => (eta - 1.0) / (LEAST - 1.0) * walsh(LEAST),
        _ => walsh(eta),
    }
}

fn walsh(eta: f32) -> f32 {
    let n = f64::from(eta);
    let (n2, n4) = (n * n, n * n * n * n);
    let log = |x: f64| f64::from(ln(x as f32));
    let sum = 0.5
        + (n - 1.0) * (3.0 * n + 1.0) / (6.0 * (n + 1.0) * (n + 1.0))
        + n2 * (n2 - 1.0) * (n2 - 1.0) / (n2 + 1.0).powi(3) * log((n - 1.0) / (n + 1.0))
        - 2.0 * n * n2 * (n2 + 2.0 * n - 1.0) / ((n2 + 1.0) * (n4 - 1.0))
        + 8.0 * n4 * (n4 + 1.0) / ((n2 + 1.0) * (n4 - 1.0) * (n4 - 1.0)) * log(n);
    sum as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_reflectance_is_that_of_all_cosines() {
        for eta in [0.66f32, 0.9, 1.0, 1.001, 1.01, 1.1, 1.33, 1.5, 2.4] {
            const COUNT: u32 = 4000;
            let sum: f64 = (0..COUNT)
                .map(|i| {
                    let cos = ((f64::from(i) + 0.5) / f64::from(COUNT)).sqrt();
                    f64::from(fresnel_dielectric(cos as f32, eta))
                })
                .sum();
            let mean = sum / f64::from(COUNT);
            assert!(
                (f64::from(fresnel_mean(eta)) - mean).abs() < 1e-3,
                "{eta}: {} {mean}",
                fresnel_mean(eta)
            );
        }
    }
}
