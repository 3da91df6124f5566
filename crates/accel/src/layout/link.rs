//! Names of what a node's lane holds.

/// A node, or a leaf: 3 bits of kind, 28 bits of number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub(crate) struct Link(pub(crate) u32);

/// What a link names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Target {
    /// The row of a node.
    Node(u32),
    /// The row of a packet of triangles.
    Packet(u32),
    /// A shape that is not a triangle, by its number in the tree.
    Item(u32),
    /// An instance.
    Instance(u32),
}

const LEAF: u32 = 1 << 31;
const KIND_SHIFT: u32 = 28;

impl Link {
    /// Numbers and rows end here.
    pub(crate) const LIMIT: u32 = 1 << KIND_SHIFT;

    pub(crate) const fn new(target: Target) -> Self {
        match target {
            Target::Node(row) => Self(row),
            Target::Packet(row) => Self(LEAF | row),
            Target::Item(item) => Self(LEAF | 1 << KIND_SHIFT | item),
            Target::Instance(instance) => Self(LEAF | 2 << KIND_SHIFT | instance),
        }
    }

    #[inline(always)]
    pub(crate) fn is_leaf(self) -> bool {
        self.0 & LEAF != 0
    }

    /// The row of a packet of triangles, if it names one. PERF: one comparison for what most leaves are (bench kernel).
    #[inline(always)]
    pub(crate) fn packet(self) -> Option<u32> {
        let row = self.0 ^ LEAF;
        (row < Self::LIMIT).then_some(row)
    }

    #[inline(always)]
    pub(crate) fn target(self) -> Target {
        let number = self.0 & (Self::LIMIT - 1);
        match (self.is_leaf(), self.0 >> KIND_SHIFT & 7) {
            (false, _) => Target::Node(self.0),
            (true, 0) => Target::Packet(number),
            (true, 1) => Target::Item(number),
            (true, _) => Target::Instance(number),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_name_what_they_were_made_of() {
        for number in [0, 1, 77, Link::LIMIT - 1] {
            let all = [
                Target::Node(number),
                Target::Packet(number),
                Target::Item(number),
                Target::Instance(number),
            ];
            for target in all {
                assert_eq!(Link::new(target).target(), target);
                assert_eq!(Link::new(target).is_leaf(), !matches!(target, Target::Node(_)));
                let packet = if let Target::Packet(row) = target { Some(row) } else { None };
                assert_eq!(Link::new(target).packet(), packet);
            }
        }
    }
}
