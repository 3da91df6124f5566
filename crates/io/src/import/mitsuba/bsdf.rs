//! Materials. Those of Mitsuba that reflect only are black from behind: ours get a side.
use std::rc::Rc;

use durer_scene::{Data, MaterialRef, Params, ValueType};

use super::{
    hair,
    index::relative,
    layered, measured, metal,
    object::Object,
    principled, tilted,
    world::{Plugin, Role, World},
};

/// Makes kind and parameters of a material that is made of no other.
pub(super) type Build = fn(&mut World<'_>, &Object) -> Option<(&'static str, Params)>;

/// Whether a material is the same from behind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Backs {
    /// As the plugin says.
    Own,
    /// Around it there is one that says so.
    Said,
}

/// What reflects, and is black from behind.
const OPAQUE: &[Plugin<Build>] = &[
    Plugin { name: "diffuse", takes: &["reflectance"], lacks: &[], build: diffuse },
    Plugin {
        name: "roughdiffuse",
        takes: &["reflectance", "alpha"],
        lacks: &["use_fast_approx"],
        build: rough_diffuse,
    },
    Plugin {
        name: "conductor",
        takes: &["material", "eta", "k", "ext_eta", "specular_reflectance"],
        lacks: &[],
        build: conductor,
    },
    Plugin {
        name: "roughconductor",
        takes: &[
            "material",
            "eta",
            "k",
            "ext_eta",
            "distribution",
            "alpha",
            "alpha_u",
            "alpha_v",
            "specular_reflectance",
            "sample_visible",
        ],
        lacks: &[],
        build: conductor,
    },
    Plugin {
        name: "plastic",
        takes: &["diffuse_reflectance", "specular_reflectance", "int_ior", "ext_ior", "nonlinear"],
        lacks: &[],
        build: layered::plastic,
    },
    Plugin {
        name: "roughplastic",
        takes: &[
            "diffuse_reflectance",
            "specular_reflectance",
            "int_ior",
            "ext_ior",
            "nonlinear",
            "distribution",
            "alpha",
            "sample_visible",
        ],
        lacks: &[],
        build: layered::plastic,
    },
    Plugin {
        name: "pplastic",
        takes: &[
            "diffuse_reflectance",
            "specular_reflectance",
            "int_ior",
            "ext_ior",
            "distribution",
            "alpha",
            "alpha_u",
            "alpha_v",
        ],
        lacks: &[],
        build: layered::plastic,
    },
    Plugin { name: "measured", takes: &["filename"], lacks: &[], build: measured::reflecting },
    Plugin {
        name: "phong",
        takes: &["diffuse_reflectance", "specular_reflectance", "exponent"],
        lacks: &[],
        build: phong,
    },
];

/// What has no other side than this one, or light in it.
const OPEN: &[Plugin<Build>] = &[
    Plugin {
        name: "dielectric",
        takes: &["int_ior", "ext_ior", "specular_reflectance", "specular_transmittance"],
        lacks: &[],
        build: dielectric,
    },
    Plugin {
        name: "thindielectric",
        takes: &["int_ior", "ext_ior", "specular_reflectance", "specular_transmittance"],
        lacks: &[],
        build: thin,
    },
    Plugin {
        name: "roughdielectric",
        takes: &[
            "int_ior",
            "ext_ior",
            "distribution",
            "alpha",
            "alpha_u",
            "alpha_v",
            "specular_reflectance",
            "specular_transmittance",
            "sample_visible",
        ],
        lacks: &[],
        build: dielectric,
    },
    Plugin { name: "hair", takes: hair::TAKES, lacks: &[], build: hair::hair },
    Plugin { name: "null", takes: &[], lacks: &[], build: |_, _| Some(("interface", Params::new())) },
    Plugin { name: "difftrans", takes: &["transmittance"], lacks: &[], build: transmitting },
    Plugin {
        name: "principled",
        takes: principled::TAKES,
        lacks: principled::LACKS,
        build: principled::solid,
    },
    Plugin {
        name: "principledthin",
        takes: principled::THIN,
        lacks: principled::LACKS,
        build: principled::thin,
    },
];

/// Materials made of others.
const NESTED: [&str; 5] = ["twosided", "mask", "blendbsdf", "normalmap", "bumpmap"];

/// The material that `object` is.
pub(super) fn material(world: &mut World<'_>, object: &Rc<Object>) -> Option<MaterialRef> {
    if let Some(known) = world.materials.get(&Rc::as_ptr(object)) {
        return *known;
    }
    let made = world.deeper(object, |world| made(world, object, Backs::Own, &mut |p| p));
    world.materials.insert(Rc::as_ptr(object), made);
    made
}

/// Changes the parameters of a material: what a normal or bump map does to the one in it.
pub(super) type Change<'c> = &'c mut dyn FnMut(Params) -> Params;

pub(super) fn made(
    world: &mut World<'_>,
    object: &Rc<Object>,
    backs: Backs,
    change: Change<'_>,
) -> Option<MaterialRef> {
    if object.tag != "bsdf" {
        world.said.error(object.at, format!("{} is no bsdf", object.shown()));
        return None;
    }
    let own = |world: &mut World<'_>, build: Build, change: Change<'_>| {
        let (kind, params) = build(world, object)?;
        Some(world.material(&object.id, kind, change(params), object.at))
    };
    if let Some(plugin) = OPAQUE.iter().find(|p| p.name == object.plugin) {
        world.check(object, plugin.takes, plugin.lacks);
        let front = own(world, plugin.build, change)?;
        return Some(if backs == Backs::Own { sides(world, object, front, None) } else { front });
    }
    if let Some(plugin) = OPEN.iter().find(|p| p.name == object.plugin) {
        world.check(object, plugin.takes, plugin.lacks);
        let made = own(world, plugin.build, change)?;
        let is_opaque = object.plugin == "principled" && !principled::transmits(object);
        return Some(if is_opaque && backs == Backs::Own { sides(world, object, made, None) } else { made });
    }
    match object.plugin.as_str() {
        "twosided" => two_sided(world, object, change),
        "mask" => masked(world, object, backs, change),
        "blendbsdf" => blended(world, object, backs, change),
        "normalmap" | "bumpmap" => tilted::tilted(world, object, backs, change),
        other => {
            let all = OPAQUE.iter().chain(OPEN).map(|p| p.name).chain(NESTED);
            world.said.unknown(object.at, "bsdf", other, all);
            None
        }
    }
}

fn sides(
    world: &mut World<'_>,
    object: &Object,
    front: MaterialRef,
    back: Option<MaterialRef>,
) -> MaterialRef {
    let params = Params::new().string("front", &world.material_name(front));
    let params = match back {
        Some(back) => params.string("back", &world.material_name(back)),
        None => params,
    };
    world.material("", "sides", params, object.at)
}

/// The materials in another; complains if there are not as many as one of `counts` says.
pub(super) fn within(world: &mut World<'_>, object: &Object, counts: &[usize]) -> Option<Vec<Rc<Object>>> {
    let all = world.of_tag(object, "bsdf");
    if !counts.contains(&all.len()) {
        let (shown, found) = (object.shown(), all.len());
        let expected = counts.iter().map(ToString::to_string).collect::<Vec<_>>().join(" or ");
        world.said.error(object.at, format!("{shown} has {found} bsdfs in it, expected {expected}"));
        return None;
    }
    Some(all)
}

fn two_sided(world: &mut World<'_>, object: &Object, change: Change<'_>) -> Option<MaterialRef> {
    world.check(object, &[], &[]);
    let all = within(world, object, &[1, 2])?;
    let mut made = all.iter().map(|o| world.deeper(o, |w| made(w, o, Backs::Said, change)));
    let (front, back) = (made.next()??, made.next());
    drop(made);
    Some(match back {
        Some(back) => sides(world, object, front, Some(back?)),
        None => front,
    })
}

fn masked(world: &mut World<'_>, object: &Object, backs: Backs, change: Change<'_>) -> Option<MaterialRef> {
    world.check(object, &["opacity"], &[]);
    let all = within(world, object, &[1])?;
    let inner = all.first()?;
    let inner = world.deeper(inner, |w| made(w, inner, backs, change))?;
    let params = Params::new().string("material", &world.material_name(inner));
    let given = object.get("opacity").is_some() || object.children.iter().any(|c| c.name == "opacity");
    let params =
        if given { world.number(params, object, ("opacity", "alpha")) } else { params.float("alpha", 0.5) };
    Some(world.material(&object.id, "mask", params, object.at))
}

fn blended(world: &mut World<'_>, object: &Object, backs: Backs, change: Change<'_>) -> Option<MaterialRef> {
    world.check(object, &["weight"], &[]);
    let all = within(world, object, &[2])?;
    let mut names = Vec::new();
    for inner in &all {
        let inner = world.deeper(inner, |w| made(w, inner, backs, change))?;
        names.push(world.material_name(inner));
    }
    let params = Params::new().with("materials", ValueType::String, Data::Strings(names));
    let params = world.number(params, object, ("weight", "amount"));
    Some(world.material(&object.id, "mix", params, object.at))
}

fn diffuse(world: &mut World<'_>, object: &Object) -> Option<(&'static str, Params)> {
    Some(("diffuse", world.color(Params::new(), object, ("reflectance", "reflectance"))))
}

fn rough_diffuse(world: &mut World<'_>, object: &Object) -> Option<(&'static str, Params)> {
    let alpha = object.number_or("alpha", 0.2, world.said);
    // Oren and Nayar's sigma is what Mitsuba 0.x makes of alpha: alpha / sqrt(2), in radians.
    let sigma = (alpha / 2f64.sqrt()).to_degrees().clamp(0.0, 90.0);
    Some((
        "diffuse",
        world.color(Params::new(), object, ("reflectance", "reflectance")).float("sigma", sigma as f32),
    ))
}

/// Roughness as parameters of ours: alpha itself, the distribution, and facets that hide each other for each direction by itself.
pub(super) fn roughness(world: &mut World<'_>, object: &Object, params: Params) -> Params {
    let distribution = object.word("distribution", &["beckmann", "ggx"], world.said);
    let params = params.string("distribution", distribution).bool("remaproughness", false);
    let params = params.string("shadowing", "separable");
    let given = |name: &str| object.get(name).is_some() || object.children.iter().any(|c| c.name == name);
    if given("alpha_u") || given("alpha_v") {
        let params = world.number(params, object, ("alpha_u", "uroughness"));
        return world.number(params, object, ("alpha_v", "vroughness"));
    }
    if given("alpha") {
        world.number(params, object, ("alpha", "roughness"))
    } else {
        params.float("roughness", 0.1)
    }
}

fn conductor(world: &mut World<'_>, object: &Object) -> Option<(&'static str, Params)> {
    let params = metal::conductor(world, object)?;
    let params = world.color(params, object, ("specular_reflectance", "reflection"));
    Some(("conductor", if object.plugin == "conductor" { params } else { roughness(world, object, params) }))
}

fn dielectric(world: &mut World<'_>, object: &Object) -> Option<(&'static str, Params)> {
    let params = pane(world, object);
    Some((
        "dielectric",
        if object.plugin == "dielectric" { params } else { roughness(world, object, params) },
    ))
}

fn thin(world: &mut World<'_>, object: &Object) -> Option<(&'static str, Params)> {
    Some(("thindielectric", pane(world, object)))
}

/// Index and factors of glass.
fn pane(world: &mut World<'_>, object: &Object) -> Params {
    let params = Params::new().float("eta", relative(world, object, "bk7"));
    let params = world.color(params, object, ("specular_reflectance", "reflection"));
    world.color(params, object, ("specular_transmittance", "transmission"))
}

fn phong(world: &mut World<'_>, object: &Object) -> Option<(&'static str, Params)> {
    let params = world.color(Params::new(), object, ("diffuse_reflectance", "diffuse"));
    let params = match world.shade(object, "specular_reflectance", Role::Surface) {
        Some(shade) => super::world::with_shade(params, "specular", shade, object.at),
        None => params.rgb("specular", [0.2; 3]),
    };
    let exponent = object.number_or("exponent", 30.0, world.said) as f32;
    Some(("phong", params.float("exponent", exponent)))
}

fn transmitting(world: &mut World<'_>, object: &Object) -> Option<(&'static str, Params)> {
    let params = Params::new().rgb("reflectance", [0.0; 3]);
    Some((
        "diffusetransmission",
        match world.shade(object, "transmittance", Role::Surface) {
            Some(shade) => super::world::with_shade(params, "transmittance", shade, object.at),
            None => params.rgb("transmittance", [0.5; 3]),
        },
    ))
}
