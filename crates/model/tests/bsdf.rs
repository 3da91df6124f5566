//! T0 for lobes: directions, Fresnel's equations, branches and how a `Bsdf` puts lobes together.
use std::f32::consts::PI;

use durer_core::{
    math::{Normal3, Vector3},
    spectrum::Spectrum,
};
use durer_model::bsdf::{
    Branch, BranchKind, Bsdf, Highlight, Interface, Lobe, Split, fresnel_dielectric, fresnel_polarized,
    normal_reflectance, reflect, refract,
};
use durer_testkit::{DVec3, interface, random::Random};

const Z: Normal3 = Normal3::new(0.0, 0.0, 1.0);

fn at_degrees(degrees: f64) -> Vector3 {
    let (s, c) = degrees.to_radians().sin_cos();
    Vector3::new(s as f32, 0.0, c as f32)
}

fn near(got: f32, expected: f64, relative: f64) -> bool {
    (f64::from(got) - expected).abs() <= relative * expected.abs().max(1e-2)
}

fn sharp(bsdf: &Bsdf, wo: Vector3) -> Vec<Branch> {
    bsdf.branches(wo).iter().copied().collect()
}

#[test]
fn snell_angles_match_the_table() {
    for (degrees, eta, expected) in [(45.0, 1.5, 28.1255), (45.0, 1.333, 32.0367), (30.0, 1.5, 19.4712)] {
        let t = refract(at_degrees(degrees), Z, 1.0 / eta).expect("enters");
        assert!((f64::from(-t.x).atan2(f64::from(-t.z)).to_degrees() - expected).abs() < 2e-4, "{t:?}");
    }
}

#[test]
fn critical_angles_match_the_table() {
    let table = [(1.333, 48.6066), (4.0 / 3.0, 48.5904), (1.5, 41.8103), (1.52, 41.1395), (2.417, 24.4397)];
    for (eta, degrees) in table {
        assert!(refract(at_degrees(degrees - 2e-3), Z, eta).is_some(), "{eta}");
        assert!(refract(at_degrees(degrees + 2e-3), Z, eta).is_none(), "{eta}");
        assert_eq!(fresnel_dielectric(at_degrees(degrees + 2e-3).z, 1.0 / eta), 1.0);
    }
}

#[test]
fn directions_agree_with_whitted_and_the_lecture() {
    let mut random = Random::new(3);
    for _ in 0..100_000 {
        // Both sides get the rounded input, so that only the arithmetic differs.
        let (n, i) = (Normal3::from_f64(random.direction()), Vector3::from_f64(random.direction()));
        let kn = random.between(0.4, 2.5) as f32;
        let (n64, i64) = (n.face_forward(i).to_f64().normalize(), i.to_f64().normalize());
        let (r, p) = interface::whitted_directions(-i64, n64, f64::from(kn));
        assert!((reflect(-i, n).to_f64() - r.normalize()).length() < 1e-4);
        let t = refract(i, n, 1.0 / kn);
        assert_eq!(t.is_some(), p.is_some(), "{i:?} {n:?} {kn}");
        if let (Some(t), Some(p)) = (t, p) {
            assert!((t.to_f64() - p.normalize()).length() < 1e-4, "{i:?} {n:?} {kn}: {t:?} {p}");
        }
    }
}

#[test]
fn whitted_example_comes_out() {
    let s = 0.5f32.sqrt();
    let (v, n) = (Vector3::new(s, -s, 0.0), Normal3::new(0.0, 1.0, 0.0));
    assert!((reflect(v, n) - Vector3::new(s, s, 0.0)).length() < 1e-6);
    let t = refract(-v, n, 1.0 / 1.5).expect("enters");
    assert!((t / -t.y - Vector3::new(0.534522, -1.0, 0.0)).length() < 1e-6);
    let inside = Vector3::new(at_degrees(60.0).x, 0.5, 0.0);
    assert_eq!(refract(inside, n, 1.5), None);
}

#[test]
fn fresnel_reflectance_matches_the_tables() {
    let glass =
        [(0.0, 0.04), (30.0, 0.04152), (45.0, 0.05024), (60.0, 0.08919), (75.0, 0.25306), (85.0, 0.61280)];
    let water = [(0.0, 0.02037), (45.0, 0.02790), (60.0, 0.05969), (75.0, 0.21238)];
    let from_water = [(40.0, 0.05558), (45.0, 0.13946), (48.0, 0.43308)];
    let rows = glass.map(|r| (1.5, r)).into_iter().chain(water.map(|r| (1.333, r)));
    for (eta, (degrees, expected)) in rows.chain(from_water.map(|r| (1.0 / 1.333, r))) {
        let cos = at_degrees(degrees).z;
        let got = f64::from(fresnel_dielectric(cos, eta));
        assert!((got - expected).abs() < 6e-6, "{eta} {degrees}: {got}");
        // To 1e-5 of the oracle fed with the same rounded numbers.
        let oracle = interface::fresnel_mean(f64::from(cos), f64::from(eta));
        assert!((got - oracle).abs() <= 1e-5 * oracle, "{eta} {degrees}: {got} {oracle}");
    }
    assert!(near(normal_reflectance(1.5), 0.04, 1e-6) && near(normal_reflectance(1.0 / 1.5), 0.04, 1e-6));
}

#[test]
fn brewster_angles_reflect_no_parallel_light() {
    for (eta, degrees) in [(1.5, 56.3099), (1.333, 53.1232)] {
        let (s, p) = fresnel_polarized(at_degrees(degrees).z, eta);
        assert!(p < 1e-11 && s > 0.05, "{eta}: {s} {p}");
    }
}

#[test]
fn hemispherical_fresnel_reflectance_matches_the_table() {
    let table = [(1.5, 0.0917780), (1.0 / 1.5, 0.5963458), (1.333, 0.0664058), (1.0 / 1.333, 0.4745906)];
    for (eta, expected) in table {
        let n = 200_000;
        // With x = cos², 2 F cos dcos = F dx.
        let x = |i: u32| ((f64::from(i) + 0.5) / f64::from(n)).sqrt() as f32;
        let sum: f64 = (0..n).map(|i| f64::from(fresnel_dielectric(x(i), eta))).sum::<f64>() / f64::from(n);
        assert!((sum - expected).abs() < 1e-5, "{eta}: {sum}");
    }
}

#[test]
fn a_fresnel_interface_divides_all_light_between_two_branches() {
    let bsdf = Bsdf::default().with(Lobe::Interface(Interface::clear(1.5)));
    let wo = at_degrees(45.0);
    let [r, t] = sharp(&bsdf, wo)[..] else { panic!("two branches") };
    assert_eq!((r.kind, t.kind), (BranchKind::Reflection, BranchKind::Transmission));
    assert_eq!(r.weight + t.weight, Spectrum::ONE);
    assert!(near(r.weight.mean(), 0.05024, 1e-3) && t.wi.z < 0.0);
    // The transmitted ray, followed back, leaves along the same path.
    let [_, back] = sharp(&bsdf, t.wi)[..] else { panic!("two branches") };
    assert!((back.wi - wo).length() < 1e-6);
}

#[test]
fn total_reflection_keeps_all_light_with_fresnel_and_loses_the_transmitted_part_with_constants() {
    let wo = -at_degrees(50.0);
    let fresnel = Bsdf::default().with(Lobe::Interface(Interface::clear(1.5)));
    let [r] = sharp(&fresnel, wo)[..] else { panic!("one branch") };
    assert_eq!((r.kind, r.weight), (BranchKind::Reflection, Spectrum::ONE));
    assert_eq!(fresnel.branches(wo).total_internal_reflection, Some(Spectrum::BLACK));

    let (reflection, transmission) = (Spectrum::splat(0.2), Spectrum::splat(0.7));
    let split = Split::Constant { reflection, transmission };
    let whitted = Bsdf::default().with(Lobe::Interface(Interface { eta: 1.5, split }));
    let [r] = sharp(&whitted, wo)[..] else { panic!("one branch") };
    assert_eq!(r.weight, reflection);
    assert_eq!(whitted.branches(wo).total_internal_reflection, Some(transmission));
    assert_eq!(whitted.branches(-wo).total_internal_reflection, None);
}

#[test]
fn an_interface_without_contrast_is_invisible() {
    let bsdf = Bsdf::default().with(Lobe::Interface(Interface::clear(1.0)));
    for wo in [at_degrees(0.0), at_degrees(70.0), -at_degrees(30.0), at_degrees(90.0)] {
        let [t] = sharp(&bsdf, wo)[..] else { panic!("one branch at {wo:?}") };
        assert_eq!((t.kind, t.weight), (BranchKind::Transmission, Spectrum::ONE));
        assert!((t.wi + wo).length() < 1e-6);
    }
}

/// I10: a plate of reflectance R that is seen from one side with sky 1 behind it passes `(1 - R) / (1 + R)`.
#[test]
fn glass_plates_pass_what_the_series_says() {
    let bsdf = Bsdf::default().with(Lobe::Interface(Interface::clear(1.5)));
    let up = Vector3::new(0.0, 0.0, 1.0);
    let weights = |wo: Vector3| {
        let [r, t] = sharp(&bsdf, wo)[..] else { panic!("two branches") };
        (f64::from(r.weight.mean()), f64::from(t.weight.mean()))
    };
    let ((_, enter), (bounce, leave)) = (weights(up), weights(-up));
    let passed = |bounces: i32| (0..=bounces).map(|k| enter * bounce.powi(2 * k) * leave).sum::<f64>();
    for (bounces, expected) in [(0, 0.9216), (1, 0.92307456), (2, 0.9230769193), (50, 0.9230769)] {
        assert!((passed(bounces) - expected).abs() < 1e-6, "{bounces}: {}", passed(bounces));
    }
}

#[test]
fn black_branches_are_left_out_and_reflections_come_first() {
    let split = Split::Constant { reflection: Spectrum::BLACK, transmission: Spectrum::BLACK };
    let nothing = Bsdf::default()
        .with(Lobe::Mirror { weight: Spectrum::BLACK })
        .with(Lobe::PassThrough { weight: Spectrum::BLACK })
        .with(Lobe::Interface(Interface { eta: 1.5, split }));
    assert!(sharp(&nothing, at_degrees(30.0)).is_empty());
    assert_eq!(nothing.branches(-at_degrees(80.0)).total_internal_reflection, None);

    let both = Bsdf::default()
        .with(Lobe::Mirror { weight: Spectrum::splat(0.5) })
        .with(Lobe::PassThrough { weight: Spectrum::splat(0.25) });
    let wo = at_degrees(30.0);
    let [r, t] = sharp(&both, wo)[..] else { panic!("two branches") };
    assert!((r.wi - reflect(-wo, Z)).length() < 1e-6 && r.weight == Spectrum::splat(0.5));
    assert_eq!((t.wi, t.weight, t.kind), (-wo, Spectrum::splat(0.25), BranchKind::Transmission));
}

#[test]
fn highlights_reflect_exactly_the_classic_formula() {
    let (ks, exponent, intensity) = (0.7f64, 20.0, 3.0f32);
    let lobe = Lobe::Highlight(Highlight { specular: Spectrum::splat(ks as f32), exponent });
    let mut random = Random::new(7);
    for _ in 0..10_000 {
        let up = |w: DVec3| Vector3::from_f64(DVec3::new(w.x, w.y, w.z.abs()));
        let (wo, wi) = (up(random.direction()), up(random.direction()));
        let got = lobe.eval(wo, wi) * (wi.z * PI * intensity);
        let h = (wo.to_f64() + wi.to_f64()).normalize();
        let expected = ks * h.z.powf(20.0) * f64::from(intensity);
        assert!((f64::from(got.mean()) - expected).abs() <= 2e-5 * expected + 1e-9, "{wo:?} {wi:?}");
    }
    let behind = lobe.eval(Vector3::new(0.0, 0.0, 1.0), Vector3::new(0.6, 0.0, -0.8));
    assert_eq!(behind, Spectrum::BLACK);
}

#[test]
fn the_ambient_coefficient_replaces_the_diffuse_albedo() {
    let diffuse = Bsdf::default().with(Lobe::Diffuse { albedo: Spectrum::splat(0.5) });
    assert_eq!(diffuse.ambient(), Spectrum::splat(0.5));
    let classic = diffuse.with(Lobe::Ambient { coefficient: Spectrum::splat(0.1) });
    assert_eq!(classic.ambient(), Spectrum::splat(0.1));
    assert_eq!(classic.albedo(), Spectrum::splat(0.5));
    assert_eq!(Bsdf::default().ambient(), Spectrum::BLACK);
}
