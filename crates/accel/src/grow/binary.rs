//! Boxes with two words: references to primitives, and nodes of the binary tree.
use wide::f32x4;

use super::hull::{AreaUnit, Hull};

/// Words are kept in lanes of floating point vectors, in the form of numbers that are not subnormal (which are slow) if
/// the word is below 2^30.
const LANE: u32 = 0x4000_0000;
/// Second words from here on say how many entries a leaf has. No node has such a number.
const LEAF: u32 = u32::MAX - 255;

/// A box and two words in 32 bytes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Item(pub(super) Hull);

/// What a node of the binary tree is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Node {
    /// Two nodes below.
    Inner([u32; 2]),
    /// A range of `Binary::order`.
    Leaf { first: u32, count: u32 },
}

impl Item {
    pub(super) const ZERO: Self = Self(Hull { lo: f32x4::ZERO, hi: f32x4::ZERO });

    #[inline(always)]
    fn new(hull: &Hull, a: u32, b: u32) -> Self {
        let with = |v: f32x4, word: u32| {
            let [x, y, z, _] = v.to_array();
            f32x4::new([x, y, z, f32::from_bits(word ^ LANE)])
        };
        Self(Hull { lo: with(hull.lo, a), hi: with(hull.hi, b) })
    }
    #[inline(always)]
    pub(super) fn reference(hull: &Hull, prim: u32) -> Self {
        Self::new(hull, prim, 0)
    }
    #[inline(always)]
    pub(super) fn inner(hull: &Hull, children: [u32; 2]) -> Self {
        Self::new(hull, children[0], children[1])
    }
    #[inline(always)]
    pub(super) fn leaf(hull: &Hull, first: u32, count: usize) -> Self {
        Self::new(hull, first, LEAF + count as u32)
    }

    /// The primitive of a reference.
    #[inline(always)]
    pub(super) fn prim(&self) -> u32 {
        self.0.lo.to_array()[3].to_bits() ^ LANE
    }
    /// What a node has below it.
    #[inline(always)]
    pub(super) fn node(&self) -> Node {
        let second = self.0.hi.to_array()[3].to_bits() ^ LANE;
        if second >= LEAF {
            Node::Leaf { first: self.prim(), count: second - LEAF }
        } else {
            Node::Inner([self.prim(), second])
        }
    }
    /// Twice the midpoint; infinite for boxes beyond half of what f32 can hold.
    #[inline(always)]
    pub(super) fn center(&self) -> f32x4 {
        self.0.lo + self.0.hi
    }
    /// The same on one axis.
    #[inline(always)]
    pub(super) fn center_on(&self, axis: usize) -> f32 {
        self.0.lo.as_array()[axis] + self.0.hi.as_array()[axis]
    }
}

/// A binary tree whose node 0 is the root.
pub(super) struct Binary {
    pub(super) nodes: Vec<Item>,
    /// Primitives, leaf by leaf.
    pub(super) order: Vec<u32>,
    pub(super) unit: AreaUnit,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_survive_in_lanes() {
        for word in [0, 1, 0x7f80_0001, 0x7fff_ffff, 0x8000_0000, LEAF - 1] {
            let inner = Item::inner(&Hull::EMPTY, [word, LEAF - 1]);
            assert_eq!(inner.node(), Node::Inner([word, LEAF - 1]));
            assert_eq!(Item::leaf(&Hull::EMPTY, word, 8).node(), Node::Leaf { first: word, count: 8 });
            assert_eq!(Item::reference(&Hull::EMPTY, word).prim(), word);
        }
    }
}
