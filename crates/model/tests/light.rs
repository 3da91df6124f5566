//! T0 and T5 for lights: closed forms, registry-wide sanity, parameters.
use std::{
    f64::consts::{PI, TAU},
    sync::Arc,
};

use durer_core::sampling::{Sampler, SamplerKind};
use durer_core::{
    glam::{DAffine3, DQuat, DVec3},
    math::{Normal3, Point3, Transform, Vector3},
    spectrum::{Basis, Spectrum},
};
use durer_model::light::{LIGHTS, Light, LightCx, LightSample, Track};
use durer_scene::{
    Args, AssetError, Assets, Data, Diagnostics, Image, ImageData, Mesh, Missing, Node, ParamDefault,
    ParamSpec, Params, ValueType, find,
};
use durer_testkit::{quadrature, random::Random};

/// A small picture and a small profile.
struct Files;

impl Assets for Files {
    fn bytes(&self, _path: &str) -> Result<Arc<[u8]>, AssetError> {
        let text = "IESNA:LM-63-2002\nTILT=NONE\n1 1000 1 3 1 1 2 0 0 0 1 1 100\n0 45 90\n0\n100 80 0\n";
        Ok(text.as_bytes().into())
    }
    fn mesh(&self, path: &str) -> Result<Arc<Mesh>, AssetError> {
        Err(AssetError::Missing { path: path.to_owned() })
    }
    fn image(&self, _path: &str) -> Result<Arc<Image>, AssetError> {
        let data = ImageData::F32((0..48).map(|i| i as f32).collect());
        Ok(Arc::new(Image { width: 4, height: 4, channels: 3, data }))
    }
}

fn try_light(kind: &str, params: Params) -> Result<Box<dyn Light>, Diagnostics> {
    let mut diagnostics = Diagnostics::default();
    let node = Node::new(kind, params);
    let entry = find(LIGHTS, "light", &node, &mut diagnostics).expect("a registered light");
    let mut args =
        Args::check(&node, entry.schema, &[], &mut diagnostics).with_assets(&Files, Missing::Refuse);
    let built = (entry.build)(&mut args);
    match built {
        Some(light) if !diagnostics.has_errors() => Ok(light),
        _ => Err(diagnostics),
    }
}

fn light(kind: &str, params: Params) -> Box<dyn Light> {
    try_light(kind, params).expect("sound parameters")
}

fn point3(params: Params, name: &str, p: [f32; 3]) -> Params {
    params.with(name, ValueType::Point3, Data::Floats(p.to_vec()))
}

fn arriving(light: &dyn Light, p: Point3) -> Option<LightSample> {
    light.sample(
        &LightCx { basis: Basis::Rgb, time: 0.0 },
        p,
        &Sampler::new(SamplerKind::Sobol, 0, [0, 0], 0, 1),
    )
}

fn close(got: f32, expected: f64, relative: f64) -> bool {
    (f64::from(got) - expected).abs() <= relative * expected.abs()
}

fn v(d: DVec3) -> Vector3 {
    Vector3::from_f64(d)
}

#[test]
fn irradiance_of_a_point_light_falls_with_the_square_of_distance() {
    let params = point3(Params::new().rgb("I", [2.0, 4.0, 8.0]).float("scale", 3.0), "from", [0.0, 5.0, 0.0]);
    let light = light("point", params);
    let p = Point3::new(3.0, 1.0, 0.0);
    let sample = arriving(&*light, p).expect("lit");
    // E12: E = I cos / d² on a floor below.
    let cos = Normal3::new(0.0, 1.0, 0.0).dot(sample.wi);
    assert_eq!(sample.point, Some(Point3::new(0.0, 5.0, 0.0)));
    let [r, g, b] = Basis::Rgb.to_rgb(sample.weight * cos);
    for (got, intensity) in [(r, 6.0), (g, 12.0), (b, 24.0)] {
        assert!(close(got, intensity * 0.8 / 25.0, 1e-6), "{got}");
    }
    assert_eq!(arriving(&*light, Point3::new(0.0, 5.0, 0.0)), None);
}

#[test]
fn without_falloff_a_facing_matte_surface_reflects_kd_times_intensity() {
    let light = light("point", Params::new().string("falloff", "none").rgb("I", [0.7; 3]));
    for distance in [0.1, 1.0, 1e4] {
        let sample = arriving(&*light, Point3::new(0.0, 0.0, distance)).expect("lit");
        let reflected = sample.weight * (0.25 / std::f32::consts::PI);
        assert!(close(reflected.mean(), 0.25 * 0.7, 1e-6));
    }
}

#[test]
fn power_of_a_point_light_is_the_integral_of_its_irradiance() {
    let params = Params::new().rgb("I", [0.1, 2.0, 3.0]).float("power", 20.0).float("scale", 2.0);
    let light = light("point", params);
    let luminance = |s: Spectrum| {
        let [r, g, b] = Basis::Rgb.to_rgb(s);
        0.2126 * r + 0.7152 * g + 0.0722 * b
    };
    let sample = arriving(&*light, Point3::new(0.0, 2.0, 0.0)).expect("lit");
    assert!(close(luminance(sample.weight), 40.0 / (4.0 * PI * 4.0), 1e-5));
}

#[test]
fn a_spot_light_sends_its_power_into_its_cone() {
    let base = || Params::new().float("coneangle", 40.0).float("conedeltaangle", 15.0);
    let spot = light("spot", base());
    let intensity =
        |w: DVec3| arriving(&*spot, Point3::ZERO + v(w)).map_or(0.0, |s| f64::from(s.weight.mean()));
    let numeric = quadrature::sphere(1000, intensity);
    let (inner, outer) = (25f64.to_radians().cos(), 40f64.to_radians().cos());
    let expected = TAU * ((1.0 - inner) + 0.5 * (inner - outer));
    assert!((numeric - expected).abs() < 1e-3 * expected, "{numeric} {expected}");

    let at =
        |degrees: f64| intensity(DVec3::new(degrees.to_radians().sin(), 0.0, degrees.to_radians().cos()));
    assert!((at(0.0) - 1.0).abs() < 1e-6 && (at(24.9) - 1.0).abs() < 1e-6);
    assert!(at(40.1) == 0.0 && at(180.0) == 0.0 && at(30.0) > at(35.0));

    let powered = light("spot", base().float("power", 7.0));
    let got = arriving(&*powered, Point3::new(0.0, 0.0, 1.0)).expect("lit").weight.mean();
    assert!(close(got, 7.0 / expected, 1e-5));
}

#[test]
fn distant_light_is_the_same_everywhere() {
    let params = point3(Params::new().rgb("L", [3.0; 3]), "from", [0.0, 2.0, 0.0]);
    let light = light("distant", point3(params, "to", [0.0, 0.0, 0.0]));
    for p in [Point3::ZERO, Point3::new(1e5, -1e5, 3.0)] {
        let sample = arriving(&*light, p).expect("lit");
        assert_eq!((sample.wi, sample.point), (Vector3::new(0.0, 1.0, 0.0), None));
        assert_eq!(sample.weight, Spectrum::splat(3.0));
    }
}

#[test]
fn a_constant_sky_is_its_own_ambient_term() {
    let sky = light("infinite", Params::new().rgb("L", [0.5, 1.0, 2.0]).float("scale", 2.0));
    let mut random = Random::new(5);
    for _ in 0..100 {
        let d = v(random.direction());
        let seen = sky.escaped(Basis::Rgb, d);
        assert_eq!(Basis::Rgb.to_rgb(seen), [1.0, 2.0, 4.0]);
        assert_eq!(sky.ambient(Basis::Rgb, d.into()), seen);
        assert_eq!(sky.glossy_ambient(Basis::Rgb, d, 0.3), seen);
    }
    // Drawn evenly over 4 pi.
    let drawn = arriving(&*sky, Point3::ZERO).expect("all around").weight;
    let expected = sky.escaped(Basis::Rgb, Vector3::new(0.0, 1.0, 0.0)).mean() * 4.0 * PI as f32;
    assert!((drawn.mean() / expected - 1.0).abs() < 1e-6);
    // E7: irradiance under a uniform sky of radiance 1 is pi.
    let one = light("infinite", Params::new().float("illuminance", PI as f32));
    assert!(close(one.escaped(Basis::Rgb, Vector3::new(0.0, 1.0, 0.0)).mean(), 1.0, 1e-6));
}

#[test]
fn the_ambient_term_of_a_gradient_sky_is_its_integral() {
    let params = Params::new().rgb("zenith", [0.0, 0.0, 1.0]).rgb("horizon", [0.0, 1.0, 0.0]);
    let params = params.rgb("ground", [1.0, 0.0, 0.0]).float("scale", 4.0);
    let sky = light("gradientsky", params);
    let mut random = Random::new(8);
    for _ in 0..40 {
        let n = random.direction();
        let (x, y) = n.any_orthonormal_pair();
        let mut sums = [0.0f64; 3];
        quadrature::cosine_hemisphere(200, |w| {
            let d = x * w.x + y * w.y + n * w.z;
            let rgb = Basis::Rgb.to_rgb(sky.escaped(Basis::Rgb, v(d)));
            (0..3).for_each(|i| sums[i] += f64::from(rgb[i]) / 40_000.0);
            0.0
        });
        let got = Basis::Rgb.to_rgb(sky.ambient(Basis::Rgb, Normal3::from_f64(n)));
        for i in 0..3 {
            assert!((f64::from(got[i]) - sums[i]).abs() < 0.01 * 4.0 * 0.5, "{n}: {got:?} {sums:?}");
        }
        let (got, sum) = (got.iter().sum::<f32>(), sums.iter().sum::<f64>());
        assert!(close(got, sum, 1e-3) && close(got, 4.0, 1e-3));
    }
}

#[test]
fn glossy_views_of_a_gradient_sky_go_from_sharp_to_ambient() {
    let sky = light("gradientsky", Params::new());
    let blue = |s: Spectrum| Basis::Rgb.to_rgb(s)[2];
    let mut random = Random::new(9);
    for _ in 0..100 {
        let d = v(random.direction());
        let sharp = blue(sky.escaped(Basis::Rgb, d));
        assert!((blue(sky.glossy_ambient(Basis::Rgb, d, 0.0)) - sharp).abs() < 0.02);
        let (dull, matte) =
            (blue(sky.glossy_ambient(Basis::Rgb, d, 1.0)), blue(sky.ambient(Basis::Rgb, d.into())));
        assert!((dull - matte).abs() < 0.12, "{d:?}: {dull} {matte}");
    }
    // The zenith is the bluest point towards the horizon's end of the range, so blur moves it monotonically.
    let up = Vector3::new(0.0, 1.0, 0.0);
    let red = |alpha: f32| Basis::Rgb.to_rgb(sky.glossy_ambient(Basis::Rgb, up, alpha))[0];
    assert!((0..10).all(|i| red(i as f32 * 0.1) < red(i as f32 * 0.1 + 0.1)));
}

#[test]
fn ambient_light_is_never_seen() {
    let light = light("ambient", Params::new().rgb("L", [0.2; 3]));
    let up = Vector3::new(0.0, 1.0, 0.0);
    assert_eq!(light.ambient(Basis::Rgb, up.into()), Spectrum::splat(0.2));
    assert_eq!(light.escaped(Basis::Rgb, up), Spectrum::BLACK);
    assert_eq!(light.glossy_ambient(Basis::Rgb, up, 0.5), Spectrum::BLACK);
    assert!(arriving(&*light, Point3::ZERO).is_none());
}

#[test]
fn placing_moves_and_turns_lights() {
    let turn =
        DAffine3::from_rotation_translation(DQuat::from_rotation_x(-PI / 2.0), DVec3::new(1.0, 0.0, 0.0));
    // Turns +z to +y, then moves along x.
    let m = Transform::from_f64(&turn);
    let mut spot = light("spot", Params::new());
    spot.place(&m.into());
    assert!(arriving(&*spot, Point3::new(1.0, 3.0, 0.0)).is_some());
    assert!(arriving(&*spot, Point3::new(1.0, 0.0, 3.0)).is_none());
    let mut sun = light("distant", Params::new());
    sun.place(&m.into());
    let wi = arriving(&*sun, Point3::ZERO).expect("lit").wi;
    assert!((wi - Vector3::new(0.0, -1.0, 0.0)).length() < 1e-6);
    let mut point = light("point", point3(Params::new(), "from", [0.0, 0.0, 2.0]));
    point.place(&m.into());
    let at = arriving(&*point, Point3::ZERO).expect("lit").point.expect("near");
    assert!((at - Point3::new(1.0, 2.0, 0.0)).length() < 1e-6);
    let mut sky = light("gradientsky", Params::new().rgb("zenith", [9.0; 3]));
    sky.place(&Track::still(DAffine3::from_rotation_x(PI / 2.0)));
    assert!(sky.escaped(Basis::Rgb, Vector3::new(0.0, 0.0, 1.0)).mean() > 8.9);
}

#[test]
fn every_light_gives_finite_light_everywhere() {
    let mut random = Random::new(11);
    for entry in LIGHTS {
        let is_required = |p: &&ParamSpec| p.default == ParamDefault::Required;
        let files = entry.schema.params.iter().filter(is_required);
        let params = files.fold(Params::new(), |all, p| all.string(p.name, "any"));
        let mut light = light(entry.schema.name, params);
        light.place(&Transform::translate(Vector3::new(0.5, -2.0, 1.0)).into());
        for i in 0..500 {
            let d = random.direction();
            let p = Point3::ZERO + v(d * 10f64.powi(i % 9 - 4));
            if let Some(s) = arriving(&*light, p) {
                assert!(s.weight.is_finite() && s.weight.max() > 0.0, "{}", entry.schema.name);
                assert!((s.wi.length() - 1.0).abs() < 1e-5);
            }
            let d = v(d);
            let alpha = random.unit() as f32;
            let seen = [light.escaped(Basis::Rgb, d), light.glossy_ambient(Basis::Rgb, d, alpha)];
            let all = seen.into_iter().chain([light.ambient(Basis::Rgb, d.into())]);
            assert!(all.into_iter().all(|s| s.is_finite() && s.mean() >= 0.0), "{}", entry.schema.name);
        }
    }
}

#[test]
fn contradictory_parameters_are_refused() {
    assert!(try_light("distant", point3(Params::new(), "to", [0.0; 3])).is_err());
    assert!(try_light("spot", point3(Params::new(), "from", [0.0, 0.0, 1.0])).is_err());
    assert!(try_light("point", Params::new().rgb("I", [0.0; 3]).float("power", 1.0)).is_err());
    let flat = Params::new().with("up", ValueType::Vector3, Data::Floats(vec![0.0; 3]));
    assert!(try_light("gradientsky", flat).is_err());
}
