//! Where all nodes are at one moment, and what weights morph targets have then.
use std::collections::BTreeMap;

use durer_core::glam::{DAffine3, DMat3, DVec3};

use super::{
    animation::{
        Animation, Changes,
        target::{Bearer, Target},
    },
    document::Document,
    element::Checked,
    node::{Hierarchy, Local},
};

/// What a picture shows of an animation.
#[derive(Clone, Copy)]
pub(super) struct Story<'s> {
    /// The scene while the shutter is open.
    pub(super) stances: &'s [Stance],
    /// What is played.
    pub(super) animation: Option<&'s Animation>,
    /// Whether the animation moves a node, by index; empty if none is played.
    pub(super) moved: &'s [bool],
}

impl Story<'_> {
    /// Whether the animation moves a node.
    pub(super) fn moves(&self, node: usize) -> bool {
        self.moved.get(node).copied().unwrap_or(false)
    }
    /// Whether it changes weights of morph targets.
    pub(super) fn morphs(&self, bearer: Bearer) -> bool {
        self.animation.is_some_and(|animation| animation.morphs(bearer))
    }
}

/// The scene at one moment.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Stance {
    /// In seconds.
    pub(super) time: f32,
    /// Where each node is in the world.
    world: Vec<DAffine3>,
    /// Weights that are not those of the document.
    weights: BTreeMap<Bearer, Vec<f32>>,
}

impl Stance {
    /// The scene as the document has it.
    pub(super) fn at_rest(document: &Document<'_>, nodes: &Hierarchy<'_>) -> Checked<Self> {
        Self::of(document, nodes, 0.0, &Changes::default())
    }
    /// The scene at `time`, when an animation makes these changes.
    pub(super) fn of(
        document: &Document<'_>,
        nodes: &Hierarchy<'_>,
        time: f32,
        changes: &Changes,
    ) -> Checked<Self> {
        let mut locals = nodes.locals.clone();
        for (target, value) in &changes.places {
            let (Target::Translation(index) | Target::Rotation(index) | Target::Scale(index)) = target else {
                continue;
            };
            let Some(Local::Parts { translation, rotation, scale }) = locals.get_mut(*index) else {
                continue;
            };
            match (target, value.as_slice()) {
                (Target::Rotation(_), [x, y, z, w]) => *rotation = [*x, *y, *z, *w],
                (Target::Translation(_), [x, y, z]) => *translation = [*x, *y, *z],
                (_, [x, y, z]) => *scale = [*x, *y, *z],
                _ => {}
            }
        }
        Ok(Self { time, world: nodes.worlds(document, &locals)?, weights: changes.weights.clone() })
    }

    /// Where a node is in the world.
    pub(super) fn world(&self, node: usize) -> DAffine3 {
        self.world.get(node).copied().unwrap_or(DAffine3::IDENTITY)
    }
    /// The animated weights of a node or mesh.
    pub(super) fn weights(&self, bearer: Bearer) -> Option<&[f32]> {
        self.weights.get(&bearer).map(Vec::as_slice)
    }
    /// Whether nothing is elsewhere at another moment.
    pub(super) fn is_like(&self, other: &Self) -> bool {
        self.world == other.world && self.weights == other.weights
    }

    /// How far everything is from where it is in `other`.
    pub(super) fn apart(&self, other: &Self) -> Way {
        self.strays((other, other), 0.0)
    }
    /// How far everything is from the place a share `u` of the straight way from one moment to another.
    pub(super) fn strays(&self, (a, b): (&Self, &Self), u: f64) -> Way {
        let pairs = a.world.iter().zip(&b.world);
        let nodes = self.world.iter().zip(pairs).map(|(m, (a, b))| {
            let linear = m.matrix3 - (a.matrix3 * (1.0 - u) + b.matrix3 * u);
            let shift = m.translation - a.translation.lerp(b.translation, u);
            [length(&linear), shift.length()]
        });
        let nodes = nodes.collect();
        let weights = self.weights.iter().map(|(bearer, own)| {
            let of = |stance: &Self| stance.weights.get(bearer).cloned().unwrap_or_default();
            let between = |(a, b): (f32, f32)| f64::from(a) * (1.0 - u) + f64::from(b) * u;
            let middle = of(a).into_iter().zip(of(b)).map(between);
            own.iter().zip(middle).map(|(w, m)| (f64::from(*w) - m).abs()).fold(0.0, f64::max)
        });
        Way { nodes, weights: weights.collect() }
    }
}

fn length(m: &DMat3) -> f64 {
    let squares: DVec3 = m.x_axis * m.x_axis + m.y_axis * m.y_axis + m.z_axis * m.z_axis;
    squares.element_sum().sqrt()
}

/// Distances of all that moves.
#[derive(Clone, Debug)]
pub(super) struct Way {
    /// By node: of the axes and of the origin.
    nodes: Vec<[f64; 2]>,
    /// By what has weights: of the weight that is farthest.
    weights: Vec<f64>,
}

impl Way {
    fn all(&self) -> impl Iterator<Item = f64> {
        self.nodes.iter().flatten().chain(&self.weights).copied()
    }
    /// The larger of both, for each.
    pub(super) fn grow(&mut self, other: &Self) {
        let own = self.nodes.iter_mut().flatten().chain(&mut self.weights);
        own.zip(other.all()).for_each(|(own, other)| *own = own.max(other));
    }
    /// Whether something is farther than this share of its `way`, by more than rounding.
    pub(super) fn exceeds(&self, way: &Self, share: f64) -> bool {
        const ROUNDING: f64 = 1e-9;
        self.all().zip(way.all()).any(|(stray, way)| stray > way * share + ROUNDING)
    }
}
