//! Coats and panes as Mitsuba has them: bodies that keep their colour, factors on what is mirrored, facets that hide each other
//! for each direction by itself.
mod material_shared;

use durer_core::math::Vector3;
use durer_model::bsdf::BranchKind;
use durer_scene::Params;
use material_shared::{branches, bsdf, material, seen_under};

/// What a smooth dielectric reflects, and the mean of that over the cosine: Fresnel's equations, in double precision.
fn fresnel(cos: f64, eta: f64) -> f64 {
    let squared = 1.0 - (1.0 - cos * cos) / (eta * eta);
    if squared <= 0.0 {
        return 1.0;
    }
    let inside = squared.sqrt();
    let (s, p) = ((cos - eta * inside) / (cos + eta * inside), (eta * cos - inside) / (eta * cos + inside));
    0.5 * (s * s + p * p)
}

#[test]
fn bodies_of_plastic_keep_their_colour_where_they_are_told_to() {
    let (eta, n) = (1.49f64, 4096);
    let inside: f64 = (0..n)
        .map(|i| (f64::from(i) + 0.5) / f64::from(n))
        .map(|c| 2.0 * c * fresnel(c, 1.0 / eta))
        .sum::<f64>()
        / f64::from(n);
    for r in [0.1f32, 0.5, 0.9] {
        for nonlinear in [false, true] {
            let params = Params::new().float("eta", eta as f32).float("thickness", 0.0).int("maxdepth", 1000);
            let params = params.rgb("reflectance", [r; 3]).bool("nonlinear", nonlinear);
            let plastic = material("coateddiffuse", params);
            let (wo, wi) = (seen_under(0.8), Vector3::new(0.0, -0.866_025_4, 0.5));
            let found = f64::from(bsdf(&*plastic, wo).eval(wo, wi).lanes()[0]);
            let r = f64::from(r);
            // Mitsuba's formula, T(wi) T(wo) r / (pi eta² (1 - F)), or 1 - r F below.
            let again = if nonlinear { r } else { 1.0 };
            let passed = (1.0 - fresnel(0.8, eta)) * (1.0 - fresnel(0.5, eta));
            let expected = passed * r / (std::f64::consts::PI * eta * eta * (1.0 - again * inside));
            assert!((found / expected - 1.0).abs() < 3e-3, "{r} {nonlinear}: {found}, expected {expected}");
        }
    }
}

#[test]
fn factors_dim_what_coats_and_panes_reflect_and_let_through() {
    let wo = seen_under(0.6);
    for (kind, name, which) in [
        ("coateddiffuse", "reflection", BranchKind::Reflection),
        ("thindielectric", "reflection", BranchKind::Reflection),
        ("thindielectric", "transmission", BranchKind::Transmission),
    ] {
        let all = |params| -> Vec<(BranchKind, f32)> {
            let material = material(kind, params);
            let bsdf = bsdf(&*material, wo);
            branches(&bsdf, wo).iter().map(|b| (b.kind, b.weight.lanes()[0])).collect()
        };
        let (whole, dimmed) = (all(Params::new()), all(Params::new().rgb(name, [0.25; 3])));
        assert_eq!(whole.len(), dimmed.len(), "{kind}");
        for (whole, dimmed) in whole.iter().zip(&dimmed) {
            let factor = if whole.0 == which { 0.25 } else { 1.0 };
            assert!((dimmed.1 - factor * whole.1).abs() < 1e-6, "{kind} {name}: {whole:?} {dimmed:?}");
        }
        assert!(whole.iter().any(|(found, weight)| *found == which && *weight > 0.0), "{kind} {name}");
    }
    // A rough coat as well.
    let rough = |params: Params| {
        material("coateddiffuse", params.float("roughness", 0.2).rgb("reflectance", [0.0; 3]))
    };
    let wi = Vector3::new(-wo.x, -wo.y, wo.z);
    let [whole, dimmed] = [Params::new(), Params::new().rgb("reflection", [0.25; 3])]
        .map(|params| bsdf(&*rough(params), wo).eval(wo, wi).lanes()[0]);
    assert!(whole > 0.0 && (dimmed / whole - 0.25).abs() < 1e-5, "{whole} {dimmed}");
}

#[test]
fn facets_that_hide_each_other_apart_are_darker_by_the_closed_form() {
    let alpha = 0.5f64;
    let metal = |shadowing: &str| {
        let params = Params::new().float("roughness", alpha as f32).bool("remaproughness", false);
        material("conductor", params.string("shadowing", shadowing).rgb("reflectance", [1.0; 3]))
    };
    let (wo, wi) = (seen_under(0.4), Vector3::new(-0.6, 0.0, 0.8));
    let [apart, together] =
        ["separable", "correlated"].map(|word| f64::from(bsdf(&*metal(word), wo).eval(wo, wi).lanes()[0]));
    // Smith's Lambda of GGX (Heitz 2014, equation 72).
    let lambda = |cos: f64| 0.5 * ((1.0 + alpha * alpha * (1.0 / (cos * cos) - 1.0)).sqrt() - 1.0);
    let (o, i) = (lambda(0.4), lambda(0.8));
    let expected = (1.0 + o + i) / ((1.0 + o) * (1.0 + i));
    assert!((apart / together - expected).abs() < 1e-4, "{} {expected}", apart / together);
}
