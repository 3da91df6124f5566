//! Every registered material, with its defaults and with parameters that stretch it: no more leaves than arrives.
use durer_core::{
    math::{Normal3, Point2, Point3, Vector3},
    spectrum::{Basis, Color},
};
use durer_model::{
    ShadeCx, Surface,
    material::{MATERIALS, Material},
    texture::{Footprint, Texture, TextureAt},
};
use durer_scene::{
    Args, Data, Diagnostics, NamedNode, Node, ParamType, Params, TextureDesc, TextureValue, ValueType, find,
};
use durer_testkit::random::Random;

use super::{sampling::energy, seen_from, slow};

const CX: ShadeCx<'static> = ShadeCx { basis: Basis::Rgb, textures: &[], log: None };

fn place() -> Surface {
    Surface {
        p: Point3::ZERO,
        p_error: Vector3::ZERO,
        n_g: Normal3::new(0.0, 0.0, 1.0),
        n_s: Normal3::new(0.0, 0.0, 1.0),
        uv: Point2::new(0.5, 0.5),
        second_uv: Point2::new(0.5, 0.5),
        dpdu: Vector3::new(2.0, 1.0, 0.0),
        dpdv: Vector3::new(0.0, 0.5, 0.0),
        vertex_color: [1.0; 4],
        footprint: Footprint::POINT,
    }
}

/// The material; `None` if it does not take these parameters.
fn built(kind: &str, params: Params) -> Option<Box<dyn Material>> {
    let mut diagnostics = Diagnostics::default();
    let node = Node::new(kind, params);
    let entry = find(MATERIALS, "material", &node, &mut diagnostics).expect("a registered material");
    let mut args = Args::check(&node, entry.schema, &[], &mut diagnostics);
    let material = args.is_sound().then(|| (entry.build)(&mut args)).flatten();
    material.filter(|_| !diagnostics.has_errors())
}

/// Every number of a schema that has a range from 0 to 1, all at once or one by one at an end, and all colours white.
fn stretched() -> Vec<(String, Box<dyn Material>)> {
    let mut all = Vec::new();
    for entry in MATERIALS.iter().filter(|e| e.schema.name != "classic") {
        let mut sets = vec![Params::new()];
        let white =
            |params: Params, name: &str| params.with(name, ValueType::Rgb, Data::Floats(vec![1.0; 3]));
        for spec in entry.schema.params {
            match spec.ty {
                ParamType::Float | ParamType::FloatTexture if spec.range == (0.0, 1.0) => {
                    sets.extend([0.1, 0.5, 1.0].map(|v| Params::new().float(spec.name, v)));
                }
                ParamType::FloatTexture if spec.range == (0.0, 90.0) => {
                    sets.push(Params::new().float(spec.name, 90.0));
                }
                ParamType::ColorTexture if spec.name != "normal" => {
                    sets.push(white(Params::new(), spec.name));
                    let rough = Params::new().float("roughness", 0.3);
                    sets.push(white(rough, spec.name));
                }
                ParamType::Choice(words) => {
                    sets.extend(words.iter().map(|word| Params::new().string(spec.name, word)));
                }
                _ => {}
            }
        }
        if entry.schema.name == "principled" {
            sets.extend(everything());
        }
        for params in sets {
            if let Some(material) = built(entry.schema.name, params.clone()) {
                all.push((format!("{} {params:?}", entry.schema.name), material));
            }
        }
    }
    all
}

/// The glTF material with all of its extensions at once.
fn everything() -> Vec<Params> {
    let all = |thickness: f32, roughness: f32| {
        Params::new()
            .float("roughness", roughness)
            .float("clearcoat", 0.7)
            .float("clearcoatroughness", 0.4)
            .rgb("sheencolor", [0.9, 0.5, 0.2])
            .float("sheenroughness", 0.6)
            .float("anisotropy", 0.8)
            .float("iridescence", 0.5)
            .float("diffusetransmission", 0.4)
            .float("transmission", 0.5)
            .float("thickness", thickness)
            .float("metallic", 0.2)
            .rgb("specularcolor", [1.0, 0.4, 0.4])
    };
    [(0.0, 0.5), (0.01, 0.5), (0.01, 0.0)].map(|(thickness, roughness)| all(thickness, roughness)).into()
}

#[test]
fn brushed_metal_reflects_more_along_the_brush_and_bodies_have_a_medium() {
    let up = Vector3::new(0.0, 0.0, 1.0);
    let brushed = Params::new().float("metallic", 1.0).float("roughness", 0.3).float("anisotropy", 0.9);
    let mut surface = Surface { dpdu: Vector3::new(0.0, 3.0, 0.0), ..place() };
    let bsdf = built("principled", brushed).expect("sound").bsdf(&CX, &mut surface, up);
    let [across, along] = [Vector3::new(0.6, 0.0, 0.8), Vector3::new(0.0, 0.6, 0.8)]
        .map(|wi| bsdf.eval(surface.frame().to_local(up), surface.frame().to_local(wi)).mean());
    assert!(along > 5.0 * across, "{along} {across}");

    let glass = Params::new().float("transmission", 1.0).float("thickness", 0.1).float("eta", 1.4);
    let glass = glass.rgb("attenuationcolor", [0.25, 1.0, 1.0]).float("attenuationdistance", 2.0);
    let glass = built("principled", glass).expect("sound");
    let medium = glass.medium().expect("a body");
    assert_eq!(medium.eta, 1.4);
    let left = Basis::Rgb.to_rgb(medium.transmittance(Basis::Rgb, 2.0));
    assert!((left[0] - 0.25).abs() < 1e-6 && left[1] == 1.0, "{left:?}");
    assert!(!glass.is_passed() && built("principled", Params::new()).expect("sound").medium().is_none());
}

#[test]
fn no_material_scatters_more_than_arrives() {
    let mut random = Random::new(91);
    let count = if slow() { 100_000 } else { 4_000 };
    let all = stretched();
    assert!(all.len() > MATERIALS.len() * 3, "{}", all.len());
    for (name, material) in all {
        for wo in seen_from() {
            let mut surface = place();
            let bsdf = material.bsdf(&CX, &mut surface, wo);
            let local = surface.frame().to_local(wo);
            let (mean, sigma) = energy(&bsdf, local, count, &mut random);
            // The table of the split sum is good to a percent.
            assert!(mean <= 1.0 + 4.0 * sigma + 0.012, "{name} {wo:?}: {mean} +- {sigma}");
            assert!(bsdf.albedo().max() <= 1.0 && bsdf.ambient().max() <= 1.001, "{name}");
        }
    }
}

/// A mixture of two described materials.
fn mixture(first: Node, second: Node, amount: f32) -> Option<Box<dyn Material>> {
    let before =
        [("first", first), ("second", second)].map(|(name, node)| NamedNode { name: name.into(), node });
    let names = Data::Strings(vec!["first".into(), "second".into()]);
    let params = Params::new().with("materials", ValueType::String, names).float("amount", amount);
    let mut diagnostics = Diagnostics::default();
    let node = Node::new("mix", params);
    let entry = find(MATERIALS, "material", &node, &mut diagnostics).expect("a registered material");
    let mut args = Args::check(&node, entry.schema, &[], &mut diagnostics).with_before(&before);
    (entry.build)(&mut args).filter(|_| args.is_sound())
}

#[test]
fn mixtures_are_weighted_sums() {
    let grey = |v: f32| Node::new("diffuse", Params::new().rgb("reflectance", [v; 3]));
    let mirror = || Node::new("mirror", Params::new().rgb("reflectance", [0.5; 3]));
    let wo = seen_from()[0];
    let bsdf = |material: Box<dyn Material>| material.bsdf(&CX, &mut place(), wo);
    let mixed = bsdf(mixture(grey(0.8), mirror(), 0.25).expect("two materials"));
    assert!((mixed.ambient().mean() - 0.6).abs() < 1e-6);
    let branches: Vec<_> = mixed.branches(wo).iter().map(|b| b.weight.mean()).collect();
    assert_eq!(branches, [0.125]);
    let mut random = Random::new(92);
    let (mean, sigma) = energy(&mixed, wo, 20_000, &mut random);
    assert!((mean - 0.725).abs() < 4.0 * sigma + 1e-4, "{mean} +- {sigma}");
    // A hole is mixed in as something clear; two are a hole.
    let hole = || Node::new("interface", Params::new());
    let half = mixture(grey(1.0), hole(), 0.5).expect("two materials");
    assert!(half.is_passed() && !half.is_hole(&CX, &place().texture_at()));
    assert_eq!(bsdf(half).branches(wo).iter().map(|b| b.weight.mean()).collect::<Vec<_>>(), [0.5]);
    assert!(mixture(hole(), hole(), 0.5).expect("two").is_hole(&CX, &place().texture_at()));
    // Ends are one of both.
    assert_eq!(bsdf(mixture(grey(0.8), mirror(), 1.0).expect("two")).ambient().mean(), 0.0);
    assert!(mixture(grey(0.8), Node::new("mixed", Params::new()), 0.5).is_none());
}

#[test]
fn mixtures_name_only_what_comes_before_them() {
    let names = Data::Strings(vec!["first".into(), "second".into()]);
    let own = Node::new("mix", Params::new().with("materials", ValueType::String, names));
    assert!(mixture(own, Node::new("diffuse", Params::new()), 0.5).is_none());
}

/// Heights that rise along u, and along v twice as fast, to 3 cm per unit.
#[derive(Debug)]
struct Slope;

impl Texture for Slope {
    fn largest(&self, _: &ShadeCx<'_>) -> f32 {
        f32::INFINITY
    }
    fn color(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Color {
        Color::gray(self.float(cx, at))
    }
    fn float(&self, _: &ShadeCx<'_>, at: &TextureAt) -> f32 {
        0.03 * (at.uv.x + 2.0 * at.uv.y)
    }
}

#[test]
fn bumps_tilt_the_normal_against_the_slope() {
    let desc = TextureDesc {
        name: "slope".into(),
        value: TextureValue::Float,
        node: Node::new("constant", Params::new()),
        world_from_texture: durer_core::glam::DAffine3::IDENTITY,
    };
    let node = Node::new("diffuse", Params::new().texture("displacement", "slope"));
    let mut diagnostics = Diagnostics::default();
    let entry = find(MATERIALS, "material", &node, &mut diagnostics).expect("a registered material");
    let descs = [desc];
    let mut args = Args::check(&node, entry.schema, &descs, &mut diagnostics);
    let material = (entry.build)(&mut args).expect("sound");
    let textures: [Box<dyn Texture>; 1] = [Box::new(Slope)];
    let cx = ShadeCx { textures: &textures, ..CX };
    let mut surface =
        Surface { dpdu: Vector3::new(0.1, 0.0, 0.0), dpdv: Vector3::new(0.0, 0.2, 0.0), ..place() };
    material.bsdf(&cx, &mut surface, Vector3::new(0.0, 0.0, 1.0));
    // The surface rises by 0.3 along x and along y.
    let expected = Normal3::new(-0.3, -0.3, 1.0).normalize();
    assert!((surface.n_s - expected).length() < 1e-3, "{:?}", surface.n_s);
}
