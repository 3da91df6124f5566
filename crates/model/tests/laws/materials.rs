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

use super::{sampling::energy, seen_from, slow, v};

const CX: ShadeCx<'static> = ShadeCx { basis: Basis::Rgb, textures: &[], log: None };

fn place() -> Surface {
    Surface {
        p: Point3::ZERO,
        p_error: Vector3::ZERO,
        n_g: Normal3::new(0.0, 0.0, 1.0),
        n_s: Normal3::new(0.0, 0.0, 1.0),
        uv: Point2::new(0.5, 0.5),
        second_uv: Point2::new(0.5, 0.5),
        face: 0,
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
                    let rough = || Params::new().float("roughness", 0.3);
                    sets.extend(words.iter().map(|word| rough().string(spec.name, word)));
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
    let metal = built("principled", brushed).expect("sound");
    let bsdf = metal.bsdf(&CX, &mut surface, up);
    let [across, along] = [Vector3::new(0.6, 0.0, 0.8), Vector3::new(0.0, 0.6, 0.8)]
        .map(|wi| bsdf.eval(surface.frame().to_local(up), surface.frame().to_local(wi)).mean());
    assert!(along > 5.0 * across, "{along} {across}");

    let glass = Params::new().float("transmission", 1.0).float("thickness", 0.1).float("eta", 1.4);
    let glass = glass.rgb("attenuationcolor", [0.25, 1.0, 1.0]).float("attenuationdistance", 2.0);
    let glass = built("principled", glass).expect("sound");
    let medium = glass.medium().expect("a body");
    assert_eq!(medium.eta_d, 1.4);
    let left = Basis::Rgb.to_rgb(medium.transmittance(&Basis::Rgb, 2.0));
    assert!((left[0] - 0.25).abs() < 1e-6 && left[1] == 1.0, "{left:?}");
    assert!(!glass.is_passed() && built("principled", Params::new()).expect("sound").medium().is_none());
}

#[test]
fn brushes_follow_the_directions_of_a_texture() {
    let up = Vector3::new(0.0, 0.0, 1.0);
    let brushed = || Params::new().float("metallic", 1.0).float("roughness", 0.3).float("anisotropy", 0.9);
    let value = |params: Params, surface: &Surface, wi: Vector3| {
        let mut surface = *surface;
        let material = built("principled", params).expect("sound");
        let bsdf = material.bsdf(&CX, &mut surface, up);
        bsdf.eval(surface.frame().to_local(up), surface.frame().to_local(wi)).mean()
    };
    let plain = Surface { dpdu: Vector3::new(2.0, 0.0, 0.0), dpdv: Vector3::new(0.0, 3.0, 0.0), ..place() };
    let mirrored = Surface { dpdv: Vector3::new(0.0, -3.0, 0.0), ..plain };
    for wi in [Vector3::new(0.6, 0.0, 0.8), Vector3::new(0.0, 0.6, 0.8), Vector3::new(0.36, 0.48, 0.8)] {
        for surface in [&plain, &mirrored] {
            // Red is along u and green along v, 0.5 is none of it.
            let along_v = value(brushed().rgb("anisotropydirection", [0.5, 1.0, 0.0]), surface, wi);
            let turned =
                value(brushed().float("anisotropyrotation", std::f32::consts::FRAC_PI_2), surface, wi);
            assert!((along_v / turned - 1.0).abs() < 1e-3, "{along_v} {turned}");
        }
        // Where v runs the other way, so does the direction between u and v.
        let slanting =
            |surface, wi| value(brushed().rgb("anisotropydirection", [0.9, 0.8, 0.0]), surface, wi);
        let (a, b) = (slanting(&plain, wi), slanting(&mirrored, Vector3::new(wi.x, -wi.y, wi.z)));
        assert!((a / b - 1.0).abs() < 1e-3, "{a} {b}");
    }
}

#[test]
fn coats_have_the_normal_of_the_shape_or_one_of_their_own() {
    let up = Vector3::new(0.0, 0.0, 1.0);
    let coated = || Params::new().float("clearcoat", 1.0).float("roughness", 1.0).rgb("basecolor", [0.0; 3]);
    // The one sharp direction: that of the coat.
    let mirrored = |params: Params| {
        let mut surface = place();
        let material = built("principled", params).expect("sound");
        let bsdf = material.bsdf(&CX, &mut surface, up);
        let branches = bsdf.sharp(surface.frame().to_local(up));
        let all: Vec<_> =
            branches.iter().map(|b| (surface.frame().to_world(b.wi), b.weight.mean())).collect();
        assert_eq!(all.len(), 1, "{all:?}");
        all[0]
    };
    let leaning = [0.5, 0.5 + 0.5 * 0.6, 0.5 + 0.5 * 0.8];
    let (plain, weight) = mirrored(coated());
    assert!((plain - up).length() < 1e-6 && (weight - 0.04).abs() < 1e-6);
    // The map of the surface below does not concern the coat.
    let (below, kept) = mirrored(coated().rgb("normal", leaning));
    assert!((below - up).length() < 1e-3 && (kept - 0.04).abs() < 1e-6, "{below:?} {kept}");
    // Its own does: the normal leans by the angle whose sine is 0.6, and the mirrored ray by twice that.
    let (own, _) = mirrored(coated().rgb("clearcoatnormal", leaning));
    assert!((own.z - 0.28).abs() < 1e-3, "{own:?}");
    let (half, _) = mirrored(coated().rgb("clearcoatnormal", leaning).float("clearcoatnormalscale", 0.5));
    assert!(half.z > own.z + 0.1 && half.z < 1.0, "{half:?}");
    let (both, weight) = mirrored(coated().rgb("clearcoatnormal", leaning).rgb("normal", leaning));
    assert!((both.z - 0.28).abs() < 1e-3 && (0.04..0.06).contains(&weight), "{both:?} {weight}");
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
            // The table of the split sum is good to a percent. Disney's formulas add up to more, along the surface.
            let most = if name.starts_with("disney") { 1.3 } else { 1.012 };
            assert!(mean <= most + 4.0 * sigma, "{name} {wo:?}: {mean} +- {sigma}");
            assert!(bsdf.albedo().max() <= 1.0 && bsdf.ambient().max() <= 1.001, "{name}");
            if material.is_walked() {
                let mut surface = place();
                let open = material.open_bsdf(&CX, &mut surface, wo);
                let (mean, sigma) = energy(&open, surface.frame().to_local(wo), count, &mut random);
                assert!(mean <= 1.0 + 4.0 * sigma + 0.012, "{name} {wo:?}, open: {mean} +- {sigma}");
            }
        }
    }
}

/// Whether a material with these parameters is known to depend on the view: what lies under a coat, fibres or a film.
fn depends_on_the_view(name: &str) -> bool {
    ["clearcoat", "sheencolor", "iridescence"].iter().any(|word| name.contains(word))
}

#[test]
fn materials_are_reciprocal_e5() {
    let mut random = Random::new(93);
    let mut kinds = 0;
    for (name, material) in stretched() {
        // Hair attenuates by what the viewer sees (Chiang and others 2016).
        if name.starts_with("hair") {
            continue;
        }
        // A walk between layers is an estimate: its lobe is tested by itself.
        if depends_on_the_view(&name) || name.starts_with("coatedconductor") {
            continue;
        }
        kinds += 1;
        for _ in 0..100 {
            let (o, i) = (v(random.direction()), v(random.direction()));
            if o.z.abs().min(i.z.abs()) < 0.02 {
                continue;
            }
            // Radiance by the square of the index on the side of the viewer.
            let value = |o, i| {
                let mut surface = place();
                let bsdf = material.bsdf(&CX, &mut surface, o);
                let frame = surface.frame();
                let (o, i) = (frame.to_local(o), frame.to_local(i));
                let eta = bsdf.fresnel(o).map_or(1.0, |seen| seen.eta);
                let crossed = if o.z * i.z < 0.0 { eta } else { 1.0 };
                bsdf.eval_radiance(o, i).mean() * crossed
            };
            let (there, back) = (value(o, i), value(i, o));
            let off = (there - back).abs();
            assert!(off <= 2e-3 * there.max(back).max(1e-3), "{name} {o:?} {i:?}: {there} {back}");
        }
    }
    assert!(kinds > 60, "{kinds}");
}

/// The sum of glTF's material in a uniform sky, seen under a cosine.
fn furnace(params: Params, cos: f32) -> f64 {
    let wo = Vector3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
    let material = built("principled", params).expect("sound");
    let bsdf = material.bsdf(&CX, &mut place(), wo);
    energy(&bsdf, wo, 60_000, &mut Random::new(94)).0
}

#[test]
fn a_white_body_under_whatever_reflects_loses_nothing() {
    for (params, lost) in [
        (Params::new().float("roughness", 0.4), 0.02),
        (
            Params::new().float("roughness", 0.4).float("clearcoat", 1.0).float("clearcoatroughness", 0.3),
            0.02,
        ),
        (Params::new().float("roughness", 0.4).float("diffusetransmission", 0.5), 0.02),
        // What facets would send back does not pass the sheet.
        (Params::new().float("roughness", 0.3).float("transmission", 1.0), 0.07),
        (Params::new().float("roughness", 0.0).float("transmission", 1.0), 1e-3),
    ] {
        for cos in [1.0, 0.6, 0.3] {
            let sum = furnace(params.clone(), cos);
            assert!(sum < 1.012 && sum > 1.0 - lost, "{params:?} {cos}: {sum}");
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
    let mixed = mixture(grey(0.8), mirror(), 0.25).expect("two materials");
    let mixed = mixed.bsdf(&CX, &mut place(), wo);
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
    let half = half.bsdf(&CX, &mut place(), wo);
    assert_eq!(half.branches(wo).iter().map(|b| b.weight.mean()).collect::<Vec<_>>(), [0.5]);
    assert!(mixture(hole(), hole(), 0.5).expect("two").is_hole(&CX, &place().texture_at()));
    // Ends are one of both.
    let end = mixture(grey(0.8), mirror(), 1.0).expect("two");
    assert_eq!(end.bsdf(&CX, &mut place(), wo).ambient().mean(), 0.0);
    assert!(mixture(grey(0.8), Node::new("mixed", Params::new()), 0.5).is_none());
}

/// A mask around a grey surface.
fn mask(params: Params) -> Box<dyn Material> {
    let grey = Node::new("diffuse", Params::new().rgb("reflectance", [0.8; 3]));
    let before = [NamedNode { name: "grey".into(), node: grey }];
    let mut diagnostics = Diagnostics::default();
    let node = Node::new("mask", params.string("material", "grey"));
    let entry = find(MATERIALS, "material", &node, &mut diagnostics).expect("a registered material");
    let mut args = Args::check(&node, entry.schema, &[], &mut diagnostics).with_before(&before);
    (entry.build)(&mut args).filter(|_| args.is_sound()).expect("a mask")
}

#[test]
fn masks_let_the_rest_pass_and_cut_holes() {
    let (wo, at) = (seen_from()[0], place().texture_at());
    let half = mask(Params::new().float("alpha", 0.25));
    let bsdf = half.bsdf(&CX, &mut place(), wo);
    assert!((bsdf.ambient().mean() - 0.2).abs() < 1e-6 && (bsdf.passed(wo).mean() - 0.75).abs() < 1e-6);
    assert!(half.is_passed() && !half.is_hole(&CX, &at) && half.coverage(&CX, &at) == 0.25);
    let none = mask(Params::new().float("alpha", 0.0));
    assert!(none.is_hole(&CX, &at) && none.coverage(&CX, &at) == 0.0);
    let whole = mask(Params::new());
    assert!(!whole.is_hole(&CX, &at) && whole.coverage(&CX, &at) == 1.0);
    let cut = |alpha: f32| mask(Params::new().float("alpha", alpha).string("alphamode", "mask"));
    assert!(cut(0.4).is_hole(&CX, &at) && cut(0.6).coverage(&CX, &at) == 1.0);
    assert_eq!(cut(0.6).bsdf(&CX, &mut place(), wo).ambient().mean(), 0.8);
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
