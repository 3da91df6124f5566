//! Textures: their v grows downwards in the picture, ours upwards.
use std::rc::Rc;

use durer_core::glam::DAffine3;
use durer_scene::{Data, Params, TextureDesc, TextureValue, ValueType};

use super::{
    object::{Object, Value},
    volume,
    world::{Plugin, Role, Shade, World, node, with_shade},
};

/// Kind, parameters and place of a texture.
type Made = (&'static str, Params, DAffine3);
/// Makes the node of a texture.
type Build = fn(&mut World<'_>, &Object, TextureValue) -> Option<Made>;

/// The textures.
pub(super) const TEXTURES: &[Plugin<Build>] = &[
    Plugin {
        name: "bitmap",
        takes: &["filename", "filter_type", "wrap_mode", "raw", "to_uv", "gamma"],
        lacks: &["format", "accel", "cache", "max_anisotropy", "channel", "wrap_mode_u", "wrap_mode_v"],
        build: bitmap,
    },
    Plugin { name: "checkerboard", takes: &["color0", "color1", "to_uv"], lacks: &[], build: checkerboard },
    Plugin { name: "mesh_attribute", takes: &["name", "scale"], lacks: &[], build: attribute },
    Plugin { name: "rawconstant", takes: &["value"], lacks: &[], build: constant },
    Plugin { name: "uniform", takes: &["value"], lacks: &[], build: constant },
    Plugin { name: "srgb", takes: &["color"], lacks: &[], build: constant },
    Plugin { name: "volume", takes: &["volume"], lacks: &[], build: volume },
    Plugin { name: "scale", takes: &["texture", "scale"], lacks: &[], build: scale },
];

/// The name of the texture that `object` is, as what yields colours or numbers.
pub(super) fn name(world: &mut World<'_>, object: &Rc<Object>, value: TextureValue) -> Option<String> {
    let key = (Rc::as_ptr(object), value == TextureValue::Color);
    if let Some(known) = world.textures.get(&key) {
        return known.clone();
    }
    let made = world.deeper(object, |world| {
        if object.tag != "texture" {
            world.said.error(object.at, format!("{} is no texture", object.shown()));
            return None;
        }
        let build = world.plugin(TEXTURES, object)?;
        let (kind, params, world_from_texture) = build(world, object, value)?;
        let textures = &mut world.desc.textures;
        let used = |name: &str| textures.iter().any(|t| t.name == name && t.value == value);
        let free = !object.id.is_empty() && !used(&object.id);
        let name = if free { object.id.clone() } else { format!("{kind} {}", textures.len()) };
        let node = node(kind, params, object.at);
        textures.push(TextureDesc { name: name.clone(), value, node, world_from_texture });
        Some(name)
    });
    world.textures.insert(key, made.clone());
    made
}

/// `spectrum` with a type.
pub(super) fn spectrum(world: &mut World<'_>, object: &Object) -> Option<Shade> {
    match object.plugin.as_str() {
        "uniform" | "d65" => {
            world.check(object, &["value", "scale", "color"], &["lambda_min", "lambda_max"]);
            let scale = object.number_or("scale", 1.0, world.said) as f32;
            let color = world.shade(object, "color", Role::Surface);
            let value = object.number_or("value", 1.0, world.said) as f32;
            Some(match color {
                Some(Shade::Rgb(rgb)) => Shade::Rgb(rgb.map(|v| v * scale)),
                _ => Shade::Rgb([value * scale; 3]),
            })
        }
        "srgb" => {
            world.check(object, &["color"], &["unbounded"]);
            world.shade(object, "color", Role::Surface)
        }
        "blackbody" => {
            world.check(object, &["temperature", "scale"], &["lambda_min", "lambda_max"]);
            let kelvin = object.number_or("temperature", 5000.0, world.said);
            let scale = object.number_or("scale", 1.0, world.said);
            Some(Shade::Curve(
                (36..=83)
                    .flat_map(|i| {
                        let nm = f64::from(i) * 10.0;
                        [nm as f32, (planck(kelvin, nm) * scale) as f32]
                    })
                    .collect(),
            ))
        }
        "irregular" => {
            world.check(object, &["wavelengths", "values"], &[]);
            let list = |name: &str, world: &mut World<'_>| {
                let text = object.text(name, world.said).unwrap_or_default().to_owned();
                super::value::told(super::value::numbers(&text), object.at, world.said)
            };
            let (nm, values) = (list("wavelengths", world)?, list("values", world)?);
            Some(Shade::Curve(nm.iter().zip(&values).flat_map(|(nm, v)| [*nm as f32, *v as f32]).collect()))
        }
        other => {
            let known = ["uniform", "d65", "srgb", "blackbody", "irregular"];
            world.said.unknown(object.at, "spectrum", other, known);
            None
        }
    }
}

/// What a black body sends at a wavelength, in W / (m² sr nm) (Planck's law).
fn planck(kelvin: f64, nm: f64) -> f64 {
    let (h, c, k, m) = (6.626_070_15e-34, 299_792_458.0, 1.380_649e-23, nm * 1e-9);
    if kelvin <= 0.0 {
        return 0.0;
    }
    2.0 * h * c * c / m.powi(5) / (h * c / (m * k * kelvin)).exp_m1() * 1e-9
}

/// `to_uv` as `[m0, m1, m2, m3, m4, m5]` of coordinates whose v grows upwards, yielding theirs.
fn to_uv(world: &mut World<'_>, object: &Object) -> [f64; 6] {
    let t = object.transform("to_uv", world.said);
    let (m, d) = (t.matrix3, t.translation);
    let (a, b, c) = (m.x_axis.x, m.y_axis.x, d.x);
    let (e, f, g) = (m.x_axis.y, m.y_axis.y, d.y);
    [a, -b, b + c, e, -f, f + g]
}

fn bitmap(world: &mut World<'_>, object: &Object, value: TextureValue) -> Option<Made> {
    let path = world.path(object, "filename")?;
    let [a, b, c, e, f, g] = to_uv(world, object);
    let filter = object.word("filter_type", &["bilinear", "nearest", "trilinear", "ewa"], world.said);
    let wrap = object.word("wrap_mode", &["repeat", "mirror", "clamp", "zero", "one"], world.said);
    let wrap = match wrap {
        "zero" => "black",
        "one" => {
            world.once(object.at, "bitmap: outside the picture it is clamped instead of 1".to_owned());
            "clamp"
        }
        other => other,
    };
    let filter = if filter == "nearest" { "point" } else { filter };
    let mut params = Params::new().string("filename", &path).string("wrap", wrap).string("filter", filter);
    let gamma = object.number("gamma", world.said);
    if object.truth("raw", false, world.said) || gamma == Some(1.0) {
        params = params.string("encoding", "linear");
    } else if let Some(gamma) = gamma.filter(|g| *g > 0.0) {
        params = params.string("encoding", &format!("gamma {gamma}"));
    }
    // Their v grows downwards, and so do the rows of the picture.
    let matrix = [a, b, c, -e, -f, 1.0 - g].map(|v| v as f32);
    if matrix != [1.0, 0.0, 0.0, 0.0, 1.0, 0.0] {
        params = params.with("uvmatrix", ValueType::Float, Data::Floats(matrix.to_vec()));
    }
    if value == TextureValue::Float {
        params = params.string("channel", "luminance");
    }
    Some(("imagemap", params, DAffine3::IDENTITY))
}

/// One cell of four squares is as wide as texture space.
fn checkerboard(world: &mut World<'_>, object: &Object, value: TextureValue) -> Option<Made> {
    let [a, b, c, e, f, g] = to_uv(world, object);
    if b != 0.0 || e != 0.0 {
        world.once(object.at, "checkerboard: \"to_uv\" turns, which is left out".to_owned());
    }
    let params = [("uscale", a), ("vscale", f), ("udelta", c), ("vdelta", g)]
        .into_iter()
        .fold(Params::new().string("filter", "none"), |p, (name, v)| p.float(name, 2.0 * v as f32));
    // Of numbers Mitsuba exchanges the two (`eval_1` in its checkerboard.cpp), of colours it does not.
    let (first, second) = if value == TextureValue::Float { ("tex2", "tex1") } else { ("tex1", "tex2") };
    let params = part(world, params, object, ("color0", first), (0.4, value));
    Some(("checkerboard", part(world, params, object, ("color1", second), (0.2, value)), DAffine3::IDENTITY))
}

fn constant(world: &mut World<'_>, object: &Object, value: TextureValue) -> Option<Made> {
    let theirs = if object.plugin == "srgb" { "color" } else { "value" };
    if let Some(Value::Triple(v)) = object.get(theirs).map(|p| &p.value) {
        return Some(("constant", Params::new().rgb("value", v.map(|v| v as f32)), DAffine3::IDENTITY));
    }
    Some((
        "constant",
        part(world, Params::new(), object, (theirs, "value"), (1.0, value)),
        DAffine3::IDENTITY,
    ))
}

fn scale(world: &mut World<'_>, object: &Object, value: TextureValue) -> Option<Made> {
    let params = part(world, Params::new(), object, ("texture", "tex"), (1.0, value));
    Some(("scale", world.number(params, object, ("scale", "scale")), DAffine3::IDENTITY))
}

/// The value of a texture that has others.
fn part(
    world: &mut World<'_>,
    params: Params,
    object: &Object,
    names: (&str, &str),
    (usual, value): (f32, TextureValue),
) -> Params {
    if value == TextureValue::Color {
        return match world.shade(object, names.0, Role::Surface) {
            Some(shade) => with_shade(params, names.1, shade, object.at),
            None => params.rgb(names.1, [usual; 3]),
        };
    }
    if let Some(Value::Color([r, g, b])) = object.get(names.0).map(|p| &p.value) {
        return params.float(names.1, durer_core::spectrum::luminance([*r, *g, *b].map(f64::from)) as f32);
    }
    let given = object.get(names.0).is_some() || object.children.iter().any(|c| c.name == names.0);
    if given { world.number(params, object, names) } else { params.float(names.1, usual) }
}

/// Colours of vertices or faces, which a mesh brings: the first three numbers are the colour, the fourth is the number.
fn attribute(world: &mut World<'_>, object: &Object, value: TextureValue) -> Option<Made> {
    let name = object.text("name", world.said).unwrap_or_default().to_owned();
    if !name.starts_with("vertex_") && !name.starts_with("face_") {
        let message = format!("mesh_attribute: \"{name}\" begins with neither \"vertex_\" nor \"face_\"");
        world.said.error(object.at, message);
        return None;
    }
    let scale = object.number_or("scale", 1.0, world.said) as f32;
    let params = Params::new().float("scale", scale);
    let _ = value;
    Some(("vertexcolor", params, DAffine3::IDENTITY))
}

/// A volume that is looked up where surfaces are.
fn volume(world: &mut World<'_>, object: &Object, value: TextureValue) -> Option<Made> {
    let Some(inner) = world.named(object, "volume") else {
        let params = part(world, Params::new(), object, ("volume", "value"), (0.75, value));
        return Some(("constant", params, DAffine3::IDENTITY));
    };
    let volume::Grid { size: [nx, ny, nz], values, place } = volume::colors(world, &inner)?;
    let params = Params::new().with("values", ValueType::Float, Data::Floats(values.concat()));
    Some(("volume", params.int("nx", nx as i32).int("ny", ny as i32).int("nz", nz as i32), place))
}
