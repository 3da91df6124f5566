//! A cone of light from one point: intensity `I` inside the inner cone, fading to 0 at the outer one.
//!
//! pbrt-v4's falloff: `smoothstep` of the cosine to the axis, from `cos(coneangle)` (0) to
//! `cos(coneangle - conedeltaangle)` (1). As the mean of smoothstep is 1/2, the power is
//! `2 pi I ((1 - cos inner) + (cos inner - cos outer) / 2)`. Or Mitsuba's: linear in the angle, whose integral over the rim is
//! `2 pi (cos inner - (sin outer - sin inner) / (outer - inner))`.
use std::f32::consts::{PI, TAU};

use durer_core::{
    math::{
        Frame, Normal3, Point2, Point3, Vector3,
        float::{acos, cos, sin, sqr},
    },
    sampling::Sampler,
    spectrum::LightColor,
};
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{
    Emitted, Extent, INTENSITY_SCALE, Leaving, Light, LightBound, LightBounds, LightCx, LightSample,
    POSITION, POWER, Source, Track, axis, falloff::Falloff, scaled, track::Anchor,
};

/// Halvings that find a place in the rim.
const HALVINGS: u32 = 26;

/// A spot light.
#[derive(Debug)]
pub struct Spot {
    /// The position, and the direction of the cone's axis.
    anchor: Anchor,
    cone: Cone,
    intensity: LightColor,
    falloff: Falloff,
}

/// The share of the intensity in each direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cone {
    cos_inner: f32,
    cos_outer: f32,
    /// Angles of both in radians, if the rim is linear in the angle.
    linear: Option<[f32; 2]>,
}

impl Cone {
    /// How the rim fades.
    pub(super) const RIM: ParamSpec = ParamSpec::new(
        "rim",
        ParamType::Choice(&["smooth", "linear"]),
        ParamDefault::Text("smooth"),
        "How the rim fades: smoothly with the cosine, as in pbrt-v4, or evenly with the angle, as in Mitsuba.",
    );

    /// From the angles of the outer cone and of the rim in degrees.
    pub(super) fn new(outer: f32, rim: f32, is_linear: bool) -> Self {
        let [inner, outer] = [(outer - rim).max(0.0), outer].map(|angle| angle * (PI / 180.0));
        let linear = (is_linear && inner < outer).then_some([inner, outer]);
        Self { cos_inner: cos(inner), cos_outer: cos(outer), linear }
    }
    /// The share at this cosine to the axis.
    pub(super) fn share(&self, cos: f32) -> f32 {
        if cos >= self.cos_inner {
            return 1.0;
        } else if cos <= self.cos_outer {
            return 0.0;
        }
        if let Some([inner, outer]) = self.linear {
            return ((outer - acos(cos)) / (outer - inner)).clamp(0.0, 1.0);
        }
        let t = (cos - self.cos_outer) / (self.cos_inner - self.cos_outer);
        t * t * (3.0 - 2.0 * t)
    }
    /// The integral of the share from the outer cone up to this cosine, by azimuth.
    fn rim_up_to(&self, cos: f32) -> f32 {
        match self.linear {
            Some([inner, outer]) => {
                let angle = acos(cos).clamp(inner, outer);
                ((outer - angle) * cos - (sin(outer) - sin(angle))) / (outer - inner)
            }
            None => {
                // The integral of smoothstep is t³ - t⁴ / 2.
                let width = self.cos_inner - self.cos_outer;
                let t = if width > 0.0 { (cos - self.cos_outer) / width } else { 0.0 };
                t * t * t * (1.0 - 0.5 * t) * width
            }
        }
    }
    /// The integral of the share over all directions.
    fn solid_angle(&self) -> f32 {
        TAU * ((1.0 - self.cos_inner) + self.rim_up_to(self.cos_inner).max(0.0))
    }
}

impl Kind for Spot {
    type Output = Box<dyn Light>;
    const SCHEMA: Schema = Schema {
        name: "spot",
        aliases: &[],
        doc: "A cone of light from one point.",
        params: &[
            ParamSpec::color("I", [1.0; 3], "Intensity on the axis.").unit("W/sr").range(0.0, f32::INFINITY),
            INTENSITY_SCALE,
            POWER,
            POSITION,
            ParamSpec::new(
                "to",
                ParamType::Point3,
                ParamDefault::Triple([0.0, 0.0, 1.0]),
                "A point on the axis.",
            )
            .unit("m"),
            ParamSpec::float("coneangle", 30.0, "Angle between axis and outer cone.")
                .unit("degrees")
                .range(0.0, 180.0),
            ParamSpec::float("conedeltaangle", 5.0, "Width of the fading rim inside the outer cone.")
                .unit("degrees")
                .range(0.0, 180.0),
            Cone::RIM,
            Falloff::SPEC,
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let is_linear = args.text(Cone::RIM.name) == "linear";
        let cone = Cone::new(args.float("coneangle"), args.float("conedeltaangle"), is_linear);
        let reach = cone.solid_angle().max(f32::MIN_POSITIVE);
        let intensity = scaled(args, "I", "power", reach);
        let (from, to): (Point3, Point3) = (args.triple("from").into(), args.triple("to").into());
        let anchor = Anchor::new(from, axis(args, from, to)?);
        let falloff = Falloff::from_args(args);
        Some(Box::new(Self { anchor, cone, intensity, falloff }))
    }
}

impl Spot {
    /// Density of the directions of particles at this cosine to the axis, 1/sr: even within the inner cone, which is
    /// chosen by the power it has, and in the rim by what smoothstep has there.
    fn density(&self, cos: f32) -> f32 {
        self.cone.share(cos) / self.cone.solid_angle()
    }
    /// The cosine that `u` in `[0, 1)` chooses.
    fn cos_at(&self, u: f32) -> f32 {
        let Cone { cos_inner, cos_outer, .. } = self.cone;
        let (inner, rim) = (1.0 - cos_inner, self.cone.rim_up_to(cos_inner).max(0.0));
        let inside = u * (inner + rim);
        if inside < inner {
            return 1.0 - inside;
        }
        // It rises with the cosine, so halving finds its inverse.
        let wanted = (rim - (inside - inner)).clamp(0.0, rim);
        let (mut low, mut high) = (cos_outer, cos_inner);
        for _ in 0..HALVINGS {
            let cos = 0.5 * (low + high);
            if self.cone.rim_up_to(cos) < wanted { low = cos } else { high = cos }
        }
        0.5 * (low + high)
    }
}

impl Light for Spot {
    fn place(&mut self, track: &Track) {
        self.anchor.place(track);
    }
    fn sample(&self, cx: &LightCx, p: Point3, _sampler: &Sampler) -> Option<LightSample> {
        let (position, axis) = self.anchor.at(cx.time);
        let (wi, irradiance) = self.falloff.towards(position, p)?;
        let weight = cx.basis.light(&self.intensity) * (irradiance * self.cone.share(-wi.dot(axis)));
        (!weight.is_black()).then_some(LightSample { wi, point: Some(position), weight, pdf: None, on: None })
    }
    fn emit(&self, cx: &LightCx, _within: &Extent, [_, u]: [Point2; 2]) -> Option<Emitted> {
        let (p, axis) = self.anchor.at(cx.time);
        let cos_axis = self.cos_at(u.x);
        let (r, azimuth) = ((1.0 - sqr(cos_axis)).max(0.0).sqrt(), TAU * u.y);
        let local = Vector3::new(r * cos(azimuth), r * sin(azimuth), cos_axis);
        let d = Frame::from_z(Normal3::from(axis)).to_world(local).normalize();
        let light = cx.basis.light(&self.intensity) * self.cone.share(d.dot(axis));
        let pdf_direction = self.density(d.dot(axis));
        (self.is_emitter() && !light.is_black()).then_some(Emitted {
            p,
            d,
            source: Source::Point,
            light,
            pdf_place: 1.0,
            pdf_direction,
        })
    }
    fn emission_pdf(&self, cx: &LightCx, _within: &Extent, ray: &Leaving) -> [f32; 2] {
        let cos = ray.d.dot(self.anchor.at(cx.time).1);
        if self.is_emitter() { [1.0, self.density(cos)] } else { [0.0; 2] }
    }
    /// Light that does not fade is no particles.
    fn is_emitter(&self) -> bool {
        self.falloff == Falloff::InverseSquare && self.cone.solid_angle() > 0.0
    }
    fn bound(&self) -> LightBound {
        self.falloff.bound(&self.anchor, self.intensity.color)
    }
    fn bounds(&self) -> Option<LightBounds> {
        (self.falloff == Falloff::InverseSquare).then(|| LightBounds {
            bounds: self.anchor.bounds(),
            normals: self.anchor.directions(acos(self.cone.cos_outer)),
            end: 0.0,
            both_sides: false,
            intensity: self.intensity.luminance(),
        })
    }
    fn reach(&self, p: Point3, n: Option<Normal3>, time: f32) -> f32 {
        let (position, axis) = self.anchor.at(time);
        let share = self.falloff.towards(position, p).map_or(0.0, |(wi, _)| self.cone.share(-wi.dot(axis)));
        self.falloff.reach(position, p, n) * self.intensity.luminance() * share
    }
    fn power(&self, _radius: f32) -> f32 {
        self.cone.solid_angle() * self.intensity.luminance()
    }
}
