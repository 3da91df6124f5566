//! What rays cost by the surface area heuristic: a line that crosses a box crosses a convex part of it with the ratio of
//! their surface areas as probability (MacDonald, Booth 1990, "Heuristics for Ray Tracing Using Space Subdivision").
use durer_core::math::Bounds3;

use crate::{
    Accel, Engine,
    isa::Registers,
    layout::{Link, MovingNode, Node, NodeWriter, Target},
    tree::{Forest, Tree, Trees},
};

impl Accel {
    /// How many nodes and leaves a random line visits on average that crosses the scene's box ([`Accel::bounds`]) and is
    /// stopped by nothing, in the trees of the scene and of instances; a leaf is up to eight triangles, one shape, or one
    /// instance. For brute force, all leaves.
    ///
    /// It compares states of the same scene: `refit` and `set_placements` keep the form of trees, so that it grows as
    /// things move from where they were when the trees were built. Building anew pays where the growth, as a fraction, of
    /// the time that rays take is more than the time to build. Takes time proportional to all nodes.
    pub fn sah_cost(&self) -> f64 {
        let own: Vec<f64> = self
            .geometries
            .iter()
            .map(|geometry| {
                geometry.forest.as_ref().map_or(0.0, |forest| self.forest_cost(forest, None, &[]))
            })
            .collect();
        let whole = f64::from(self.bounds.half_area());
        let forests = std::iter::once(&self.scene).chain(self.movers.iter().map(|movers| &movers.forest));
        forests.map(|forest| self.forest_cost(forest, Some(whole), &own)).sum()
    }

    /// Of a line through a box with half the area `whole`, or through the tree's own box; `own` are the costs of
    /// geometries that are instances. Of trees for stretches of time the mean, weighted by their length.
    fn forest_cost(&self, forest: &Forest, whole: Option<f64>, own: &[f64]) -> f64 {
        let one = |tree: &Tree| match (&forest.trees, self.registers) {
            #[cfg(target_arch = "x86_64")]
            (Trees::Still(_), Registers::Avx512(_)) => self.tree_cost::<Node<16>>(tree, whole, own),
            #[cfg(target_arch = "x86_64")]
            (Trees::Moving { .. }, Registers::Avx512(_)) => {
                self.tree_cost::<MovingNode<16>>(tree, whole, own)
            }
            (Trees::Still(_), _) => self.tree_cost::<Node<8>>(tree, whole, own),
            (Trees::Moving { .. }, _) => self.tree_cost::<MovingNode<8>>(tree, whole, own),
        };
        match &forest.trees {
            Trees::Still(tree) => one(tree),
            Trees::Moving { times, trees } => {
                let weights: Vec<f64> =
                    times.windows(2).map(|pair| f64::from(pair[1]) - f64::from(pair[0])).collect();
                let sum: f64 = trees.iter().zip(&weights).map(|(tree, weight)| weight * one(tree)).sum();
                sum / weights.iter().sum::<f64>()
            }
        }
    }

    fn tree_cost<N: NodeWriter>(&self, tree: &Tree, whole: Option<f64>, own: &[f64]) -> f64 {
        let inside = |link: Link| match link.target() {
            Target::Instance(index) => own[self.instances[index as usize].geometry.index()],
            _ => 0.0,
        };
        let always: f64 = tree.unbounded.iter().chain(&tree.leaves).map(|&link| 1.0 + inside(link)).sum();
        if self.engine == Engine::BruteForce || tree.nodes == 0 {
            return always;
        }
        // In the middle of the stretch.
        let lanes = |number: u32| {
            let node: &N = tree.pages.get(number * tree.node_rows);
            (0..N::WIDTH)
                .filter_map(move |lane| node.lane(lane, 0.5))
                .map(|([min, max], link)| (Bounds3 { min: min.into(), max: max.into() }, Link(link)))
        };
        let root = lanes(0).fold(Bounds3::EMPTY, |all, (b, _)| all.union(b));
        let whole = whole.filter(|area| *area > 0.0).unwrap_or(f64::from(root.half_area()));
        let share = |b: &Bounds3| {
            let ratio = f64::from(b.half_area()) / whole;
            // Flat scenes have no area; boxes are a little larger than what they hold.
            if ratio.is_finite() { ratio.min(1.0) } else { 1.0 }
        };
        let all = (0..tree.nodes).flat_map(lanes);
        always + 1.0 + all.map(|(b, link)| share(&b) * (1.0 + inside(link))).sum::<f64>()
    }
}
