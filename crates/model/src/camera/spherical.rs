//! A camera that sees all around: every direction has its place in the picture (Physically Based Rendering, 4th edition,
//! section 5.3). Up is +y of camera space; an infinite light's pictures have the same layouts about z.
use std::f32::consts::PI;

use durer_core::math::{Point2, Point3, Ray, Vector3, float::sqr};
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{
    Camera, Lens, Shutter, Sight,
    lens::LENS,
    screen::{ASPECT, SCREEN_WINDOW},
    shutter::SHUTTER,
};
use crate::light::infinite::layout::Layout;

/// A camera at the middle of the sphere that its picture covers.
#[derive(Clone, Debug, PartialEq)]
pub struct Spherical {
    layout: Layout,
    lens: Lens,
    shutter: Shutter,
}

/// Parameters that pbrt-v4 takes for all its cameras.
const WITHOUT_EFFECT: [ParamSpec; 4] = [SCREEN_WINDOW, ASPECT, LENS[0], LENS[1]];

/// The same place of the octahedral map inside the picture, for one beyond an edge, where filters ask too: what lies beyond
/// an edge lies within it as well, mirrored about the middle of the edge.
fn within(Point2 { x, y }: Point2) -> [f32; 2] {
    let fold = |u: f32| if u < 0.0 { -u } else { 2.0 - u };
    let outside = |u: f32| !(0.0..=1.0).contains(&u);
    let (x, y) = if outside(x) { (fold(x), 1.0 - y) } else { (x, y) };
    if outside(y) { [1.0 - x, fold(y)] } else { [x, y] }
}

impl Camera for Spherical {
    fn fit(&mut self, _width: u32, _height: u32) {}
    fn ray(&self, film: Point2, _lens: Point2, time: f32) -> Ray {
        let place = match self.layout {
            // Beyond the poles and the seam the angles go on by themselves.
            Layout::EqualArea => within(film),
            _ => [film.x, film.y],
        };
        let d = self.layout.direction(place);
        Ray { time, ..Ray::new(Point3::ZERO, Vector3::new(d.x, d.z, d.y).normalize()) }
    }
    fn is_connectible(&self) -> bool {
        true
    }
    fn sees(&self, p: Point3, _lens: Point2) -> Option<Sight> {
        let d = p - Point3::ZERO;
        (d.length_squared() > 0.0).then(|| {
            let d = d.normalize();
            let [x, y] = self.layout.uv(Vector3::new(d.x, d.z, d.y));
            Sight { from: Point3::ZERO, d, film: Point2::new(x, y) }
        })
    }
    /// Of the equal-area map the same everywhere, `1 / 4 pi`; of the other `1 / (2 pi² sin)`, for the angle from the zenith.
    fn importance(&self, d: Vector3, distance: f32) -> f32 {
        let density = match self.layout {
            Layout::EqualArea => 0.25 / PI,
            _ => 0.5 / (sqr(PI) * (sqr(d.x) + sqr(d.z)).sqrt()),
        };
        density / sqr(distance)
    }
    fn repeats(&self, Point2 { x, y }: Point2) -> Vec<Point2> {
        let places = match self.layout {
            // Beyond the seam, and beyond the poles half a turn away.
            Layout::LatitudeLongitude | Layout::PoleToPole(_) => {
                let turned = if x < 0.5 { x + 0.5 } else { x - 0.5 };
                let beside = |x: f32, y: f32| [[x - 1.0, y], [x, y], [x + 1.0, y]];
                [beside(x, y), beside(turned, -y), beside(turned, 2.0 - y)].concat()
            }
            Layout::EqualArea => {
                let edges = [[-x, 1.0 - y], [2.0 - x, 1.0 - y], [1.0 - x, -y], [1.0 - x, 2.0 - y]];
                let corners =
                    [[x - 1.0, y - 1.0], [x + 1.0, y - 1.0], [x - 1.0, y + 1.0], [x + 1.0, y + 1.0]];
                [edges, corners].concat()
            }
        };
        places.into_iter().filter(|at| *at != [x, y]).map(|[x, y]| Point2::new(x, y)).collect()
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

impl Kind for Spherical {
    type Output = Box<dyn Camera>;
    const SCHEMA: Schema = Schema {
        name: "spherical",
        aliases: &[],
        doc: "Sees all around from the origin of camera space, in focus everywhere; up is +y. The parameters of lens and \
              screen have no effect: they are taken as pbrt-v4 takes them.",
        params: &[
            ParamSpec::new(
                "mapping",
                ParamType::Choice(&["equalarea", "equirectangular"]),
                ParamDefault::Text("equalarea"),
                "Where directions lie in the picture. equalarea: an octahedron unfolded, +y in the middle, -y in the four \
                 corners, every pixel of the same solid angle; for square pictures. equirectangular: longitude across, from \
                 +x by +z, which shows the world mirrored, and the angle from +y downwards; for pictures twice as wide as \
                 high.",
            ),
            WITHOUT_EFFECT[0],
            WITHOUT_EFFECT[1],
            WITHOUT_EFFECT[2],
            WITHOUT_EFFECT[3],
            SHUTTER[0],
            SHUTTER[1],
            SHUTTER[2],
            SHUTTER[3],
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let layout = match args.text("mapping") {
            "equirectangular" => Layout::LatitudeLongitude,
            _ => Layout::EqualArea,
        };
        for ParamSpec { name, .. } in WITHOUT_EFFECT {
            if args.is_set(name) {
                args.warning(name, format!("\"{name}\" has no effect on a spherical camera"));
            }
        }
        let shutter = Shutter::read(args);
        args.is_sound().then(|| Box::new(Self { layout, lens: Lens::pinhole(), shutter }) as Box<dyn Camera>)
    }
}
