//! Vertices that agree in all of their attributes become one, in linear time.
//!
//! Most positions go with one pair of other attributes only: that pair is kept in a table by position. The rest goes
//! to a hash table with random keys, which no file can make slow.
use std::collections::HashMap;

/// The first pair seen with a position, in the group `stamp`.
#[derive(Clone, Copy, Default)]
struct Slot {
    stamp: u32,
    pair: [u32; 2],
    id: u32,
}

/// Numbers triples (position, two others) within groups.
pub(crate) struct Unifier {
    stamp: u32,
    slots: Vec<Slot>,
    others: HashMap<[u32; 4], u32>,
    /// Look-ups that needed the hash table.
    #[cfg(test)]
    pub(crate) hashed: usize,
}

impl Unifier {
    /// For positions below `positions`.
    pub(crate) fn new(positions: usize) -> Self {
        Self {
            stamp: 1,
            slots: vec![Slot::default(); positions],
            others: HashMap::new(),
            #[cfg(test)]
            hashed: 0,
        }
    }
    /// Begins a group: what was seen before counts no more.
    pub(crate) fn next_group(&mut self) {
        self.stamp += 1;
    }
    /// The number of a triple in this group: `fresh` if it is new.
    pub(crate) fn id(&mut self, position: u32, pair: [u32; 2], fresh: u32) -> u32 {
        let stamp = self.stamp;
        let Some(slot) = self.slots.get_mut(position as usize) else {
            return fresh;
        };
        if slot.stamp != stamp {
            *slot = Slot { stamp, pair, id: fresh };
        } else if slot.pair != pair {
            #[cfg(test)]
            {
                self.hashed += 1;
            }
            let [a, b] = pair;
            return *self.others.entry([stamp, position, a, b]).or_insert(fresh);
        }
        slot.id
    }
}

#[cfg(test)]
mod tests {
    use super::Unifier;

    #[test]
    fn equal_triples_share_a_number_within_a_group() {
        let mut unifier = Unifier::new(3);
        let mut id = |position, pair, fresh| unifier.id(position, pair, fresh);
        assert_eq!(id(0, [1, 1], 0), 0);
        assert_eq!(id(1, [1, 1], 1), 1);
        assert_eq!(id(0, [1, 2], 2), 2);
        assert_eq!(id(0, [1, 1], 3), 0);
        assert_eq!(id(0, [1, 2], 3), 2);
        assert_eq!(id(0, [2, 1], 3), 3);
        unifier.next_group();
        assert_eq!(unifier.id(0, [1, 2], 0), 0);
        assert_eq!(unifier.id(0, [1, 1], 1), 1);
    }

    #[test]
    fn each_corner_costs_one_look_up_however_many_share_a_position() {
        for corners in [1000, 2000] {
            let mut unifier = Unifier::new(1);
            for i in 0..corners {
                assert_eq!(unifier.id(0, [i, 0], i), i);
            }
            assert_eq!(unifier.hashed, corners as usize - 1);
        }
    }
}
