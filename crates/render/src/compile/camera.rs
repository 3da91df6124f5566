//! The camera of the picture: which one, with what lens, where, and what it focuses on.
use durer_core::{
    glam::{DAffine3, DVec3},
    math::{Interval, Motion, Point2},
    spectrum::Basis,
};
use durer_model::camera::{FilmBack, Lens, Shutter};
use durer_scene::{CameraDesc, Data, Diagnostics, Location, Param, Params, SceneDesc, ValueType};

use super::{CompileOptions, nodes};
use crate::{CameraPlacement, SampleCx, Scene, View, film::Sensor, probe::NoProbe};

/// Of a film that leaves pictures as they are.
const USUAL_ISO: f32 = 100.0;

/// How wide a lens is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Aperture {
    /// Its radius in metres; 0 has everything in focus.
    Radius(f32),
    /// Focal length by diameter.
    FNumber(f32),
}

/// What is in focus.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Focus {
    /// A plane at this depth along the camera's axis, in metres.
    Distance(f32),
    /// What is seen there, in pixels from the upper left corner.
    Pixel([f32; 2]),
}

/// What replaces the lens of whatever camera takes the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LensOptions {
    /// Its width; the camera's if `None`.
    pub aperture: Option<Aperture>,
    /// What is in focus; what the camera says if `None`.
    pub focus: Option<Focus>,
}

impl LensOptions {
    /// The camera with these parameters in place of those that say the same in its own way.
    pub fn given_to(self, camera: CameraDesc) -> CameraDesc {
        let is_glass = camera.node.kind == "realistic";
        let floats = |name: &str, ty: ValueType, values: &[f32]| Param {
            name: name.to_owned(),
            ty,
            data: Data::Floats(values.to_vec()),
            at: Location::None,
        };
        let aperture = self.aperture.map(|aperture| match aperture {
            Aperture::Radius(radius) if is_glass => {
                floats("aperturediameter", ValueType::Float, &[radius * 2e3])
            }
            Aperture::Radius(radius) => floats("lensradius", ValueType::Float, &[radius]),
            Aperture::FNumber(n) => floats("fnumber", ValueType::Float, &[n]),
        });
        let focus = self.focus.map(|focus| match focus {
            Focus::Distance(depth) if is_glass => floats("focusdistance", ValueType::Float, &[depth]),
            Focus::Distance(depth) => floats("focaldistance", ValueType::Float, &[depth]),
            Focus::Pixel(pixel) => floats("focuspixel", ValueType::Point2, &pixel),
        });
        let replaced = |name: &str| match name {
            "lensradius" | "aperturediameter" | "fnumber" => aperture.is_some(),
            "focaldistance" | "focusdistance" | "focuspixel" => focus.is_some(),
            _ => false,
        };
        let mut params = Params::new();
        camera.node.params.iter().filter(|p| !replaced(&p.name)).for_each(|p| params.push(p.clone()));
        aperture.into_iter().chain(focus).for_each(|p| params.push(p));
        CameraDesc { node: durer_scene::Node { params, ..camera.node }, ..camera }
    }
}

/// The camera the options name, else the first.
pub(super) fn chosen(
    desc: &SceneDesc,
    options: &CompileOptions,
    diagnostics: &mut Diagnostics,
) -> Option<CameraDesc> {
    let Some(wanted) = &options.camera else { return desc.cameras.first().cloned() };
    let by_name = desc.cameras.iter().find(|c| &c.name == wanted);
    let found = by_name.or_else(|| desc.cameras.get(wanted.parse::<usize>().ok()?));
    if found.is_none() {
        let names: Vec<String> = (0..desc.cameras.len())
            .map(|i| i.to_string())
            .chain(desc.cameras.iter().map(|c| c.name.clone()).filter(|n| !n.is_empty()))
            .collect();
        diagnostics.unknown(Location::None, "camera", wanted, names.iter().map(String::as_str));
    }
    found.cloned()
}

/// The camera placed, in a render space with this origin or where the camera is when the shutter opens; `things_move` tells
/// whether the picture depends on when it is taken even if the camera rests.
pub(super) fn view(
    nodes: &mut nodes::Builder<'_>,
    desc: &CameraDesc,
    options: &CompileOptions,
    (things_move, origin): (bool, Option<DVec3>),
) -> Option<View> {
    let filter = nodes.filter();
    let mut camera = nodes.camera(&desc.node)?;
    let film = &nodes.desc.film;
    let diagonal = film.diagonal_mm.map_or(FilmBack::default().diagonal, |mm| mm * 1e-3);
    let speed = film.iso.unwrap_or(USUAL_ISO) / USUAL_ISO * film.exposure_seconds.unwrap_or(1.0);
    camera.load(FilmBack { diagonal });
    camera.fit(options.width, options.height);
    let moves = things_move || !desc.world_from_camera.is_still();
    let shutter = shutter(camera.shutter(), moves, options);
    let at_opening = desc.world_from_camera.at(shutter.interval().min.into());
    let world_from_render = origin.unwrap_or(at_opening.translation);
    let render_from_world = DAffine3::from_translation(-world_from_render);
    let motion = match shutter.sees_one_moment() {
        true => Motion::still(render_from_world * at_opening),
        false => desc.world_from_camera.within(&render_from_world),
    };
    let Some(placement) = CameraPlacement::from_motion(&motion) else {
        nodes.diagnostics.error(desc.node.at.clone(), "the camera's transform cannot be inverted");
        return None;
    };
    Some(View {
        camera,
        placement,
        world_from_render,
        width: options.width,
        height: options.height,
        shutter,
        filter: filter?,
        speed,
        sensor: Sensor::new(film.white_balance, film.max_component_value),
        layers: None,
    })
}

/// When the shutter is open: as the options say, else as the camera says; a moment if nothing moves.
fn shutter(own: &Shutter, moves: bool, options: &CompileOptions) -> Shutter {
    let after = |asked: Interval| Interval::new(options.time + asked.min, options.time + asked.max);
    match (options.shutter, moves) {
        (Some(asked), _) => own.during(after(asked)),
        (None, true) => own.during(after(own.interval())),
        (None, false) => Shutter::instant(options.time),
    }
}

/// Pixels of the picture by pixels of the camera's `focuspixel`: a scene speaks of the picture that it asks for, whatever
/// its size becomes, the options of the one that is taken.
pub(super) fn pixel_scale(desc: &SceneDesc, options: &CompileOptions) -> [f32; 2] {
    let by = |size: u32, asked: Option<u32>| asked.map_or(1.0, |asked| size as f32 / asked.max(1) as f32);
    match options.lens.focus {
        Some(_) => [1.0; 2],
        None => [by(options.width, desc.film.width), by(options.height, desc.film.height)],
    }
}

/// Focuses on what is seen in the pixel that the camera names, in the middle of the exposure; `None` after a complaint if
/// nothing is. `scale` is that of [`pixel_scale`].
pub(super) fn focus(
    scene: &mut Scene,
    scale: [f32; 2],
    at: Location,
    diagnostics: &mut Diagnostics,
) -> Option<()> {
    let view = &scene.view;
    let Some(pixel) = view.camera.lens().focus_pixel() else { return Some(()) };
    let (x, y) = (pixel.x * scale[0], pixel.y * scale[1]);
    let row = (y.max(0.0) as u32).min(view.height - 1);
    let ray = view.ray(Point2::new(x, y), Lens::CENTRE, view.shutter.moment(0.5, row, view.height));
    let cx = SampleCx { scene, basis: Basis::Rgb };
    let Some(hit) = scene.closest(&cx, &ray, &mut NoProbe, ()) else {
        let message = format!("nothing is seen at {x},{y} that the lens could focus on");
        let size = format!("the picture is {} x {} pixels", view.width, view.height);
        diagnostics.error(at, message).hint(format!("name a pixel that shows a surface; {size}"));
        return None;
    };
    let camera_from_render = view.render_from_camera(ray.time).inverse();
    let depth = camera_from_render.point(ray.at(hit.t)).z;
    let focused = scene.view.camera.focus_at(depth);
    focused
        .map_err(|why| diagnostics.error(at, format!("what is seen at {x},{y} is {depth} m away: {why}")))
        .ok()
        .map(|_| ())
}
