//! A clear sky by daylight (Preetham, Shirley and Smits 1999, "A Practical Analytic Model for Daylight", appendix A.2), above
//! a matte ground.
//!
//! Luminance and chromaticity are those of the zenith times `F(theta, gamma) / F(0, theta_s)` with the function of Perez et al.
//! 1993, `F = (1 + A exp(B / cos theta)) (1 + C exp(D gamma) + E cos² gamma)`: `theta` is the angle from the zenith, `gamma` that
//! from the sun, `theta_s` the sun's from the zenith. The sun itself is another light (`sun.rs`), which says what the units are.
use std::{f64::consts::PI, sync::Arc};

use durer_core::{glam::DVec3, math::Vector3, spectrum::Color};
use durer_scene::{Args, Image, ImageData, Kind, ParamDefault, ParamSpec, ParamType, Schema};
use rayon::prelude::*;

use super::{
    Infinite, Light,
    infinite::Layout,
    sun::{self, TURBIDITY},
};

/// Rows of the picture that the sky becomes.
const ROWS: u32 = 512;

/// The word `sky`.
#[derive(Debug)]
pub struct Sky;

impl Kind for Sky {
    type Output = Box<dyn Light>;
    const SCHEMA: Schema = Schema {
        name: "sky",
        aliases: &[],
        doc: "A clear sky by daylight above a matte ground; the sun itself is the light \"sun\".",
        params: &[
            sun::DIRECTION,
            sun::UP,
            TURBIDITY,
            ParamSpec::color(
                "ground",
                [0.2; 3],
                "Reflectance of the ground, which is all that is below the horizon.",
            )
            .range(0.0, 1.0),
            ParamSpec::float(
                "scale",
                1.0,
                "Factor on the radiance: 1 exposes for full sun, 39.3 makes it kcd/m².",
            )
            .range(0.0, f32::INFINITY),
            ParamSpec::new(
                "sunlight",
                ParamType::Bool,
                ParamDefault::Bool(true),
                "The sun lights the ground that is seen, too.",
            ),
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let (up, sun) = sun::directions(args)?;
        let turbidity = args.float("turbidity");
        let daylight = Daylight::new(f64::from(turbidity), up, sun);
        let direct = sun::irradiance(turbidity, sun.dot(up) as f32);
        let direct =
            if args.bool("sunlight") { direct * (sun.dot(up).max(0.0) as f32) } else { Color::BLACK };
        let ground = args.color("ground") * ((daylight.irradiance() + direct) * std::f32::consts::FRAC_1_PI);
        let image = Arc::new(daylight.picture(ground));
        let scale = args.float("scale") / sun::WHITE;
        Some(Box::new(Infinite::of_picture(image, Layout::LatitudeLongitude, scale)))
    }
}

/// Perez's five numbers.
type Perez = [f64; 5];

/// The sky of one moment.
struct Daylight {
    up: DVec3,
    sun: DVec3,
    /// Luminance and chromaticity x and y of the zenith, over `F(0, theta_s)`.
    zenith: [f64; 3],
    perez: [Perez; 3],
}

fn f([a, b, c, d, e]: Perez, cos: f64, gamma: f64) -> f64 {
    (1.0 + a * libm::exp(b / cos)) * (1.0 + c * libm::exp(d * gamma) + e * libm::cos(gamma).powi(2))
}

impl Daylight {
    fn new(t: f64, up: DVec3, sun: DVec3) -> Self {
        // Below the horizon the model says nothing: the sky of sunset is taken.
        let from_zenith = libm::acos(sun.dot(up).clamp(0.0, 1.0));
        let perez = [
            [
                0.1787 * t - 1.4630,
                -0.3554 * t + 0.4275,
                -0.0227 * t + 5.3251,
                0.1206 * t - 2.5771,
                -0.0670 * t + 0.3703,
            ],
            [
                -0.0193 * t - 0.2592,
                -0.0665 * t + 0.0008,
                -0.0004 * t + 0.2125,
                -0.0641 * t - 0.8989,
                -0.0033 * t + 0.0452,
            ],
            [
                -0.0167 * t - 0.2608,
                -0.0950 * t + 0.0092,
                -0.0079 * t + 0.2102,
                -0.0441 * t - 1.6537,
                -0.0109 * t + 0.0529,
            ],
        ];
        let chi = (4.0 / 9.0 - t / 120.0) * (PI - 2.0 * from_zenith);
        let luminance = (4.0453 * t - 4.9710) * libm::tan(chi) - 0.2155 * t + 2.4192;
        let cubic = |[a, b, c, d]: [f64; 4]| ((a * from_zenith + b) * from_zenith + c) * from_zenith + d;
        let mixed = |rows: [[f64; 4]; 3]| (cubic(rows[0]) * t + cubic(rows[1])) * t + cubic(rows[2]);
        let x = mixed([
            [0.00166, -0.00375, 0.00209, 0.0],
            [-0.02903, 0.06377, -0.03202, 0.00394],
            [0.11693, -0.21196, 0.06052, 0.25886],
        ]);
        let y = mixed([
            [0.00275, -0.00610, 0.00317, 0.0],
            [-0.04214, 0.08970, -0.04153, 0.00516],
            [0.15346, -0.26756, 0.06670, 0.26688],
        ]);
        let at_zenith = |i: usize| f(perez[i], 1.0, from_zenith);
        let zenith = [luminance.max(0.0) / at_zenith(0), x / at_zenith(1), y / at_zenith(2)];
        Self { up, sun, zenith, perez }
    }

    /// The radiance of the sky in unit direction `d`, of which it is above the horizon, kcd/m².
    fn at(&self, d: DVec3) -> Color {
        let cos = d.dot(self.up).max(1e-3);
        let gamma = libm::atan2(d.cross(self.sun).length(), d.dot(self.sun));
        let [luminance, x, y] = [0, 1, 2].map(|i| self.zenith[i] * f(self.perez[i], cos, gamma));
        let (big_x, big_z) = (x / y * luminance, (1.0 - x - y) / y * luminance);
        // XYZ to linear Rec. 709 (IEC 61966-2-1).
        let rgb = [
            3.240_970 * big_x - 1.537_383 * luminance - 0.498_611 * big_z,
            -0.969_244 * big_x + 1.875_968 * luminance + 0.041_555 * big_z,
            0.055_630 * big_x - 0.203_977 * luminance + 1.056_972 * big_z,
        ];
        Color { rgb: rgb.map(|v| v.max(0.0) as f32) }
    }

    /// Irradiance of a horizontal plane.
    fn irradiance(&self) -> Color {
        const RINGS: u32 = 64;
        let [x, y] = [self.up.any_orthonormal_vector(), self.up.cross(self.up.any_orthonormal_vector())];
        let mut sum = Color::BLACK;
        for i in 0..RINGS * RINGS {
            let place = |i: u32| (f64::from(i) + 0.5) / f64::from(RINGS);
            let (r2, phi) = (place(i / RINGS), 2.0 * PI * place(i % RINGS));
            let (sin, cos) = libm::sincos(phi);
            let d = (x * cos + y * sin) * r2.sqrt() + self.up * (1.0 - r2).sqrt();
            sum = sum + self.at(d);
        }
        sum * (std::f32::consts::PI / (RINGS * RINGS) as f32)
    }

    /// The sky with a ground of this radiance.
    fn picture(&self, ground: Color) -> Image {
        let columns = 2 * ROWS;
        let pixel = |i: u32| {
            let place = |i: u32, n: u32| (i as f32 + 0.5) / n as f32;
            let d: Vector3 =
                Layout::LatitudeLongitude.direction([place(i % columns, columns), place(i / columns, ROWS)]);
            let d = d.to_f64();
            if d.dot(self.up) > 0.0 { self.at(d) } else { ground }.rgb
        };
        let values: Vec<[f32; 3]> = (0..columns * ROWS).into_par_iter().map(pixel).collect();
        Image { width: columns, height: ROWS, channels: 3, data: ImageData::F32(values.concat()) }
    }
}
