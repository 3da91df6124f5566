//! What an integrator gets to know about lobes that it cannot evaluate for a light.
use durer_core::{math::Vector3, spectrum::Spectrum};

use super::Bsdf;

/// Kinds of scattering that rays are spawned for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BranchKind {
    /// Mirror reflection.
    Reflection,
    /// Refraction, or passing straight on.
    Transmission,
}

/// A direction of a perfectly sharp lobe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Branch {
    /// Which way.
    pub kind: BranchKind,
    /// Unit direction.
    pub wi: Vector3,
    /// What the radiance arriving from `wi` is multiplied with; never black.
    pub weight: Spectrum,
}

/// The sharp directions of a [`Bsdf`].
#[derive(Clone, Copy, Debug, Default)]
pub struct Branches {
    list: [Option<Branch>; Self::MOST],
    count: usize,
    /// Set if a lobe would have transmitted but reflects totally, with the weight that the transmitted ray would have
    /// had and that is lost: Whitted's constant coefficient. Black where Fresnel's equations hand all of it to the
    /// reflected ray.
    pub total_internal_reflection: Option<Spectrum>,
}

impl Branches {
    /// One per lobe, and a second one for the one lobe of a material that is an interface.
    const MOST: usize = Bsdf::MOST_LOBES + 1;

    /// The branches, reflections before transmissions of the same lobe.
    pub fn iter(&self) -> impl Iterator<Item = &Branch> {
        self.list[..self.count].iter().flatten()
    }
    /// Multiplies all weights; a branch that then carries nothing goes.
    pub(super) fn dim(&mut self, arriving: Spectrum) {
        if arriving == Spectrum::ONE {
            return;
        }
        let old = *self;
        self.count = 0;
        for branch in old.iter() {
            self.add(branch.kind, branch.wi, arriving * branch.weight);
        }
        self.total_internal_reflection = old.total_internal_reflection.map(|weight| arriving * weight);
    }
    /// Adds a branch unless it carries nothing.
    pub(super) fn add(&mut self, kind: BranchKind, wi: Vector3, weight: Spectrum) {
        if weight.is_black() {
            return;
        }
        debug_assert!(self.count < Self::MOST, "a material returns more than one interface");
        if let Some(place) = self.list.get_mut(self.count) {
            *place = Some(Branch { kind, wi, weight });
            self.count += 1;
        }
    }
}

/// A glossy lobe as seen by an integrator that does not sample it: its main direction and how much it reflects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GlossyView {
    /// Mirror direction.
    pub wi: Vector3,
    /// Directional albedo, less what a branch of the same lobe carries.
    pub weight: Spectrum,
    /// GGX roughness.
    pub alpha: f32,
}
