//! A light infinitely far away: parallel rays, the same irradiance `E = L cos` everywhere. Or nearly parallel ones: a disk of
//! half angle `a` has the radiance `E / (pi sin² a)`, is sampled evenly over its solid angle `2 pi (1 - cos a)`, and is seen by
//! paths that leave the scene.
use std::f32::consts::{PI, TAU};

use durer_core::{
    math::{
        Frame, Normal3, Point2, Point3, Vector3,
        float::{cos, sin, sqr},
    },
    sampling::{Dim, Sampler},
    spectrum::{Basis, LightColor, Spectrum},
};
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{
    Emitted, Extent, Leaving, Light, LightBound, LightCx, LightSample, Source, Track, axis, largest, scaled,
    track::Anchor,
};

/// A distant light.
#[derive(Debug)]
pub struct Distant {
    /// The direction in which the light travels.
    anchor: Anchor,
    irradiance: LightColor,
    disk: Option<Disk>,
}

/// A light that has a size.
#[derive(Clone, Debug)]
struct Disk {
    radiance: LightColor,
    /// `1 - cos` of half the angle across it.
    opening: f32,
}

impl Disk {
    /// One of so many degrees across that gives this irradiance.
    fn new(irradiance: &LightColor, degrees: f32) -> Option<Self> {
        let half = 0.5 * degrees.to_radians();
        let opening = 2.0 * sqr(sin(0.5 * half));
        (opening > 0.0)
            .then(|| Self { radiance: irradiance.clone() * (1.0 / (PI * sqr(sin(half)))), opening })
    }
    fn density(&self) -> f32 {
        1.0 / (TAU * self.opening)
    }
    /// One of its directions; `u` in `[0, 1)²`.
    fn direction(&self, middle: Vector3, u: Point2) -> Vector3 {
        let down = u.x * self.opening;
        let (r, azimuth) = ((down * (2.0 - down)).sqrt(), TAU * u.y);
        let local = Vector3::new(r * cos(azimuth), r * sin(azimuth), 1.0 - down);
        Frame::from_z(Normal3::from(middle)).to_world(local).normalize()
    }
    /// Whether unit direction `d` is in it whose middle is at `middle`.
    fn holds(&self, middle: Vector3, d: Vector3) -> bool {
        // 1 - cos of the angle between them.
        0.5 * (d - middle).length_squared() <= self.opening
    }
}

impl Distant {
    /// A light that travels from `from` along unit `direction`, with this irradiance; `degrees` across.
    pub(super) fn new(from: Point3, direction: Vector3, irradiance: LightColor, degrees: f32) -> Self {
        let disk = Disk::new(&irradiance, degrees);
        Self { anchor: Anchor::new(from, direction), irradiance, disk }
    }
}

impl Kind for Distant {
    type Output = Box<dyn Light>;
    const SCHEMA: Schema = Schema {
        name: "distant",
        aliases: &["directional"],
        doc: "Parallel light from infinitely far away, like the sun's.",
        params: &[
            ParamSpec::color("L", [1.0; 3], "Irradiance on a plane that faces the light.")
                .unit("W/m²")
                .range(0.0, f32::INFINITY),
            ParamSpec::float("scale", 1.0, "Factor on L.").range(0.0, f32::INFINITY),
            ParamSpec::new(
                "illuminance",
                ParamType::Float,
                ParamDefault::Unset,
                "Luminance of that irradiance; replaces the magnitude of L, scale still applies.",
            )
            .range(0.0, f32::INFINITY),
            ParamSpec::new(
                "from",
                ParamType::Point3,
                ParamDefault::Triple([0.0; 3]),
                "Light travels from here",
            )
            .unit("m"),
            ParamSpec::new("to", ParamType::Point3, ParamDefault::Triple([0.0, 0.0, 1.0]), "towards here.")
                .unit("m"),
            ParamSpec::float("angle", 0.0, "Angle across the light: with one, shadows have soft edges.")
                .unit("degrees")
                .range(0.0, 90.0),
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let irradiance = scaled(args, "L", "illuminance", 1.0);
        let (from, to): (Point3, Point3) = (args.triple("from").into(), args.triple("to").into());
        let direction = axis(args, from, to)?;
        Some(Box::new(Self::new(from, direction, irradiance, args.float("angle"))))
    }
}

impl Light for Distant {
    fn place(&mut self, track: &Track) {
        self.anchor.place(track);
    }
    fn sample(&self, cx: &LightCx, _p: Point3, sampler: &Sampler) -> Option<LightSample> {
        let middle = -self.anchor.at(cx.time).1;
        let Some(disk) = &self.disk else {
            let weight = cx.basis.light(&self.irradiance);
            return (!weight.is_black()).then_some(LightSample {
                wi: middle,
                point: None,
                weight,
                pdf: None,
                on: None,
            });
        };
        let u = sampler.d2(Dim::Light);
        let wi = disk.direction(middle, u);
        let weight = cx.basis.light(&disk.radiance) / disk.density();
        (!weight.is_black()).then_some(LightSample {
            wi,
            point: None,
            weight,
            pdf: Some(disk.density()),
            on: None,
        })
    }
    fn emit(&self, cx: &LightCx, within: &Extent, [place, u]: [Point2; 2]) -> Option<Emitted> {
        let middle = -self.anchor.at(cx.time).1;
        let (d, source, light, pdf_direction) = match &self.disk {
            None => (-middle, Source::Parallel, cx.basis.light(&self.irradiance), 1.0),
            Some(disk) => {
                let light = cx.basis.light(&disk.radiance);
                (-disk.direction(middle, u), Source::Far, light, disk.density())
            }
        };
        let (p, pdf_place) = within.before(d, place);
        (!light.is_black()).then_some(Emitted { p, d, source, light, pdf_place, pdf_direction })
    }
    fn emission_pdf(&self, cx: &LightCx, within: &Extent, ray: &Leaving) -> [f32; 2] {
        let direction = if self.disk.is_some() { self.pdf_escaped(cx, ray.p, -ray.d) } else { 1.0 };
        [within.density_at(ray.p, ray.d), direction]
    }
    fn is_emitter(&self) -> bool {
        true
    }
    fn is_disk(&self) -> bool {
        self.disk.is_some()
    }
    fn pdf_escaped(&self, cx: &LightCx, _from: Point3, d: Vector3) -> f32 {
        let middle = -self.anchor.at(cx.time).1;
        self.disk.as_ref().filter(|disk| disk.holds(middle, d)).map_or(0.0, Disk::density)
    }
    fn escaped(&self, basis: Basis, d: Vector3) -> Spectrum {
        // Suns that move while the shutter is open are seen where they are at first.
        let middle = -self.anchor.at(f32::NEG_INFINITY).1;
        let disk = self.disk.as_ref().filter(|disk| disk.holds(middle, d));
        disk.map_or(Spectrum::BLACK, |disk| basis.light(&disk.radiance))
    }
    fn bound(&self) -> LightBound {
        let seen = self.disk.as_ref().map_or(0.0, |disk| largest(disk.radiance.color));
        LightBound { seen, facing: largest(self.irradiance.color), ..LightBound::default() }
    }
    fn reach(&self, _p: Point3, n: Option<Normal3>, time: f32) -> f32 {
        let (_, direction) = self.anchor.at(time);
        // Of a disk some may rise where the middle does not.
        let above = self.disk.as_ref().map_or(0.0, |disk| (disk.opening * (2.0 - disk.opening)).sqrt());
        self.irradiance.luminance() * n.map_or(1.0, |n| (above - n.dot(direction)).max(0.0))
    }
    fn power(&self, radius: f32) -> f32 {
        PI * sqr(radius) * self.irradiance.luminance()
    }
}
