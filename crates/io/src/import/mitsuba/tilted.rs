//! Normal maps and bump maps around other materials.
use std::rc::Rc;

use durer_core::glam::DAffine3;
use durer_scene::{MaterialRef, Params, TextureDesc, TextureValue};

use super::{
    bsdf::{Backs, Change, made, within},
    object::{Object, Value},
    texture,
    world::{World, node},
};

/// A normal map or a bump map around another material.
pub(super) fn tilted(
    world: &mut World<'_>,
    object: &Object,
    backs: Backs,
    change: Change<'_>,
) -> Option<MaterialRef> {
    let is_bump = object.plugin == "bumpmap";
    let mut takes = vec![if is_bump { "scale" } else { "normalmap" }];
    // The texture of a bump map may have any name.
    takes.extend(object.children.iter().filter(|_| is_bump).map(|c| c.name.as_str()));
    world.check(object, &takes, &["flip_invalid_normals", "use_shadowing_function"]);
    let all = within(world, object, &[1])?;
    let inner = Rc::clone(all.first()?);
    let texture = world.inner(object).into_iter().find(|(_, o)| o.tag == "texture").map(|(_, o)| o);
    let Some(texture) = texture else {
        world.said.error(object.at, format!("{} has no texture", object.shown()));
        return None;
    };
    let params = if is_bump {
        let name = texture::name(world, &texture, TextureValue::Float)?;
        let scale = object.number_or("scale", 1.0, world.said) as f32;
        let scaled = format!("{name} times {scale}");
        if scale != 1.0 && !world.desc.textures.iter().any(|t| t.name == scaled) {
            let params = Params::new().texture("tex", &name).float("scale", scale);
            world.desc.textures.push(TextureDesc {
                name: scaled.clone(),
                value: TextureValue::Float,
                node: node("scale", params, object.at),
                world_from_texture: DAffine3::IDENTITY,
            });
        }
        Some(Params::new().texture("displacement", if scale == 1.0 { &name } else { &scaled }))
    } else {
        normals(world, &texture)?
    };
    if inner.plugin == "null" && params.is_some() {
        world.once(object.at, format!("{} in {}: the map has no effect", inner.shown(), object.shown()));
    }
    let params = params.filter(|_| inner.plugin != "null");
    let mut with = |given: Params| {
        params.iter().flat_map(Params::iter).fold(change(given), |mut all, p| {
            all.push(p.clone());
            all
        })
    };
    world.deeper(&inner, |w| made(w, &inner, backs, &mut with))
}

/// The parameters of a normal map; none where it is even and straight.
fn normals(world: &mut World<'_>, texture: &Object) -> Option<Option<Params>> {
    match texture.plugin.as_str() {
        "bitmap" => {
            world.check(
                texture,
                &["filename", "raw"],
                &["filter_type", "wrap_mode", "to_uv", "format", "accel"],
            );
            let path = world.path(texture, "filename")?;
            Some(Some(Params::new().string("normalmap", &path)))
        }
        "rawconstant"
            if matches!(texture.get("value").map(|p| &p.value), Some(Value::Triple([0.5, 0.5, 1.0]))) =>
        {
            Some(None)
        }
        _ => {
            let message = "a normal map must be a bitmap here: another one has no effect";
            world.once(texture.at, message.to_owned());
            Some(None)
        }
    }
}
