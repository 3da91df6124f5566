//! Lights.
use std::{rc::Rc, sync::Arc};

use durer_core::{
    glam::{DAffine3, DMat3, DVec3},
    math::Motion,
};
use durer_scene::{Data, LightDesc, Node, Params, ValueType};

use super::{
    object::{Object, Value},
    world::{Plugin, Role, Shade, World, node},
};

/// Makes kind, parameters and placement of each light that a plugin stands for.
type Build = fn(&mut World<'_>, &Object) -> Vec<(&'static str, Params, DAffine3)>;

/// Lights that are no surface.
const EMITTERS: &[Plugin<Build>] = &[
    Plugin {
        name: "point",
        takes: &["position", "intensity", "to_world"],
        lacks: &["sampling_weight"],
        build: point,
    },
    Plugin {
        name: "spot",
        takes: &["intensity", "cutoff_angle", "beam_width", "texture", "to_world"],
        lacks: &["sampling_weight"],
        build: spot,
    },
    Plugin {
        name: "directional",
        takes: &["direction", "irradiance", "to_world"],
        lacks: &["sampling_weight"],
        build: directional,
    },
    Plugin { name: "constant", takes: &["radiance"], lacks: &["sampling_weight"], build: constant },
    Plugin {
        name: "envmap",
        takes: &["filename", "scale", "to_world"],
        lacks: &["sampling_weight", "mis_compensation"],
        build: envmap,
    },
    Plugin {
        name: "projector",
        takes: &["irradiance", "scale", "fov", "fov_axis", "focal_length", "to_world"],
        lacks: &["sampling_weight"],
        build: projector,
    },
    Plugin { name: "sunsky", takes: SUNSKY, lacks: SUNSKY_LACKS, build: sunsky },
    Plugin { name: "sky", takes: SUNSKY, lacks: SUNSKY_LACKS, build: sunsky },
    Plugin { name: "sun", takes: SUNSKY, lacks: SUNSKY_LACKS, build: sunsky },
];
const SUNSKY: &[&str] =
    &["turbidity", "albedo", "sun_direction", "sun_scale", "sky_scale", "scale", "to_world"];
const SUNSKY_LACKS: &[&str] = &[
    "latitude",
    "longitude",
    "timezone",
    "year",
    "month",
    "day",
    "hour",
    "minute",
    "second",
    "sun_aperture",
    "complex_sun",
    "stretch",
    "resolution",
    "sun_radius_scale",
    "sampling_weight",
];

/// Adds the light that `object` is.
pub(super) fn add(world: &mut World<'_>, object: &Rc<Object>) {
    if object.plugin == "area" {
        // It belongs to the shapes that refer to it.
        return;
    }
    let Some(build) = world.plugin(EMITTERS, object) else { return };
    for (kind, params, world_from_light) in build(world, object) {
        let node = node(kind, params, object.at);
        let light =
            LightDesc { name: object.id.clone(), node, world_from_light: Motion::still(world_from_light) };
        world.desc.lights.push(light);
    }
}

/// The light of a shape's surface.
pub(super) fn area(world: &mut World<'_>, shape: &Object) -> Option<Arc<Node>> {
    let own = world.of_tag(shape, "emitter");
    let light = own.first()?;
    if light.plugin != "area" {
        let hint = match light.plugin.as_str() {
            "directionalarea" => {
                "no path meets light that leaves along normals only: expected \"area\", or a \"directional\" light"
            }
            _ => "expected \"area\"",
        };
        world.said.error(light.at, format!("{} is no light of a shape", light.shown())).hint(hint);
        return None;
    }
    world.check(light, &["radiance"], &["sampling_weight"]);
    Some(Arc::new(node("diffuse", world.light(light, ("radiance", "L"), 1.0), light.at)))
}

fn point(world: &mut World<'_>, object: &Object) -> Vec<(&'static str, Params, DAffine3)> {
    let place = match object.triple("position", world.said) {
        Some(p) => DAffine3::from_translation(p.into()),
        None => object.transform("to_world", world.said),
    };
    vec![("point", world.light(object, ("intensity", "I"), 1.0), place)]
}

fn spot(world: &mut World<'_>, object: &Object) -> Vec<(&'static str, Params, DAffine3)> {
    let cutoff = object.number_or("cutoff_angle", 20.0, world.said);
    let beam = object.number_or("beam_width", 0.75 * cutoff, world.said);
    let mut params = world.light(object, ("intensity", "I"), 1.0);
    params =
        params.float("coneangle", cutoff as f32).float("conedeltaangle", (cutoff - beam).max(0.0) as f32);
    params = params.string("rim", "linear");
    let place = object.transform("to_world", world.said);
    let Some(texture) = world.named(object, "texture") else { return vec![("spot", params, place)] };
    if texture.plugin != "bitmap" {
        world.once(texture.at, "spot: its texture must be a bitmap; it is left out".to_owned());
        return vec![("spot", params, place)];
    }
    world.check(&texture, &["filename", "raw"], &["filter_type", "wrap_mode", "to_uv", "format", "accel"]);
    let Some(path) = world.path(&texture, "filename") else { return Vec::new() };
    // A slide that the outer cone touches.
    let color = world.shade(object, "intensity", Role::Light);
    let scale = match color {
        Some(Shade::Rgb([r, g, b])) if r == g && g == b => r,
        None => 1.0,
        Some(_) => {
            world.once(object.at, "spot with a texture: the colour of \"intensity\" is left out".to_owned());
            let strength = params
                .get("scale")
                .and_then(|p| if let Data::Floats(v) = &p.data { v.first() } else { None });
            strength.copied().unwrap_or(1.0)
        }
    };
    let kept = ["coneangle", "conedeltaangle", "rim"];
    let mut slide =
        Params::new().string("filename", &path).float("scale", scale).float("fov", 2.0 * cutoff as f32);
    slide = slide.float("aspect", 1.0);
    params.iter().filter(|p| kept.contains(&p.name.as_str())).for_each(|p| slide.push(p.clone()));
    // The picture's rows go the way of +y.
    vec![("projection", slide, place * DAffine3::from_scale(DVec3::new(1.0, -1.0, 1.0)))]
}

fn directional(world: &mut World<'_>, object: &Object) -> Vec<(&'static str, Params, DAffine3)> {
    let params = world.light(object, ("irradiance", "L"), 1.0);
    let place = object.transform("to_world", world.said);
    let params = match object.triple("direction", world.said) {
        Some(d) => {
            let point = |p: [f64; 3]| Data::Floats(p.map(|v| v as f32).to_vec());
            params.with("from", ValueType::Point3, point([0.0; 3])).with("to", ValueType::Point3, point(d))
        }
        None => params,
    };
    vec![("distant", params, place)]
}

fn constant(world: &mut World<'_>, object: &Object) -> Vec<(&'static str, Params, DAffine3)> {
    vec![("infinite", world.light(object, ("radiance", "L"), 1.0), DAffine3::IDENTITY)]
}

/// Directions of an environment map: in Mitsuba y is up and u grows from -z by +x; in ours z is up and u grows from +x
/// by +y.
fn envmap(world: &mut World<'_>, object: &Object) -> Vec<(&'static str, Params, DAffine3)> {
    let Some(path) = world.path(object, "filename") else { return Vec::new() };
    let scale = object.number_or("scale", 1.0, world.said) as f32;
    let params = Params::new().string("filename", &path).float("scale", scale).string("layout", "poletopole");
    let turned = DMat3::from_cols(DVec3::NEG_Z, DVec3::X, DVec3::Y);
    // Where it stands has no effect: it is far away.
    let place = object.transform("to_world", world.said).matrix3 * turned;
    vec![("infinite", params, DAffine3::from_mat3(place))]
}

fn projector(world: &mut World<'_>, object: &Object) -> Vec<(&'static str, Params, DAffine3)> {
    let texture = world.named(object, "irradiance").filter(|t| t.plugin == "bitmap");
    let Some(texture) = texture else {
        world.said.error(object.at, "the \"irradiance\" of a projector must be a bitmap");
        return Vec::new();
    };
    world.check(&texture, &["filename", "raw"], &["filter_type", "wrap_mode", "to_uv", "format", "accel"]);
    let Some(path) = world.path(&texture, "filename") else { return Vec::new() };
    let scale = object.number_or("scale", 1.0, world.said) as f32;
    let fov = object.number_or("fov", 50.0, world.said) as f32;
    world.once(
        object.at,
        "projector: \"fov\" is taken to be across the shorter edge of the picture".to_owned(),
    );
    let params = Params::new().string("filename", &path).float("scale", scale).float("fov", fov);
    // Its x is to the left, as a camera's.
    let place = object.transform("to_world", world.said) * DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    vec![("projection", params, place)]
}

fn sunsky(world: &mut World<'_>, object: &Object) -> Vec<(&'static str, Params, DAffine3)> {
    world.once(object.at, format!("{}: drawn by durer's own model of daylight", object.plugin));
    let place = object.transform("to_world", world.said);
    let triple = |v: DVec3| Data::Floats(v.to_array().map(|v| v as f32).to_vec());
    let sun = match object.get("sun_direction").map(|p| &p.value) {
        Some(Value::Triple(d)) => DVec3::from(*d),
        _ => DVec3::new(0.0, -0.5, 0.8),
    };
    let sun = place.matrix3 * sun;
    let up = place.matrix3 * DVec3::Z;
    let all = object.number_or("scale", 1.0, world.said);
    let mut lights = Vec::new();
    for (kind, scale) in [("sky", "sky_scale"), ("sun", "sun_scale")] {
        let scale = all * object.number_or(scale, 1.0, world.said);
        if object.plugin != "sunsky" && object.plugin != kind || scale <= 0.0 {
            continue;
        }
        let turbidity = object.number_or("turbidity", 3.0, world.said).clamp(1.7, 10.0);
        let mut params = Params::new()
            .with("sun", ValueType::Vector3, triple(sun))
            .with("up", ValueType::Vector3, triple(up))
            .float("turbidity", turbidity as f32)
            .float("scale", scale as f32);
        if kind == "sky" {
            params = world.color(params, object, ("albedo", "ground"));
        }
        lights.push((kind, params, DAffine3::IDENTITY));
    }
    lights
}
