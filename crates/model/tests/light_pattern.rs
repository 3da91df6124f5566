//! Lights with a pattern: E12, the integral of the intensity is the power; where pictures and profiles point to.
use std::{f64::consts::PI, sync::Arc};

use durer_core::{
    glam::{DAffine3, DVec3},
    math::Point3,
    sampling::{Sampler, SamplerKind},
    spectrum::Basis,
};
use durer_model::light::{LIGHTS, Light, LightCx, Track};
use durer_scene::{
    Args, AssetError, Assets, Data, Diagnostics, Image, ImageData, Mesh, Missing, Node, Params, ValueType,
    find,
};
use durer_testkit::{quadrature, random::Random};

/// One picture and one file, whatever the name.
struct Only(Arc<Image>, String);

impl Assets for Only {
    fn bytes(&self, _path: &str) -> Result<Arc<[u8]>, AssetError> {
        Ok(self.1.as_bytes().into())
    }
    fn mesh(&self, path: &str) -> Result<Arc<Mesh>, AssetError> {
        Err(AssetError::Missing { path: path.to_owned() })
    }
    fn image(&self, _path: &str) -> Result<Arc<Image>, AssetError> {
        Ok(Arc::clone(&self.0))
    }
}

/// Grey pixels.
fn picture(width: u32, height: u32, pixel: impl Fn(u32, u32) -> f32) -> Image {
    let all = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let data = all.flat_map(|(x, y)| [pixel(x, y); 3]).collect();
    Image { width, height, channels: 3, data: ImageData::F32(data) }
}

fn try_light(kind: &str, params: Params, image: Image, file: &str) -> Result<Box<dyn Light>, String> {
    let mut said = Diagnostics::default();
    let node = Node::new(kind, params.string("filename", "file"));
    let entry = find(LIGHTS, "light", &node, &mut said).expect("a registered light");
    let assets = Only(Arc::new(image), file.to_owned());
    let mut args = Args::check(&node, entry.schema, &[], &mut said).with_assets(&assets, Missing::Refuse);
    let light = (entry.build)(&mut args);
    light.ok_or_else(|| said.iter().map(|d| d.message.as_str()).collect::<Vec<_>>().join("\n"))
}

fn light(kind: &str, params: Params, image: Image) -> Box<dyn Light> {
    try_light(kind, params, image, "").expect("a sound light")
}

fn ies(params: Params, file: &str) -> Box<dyn Light> {
    try_light("ies", params, picture(1, 1, |_, _| 1.0), file).expect("a sound profile")
}

/// Intensity in unit direction `d` of a light at the origin.
fn intensity(light: &dyn Light, d: DVec3) -> f64 {
    let cx = LightCx { basis: Basis::Rgb, time: 0.0 };
    let sampler = Sampler::new(SamplerKind::Sobol, 0, [0, 0], 0, 1);
    light.sample(&cx, Point3::from_f64(d * 2.0), &sampler).map_or(0.0, |s| 4.0 * f64::from(s.weight.mean()))
}

fn uneven(x: u32, y: u32) -> f32 {
    ((x * 5 + y * 3) % 7) as f32
}

/// A profile of these angles and intensities, of one lamp.
fn file(down: &[f64], around: &[f64], values: &[f64]) -> String {
    let words = |list: &[f64]| list.iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
    format!(
        "IESNA:LM-63-2002\n[TEST] of durer\n[LUMINAIRE] none, it is made up\nTILT=NONE\n1 -1 2 {} {} 1 2 0 0 0\n1.5 1 20\n\
         {}\n{}\n{}\n",
        down.len(),
        around.len(),
        words(down),
        words(around),
        words(values)
    )
}

const DOWN: [f64; 5] = [0.0, 20.0, 45.0, 90.0, 135.0];

fn profiles() -> Vec<String> {
    let values = |n: usize| (0..5 * n).map(|i| 100.0 + (i * i % 37) as f64 * 20.0).collect::<Vec<_>>();
    [&[0.0][..], &[0.0, 45.0, 90.0], &[0.0, 90.0, 180.0], &[90.0, 150.0, 270.0], &[0.0, 120.0, 240.0, 360.0]]
        .iter()
        .map(|around| file(&DOWN, around, &values(around.len())))
        .collect()
}

#[test]
fn the_integral_of_the_intensity_is_the_power() {
    let power = || Params::new().float("power", 10.0).float("scale", 0.5);
    let mut lights = vec![
        ("projection", light("projection", power().float("fov", 70.0), picture(12, 8, uneven))),
        ("tall projection", light("projection", power(), picture(4, 9, uneven))),
        ("goniometric", light("goniometric", power().rgb("I", [1.0, 2.0, 0.5]), picture(8, 8, uneven))),
    ];
    lights.extend(profiles().iter().map(|text| ("ies", ies(power(), text))));
    for (name, light) in &lights {
        assert!((light.power(1.0) - 5.0).abs() < 1e-5, "{name}");
        let luminance = |d: DVec3| {
            let cx = LightCx { basis: Basis::Rgb, time: 0.0 };
            let s =
                light.sample(&cx, Point3::from_f64(d), &Sampler::new(SamplerKind::Sobol, 0, [0, 0], 0, 1));
            let rgb = s.map_or([0.0; 3], |s| Basis::Rgb.to_rgb(s.weight));
            f64::from(durer_core::spectrum::Color { rgb }.luminance())
        };
        let found = quadrature::sphere(900, luminance);
        assert!((found / 5.0 - 1.0).abs() < 4e-3, "{name}: {found}");
    }
}

#[test]
fn the_power_of_a_profile_is_that_of_its_candela() {
    // 100 cd, twice, by a ballast factor of 1.5, over the lower half.
    let even = ies(Params::new(), &file(&[0.0, 90.0], &[0.0], &[100.0, 100.0]));
    assert!((f64::from(even.power(1.0)) / (300.0 * 2.0 * PI) - 1.0).abs() < 1e-6);
    assert!((intensity(&*even, DVec3::new(0.6, 0.0, 0.8)) / 300.0 - 1.0).abs() < 1e-5);
    assert_eq!(intensity(&*even, DVec3::new(0.6, 0.0, -0.8)), 0.0);
}

#[test]
fn angles_around_follow_their_symmetry() {
    let at = |light: &dyn Light, down: f64, around: f64| {
        let (d, a) = (down.to_radians(), around.to_radians());
        intensity(light, DVec3::new(d.sin() * a.cos(), d.sin() * a.sin(), d.cos())) / 3.0
    };
    let row = |values: &[f64]| values.iter().flat_map(|v| [*v; 2]).collect::<Vec<_>>();
    let of = |around: &[f64], values: &[f64]| ies(Params::new(), &file(&[0.0, 180.0], around, &row(values)));
    let near = |got: f64, expected: f64| {
        assert!((got - expected).abs() < 1e-3 * expected, "{got}, expected {expected}")
    };
    let quarters = of(&[0.0, 90.0], &[10.0, 40.0]);
    for (angle, expected) in
        [(0.1, 10.0333), (30.0, 20.0), (90.0, 40.0), (150.0, 20.0), (210.0, 20.0), (330.0, 20.0)]
    {
        near(at(&*quarters, 50.0, angle), expected);
    }
    let halves = of(&[0.0, 180.0], &[10.0, 40.0]);
    for (angle, expected) in [(60.0, 20.0), (120.0, 30.0), (240.0, 30.0), (300.0, 20.0)] {
        near(at(&*halves, 50.0, angle), expected);
    }
    let others = of(&[90.0, 270.0], &[10.0, 40.0]);
    for (angle, expected) in [(150.0, 20.0), (210.0, 30.0), (30.0, 20.0), (330.0, 30.0)] {
        near(at(&*others, 50.0, angle), expected);
    }
    let whole = of(&[0.0, 90.0, 360.0], &[10.0, 40.0, 10.0]);
    for (angle, expected) in [(45.0, 25.0), (180.0, 30.0), (270.0, 20.0)] {
        near(at(&*whole, 50.0, angle), expected);
    }
}

#[test]
fn a_luminaire_points_where_it_is_told() {
    let point = |name: &str, p: [f32; 3]| (name.to_owned(), p);
    let params = [point("from", [0.0; 3]), point("to", [0.0, -1.0, 0.0])]
        .iter()
        .fold(Params::new(), |all, (name, p)| all.with(name, ValueType::Point3, Data::Floats(p.to_vec())));
    let down = ies(params, &file(&[0.0, 90.0], &[0.0, 90.0], &[30.0, 3.0, 30.0, 9.0]));
    let near = |d: DVec3, expected: f64| assert!((intensity(&*down, d) / 3.0 - expected).abs() < 1e-2, "{d}");
    near(-DVec3::Y, 30.0);
    near(DVec3::new(1.0, -1e-4, 0.0).normalize(), 3.0);
    near(DVec3::new(0.0, -1e-4, 1.0).normalize(), 9.0);
    near(DVec3::Y, 0.0);
}

#[test]
fn pictures_stand_upright() {
    // Bright in the upper left pixel only.
    let corner = |x: u32, y: u32| if (x, y) == (0, 0) { 8.0 } else { 0.0 };
    let slide = light("projection", Params::new(), picture(2, 2, corner));
    assert!((intensity(&*slide, DVec3::new(-0.5, 0.5, 1.0).normalize()) - 8.0).abs() < 1e-4);
    for d in [[0.5, 0.5, 1.0], [-0.5, -0.5, 1.0], [0.5, -0.5, 1.0], [-1.5, 0.5, 1.0], [-0.5, 0.5, -1.0]] {
        assert_eq!(intensity(&*slide, DVec3::from_array(d).normalize()), 0.0);
    }
    // The middle of the octahedral map is +y.
    let middle = |x: u32, y: u32| if (2..6).contains(&x) && (2..6).contains(&y) { 1.0 } else { 0.0 };
    let globe = light("goniometric", Params::new(), picture(8, 8, middle));
    assert!(intensity(&*globe, DVec3::Y) > 0.9 && intensity(&*globe, -DVec3::Y) == 0.0);
}

#[test]
fn bounds_hold_what_shines_wherever_it_is_placed() {
    let mut random = Random::new(31);
    let wide = light("projection", Params::new(), picture(12, 4, |_, _| 1.0));
    let narrow = ies(Params::new(), &file(&[0.0, 10.0, 20.0, 90.0], &[0.0], &[5.0, 4.0, 0.0, 0.0]));
    for mut light in [wide, narrow] {
        let turn = durer_core::glam::DQuat::from_axis_angle(random.direction(), 2.0);
        light.place(&Track::still(DAffine3::from_quat(turn)));
        let cone = light.bounds().expect("a place").normals;
        let mut lit = 0;
        for _ in 0..20_000 {
            let d = random.direction();
            if intensity(&*light, d) > 0.0 {
                lit += 1;
                assert!(d.angle_between(cone.axis.to_f64()) <= f64::from(cone.angle) + 1e-5);
            }
        }
        assert!(lit > 100 && cone.angle < 1.4, "{lit}, {}", cone.angle);
    }
}

#[test]
fn what_is_no_profile_says_why() {
    let good = file(&[0.0, 90.0], &[0.0], &[1.0, 1.0]);
    let cases = [
        ("nonsense", "no line TILT="),
        ("TILT=lamp.tlt\n", "lamp.tlt"),
        ("TILT=NONE\n1 2 3", "ends before"),
        ("TILT=NONE\n1 2 x", "found \"x\""),
        (&good.replace("1 -1 2 2 1 1", "1 -1 2 2 1 2"), "type B"),
        (&good.replace("1 -1 2 2 1 1", "1 -1 2 1e9 1 1"), "vertical angles"),
        (&file(&[0.0, 90.0, 50.0], &[0.0], &[1.0; 3]), "do not rise"),
        (&file(&[0.0, 90.0], &[0.0, 33.0], &[1.0; 4]), "horizontal angles"),
        (&file(&[-90.0, 90.0], &[0.0], &[1.0; 2]), "vertical angles"),
        (&file(&[0.0, 90.0], &[0.0], &[1.0, -1.0]), "an intensity is"),
        (&file(&[0.0, 90.0], &[0.0], &[1.0]), "ends before"),
    ];
    for (text, expected) in cases {
        let said = try_light("ies", Params::new(), picture(1, 1, |_, _| 1.0), text).expect_err(expected);
        assert!(said.contains(expected), "{text}: {said}");
    }
    let tilted = good.replace("TILT=NONE", "TILT=INCLUDE\n1\n2\n0 90\n1 1");
    assert!(try_light("ies", Params::new(), picture(1, 1, |_, _| 1.0), &tilted).is_ok());
    let said =
        try_light("goniometric", Params::new(), picture(4, 3, |_, _| 1.0), "").expect_err("not square");
    assert!(said.contains("4 x 3"), "{said}");
    let black = try_light("projection", Params::new().float("power", 1.0), picture(2, 2, |_, _| 0.0), "");
    assert!(black.expect_err("black").contains("power"));
}
