//! Hair: the same model as ours (Chiang and others 2016), whose absorption counts per radius there, too.
use durer_scene::Params;

use super::{
    index::relative,
    object::Object,
    world::{Role, Shade, World, with_shade},
};

pub(super) const TAKES: &[&str] = &[
    "eumelanin",
    "pheomelanin",
    "sigma_a",
    "scale",
    "int_ior",
    "ext_ior",
    "longitudinal_roughness",
    "azimuthal_roughness",
    "scale_tilt",
];

pub(super) fn hair(world: &mut World<'_>, object: &Object) -> Option<(&'static str, Params)> {
    let numbers = [
        ("longitudinal_roughness", "beta_m", 0.3),
        ("azimuthal_roughness", "beta_n", 0.3),
        ("scale_tilt", "alpha", 2.0),
    ];
    let mut params = Params::new().float("eta", relative(world, object, "amber"));
    for (theirs, ours, usual) in numbers {
        params = params.float(ours, object.number_or(theirs, usual, world.said) as f32);
    }
    let pigments = [("eumelanin", 1.3), ("pheomelanin", 0.2)];
    let Some(absorbed) = world.shade(object, "sigma_a", Role::Surface) else {
        return Some((
            "hair",
            pigments.into_iter().fold(params, |params, (name, usual)| {
                params.float(name, object.number_or(name, usual, world.said) as f32)
            }),
        ));
    };
    for prop in object.props.iter().filter(|p| pigments.iter().any(|(name, _)| *name == p.name)) {
        world
            .said
            .error(prop.at, format!("hair has \"sigma_a\" and \"{}\", expected one of them", prop.name));
    }
    let scale = object.number_or("scale", 1.0, world.said) as f32;
    let absorbed = match absorbed {
        Shade::Rgb(rgb) => Shade::Rgb(rgb.map(|v| v * scale)),
        Shade::Curve(curve) => Shade::Curve(
            curve.iter().enumerate().map(|(i, v)| if i % 2 == 1 { v * scale } else { *v }).collect(),
        ),
        Shade::Texture(name) => {
            if scale != 1.0 {
                world.once(object.at, "hair: \"scale\" has no effect on a texture".to_owned());
            }
            Shade::Texture(name)
        }
    };
    Some(("hair", with_shade(params, "sigma_a", absorbed, object.at)))
}
