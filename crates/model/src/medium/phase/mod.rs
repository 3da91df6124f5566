//! Directions after a particle: phase functions.
//!
//! A direction is drawn from one density for all wavelengths. Where drops of water send each wavelength elsewhere, light
//! counts by what its own phase function is by that density.
mod blend;
mod drops;
mod henyey_greenstein;
mod rayleigh;
mod read;
mod sggx;
mod table;
#[cfg(test)]
mod tests;
mod turn;

use std::sync::Arc;

use durer_core::{
    math::{
        Frame, Normal3, Point2, Point3, Transform, Vector3,
        float::{cos, sin, sqr},
    },
    spectrum::{Basis, Spectrum},
};

use self::{blend::Blend, drops::Drops, sggx::Flakes, table::Table};
pub use self::{henyey_greenstein::HenyeyGreenstein, turn::Turn};

/// How particles of a volume scatter. Densities are by solid angle, 1/sr.
#[derive(Clone, Debug, PartialEq)]
pub enum Phase {
    /// By the mean cosine alone.
    HenyeyGreenstein(HenyeyGreenstein),
    /// As drops of water do: with rainbows.
    Drops(Arc<Drops>),
    /// As molecules of air do: as much back as on, half as much to the sides.
    Rayleigh,
    /// As a table of cosines says.
    Table(Arc<Table>),
    /// As flakes that lie mostly one way, which mirror.
    Flakes(Arc<Flakes>),
    /// As several of these side by side.
    Blend(Arc<Blend>),
}

impl Phase {
    /// What documents call it.
    pub fn name(&self) -> &'static str {
        match self {
            Self::HenyeyGreenstein(_) => "henyey-greenstein",
            Self::Drops(_) => "waterdrops",
            Self::Rayleigh => "rayleigh",
            Self::Table(_) => "table",
            Self::Flakes(_) => "sggx",
            Self::Blend(_) => "blend",
        }
    }
    /// The mean cosine of the deflection, over all wavelengths, and over all directions and places if it is not the same for
    /// them.
    pub fn g(&self) -> f32 {
        match self {
            Self::HenyeyGreenstein(phase) => phase.g(),
            Self::Drops(drops) => drops.mean_cos(),
            Self::Rayleigh => 0.0,
            Self::Table(table) => table.mean_cos(),
            Self::Flakes(flakes) => flakes.mean_cos(),
            Self::Blend(blend) => blend.mean_cos(),
        }
    }
    /// Density of this turn, 1/sr: of going on along `to` after `from`.
    pub fn density(&self, turn: &Turn) -> f32 {
        match self {
            Self::HenyeyGreenstein(phase) => phase.density(turn.cos()),
            Self::Drops(drops) => drops.density(turn.cos()),
            Self::Rayleigh => rayleigh::density(turn.cos()),
            Self::Table(table) => table.density(turn.cos()),
            Self::Flakes(flakes) => flakes.density(turn),
            Self::Blend(blend) => blend.density(turn),
        }
    }
    /// The share of light that goes there by that density: ones where all wavelengths scatter alike.
    pub fn tint(&self, basis: &Basis, turn: &Turn) -> Spectrum {
        match self {
            Self::HenyeyGreenstein(_) | Self::Rayleigh | Self::Table(_) | Self::Flakes(_) => Spectrum::ONE,
            Self::Drops(drops) => drops.tint(basis, turn.cos()),
            Self::Blend(blend) => blend.tint(basis, turn),
        }
    }
    /// A unit direction after unit direction `from` at a point of render space, at a point of the unit square.
    pub fn deflected(&self, (p, from): (Point3, Vector3), u: Point2) -> Vector3 {
        match self {
            Self::HenyeyGreenstein(phase) => phase.deflected(from, u),
            Self::Drops(drops) => turned(from, drops.cos(u.x), u.y),
            Self::Rayleigh => turned(from, rayleigh::cos(u.x), u.y),
            Self::Table(table) => turned(from, table.cos(u.x), u.y),
            Self::Flakes(flakes) => flakes.deflected((p, from), u),
            Self::Blend(blend) => blend.deflected((p, from), u),
        }
    }
    /// What light of a turn that was drawn on a walk from a lamp counts: radiance goes the other way, for which the density may
    /// be another one. On walks from the eye it is 1.
    pub fn skew(&self, turn: &Turn) -> f32 {
        if self.is_symmetric() { 1.0 } else { self.density(&turn.back()) / self.density(turn) }
    }
    /// Whether turns are as dense there as back.
    fn is_symmetric(&self) -> bool {
        match self {
            Self::HenyeyGreenstein(_) | Self::Drops(_) | Self::Rayleigh | Self::Table(_) => true,
            Self::Flakes(_) => false,
            Self::Blend(blend) => blend.is_symmetric(),
        }
    }
    /// Whether it is the same everywhere.
    pub(super) fn is_even(&self) -> bool {
        match self {
            Self::HenyeyGreenstein(_) | Self::Drops(_) | Self::Rayleigh | Self::Table(_) => true,
            Self::Flakes(flakes) => flakes.is_even(),
            Self::Blend(blend) => blend.is_even(),
        }
    }
    /// Moves what changes from place to place into render space.
    pub(super) fn place(&mut self, cube_from_render: &Transform) {
        match self {
            Self::HenyeyGreenstein(_) | Self::Drops(_) | Self::Rayleigh | Self::Table(_) => {}
            Self::Flakes(flakes) => Arc::make_mut(flakes).place(cube_from_render),
            Self::Blend(blend) => Arc::make_mut(blend).place(cube_from_render),
        }
    }
}

/// A unit direction of this cosine to unit direction `w`, turned around it by `u` of a full turn.
fn turned(w: Vector3, cosine: f32, u: f32) -> Vector3 {
    let sine = (1.0 - sqr(cosine)).max(0.0).sqrt();
    let azimuth = std::f32::consts::TAU * u;
    let local = Vector3::new(sine * cos(azimuth), sine * sin(azimuth), cosine);
    Frame::from_z(Normal3::from(w)).to_world(local).normalize()
}
