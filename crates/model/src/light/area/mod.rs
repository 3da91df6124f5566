//! Light from surfaces: every point sends out the same radiance in all directions of its outside. A texture or a picture may
//! vary it from point to point, and a hole of the surface does not shine.
//!
//! Light is gathered by choosing a point of the surface: spheres by their cone, rectangles and triangles by solid angle,
//! everything else by area, with `p(direction) = p(area) distance² / cos`. Which of these it is does not change the mean,
//! only the noise. The power is `pi L A`, for a mean radiance `L`, twice that if both sides
//! shine.
mod cone;
mod emitter;
mod form;
mod glow;
mod known;
mod looked;
mod piece;
mod placed;
mod rectangle;
mod triangle;

use std::{f64::consts::PI, sync::OnceLock};

use durer_core::{
    glam::DVec3,
    math::{
        Frame, Normal3, Point2, Point3, Vector3,
        error::{gamma, offset_ray_origin},
    },
    sampling::{Dim, Sampler, cosine_hemisphere},
    spectrum::{Basis, Color, Spectrum},
};
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use self::{emitter::Emitter, glow::Glow, placed::Chosen};
use super::{
    Emitted, Extent, Leaving, Light, LightBound, LightBounds, LightCx, LightHit, LightSample, POWER, Source,
    Track, steps,
};
use crate::{Surface, shape::Geometry, texture::TextureAt};

pub use self::glow::{Looks, Materials, Textures};

/// What a surface sends out, before it is known which: the word `diffuse` of `AreaLightSource`.
#[derive(Clone, Debug)]
pub struct Emission {
    /// Radiance before `scale`, or, if `power` is given, up to a factor.
    glow: Glow,
    scale: f32,
    /// Luminance of the whole power, W.
    power: Option<f32>,
    sides: Sides,
}

/// Which sides of a surface shine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sides {
    Outside,
    Both,
}

impl Kind for Emission {
    type Output = Self;
    const SCHEMA: Schema = Schema {
        name: "diffuse",
        aliases: &["area"],
        doc: "The shapes that follow, up to the end of the block, shine from every point of their outside equally in all \
              directions.",
        params: &[
            ParamSpec::color_texture("L", [1.0; 3], "Radiance, which a texture may vary over the surface.")
                .unit("W/(m² sr)")
                .range(0.0, f32::INFINITY),
            ParamSpec::float("scale", 1.0, "Factor on the radiance.").range(0.0, f32::INFINITY),
            ParamSpec {
                doc: "Total power of each shape; replaces the magnitude of the radiance, scale still applies.",
                ..POWER
            },
            ParamSpec::new("twosided", ParamType::Bool, ParamDefault::Bool(false), "The inside shines too."),
            ParamSpec::new(
                "filename",
                ParamType::File,
                ParamDefault::Unset,
                "A picture of the radiance over the surface coordinates, instead of L: floats are linear, integers \
                 sRGB-encoded.",
            ),
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self> {
        let sides = if args.bool("twosided") { Sides::Both } else { Sides::Outside };
        let power = args.optional_float("power");
        Some(Self { glow: Glow::read(args)?, scale: args.float("scale"), power, sides })
    }
}

/// A shape that shines, in its place.
#[derive(Debug)]
pub struct Area {
    emitter: Emitter,
    emission: Emission,
    looks: Looks,
    /// Factor on the radiance of the emission's `glow`.
    factor: f32,
    /// Mean luminance over the surface, which counts as black where it has holes.
    mean: f32,
    /// See [`Area::shares`], once asked for.
    shares: OnceLock<Vec<f32>>,
}

impl Area {
    /// The light of `geometry` placed by `track`; `reversed` if its normals are turned.
    ///
    /// # Errors
    /// Why it cannot shine: it is infinite, or has no area.
    pub fn new(
        emission: &Emission,
        geometry: &Geometry,
        track: Track,
        orientation: Orientation,
    ) -> Result<Self, &'static str> {
        let emitter = Emitter::new(geometry, track, emission.sides, orientation == Orientation::Reversed)?;
        let (emission, looks) = (emission.clone(), Looks::default());
        Ok(Self { emitter, emission, looks, factor: 1.0, mean: 0.0, shares: OnceLock::new() }.measured())
    }

    /// The same with the textures and holes of its shape.
    #[must_use]
    pub fn with_looks(self, looks: Looks) -> Self {
        Self { looks, ..self }.measured()
    }

    /// The same with what follows from how bright it is all over.
    fn measured(self) -> Self {
        let mean = match self.emission.glow.even().filter(|_| !self.looks.has_holes()) {
            Some(color) => color.luminance(),
            None => {
                let of = |&(share, p, n, piece): &(f64, DVec3, DVec3, usize)| {
                    let at = self.emitter.texture_at(f32::NEG_INFINITY, (p, n), piece);
                    let radiance = self.looks.radiance(&self.emission.glow, &Basis::Rgb, &at);
                    share as f32 * Color { rgb: Basis::Rgb.to_rgb(radiance) }.luminance()
                };
                self.emitter.spread().iter().map(of).sum()
            }
        };
        let factor = match self.emission.power {
            None => 1.0,
            Some(_) if mean <= 0.0 => 0.0,
            Some(power) => (f64::from(power) / (self.surface() * f64::from(mean))) as f32,
        };
        let factor = factor * self.emission.scale;
        Self { factor, mean: mean * factor, ..self }
    }

    /// The power of a radiance of 1.
    fn surface(&self) -> f64 {
        let sides = if self.emission.sides == Sides::Both { 2.0 } else { 1.0 };
        PI * sides * self.emitter.area
    }

    /// The radiance where textures are looked up at `at`.
    fn radiance(&self, basis: Basis, at: impl FnOnce() -> TextureAt) -> Spectrum {
        let radiance = match self.emission.glow.even().filter(|_| !self.looks.has_holes()) {
            Some(color) => basis.light(color),
            None => self.looks.radiance(&self.emission.glow, &basis, &at()),
        };
        radiance * self.factor
    }

    /// A point of it moved to the side of `d` by more than its rounding, and that of a ray of this length.
    fn beside(&self, chosen: &Chosen, d: Vector3, length: f64) -> Point3 {
        let rounded = Point3::from_f64(chosen.p);
        let slack = ((length + self.emitter.magnitude()) as f32) * gamma(8);
        let error = (rounded - Point3::ZERO).abs() * gamma(8) + Vector3::splat(slack);
        offset_ray_origin(rounded, error, Normal3::from_f64(chosen.n), d)
    }

    /// Sums of the shares of the pieces among particles: by area and mean luminance, of which none has less than a
    /// tenth of all.
    fn shares(&self) -> &[f32] {
        self.shares.get_or_init(|| {
            let mut weights: Vec<f64> = self.emitter.areas();
            if self.emission.glow.even().is_none() || self.looks.has_holes() {
                let mut found = vec![[0.0; 2]; weights.len()];
                let mut all = [0.0; 2];
                for (share, p, n, piece) in self.emitter.spread() {
                    let at = self.emitter.texture_at(f32::NEG_INFINITY, (p, n), piece);
                    let radiance = self.looks.radiance(&self.emission.glow, &Basis::Rgb, &at);
                    let luminance = Color { rgb: Basis::Rgb.to_rgb(radiance) }.luminance();
                    for sums in [&mut found[piece], &mut all] {
                        *sums = [sums[0] + share * f64::from(luminance), sums[1] + share];
                    }
                }
                let mean = |[light, share]: [f64; 2]| if share > 0.0 { light / share } else { 0.0 };
                let least = 0.1 * mean(all);
                weights.iter_mut().zip(found).for_each(|(weight, sums)| *weight *= mean(sums).max(least));
            }
            let largest = weights.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
            let mut sums: Vec<f32> = weights.iter().map(|w| (w / largest) as f32).collect();
            steps::accumulate(&mut sums);
            sums
        })
    }

    /// Density of particles along unit direction `d` where the normal is `n`, 1/sr.
    fn density_along(&self, n: DVec3, d: DVec3) -> f32 {
        let sides = if self.emission.sides == Sides::Both { 2.0 } else { 1.0 };
        if self.shines(n, d) { (n.dot(d).abs() / (PI * sides)) as f32 } else { 0.0 }
    }

    /// Whether the side on which direction `w` lies shines, where the normal is `n`.
    fn shines(&self, n: DVec3, w: DVec3) -> bool {
        let cos = n.dot(w);
        cos > 0.0 || self.emission.sides == Sides::Both && cos < 0.0
    }
}

/// Whether normals are as the shape has them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Orientation {
    /// They are.
    #[default]
    AsMade,
    /// They are turned.
    Reversed,
}

impl Light for Area {
    /// It was placed when it was made.
    fn place(&mut self, _track: &Track) {}

    fn sample(&self, cx: &LightCx, p: Point3, sampler: &Sampler) -> Option<LightSample> {
        let from = p.to_f64();
        let u = sampler.d2(Dim::Light);
        let (chosen, piece) = self.emitter.choose(from, cx.time, [u.x.into(), u.y.into()])?;
        let towards = chosen.p - from;
        let distance = towards.length();
        if !self.shines(chosen.n, -towards) || distance == 0.0 {
            return None;
        }
        let at = || self.emitter.texture_at(cx.time, (chosen.p, chosen.n), piece);
        let weight = self.radiance(cx.basis, at) * (1.0 / chosen.density) as f32;
        if weight.is_black() {
            return None;
        }
        // Shadow rays end before the surface by more than rounding can be wrong: that of the ray, which grows with its
        // length, and that of the placement.
        let point = self.beside(&chosen, Vector3::from_f64(-towards), distance);
        let on = LightHit {
            p: Point3::from_f64(chosen.p),
            n: Normal3::from_f64(chosen.n),
            part: self.emitter.part_of(piece),
        };
        let wi = Vector3::from_f64(towards / distance);
        Some(LightSample { wi, point: Some(point), weight, pdf: Some(chosen.density as f32), on: Some(on) })
    }

    fn emit(&self, cx: &LightCx, _within: &Extent, [place, u]: [Point2; 2]) -> Option<Emitted> {
        let (index, rest, share) = steps::pick(self.shares(), place.x);
        let chosen = self.emitter.point_of(index, cx.time, [rest.into(), place.y.into()])?;
        let at = || self.emitter.texture_at(cx.time, (chosen.p, chosen.n), index);
        let light = self.radiance(cx.basis, at);
        let n = Normal3::from_f64(chosen.n);
        let local = match self.emission.sides {
            Sides::Outside => cosine_hemisphere(u),
            Sides::Both => {
                let (first, x) = if u.x < 0.5 { (1.0, 2.0 * u.x) } else { (-1.0, 2.0 * u.x - 1.0) };
                cosine_hemisphere(Point2::new(x, u.y)) * first
            }
        };
        let d = Frame::from_z(n).to_world(local).normalize();
        let hit = LightHit { p: Point3::from_f64(chosen.p), n, part: self.emitter.part_of(index) };
        let pdf_place = share * chosen.density as f32;
        let pdf_direction = self.density_along(n.to_f64(), d.to_f64());
        (pdf_place > 0.0 && pdf_direction > 0.0 && !light.is_black()).then_some(Emitted {
            p: self.beside(&chosen, d, 0.0),
            d,
            source: Source::Surface(hit),
            light,
            pdf_place,
            pdf_direction,
        })
    }

    fn emission_pdf(&self, cx: &LightCx, _within: &Extent, ray: &Leaving) -> [f32; 2] {
        let Some(hit) = &ray.hit else { return [0.0; 2] };
        let (p, n) = (hit.p.to_f64(), hit.n.to_f64());
        let (density, index) = self.emitter.density_of(cx.time, (p, n, hit.part));
        [steps::share(self.shares(), index) * density as f32, self.density_along(n, ray.d.to_f64())]
    }

    fn is_emitter(&self) -> bool {
        self.is_sampled()
    }

    fn bound(&self) -> LightBound {
        let seen = self.looks.largest(&self.emission.glow) * self.factor;
        LightBound { seen, ..LightBound::default() }
    }

    fn bounds(&self) -> Option<LightBounds> {
        let known = self.emitter.known;
        Some(LightBounds { intensity: known.intensity * self.mean, ..known })
    }

    fn power(&self, _radius: f32) -> f32 {
        self.mean * self.surface() as f32
    }

    fn pdf(&self, cx: &LightCx, from: Point3, hit: &LightHit) -> f32 {
        let (from, p, n) = (from.to_f64(), hit.p.to_f64(), hit.n.to_f64());
        if !self.shines(n, from - p) {
            return 0.0;
        }
        self.emitter.density(from, cx.time, (p, n, hit.part)) as f32
    }

    fn is_sampled(&self) -> bool {
        self.mean > 0.0
    }

    fn emitted(&self, basis: Basis, surface: &Surface, wo: Vector3) -> Spectrum {
        let shines = self.shines(surface.n_g.to_f64(), wo.to_f64());
        if shines { self.radiance(basis, || surface.texture_at()) } else { Spectrum::BLACK }
    }
}

/// The angle between two vectors, in `[0, pi]`, to full accuracy also near both ends.
fn between(a: DVec3, b: DVec3) -> f64 {
    libm::atan2(a.cross(b).length(), a.dot(b))
}

/// Two unit vectors perpendicular to unit `z` and each other (Duff et al. 2017).
fn frame(z: DVec3) -> [DVec3; 2] {
    let sign = 1f64.copysign(z.z);
    let a = -1.0 / (sign + z.z);
    let b = z.x * z.y * a;
    [DVec3::new(1.0 + sign * z.x * z.x * a, sign * b, -sign * z.x), DVec3::new(b, sign + z.y * z.y * a, -z.y)]
}
