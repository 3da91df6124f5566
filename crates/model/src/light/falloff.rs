//! How a light without extent fades with distance.
use std::f32::consts::PI;

use durer_core::{
    math::{Normal3, Point3, Vector3},
    spectrum::Color,
};
use durer_scene::{Args, ParamDefault, ParamSpec, ParamType};

use super::{LightBound, largest, track::Anchor};

/// Fading with distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Falloff {
    /// As in nature: irradiance is intensity / distance².
    InverseSquare,
    /// Not at all. The irradiance is pi times the intensity at every distance, so that a facing Lambertian surface of
    /// coefficient `k_d` reflects the radiance `k_d I` of Whitted's formula.
    None,
}

impl Falloff {
    pub(super) const SPEC: ParamSpec = ParamSpec::new(
        "falloff",
        ParamType::Choice(&["inverse-square", "none"]),
        ParamDefault::Text("inverse-square"),
        "Fading with distance; none as in the classic formula, where a facing matte surface reflects kd I.",
    );

    pub(super) fn from_args(args: &Args<'_>) -> Self {
        if args.text("falloff") == "none" { Self::None } else { Self::InverseSquare }
    }
    /// Unit direction from `p` to the light at `light`, and the irradiance per intensity on a plane facing it. `None` if
    /// they coincide.
    pub(super) fn towards(self, light: Point3, p: Point3) -> Option<(Vector3, f32)> {
        let d = light - p;
        let distance = d.length();
        if distance == 0.0 || !distance.is_finite() {
            return None;
        }
        let irradiance = match self {
            Self::InverseSquare => 1.0 / distance / distance,
            Self::None => PI,
        };
        irradiance.is_finite().then(|| (d / distance, irradiance))
    }
    /// The irradiance per intensity at `p` on a surface of unit normal `n`, or facing the light.
    pub(super) fn reach(self, light: Point3, p: Point3, n: Option<Normal3>) -> f32 {
        let cos = |wi: Vector3| n.map_or(1.0, |n| n.dot(wi).max(0.0));
        self.towards(light, p).map_or(0.0, |(wi, irradiance)| irradiance * cos(wi))
    }
    /// The most that a light of this intensity at `anchor` can send. Of one that moves and fades there is no bound.
    pub(super) fn bound(self, anchor: &Anchor, intensity: Color) -> LightBound {
        let intensity = largest(intensity);
        let (facing, fades_from) = match (self, anchor.still()) {
            (Self::None, _) => (PI * intensity, None),
            (Self::InverseSquare, Some(place)) => (intensity, Some(place)),
            (Self::InverseSquare, None) if intensity > 0.0 => (f32::INFINITY, None),
            (Self::InverseSquare, None) => (0.0, None),
        };
        LightBound { facing, fades_from, ..LightBound::default() }
    }
}
