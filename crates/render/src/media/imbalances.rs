//! Counts of rays whose account of the bodies they are in is wrong: per sample, and of a whole picture.
use std::collections::BTreeMap;

use durer_core::Id;

use crate::Object;

/// How often rays of a sample left bodies that they were not in: the surface is inside out or open, or the camera is in a
/// body without anybody knowing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Imbalances {
    /// Number and count, used ones first.
    objects: [(u32, u32); Self::OBJECTS],
    /// At further objects.
    pub elsewhere: u32,
    /// Bodies entered while a ray was in [`CAPACITY`](super::MediumStack::CAPACITY) others.
    pub too_deep: u32,
}

impl Imbalances {
    /// Objects told apart in a sample.
    pub const OBJECTS: usize = 4;

    /// True if there were none.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
    /// Counts one at an object.
    pub fn add(&mut self, object: Id<Object>) {
        let number = object.index() as u32;
        let place = self.objects.iter_mut().find(|(o, count)| *count == 0 || *o == number);
        match place {
            Some((o, count)) => (*o, *count) = (number, *count + 1),
            None => self.elsewhere += 1,
        }
    }
    /// The objects and how often it was theirs.
    pub fn iter(&self) -> impl Iterator<Item = (Id<Object>, u32)> {
        self.objects.into_iter().filter(|(_, count)| *count > 0).map(|(o, count)| (Id::new(o), count))
    }
}

/// The same of all samples of a picture. Sums, so that the order of the samples does not matter.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ImbalanceTotals {
    /// Per object, by its number.
    pub objects: BTreeMap<u32, u64>,
    /// At objects that a sample met after [`Imbalances::OBJECTS`] others.
    pub elsewhere: u64,
    /// Bodies entered while a ray was in as many as it can be.
    pub too_deep: u64,
}

impl ImbalanceTotals {
    /// True if there were none.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
    /// Adds those of a sample.
    pub fn add(&mut self, sample: &Imbalances) {
        if sample.is_empty() {
            return;
        }
        for (object, count) in sample.iter() {
            *self.objects.entry(object.index() as u32).or_default() += u64::from(count);
        }
        self.elsewhere += u64::from(sample.elsewhere);
        self.too_deep += u64::from(sample.too_deep);
    }
    /// Adds those of another part of the picture.
    pub fn merge(&mut self, other: &Self) {
        for (object, count) in &other.objects {
            *self.objects.entry(*object).or_default() += count;
        }
        self.elsewhere += other.elsewhere;
        self.too_deep += other.too_deep;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_lost_of_many_objects() {
        let mut sample = Imbalances::default();
        for object in [7, 3, 7, 0, 9, 11, 12, 7] {
            sample.add(Id::new(object));
        }
        let mut totals = ImbalanceTotals::default();
        assert!(totals.is_empty());
        totals.add(&sample);
        let mut twice = totals.clone();
        twice.merge(&totals);
        assert_eq!(twice.objects.into_iter().collect::<Vec<_>>(), [(0, 2), (3, 2), (7, 6), (9, 2)]);
        assert_eq!(twice.elsewhere, 4);
    }
}
