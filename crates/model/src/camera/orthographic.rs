//! Parallel projection: rays start on the plane z = 0 of camera space at the film position in the screen window and run
//! along +z (Physically Based Rendering, 4th edition, section 5.2.1).
use durer_core::math::{Point2, Point3, Ray, Vector3};
use durer_scene::{Args, Kind, Schema};

use super::{
    Camera, Differential, Lens, Shutter, Sight,
    lens::LENS,
    screen::{ASPECT, SCREEN_WINDOW, Screen, UnitAxis},
    shutter::SHUTTER,
};

/// A camera infinitely far away.
#[derive(Clone, Debug, PartialEq)]
pub struct Orthographic {
    screen: Screen,
    lens: Lens,
    shutter: Shutter,
}

impl Camera for Orthographic {
    fn fit(&mut self, width: u32, height: u32) {
        self.screen.fit(width, height);
        // Only used without a focal length, which is refused.
        self.lens.fit(1.0);
    }
    fn ray(&self, film: Point2, lens: Point2, time: f32) -> Ray {
        let p = self.screen.at(film);
        self.lens.ray(Point3::new(p.x, p.y, 0.0), Vector3::new(0.0, 0.0, 1.0), lens, time)
    }
    fn differentials(&self, _: Vector3) -> [Differential; 2] {
        self.screen.steps().map(|o| Differential { o, d: Vector3::ZERO })
    }
    fn is_connectible(&self) -> bool {
        true
    }
    /// Rays through one point of the lens are parallel: what is not in focus is moved sideways.
    fn sees(&self, p: Point3, lens: Point2) -> Option<Sight> {
        if p.z <= 0.0 {
            return None;
        }
        let [x, y] = if self.lens.is_open() { self.lens.at(lens) } else { [0.0; 2] };
        let left = 1.0 - p.z / self.lens.focus();
        let at = Point2::new(p.x - x * left, p.y - y * left);
        let d = Vector3::new(-x, -y, self.lens.focus()).normalize();
        Some(Sight { from: Point3::new(at.x + x, at.y + y, 0.0), d, film: self.screen.film(at) })
    }
    /// The same at every distance: the picture's area, seen aslant.
    fn importance(&self, d: Vector3, _distance: f32) -> f32 {
        if d.z > 0.0 { 1.0 / (self.screen.area() * d.z) } else { 0.0 }
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

impl Kind for Orthographic {
    type Output = Box<dyn Camera>;
    const SCHEMA: Schema = Schema {
        name: "orthographic",
        aliases: &[],
        doc: "Parallel projection along +z of camera space. Without screenwindow the shorter side of the picture is 2 m.",
        params: &[
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
        let screen = Screen::read(args, UnitAxis::Shorter);
        let (lens, shutter) = (Lens::read(args), Shutter::read(args));
        if args.is_set("fnumber") && !args.is_set("focallength") {
            args.error(
                "fnumber",
                "\"fnumber\" needs \"float focallength\": parallel rays have no field of view",
            );
        }
        args.is_sound().then(|| Box::new(Self { screen, lens, shutter }) as Box<dyn Camera>)
    }
}
