//! Cameras with their film, filter and sampler.
use std::rc::Rc;

use durer_core::{
    glam::{DAffine3, DMat3, DVec3},
    math::Motion,
};
use durer_scene::{CameraDesc, Crop, Data, MediumInterface, Params, ValueType};

use super::{
    medium,
    object::Object,
    world::{World, node},
};

/// Cameras that ours are made from.
const SENSORS: [&str; 4] = ["perspective", "thinlens", "orthographic", "radiancemeter"];
/// Those that are none of a camera, and what to take instead.
const OTHERS: [(&str, &str); 4] = [
    (
        "irradiancemeter",
        "a radiancemeter, or an orthographic camera before a white diffuse surface there, measures light as well",
    ),
    ("distant", "an orthographic camera outside the scene that looks along \"direction\" sees the same"),
    ("batch", "give each of its sensors a file of its own"),
    ("fluencemeter", "light through a point is measured by a spherical camera of a .pbrt file"),
];
/// Half the width of what a meter sees, in metres: a ray.
const RAY: f32 = 1e-9;
/// Parameters of all.
const TAKES: &[&str] = &[
    "to_world",
    "near_clip",
    "far_clip",
    "fov",
    "fov_axis",
    "focal_length",
    "principal_point_offset_x",
    "principal_point_offset_y",
    "aperture_radius",
    "focus_distance",
    "shutter_open",
    "shutter_close",
];
/// Those of a meter.
const METER: &[&str] = &["to_world", "origin", "direction", "shutter_open", "shutter_close"];
/// Filters: theirs, ours, radius.
const FILTERS: [(&str, &str, f64); 6] = [
    ("box", "box", 0.5),
    ("tent", "triangle", 1.0),
    ("gaussian", "gaussian", 2.0),
    ("mitchell", "mitchell", 2.0),
    ("catmullrom", "mitchell", 2.0),
    ("lanczos", "sinc", 3.0),
];
/// Samplers.
const SAMPLERS: [&str; 6] = ["independent", "stratified", "multijitter", "orthogonal", "ldsampler", "halton"];

/// Adds the camera that `object` is; the first one's film is the picture.
pub(super) fn add(world: &mut World<'_>, object: &Rc<Object>) {
    if !SENSORS.contains(&object.plugin.as_str()) {
        match OTHERS.iter().find(|(name, _)| *name == object.plugin) {
            Some((name, instead)) => {
                world.said.error(object.at, format!("sensor \"{name}\" has no counterpart")).hint(*instead);
            }
            None => world.said.unknown(object.at, "sensor", &object.plugin, SENSORS),
        }
        return;
    }
    let is_meter = object.plugin == "radiancemeter";
    world.check(object, if is_meter { METER } else { TAKES }, &[]);
    for name in ["near_clip", "far_clip"] {
        if let Some(prop) = object.get(name) {
            world.note(prop.at, format!("\"{name}\" has no effect: nothing is clipped"));
        }
    }
    let (width, height) = film(world, object);
    let aspect = width / height;
    let placed = match is_meter {
        true => aimed(world, object),
        false => object.transform("to_world", world.said),
    };
    let media = world.of_tag(object, "medium").first().and_then(|o| medium::medium(world, o));
    let params = match object.plugin.as_str() {
        "radiancemeter" => {
            let window = [-RAY, RAY, -RAY, RAY].to_vec();
            Params::new().with("screenwindow", ValueType::Float, Data::Floats(window))
        }
        "orthographic" => {
            let window = [-1.0, 1.0, -1.0 / aspect, 1.0 / aspect].map(|v| v as f32);
            Params::new().with("screenwindow", ValueType::Float, Data::Floats(window.to_vec()))
        }
        _ => perspective(world, object, aspect),
    };
    let params = match object.plugin.as_str() {
        "thinlens" => {
            let radius = object.number_or("aperture_radius", 0.0, world.said) as f32;
            let focus = object.number_or("focus_distance", 1.0, world.said) as f32;
            params.float("lensradius", radius.max(0.0)).float("focaldistance", focus)
        }
        _ => params,
    };
    let params = match object.number("shutter_open", world.said) {
        Some(open) => params.float("shutteropen", open as f32),
        None => params,
    };
    let params = match object.number("shutter_close", world.said) {
        Some(close) => params.float("shutterclose", close as f32),
        None => params,
    };
    let is_flat = is_meter || object.plugin == "orthographic";
    let kind = if is_flat { "orthographic" } else { "perspective" };
    // Mitsuba's cameras have x to the left, ours to the right.
    let mirrored = placed * DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    world.desc.cameras.push(CameraDesc {
        name: object.id.clone(),
        node: node(kind, params, object.at),
        world_from_camera: Motion::still(mirrored),
        media: media.map(|outside| MediumInterface { inside: None, outside: Some(outside) }),
    });
}

/// Where the ray of a meter starts, and where z goes: by "origin" and "direction", or placed.
fn aimed(world: &mut World<'_>, object: &Object) -> DAffine3 {
    let [origin, direction] = ["origin", "direction"].map(|name| object.triple(name, world.said));
    let (Some(origin), Some(direction)) = (origin, direction) else {
        if origin.is_some() || direction.is_some() {
            world
                .said
                .error(object.at, "radiancemeter needs both \"origin\" and \"direction\", or \"to_world\"");
        }
        return object.transform("to_world", world.said);
    };
    match DVec3::from(direction).try_normalize() {
        Some(z) => {
            let (x, y) = z.any_orthonormal_pair();
            DAffine3::from_mat3_translation(DMat3::from_cols(x, y, z), origin.into())
        }
        None => {
            world.said.error(object.at, "\"direction\" of a radiancemeter is 0 0 0");
            DAffine3::IDENTITY
        }
    }
}

fn perspective(world: &mut World<'_>, object: &Object, aspect: f64) -> Params {
    let (fov, axis) = field_of_view(world, object, aspect);
    let params = Params::new().float("fov", fov as f32).string("fovaxis", axis);
    let [x, y] = ["principal_point_offset_x", "principal_point_offset_y"]
        .map(|name| object.number_or(name, 0.0, world.said));
    if x == 0.0 && y == 0.0 {
        return params;
    }
    // In units of half the axis that fov measures; offsets are shares of the picture, y downwards.
    let (w, h) = match axis {
        "x" => (1.0, 1.0 / aspect),
        "y" => (aspect, 1.0),
        _ if aspect < 1.0 => (1.0, 1.0 / aspect),
        _ => (aspect, 1.0),
    };
    let (dx, dy) = (2.0 * x * w, -2.0 * y * h);
    let window = [dx - w, dx + w, dy - h, dy + h].map(|v| v as f32);
    params.with("screenwindow", ValueType::Float, Data::Floats(window.to_vec()))
}

/// The angle in degrees, and the axis of ours that it measures.
fn field_of_view(world: &mut World<'_>, object: &Object, aspect: f64) -> (f64, &'static str) {
    let angle = |width: f64| 2.0 * (0.5 * width).atan().to_degrees();
    let across = |diagonal: f64| angle(diagonal / (1.0 + 1.0 / (aspect * aspect)).sqrt());
    if let Some(fov) = object.number("fov", world.said) {
        if fov <= 0.0 || fov >= 180.0 {
            let at = object.get("fov").map_or(object.at, |p| p.at);
            world.said.error(at, format!("\"fov\" is {fov}, expected an angle between 0 and 180 degrees"));
            return (50.0, "x");
        }
        return match object.word("fov_axis", &["x", "y", "diagonal", "smaller", "larger"], world.said) {
            "y" => (fov, "y"),
            "smaller" => (fov, "shorter"),
            "larger" => (fov, if aspect > 1.0 { "x" } else { "y" }),
            "diagonal" => (across(2.0 * (0.5 * fov.to_radians()).tan()), "x"),
            _ => (fov, "x"),
        };
    }
    let length = match object.text("focal_length", world.said) {
        Some(text) => {
            let at = object.get("focal_length").map_or(object.at, |p| p.at);
            let number =
                super::value::number(text.trim().trim_end_matches("mm")).and_then(|v| match v > 0.0 {
                    true => Ok(v),
                    false => Err(format!("\"focal_length\" is {text}, expected a length such as 50mm")),
                });
            super::value::told(number, at, world.said).unwrap_or(50.0)
        }
        None => 50.0,
    };
    // Of a film of 36 mm by 24 mm.
    (across(36f64.hypot(24.0) / length), "x")
}

/// The part of a film that is wanted.
const CROP: [&str; 4] = ["crop_offset_x", "crop_offset_y", "crop_width", "crop_height"];

fn crop(world: &mut World<'_>, film: &Object, (width, height): (f64, f64)) -> Option<Crop> {
    let [x, y, w, h] = CROP;
    let mut number = |name: &str, usual: f64| film.number_or(name, usual, world.said);
    let (x, y) = (number(x, 0.0), number(y, 0.0));
    let (w, h) = (number(w, width - x), number(h, height - y));
    let fits = x >= 0.0 && y >= 0.0 && w >= 1.0 && h >= 1.0 && x + w <= width && y + h <= height;
    if !fits {
        let message = format!("a part of {w} x {h} pixels from {x}, {y} on is not within {width} x {height}");
        world.said.error(film.at, message);
        return None;
    }
    let is_all = (w, h) == (width, height);
    (!is_all).then(|| Crop::Pixels([x, x + w, y, y + h].map(|edge| edge as u32)))
}

/// Reads the film, the filter in it and the sampler beside it; says how wide and high the picture is.
fn film(world: &mut World<'_>, sensor: &Object) -> (f64, f64) {
    const USUAL: (f64, f64) = (768.0, 576.0);
    let is_first = world.desc.cameras.is_empty();
    let film = world.of_tag(sensor, "film").into_iter().next();
    let mut size = USUAL;
    if let Some(film) = &film {
        if !["hdrfilm", "ldrfilm", "specfilm", "mfilm"].contains(&film.plugin.as_str()) {
            world.said.unknown(film.at, "film", &film.plugin, ["hdrfilm", "specfilm"]);
        }
        let idle = [
            "pixel_format",
            "component_format",
            "file_format",
            "banner",
            "sample_border",
            "compensate",
            "high_quality_edges",
            "attach_log",
            "fov_axis",
        ];
        let mut takes = vec!["width", "height"];
        takes.extend(idle);
        takes.extend(CROP);
        world.check(film, &takes, &[]);
        for prop in film.props.iter().filter(|p| idle.contains(&p.name.as_str())) {
            world.note(
                prop.at,
                format!("\"{}\" has no effect: options say how pictures are written", prop.name),
            );
        }
        size = (film.number_or("width", USUAL.0, world.said), film.number_or("height", USUAL.1, world.said));
        if !(1.0..=65536.0).contains(&size.0) || !(1.0..=65536.0).contains(&size.1) {
            world
                .said
                .error(film.at, format!("a picture of {} x {} pixels, expected 1 to 65536", size.0, size.1));
            size = USUAL;
        }
        if is_first {
            world.desc.film.crop = crop(world, film, size);
        }
    }
    if is_first {
        world.desc.film.width = Some(size.0 as u32);
        world.desc.film.height = Some(size.1 as u32);
        let own = film.and_then(|film| world.of_tag(&film, "rfilter").into_iter().next());
        filter(world, own.as_deref(), sensor);
        sampler(world, sensor);
    }
    size
}

fn filter(world: &mut World<'_>, object: Option<&Object>, sensor: &Object) {
    let at = object.map_or(sensor.at, |o| o.at);
    let word = object.map_or("gaussian", |o| o.plugin.as_str());
    let Some((_, kind, radius)) = FILTERS.iter().find(|(theirs, ..)| *theirs == word) else {
        world.said.unknown(at, "rfilter", word, FILTERS.iter().map(|f| f.0));
        return;
    };
    let mut number = |name: &str, usual: f64| object.map_or(usual, |o| o.number_or(name, usual, world.said));
    let (radius, params) = match word {
        "gaussian" => {
            let sigma = number("stddev", 0.5);
            // It ends where almost nothing is left of it.
            (4.0 * sigma, Params::new().float("sigma", sigma as f32))
        }
        "mitchell" => {
            let (b, c) = (number("A", 1.0 / 3.0), number("B", 1.0 / 3.0));
            (*radius, Params::new().float("B", b as f32).float("C", c as f32))
        }
        "catmullrom" => (*radius, Params::new().float("B", 0.0).float("C", 0.5)),
        "lanczos" => {
            let lobes = number("lobes", 3.0);
            (lobes, Params::new().float("tau", lobes as f32))
        }
        _ => (number("radius", *radius), Params::new()),
    };
    if let Some(object) = object {
        world.check(object, &["stddev", "A", "B", "lobes", "radius"], &[]);
    }
    let radius = radius.clamp(1e-3, 32.0) as f32;
    world.desc.filter = Some(node(kind, params.float("xradius", radius).float("yradius", radius), at));
}

fn sampler(world: &mut World<'_>, sensor: &Object) {
    let own = world.of_tag(sensor, "sampler").into_iter().next();
    let Some(object) = own else {
        world.desc.film.samples = Some(4);
        return;
    };
    if !SAMPLERS.contains(&object.plugin.as_str()) {
        world.said.unknown(object.at, "sampler", &object.plugin, SAMPLERS);
        return;
    }
    world.check(&object, &["sample_count", "seed", "jitter", "dimension", "strength"], &[]);
    let count = object.number_or("sample_count", 4.0, world.said);
    if !(1.0..=1e9).contains(&count) {
        world.said.error(object.at, format!("\"sample_count\" is {count}, expected 1 or more"));
        return;
    }
    world.desc.film.samples = Some(count as u32);
    // Ours of the same kind; those that spread samples evenly become the usual one, which does so best.
    let kind = if object.plugin == "independent" { "independent" } else { "zsobol" };
    if kind != object.plugin {
        world.note(object.at, format!("sampler \"{}\": \"{kind}\" is used", object.plugin));
    }
    world.desc.sampler = Some(node(kind, Params::new(), object.at));
}
