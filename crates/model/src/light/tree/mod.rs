//! A tree of lights, by which one of many is chosen where light is wanted.
//!
//! From the root down one of two children is taken in proportion to a bound on what each could send (Conty Estevez and
//! Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting"; Physically Based Rendering, 4th edition,
//! section 12.6.3). Of a node that a point sees in the direction at angle `theta_w` from the axis of its normals
//!
//! `importance = I cos(theta') cos(theta_i') / d²`, `theta' = theta_w - theta_o - theta_b`, `theta_i' = theta_i - theta_b`,
//!
//! angles below 0 being 0: `theta_o` is the angle of the cone of normals, `theta_b` the half angle of a sphere around the
//! node, `theta_i` the angle from the receiver's normal. It is 0 only where nothing can arrive: beyond the angle at which
//! the light ends, and behind the receiver. `d` is at least the sphere's radius.
mod bounds;
mod build;

use durer_core::math::{
    Normal3, Point3, Vector3,
    float::{cos, sin},
};

pub use self::bounds::{Cone, LightBounds};

/// No node.
const NONE: u32 = u32::MAX;
/// Up to so many lights are all looked at: that costs no more than the way down, and is more exact.
const FEW: usize = 4;
/// Levels that no tree exceeds.
const DEEPEST: usize = 64;
/// The spheres around nodes are larger by this factor, squared, so that rounding never loses what lies at their rim.
const LARGER: f32 = 1.0 + 1e-5;

/// A light or two nodes.
#[derive(Clone, Copy, Debug, Default)]
struct Node {
    center: Point3,
    /// Of the sphere around it, squared.
    radius2: f32,
    axis: Vector3,
    /// Of the cone of normals.
    cos_o: f32,
    sin_o: f32,
    /// Of the angle beyond which it is dark.
    cos_end: f32,
    intensity: f32,
    /// The light, or the first of two children.
    link: u32,
    parent: u32,
    is_leaf: bool,
    both_sides: bool,
}

impl Node {
    fn set(&mut self, known: &LightBounds, link: u32, is_leaf: bool) {
        *self = Self {
            center: known.bounds.center(),
            radius2: 0.25 * known.bounds.diagonal().length_squared() * LARGER,
            axis: known.normals.axis,
            cos_o: cos(known.normals.angle),
            sin_o: sin(known.normals.angle),
            cos_end: cos(known.end),
            intensity: known.intensity,
            link,
            parent: self.parent,
            is_leaf,
            both_sides: known.both_sides,
        };
    }

    /// Whether [`Node::importance`] is above 0: what shines into a half space in the direction of its axis, and receivers,
    /// see nothing behind their plane. PERF: without roots, as most scenes have a light or two (bench render).
    fn may_reach(&self, p: Point3, n: Option<Normal3>) -> bool {
        if self.cos_o < 1.0 || self.cos_end.abs() > 1e-6 {
            return self.importance(p, n) > 0.0;
        }
        let d = p - self.center;
        if d.length_squared() <= self.radius2 {
            return self.intensity > 0.0;
        }
        let is_behind = |along: f32| along < 0.0 && along * along > self.radius2;
        let is_dark = !self.both_sides && is_behind(self.axis.dot(d));
        self.intensity > 0.0 && !is_dark && !n.is_some_and(|n| is_behind(-n.dot(d)))
    }

    /// About the most irradiance that can come from it to `p`, on a surface of normal `n`.
    fn importance(&self, p: Point3, n: Option<Normal3>) -> f32 {
        let d = p - self.center;
        let squared = d.length_squared();
        if squared <= self.radius2 {
            // From within it may come from everywhere.
            return if self.radius2 > 0.0 { (self.intensity / self.radius2).min(f32::MAX) } else { 0.0 };
        }
        let inverse = 1.0 / squared.sqrt();
        let sin2 = self.radius2 / squared;
        let around = ((1.0 - sin2).sqrt(), sin2.sqrt());
        let along = self.axis.dot(d) * inverse;
        let cos_w = if self.both_sides { along.abs() } else { along };
        let cos_out = less(less(with_sine(cos_w), (self.cos_o, self.sin_o)), around).0;
        if cos_out < self.cos_end {
            return 0.0;
        }
        let cos_in = n.map_or(1.0, |n| less(with_sine(-n.dot(d) * inverse), around).0.max(0.0));
        (self.intensity * cos_out.max(0.0) * cos_in / squared).min(f32::MAX)
    }
}

/// Cosine and sine of the angle in `[0, pi]` of this cosine.
fn with_sine(cos: f32) -> (f32, f32) {
    (cos, (1.0 - cos * cos).max(0.0).sqrt())
}

/// Cosine and sine of the angle of `a` less that of `b`, and of 0 if that is negative.
fn less(a: (f32, f32), b: (f32, f32)) -> (f32, f32) {
    if a.0 >= b.0 { (1.0, 0.0) } else { (a.0 * b.0 + a.1 * b.1, a.1 * b.0 - a.0 * b.1) }
}

/// A tree of lights.
#[derive(Debug)]
pub struct LightTree {
    nodes: Vec<Node>,
    /// The leaf of each light; [`NONE`] for those that are dark.
    leaves: Vec<u32>,
}

/// What a tree chose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Picked {
    /// The light.
    pub index: usize,
    /// Its chance.
    pub chance: f64,
    /// How far the number that chose it lies within its chance, in `[0, 1)`.
    pub rest: f64,
}

impl LightTree {
    /// A tree of these lights; those of no intensity are never chosen. `None` if all are dark.
    pub fn new(lights: impl ExactSizeIterator<Item = LightBounds>) -> Option<Self> {
        let mut growing = build::Growing::new(lights.len());
        let shines = |known: &LightBounds| known.intensity > 0.0 && known.bounds.is_finite();
        let mut items: Vec<_> = (0..)
            .zip(lights)
            .filter(|(_, known)| shines(known))
            .map(|(i, known)| build::Item::new(i, known))
            .collect();
        if items.is_empty() {
            return None;
        }
        growing.fill(0, &mut items, 0);
        Some(Self { nodes: growing.nodes, leaves: growing.leaves })
    }

    /// A light for point `p` on a surface of unit normal `n`, chosen by `u` in `[0, 1)`; `None` if nothing can arrive.
    pub fn choose(&self, p: Point3, n: Option<Normal3>, u: f64) -> Option<Picked> {
        let (mut node, mut chance, mut rest) = (&self.nodes[0], 1.0, u);
        if node.is_leaf {
            return node.may_reach(p, n).then_some(Picked { index: node.link as usize, chance, rest });
        }
        if self.leaves.len() <= FEW {
            return self.choose_of_few(p, n, u);
        }
        while !node.is_leaf {
            let first = self.first_share(node, p, n)?;
            let is_first = rest < first;
            let (share, before) = if is_first { (first, 0.0) } else { (1.0 - first, first) };
            chance *= share;
            rest = ((rest - before) / share).clamp(0.0, 1.0 - f64::EPSILON);
            node = &self.nodes[node.link as usize + usize::from(!is_first)];
        }
        Some(Picked { index: node.link as usize, chance, rest })
    }

    /// What each of few lights may send, and all together.
    fn of_few(&self, p: Point3, n: Option<Normal3>) -> ([f32; FEW], f64) {
        let (mut each, mut total) = ([0.0; FEW], 0.0);
        for (own, &leaf) in each.iter_mut().zip(&self.leaves) {
            if leaf != NONE {
                *own = self.nodes[leaf as usize].importance(p, n);
                total += f64::from(*own);
            }
        }
        (each, total)
    }

    fn choose_of_few(&self, p: Point3, n: Option<Normal3>, u: f64) -> Option<Picked> {
        let (each, total) = self.of_few(p, n);
        let mut left = u * total;
        let mut picked = None;
        for (index, own) in each.iter().map(|own| f64::from(*own)).enumerate() {
            if own > 0.0 {
                let rest = (left / own).clamp(0.0, 1.0 - f64::EPSILON);
                picked = Some(Picked { index, chance: own / total, rest });
                if left < own {
                    break;
                }
            }
            left -= own;
        }
        picked
    }

    /// The chance with which [`LightTree::choose`] gives light `index`.
    pub fn chance(&self, p: Point3, n: Option<Normal3>, index: usize) -> f64 {
        let root = &self.nodes[0];
        if root.is_leaf {
            return if root.link as usize == index && root.may_reach(p, n) { 1.0 } else { 0.0 };
        }
        if self.leaves.len() <= FEW {
            let (each, total) = self.of_few(p, n);
            let own = each.get(index).map_or(0.0, |own| f64::from(*own));
            return if own > 0.0 { own / total } else { 0.0 };
        }
        let mut way = [0u32; DEEPEST];
        let mut steps = 0;
        let Some(mut at) = self.leaves.get(index).copied().filter(|leaf| *leaf != NONE) else { return 0.0 };
        while at != 0 {
            way[steps] = at;
            steps += 1;
            at = self.nodes[at as usize].parent;
        }
        let mut chance = 1.0;
        for &child in way[..steps].iter().rev() {
            let parent = &self.nodes[self.nodes[child as usize].parent as usize];
            let Some(first) = self.first_share(parent, p, n) else { return 0.0 };
            chance *= if child == parent.link { first } else { 1.0 - first };
        }
        chance
    }

    /// About the irradiance that can come from all lights to `p`, on a surface of unit normal `n`.
    pub fn estimate(&self, p: Point3, n: Option<Normal3>) -> f32 {
        if self.leaves.len() <= FEW {
            return (self.of_few(p, n).1 as f32).min(f32::MAX);
        }
        let root = &self.nodes[0];
        let [a, b] = [0, 1].map(|i| self.nodes[root.link as usize + i].importance(p, n));
        a + b
    }

    /// The chance of the first of a node's children; `None` if nothing comes from either.
    fn first_share(&self, node: &Node, p: Point3, n: Option<Normal3>) -> Option<f64> {
        let [a, b] = [0, 1].map(|i| f64::from(self.nodes[node.link as usize + i].importance(p, n)));
        (a + b > 0.0).then(|| a / (a + b))
    }
}
