//! What a recorded tree must fulfil whatever integrator made it: each law is computed anew, from the scene and not from
//! what the integrator says of itself.
mod energy;
mod interface;
mod light;
mod media;
mod mirror;
mod normal;
mod sum;

use serde::Serialize;

use crate::{
    Object, Prepared,
    glam::DVec3,
    math::Vector3,
    probe::{RayKind, RayTree, TreeHit, TreeNode},
};

/// A law of ray tracing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Law {
    /// Shadow rays lead to their light.
    ShadowRay,
    /// Normals are those of the shape, and shading normals stay on their side.
    Normal,
    /// Refraction follows Snell's law between the bodies on both sides.
    Snell,
    /// Reflection and refraction share the light by Fresnel's equations.
    Fresnel,
    /// Mirrored rays leave as they came.
    Mirror,
    /// A ray is in the bodies that it entered and did not leave.
    Media,
    /// No more light leaves than arrives; radiance is a number, not below 0.
    Energy,
    /// The pixel is the sum of what its rays bring.
    Sum,
}

impl Law {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::ShadowRay,
        Self::Normal,
        Self::Snell,
        Self::Fresnel,
        Self::Mirror,
        Self::Media,
        Self::Energy,
        Self::Sum,
    ];
}

/// A law that a ray breaks.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// Which.
    pub law: Law,
    /// The first ray in the tree that breaks it this way.
    pub node: u32,
    /// The thing that it is about: a light, an object, a number of the ray.
    pub about: String,
    /// What is wrong, in words and numbers.
    pub text: String,
    /// How many rays break it at the same thing.
    pub rays: usize,
}

impl Finding {
    /// Whether the same is wrong with the same thing.
    pub(super) fn is_like(&self, o: &Self) -> bool {
        self.law == o.law && self.about == o.about
    }
}

/// What a check found at a ray: `about` tells what rays have in common that are counted together.
struct Found {
    law: Law,
    node: usize,
    about: String,
    text: String,
}

/// A tree, and the scene that it was recorded in.
struct Checked<'a> {
    prepared: &'a Prepared,
    tree: &'a RayTree,
    children: Vec<Vec<u32>>,
    found: Vec<Found>,
}

/// All laws that rays of a tree break. Empty if the renderer and the scene are sound.
pub fn check(prepared: &Prepared, tree: &RayTree) -> Vec<Finding> {
    let mut checked = Checked { prepared, tree, children: tree.children(), found: Vec::new() };
    checked.sums();
    for (index, node) in tree.nodes.iter().enumerate() {
        checked.energy(index, node);
        if let Some(hit) = &node.hit {
            // What follows from a wrong normal is not wrong by itself.
            let is_turned = checked.normals(index, node, hit);
            if !is_turned {
                checked.media(index, node, hit);
            }
            checked.mirrors(index, node, hit);
            checked.interfaces(index, node, hit);
        }
        checked.shadow_rays(index, node);
    }
    grouped(checked.found)
}

/// One finding for all rays that break a law at the same thing.
fn grouped(found: Vec<Found>) -> Vec<Finding> {
    let mut findings: Vec<Finding> = Vec::new();
    for Found { law, node, about, text } in found {
        let one = Finding { law, node: node as u32, about, text, rays: 1 };
        match findings.iter_mut().find(|known| known.is_like(&one)) {
            Some(known) => known.rays += 1,
            None => findings.push(one),
        }
    }
    findings
}

impl Checked<'_> {
    fn add(&mut self, law: Law, node: usize, about: &str, text: String) {
        self.found.push(Found { law, node, about: about.to_owned(), text });
    }
    fn object(&self, hit: &TreeHit) -> &Object {
        self.prepared.scene.object(hit.object)
    }
    fn name(&self, hit: &TreeHit) -> String {
        self.object(hit).name.clone()
    }
    /// The children of a node with their numbers.
    fn below(&self, index: usize) -> impl Iterator<Item = (usize, &TreeNode)> {
        self.children[index].iter().map(|&c| (c as usize, &self.tree.nodes[c as usize]))
    }
    /// Whether the ray of a node merely passed the surface that it met.
    fn is_passed(&self, index: usize) -> bool {
        self.below(index).any(|(_, child)| child.kind == RayKind::Passing)
    }
}

/// A direction of unit length in double precision.
fn unit(v: Vector3) -> DVec3 {
    v.to_f64().normalize_or_zero()
}

/// Angle between two directions, in radians; exact also where it is small.
fn angle(a: DVec3, b: DVec3) -> f64 {
    a.cross(b).length().atan2(a.dot(b))
}
