//! T0 and T3 for materials: parameters, lobes, energy of every registered kind, normal maps.
mod material_shared;

use durer_core::{
    math::{Frame, Normal3, Vector3},
    spectrum::{Basis, Spectrum},
};
use durer_model::{
    Surface,
    bsdf::{BranchKind, Bsdf, Lobe},
    material::{MATERIALS, Material},
};
use durer_scene::{Data, Entry, ParamDefault, Params, ValueType};
use durer_testkit::{DVec3, quadrature::cosine_hemisphere, random::Random};
use material_shared::{CX, branches, bsdf, built, material, place, seen_under};

/// What the surface returns of a sky of radiance 1, as an integrator without sampling sees it.
fn seen_in_a_uniform_sky(bsdf: &Bsdf, wo: Vector3) -> f32 {
    let sharp: Spectrum = branches(bsdf, wo).iter().fold(Spectrum::BLACK, |sum, b| sum + b.weight);
    let gloss = bsdf.glossy(wo).map_or(Spectrum::BLACK, |g| g.weight);
    (bsdf.ambient() + gloss + sharp).max()
}

/// Parameter sets that stretch each kind; `classic` keeps its default, as its coefficients are what the user makes them.
fn corners(kind: &str) -> Vec<Params> {
    let mut sets = vec![Params::new()];
    match kind {
        "diffuse" | "mirror" => sets.push(Params::new().rgb("reflectance", [1.0; 3])),
        "dielectric" => sets.extend([0.5, 1.0, 2.4].map(|eta| Params::new().float("eta", eta))),
        "principled" => {
            for roughness in [0.0, 0.1, 0.3, 0.5, 1.0] {
                for (metallic, transmission, alpha) in
                    [(0.0, 0.0, 1.0), (1.0, 0.0, 1.0), (0.5, 0.5, 0.5), (0.0, 1.0, 1.0)]
                {
                    let p = Params::new().float("roughness", roughness).float("metallic", metallic);
                    let p = p.float("transmission", transmission).float("alpha", alpha);
                    sets.push(p.string("alphamode", "blend"));
                }
            }
        }
        _ => {}
    }
    sets
}

/// The kinds that need no other material (`tests/laws` mixes them).
fn alone() -> impl Iterator<Item = &'static Entry<Box<dyn Material>>> {
    MATERIALS.iter().filter(|e| e.schema.params.iter().all(|p| p.default != ParamDefault::Required))
}

#[test]
fn no_material_returns_more_than_arrives() {
    for entry in alone() {
        for params in corners(entry.schema.name) {
            let material = material(entry.schema.name, params.clone());
            for cos in [1.0, 0.7, 0.2, 0.01, -0.01, -0.5, -1.0] {
                let wo = seen_under(cos);
                let bsdf = bsdf(&*material, wo);
                let seen = seen_in_a_uniform_sky(&bsdf, wo);
                assert!(seen <= 1.0 + 1e-5, "{} {params:?} cos {cos}: {seen}", entry.schema.name);
                assert!(bsdf.albedo().max() <= 1.0);
                let side = f64::from(cos.signum());
                let lit = cosine_hemisphere(48, |wi| {
                    let wi = Vector3::from_f64(DVec3::new(wi.x, wi.y, wi.z * side));
                    f64::from(bsdf.eval(wo, wi).max())
                });
                // Narrow lobes need other points, see bsdf_energy; 48² points are coarse for them.
                let narrow = bsdf.lobes().any(|l| matches!(l, Lobe::Glossy(g) if g.facets.alpha() < 0.2));
                assert!(narrow || lit <= 1.0 + 0.02, "{} {params:?} cos {cos}: {lit}", entry.schema.name);
            }
        }
    }
}

#[test]
fn lossless_materials_vanish_in_a_uniform_sky() {
    for (kind, params) in [
        ("diffuse", Params::new().rgb("reflectance", [1.0; 3])),
        ("mirror", Params::new().rgb("reflectance", [1.0; 3])),
        ("dielectric", Params::new()),
        ("principled", Params::new()),
        ("principled", Params::new().float("transmission", 1.0).float("roughness", 0.0)),
        ("principled", Params::new().float("metallic", 1.0).float("roughness", 0.0)),
    ] {
        let material = material(kind, params.clone());
        for cos in [1.0, 0.5, 0.05] {
            let wo = seen_under(cos);
            let seen = seen_in_a_uniform_sky(&bsdf(&*material, wo), wo);
            assert!((seen - 1.0).abs() < 1e-5, "{kind} {params:?}: {seen}");
        }
    }
}

#[test]
fn opaque_materials_look_the_same_from_both_sides() {
    let mut random = Random::new(2);
    let direction = |r: &mut Random| Vector3::from_f64(r.direction());
    // Scales lean, and where a hair is hit is a matter of its sides.
    for entry in alone().filter(|e| !["dielectric", "hair"].contains(&e.schema.name)) {
        let material = material(entry.schema.name, Params::new());
        for _ in 0..200 {
            let (wo, wi) = (direction(&mut random), direction(&mut random));
            let (front, back) = (bsdf(&*material, wo).eval(wo, wi), bsdf(&*material, -wo).eval(-wo, -wi));
            assert!((front.mean() - back.mean()).abs() <= 1e-5 * front.mean(), "{}", entry.schema.name);
        }
    }
}

#[test]
fn classic_coefficients_become_lobes() {
    let wo = seen_under(0.6);
    let opaque = material("classic", Params::new().rgb("diffuse", [0.3; 3]));
    let opaque = bsdf(&*opaque, wo);
    assert!(branches(&opaque, wo).is_empty());
    assert_eq!(opaque.ambient(), Spectrum::splat(0.3));

    let params = Params::new().rgb("ambient", [0.1; 3]).rgb("reflection", [0.4; 3]).rgb("specular", [0.2; 3]);
    let shiny = material("classic", params.clone());
    let shiny = bsdf(&*shiny, wo);
    assert_eq!(shiny.ambient(), Spectrum::splat(0.1));
    let [r] = branches(&shiny, wo)[..] else { panic!("one branch") };
    assert_eq!((r.kind, r.weight), (BranchKind::Reflection, Spectrum::splat(0.4)));

    let glass = material("classic", params.rgb("transmission", [0.5; 3]).float("eta", 1.5));
    let glass = bsdf(&*glass, wo);
    let [r, t] = branches(&glass, wo)[..] else { panic!("two branches") };
    assert_eq!((r.weight, t.weight), (Spectrum::splat(0.4), Spectrum::splat(0.5)));
    assert!((t.wi.x + 0.8 / 1.5).abs() < 1e-6 && t.wi.z < 0.0);
    assert_eq!(glass.lobes().count(), 4);
}

#[test]
fn rough_glass_spreads() {
    let spreads = |params| {
        let (glass, said) = built("glass", params);
        let said: Vec<_> = said.iter().map(|d| (d.severity, d.message.clone())).collect();
        (bsdf(&*glass.expect("built"), seen_under(0.5)).spreads(), said)
    };
    assert_eq!(spreads(Params::new()), (false, vec![]));
    assert_eq!(spreads(Params::new().float("roughness", 0.3)), (true, vec![]));
    let (does, said) = spreads(Params::new().float("uroughness", 0.3).float("vroughness", 0.1));
    assert_eq!((does, said), (true, vec![]));
    let (_, said) = built("dielectric", Params::new().float("eta", 0.0));
    assert!(said.has_errors());
}

#[test]
fn coefficients_above_one_are_cut_with_a_warning() {
    let (matte, said) = built("matte", Params::new().rgb("reflectance", [0.5, 2.0, 0.5]));
    assert!(!said.has_errors() && said.iter().count() == 1);
    let wo = seen_under(0.5);
    assert_eq!(Basis::Rgb.to_rgb(bsdf(&*matte.expect("built"), wo).albedo()), [0.5, 1.0, 0.5]);
    // Measured spectra are pairs of wavelength and value.
    let pairs = Data::Floats(vec![400.0, 0.2, 700.0, 0.4]);
    let (matte, said) = built("diffuse", Params::new().with("reflectance", ValueType::Spectrum, pairs));
    assert!(!said.has_errors());
    assert!((bsdf(&*matte.expect("built"), wo).albedo().mean() - 0.3).abs() < 0.01);
}

#[test]
fn metals_are_tinted_and_dielectrics_are_not() {
    let wo = seen_under(1.0);
    let gold = Params::new().rgb("basecolor", [1.0, 0.7, 0.3]).float("roughness", 0.0);
    let metal = material("principled", gold.clone().float("metallic", 1.0));
    let metal = bsdf(&*metal, wo);
    let [r] = branches(&metal, wo)[..] else { panic!("one branch") };
    let rgb = Basis::Rgb.to_rgb(r.weight);
    assert!((rgb[0] - 1.0).abs() < 1e-6 && (rgb[1] - 0.7).abs() < 1e-6 && (rgb[2] - 0.3).abs() < 1e-6);
    assert_eq!(metal.ambient(), Spectrum::BLACK);

    let plastic = material("principled", gold);
    let plastic = bsdf(&*plastic, wo);
    let [r] = branches(&plastic, wo)[..] else { panic!("one branch") };
    assert!((r.weight.mean() - 0.04).abs() < 1e-6);
    let body = Basis::Rgb.to_rgb(plastic.ambient());
    assert!((body[0] - 0.96).abs() < 1e-5 && (body[2] - 0.288).abs() < 1e-5);
}

#[test]
fn coverage_lets_the_rest_pass_straight_on() {
    let wo = seen_under(0.8);
    let half = Params::new().rgb("basecolor", [0.0; 3]).float("alpha", 0.25).float("metallic", 1.0);
    let blend = material("principled", half.clone().string("alphamode", "blend"));
    let blend = bsdf(&*blend, wo);
    let [t] = branches(&blend, wo)[..] else { panic!("one branch") };
    assert_eq!((t.kind, t.wi, t.weight), (BranchKind::Transmission, -wo, Spectrum::splat(0.75)));

    let mask = material("principled", half.clone().string("alphamode", "mask"));
    assert!(mask.has_holes() && mask.is_hole(&CX, &place().texture_at()));
    let solid = material("principled", half.string("alphamode", "mask").float("alphacutoff", 0.2));
    let at = place().texture_at();
    assert!(!solid.is_hole(&CX, &at));
    // The vertices' alpha counts too.
    assert!(
        solid.is_hole(&CX, &durer_model::texture::TextureAt { vertex_color: [1.0, 1.0, 1.0, 0.5], ..at })
    );
    let opaque = material("principled", Params::new().float("alpha", 0.0));
    assert!(!opaque.has_holes() && branches(&bsdf(&*opaque, wo), wo).is_empty());
}

#[test]
fn vertex_colours_multiply_the_base_colour() {
    let material = material("principled", Params::new().rgb("basecolor", [0.5; 3]).float("eta", 1.0));
    let mut surface = Surface { vertex_color: [1.0, 0.5, 0.0, 1.0], ..place() };
    let rgb = Basis::Rgb.to_rgb(material.bsdf(&CX, &mut surface, seen_under(1.0)).ambient());
    assert!((rgb[0] - 0.5).abs() < 1e-6 && (rgb[1] - 0.25).abs() < 1e-6 && rgb[2] == 0.0);
}

#[test]
fn emission_is_colour_times_strength_and_coverage() {
    let params = Params::new().rgb("emission", [1.0, 0.5, 0.0]).float("emissionstrength", 8.0);
    let at = place().texture_at();
    let glow = material("principled", params.clone()).emission(&CX, &at);
    assert_eq!(Basis::Rgb.to_rgb(glow), [8.0, 4.0, 0.0]);
    let thin = params.float("alpha", 0.5).string("alphamode", "blend");
    assert_eq!(Basis::Rgb.to_rgb(material("principled", thin).emission(&CX, &at)), [4.0, 2.0, 0.0]);
}

fn tilted(surface: Surface, rgb: [f32; 3], scale: f32, wo: Vector3) -> Normal3 {
    let material = material("principled", Params::new().rgb("normal", rgb).float("normalscale", scale));
    let mut surface = surface;
    material.bsdf(&CX, &mut surface, wo);
    surface.n_s
}

#[test]
fn normal_maps_tilt_towards_growing_u_and_v() {
    let up = seen_under(1.0);
    let near = |n: Normal3, x: f32, y: f32, z: f32| (n - Normal3::new(x, y, z)).length() < 1e-5;
    assert!(near(tilted(place(), [0.5, 0.5, 1.0], 1.0, up), 0.0, 0.0, 1.0));
    assert!(near(tilted(place(), [0.8, 0.5, 0.9], 1.0, up), 0.6, 0.0, 0.8));
    assert!(near(tilted(place(), [0.5, 0.8, 0.9], 1.0, up), 0.0, 0.6, 0.8));
    assert!(near(tilted(place(), [0.8, 0.5, 0.9], -1.0, up), -0.6, 0.0, 0.8));
    let mirrored = Surface { dpdv: Vector3::new(0.0, -1.0, 0.0), ..place() };
    assert!(near(tilted(mirrored, [0.5, 0.8, 0.9], 1.0, up), 0.0, -0.6, 0.8));
    let bare = Surface { dpdu: Vector3::ZERO, dpdv: Vector3::ZERO, ..place() };
    assert!(near(tilted(bare, [0.8, 0.5, 0.9], 1.0, up), 0.0, 0.0, 1.0));
}

#[test]
fn tilted_normals_stay_outside_and_towards_the_viewer() {
    let mut random = Random::new(6);
    for _ in 0..10_000 {
        let n_g = random.direction();
        let bent = (n_g + 0.7 * random.direction()).normalize();
        let frame = Frame::from_z(Normal3::from_f64(bent));
        let surface = Surface {
            n_g: Normal3::from_f64(n_g),
            n_s: Normal3::from_f64(bent),
            dpdu: frame.x * 3.0,
            dpdv: frame.y,
            ..place()
        };
        let rgb = [0; 3].map(|_: i32| random.unit() as f32);
        let wo = Vector3::from_f64(random.direction());
        let n = tilted(surface, rgb, 2.0, wo);
        assert!((n.length() - 1.0).abs() < 1e-4 && surface.n_g.dot(n) > 0.0);
        let agrees = (n.dot(wo) > 0.0) == surface.is_outside(wo);
        assert!(agrees || n == surface.n_s, "{surface:?} {rgb:?} {wo:?}: {n:?}");
    }
}

#[test]
fn interfaces_are_not_there() {
    let nothing = material("interface", Params::new());
    assert!(nothing.has_holes() && nothing.is_hole(&CX, &place().texture_at()));
}

#[test]
fn unlit_surfaces_emit_their_colour_as_it_is_and_scatter_nothing() {
    let params =
        Params::new().rgb("basecolor", [1.0, 0.5, 0.25]).rgb("emission", [9.0; 3]).bool("unlit", true);
    let unlit = material("principled", params.clone());
    let mut surface = Surface { vertex_color: [0.5, 1.0, 1.0, 0.5], ..place() };
    let wo = seen_under(0.3);
    let seen = unlit.emission(&CX, &surface.texture_at());
    assert_eq!(Basis::Rgb.to_rgb(seen), [0.5, 0.5, 0.25]);
    let bare = unlit.bsdf(&CX, &mut surface, wo);
    assert!(bare.is_sharp() && branches(&bare, wo).is_empty() && bare.glossy(wo).is_none());
    assert_eq!(bare.ambient(), Spectrum::BLACK);
    // Half of it is there: the rest shows what lies behind.
    let half = material("principled", params.string("alphamode", "blend"));
    let seen = half.emission(&CX, &surface.texture_at());
    assert_eq!(Basis::Rgb.to_rgb(seen), [0.25, 0.25, 0.125]);
    let [t] = branches(&half.bsdf(&CX, &mut surface, wo), wo)[..] else { panic!("one branch") };
    assert_eq!((t.wi, t.weight), (-wo, Spectrum::splat(0.5)));
}

#[test]
fn blended_surfaces_are_holes_where_nothing_of_them_is_there() {
    let blend =
        |alpha| material("principled", Params::new().float("alpha", alpha).string("alphamode", "blend"));
    let at = place().texture_at();
    assert!(blend(0.0).is_hole(&CX, &at) && !blend(0.01).is_hole(&CX, &at));
    let clear = durer_model::texture::TextureAt { vertex_color: [1.0, 1.0, 1.0, 0.0], ..at };
    assert!(blend(1.0).has_holes() && blend(1.0).is_hole(&CX, &clear));
}

#[test]
fn normal_maps_turn_with_their_texture_transform() {
    let turned = |matrix: [f32; 4]| {
        let floats = Data::Floats(matrix.to_vec());
        let params = Params::new().rgb("normal", [0.8, 0.5, 0.9]).with("normaluv", ValueType::Float, floats);
        let mut surface = place();
        material("principled", params).bsdf(&CX, &mut surface, seen_under(1.0));
        surface.n_s
    };
    let near = |n: Normal3, x: f32, y: f32| (n - Normal3::new(x, y, 0.8)).length() < 1e-5;
    assert!(near(turned([3.0, 0.0, 0.0, 2.0]), 0.6, 0.0));
    // u' = -v: u' grows towards -v. u' = -u: the map is mirrored.
    assert!(near(turned([0.0, -1.0, 1.0, 0.0]), 0.0, -0.6));
    assert!(near(turned([-1.0, 0.0, 0.0, 1.0]), -0.6, 0.0));
    // Stretched to a line: as if there were no transform.
    assert!(near(turned([1.0, 0.0, 1.0, 0.0]), 0.6, 0.0));
    let (_, said) =
        built("principled", Params::new().with("normaluv", ValueType::Float, Data::Floats(vec![1.0])));
    assert!(said.has_errors());
}
