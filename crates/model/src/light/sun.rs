//! The sun through a clear atmosphere: a distant light of half a degree.
//!
//! The illuminance outside the atmosphere, 133.8 klx, is dimmed by the air, `0.008735 lambda^-4.08 m`, and by haze, `beta
//! lambda^-1.3 m` with Ångström's turbidity `beta = 0.04608 T - 0.04586`, as in appendix A.1 of Preetham, Shirley and Smits 1999,
//! for one wavelength `lambda` in micrometres per channel; `m` is the relative mass of air of Kasten 1965. Ozone and vapour,
//! which take a few percent, are left out.
//!
//! One unit of irradiance is 39.3 klx, one of radiance 39.3 kcd/m²: 1 is what is just white in a photograph of exposure value 15
//! at ISO 100, by the rule of sunny 16 that of a landscape in full sun (ISO 12232 sets white at `1.2 * 2^EV` cd/m² for a lens
//! that passes 0.65 of the light). White paper in the sun is then 0.8, a clear sky 0.1 to 0.3.
use durer_core::{
    glam::DVec3,
    math::{
        Point3, Vector3,
        float::{acos, exp, pow},
    },
    spectrum::Color,
};
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{Distant, Light};

/// Illuminance outside the atmosphere, klx.
const OUTSIDE: f32 = 133.8;
/// Luminance of one unit of radiance, kcd/m²: `1.2 * 2^15 / 1000`.
pub(super) const WHITE: f32 = 39.3216;
/// A wavelength for each channel, micrometres.
const WAVELENGTHS: [f32; 3] = [0.610, 0.550, 0.465];

/// Where the sun is.
pub(super) const DIRECTION: ParamSpec = ParamSpec::new(
    "sun",
    ParamType::Vector3,
    ParamDefault::Triple([0.5, 0.7, 0.4]),
    "Direction towards the sun.",
);
/// Where the zenith is.
pub(super) const UP: ParamSpec = ParamSpec::new(
    "up",
    ParamType::Vector3,
    ParamDefault::Triple([0.0, 1.0, 0.0]),
    "Direction of the zenith.",
);
/// How hazy it is.
pub(super) const TURBIDITY: ParamSpec =
    ParamSpec::float("turbidity", 3.0, "Haze: 2 on a very clear day, 10 on a hazy one.").range(1.7, 10.0);

/// The word `sun`.
#[derive(Debug)]
pub struct Sun;

impl Kind for Sun {
    type Output = Box<dyn Light>;
    const SCHEMA: Schema = Schema {
        name: "sun",
        aliases: &[],
        doc: "The sun through a clear atmosphere: a disk infinitely far away.",
        params: &[
            DIRECTION,
            UP,
            TURBIDITY,
            ParamSpec::float(
                "scale",
                1.0,
                "Factor on the irradiance: 1 exposes for full sun, 39.3 makes it klx.",
            )
            .range(0.0, f32::INFINITY),
            ParamSpec::float("angle", 0.53, "Angle across the disk.").unit("degrees").range(0.0, 90.0),
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let (up, sun) = directions(args)?;
        let irradiance =
            irradiance(args.float("turbidity"), sun.dot(up) as f32) * (args.float("scale") / WHITE);
        let travels = Vector3::from_f64(-sun);
        Some(Box::new(Distant::new(Point3::ZERO, travels, irradiance.into(), args.float("angle"))))
    }
}

/// Unit directions of the zenith and of the sun; complains about those that are none.
pub(super) fn directions(args: &mut Args<'_>) -> Option<(DVec3, DVec3)> {
    let [up, sun] = ["up", "sun"].map(|name| {
        let d = DVec3::from_array(args.triple(name).map(f64::from)).normalize_or_zero();
        if d == DVec3::ZERO {
            args.error(name, format!("\"{name}\" is zero, which is no direction"));
        }
        d
    });
    args.is_sound().then_some((up, sun))
}

/// Irradiance of a plane that faces the sun, klx, at the cosine of its angle from the zenith; black below the horizon.
pub(super) fn irradiance(turbidity: f32, cos: f32) -> Color {
    if cos <= 0.0 {
        return Color::BLACK;
    }
    let degrees = acos(cos.min(1.0)).to_degrees();
    let mass = 1.0 / (cos + 0.15 * pow(93.885 - degrees, -1.253));
    let haze = 0.046_08 * turbidity - 0.045_86;
    let passes =
        WAVELENGTHS.map(|lambda| exp(-mass * (0.008_735 * pow(lambda, -4.08) + haze * pow(lambda, -1.3))));
    Color { rgb: passes.map(|passes| OUTSIDE * passes) }
}
