//! Plastic: a matte body under a dielectric coat.
//!
//! Mitsuba's body sends `T(wi) T(wo) r / (pi eta² (1 - r F))`, with the share `F` of diffuse light that the coat reflects back
//! from inside, where `nonlinear`; else `1 - F` stands in place of `1 - r F`. Ours does both.
use durer_scene::Params;

use super::{bsdf::roughness, index::relative, object::Object, world::World};

pub(super) fn plastic(world: &mut World<'_>, object: &Object) -> Option<(&'static str, Params)> {
    let eta = relative(world, object, "polypropylene").max(1.0);
    let nonlinear = object.truth("nonlinear", false, world.said);
    // A coat that is there, but in which nothing is lost; as many reflections in it as there may be.
    let params = Params::new().float("eta", eta).float("thickness", 0.0).int("maxdepth", 1000);
    let params = params.bool("nonlinear", nonlinear);
    let params = world.color(params, object, ("diffuse_reflectance", "reflectance"));
    let params = world.color(params, object, ("specular_reflectance", "reflection"));
    if object.plugin == "pplastic" {
        world.once(object.at, "pplastic: light is not polarised here".to_owned());
    }
    Some((
        "coateddiffuse",
        if object.plugin == "plastic" { params } else { roughness(world, object, params) },
    ))
}
