//! Light that leaves its source: how particles begin.
use std::f32::consts::PI;

use durer_core::{
    math::{Frame, Normal3, Point2, Point3, Vector3, float::sqr},
    sampling::concentric_disk,
    spectrum::Spectrum,
};

use super::LightHit;

/// A ball around all surfaces that light from far away can meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// Its middle.
    pub center: Point3,
    /// Its radius, in metres.
    pub radius: f32,
}

/// From what a particle starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Source {
    /// A point without extent.
    Point,
    /// A surface that shines.
    Surface(LightHit),
    /// A single direction, from infinitely far away.
    Parallel,
    /// Directions from infinitely far away, which rays that leave the scene meet.
    Far,
    /// A medium that glows, where rays along which it is looked for draw places with this density, 1/m.
    Glow(f32),
}

/// A particle that leaves a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Emitted {
    /// Where it starts; of light from far away a point before everything else.
    pub p: Point3,
    /// Unit direction in which it travels.
    pub d: Vector3,
    /// From what.
    pub source: Source,
    /// Radiance; of points intensity, of parallel light irradiance, of media what a metre adds.
    pub light: Spectrum,
    /// Density of the place, 1/m²: over the surface, of media 1/m³ by volume, or over the disk through the middle of the [`Extent`] that faces
    /// light from far away; 1 for points.
    pub pdf_place: f32,
    /// Density of the direction, 1/sr; 1 for parallel light.
    pub pdf_direction: f32,
}

impl Emitted {
    /// What of the light's power it stands for, W: light by densities, and of surfaces the cosine.
    pub fn power(&self) -> Spectrum {
        let cos = match &self.source {
            Source::Surface(hit) => hit.n.dot(self.d).abs(),
            _ => 1.0,
        };
        self.light * (cos / (self.pdf_place * self.pdf_direction))
    }
}

/// The ray of a particle, as those ask who met it and want to know how it could have begun.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leaving {
    /// Where it left a surface that shines; of other lights a point on its way.
    pub p: Point3,
    /// The place of that surface.
    pub hit: Option<LightHit>,
    /// Unit direction in which it travels.
    pub d: Vector3,
}

impl Extent {
    /// A point for light that travels along `d` from far away, before the ball, and the density of it, 1/m²; `u` in
    /// `[0, 1)²`.
    pub(super) fn before(&self, d: Vector3, u: Point2) -> (Point3, f32) {
        let [x, y] = concentric_disk(u).map(|v| v * self.radius);
        let frame = Frame::from_z(Normal3::from(d));
        (self.center + frame.x * x + frame.y * y - d * self.radius, self.density())
    }
    /// The density of the places of [`Extent::before`] from which light along `d` comes by `p`, 1/m².
    pub(super) fn density_at(&self, p: Point3, d: Vector3) -> f32 {
        let off = p - self.center;
        let aside = off - d * off.dot(d);
        // Points on the rim are there by rounding.
        if aside.length_squared() <= sqr(self.radius * (1.0 + 1e-5)) { self.density() } else { 0.0 }
    }
    fn density(&self) -> f32 {
        1.0 / (PI * sqr(self.radius))
    }
}
