//! Which transparent bodies a ray is in, and what that makes of the surfaces it meets.
//!
//! Every path ray carries a [`MediumStack`]: the bodies entered and not yet left. What fills the place is, of the bodies
//! with a priority, the one of the highest (Schmidt and Budge 2002); of equal ones that of larger index, so that the order
//! in which they were entered does not matter. A body without a priority is taken to lie within what the ray was in.
//!
//! What floats there is what the present body says, else the one around it, else what floats around everything. Files may
//! say what is on both sides of a surface, as pbrt's do: behind it that is there, whatever the account says.
mod crossing;
mod imbalances;
mod start;

use std::{collections::HashMap, hash::Hash};

use durer_core::{Id, spectrum::Basis};
use durer_model::{Fill, Hull, Medium};

use crate::Object;
pub(crate) use crossing::{Boundary, Crossing};
pub use imbalances::{ImbalanceTotals, Imbalances};
pub(crate) use start::{around, at, start};

/// The media of a scene: equal ones are one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Media {
    list: Vec<Medium>,
    /// PERF: of priorities and hulls only this is asked for, often (bench render).
    ranks: Vec<Rank>,
    of_object: Vec<Option<Id<Medium>>>,
    /// One of them is the inside of a body.
    bodies: bool,
    /// Light walks in one of them.
    walked: bool,
}

/// What a medium is to others in the same place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Rank {
    /// No body: what floats in it is within the body around it.
    Within,
    /// A body that lies within what is around it.
    Nested,
    /// The place of its priority among all.
    Prior(u32),
}

impl Media {
    /// Those that objects have behind their surfaces. Objects of the same `key` have the same.
    pub(crate) fn new<K: Eq + Hash>(objects: impl Iterator<Item = (K, Option<Medium>)>) -> Self {
        let mut list: Vec<Medium> = Vec::new();
        let mut number = |medium: Medium| {
            let known = list.iter().position(|m| *m == medium);
            Id::new(known.unwrap_or_else(|| {
                list.push(medium);
                list.len() - 1
            }) as u32)
        };
        let mut known: HashMap<K, Option<Id<Medium>>> = HashMap::new();
        let of_object =
            objects.map(|(key, medium)| *known.entry(key).or_insert_with(|| medium.map(&mut number)));
        let of_object = of_object.collect();
        Self {
            of_object,
            bodies: list.iter().any(|m| m.hull == Hull::Body),
            walked: list.iter().any(|m| matches!(m.inside, Some(Fill::Below(_)))),
            ranks: ranks(&list),
            list,
        }
    }
    /// True if nothing is transparent.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }
    /// True if there are transparent bodies.
    pub(crate) fn has_bodies(&self) -> bool {
        self.bodies
    }
    /// True if light walks below some surface.
    pub(crate) fn are_walked(&self) -> bool {
        self.walked
    }
    /// The medium behind surfaces of an object.
    pub fn of_object(&self, object: Id<Object>) -> Option<Id<Medium>> {
        self.of_object.get(object.index()).copied().flatten()
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
    /// What floats around all of them: one more than the number of the volume, or 0.
    around: u16,
    len: u8,
}

impl MediumStack {
    /// Most bodies that a ray can be in at once.
    pub const CAPACITY: usize = 8;
    /// Most volumes of a scene.
    pub(crate) const MOST_VOLUMES: usize = u16::MAX as usize;

    /// No bodies, and what floats where there are none.
    pub(crate) fn within(around: Fill) -> Self {
        let mut stack = Self::default();
        stack.surround(around);
        stack
    }
    fn surround(&mut self, around: Fill) {
        self.around = match around {
            // Below surfaces nobody can say to be at the start.
            Fill::Nothing | Fill::Below(_) => 0,
            Fill::Volume(number) => number as u16 + 1,
        };
    }

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
    /// Those that have a say in what fills the place where the ray is, each what was there before it.
    fn counting(&self, media: &Media) -> impl Iterator<Item = (Id<Medium>, Rank)> {
        let mut highest = Rank::Within;
        self.iter().map(|id| (id, media.ranks[id.index()])).filter(move |&(_, rank)| match rank {
            Rank::Within | Rank::Nested => true,
            Rank::Prior(_) => {
                let counts = rank > highest;
                highest = highest.max(rank);
                counts
            }
        })
    }
    /// The body that fills the place where the ray is; `None` in the empty space around everything.
    pub(crate) fn body(&self, media: &Media) -> Option<Id<Medium>> {
        let bodies = self.counting(media).filter(|(_, rank)| *rank > Rank::Within);
        bodies.fold(None, |_, (id, _)| Some(id))
    }
    /// What floats there.
    pub(crate) fn fill(&self, media: &Media) -> Fill {
        let around = match self.around {
            0 => Fill::Nothing,
            number => Fill::Volume(u32::from(number) - 1),
        };
        self.counting(media).fold(around, |around, (id, rank)| {
            let around = if rank > Rank::Nested { Fill::default() } else { around };
            media.get(id).inside.unwrap_or(around)
        })
    }
    /// The absolute index of refraction there.
    pub(crate) fn eta(&self, media: &Media, basis: &Basis) -> f32 {
        self.counting(media).fold(1.0, |eta, (id, rank)| match rank {
            Rank::Within => eta,
            Rank::Nested => eta * media.get(id).eta(basis),
            Rank::Prior(_) => media.get(id).eta(basis),
        })
    }
    /// Makes the account agree with a surface behind which, as it says, `fill` floats. Where a body of a priority is present
    /// it has its own.
    fn agree(&mut self, fill: Fill, media: &Media) {
        let has_priority = |id: &Id<Medium>| media.get(*id).priority.is_some();
        if self.iter().any(|id| has_priority(&id)) || self.fill(media) == fill {
            return;
        }
        let silent = self.iter().filter(|id| media.get(*id).inside.is_none());
        let mut agreed = Self::within(fill);
        for id in silent {
            // No more than before.
            let _ = agreed.enter(id);
        }
        *self = agreed;
    }
}

/// Those with a priority are in a total order of different media.
fn ranks(list: &[Medium]) -> Vec<Rank> {
    let key = |m: &Medium| {
        (m.priority, m.eta_d.to_bits(), m.absorption.rgb.map(f32::to_bits), (m.inside, m.outside, m.hull))
    };
    let mut keys: Vec<_> = list.iter().filter(|m| m.priority.is_some()).map(key).collect();
    keys.sort_unstable();
    keys.dedup();
    let rank = |m: &Medium| match (keys.binary_search(&key(m)), m.hull) {
        (Ok(place), _) => Rank::Prior(place as u32),
        (Err(_), Hull::Body) => Rank::Nested,
        (Err(_), Hull::Sheet | Hull::Open) => Rank::Within,
    };
    list.iter().map(rank).collect()
}
