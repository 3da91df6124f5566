//! A sky that brightens or darkens from the horizon to the zenith, above a ground of one colour.
//!
//! With `s` the sine of the elevation, the radiance is `horizon + (zenith - horizon) w(s)`, `w = 1 - (1 - s)²`, above the
//! horizon and `horizon + (ground - horizon) v(-s)`, `v = 1 - (1 - s)^8`, below: continuous, with a thin rim of haze under
//! the horizon. The ambient term and glossy reflections weigh the three colours by blurred `w` and `v` (`sky_blur.rs`).
use std::f32::consts::{PI, TAU};

use durer_core::{
    math::{
        Frame, Normal3, Point2, Point3, Vector3,
        float::{cos, sin, sqr},
    },
    sampling::{Dim, Sampler},
    spectrum::{Basis, Color, Spectrum},
};
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{
    Emitted, Extent, LEAST_REACH, Leaving, Light, LightBound, LightCx, LightSample, Source, Track, UNIFORM,
    largest, sky_blur::SkyBlur, sky_power, steps,
};

/// Belts of equal solid angle, on each of which directions are drawn evenly.
const BELTS: usize = 128;

/// A gradient sky.
#[derive(Debug)]
pub struct GradientSky {
    zenith: Color,
    horizon: Color,
    ground: Color,
    /// Unit direction of the zenith.
    up: Vector3,
    /// Blurred weight of the zenith, by the sine of the elevation.
    zenith_weight: SkyBlur,
    /// Blurred weight of the ground.
    ground_weight: SkyBlur,
    /// Sums of the shares of the belts, from the nadir up; all 0 if it is black.
    belts: Vec<f32>,
    /// Mean luminance over the sphere.
    mean: f32,
}

/// Share of the zenith's colour at sine `s` of the elevation.
fn zenith_weight(s: f32) -> f32 {
    1.0 - sqr(1.0 - s.clamp(0.0, 1.0))
}

/// Share of the ground's colour.
fn ground_weight(s: f32) -> f32 {
    1.0 - sqr(sqr(sqr(1.0 + s.clamp(-1.0, 0.0))))
}

/// Sine of the elevation, counted in belts from the nadir.
fn height(belts: f32) -> f32 {
    2.0 * belts / BELTS as f32 - 1.0
}

impl Kind for GradientSky {
    type Output = Box<dyn Light>;
    const SCHEMA: Schema = Schema {
        name: "gradientsky",
        aliases: &[],
        doc: "A sky with a smooth gradient from the horizon to the zenith, and a ground below.",
        params: &[
            ParamSpec::color("zenith", [0.25, 0.45, 0.8], "Radiance overhead.")
                .unit("W/(m² sr)")
                .range(0.0, f32::INFINITY),
            ParamSpec::color("horizon", [0.8, 0.87, 0.95], "Radiance at the horizon.")
                .unit("W/(m² sr)")
                .range(0.0, f32::INFINITY),
            ParamSpec::color("ground", [0.3, 0.27, 0.24], "Radiance from below.")
                .unit("W/(m² sr)")
                .range(0.0, f32::INFINITY),
            ParamSpec::new(
                "up",
                ParamType::Vector3,
                ParamDefault::Triple([0.0, 1.0, 0.0]),
                "Direction of the zenith.",
            ),
            ParamSpec::float("scale", 1.0, "Factor on the radiance.").range(0.0, f32::INFINITY),
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let up = Vector3::from(args.triple("up"));
        if up.length_squared() == 0.0 {
            args.error("up", "the zenith needs a direction, \"up\" is zero");
            return None;
        }
        let scale = args.float("scale");
        let mut sky = Self {
            zenith: args.color("zenith") * scale,
            horizon: args.color("horizon") * scale,
            ground: args.color("ground") * scale,
            up: up.normalize(),
            zenith_weight: SkyBlur::of(zenith_weight),
            ground_weight: SkyBlur::of(ground_weight),
            belts: Vec::new(),
            mean: 0.0,
        };
        sky.belts = (0..BELTS).map(|i| sky.luminance(i)).collect();
        sky.mean = (steps::accumulate(&mut sky.belts) / BELTS as f64) as f32;
        Some(Box::new(sky))
    }
}

impl GradientSky {
    /// Mean luminance of the ends of a belt: above 0 where anything in it is, as the gradients are monotonic.
    fn luminance(&self, belt: usize) -> f32 {
        let end = |belt: usize| {
            let s = height(belt as f32);
            let (zenith, ground) = (zenith_weight(s), ground_weight(s));
            let horizon = (1.0 - zenith - ground).max(0.0);
            (self.zenith * zenith + self.horizon * horizon + self.ground * ground).luminance()
        };
        0.5 * (end(belt) + end(belt + 1))
    }
    /// Density of the directions of a belt, 1/sr.
    fn density(&self, belt: usize) -> f32 {
        steps::share(&self.belts, belt) * BELTS as f32 * UNIFORM
    }
    /// A direction and its density, 1/sr; `u` in `[0, 1)²`.
    fn direction(&self, u: Point2) -> (Vector3, f32) {
        let (belt, rest, _) = steps::pick(&self.belts, u.y);
        let z = height(belt as f32 + rest);
        let (r, azimuth) = ((1.0 - sqr(z)).max(0.0).sqrt(), TAU * u.x);
        let local = Vector3::new(r * cos(azimuth), r * sin(azimuth), z);
        (Frame::from_z(Normal3::from(self.up)).to_world(local), self.density(belt))
    }
    fn mixed(&self, basis: Basis, zenith: f32, ground: f32) -> Spectrum {
        let horizon = (1.0 - zenith - ground).max(0.0);
        basis.emission(self.zenith * zenith + self.horizon * horizon + self.ground * ground)
    }
}

impl Light for GradientSky {
    fn place(&mut self, track: &Track) {
        let m = track.at(f32::NEG_INFINITY);
        self.up = Vector3::from_f64(m.transform_vector3(self.up.to_f64()).normalize());
    }
    fn sample(&self, cx: &LightCx, _p: Point3, sampler: &Sampler) -> Option<LightSample> {
        let (wi, pdf) = self.direction(sampler.d2(Dim::Light));
        let weight = self.escaped(cx.basis, wi) / pdf;
        (pdf > 0.0 && !weight.is_black()).then_some(LightSample {
            wi,
            point: None,
            weight,
            pdf: Some(pdf),
            on: None,
        })
    }
    fn reach(&self, _p: Point3, n: Option<Normal3>, _time: f32) -> f32 {
        let least = LEAST_REACH * self.mean;
        PI * n.map_or(self.mean, |n| self.ambient(Basis::Rgb, n).mean().max(least))
    }
    fn power(&self, radius: f32) -> f32 {
        sky_power(self.mean, radius)
    }
    fn is_sampled(&self) -> bool {
        self.belts[BELTS - 1] > 0.0
    }
    fn pdf_escaped(&self, _cx: &LightCx, _from: Point3, d: Vector3) -> f32 {
        let belt = (0.5 * (d.dot(self.up) + 1.0) * BELTS as f32) as usize;
        self.density(belt.min(BELTS - 1))
    }
    fn emit(&self, cx: &LightCx, within: &Extent, [place, u]: [Point2; 2]) -> Option<Emitted> {
        let (wi, pdf_direction) = self.direction(u);
        let (light, (p, pdf_place)) = (self.escaped(cx.basis, wi), within.before(-wi, place));
        let emitted = Emitted { p, d: -wi, source: Source::Far, light, pdf_place, pdf_direction };
        (pdf_direction > 0.0 && !light.is_black()).then_some(emitted)
    }
    fn emission_pdf(&self, cx: &LightCx, within: &Extent, ray: &Leaving) -> [f32; 2] {
        [within.density_at(ray.p, ray.d), self.pdf_escaped(cx, ray.p, -ray.d)]
    }
    fn is_emitter(&self) -> bool {
        self.is_sampled()
    }
    fn surrounds(&self) -> bool {
        true
    }
    /// Everything is a mixture of the three.
    fn bound(&self) -> LightBound {
        let most = [self.zenith, self.horizon, self.ground].map(largest).into_iter().fold(0.0, f32::max);
        LightBound { seen: most, ambient: most, ..LightBound::default() }
    }
    fn ambient(&self, basis: Basis, n: Normal3) -> Spectrum {
        let s = n.dot(self.up);
        self.mixed(basis, self.zenith_weight.ambient(s), self.ground_weight.ambient(s))
    }
    fn glossy_ambient(&self, basis: Basis, d: Vector3, alpha: f32) -> Spectrum {
        let s = d.dot(self.up);
        self.mixed(basis, self.zenith_weight.glossy(s, alpha), self.ground_weight.glossy(s, alpha))
    }
    fn escaped(&self, basis: Basis, d: Vector3) -> Spectrum {
        let s = d.dot(self.up);
        self.mixed(basis, zenith_weight(s), ground_weight(s))
    }
}
