//! What a query asks for beside the ray: masks, backs, holes.
use durer_accel::{Accel, Hit, PrimitiveHit, UserGeometry};
use durer_core::math::Ray;

use crate::corpus::{Random, Shapes};

/// Hits that do not count.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Holes {
    None,
    /// Some primitives.
    Primitives,
    /// A pattern on every surface.
    Pattern,
}

/// What is asked.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Asked {
    pub(crate) mask: u32,
    pub(crate) culls: bool,
    pub(crate) holes: Holes,
}

impl Asked {
    pub(crate) fn random(random: &mut Random) -> Self {
        let mask = [u32::MAX, u32::MAX, 1, 2, 6, 0][random.below(6)];
        let holes = [Holes::None, Holes::None, Holes::Primitives, Holes::Pattern][random.below(4)];
        Self { mask, culls: random.below(3) == 0, holes }
    }

    /// Whether hits on a primitive count; a pattern may let through any.
    pub(crate) fn lets_through(&self, instance: u32, prim: u32) -> bool {
        self.holes != Holes::Primitives || !(instance.wrapping_mul(7) ^ prim).is_multiple_of(3)
    }

    fn accepts(&self, hit: &Hit) -> bool {
        match self.holes {
            Holes::Pattern => ((hit.u * 8.0) as i32 + (hit.v * 8.0) as i32) % 2 == 0,
            _ => self.lets_through(hit.instance, hit.prim),
        }
    }

    /// Both answers of an `Accel`.
    pub(crate) fn put(&self, accel: &Accel, shapes: &Shapes, ray: &Ray) -> (Option<Hit>, bool) {
        let query = || accel.query(ray).mask(self.mask).cull_backs(self.culls);
        match self.holes {
            Holes::None => (query().user(shapes).closest(), query().user(shapes).any()),
            _ => {
                let sieve = Sieve(shapes, self);
                (query().user(&sieve).closest(), query().user(&sieve).any())
            }
        }
    }
}

/// Shapes with holes.
struct Sieve<'a>(&'a Shapes, &'a Asked);

impl UserGeometry for Sieve<'_> {
    const FILTERS: bool = true;

    fn intersect(&self, instance: u32, prim: u32, ray: &Ray, t_max: f32) -> Option<PrimitiveHit> {
        self.0.intersect(instance, prim, ray, t_max)
    }
    fn accepts(&self, hit: &Hit) -> bool {
        self.1.accepts(hit)
    }
}
