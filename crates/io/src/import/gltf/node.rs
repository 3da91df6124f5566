//! The node hierarchy: who is whose child, and where nodes are in the world, composed in f64.
//!
//! Nodes must form disjoint trees (glTF 2.0, section 3.5.2). Nothing here recurses: a chain may be as long as the file.
use durer_core::glam::{DAffine3, DMat3, DQuat, DVec3};

use super::{
    document::{Document, only},
    element::{Checked, Element},
};

/// All nodes of a document.
pub(super) struct Hierarchy<'a> {
    nodes: Vec<Element<'a>>,
    children: Vec<Vec<usize>>,
    /// Indices of the nodes that are no other's child.
    pub(super) roots: Vec<usize>,
    /// The nodes' own transforms, as the document has them.
    pub(super) locals: Vec<Local>,
}

/// A node's own transform.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Local {
    /// A matrix.
    Matrix(DAffine3),
    /// What animations can change.
    Parts {
        /// In metres.
        translation: [f64; 3],
        /// x, y, z, w.
        rotation: [f64; 4],
        /// Along the axes.
        scale: [f64; 3],
    },
}

impl Local {
    /// `None` if the rotation is none.
    fn affine(&self) -> Option<DAffine3> {
        match *self {
            Self::Matrix(m) => Some(m),
            Self::Parts { translation, rotation, scale } => trs(translation, rotation, scale),
        }
    }
}

impl<'a> Hierarchy<'a> {
    /// Reads all nodes; one whose own transform is at fault stands where its parent does, after a complaint.
    pub(super) fn read(document: &Document<'a>) -> Checked<Self> {
        let nodes = document.root.list("nodes")?;
        let mut parents: Vec<Option<usize>> = vec![None; nodes.len()];
        let mut children = Vec::with_capacity(nodes.len());
        for (index, node) in nodes.iter().enumerate() {
            let mut own = Vec::new();
            for reference in node.list("children")? {
                let child = reference.index()?;
                match parents.get_mut(child) {
                    Some(parent @ None) => *parent = Some(index),
                    Some(Some(other)) => {
                        return Err(reference.fault(format!(
                            "/nodes/{child} is already a child of /nodes/{other}: a node has one parent"
                        )));
                    }
                    None => return Err(no_such_node(&reference, child, nodes.len())),
                }
                own.push(child);
            }
            children.push(own);
        }
        let roots = parents.iter().enumerate().filter(|(_, p)| p.is_none()).map(|(i, _)| i).collect();
        let upright = Local::Matrix(DAffine3::IDENTITY);
        let own = |node: &Element<'a>| document.keep(local(document, node)).unwrap_or(upright.clone());
        let locals = nodes.iter().map(own).collect();
        let hierarchy = Self { nodes, children, roots, locals };
        hierarchy.check()?;
        Ok(hierarchy)
    }

    /// Where all nodes are with these transforms of their own.
    pub(super) fn worlds(&self, document: &Document<'_>, locals: &[Local]) -> Checked<Vec<DAffine3>> {
        let mut worlds = vec![DAffine3::IDENTITY; self.nodes.len()];
        let mut stack: Vec<(usize, DAffine3)> = self.roots.iter().map(|&i| (i, DAffine3::IDENTITY)).collect();
        while let Some((index, above)) = stack.pop() {
            let Some((node, local)) = self.nodes.get(index).zip(locals.get(index)) else { continue };
            let own = local.affine().unwrap_or_else(|| {
                document.error(node.fault_at("rotation", "a quaternion of length 0"));
                DAffine3::IDENTITY
            });
            let world = above * own;
            if !world.is_finite() {
                return Err(node.fault("the transforms above this node multiply to infinity"));
            }
            if let Some(place) = worlds.get_mut(index) {
                *place = world;
            }
            stack.extend(self.children_of(index).iter().map(|&child| (child, world)));
        }
        Ok(worlds)
    }

    /// Complains about nodes that no root leads to.
    fn check(&self) -> Checked<()> {
        let mut reached = vec![false; self.nodes.len()];
        let mut stack = self.roots.clone();
        while let Some(index) = stack.pop() {
            if let Some(reached) = reached.get_mut(index) {
                *reached = true;
            }
            stack.extend(self.children_of(index));
        }
        match reached.iter().position(|reached| !reached).and_then(|i| self.nodes.get(i)) {
            None => Ok(()),
            Some(node) => {
                let from = reached.iter().position(|reached| !reached).unwrap_or_default();
                let message = format!("nodes must form trees, without cycles: {}", self.cycle(from));
                Err(node.fault_at("children", message))
            }
        }
    }

    /// The loop above the node `from`, to which no root leads: whoever goes up from there walks in circles.
    fn cycle(&self, from: usize) -> String {
        const MOST: usize = 8;
        let mut parents = vec![from; self.nodes.len()];
        for (index, children) in self.children.iter().enumerate() {
            for &child in children {
                if let Some(parent) = parents.get_mut(child) {
                    *parent = index;
                }
            }
        }
        let up = |index: &usize| parents.get(*index).copied();
        // After as many steps as there are nodes we are within the loop, wherever we began.
        let within = std::iter::successors(Some(from), up).nth(self.nodes.len()).unwrap_or(from);
        let upwards = std::iter::successors(up(&within), up).take_while(|&index| index != within);
        let mut all: Vec<usize> = upwards.collect();
        all.push(within);
        all.reverse();
        let shown: Vec<String> = all.iter().take(MOST).map(|index| format!("/nodes/{index}")).collect();
        let more = if all.len() > MOST { " -> ..." } else { "" };
        format!("{}{more} -> /nodes/{within}", shown.join(" -> "))
    }

    /// Which nodes are among `tops`, or below one of them.
    pub(super) fn below(&self, tops: impl Iterator<Item = usize>) -> Vec<bool> {
        let mut is_below = vec![false; self.nodes.len()];
        let mut stack: Vec<usize> = tops.collect();
        while let Some(index) = stack.pop() {
            if let Some(known @ false) = is_below.get_mut(index) {
                *known = true;
                stack.extend(self.children_of(index));
            }
        }
        is_below
    }

    /// The node that `reference` names by index.
    pub(super) fn index(&self, reference: &Element<'a>) -> Checked<usize> {
        let index = reference.index()?;
        let count = self.nodes.len();
        if index < count { Ok(index) } else { Err(no_such_node(reference, index, count)) }
    }
    /// A node, if there are as many.
    pub(super) fn node(&self, index: usize) -> Option<&Element<'a>> {
        self.nodes.get(index)
    }
    /// Indices of a node's children.
    pub(super) fn children_of(&self, index: usize) -> &[usize] {
        self.children.get(index).map_or(&[], Vec::as_slice)
    }
}

fn no_such_node(reference: &Element<'_>, index: usize, count: usize) -> super::element::Fault {
    reference.fault(format!("refers to /nodes/{index}, but {}", only(count, "nodes")))
}

/// The placement of a translation, a rotation (x, y, z, w) and a scale; `None` if the rotation is none.
pub(super) fn trs(translation: [f64; 3], rotation: [f64; 4], scale: [f64; 3]) -> Option<DAffine3> {
    let [x, y, z, w] = rotation;
    let length = (x * x + y * y + z * z + w * w).sqrt();
    let q = DQuat::from_xyzw(x / length, y / length, z / length, w / length);
    let made = DAffine3::from_scale_rotation_translation(DVec3::from(scale), q, DVec3::from(translation));
    (length > 0.0 && length.is_finite()).then_some(made)
}

/// The placement of a matrix in column order, less its last row.
pub(super) fn matrix(m: [f64; 16]) -> DAffine3 {
    let [a, b, c, _, d, e, f, _, g, h, i, _, x, y, z, _] = m;
    let matrix3 = DMat3::from_cols(DVec3::new(a, b, c), DVec3::new(d, e, f), DVec3::new(g, h, i));
    DAffine3 { matrix3, translation: DVec3::new(x, y, z) }
}

/// Whether the last row of a matrix in column order is 0 0 0 1.
pub(super) fn is_affine(m: &[f64; 16]) -> bool {
    [m[3], m[7], m[11], m[15]] == [0.0, 0.0, 0.0, 1.0]
}

/// A node's own transform.
fn local(document: &Document<'_>, node: &Element<'_>) -> Checked<Local> {
    if let Some(element) = node.get("matrix")? {
        let m: [f64; 16] = element.numbers()?;
        if !is_affine(&m) {
            document.warn(&element, "the last row of this matrix is not 0 0 0 1; it is ignored");
        }
        return Ok(Local::Matrix(matrix(m)));
    }
    Ok(Local::Parts {
        translation: node.numbers_or("translation", [0.0; 3])?,
        rotation: node.numbers_or("rotation", [0.0, 0.0, 0.0, 1.0])?,
        scale: node.numbers_or("scale", [1.0; 3])?,
    })
}
