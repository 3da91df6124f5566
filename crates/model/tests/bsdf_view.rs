//! What people are told of lobes: names, Fresnel's numbers, whose a ray is, and what single scattering loses.
use durer_core::{
    math::{Point2, Vector3},
    spectrum::Spectrum,
};
use durer_model::bsdf::{
    Blur, Blurred, BranchKind, Bsdf, Facets, Glossy, Interface, Lobe, Reflectance, fresnel_dielectric,
};

fn direction(degrees: f32) -> Vector3 {
    let (sin, cos) = f64::from(degrees).to_radians().sin_cos();
    Vector3::new(sin as f32, 0.0, cos as f32)
}

fn grid() -> impl Iterator<Item = Point2> {
    (0..400).map(|i| Point2::new((i % 20) as f32 / 20.0 + 0.01, (i / 20) as f32 / 20.0 + 0.01))
}

fn glossy(alpha: f32) -> Lobe<'static> {
    let reflectance = Reflectance::Schlick { f0: Spectrum::ONE * 0.5, f90: Spectrum::ONE };
    Lobe::Glossy(Glossy { reflectance, facets: Facets::round(alpha), scale: 1.0 })
}

fn frosted(eta: f32) -> Lobe<'static> {
    Lobe::Blurred(Blurred { interface: Interface::clear(eta), blur: Blur::Microfacet(Facets::round(0.9)) })
}

#[test]
fn glass_tells_its_critical_angle_from_the_denser_side_only() {
    let glass = Bsdf::default().with(Lobe::Interface(Interface::clear(1.5)));
    let outside = glass.fresnel(direction(60.0)).expect("an interface");
    assert!((outside.reflect - 0.089_19).abs() < 1e-5, "I5: {outside:?}");
    assert_eq!((outside.critical_angle, outside.is_total, outside.is_constant), (None, false, false));
    let inside = |degrees: f32| glass.fresnel(-direction(degrees)).expect("an interface");
    let critical = inside(0.0).critical_angle.expect("denser");
    assert!((critical.to_degrees() - 41.810_314).abs() < 1e-4, "{critical}");
    assert!(!inside(41.0).is_total && inside(42.0).is_total);
    assert_eq!((inside(42.0).reflect, inside(42.0).transmit), (1.0, 0.0));
    assert!((inside(0.0).eta - 1.0 / 1.5).abs() < 1e-7);
    assert!((inside(20.0).reflect - fresnel_dielectric(direction(20.0).z, 1.0 / 1.5)).abs() < 1e-7);
    assert_eq!(Bsdf::default().with(glossy(0.5)).fresnel(direction(10.0)), None);
}

#[test]
fn branches_and_draws_know_their_lobes() {
    let wo = direction(30.0);
    let all = Bsdf::default()
        .with(Lobe::Diffuse { albedo: Spectrum::ONE })
        .with(Lobe::Mirror { weight: Spectrum::ONE })
        .with(glossy(0.1))
        .with(Lobe::Interface(Interface::clear(1.5)));
    let names: Vec<_> = (0..5).map(|i| all.lobe_of_branch(wo, i)).collect();
    assert_eq!(names, [Some("mirror"), Some("glossy"), Some("glass"), Some("glass"), None]);
    let names: Vec<_> = (0..4).map(|i| all.lobe_of_sharp(wo, i)).collect();
    assert_eq!(names, [Some("mirror"), Some("glass"), Some("glass"), None]);
    let u = |_| Point2::new(0.4, 0.3);
    assert_eq!(all.lobe_of_draw(wo, u, 0).map(|(i, lobe)| (i, lobe.name())), Some((2, "glossy")));
    assert!(all.lobe_of_draw(wo, u, 1).is_none());
}

#[test]
fn a_draw_is_there_or_lost() {
    let wo = direction(80.0);
    let (mut drawn, mut lost) = (0, 0);
    let rough = Bsdf::default().with(glossy(0.9));
    for u in grid() {
        let (here, gone) = (rough.draws(wo, |_| u).iter().count(), rough.lost_draws(wo, |_| u));
        assert_eq!(here + gone.len(), 1);
        assert!(
            gone.iter().all(|l| l.branch.wi.z <= 0.0 && l.branch.weight.max() >= 0.5 && l.lobe == "glossy")
        );
        (drawn, lost) = (drawn + here, lost + gone.len());
    }
    assert!(drawn > 50 && lost > 20, "{drawn} {lost}");
    for side in [wo, -wo] {
        let glass = Bsdf::default().with(frosted(1.5));
        let mut lost = 0;
        for u in grid() {
            let draws = glass.draws(side, |_| u);
            for gone in glass.lost_draws(side, |_| u) {
                let stays = gone.branch.wi.z * side.z > 0.0;
                assert_eq!(stays, gone.branch.kind == BranchKind::Transmission, "on the wrong side");
                assert!(draws.iter().all(|d| d.branch.kind != gone.branch.kind));
                lost += 1;
            }
        }
        assert!(lost > 10, "{lost}");
    }
}

#[test]
fn lobes_are_black_if_nothing_goes_on() {
    let black = Bsdf::default().with(Lobe::Diffuse { albedo: Spectrum::BLACK });
    assert!(black.is_black() && Bsdf::default().is_black());
    let mut grey = Bsdf::default().with(Lobe::Diffuse { albedo: Spectrum::ONE * 0.5 });
    assert!(!grey.is_black() && !Bsdf::default().with(frosted(1.5)).is_black());
    grey.dim(Spectrum::BLACK);
    assert!(grey.is_black(), "nothing arrives");
    let [matte, rough, glass] =
        [Lobe::Diffuse { albedo: Spectrum::ONE * 0.5 }, glossy(0.3), frosted(1.3)].map(|l| l.view());
    assert_eq!((matte.name, matte.reflectance.max(), matte.alpha), ("diffuse", 0.5, None));
    assert_eq!((rough.alpha, rough.exponent, rough.transmittance), (Some(0.3), None, Spectrum::BLACK));
    assert_eq!((glass.name, glass.alpha, glass.transmittance), ("frosted", Some(0.9), Spectrum::ONE));
}
