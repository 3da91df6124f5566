//! T3 for lobes: reciprocity, white furnaces, the split-sum table.
use durer_core::{math::Vector3, spectrum::Spectrum};
use durer_model::bsdf::{BranchKind, Bsdf, Distribution, Facets, Glossy, Highlight, Lobe, Reflectance};
use durer_testkit::{
    DVec3,
    microfacet::{Facets as Exact, Like},
    quadrature::cosine_hemisphere,
    random::Random,
};

fn glossy(f0: f32, alpha: f32) -> Glossy {
    let reflectance = Reflectance::Schlick { f0: Spectrum::splat(f0), f90: Spectrum::ONE };
    Glossy { reflectance, facets: Facets::round(alpha), scale: 1.0 }
}

/// The same with the facets of the oracle.
fn like(f0: f32, exact: Exact) -> Glossy {
    let facets = Facets::round(exact.alpha as f32);
    let distribution = match exact.like {
        Like::Ggx => Distribution::Ggx,
        Like::Beckmann => Distribution::Beckmann,
    };
    Glossy { facets: facets.distributed(distribution), ..glossy(f0, exact.alpha as f32) }
}

/// Facets of these widths, of both distributions.
fn both(alphas: &[f64]) -> Vec<Exact> {
    alphas.iter().flat_map(|alpha| [Exact::ggx(*alpha), Exact::beckmann(*alpha)]).collect()
}

/// Every lobe that reflects lights and obeys physics. `Highlight` is left out: the classic formula is neither reciprocal
/// nor energy conserving (2026-11-22).
fn physical_lobes() -> Vec<Lobe<'static>> {
    let mut lobes = vec![Lobe::Diffuse { albedo: Spectrum::ONE }];
    for exact in both(&[0.001, 0.01, 0.1, 0.25, 0.5, 1.0]) {
        lobes.extend([0.0, 0.04, 1.0].map(|f0| Lobe::Glossy(like(f0, exact))));
    }
    lobes
}

fn v(w: DVec3) -> Vector3 {
    Vector3::from_f64(w)
}

fn seen_under(cos: f64) -> DVec3 {
    DVec3::new((1.0 - cos * cos).sqrt(), 0.0, cos)
}

#[test]
fn lobes_are_reciprocal_and_the_same_from_both_sides() {
    let mut random = Random::new(1);
    for lobe in physical_lobes() {
        for _ in 0..1000 {
            let (wo, wi) = (v(random.direction()), v(random.direction()));
            let (there, back) = (lobe.eval(wo, wi).mean(), lobe.eval(wi, wo).mean());
            assert!((there - back).abs() <= 1e-5 * there.max(back), "{lobe:?} {wo:?} {wi:?}: {there} {back}");
            assert!((there - lobe.eval(-wo, -wi).mean()).abs() <= 1e-5 * there, "{lobe:?}");
            assert!(there == 0.0 || wo.z * wi.z > 0.0, "{lobe:?} transmits");
        }
    }
}

#[test]
fn no_direction_gives_nan_or_infinity() {
    let tiny = [0.0, 1e-30, 1e-20, 1e-7, 1e-3, 1.0];
    let mut directions = Vec::new();
    for z in tiny {
        for side in [-1.0, 1.0] {
            let r = (1.0f32 - z * z).sqrt();
            directions.extend([[r, 0.0], [-r, 0.0], [0.0, r]].map(|[x, y]| Vector3::new(x, y, side * z)));
        }
    }
    let specular = Spectrum::splat(0.5);
    let classic = [0.0, 1.0, 1e4].map(|exponent| Lobe::Highlight(Highlight { specular, exponent }));
    for lobe in physical_lobes().into_iter().chain(classic) {
        for &wo in &directions {
            for &wi in &directions {
                let f = lobe.eval(wo, wi);
                assert!(f.is_finite() && f.mean() >= 0.0, "{lobe:?} {wo:?} {wi:?}: {f:?}");
                assert!((f * wi.z.abs()).is_finite());
            }
            let bsdf = Bsdf::default().with(lobe);
            assert!(bsdf.branches(wo).iter().all(|b| b.weight.is_finite() && b.wi.is_finite()));
            assert!(bsdf.glossy(wo).is_none_or(|g| g.weight.is_finite()));
        }
    }
}

/// `integral f cos` of the lobe under test, with points where the double-precision lobe has its mass.
fn furnace(lobe: &Lobe, facets: Exact, wo: DVec3, n: usize) -> f64 {
    facets.integrate(wo, n, |wi, _| f64::from(lobe.eval(v(wo), v(wi)).mean()) * wi.z)
}

#[test]
fn the_white_furnace_of_a_diffuse_lobe_is_one() {
    let lobe = Lobe::Diffuse { albedo: Spectrum::ONE };
    let wo = Vector3::new(0.6, 0.0, 0.8);
    let sum = cosine_hemisphere(32, |wi| f64::from(lobe.eval(wo, v(wi)).mean()));
    assert!((sum - 1.0).abs() < 1e-6);
}

#[test]
fn the_white_furnace_of_glossy_lobes_matches_closed_forms() {
    let table = [
        (1.0, 0.1, 0.988304),
        (1.0, 0.25, 0.915812),
        (1.0, 0.5, 0.687849),
        (1.0, 1.0, 0.306853),
        (0.5, 0.5, 0.698251),
        (0.5, 1.0, 0.450694),
    ];
    for (cos, alpha, expected) in table {
        let sum = furnace(&Lobe::Glossy(glossy(1.0, alpha as f32)), Exact::ggx(alpha), seen_under(cos), 500);
        assert!((sum - expected).abs() < 1e-3, "cos {cos} alpha {alpha}: {sum}");
    }
}

#[test]
fn the_white_furnace_of_both_distributions_is_the_oracles() {
    for exact in both(&[0.1, 0.3, 0.6, 1.0]) {
        for cos in [0.15, 0.4, 0.8, 1.0] {
            let sum = furnace(&Lobe::Glossy(like(1.0, exact)), exact, seen_under(cos), 200);
            let (a, b) = exact.albedo(cos, 200);
            assert!((sum - a - b).abs() < 1e-4, "{exact:?} {cos}: {sum} {}", a + b);
        }
    }
}

#[test]
fn no_lobe_reflects_more_than_arrives() {
    for exact in both(&[0.001, 0.02, 0.1, 0.3, 0.6, 1.0]) {
        for cos in [0.01, 0.1, 0.3, 0.6, 0.9, 1.0] {
            for f0 in [0.0, 0.04, 1.0] {
                let sum = furnace(&Lobe::Glossy(like(f0, exact)), exact, seen_under(cos), 100);
                assert!(sum <= 1.0 + 1e-3, "{exact:?} cos {cos} f0 {f0}: {sum}");
            }
        }
    }
}

#[test]
fn the_split_sum_is_near_the_integral() {
    for exact in both(&[0.004, 0.03, 0.1, 0.22, 0.35, 0.6, 0.9]) {
        for cos in [0.02, 0.07, 0.15, 0.33, 0.5, 0.8, 0.97] {
            let (a, b) = exact.albedo(cos, 400);
            for f0 in [0.0, 0.04, 0.5, 1.0] {
                let got = like(f0, exact).directional_albedo(v(seen_under(cos))).mean();
                let expected = f64::from(f0) * a + b;
                assert!((f64::from(got) - expected).abs() < 0.015, "{exact:?} {cos} {f0}: {got} {expected}");
                assert!(got <= 1.0);
            }
        }
    }
}

#[test]
fn branch_and_view_of_a_glossy_lobe_weigh_its_directional_albedo() {
    let wo = v(seen_under(0.4));
    for alpha in [0.0, 0.0005, 0.001, 0.01, 0.02, 0.05, 0.1, 0.19, 0.2, 0.5, 1.0] {
        let lobe = Glossy { scale: 0.5, ..glossy(0.3, alpha) };
        let bsdf = Bsdf::default().with(Lobe::Glossy(lobe));
        let branch = bsdf.branches(wo).iter().map(|b| (b.kind, b.weight)).next();
        let view = bsdf.glossy(wo);
        assert_eq!(branch.is_some(), alpha < 0.2);
        assert_eq!(view.is_some(), alpha > 0.02);
        assert!(branch.is_none_or(|(kind, _)| kind == BranchKind::Reflection));
        let sum = branch.map_or(Spectrum::BLACK, |b| b.1) + view.map_or(Spectrum::BLACK, |g| g.weight);
        assert!((sum.mean() - 0.5 * lobe.directional_albedo(wo).mean()).abs() < 1e-6, "{alpha}");
    }
}

const SIZE: usize = 16;

fn table_node(of: fn(f64) -> Exact, row: usize, column: usize, n: usize) -> [f64; 2] {
    let square = |i: usize| (i as f64 / (SIZE - 1) as f64).powi(2);
    // At cosine 0 itself the integrand is 0/0.
    let (alpha, cos) = (square(row), square(column).max(1e-4));
    if row == 0 {
        let fc = (1.0 - square(column)).powi(5);
        return [1.0 - fc, fc];
    }
    let (a, b) = of(alpha).albedo(cos, n);
    [a, b]
}

#[test]
fn albedo_table_is_the_integral() {
    for (row, of) in (0..SIZE).flat_map(|row| [(row, Exact::ggx as fn(f64) -> Exact), (row, Exact::beckmann)])
    {
        for column in (0..SIZE).step_by(3) {
            let ([a, b], at) = (table_node(of, row, column, 400), |i: usize| (i as f64 / 15.0).powi(2));
            let wo = v(seen_under(at(column)));
            let got = |f0: f32| f64::from(like(f0, of(at(row))).directional_albedo(wo).mean());
            // At grazing incidence the quadrature itself converges slowly.
            let tolerance = if column == 0 { 0.02 } else { 5e-3 };
            assert!((got(0.0) - b).abs() < tolerance, "B at {row} {column}: {} {b}", got(0.0));
            assert!((got(1.0) - a - b).abs() < tolerance, "A + B at {row} {column}: {} {}", got(1.0), a + b);
        }
    }
}

#[test]
#[ignore = "prints the body of albedo_table.rs"]
fn print_albedo_table() {
    print_table(Exact::ggx);
}

#[test]
#[ignore = "prints the body of beckmann_table.rs"]
fn print_beckmann_table() {
    print_table(Exact::beckmann);
}

fn print_table(of: fn(f64) -> Exact) {
    for row in 0..SIZE {
        println!("    [");
        for columns in [0..6, 6..11, 11..16] {
            let pairs: Vec<_> = columns.map(|c| table_node(of, row, c, 1000)).collect();
            let line: Vec<_> =
                pairs.iter().map(|[a, b]| format!("[{:.4}, {:.4}]", a.min(1.0 - b), b)).collect();
            println!("        {},", line.join(", "));
        }
        println!("    ],");
    }
}
