//! Disney's materials (Burley 2012, 2015) by that of glTF, which is nearest: base colour, metal, roughness, transmission, sheen
//! and clear coat mean the same, their formulas differ.
use durer_scene::Params;

use super::{
    object::{Object, Value},
    world::World,
};

/// Parameters of `principled`.
pub(super) const TAKES: &[&str] = &[
    "base_color",
    "roughness",
    "anisotropic",
    "metallic",
    "spec_trans",
    "eta",
    "specular",
    "sheen",
    "clearcoat",
    "clearcoat_gloss",
];
/// Parameters of `principledthin`.
pub(super) const THIN: &[&str] =
    &["base_color", "roughness", "anisotropic", "spec_trans", "eta", "sheen", "diff_trans"];
/// What ours has not.
pub(super) const LACKS: &[&str] = &[
    "spec_tint",
    "sheen_tint",
    "flatness",
    "main_specular_sampling_rate",
    "clearcoat_sampling_rate",
    "diffuse_reflectance_sampling_rate",
    "spec_reflect_sampling_rate",
    "spec_trans_sampling_rate",
    "diff_trans_sampling_rate",
    "diffuse_sampling_rate",
];

/// Whether light gets through.
pub(super) fn transmits(object: &Object) -> bool {
    let given = object.children.iter().any(|c| c.name == "spec_trans");
    given || matches!(object.get("spec_trans").map(|p| &p.value), Some(Value::Number(v)) if *v > 0.0)
}

pub(super) fn solid(world: &mut World<'_>, object: &Object) -> Option<(&'static str, Params)> {
    let mut params = common(world, object);
    params = world.number(params, object, ("metallic", "metallic"));
    params = world.number(params, object, ("clearcoat", "clearcoat"));
    if object.children.iter().any(|c| c.name == "clearcoat_gloss") {
        world.once(object.at, "principled: \"clearcoat_gloss\" must be a number; 0 is used".to_owned());
    }
    // Burley: the alpha of the coat falls from 0.1 to 0.001 as it gets glossy.
    let gloss = object.number_or("clearcoat_gloss", 0.0, world.said);
    params = params.float("clearcoatroughness", (0.1 + gloss * (0.001 - 0.1)).max(0.0).sqrt() as f32);
    // Above 0: what gets through is refracted. The length has no effect, as nothing is absorbed.
    Some(("principled", if transmits(object) { params.float("thickness", 1.0) } else { params }))
}

pub(super) fn thin(world: &mut World<'_>, object: &Object) -> Option<(&'static str, Params)> {
    let params = common(world, object);
    if object.children.iter().any(|c| c.name == "diff_trans") {
        let message = "principledthin: \"diff_trans\" goes from 0 to 2 and is cut at 1 as a texture";
        world.once(object.at, message.to_owned());
        return Some(("principled", world.number(params, object, ("diff_trans", "diffusetransmission"))));
    }
    let share = object.number_or("diff_trans", 0.0, world.said) / 2.0;
    Some(("principled", params.float("diffusetransmission", share.clamp(0.0, 1.0) as f32)))
}

fn common(world: &mut World<'_>, object: &Object) -> Params {
    let message = format!("{}: drawn by glTF's formulas for metal, roughness, sheen and coat", object.plugin);
    world.once(object.at, message);
    let given = |name: &str| object.get(name).is_some() || object.children.iter().any(|c| c.name == name);
    let mut params = Params::new();
    params = if given("base_color") {
        world.color(params, object, ("base_color", "basecolor"))
    } else {
        params.rgb("basecolor", [0.5; 3])
    };
    for names in [("roughness", "roughness"), ("anisotropic", "anisotropy"), ("spec_trans", "transmission")] {
        params = world.number(params, object, names);
    }
    let eta = match (object.number("eta", world.said), object.number("specular", world.said)) {
        (Some(eta), _) => eta,
        (None, specular) => {
            if object.children.iter().any(|c| c.name == "specular") {
                world.once(object.at, "principled: \"specular\" must be a number; 0.5 is used".to_owned());
            }
            // The index that reflects 8 % of this at normal incidence.
            let root = (0.08 * specular.unwrap_or(0.5).clamp(0.0, 1.0)).sqrt();
            2.0 / (1.0 - root) - 1.0
        }
    };
    params = params.float("eta", eta as f32);
    match object.number("sheen", world.said) {
        Some(sheen) => {
            params.rgb("sheencolor", [sheen.clamp(0.0, 1.0) as f32; 3]).float("sheenroughness", 0.5)
        }
        None => {
            if let Some(texture) = world.named(object, "sheen")
                && let Some(name) = super::texture::name(world, &texture, durer_scene::TextureValue::Color)
            {
                params = params.texture("sheencolor", &name).float("sheenroughness", 0.5);
            }
            params
        }
    }
}
