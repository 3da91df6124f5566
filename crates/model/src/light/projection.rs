//! A picture thrown from a point, as by a slide projector: along +z, x to the right and y up.
//!
//! The intensity in the direction of a pixel is that of the pixel (pbrt-v4's meaning): a wall across the axis gets
//! `I cos^3 / z²`. The power is the sum of the pixels by their solid angles: seen from distance 1, the rectangle between the
//! axis and `(x, y)` has `atan(x y / sqrt(1 + x² + y²))`.
use durer_core::{
    math::{
        Vector3,
        float::{atan2, tan},
    },
    spectrum::Color,
};
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{
    Cone, Light, POSITION, POWER,
    beam::{Beam, Pattern},
    picture::Picture,
    spot,
};

/// The word `projection`.
#[derive(Debug)]
pub struct Projection;

/// The picture at distance 1 in front of the light.
#[derive(Debug)]
struct Slide {
    picture: Picture,
    /// Half its width and height.
    half: [f32; 2],
    /// A cone that it is seen through.
    mask: Option<spot::Cone>,
    integral: f32,
}

impl Slide {
    fn new(picture: Picture, (fov, aspect): (f32, Option<f32>), mask: Option<spot::Cone>) -> Self {
        let opening = tan(0.5 * fov.to_radians());
        let [width, height] = picture.size().map(|n| n as f32);
        let aspect = aspect.unwrap_or(width / height);
        let half = [opening * aspect.max(1.0), opening * (1.0 / aspect).max(1.0)];
        let mut slide = Self { picture, half, mask, integral: 0.0 };
        slide.integral = slide.sum();
        slide
    }
    fn sum(&self) -> f32 {
        let [width, height] = self.picture.size();
        let edge = |i: u32, n: u32, half: f32| f64::from(half) * (2.0 * f64::from(i) / f64::from(n) - 1.0);
        let upto = |x: f64, y: f64| libm::atan2(x * y, (1.0 + x * x + y * y).sqrt());
        let mut sum = 0.0;
        for j in 0..height {
            let y = [j, j + 1].map(|j| edge(j, height, self.half[1]));
            for i in 0..width {
                let x = [i, i + 1].map(|i| edge(i, width, self.half[0]));
                let angle = upto(x[1], y[1]) - upto(x[0], y[1]) - upto(x[1], y[0]) + upto(x[0], y[0]);
                let middle = Vector3::from_f64([x[0] + x[1], y[0] + y[1], 2.0].into()).normalize();
                sum += f64::from(self.picture.pixel(i, j).luminance() * self.share(middle)) * angle;
            }
        }
        sum as f32
    }
    /// What the mask leaves in a unit direction.
    fn share(&self, d: Vector3) -> f32 {
        self.mask.map_or(1.0, |cone| cone.share(d.z))
    }
}

impl Pattern for Slide {
    fn intensity(&self, d: Vector3) -> Color {
        let [w, h] = self.half;
        if d.z <= 0.0 || d.x.abs() > w * d.z || d.y.abs() > h * d.z {
            return Color::BLACK;
        }
        let seen = self.picture.nearest([0.5 + 0.5 * d.x / (w * d.z), 0.5 - 0.5 * d.y / (h * d.z)]);
        seen * self.share(d)
    }
    fn cone(&self) -> Cone {
        let [w, h] = self.half;
        Cone { axis: Vector3::new(0.0, 0.0, 1.0), angle: atan2((w * w + h * h).sqrt(), 1.0) * (1.0 + 1e-6) }
    }
    fn largest(&self) -> f32 {
        self.picture.largest()
    }
    fn integral(&self) -> f32 {
        self.integral
    }
}

impl Kind for Projection {
    type Output = Box<dyn Light>;
    const SCHEMA: Schema = Schema {
        name: "projection",
        aliases: &[],
        doc: "Throws a picture from one point along +z, like a slide projector.",
        params: &[
            ParamSpec::new(
                "filename",
                ParamType::File,
                ParamDefault::Required,
                "The picture, whose pixels are intensities in W/sr: floats are linear, integers sRGB-encoded.",
            ),
            ParamSpec::float("fov", 90.0, "Angle between the shorter picture's edges.")
                .unit("degrees")
                .range(0.01, 179.0),
            ParamSpec::new(
                "aspect",
                ParamType::Float,
                ParamDefault::Unset,
                "Width by height of the picture as it is thrown; default: its own.",
            )
            .above(0.0, f32::INFINITY),
            ParamSpec::new(
                "coneangle",
                ParamType::Float,
                ParamDefault::Unset,
                "Angle between the axis and a cone outside of which nothing is thrown.",
            )
            .unit("degrees")
            .range(0.0, 180.0),
            ParamSpec::float("conedeltaangle", 0.0, "Width of the fading rim inside that cone.")
                .unit("degrees")
                .range(0.0, 180.0),
            spot::Cone::RIM,
            ParamSpec::float("scale", 1.0, "Factor on the intensity.").range(0.0, f32::INFINITY),
            ParamSpec { doc: "Total power; replaces the magnitude of the picture.", ..POWER },
            POSITION,
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let picture = Picture::read(args, "filename");
        if !args.is_sound() {
            return None;
        }
        let is_linear = args.text(spot::Cone::RIM.name) == "linear";
        let outer = args.optional_float("coneangle");
        let mask = outer.map(|outer| spot::Cone::new(outer, args.float("conedeltaangle"), is_linear));
        let slide = Slide::new(
            picture.unwrap_or_else(Picture::placeholder),
            (args.float("fov"), args.optional_float("aspect")),
            mask,
        );
        let factor = factor(args, slide.integral)?;
        Some(Box::new(Beam::new(args.triple("from").into(), slide, Color::gray(factor).into())))
    }
}

/// The parameter `scale`, by what `power` makes of a light of this power; complains if that has none.
pub(super) fn factor(args: &mut Args<'_>, integral: f32) -> Option<f32> {
    let scale = args.float("scale");
    match args.optional_float("power") {
        Some(_) if integral <= 0.0 => {
            args.error("power", "the light is black: no factor gives it \"power\"");
            None
        }
        Some(power) => Some(scale * power / integral),
        None => Some(scale),
    }
}
