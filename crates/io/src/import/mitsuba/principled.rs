//! Disney's materials (Burley 2012, 2015): `principled`, and `principledthin` for sheets.
use durer_scene::Params;

use super::{
    object::{Object, Value},
    world::World,
};

/// Numbers that both take, and what ours are called.
const COMMON: [(&str, &str); 7] = [
    ("roughness", "roughness"),
    ("anisotropic", "anisotropic"),
    ("spec_trans", "spectrans"),
    ("spec_tint", "speculartint"),
    ("sheen", "sheen"),
    ("sheen_tint", "sheentint"),
    ("flatness", "flatness"),
];
/// Parameters of `principled`.
pub(super) const TAKES: &[&str] = &[
    "base_color",
    "roughness",
    "anisotropic",
    "metallic",
    "spec_trans",
    "spec_tint",
    "eta",
    "specular",
    "sheen",
    "sheen_tint",
    "flatness",
    "clearcoat",
    "clearcoat_gloss",
];
/// Parameters of `principledthin`.
pub(super) const THIN: &[&str] = &[
    "base_color",
    "roughness",
    "anisotropic",
    "spec_trans",
    "spec_tint",
    "eta",
    "sheen",
    "sheen_tint",
    "flatness",
    "diff_trans",
];
/// How often Mitsuba takes which part of them: nothing that is seen.
pub(super) const LACKS: &[&str] = &[
    "main_specular_sampling_rate",
    "clearcoat_sampling_rate",
    "diffuse_reflectance_sampling_rate",
    "diffuse_transmittance_sampling_rate",
    "specular_reflectance_sampling_rate",
    "specular_transmittance_sampling_rate",
];
/// The index that transmits where 1 is given, as in Mitsuba.
const NEARLY_ONE: f64 = 1.001;

/// Whether light gets through.
pub(super) fn transmits(object: &Object) -> bool {
    let given = object.children.iter().any(|c| c.name == "spec_trans");
    given || matches!(object.get("spec_trans").map(|p| &p.value), Some(Value::Number(v)) if *v > 0.0)
}

pub(super) fn solid(world: &mut World<'_>, object: &Object) -> Option<(&'static str, Params)> {
    let mut params = common(world, object);
    for names in [("metallic", "metallic"), ("clearcoat", "clearcoat"), ("clearcoat_gloss", "clearcoatgloss")]
    {
        params = world.number(params, object, names);
    }
    let specular = number(world, object, "specular");
    let eta = match number(world, object, "eta") {
        Some(_) if specular.is_some() => {
            world.said.error(object.at, "\"eta\" and \"specular\" say the same: only one may be given");
            return None;
        }
        Some(eta) => eta,
        None => {
            // The index that reflects 8 % of this at normal incidence.
            let root = (0.08 * specular.unwrap_or(0.5).clamp(0.0, 1.0)).sqrt();
            2.0 / (1.0 - root) - 1.0
        }
    };
    let eta = if transmits(object) && eta == 1.0 { NEARLY_ONE } else { eta };
    Some(("disney", params.float("eta", eta as f32)))
}

pub(super) fn thin(world: &mut World<'_>, object: &Object) -> Option<(&'static str, Params)> {
    let params = common(world, object).bool("thin", true);
    let params = world.number(params, object, ("diff_trans", "difftrans"));
    let eta = number(world, object, "eta").unwrap_or(1.5);
    Some(("disney", params.float("eta", eta as f32)))
}

/// A number that must be the same everywhere.
fn number(world: &mut World<'_>, object: &Object, name: &str) -> Option<f64> {
    if object.children.iter().any(|c| c.name == name) {
        let message =
            format!("{}: \"{name}\" is the same everywhere here: its default is used", object.plugin);
        world.once(object.at, message);
    }
    object.number(name, world.said)
}

fn common(world: &mut World<'_>, object: &Object) -> Params {
    let params = world.color(Params::new(), object, ("base_color", "color"));
    COMMON.into_iter().fold(params, |params, names| world.number(params, object, names))
}
