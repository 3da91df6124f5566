//! A camera that looks through a lens of glass, surface by surface (Kolb, Mitchell and Hanrahan 1995, "A Realistic Camera
//! Model for Computer Graphics").
//!
//! The film lies at the origin of camera space; the picture on it is upside down, as in all cameras, and is turned when it is
//! shown. What a point of the film receives is `integral of L cos^4 / z^2 dA` over the exit pupil, `z` in front of it:
//! vignetting, the fall-off towards the corners and all aberrations but those of colour are there. Indices of refraction are
//! the same for all wavelengths.
mod glass;
mod paraxial;
mod prescription;
mod pupil;
mod stop;

use durer_core::{
    glam::DVec3,
    math::{Point2, Point3, Ray, Vector3},
};
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{Camera, EyeRay, FilmBack, Lens, Shutter, lens::FOCUS_PIXEL, shutter::SHUTTER};
use glass::{Glass, Interface, Through};
use paraxial::Paraxial;
use pupil::Pupils;
use stop::Stop;

/// Points of the pupil for the light in the middle of the picture.
const CENTRE_POINTS: u32 = 1 << 14;
/// Steps of the sequence that they are: powers of 1 by the root of x^3 = x + 1 (Roberts 2018, "The Unreasonable
/// Effectiveness of Quasirandom Sequences").
const GOLDEN: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_3];

/// How bright pictures are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Exposure {
    /// What falls onto the film while the shutter is open, as in pbrt-v4.
    Film,
    /// An even scene is as bright in the middle of the picture as seen without a lens.
    Even,
}

/// A camera with a lens of glass.
#[derive(Clone, Debug)]
pub struct Realistic {
    paraxial: Paraxial,
    glass: Glass,
    stop: Stop,
    exposure: Exposure,
    /// The film's diagonal in metres.
    diagonal: f64,
    /// The picture's size on the film, in metres.
    size: [f64; 2],
    /// From the rearmost surface to the film, in metres.
    film: f64,
    pupils: Pupils,
    /// What light on the film counts in the picture.
    gain: f64,
    lens: Lens,
    shutter: Shutter,
}

impl Realistic {
    /// Looks for the exit pupils behind the lens where it is.
    fn look_back(&mut self) {
        self.pupils = Pupils::new(&self.glass, self.film, self.diagonal);
        let interval = self.shutter.interval();
        self.gain = match self.exposure {
            Exposure::Film => f64::from(interval.max - interval.min),
            Exposure::Even => match self.light([0.0; 2]) {
                light if light > 0.0 => 1.0 / light,
                _ => 0.0,
            },
        };
    }

    /// What a point of the film receives of an even scene of radiance 1.
    fn light(&self, film: [f64; 2]) -> f64 {
        let points = (0..CENTRE_POINTS).map(|i| {
            let [u, v] = GOLDEN.map(|step| ((f64::from(i) + 0.5) * step).fract() as f32);
            Point2::new(u, v)
        });
        points.filter_map(|u| self.traced(film, u)).map(|(_, light)| light).sum::<f64>()
            / f64::from(CENTRE_POINTS)
    }

    /// The place on the film that shows a place of the picture, in metres.
    fn on_film(&self, at: Point2) -> [f64; 2] {
        [self.size[0] * (0.5 - f64::from(at.x)), self.size[1] * (f64::from(at.y) - 0.5)]
    }

    /// The way through the glass from a place of the film for `u` in `[0, 1)²`, and what its radiance counts on the film.
    fn traced(&self, film: [f64; 2], u: Point2) -> Option<(Through, f64)> {
        let ([x, y], area) = self.pupils.sample(film, u)?;
        let from = DVec3::new(film[0], film[1], 0.0);
        let d = DVec3::new(x, y, self.film) - from;
        let through = self.glass.trace(self.film, from, d)?;
        let passed = self.stop.at(through.at_stop);
        let cos_squared = self.film * self.film / d.length_squared();
        let light = passed * cos_squared * cos_squared * area / (self.film * self.film);
        (light > 0.0).then_some((through, light))
    }

    /// What a pinhole in the middle of the front surface would see: where the lens shows nothing.
    fn pinhole(&self, film: [f64; 2], time: f32) -> Ray {
        let d = DVec3::new(-film[0], -film[1], self.film + self.glass.length()).normalize();
        let o = DVec3::new(0.0, 0.0, self.film + self.glass.length());
        Ray { time, ..Ray::new(Point3::from_f64(o), Vector3::from_f64(d)) }
    }
}

impl Camera for Realistic {
    fn load(&mut self, film: FilmBack) {
        self.diagonal = film.diagonal.into();
    }
    fn fit(&mut self, width: u32, height: u32) {
        let aspect = f64::from(height.max(1)) / f64::from(width.max(1));
        let x = self.diagonal / (1.0 + aspect * aspect).sqrt();
        self.size = [x, aspect * x];
        self.look_back();
    }
    fn ray(&self, film: Point2, lens: Point2, time: f32) -> Ray {
        self.eye(film, lens, time).ray
    }
    fn eye(&self, film: Point2, lens: Point2, time: f32) -> EyeRay {
        let film = self.on_film(film);
        match self.traced(film, lens) {
            Some((Through { o, d, .. }, light)) => EyeRay {
                ray: Ray { time, ..Ray::new(Point3::from_f64(o), Vector3::from_f64(d).normalize()) },
                weight: (light * self.gain) as f32,
            },
            None => EyeRay { ray: self.pinhole(film, time), weight: 0.0 },
        }
    }
    fn on_lens(&self, film: Point2, u: Point2) -> [f32; 2] {
        let o = self.ray(film, u, 0.0).o;
        [o.x, o.y]
    }
    fn focus_at(&mut self, depth: f32) -> Result<(), String> {
        self.film = self.paraxial.film(depth.into())?;
        self.lens.focus_at(depth);
        self.look_back();
        Ok(())
    }
    fn lens(&self) -> &Lens {
        &self.lens
    }
    fn shutter(&self) -> &Shutter {
        &self.shutter
    }
}

const LENS_FILE: ParamSpec = ParamSpec::new(
    "lensfile",
    ParamType::File,
    ParamDefault::Required,
    "The lens: a row for each surface from the scene to the film, with radius of curvature (0 is the aperture stop), way to \
     the next surface, index of refraction behind (0 is air) and diameter, in mm.",
);
/// Diameter of the stop unless told, in millimetres; pbrt's.
const DIAMETER_MM: f32 = 1.0;

impl Kind for Realistic {
    type Output = Box<dyn Camera>;
    const SCHEMA: Schema = Schema {
        name: "realistic",
        aliases: &[],
        doc: "Looks through a lens of glass, surface by surface, from the film at the origin of camera space along +z.",
        params: &[
            LENS_FILE,
            ParamSpec::float("aperturediameter", DIAMETER_MM, "Of the stop; at most that of the file.")
                .unit("mm")
                .above(0.0, f32::INFINITY),
            ParamSpec::new(
                "fnumber",
                ParamType::Float,
                ParamDefault::Unset,
                "The diameter of the stop in another way: focal length by that of the entrance pupil.",
            )
            .above(0.0, f32::INFINITY),
            ParamSpec::float("focusdistance", 10.0, "From the film to what is in focus.")
                .unit("m")
                .range(0.0, f32::INFINITY),
            FOCUS_PIXEL,
            ParamSpec::new(
                "aperture",
                ParamType::File,
                ParamDefault::Text("circular"),
                "Shape of the stop: circular, gaussian, square, pentagon, star, or a picture of what it lets through.",
            ),
            ParamSpec::new(
                "exposure",
                ParamType::Choice(&["film", "even"]),
                ParamDefault::Text("film"),
                "film: as much light as falls onto the film while the shutter is open, as in pbrt-v4; the film's iso makes up \
                 for it. even: an even scene is as bright in the middle of the picture as without a lens.",
            ),
            SHUTTER[0],
            SHUTTER[1],
            SHUTTER[2],
            SHUTTER[3],
        ],
    };

    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let bytes = args.file("lensfile");
        let stop = Stop::read(args);
        let focus_pixel = super::lens::focus_pixel(args, "focusdistance");
        let shutter = Shutter::read(args);
        let exposure = if args.text("exposure") == "even" { Exposure::Even } else { Exposure::Film };
        let mut surfaces = match (bytes.map(|bytes| prescription::read(&bytes)), args.is_sound()) {
            (_, false) => return None,
            (Some(Ok(surfaces)), _) => surfaces,
            (found, _) => {
                let why =
                    found.and_then(Result::err).unwrap_or_else(|| "no camera without its lens".to_owned());
                args.error("lensfile", format!("{}: {why}", args.text("lensfile")));
                return None;
            }
        };
        let Some(paraxial) = Paraxial::new(&surfaces) else {
            let message = format!("{}: this lens gathers no parallel light", args.text("lensfile"));
            args.error("lensfile", message);
            return None;
        };
        let entrance = set_stop(args, &mut surfaces, &paraxial);
        let focus = args.float("focusdistance");
        let film = match paraxial.film(focus.into()) {
            Ok(film) => film,
            Err(why) => {
                args.error("focusdistance", format!("\"focusdistance\" is {focus} m: {why}"));
                return None;
            }
        };
        let glass = Glass::new(&surfaces);
        let diagonal = f64::from(FilmBack::default().diagonal);
        let lens = Lens::behind(entrance as f32, focus, focus_pixel);
        let new = Self {
            paraxial,
            glass,
            stop: stop?,
            exposure,
            diagonal,
            size: [0.0; 2],
            film,
            pupils: Pupils::default(),
            gain: 1.0,
            lens,
            shutter,
        };
        args.is_sound().then(|| Box::new(new) as Box<dyn Camera>)
    }
}

/// Sets the diameter of the stop, if there is one; the radius of the entrance pupil, in metres.
fn set_stop(args: &mut Args<'_>, surfaces: &mut [Interface], paraxial: &Paraxial) -> f64 {
    let fnumber = args.optional_float("fnumber");
    if fnumber.is_some() && args.is_set("aperturediameter") {
        let message = "both \"aperturediameter\" and \"fnumber\" are given: each says how wide the stop is";
        args.error("fnumber", message);
    }
    let word = if fnumber.is_some() { "fnumber" } else { "aperturediameter" };
    let radius = match fnumber {
        Some(n) => paraxial.focal / (2.0 * f64::from(n)) * paraxial.at_stop.abs(),
        None => f64::from(args.float("aperturediameter")) * 0.5e-3,
    };
    if !(radius > 0.0 && radius.is_finite()) {
        args.error(word, format!("\"{word}\" gives the stop a radius of {radius} m"));
    }
    let Some(stop) = surfaces.iter_mut().find(|s| s.is_stop()) else {
        if args.is_set(word) {
            args.warning(word, format!("\"{word}\" has no effect: the lens has no aperture stop (radius 0)"));
        }
        return surfaces.first().map_or(0.0, |front| front.radius);
    };
    if radius > stop.radius && args.is_set(word) {
        let (asked, widest) = (2e3 * radius, 2e3 * stop.radius);
        let message =
            format!("the stop would be {asked:.4} mm wide; it opens to {widest:.4} mm, which is taken");
        args.warning(word, message);
    }
    stop.radius = stop.radius.min(radius);
    stop.radius / paraxial.at_stop.abs()
}
