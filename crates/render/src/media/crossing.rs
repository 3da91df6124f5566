//! What a ray does to its [`MediumStack`] where it meets a surface.
//!
//! Surfaces that touch are one boundary: a ray that meets one of them starts anew behind all of them, so all are found and
//! counted at once. What counts as touching is what lies between the origins of the rays that leave to the two sides:
//! [`TOUCHING`] rounding errors on each, as both surfaces may be off by one. Only bodies with priorities touch; the
//! surfaces of others relate to what lies around them as pbrt has it.
//!
//! The account is known to be right on the ray only. Where two surfaces cross, the origin on its side, straight above the
//! place of the hit, may lie on the other side of one of them: what lies between the ray and that origin counts too.
use std::cell::RefCell;

use durer_accel::{Hit, PrimitiveHit, UserGeometry};
use durer_core::{
    Id,
    math::{Point3, Ray, Vector3},
    spectrum::Basis,
};
use durer_model::{Hull, Medium, Surface, bsdf::BranchKind};

use super::{Imbalance, MediumStack};
use crate::{Object, Scene};

/// Rounding errors of a point, on each side of a surface, within which others touch it.
const TOUCHING: f32 = 4.0;

/// What a surface is to a ray, given the bodies that the ray is in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Boundary {
    /// That of a body without priority, or of none: as its material says.
    Own,
    /// Between two media: index of refraction on the far side divided by that on the near side.
    Between(f32),
    /// Nothing: both sides are filled by the same, or media meet without a surface.
    Passed,
}

/// Where rays that leave a surface are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Crossing {
    /// What the surface was.
    pub(crate) boundary: Boundary,
    /// The bodies that a ray is in which stays on this side.
    front: MediumStack,
    /// Those that a ray is in which went through.
    pub(crate) behind: MediumStack,
    /// The index changes with wavelength: what goes on is of the leading one only.
    pub(crate) disperses: bool,
}

impl Crossing {
    /// The surface of no body.
    pub(crate) fn nothing(before: &MediumStack) -> Self {
        Self { boundary: Boundary::Own, front: *before, behind: *before, disperses: false }
    }

    /// The bodies that a ray is in which stays on this side of the surface, or goes through it.
    pub(crate) fn media(&self, branch: BranchKind) -> MediumStack {
        match branch {
            BranchKind::Reflection => self.front,
            BranchKind::Transmission => self.behind,
        }
    }
}

/// A surface of a body at the place of a hit.
#[derive(Clone, Copy)]
struct Skin {
    object: Id<Object>,
    medium: Id<Medium>,
    is_entered: bool,
}

impl Skin {
    fn cross(&self, stack: &mut MediumStack) -> Result<(), Imbalance> {
        if self.is_entered { stack.enter(self.medium) } else { stack.leave(self.medium) }
    }
}

impl Scene {
    /// Crosses the surface of `object` at `surface`, seen from `wo` by a ray that met nothing for `t` metres, with all that
    /// touch it. Says what is wrong with the account. Where surfaces can touch, `surface` grows an error bound that reaches
    /// beyond them.
    pub(crate) fn cross(
        &self,
        basis: &Basis,
        (object, surface): (Id<Object>, &mut Surface),
        (wo, time, t): (Vector3, f32, f32),
        before: &MediumStack,
        mut complain: impl FnMut(Id<Object>, Imbalance),
    ) -> Crossing {
        let mut crossing = Crossing::nothing(before);
        let Some(medium) = self.medium_of(object) else { return crossing };
        crossing.disperses = *basis != Basis::Rgb && self.media.get(medium).dispersion.is_some();
        let skin = Skin { object, medium, is_entered: surface.is_outside(wo) };
        let known = self.media.get(medium);
        if known.priority.is_none() {
            if let Err(imbalance) = skin.cross(&mut crossing.behind) {
                complain(object, imbalance);
            }
            if let Some(fill) = if skin.is_entered { known.inside } else { known.outside } {
                crossing.behind.agree(fill, &self.media);
            }
            if known.hull == Hull::Open {
                crossing.boundary = Boundary::Passed;
            }
            return crossing;
        }
        surface.p_error = surface.p_error * TOUCHING;
        let n = surface.n_g;
        let back = n.abs().dot(surface.p_error) / n.dot(wo).abs();
        let on_ray = surface.p + wo * back.min(t);
        let [front, behind] = [wo, -wo].map(|d| surface.spawn(d, time).o);
        let mut skins = self.skins_between((on_ray, front), time, object);
        for skin in &skins {
            // What is wrong with the account here is so behind the surface too, and complained about there.
            let _ = skin.cross(&mut crossing.front);
        }
        skins.append(&mut self.skins_between((front, behind), time, object));
        skins.push(skin);
        let mut near = *before;
        // In an order that does not depend on the hierarchy. Who enters first: a shared wall is then no imbalance.
        skins.sort_by_key(|s| (!s.is_entered, s.object.index()));
        for skin in &skins {
            if let Err(imbalance) = skin.cross(&mut crossing.behind) {
                complain(skin.object, imbalance);
                if imbalance == Imbalance::LeftUnentered {
                    // It must have been in there, whatever it knew. A full stack was complained about.
                    let _ = near.enter(skin.medium);
                }
            }
        }
        let (media, far) = (&self.media, &crossing.behind);
        let filling = [&near, far].map(|stack| stack.body(media));
        crossing.boundary = match filling[0] == filling[1] {
            true => Boundary::Passed,
            false => Boundary::Between(far.eta(media, basis) / near.eta(media, basis)),
        };
        let disperses = |id: &Id<Medium>| media.get(*id).dispersion.is_some();
        crossing.disperses = *basis != Basis::Rgb && filling.iter().flatten().any(disperses);
        crossing
    }

    /// The surfaces of bodies with priorities between two places, but for those of this object.
    fn skins_between(&self, (from, to): (Point3, Point3), time: f32, object: Id<Object>) -> Vec<Skin> {
        let length = (to - from).length();
        if length == 0.0 {
            return Vec::new();
        }
        let ray = Ray { t_max: length, time, ..Ray::new(from, (to - from) / length) };
        let found = Touching { scene: self, ray: &ray, object, skins: RefCell::default() };
        self.accel.query(&ray).user(&found).closest();
        found.skins.into_inner()
    }

    /// The medium behind surfaces of an object.
    pub(crate) fn medium_of(&self, object: Id<Object>) -> Option<Id<Medium>> {
        self.media.of_object(object)
    }
}

/// Collects what a short ray meets, instead of ending there.
struct Touching<'a> {
    scene: &'a Scene,
    ray: &'a Ray,
    object: Id<Object>,
    skins: RefCell<Vec<Skin>>,
}

impl UserGeometry for Touching<'_> {
    const FILTERS: bool = true;

    fn intersect(&self, instance: u32, prim: u32, ray: &Ray, t_max: f32) -> Option<PrimitiveHit> {
        self.scene.intersect_shape(instance, prim, ray, t_max)
    }

    /// Never: all are to be found. Instances with priorities are always asked for.
    fn accepts(&self, hit: &Hit) -> bool {
        let Self { scene, ray, object, skins } = self;
        let other = scene.resolve(hit).0;
        let medium = scene.medium_of(other).filter(|&m| scene.media.get(m).priority.is_some());
        // Where triangles meet, both may be hit: a surface is there once.
        let is_new = other != *object && skins.borrow().iter().all(|s| s.object != other);
        if let (Some(medium), true) = (medium, is_new) {
            let is_entered = scene.surface(ray, hit).1.is_outside(-ray.d);
            skins.borrow_mut().push(Skin { object: other, medium, is_entered });
        }
        false
    }
}
