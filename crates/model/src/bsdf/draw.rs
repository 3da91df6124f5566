//! Directions drawn from lobes that spread: what a distributed ray follows instead of one sharp direction.
use durer_core::spectrum::Spectrum;

use super::{Branch, Bsdf};

/// A direction drawn from a lobe. `branch.weight` is `f cos / density`: averaged over many draws the branches give what
/// the lobe reflects or transmits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drawn {
    /// Which way, and what the radiance arriving from there is multiplied with.
    pub branch: Branch,
    /// Density with which draws of this lobe meet `branch.wi`, 1/sr.
    pub pdf: f32,
}

/// One draw from every lobe that spreads.
#[derive(Clone, Copy, Debug, Default)]
pub struct Draws {
    list: [Option<Drawn>; Self::MOST],
    count: usize,
}

impl Draws {
    /// One per lobe, and a second one for the one lobe of a material that is an interface.
    const MOST: usize = Bsdf::MOST_LOBES + 1;

    /// The draws, in the order of their lobes.
    pub fn iter(&self) -> impl Iterator<Item = &Drawn> {
        self.list[..self.count].iter().flatten()
    }
    /// Multiplies all weights.
    pub(super) fn dim(&mut self, arriving: Spectrum) {
        for drawn in self.list.iter_mut().flatten() {
            drawn.branch.weight *= arriving;
        }
    }
    /// Adds a draw.
    pub(super) fn add(&mut self, drawn: Drawn) {
        debug_assert!(self.count < Self::MOST, "a material returns more than one interface");
        if let Some(place) = self.list.get_mut(self.count) {
            *place = Some(drawn);
            self.count += 1;
        }
    }
}
