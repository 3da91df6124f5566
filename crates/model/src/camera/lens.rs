//! The thin lens, of which all cameras have one: a ray starts anywhere on it and passes the point of the plane in focus
//! that the ray through its centre passes (Cook, Porter and Carpenter 1984; Physically Based Rendering, 4th edition,
//! section 5.2.3).
//!
//! A point at depth `z` is blurred to a disc of diameter `A |z - z_f| / z` on the plane in focus at depth `z_f`, with the
//! lens's diameter `A`. An f-number `N` stands for a diameter of `f / N`.
use std::f32::consts::{FRAC_PI_2, TAU};

use durer_core::{
    math::{
        Point2, Point3, Ray, Vector3,
        float::{cos, sin},
    },
    sampling::concentric_polar,
};
use durer_scene::{Args, ParamDefault, ParamSpec, ParamType};

/// Height of the film that a focal length is worked out for if none is given: that of a 35 mm camera.
const FILM_MM: f32 = 24.0;
/// Depth of the plane in focus unless told.
const FAR: f32 = 1e6;

const fn optional(name: &'static str, doc: &'static str) -> ParamSpec {
    ParamSpec::new(name, ParamType::Float, ParamDefault::Unset, doc).above(0.0, f32::INFINITY)
}

/// What a lens focuses on, in another way.
pub(super) const FOCUS_PIXEL: ParamSpec = ParamSpec::new(
    "focuspixel",
    ParamType::Point2s,
    ParamDefault::Unset,
    "Focus on what is seen there, in pixels of Film from the upper left corner, instead of at a distance.",
)
.unit("px");

/// The pixel of [`FOCUS_PIXEL`], if it is given; `distance` is the parameter that would say the same.
pub(super) fn focus_pixel(args: &mut Args<'_>, distance: &str) -> Option<Point2> {
    let pixel = match args.pairs("focuspixel")[..] {
        [] => None,
        [[x, y]] => Some(Point2::new(x, y)),
        ref other => {
            args.error("focuspixel", format!("\"focuspixel\" is {} points, expected one", other.len()));
            None
        }
    };
    if pixel.is_some() && args.is_set(distance) {
        let message = format!("both \"{distance}\" and \"focuspixel\" are given: each says what is in focus");
        args.error("focuspixel", message);
    }
    pixel
}

/// The parameters of a lens.
pub(super) const LENS: [ParamSpec; 7] = [
    ParamSpec::float("lensradius", 0.0, "Radius of the lens; 0 has everything in focus.")
        .unit("m")
        .range(0.0, f32::INFINITY),
    ParamSpec::float("focaldistance", FAR, "Depth of the plane in focus, along the camera's axis.")
        .unit("m")
        .above(0.0, f32::INFINITY),
    optional("fnumber", "The radius of the lens in another way: focal length by twice this number."),
    optional(
        "focallength",
        "Of the lens, for fnumber. Default: what gives the field of view on a film 24 mm high, focused far away.",
    )
    .unit("mm"),
    FOCUS_PIXEL,
    ParamSpec::new(
        "blades",
        ParamType::Int,
        ParamDefault::Int(0),
        "Corners of the aperture, which lie on the circle of the lens: 3 or more; 0 is round.",
    )
    .range(0.0, 64.0),
    ParamSpec::float("bladerotation", 0.0, "Turns the aperture counter-clockwise; at 0 a corner is at the top.")
        .unit("deg"),
];

/// A lens.
#[derive(Clone, Debug, PartialEq)]
pub struct Lens {
    radius: f32,
    /// Depth of the plane in focus.
    focus: f32,
    fnumber: Option<f32>,
    focal_mm: Option<f32>,
    focus_pixel: Option<Point2>,
    /// Corners of the aperture on the unit circle; none for a round one.
    corners: Vec<[f32; 2]>,
}

impl Lens {
    /// Of a pinhole.
    pub const CENTRE: Point2 = Point2::new(0.5, 0.5);

    /// From the parameters [`LENS`].
    pub(super) fn read(args: &mut Args<'_>) -> Self {
        let fnumber = args.optional_float("fnumber");
        if fnumber.is_some() && args.is_set("lensradius") {
            args.error(
                "fnumber",
                "both \"lensradius\" and \"fnumber\" are given: each says how wide the lens is",
            );
        }
        let focus_pixel = focus_pixel(args, "focaldistance");
        let focus = args.float("focaldistance");
        let blades = args.int("blades");
        if blades == 1 || blades == 2 {
            args.error(
                "blades",
                format!("\"blades\" is {blades}, expected 3 or more, or 0 for a round lens"),
            );
        }
        let top = FRAC_PI_2 + args.float("bladerotation").to_radians();
        let corner = |k: i32| {
            let angle = top + TAU * k as f32 / blades as f32;
            [cos(angle), sin(angle)]
        };
        let focal_mm = args.optional_float("focallength");
        let corners = (0..blades).map(corner).collect();
        Self { radius: args.float("lensradius"), focus, fnumber, focal_mm, focus_pixel, corners }
    }

    /// Of a camera that has no other.
    pub(super) fn pinhole() -> Self {
        let focus = FAR;
        Self { radius: 0.0, focus, fnumber: None, focal_mm: None, focus_pixel: None, corners: Vec::new() }
    }

    /// In front of glass that is traced: the radius of the light that gets in, and what is in focus.
    pub(super) fn behind(radius: f32, focus: f32, focus_pixel: Option<Point2>) -> Self {
        Self { radius, focus, focus_pixel, ..Self::pinhole() }
    }

    /// Finds the radius of an f-number; `slope` is the height of the picture at depth 1, by 2.
    pub(super) fn fit(&mut self, slope: f32) {
        if let Some(n) = self.fnumber {
            let focal_mm = self.focal_mm.unwrap_or(FILM_MM * 0.5 / slope);
            self.radius = focal_mm * 1e-3 / (2.0 * n);
        }
    }

    /// In metres; 0 for a pinhole.
    pub fn radius(&self) -> f32 {
        self.radius
    }
    /// Whether it blurs anything: numbers for points on it are wanted then.
    pub fn is_open(&self) -> bool {
        self.radius > 0.0
    }
    /// Depth of the plane in focus along the camera's axis, in metres.
    pub fn focus(&self) -> f32 {
        self.focus
    }
    /// Where the picture shows what shall be in focus, in pixels; who knows what is there says so by [`Lens::focus_at`].
    pub fn focus_pixel(&self) -> Option<Point2> {
        self.focus_pixel
    }
    /// Puts the plane in focus at a depth above 0, in metres.
    pub fn focus_at(&mut self, depth: f32) {
        self.focus = depth;
    }

    /// The point of the lens for `u` in `[0, 1)²`, in metres from its centre, to which the centre of the square goes.
    /// Evenly spread points stay evenly spread, and neighbours neighbours.
    pub fn at(&self, u: Point2) -> [f32; 2] {
        let (r, turn) = disk(u);
        let unit = match self.corners.len() {
            0 => [cos(turn * TAU), sin(turn * TAU)],
            n => {
                // A sector of the disk becomes the triangle between two corners: equal parts of it stay equal.
                let along = turn * n as f32;
                let k = (along as usize).min(n - 1);
                let (a, b, t) = (self.corners[k], self.corners[(k + 1) % n], along - k as f32);
                [a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t]
            }
        };
        unit.map(|v| v * r * self.radius)
    }

    /// The ray for `u` of what a pinhole at the lens's centre `o` (at depth 0) sees in direction `d`, which looks ahead.
    #[inline]
    pub(super) fn ray(&self, o: Point3, d: Vector3, u: Point2, time: f32) -> Ray {
        if !self.is_open() {
            return Ray { time, ..Ray::new(o, d) };
        }
        let [x, y] = self.at(u);
        let to_focus = d * (self.focus / d.z);
        let shift = Vector3::new(x, y, 0.0);
        Ray { time, ..Ray::new(o + shift, (to_focus - shift).normalize()) }
    }
}

/// The square to the unit disk: radius, and angle in turns from 0 to 1.
fn disk(u: Point2) -> (f32, f32) {
    let (r, angle) = concentric_polar(u);
    let turn = angle / TAU + if r < 0.0 { 0.5 } else { 0.0 };
    (r.abs(), if turn < 0.0 { turn + 1.0 } else { turn })
}
