//! A light without extent whose intensity in each direction a picture has, in pbrt-v4's equal-area octahedral map: the
//! light's +y is in its middle.
use std::f32::consts::PI;

use durer_core::{math::Vector3, spectrum::Color};
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{
    Cone, Light, POSITION, POWER,
    beam::{Beam, Pattern},
    infinite::Layout,
    picture::Picture,
    projection::factor,
};

/// The word `goniometric`.
#[derive(Debug)]
pub struct Goniometric;

/// The picture around the light.
#[derive(Debug)]
struct Globe {
    /// Shares of the intensity, grey.
    picture: Picture,
    integral: f32,
}

/// The mean of the three colours, as pbrt-v4 has it.
fn grey(color: Color) -> f32 {
    color.rgb.iter().sum::<f32>() / 3.0
}

impl Globe {
    fn new(picture: Picture) -> Self {
        let [width, height] = picture.size();
        let row = |y: u32| (0..width).map(|x| f64::from(grey(picture.pixel(x, y)))).sum::<f64>();
        let mean = (0..height).map(row).sum::<f64>() / (f64::from(width) * f64::from(height));
        Self { integral: 4.0 * PI * mean as f32, picture }
    }
}

impl Pattern for Globe {
    fn intensity(&self, d: Vector3) -> Color {
        let uv = Layout::EqualArea.uv(Vector3::new(d.x, d.z, d.y));
        Color::gray(grey(self.picture.nearest(uv)))
    }
    fn cone(&self) -> Cone {
        Cone::ALL
    }
    fn largest(&self) -> f32 {
        self.picture.largest()
    }
    fn integral(&self) -> f32 {
        self.integral
    }
}

impl Kind for Goniometric {
    type Output = Box<dyn Light>;
    const SCHEMA: Schema = Schema {
        name: "goniometric",
        aliases: &[],
        doc: "Shines from one point with an intensity that a picture has for each direction.",
        params: &[
            ParamSpec::color("I", [1.0; 3], "Intensity where the picture is 1.")
                .unit("W/sr")
                .range(0.0, f32::INFINITY),
            ParamSpec::new(
                "filename",
                ParamType::File,
                ParamDefault::Required,
                "A square picture in the equal-area octahedral map, of which the mean of the colours counts.",
            ),
            ParamSpec::float("scale", 1.0, "Factor on the intensity.").range(0.0, f32::INFINITY),
            POWER,
            POSITION,
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let picture = Picture::read(args, "filename");
        let intensity = args.light_color("I");
        if let Some([width, height]) = picture.as_ref().map(Picture::size).filter(|[w, h]| w != h) {
            let message = format!("the picture has {width} x {height} pixels: an equal-area map is square");
            args.error("filename", message);
        }
        if !args.is_sound() {
            return None;
        }
        let globe = Globe::new(picture.unwrap_or_else(Picture::placeholder));
        let factor = factor(args, globe.integral * intensity.luminance())?;
        Some(Box::new(Beam::new(args.triple("from").into(), globe, intensity * factor)))
    }
}
