//! Directions drawn from lobes: densities, weights, energy (T2, T3), gloss as in the paper of 1984 (C4, F9).
use durer_core::{
    math::{Point2, Vector3},
    spectrum::Spectrum,
};
use durer_model::bsdf::{
    Blur, Blurred, BranchKind, Bsdf, Drawn, Facets, Gloss, Glossy, Interface, Lobe, Reflectance, Seen, Split,
};
use durer_testkit::{
    DVec3, chi_square::Histogram, gloss_table::GlossTable, microfacet::Facets as Exact, quadrature,
    random::Random,
};

fn glossy(f0: f32, alpha: f32) -> Lobe<'static> {
    let reflectance = Reflectance::Schlick { f0: Spectrum::splat(f0), f90: Spectrum::ONE };
    Lobe::Glossy(Glossy { reflectance, facets: Facets::round(alpha), scale: 1.0 })
}

fn frosted(eta: f32, alpha: f32) -> Lobe<'static> {
    Lobe::Blurred(Blurred { interface: Interface::clear(eta), blur: Blur::Microfacet(Facets::round(alpha)) })
}

fn translucent(reflection: f32, transmission: f32) -> Lobe<'static> {
    let split = Split::Constant { reflection: Spectrum::splat(0.3), transmission: Spectrum::splat(0.6) };
    let blur = Blur::Cosine { reflection, transmission };
    Lobe::Blurred(Blurred { interface: Interface { eta: 1.5, split }, blur })
}

fn gloss(exponent: f32) -> Lobe<'static> {
    Lobe::Gloss(Gloss { weight: Spectrum::ONE, exponent })
}

/// Lobes that spread, wide enough for the cells of a histogram.
fn lobes() -> Vec<Lobe<'static>> {
    let mut lobes = vec![gloss(0.0), gloss(1.0), gloss(12.0), gloss(60.0), translucent(5.0, 20.0)];
    lobes.extend([0.15, 0.3, 0.6, 1.0].map(|alpha| glossy(0.3, alpha)));
    lobes.extend([0.2, 0.5, 1.0].map(|alpha| frosted(1.5, alpha)));
    lobes.push(frosted(1.0 / 1.33, 0.4));
    lobes
}

fn seen_from() -> Vec<Vector3> {
    [0.98f32, 0.7, 0.25, -0.6]
        .map(|z| Vector3::new((1.0 - z * z).sqrt() * 0.8, (1.0 - z * z).sqrt() * 0.6, z))
        .into()
}

fn v(w: DVec3) -> Vector3 {
    Vector3::from_f64(w)
}

fn unit(random: &mut Random) -> Point2 {
    Point2::new(random.unit().min(0.999_999) as f32, random.unit().min(0.999_999) as f32)
}

/// The draw of one kind, if there is one.
fn draw(bsdf: &Bsdf, wo: Vector3, u: Point2, kind: BranchKind) -> Option<Drawn> {
    bsdf.draws(wo, |_| u).iter().find(|d| d.branch.kind == kind).copied()
}

#[test]
fn draws_have_the_density_they_say() {
    let mut random = Random::new(11);
    let kinds = [BranchKind::Reflection, BranchKind::Transmission];
    let mut tests = Vec::new();
    for lobe in lobes() {
        let bsdf = Bsdf::default().with(lobe);
        for wo in seen_from() {
            for kind in kinds {
                let mut histogram = Histogram::default();
                let mut any = false;
                for _ in 0..20_000 {
                    match draw(&bsdf, wo, unit(&mut random), kind) {
                        Some(drawn) => {
                            any = true;
                            histogram.add(drawn.branch.wi.to_f64());
                        }
                        None => histogram.miss(),
                    }
                }
                let mirrors = kind == BranchKind::Reflection;
                let density = |w: DVec3| {
                    let same_side = w.z * f64::from(wo.z) > 0.0;
                    if same_side == mirrors { f64::from(lobe.pdf(wo, v(w)).unwrap_or(0.0)) } else { 0.0 }
                };
                if any {
                    tests.push((histogram.p_value(density), format!("{lobe:?} {wo:?} {kind:?}")));
                }
            }
        }
    }
    // Sidak: the chance that one of n right densities fails is 1 percent.
    let level = 1.0 - 0.99f64.powf(1.0 / tests.len() as f64);
    assert!(tests.len() > 60);
    for (p, what) in tests {
        assert!(p > level, "p = {p:e} for {what}");
    }
}

#[test]
fn weights_are_the_value_times_cosine_by_density() {
    let mut random = Random::new(12);
    for lobe in lobes() {
        let bsdf = Bsdf::default().with(lobe);
        for wo in seen_from() {
            for _ in 0..300 {
                for drawn in bsdf.draws(wo, |_| unit(&mut random)).iter() {
                    let Drawn { branch, pdf } = *drawn;
                    let value = lobe.eval(wo, branch.wi).mean() * branch.wi.z.abs();
                    let weight = branch.weight.mean();
                    assert!(pdf > 0.0 && weight.is_finite() && (branch.wi.length() - 1.0).abs() < 1e-4);
                    let off = (value / pdf - weight).abs();
                    assert!(off <= 2e-3 * weight.max(0.01), "{lobe:?} {wo:?} {drawn:?}: {}", value / pdf);
                }
            }
        }
    }
}

/// Mean weight of the draws of a kind.
fn energy(lobe: &Lobe, wo: Vector3, kind: BranchKind, n: u32) -> f64 {
    let bsdf = Bsdf::default().with(*lobe);
    let cell = |i: u32| (i as f32 + 0.5) / n as f32;
    let mut sum = 0.0;
    for i in 0..n {
        for j in 0..n {
            let drawn = draw(&bsdf, wo, Point2::new(cell(i), cell(j)), kind);
            sum += drawn.map_or(0.0, |d| f64::from(d.branch.weight.mean()));
        }
    }
    sum / f64::from(n * n)
}

#[test]
fn drawn_energy_is_that_of_the_white_furnace_e3() {
    let up = Vector3::new(0.0, 0.0, 1.0);
    for (alpha, expected) in [(0.1, 0.988304), (0.25, 0.915812), (0.5, 0.687849), (1.0, 0.306853)] {
        let got = energy(&glossy(1.0, alpha), up, BranchKind::Reflection, 200);
        assert!((got - expected).abs() < 2e-3, "alpha {alpha}: {got}");
    }
    for exponent in [0.0, 3.0, 100.0] {
        let got = energy(&gloss(exponent), Vector3::new(0.6, 0.0, 0.8), BranchKind::Reflection, 32);
        assert!((got - 1.0).abs() < 1e-6, "exponent {exponent}: {got}");
    }
}

#[test]
fn nearly_smooth_frosted_glass_divides_light_like_smooth_glass() {
    for (eta, z) in [(1.5f32, 0.9f32), (1.5, 0.4), (1.0 / 1.5, 0.95), (1.0 / 1.5, 0.3)] {
        let wo = Vector3::new((1.0 - z * z).sqrt(), 0.0, z);
        let smooth = Bsdf::default().with(Lobe::Interface(Interface::clear(eta)));
        for kind in [BranchKind::Reflection, BranchKind::Transmission] {
            let weight =
                |b: &Bsdf| b.branches(wo).iter().find(|b| b.kind == kind).map_or(0.0, |b| b.weight.mean());
            let got = energy(&frosted(eta, 0.002), wo, kind, 64);
            assert!((got - f64::from(weight(&smooth))).abs() < 5e-3, "{eta} {z} {kind:?}: {got}");
        }
    }
}

#[test]
fn frosted_glass_never_gains_and_loses_little() {
    for alpha in [0.05, 0.2, 0.5, 1.0] {
        for wo in seen_from() {
            for eta in [1.5, 1.0 / 1.5] {
                let lobe = frosted(eta, alpha);
                let both = energy(&lobe, wo, BranchKind::Reflection, 80)
                    + energy(&lobe, wo, BranchKind::Transmission, 80);
                // What is lost bounces between microfacets: most of it inside, where they reflect totally.
                let least = if alpha > 0.2 { 0.35 } else { 0.8 };
                assert!(both <= 1.0 + 1e-3 && both > least, "alpha {alpha} eta {eta} {wo:?}: {both}");
            }
        }
    }
}

#[test]
fn wide_gloss_turns_what_would_enter_the_surface() {
    let lobe = gloss(4.0);
    let wo = Vector3::new(0.98, 0.0, 0.2).normalize();
    let mass = quadrature::sphere(200, |w| f64::from(lobe.pdf(wo, v(w)).unwrap_or(0.0)));
    assert!((mass - 1.0).abs() < 1e-3, "{mass}");
    let mut random = Random::new(5);
    let bsdf = Bsdf::default().with(lobe);
    assert!((0..2000).all(|_| bsdf.draws(wo, |_| unit(&mut random)).iter().all(|d| d.branch.wi.z > 0.0)));
}

/// Share of `cos^n` about the z axis within the half space whose edge lies `psi` off the axis.
fn share_beyond_edge(exponent: f64, psi: f64) -> f64 {
    let n = 20_000;
    let lobe = |from: f64, to: f64| {
        let step = (to - from) / f64::from(n);
        (0..n).map(|i| (from + (f64::from(i) + 0.5) * step).cos().powf(exponent)).sum::<f64>() * step
    };
    let right = std::f64::consts::FRAC_PI_2;
    lobe(-right, psi) / lobe(-right, right)
}

#[test]
fn gloss_across_a_straight_edge_f9() {
    let lobe = Gloss { weight: Spectrum::ONE, exponent: 32.0 };
    let bsdf = Bsdf::default().with(Lobe::Gloss(lobe));
    let wo = Vector3::new(0.0, 0.0, 1.0);
    for (degrees, expected) in [(2.0f64, 0.578880), (5.0, 0.690703), (20.0, 0.977839)] {
        assert!((share_beyond_edge(32.0, degrees.to_radians()) - expected).abs() < 1e-5);
        let (sin, cos) = degrees.to_radians().sin_cos();
        let n = 400;
        let mut inside = 0;
        for i in 0..n * n {
            let u = Point2::new(((i % n) as f32 + 0.5) / n as f32, ((i / n) as f32 + 0.5) / n as f32);
            let wi = bsdf.draws(wo, |_| u).iter().next().map(|d| d.branch.wi.to_f64());
            // The edge runs along y, `psi` towards +x.
            inside += u32::from(wi.is_some_and(|w| w.x * cos - w.z * sin < 0.0));
        }
        let got = f64::from(inside) / f64::from(n * n);
        assert!((got - expected).abs() < 1e-3, "{degrees} deg: {got}");
    }
    // Half power 11.8825 degrees off the axis.
    let half = 11.8825f64.to_radians();
    let at = |angle: f64| f64::from(lobe.pdf(wo, v(DVec3::new(angle.sin(), 0.0, angle.cos()))));
    assert!((at(half) / at(0.0) - 0.5).abs() < 1e-4);
    assert!((at(0.0) - 5.252113).abs() < 1e-4);
}

#[test]
fn a_table_of_directions_and_exact_draws_agree_c4() {
    let exponent = 24.0;
    let table = GlossTable::new(exponent, 64, 32);
    let lobe = gloss(exponent as f32);
    let wo = Vector3::new(0.0, 0.0, 1.0);
    let mut random = Random::new(21);
    let (mut tabulated, mut drawn) = (Histogram::default(), Histogram::default());
    let bsdf = Bsdf::default().with(lobe);
    for i in 0..8192 {
        tabulated.add(table.direction(i % table.len(), [random.unit(), random.unit()]));
        let u = unit(&mut random);
        bsdf.draws(wo, |_| u).iter().for_each(|d| drawn.add(d.branch.wi.to_f64()));
    }
    let density = |w: DVec3| f64::from(lobe.pdf(wo, v(w)).unwrap_or(0.0));
    assert!(tabulated.p_value(density) > 0.01, "{}", tabulated.p_value(density));
    assert!(drawn.p_value(density) > 0.01, "{}", drawn.p_value(density));
    let other = |w: DVec3| f64::from(gloss(20.0).pdf(wo, v(w)).unwrap_or(0.0));
    assert!(tabulated.p_value(other) < 1e-6, "the test has no power");
}

#[test]
fn what_lights_and_drawn_rays_find_adds_up_to_the_whole() {
    // One sample of the light and one draw, weighted by the balance heuristic, over a cap of light.
    let lobe = glossy(0.9, 0.25);
    let bsdf = Bsdf::default().with(lobe);
    let wo = Vector3::new(0.5, 0.0, 0.75f32.sqrt());
    let axis = DVec3::new(-0.45, 0.1, 0.9).normalize();
    let (cap, solid_angle) = (0.92f64, std::f64::consts::TAU * 0.08);
    let pdf = (1.0 / solid_angle) as f32;
    let exact = Exact::ggx(0.25).integrate(wo.to_f64(), 1500, |wi, _| {
        if wi.dot(axis) > cap { f64::from(lobe.eval(wo, v(wi)).mean()) * wi.z } else { 0.0 }
    });
    let mut random = Random::new(8);
    let (n, rays) = (200_000, 3.0);
    let mut sum = 0.0;
    for _ in 0..n {
        let w = loop {
            let w = random.direction();
            if w.dot(axis) > cap {
                break v(w);
            }
        };
        let share = bsdf.eval_shared(wo, w, Seen::Draws { pdf, rays });
        sum += f64::from(share.mean()) * f64::from(w.z) * solid_angle;
        if let Some(d) = draw(&bsdf, wo, unit(&mut random), BranchKind::Reflection)
            && d.branch.wi.to_f64().dot(axis) > cap
        {
            sum += f64::from(d.branch.weight.mean() * d.pdf * rays / (d.pdf * rays + pdf));
        }
    }
    let got = sum / f64::from(n);
    assert!((got - exact).abs() < 0.01 * exact, "{got} {exact}");
}
