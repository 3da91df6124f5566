//! A luminaire as its maker measured it: an IES file (ANSI/IES LM-63) of intensities by angle.
mod profile;
mod words;

use durer_core::{
    math::{Point3, Vector3},
    spectrum::Color,
};
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use self::profile::Profile;
use super::{
    Cone, Light, POSITION, POWER, axis,
    beam::{Beam, Pattern},
    projection::factor,
};

/// The word `ies`.
#[derive(Debug)]
pub struct Ies;

/// A profile, turned.
#[derive(Debug)]
struct Turned {
    profile: Profile,
    /// Unit vectors towards the angles 0 and 90 degrees across, and downward.
    axes: [Vector3; 3],
}

impl Pattern for Turned {
    fn intensity(&self, d: Vector3) -> Color {
        Color::gray(self.profile.at(Vector3::from(self.axes.map(|axis| axis.dot(d)))))
    }
    fn cone(&self) -> Cone {
        Cone { axis: self.axes[2], angle: self.profile.end() }
    }
    fn largest(&self) -> f32 {
        self.profile.largest()
    }
    fn integral(&self) -> f32 {
        self.profile.integral()
    }
}

impl Kind for Ies {
    type Output = Box<dyn Light>;
    const SCHEMA: Schema = Schema {
        name: "ies",
        aliases: &[],
        doc: "A luminaire that shines from one point as an IES file (LM-63, type C) of its maker says.",
        params: &[
            ParamSpec::new(
                "filename",
                ParamType::File,
                ParamDefault::Required,
                "The file; one candela counts as 1 W/sr in luminance.",
            ),
            ParamSpec::color("I", [1.0; 3], "Colour, a factor on the file's intensities.")
                .range(0.0, f32::INFINITY),
            ParamSpec::float("scale", 1.0, "Factor on the intensity.").range(0.0, f32::INFINITY),
            POWER,
            POSITION,
            ParamSpec::new(
                "to",
                ParamType::Point3,
                ParamDefault::Triple([0.0, 0.0, 1.0]),
                "Straight below the luminaire; its length lies across x as far as may be.",
            )
            .unit("m"),
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let bytes = args.file("filename");
        let color = args.light_color("I");
        let (from, to): (Point3, Point3) = (args.triple("from").into(), args.triple("to").into());
        let down = axis(args, from, to);
        if !args.is_sound() {
            return None;
        }
        let profile = match bytes.map_or_else(|| Ok(Profile::even()), |bytes| words::read(&bytes)) {
            Ok(profile) => profile,
            Err(reason) => {
                args.error("filename", format!("{}: {reason}", args.text("filename")));
                return None;
            }
        };
        let down = down?;
        let factor = factor(args, profile.integral() * color.luminance())?;
        let near =
            if down.x.abs() < 0.999 { Vector3::new(1.0, 0.0, 0.0) } else { Vector3::new(0.0, 1.0, 0.0) };
        let x = (near - down * near.dot(down)).normalize();
        let axes = [x, down.cross(x), down];
        Some(Box::new(Beam::new(from, Turned { profile, axes }, color * factor)))
    }
}
