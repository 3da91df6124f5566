//! Pinhole camera.
//!
//! Rays start at the origin and pass the image plane `z = 1` at `tan(fov / 2) (x, y)`, where `(x, y)` is the film
//! position in the screen window (Physically Based Rendering, 4th edition, section 5.2.2). For a point at depth `z` seen at
//! angle `a` from the axis the ray is `z / cos a` long.
use durer_core::{
    math::{Point2, Point3, Ray, Vector3, float},
    sampling::Sampler,
};
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{
    Camera,
    screen::{ASPECT, SCREEN_WINDOW, Screen, UnitAxis},
    shutter::{SHUTTER_CLOSE, SHUTTER_OPEN},
};

/// A pinhole camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Perspective {
    screen: Screen,
    /// `tan(fov / 2)`.
    half: f32,
}

impl Camera for Perspective {
    fn fit(&mut self, width: u32, height: u32) {
        self.screen.fit(width, height);
    }
    fn ray(&self, film: Point2, time: f32, _sampler: &Sampler) -> Ray {
        let p = self.screen.at(film);
        let d = Vector3::new(p.x * self.half, p.y * self.half, 1.0).normalize();
        Ray { time, ..Ray::new(Point3::ZERO, d) }
    }
}

impl Kind for Perspective {
    type Output = Box<dyn Camera>;
    const SCHEMA: Schema = Schema {
        name: "perspective",
        aliases: &[],
        doc: "A pinhole camera at the origin of camera space, looking along +z.",
        params: &[
            ParamSpec::float("fov", 90.0, "Field of view, full angle; between 0 and 180.")
                .unit("deg")
                .range(0.0, 180.0),
            ParamSpec::new(
                "fovaxis",
                ParamType::Choice(&["shorter", "x", "y"]),
                ParamDefault::Text("shorter"),
                "The side of the picture that fov measures.",
            ),
            SCREEN_WINDOW,
            ASPECT,
            ParamSpec::float("lensradius", 0.0, "Radius of the lens; only 0 is supported.")
                .unit("m")
                .range(0.0, f32::INFINITY),
            ParamSpec::float("focaldistance", 1e6, "Depth of the plane in focus; without effect.")
                .unit("m")
                .range(0.0, f32::INFINITY),
            SHUTTER_OPEN,
            SHUTTER_CLOSE,
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let fov = args.float("fov");
        if fov == 0.0 || fov == 180.0 {
            args.error("fov", format!("\"fov\" is {fov}, expected an angle between 0 and 180 deg"));
        }
        if args.float("lensradius") > 0.0 {
            args.warning("lensradius", "depth of field is not supported yet; everything will be in focus");
        }
        let unit_axis = match args.text("fovaxis") {
            "x" => UnitAxis::X,
            "y" => UnitAxis::Y,
            _ => UnitAxis::Shorter,
        };
        let screen = Screen::read(args, unit_axis);
        let half = float::tan(fov.to_radians() * 0.5);
        args.is_sound().then(|| Box::new(Self { screen, half }) as Box<dyn Camera>)
    }
}
