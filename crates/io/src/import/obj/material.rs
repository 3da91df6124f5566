//! MTL materials to materials of ours.
//!
//! | MTL | becomes |
//! |---|---|
//! | `illum` 3, 5 without `Pm` | `mirror` of colour `Ks` if `Kd` is black, else `classic` with `Ks` as its reflection |
//! | `illum` 6, 7; 4, 9 where `d` is below 1 and `Ni` is not 1 | `dielectric`, or `classic` with refraction if coloured by `Kd` |
//! | all others | `principled` |
//!
//! In `principled`, the exponent `Ns` of a highlight becomes the roughness whose GGX lobe is as wide
//! (alpha² = 2 / (Ns + 2), Walter et al. 2007), and `Ks` scales the reflectance of glass, 0.04 at 0.5, as modelling
//! programs that write MTL mean it. `Ka` is ignored knowingly.
use durer_core::math::float;
use durer_scene::{Node, Params};

use super::{
    mtl::{Material, Slot},
    texture::{Role, Textures},
};

const BLACK: [f32; 3] = [0.0; 3];

/// The material whose images are relative to `folder`.
pub(super) fn node(material: &Material, folder: &str, textures: &mut Textures) -> Node {
    let kd = material.kd.unwrap_or([0.8; 3]);
    let ks = material.ks.unwrap_or(BLACK);
    let dark = material.map(Slot::Diffuse).is_none() && kd == BLACK;
    let refracts = material.ni.is_some_and(|n| (0.1..=10.0).contains(&n) && n != 1.0);
    let plain = material.pm.is_none() && material.pr.is_none() && material.ke.is_none_or(|ke| ke == BLACK);
    match material.illum {
        Some(3 | 5) if plain && dark && ks != BLACK => {
            Node::new("mirror", Params::new().rgb("reflectance", ks))
        }
        Some(illum @ (3 | 5)) if plain && ks != BLACK && material.opacity() == 1.0 => {
            let params = classic(material, folder, textures);
            Node::new("classic", params.rgb("reflection", ks).bool("fresnel", illum == 5))
        }
        Some(4 | 9) if plain && material.opacity() < 1.0 && refracts => glass(material, dark),
        Some(6 | 7) if plain && (material.opacity() < 1.0 || refracts) => glass(material, dark),
        _ => Node::new("principled", principled(material, folder, textures)),
    }
}

/// The parts that `classic` has in common with MTL.
fn classic(material: &Material, folder: &str, textures: &mut Textures) -> Params {
    let params = diffuse("diffuse", material, folder, textures, Params::new());
    let exponent = material.ns.unwrap_or(32.0).clamp(0.0, 1e6);
    params.rgb("specular", material.ks.unwrap_or(BLACK)).float("exponent", exponent)
}

fn glass(material: &Material, dark: bool) -> Node {
    let eta = material.ni.filter(|n| (0.1..=10.0).contains(n) && *n != 1.0).unwrap_or(1.5);
    let filter = material.tf.unwrap_or([1.0; 3]);
    let clear = filter == [1.0; 3] || filter == BLACK;
    if clear && (dark || material.opacity() == 0.0) {
        return Node::new("dielectric", Params::new().float("eta", eta));
    }
    let through = 1.0 - material.opacity();
    let through = if through > 0.0 { through } else { 1.0 };
    let filter = if filter == BLACK { [1.0; 3] } else { filter };
    let kd = material.kd.unwrap_or(BLACK).map(|c| c * (1.0 - through));
    let params = Params::new()
        .rgb("diffuse", kd)
        .rgb("specular", material.ks.unwrap_or(BLACK))
        .float("exponent", material.ns.unwrap_or(32.0).clamp(0.0, 1e6))
        .rgb("reflection", [1.0; 3])
        .rgb("transmission", filter.map(|c| c * through));
    Node::new("classic", params.bool("fresnel", true).float("eta", eta))
}

/// `Kd` with its image. A black `Kd` beside an image is a slip of many exporters: the image alone is meant.
fn diffuse(name: &str, material: &Material, folder: &str, textures: &mut Textures, params: Params) -> Params {
    let kd = material.kd.unwrap_or([0.8; 3]);
    let factor = if material.kd.is_none() || kd == BLACK { [1.0; 3] } else { kd };
    let map = material.map(Slot::Diffuse);
    match map.and_then(|map| textures.texture(map, folder, Role::Color(factor))) {
        Some(texture) => params.texture(name, &texture),
        None => params.rgb(name, if map.is_some() { [0.5; 3] } else { kd }),
    }
}

fn principled(material: &Material, folder: &str, textures: &mut Textures) -> Params {
    let mut params = diffuse("basecolor", material, folder, textures, Params::new());
    params = surface(material, folder, textures, params);
    params = coverage(material, folder, textures, params);
    let glow = material.ke.filter(|ke| *ke != BLACK);
    let map = material.map(Slot::Emission);
    let role = Role::Color(glow.unwrap_or([1.0; 3]));
    params = match (map.and_then(|map| textures.texture(map, folder, role)), glow) {
        (Some(texture), _) => params.texture("emission", &texture),
        (None, Some(glow)) => params.rgb("emission", glow),
        (None, None) => params,
    };
    let normal = material.map(Slot::Normal).or(material.map(Slot::Bump));
    let kind = if material.map(Slot::Normal).is_some() { Role::Normal } else { Role::Bump };
    match normal.and_then(|map| textures.texture(map, folder, kind).map(|t| (t, map.strength))) {
        Some((texture, strength)) => {
            let params = params.texture("normal", &texture);
            if strength == 1.0 { params } else { params.float("normalscale", strength) }
        }
        None => params,
    }
}

/// Roughness, metal, reflectance.
fn surface(material: &Material, folder: &str, textures: &mut Textures, mut params: Params) -> Params {
    let modern = material.pr.is_some() || material.pm.is_some() || material.map(Slot::Roughness).is_some();
    let [r, g, b] = material.ks.unwrap_or(BLACK);
    let shine = if matches!(material.illum, Some(0 | 1)) { 0.0 } else { ((r + g + b) / 3.0).min(1.0) };
    let exponent = material.ns.unwrap_or(0.0).clamp(0.0, 1e6);
    let roughness = match material.pr {
        Some(roughness) => roughness.clamp(0.0, 1.0),
        None => float::pow(2.0 / (exponent + 2.0), 0.25),
    };
    let eta = match material.ni {
        Some(eta) if modern && (1.0..=10.0).contains(&eta) => eta,
        _ if modern => 1.5,
        _ => {
            let root = (0.08 * shine).sqrt();
            (1.0 + root) / (1.0 - root)
        }
    };
    params = params.float("eta", eta);
    let scalar = |slot, factor| material.map(slot).map(|map| (map, Role::Scalar(factor)));
    let rough = scalar(Slot::Roughness, material.pr.unwrap_or(1.0));
    params = match rough.and_then(|(map, role)| textures.texture(map, folder, role)) {
        Some(texture) => params.texture("roughness", &texture),
        None => params.float("roughness", roughness),
    };
    let metal = scalar(Slot::Metallic, material.pm.unwrap_or(1.0));
    match (metal.and_then(|(map, role)| textures.texture(map, folder, role)), material.pm) {
        (Some(texture), _) => params.texture("metallic", &texture),
        (None, Some(metallic)) => params.float("metallic", metallic.clamp(0.0, 1.0)),
        (None, None) => params,
    }
}

/// Holes and thin surfaces.
fn coverage(material: &Material, folder: &str, textures: &mut Textures, params: Params) -> Params {
    let opacity = material.opacity();
    let map = material.map(Slot::Opacity);
    // A d of 0 beside an image is a slip: nothing would be left to see.
    let factor = if opacity == 0.0 { 1.0 } else { opacity };
    match map.and_then(|map| textures.texture(map, folder, Role::Opacity(factor))) {
        Some(texture) => params.texture("alpha", &texture).string("alphamode", "blend"),
        None if opacity < 1.0 => params.float("alpha", opacity).string("alphamode", "blend"),
        None => params,
    }
}
