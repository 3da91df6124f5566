//! Which transparent bodies a ray is in, and what that makes of the surfaces it meets.
//!
//! Every path ray carries a [`MediumStack`]: the bodies entered and not yet left. What fills the place is, of the bodies
//! with a priority, the one of the highest (Schmidt and Budge 2002); of equal ones that of larger index, so that the order
//! in which they were entered does not matter. A body without a priority is taken to lie within what the ray was in.
mod crossing;
mod imbalances;
mod start;

use durer_core::{Id, spectrum::Basis};
use durer_model::{Medium, material::Material};

pub(crate) use crossing::{Boundary, Crossing};
pub use imbalances::{ImbalanceTotals, Imbalances};
pub(crate) use start::{around, start};

/// The media of a scene: equal ones are one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Media {
    list: Vec<Medium>,
    of_material: Vec<Option<Id<Medium>>>,
}

/// What fills a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Present {
    /// The medium; `None` for the empty space around everything.
    pub(crate) medium: Option<Id<Medium>>,
    /// Absolute index of refraction.
    pub(crate) eta: f32,
}

impl Media {
    /// The media of these materials.
    pub(crate) fn new(materials: &[Box<dyn Material>]) -> Self {
        let mut list: Vec<Medium> = Vec::new();
        let mut number = |medium: Medium| {
            let known = list.iter().position(|m| *m == medium);
            Id::new(known.unwrap_or_else(|| {
                list.push(medium);
                list.len() - 1
            }) as u32)
        };
        let of_material = materials.iter().map(|m| m.medium().map(&mut number)).collect();
        Self { list, of_material }
    }
    /// True if nothing is transparent.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }
    /// The medium behind surfaces of a material.
    pub fn of_material(&self, material: u32) -> Option<Id<Medium>> {
        self.of_material.get(material as usize).copied().flatten()
    }
    /// A medium.
    pub fn get(&self, id: Id<Medium>) -> &Medium {
        &self.list[id.index()]
    }
}

/// Why a ray's account of the bodies it is in is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Imbalance {
    /// It left a body that it was not in.
    LeftUnentered,
    /// It is in more bodies than [`MediumStack::CAPACITY`].
    TooDeep,
}

/// The bodies that a ray is in, in the order in which it entered them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MediumStack {
    ids: [u32; Self::CAPACITY],
    len: u8,
}

impl MediumStack {
    /// Most bodies that a ray can be in at once.
    pub const CAPACITY: usize = 8;

    /// True in empty space.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }
    /// The bodies.
    pub fn iter(&self) -> impl DoubleEndedIterator<Item = Id<Medium>> {
        self.ids[..usize::from(self.len)].iter().map(|&id| Id::new(id))
    }
    pub(crate) fn enter(&mut self, id: Id<Medium>) -> Result<(), Imbalance> {
        let place = self.ids.get_mut(usize::from(self.len)).ok_or(Imbalance::TooDeep)?;
        *place = id.index() as u32;
        self.len += 1;
        Ok(())
    }
    /// Leaves the body of this medium that was entered last.
    pub(crate) fn leave(&mut self, id: Id<Medium>) -> Result<(), Imbalance> {
        let found = self.iter().rev().position(|entered| entered == id).ok_or(Imbalance::LeftUnentered)?;
        let len = usize::from(self.len);
        self.ids.copy_within(len - found..len, len - found - 1);
        // So that equal stacks have equal bits.
        self.ids[len - 1] = 0;
        self.len -= 1;
        Ok(())
    }
    /// What fills the place where the ray is.
    pub(crate) fn present(&self, media: &Media, basis: &Basis) -> Present {
        let mut present = Present { medium: None, eta: 1.0 };
        let mut winner: Option<&Medium> = None;
        for id in self.iter() {
            let medium = media.get(id);
            if medium.priority.is_none() {
                present = Present { medium: Some(id), eta: present.eta * medium.eta(basis) };
            } else if winner.is_none_or(|w| yields(w, medium)) {
                winner = Some(medium);
                present = Present { medium: Some(id), eta: medium.eta(basis) };
            }
        }
        present
    }
}

/// Whether `present` gives way to `other`, both with a priority: a total order of different media.
fn yields(present: &Medium, other: &Medium) -> bool {
    let key = |m: &Medium| (m.priority, m.eta_d.to_bits(), m.absorption.rgb.map(f32::to_bits));
    key(present) < key(other)
}
