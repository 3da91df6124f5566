//! Central perspective through a thin lens, or a pinhole.
//!
//! Rays through the lens's centre start at the origin and pass the image plane `z = 1` at `tan(fov / 2) (x, y)`, where `(x, y)` is the film
//! position in the screen window (Physically Based Rendering, 4th edition, section 5.2.2). For a point at depth `z` seen at
//! angle `a` from the axis the ray is `z / cos a` long.
use durer_core::math::{
    Point2, Point3, Ray, Vector3,
    float::{self, sqr},
};
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{
    Camera, Differential, Lens, Shutter, Sight,
    lens::LENS,
    screen::{ASPECT, SCREEN_WINDOW, Screen, UnitAxis},
    shutter::SHUTTER,
};

/// A camera that sees as an eye does.
#[derive(Clone, Debug, PartialEq)]
pub struct Perspective {
    screen: Screen,
    /// `tan(fov / 2)`.
    half: f32,
    lens: Lens,
    shutter: Shutter,
}

impl Camera for Perspective {
    fn fit(&mut self, width: u32, height: u32) {
        self.screen.fit(width, height);
        self.lens.fit(self.half * self.screen.half_height());
    }
    fn ray(&self, film: Point2, lens: Point2, time: f32) -> Ray {
        let p = self.screen.at(film);
        let d = Vector3::new(p.x * self.half, p.y * self.half, 1.0).normalize();
        self.lens.ray(Point3::ZERO, d, lens, time)
    }
    /// The image plane is `1 / d.z` away along the ray; of a step on it counts what is perpendicular to the ray. Through
    /// another point of the lens everything is the same on the plane in focus.
    fn differentials(&self, d: Vector3) -> [Differential; 2] {
        self.screen.steps().map(|step| {
            let step = step * (self.half * d.z);
            Differential { o: Vector3::ZERO, d: step - d * d.dot(step) }
        })
    }
    fn is_connectible(&self) -> bool {
        true
    }
    /// Through the lens's centre goes what passes the plane in focus, or the one at depth 1, at the same place.
    fn sees(&self, p: Point3, lens: Point2) -> Option<Sight> {
        if p.z <= 0.0 {
            return None;
        }
        let [x, y] = if self.lens.is_open() { self.lens.at(lens) } else { [0.0; 2] };
        let from = Point3::new(x, y, 0.0);
        let d = (p - from).normalize();
        let seen = |own: f32, along: f32| (own / self.lens.focus() + along / d.z) / self.half;
        let at = Point2::new(seen(x, d.x), seen(y, d.y));
        Some(Sight { from, d, film: self.screen.film(at) })
    }
    /// The picture covers `A` of the plane at depth 1, and of any plane in focus as much by depth²: `1 / (A cos³ t²)`.
    fn importance(&self, d: Vector3, distance: f32) -> f32 {
        let covered = self.screen.area() * sqr(self.half);
        if d.z > 0.0 { 1.0 / (covered * sqr(d.z * distance) * d.z) } else { 0.0 }
    }
    fn lens(&self) -> &Lens {
        &self.lens
    }
    fn focus_at(&mut self, depth: f32) -> Result<(), String> {
        self.lens.focus_at(depth);
        Ok(())
    }
    fn shutter(&self) -> &Shutter {
        &self.shutter
    }
}

impl Kind for Perspective {
    type Output = Box<dyn Camera>;
    const SCHEMA: Schema = Schema {
        name: "perspective",
        aliases: &[],
        doc: "A camera at the origin of camera space, looking along +z.",
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
            LENS[0],
            LENS[1],
            LENS[2],
            LENS[3],
            LENS[4],
            LENS[5],
            LENS[6],
            SHUTTER[0],
            SHUTTER[1],
            SHUTTER[2],
            SHUTTER[3],
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let fov = args.float("fov");
        if fov == 0.0 || fov == 180.0 {
            args.error("fov", format!("\"fov\" is {fov}, expected an angle between 0 and 180 deg"));
        }
        let unit_axis = match args.text("fovaxis") {
            "x" => UnitAxis::X,
            "y" => UnitAxis::Y,
            _ => UnitAxis::Shorter,
        };
        let screen = Screen::read(args, unit_axis);
        let (lens, shutter) = (Lens::read(args), Shutter::read(args));
        let half = float::tan(fov.to_radians() * 0.5);
        args.is_sound().then(|| Box::new(Self { screen, half, lens, shutter }) as Box<dyn Camera>)
    }
}
