//! Skies as paths ask them: directions follow their density, which is that of what rays see.
use std::{
    f64::consts::{PI, TAU},
    sync::Arc,
};

use durer_core::{
    glam::{DAffine3, DQuat, DVec3},
    math::{Point3, Vector3},
    sampling::{Sampler, SamplerKind},
    spectrum::Basis,
};
use durer_model::light::{LIGHTS, Light, LightCx, LightSample, Track};
use durer_scene::{
    Args, AssetError, Assets, Data, Diagnostics, Image, ImageData, Mesh, Missing, Node, Params, ValueType,
    find,
};
use durer_testkit::{chi_square::Histogram, quadrature, random::Random};

const CX: LightCx = LightCx { basis: Basis::Rgb, time: 0.0 };

/// One picture, whatever the name.
struct Only(Arc<Image>);

impl Assets for Only {
    fn bytes(&self, path: &str) -> Result<Arc<[u8]>, AssetError> {
        Err(AssetError::Missing { path: path.to_owned() })
    }
    fn mesh(&self, path: &str) -> Result<Arc<Mesh>, AssetError> {
        Err(AssetError::Missing { path: path.to_owned() })
    }
    fn image(&self, _path: &str) -> Result<Arc<Image>, AssetError> {
        Ok(Arc::clone(&self.0))
    }
}

fn built(kind: &str, params: Params, image: Image) -> Box<dyn Light> {
    let mut diagnostics = Diagnostics::default();
    let node = Node::new(kind, params);
    let entry = find(LIGHTS, "light", &node, &mut diagnostics).expect("a registered light");
    let assets = Only(Arc::new(image));
    let mut args =
        Args::check(&node, entry.schema, &[], &mut diagnostics).with_assets(&assets, Missing::Refuse);
    (entry.build)(&mut args).expect("a sound light")
}

fn no_image() -> Image {
    Image { width: 0, height: 0, channels: 3, data: ImageData::F32(Vec::new()) }
}

/// Grey pixels.
fn picture(width: u32, height: u32, pixel: impl Fn(u32, u32) -> f32) -> Image {
    let all = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let data = all.flat_map(|(x, y)| [pixel(x, y); 3]).collect();
    Image { width, height, channels: 3, data: ImageData::F32(data) }
}

fn file() -> Params {
    Params::new().string("filename", "sky.exr")
}

/// A dim sky, half of it black, with a bright pixel.
fn sunny(x: u32, y: u32) -> f32 {
    match (x, y) {
        (5, 3) => 300.0,
        _ if x < 8 => 0.0,
        _ => 0.5 + 0.1 * (y as f32),
    }
}

/// Skies of all kinds, with their names.
fn skies() -> Vec<(&'static str, Box<dyn Light>)> {
    let turned = DAffine3::from_quat(DQuat::from_euler(durer_core::glam::EulerRot::XYZ, 0.4, 1.1, -0.7));
    let mirrored = turned * DAffine3::from_scale(DVec3::new(1.0, -1.0, 1.0));
    let stretched = turned * DAffine3::from_scale(DVec3::new(1.0, 0.6, 2.0));
    let colors =
        Params::new().rgb("zenith", [0.1, 0.2, 3.0]).rgb("ground", [0.0; 3]).rgb("horizon", [0.0; 3]);
    let mut skies = vec![
        ("constant", built("infinite", Params::new(), no_image())),
        ("gradient", built("gradientsky", Params::new(), no_image())),
        ("blue", built("gradientsky", colors, no_image())),
        ("latlong", built("infinite", file(), picture(24, 12, sunny))),
        ("octahedral", built("infinite", file(), picture(16, 16, sunny))),
        ("turned", built("infinite", file(), picture(24, 12, sunny))),
        ("mirrored", built("infinite", file(), picture(16, 16, sunny))),
        ("stretched", built("infinite", file(), picture(24, 12, sunny))),
        ("one pixel", built("infinite", file(), picture(1, 1, |_, _| 2.0))),
    ];
    for ((_, sky), place) in skies[4..].iter_mut().zip([DAffine3::IDENTITY, turned, mirrored, stretched]) {
        sky.place(&Track::still(place));
    }
    skies
}

fn v(d: DVec3) -> Vector3 {
    Vector3::from_f64(d)
}

fn sample(light: &dyn Light, i: u32, n: u32) -> Option<LightSample> {
    light.sample(&CX, Point3::ZERO, &Sampler::new(SamplerKind::Independent, 11, [0, 0], i, n))
}

fn pdf(light: &dyn Light, d: DVec3) -> f64 {
    light.pdf_escaped(&CX, Point3::ZERO, Vector3::from_f64(d)).into()
}

fn seen(light: &dyn Light, d: DVec3) -> f64 {
    light.escaped(Basis::Rgb, Vector3::from_f64(d)).mean().into()
}

#[test]
fn directions_follow_their_density() {
    const N: u32 = 200_000;
    for (name, sky) in skies() {
        assert!(sky.is_sampled(), "{name}");
        let mut histogram = Histogram::default();
        for i in 0..N {
            match sample(&*sky, i, N) {
                Some(s) => histogram.add(s.wi.to_f64()),
                None => histogram.miss(),
            }
        }
        // Where a cell reaches into the dark nothing is given.
        let p = histogram.p_value(|d| if seen(&*sky, d) > 0.0 { pdf(&*sky, d) } else { 0.0 });
        // Sidak: 9 skies at 0.01 together.
        assert!(p > 0.001, "{name}: p = {p}");
    }
}

#[test]
fn densities_integrate_to_one_and_are_above_zero_where_there_is_light() {
    for (name, sky) in skies() {
        let integral = quadrature::sphere(600, |d| {
            let density = pdf(&*sky, d);
            assert!(density > 0.0 || seen(&*sky, d) == 0.0, "{name}, {d}");
            density
        });
        assert!((integral - 1.0).abs() < 0.02, "{name}: {integral}");
    }
}

#[test]
fn the_density_of_a_sample_is_that_of_its_direction() {
    for (name, sky) in skies() {
        let mut off = 0;
        for i in 0..10_000 {
            let Some(s) = sample(&*sky, i, 10_000) else { continue };
            let (claimed, found) = (f64::from(s.pdf.expect("of some extent")), pdf(&*sky, s.wi.to_f64()));
            // At the edge of a cell rounding may put the direction into the next.
            off += u32::from((claimed / found - 1.0).abs() > 1e-3);
            let weight = seen(&*sky, s.wi.to_f64()) / claimed;
            assert!((f64::from(s.weight.mean()) / weight - 1.0).abs() < 1e-4, "{name}");
            assert!(s.point.is_none() && (s.wi.length() - 1.0).abs() < 1e-5, "{name}");
        }
        assert!(off < 10, "{name}: {off}");
    }
}

/// E7 for the constant sky, quadrature for the others.
#[test]
fn irradiance_is_that_of_the_closed_form() {
    const N: u32 = 1 << 15;
    let irradiance = |sky: &dyn Light, n: DVec3| {
        let one = |i| {
            let s = sky.sample(&CX, Point3::ZERO, &Sampler::new(SamplerKind::Sobol, 3, [0, 0], i, N))?;
            Some(f64::from(s.weight.mean()) * s.wi.to_f64().dot(n).max(0.0))
        };
        (0..N).filter_map(one).sum::<f64>() / f64::from(N)
    };
    let sky = built("infinite", Params::new(), no_image());
    let got = irradiance(&*sky, DVec3::Z);
    assert!((got - PI).abs() < 1e-3, "E7: {got}");
    let mut random = Random::new(8);
    for (name, sky) in skies().iter() {
        for _ in 0..4 {
            let n = random.direction();
            let expected = quadrature::sphere(300, |d| seen(&**sky, d) * d.dot(n).max(0.0));
            let got = irradiance(&**sky, n);
            assert!((got - expected).abs() < 0.03 * expected + 0.01, "{name}: {got}, expected {expected}");
        }
    }
}

const PORTAL: [[f32; 3]; 4] = [[1.0, 2.0, -1.0], [1.0, 2.0, 0.5], [-1.0, 2.0, 0.5], [-1.0, 2.0, -1.0]];

fn with_portal(params: Params, corners: &[[f32; 3]]) -> Params {
    params.with("portal", ValueType::Point3, Data::Floats(corners.concat()))
}

#[test]
fn through_a_portal_directions_follow_their_density_and_bring_its_light() {
    const N: u32 = 50_000;
    const MOMENTS: [fn(DVec3) -> f64; 3] = [|_| 1.0, |d| d.x, |d| d.z * d.y];
    let turned = DAffine3::from_rotation_x(1.2);
    let world = DAffine3::from_translation(DVec3::new(0.1, -0.2, 0.3));
    for (name, mut sky) in [
        ("constant", built("infinite", with_portal(Params::new(), &PORTAL), no_image())),
        ("picture", built("infinite", with_portal(file(), &PORTAL), picture(24, 12, sunny))),
    ] {
        sky.place(&Track::still(turned));
        sky.place_portal(&world);
        for from in [DVec3::ZERO, DVec3::new(0.5, 1.7, 0.2), DVec3::new(4.0, -2.0, 1.0)] {
            let p = Point3::from_f64(from);
            let is_through = |d: DVec3| {
                let [low, high] = [[-1.0, 2.0, -1.0], [1.0, 2.0, 0.5]]
                    .map(|c| world.transform_point3(DVec3::from_array(c)));
                let t = (low.y - from.y) / d.y;
                let at = from + d * t;
                t > 0.0 && (low.x..high.x).contains(&at.x) && (low.z..high.z).contains(&at.z)
            };
            let pdf = |d: DVec3| f64::from(sky.pdf_escaped(&CX, p, v(d)));
            let (mut light, mut off, mut moments) = (0.0, 0, [0.0; 3]);
            for i in 0..N {
                let sampler = Sampler::new(SamplerKind::Independent, 4, [0, 0], i, N);
                let Some(s) = sky.sample(&CX, p, &sampler) else { continue };
                for (sum, moment) in moments.iter_mut().zip(MOMENTS) {
                    *sum += moment(s.wi.to_f64()) / f64::from(N);
                }
                light += f64::from(s.weight.mean()) / f64::from(N);
                let (claimed, found) = (f64::from(s.pdf.expect("of some extent")), pdf(s.wi.to_f64()));
                off += u32::from((claimed / found - 1.0).abs() > 1e-2);
            }
            // Rounding may put a direction into the next cell.
            assert!(off < N / 1000, "{name} {from}: {off}");
            // The edges of the portal cut the cells of a chi-square test: moments instead.
            for (moment, drawn) in MOMENTS.iter().zip(moments) {
                let expected =
                    quadrature::sphere(800, |d| if seen(&*sky, d) > 0.0 { pdf(d) * moment(d) } else { 0.0 });
                assert!((drawn - expected).abs() < 0.015, "{name} {from}: {drawn}, expected {expected}");
            }
            let expected = quadrature::sphere(800, |d| if is_through(d) { seen(&*sky, d) } else { 0.0 });
            assert!((light / expected - 1.0).abs() < 0.02, "{name} {from}: {light}, expected {expected}");
        }
        // From outside it is as without a portal.
        let outside = Point3::new(0.0, 5.0, 0.0);
        let all = quadrature::sphere(300, |d| sky.pdf_escaped(&CX, outside, v(d)).into());
        assert!((all - 1.0).abs() < 0.02, "{name}: {all}");
        let beside = (0..300).filter(|i| {
            let d = Vector3::from_f64(Random::new(*i).direction());
            d.y > 0.0 && sky.pdf_escaped(&CX, outside, d) > 0.0
        });
        assert!(beside.count() > 30, "{name}");
    }
}

#[test]
fn portals_are_rectangles() {
    let refused = |corners: &[[f32; 3]]| {
        let mut said = Diagnostics::default();
        let node = Node::new("infinite", with_portal(Params::new(), corners));
        let entry = find(LIGHTS, "light", &node, &mut said).expect("a registered light");
        let mut args = Args::check(&node, entry.schema, &[], &mut said);
        let _ = (entry.build)(&mut args);
        said.has_errors()
    };
    assert!(!refused(&PORTAL));
    assert!(refused(&PORTAL[..3]));
    assert!(refused(&[[1.0, 2.0, -1.0], [1.5, 2.0, 0.5], [-1.0, 2.0, 0.5], [-1.5, 2.0, -1.0]]));
    assert!(refused(&[[0.0; 3]; 4]));
}

#[test]
fn a_bright_pixel_gets_most_of_the_samples() {
    let sky = built("infinite", file(), picture(64, 32, |x, y| if (x, y) == (10, 8) { 1e5 } else { 0.01 }));
    let (azimuth, from_zenith) = (10.5 / 64.0 * TAU, 8.5 / 32.0 * PI);
    let sun =
        DVec3::new(from_zenith.sin() * azimuth.cos(), from_zenith.sin() * azimuth.sin(), from_zenith.cos());
    let near = |s: &LightSample| s.wi.to_f64().angle_between(sun) < 0.25;
    let hits = (0..4096).filter_map(|i| sample(&*sky, i, 4096)).filter(near).count();
    assert!(hits > 4080, "{hits}");
    // The dim part has the share of its light.
    let dim = |f: &dyn Fn(DVec3) -> f64| {
        quadrature::sphere(400, |d| if d.angle_between(sun) < 0.25 { 0.0 } else { f(d) })
    };
    let total = PI * 4.0 * f64::from(sky.escaped(Basis::Rgb, Vector3::from_f64(-sun)).mean())
        + 1e5 * 2.0 * PI.powi(2) / 2048.0 * from_zenith.sin();
    let (light, chance) = (dim(&|d| seen(&*sky, d)), dim(&|d| pdf(&*sky, d)));
    // What is as dim as this is drawn a little more often than its light deserves.
    assert!((0.95..1.5).contains(&(chance / (light / total))), "{chance} {light} {total}");
}

#[test]
fn black_skies_are_not_sampled() {
    let black = Params::new().rgb("zenith", [0.0; 3]).rgb("ground", [0.0; 3]).rgb("horizon", [0.0; 3]);
    for sky in [
        built("infinite", file(), picture(4, 2, |_, _| 0.0)),
        built("infinite", Params::new().rgb("L", [0.0; 3]), no_image()),
        built("infinite", file().float("scale", 0.0), picture(4, 2, sunny)),
        built("gradientsky", black, no_image()),
        built("ambient", Params::new(), no_image()),
    ] {
        assert!(!sky.is_sampled() && sample(&*sky, 0, 1).is_none());
    }
    let params = Params::new().with("L", ValueType::Rgb, Data::Floats(vec![0.0, 0.0, 1.0]));
    assert!(built("infinite", params, no_image()).is_sampled());
}

fn toward(params: Params, name: &str, d: [f32; 3]) -> Params {
    params.with(name, ValueType::Vector3, Data::Floats(d.to_vec()))
}

#[test]
fn a_disk_gives_its_irradiance_and_is_seen_where_it_is_sampled() {
    const N: u32 = 4096;
    for angle in [0.53f32, 20.0] {
        let sun = built("distant", Params::new().float("angle", angle).rgb("L", [3.0; 3]), no_image());
        assert!(sun.is_disk() && !sun.surrounds());
        let mut irradiance = 0.0;
        for i in 0..N {
            let s = sun
                .sample(&CX, Point3::ZERO, &Sampler::new(SamplerKind::Sobol, 1, [0, 0], i, N))
                .expect("lit");
            irradiance += f64::from(s.weight.mean() * -s.wi.z) / f64::from(N);
            let half = s.wi.to_f64().angle_between(-DVec3::Z).to_degrees() * 2.0;
            assert!(half <= f64::from(angle) * 1.0001, "{half}");
            if half < f64::from(angle) * 0.999 {
                let pdf = s.pdf.expect("of some extent");
                assert!((sun.pdf_escaped(&CX, Point3::ZERO, s.wi) / pdf - 1.0).abs() < 1e-5);
                let seen = sun.escaped(Basis::Rgb, s.wi).mean();
                assert!((s.weight.mean() * pdf / seen - 1.0).abs() < 1e-4);
            }
        }
        assert!((irradiance / 3.0 - 1.0).abs() < 1e-3, "{angle}: {irradiance}");
        assert_eq!(sun.escaped(Basis::Rgb, Vector3::new(0.0, 0.0, 1.0)).mean(), 0.0);
    }
    assert!(!built("distant", Params::new(), no_image()).is_disk());
}

/// The factor that makes a sky's units kcd/m² and klx: white of exposure value 15, by hand.
const UNIT: f32 = 39.3216;

#[test]
fn full_sun_is_exposed_as_a_photographer_does_it() {
    // Noon in clear air: a photograph by the rule of sunny 16 shows white paper nearly white, and a grey card of 18 % at
    // about 0.18, within a stop. A clear sky is neither white nor black.
    let sun = built("sun", toward(Params::new(), "sun", [0.5, 1.0, 0.0]), no_image());
    let sky = built("sky", toward(Params::new(), "sun", [0.5, 1.0, 0.0]), no_image());
    let up = durer_core::math::Normal3::new(0.0, 1.0, 0.0);
    let luminance = |s| durer_core::spectrum::Color { rgb: Basis::Rgb.to_rgb(s) }.luminance();
    let sample = sun.sample(&CX, Point3::ZERO, &Sampler::middle()).expect("it shines");
    let level = luminance(sample.weight) * sample.wi.y / std::f32::consts::PI
        + luminance(sky.ambient(Basis::Rgb, up));
    assert!((0.6..1.1).contains(&(0.9 * level)), "white paper: {}", 0.9 * level);
    assert!((0.09..0.36).contains(&(0.18 * level)), "grey card: {}", 0.18 * level);
    let overhead = luminance(sky.escaped(Basis::Rgb, Vector3::new(-0.6, 0.8, 0.0)));
    assert!((0.03..0.5).contains(&overhead), "sky: {overhead}");
}

#[test]
fn a_clear_sky_is_blue_and_brightest_about_the_sun() {
    let sky = |turbidity: f32, sun: [f32; 3]| {
        let params = Params::new().float("turbidity", turbidity).float("scale", UNIT);
        built("sky", toward(params, "sun", sun), no_image())
    };
    let high = [0.0, 0.8, 0.6];
    let clear = sky(2.5, high);
    let at = |sky: &dyn Light, d: [f64; 3]| {
        Basis::Rgb.to_rgb(sky.escaped(Basis::Rgb, v(DVec3::from_array(d).normalize())))
    };
    let luminance = |rgb: [f32; 3]| durer_core::spectrum::Color { rgb }.luminance();
    let zenith = at(&*clear, [0.0, 1.0, 0.0]);
    // Equation A.2 for 2.5 and 36.87 degrees: chi = 0.788889, 5.14225 tan chi - 0.53875 + 2.4192 kcd/m².
    let expected = {
        let chi = (4.0 / 9.0 - 2.5 / 120.0) * (PI - 2.0 * 0.6f64.asin());
        (4.0453 * 2.5 - 4.9710) * chi.tan() - 0.2155 * 2.5 + 2.4192
    };
    assert!((f64::from(luminance(zenith)) / expected - 1.0).abs() < 0.02, "{zenith:?}, expected {expected}");
    assert!(zenith[2] > 1.5 * zenith[0], "{zenith:?}");
    let [near, away] = [[0.0, 0.75, 0.65], [0.0, 0.8, -0.6]].map(|d| luminance(at(&*clear, d)));
    assert!(near > 2.0 * away, "{near} {away}");
    // The lower the sun, the redder its light and the darker the sky.
    let low = sky(2.5, [1.0, 0.05, 0.0]);
    assert!(luminance(at(&*low, [0.0, 1.0, 0.0])) < 0.5 * luminance(zenith));
    let sun = |height: f32| {
        let params = Params::new().float("scale", UNIT);
        let sun = built("sun", toward(params, "sun", [1.0, height, 0.0]), no_image());
        sun.sample(&CX, Point3::ZERO, &Sampler::middle()).map_or([0.0; 3], |s| Basis::Rgb.to_rgb(s.weight))
    };
    let [noon, evening] = [2.0, 0.05].map(sun);
    assert!((70.0..120.0).contains(&luminance(noon)), "klx at noon: {noon:?}");
    assert!(evening[0] > 3.0 * evening[2] && luminance(evening) < 0.4 * luminance(noon), "{evening:?}");
    assert_eq!(sun(-0.1), [0.0; 3]);
    // The ground is lit by both.
    let ground = luminance(at(&*clear, [0.0, -1.0, 0.0]));
    assert!((3.0..9.0).contains(&ground), "{ground}");
}
