//! Parallel projection: rays start on the plane z = 0 of camera space at the film position in the screen window and run
//! along +z (Physically Based Rendering, 4th edition, section 5.2.1).
use durer_core::{
    math::{Point2, Point3, Ray, Vector3},
    sampling::Sampler,
};
use durer_scene::{Args, Kind, Schema};

use super::{
    Camera,
    screen::{ASPECT, SCREEN_WINDOW, Screen, UnitAxis},
    shutter::{SHUTTER_CLOSE, SHUTTER_OPEN},
};

/// A camera infinitely far away.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orthographic {
    screen: Screen,
}

impl Camera for Orthographic {
    fn fit(&mut self, width: u32, height: u32) {
        self.screen.fit(width, height);
    }
    fn ray(&self, film: Point2, time: f32, _sampler: &Sampler) -> Ray {
        let p = self.screen.at(film);
        Ray { time, ..Ray::new(Point3::new(p.x, p.y, 0.0), Vector3::new(0.0, 0.0, 1.0)) }
    }
}

impl Kind for Orthographic {
    type Output = Box<dyn Camera>;
    const SCHEMA: Schema = Schema {
        name: "orthographic",
        aliases: &[],
        doc: "Parallel projection along +z of camera space. Without screenwindow the shorter side of the picture is 2 m.",
        params: &[SCREEN_WINDOW, ASPECT, SHUTTER_OPEN, SHUTTER_CLOSE],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let screen = Screen::read(args, UnitAxis::Shorter);
        args.is_sound().then(|| Box::new(Self { screen }) as Box<dyn Camera>)
    }
}
