//! How much of the light that gets into a half-space comes out again, and how its particles must scatter for that.
//!
//! Of isotropic particles of albedo `w` the half-space itself reflects `w H(m) H(m') / (4 (m + m'))` between two cosines,
//! `1 / H(m) = sqrt(1 - w) + w / 2 ∫ m' H(m') / (m + m') dm'` (Chandrasekhar, "Radiative Transfer", 1960, chapters 4 and 5).
//! A smooth boundary of index `eta` sends back `F(m)` of what comes from below, so that the radiance `I` below it solves
//! `I(m) = ∫ w / 2 H H' / (m + m') ((1 - F') + F' I') dm'` for an even sky, and the share of light that got in and comes out is
//! `∫ m (1 - F) I / ∫ m (1 - F)`. Particles that scatter forward by `g` are like isotropic ones of albedo
//! `w (1 - g) / (1 - w g)` (similarity; van de Hulst 1980), which is right to about 1 percent.
use durer_core::spectrum::Spectrum;

use crate::bsdf::fresnel_dielectric;

/// Albedos that are tabulated: `1 - (i / 32)⁴`, as the share changes fastest where almost nothing is absorbed.
const STEPS: usize = 32;
/// Cosines on either side of the critical angle.
const COSINES: usize = 24;
/// Rounds of an iteration at most, and the change below which it ends.
const ROUNDS: usize = 400;
const SETTLED: f64 = 1e-7;

/// The shares of light that come out of half-spaces behind a boundary.
#[derive(Clone, Debug, PartialEq)]
pub struct HalfSpace {
    /// By the fourth root of what a particle absorbs, in steps; falling.
    shares: [f32; STEPS + 1],
}

/// A cosine below the boundary.
struct Node {
    cos: f64,
    width: f64,
    /// What the boundary lets out.
    out: f64,
}

impl HalfSpace {
    /// Behind a smooth boundary of this relative index.
    pub fn new(eta: f32) -> Self {
        let nodes = nodes(eta);
        Self {
            shares: std::array::from_fn(|i| {
                let x = i as f64 / STEPS as f64;
                share(&nodes, 1.0 - x.powi(4)) as f32
            }),
        }
    }

    /// The albedo of particles of asymmetry `g` with which these shares of the light that got in come out again.
    pub fn albedo(&self, share: Spectrum, g: f32) -> Spectrum {
        share.map(|share| {
            let absorbed = self.absorbed(share);
            // By similarity.
            1.0 - absorbed * (1.0 - g) / (1.0 - g + (1.0 - absorbed) * g)
        })
    }

    /// What an isotropic particle absorbs.
    fn absorbed(&self, share: f32) -> f32 {
        let above = self.shares.partition_point(|s| *s > share).clamp(1, STEPS);
        let (before, after) = (self.shares[above - 1], self.shares[above]);
        let t = if before > after { ((before - share) / (before - after)).clamp(0.0, 1.0) } else { 0.0 };
        let x = (above as f32 - 1.0 + t) / STEPS as f32;
        x * x * x * x
    }
}

/// Cosines with weights: more of them where the boundary begins to let light out.
fn nodes(eta: f32) -> Vec<Node> {
    let critical = (1.0 - f64::from(eta.max(1.0)).powi(-2)).sqrt();
    let mut nodes = Vec::new();
    for i in 0..COSINES {
        let (x, h) = ((i as f64 + 0.5) / COSINES as f64, 1.0 / COSINES as f64);
        if critical > 0.0 {
            nodes.push(Node { cos: critical * x, width: critical * h, out: 0.0 });
        }
        let cos = critical + (1.0 - critical) * x * x;
        let out = 1.0 - f64::from(fresnel_dielectric(cos as f32, 1.0 / eta));
        nodes.push(Node { cos, width: (1.0 - critical) * 2.0 * x * h, out });
    }
    nodes
}

/// The share of light that comes out again where particles have this albedo.
fn share(nodes: &[Node], albedo: f64) -> f64 {
    let h = chandrasekhar(nodes, albedo);
    let reflected = |i: usize, j: usize| {
        0.5 * albedo * h[i] * h[j] * nodes[j].cos * nodes[j].width / (nodes[i].cos + nodes[j].cos)
    };
    let next = |below: &[f64]| -> Vec<f64> {
        let down: Vec<f64> = nodes.iter().zip(below).map(|(n, i)| n.out + (1.0 - n.out) * i).collect();
        (0..nodes.len()).map(|i| (0..nodes.len()).map(|j| reflected(i, j) * down[j]).sum()).collect()
    };
    let below = settled(vec![0.0; nodes.len()], next);
    let through = |f: &dyn Fn(usize) -> f64| -> f64 {
        nodes.iter().enumerate().map(|(i, n)| n.cos * n.width * n.out * f(i)).sum()
    };
    through(&|i| below[i]) / through(&|_| 1.0)
}

/// `H` at the nodes.
fn chandrasekhar(nodes: &[Node], albedo: f64) -> Vec<f64> {
    let next = |h: &[f64]| -> Vec<f64> {
        let inverse = |n: &Node| {
            let sum: f64 = nodes.iter().zip(h).map(|(m, h)| m.cos * h * m.width / (n.cos + m.cos)).sum();
            (1.0 - albedo).sqrt() + 0.5 * albedo * sum
        };
        nodes.iter().map(|n| 1.0 / inverse(n)).collect()
    };
    // The mean of two rounds settles faster than the last of them.
    settled(vec![1.0; nodes.len()], |h| next(h).iter().zip(h).map(|(a, b)| 0.5 * (a + b)).collect())
}

/// Repeats until nothing changes.
fn settled(mut values: Vec<f64>, next: impl Fn(&[f64]) -> Vec<f64>) -> Vec<f64> {
    for _ in 0..ROUNDS {
        let after = next(&values);
        let change = after.iter().zip(&values).fold(0.0f64, |most, (a, b)| most.max((a - b).abs()));
        values = after;
        if change < SETTLED {
            break;
        }
    }
    values
}

#[cfg(test)]
mod tests {
    use durer_testkit::random::Random;

    use super::*;

    /// The share that comes out of walks which begin as an even sky's light gets in.
    fn walked(eta: f32, albedo: f64) -> f64 {
        let mut random = Random::new(7);
        let (mut entered, mut left) = (0.0, 0.0);
        for _ in 0..30_000 {
            // Backwards, from below: a cosine is met as often as it lets light through.
            let mut cos = -random.unit().sqrt();
            let boundary = |cos: f64| f64::from(fresnel_dielectric(cos as f32, 1.0 / eta));
            let weight = 1.0 - boundary(-cos);
            entered += weight;
            let (mut depth, mut alive) = (0.0, weight);
            while alive > 0.0 {
                depth -= cos * -(1.0 - random.unit()).ln();
                if depth < 0.0 {
                    if random.unit() >= boundary(cos) {
                        left += alive;
                        break;
                    }
                    // Back in, by what was left of the way.
                    depth = -depth;
                }
                if random.unit() >= albedo {
                    alive = 0.0;
                }
                cos = 2.0 * random.unit() - 1.0;
            }
        }
        left / entered
    }

    #[test]
    fn half_spaces_send_back_what_walks_bring_out() {
        for (eta, albedo) in [(1.0, 0.5), (1.0, 0.9), (1.33, 0.8), (1.33, 0.99), (1.6, 0.95)] {
            let (told, walked) = (share(&nodes(eta), albedo), walked(eta, albedo));
            assert!((told - walked).abs() < 8e-3, "{eta}, {albedo}: {told}, walks say {walked}");
        }
        // Without a boundary a fit is known; where nothing absorbs nothing is lost.
        let of = |albedo: f64| {
            let root = (1.0 - albedo).sqrt();
            (1.0 - root) * (1.0 - 0.139 * root) / (1.0 + 1.17 * root)
        };
        for albedo in [0.1, 0.6, 0.95, 1.0] {
            let found = share(&nodes(1.0), albedo);
            assert!((found - of(albedo)).abs() < 8e-3, "{albedo}: {found}, not {}", of(albedo));
        }
        assert!((share(&nodes(1.33), 1.0) - 1.0).abs() < 3e-3, "{}", share(&nodes(1.33), 1.0));
    }

    #[test]
    fn albedos_lead_back_to_the_shares_that_were_asked_for() {
        for eta in [1.0f32, 1.33, 1.8] {
            let half = HalfSpace::new(eta);
            for asked in [0.0f32, 0.05, 0.3, 0.7, 0.95, 1.0] {
                let albedo = half.albedo(Spectrum::splat(asked), 0.0).max();
                let found = share(&nodes(eta), f64::from(albedo));
                assert!((found - f64::from(asked)).abs() < 3e-3, "{eta}, {asked}: {albedo} gives {found}");
                let forward = half.albedo(Spectrum::splat(asked), 0.8).max();
                let like = forward * 0.2 / (1.0 - forward * 0.8);
                assert!((like - albedo).abs() < 1e-4, "{like} is not {albedo}");
            }
        }
    }
}
