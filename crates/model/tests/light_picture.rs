//! Pictures of the surroundings as lights: where pixels lie, how much light they give, what is refused.
use std::{
    f64::consts::{PI, TAU},
    sync::Arc,
};

use durer_core::{
    glam::{DAffine3, DVec3},
    math::{Normal3, Point3, Vector3},
    sampling::{Sampler, SamplerKind},
    spectrum::Basis,
};
use durer_model::light::{LIGHTS, Light, LightCx, Track};
use durer_scene::{
    Args, AssetError, Assets, Diagnostics, Image, ImageData, Mesh, Missing, Node, Params, find,
};
use durer_testkit::{quadrature, random::Random};

/// One picture, whatever the name.
struct Only(Option<Arc<Image>>);

impl Assets for Only {
    fn bytes(&self, path: &str) -> Result<Arc<[u8]>, AssetError> {
        Err(AssetError::Missing { path: path.to_owned() })
    }
    fn mesh(&self, path: &str) -> Result<Arc<Mesh>, AssetError> {
        Err(AssetError::Missing { path: path.to_owned() })
    }
    fn image(&self, path: &str) -> Result<Arc<Image>, AssetError> {
        self.0.clone().ok_or_else(|| AssetError::Missing { path: path.to_owned() })
    }
}

fn try_light(image: Option<Image>, params: Params, missing: Missing) -> Result<Box<dyn Light>, String> {
    let mut diagnostics = Diagnostics::default();
    let node = Node::new("infinite", params.string("filename", "sky.exr"));
    let entry = find(LIGHTS, "light", &node, &mut diagnostics).expect("a registered light");
    let assets = Only(image.map(Arc::new));
    let mut args = Args::check(&node, entry.schema, &[], &mut diagnostics).with_assets(&assets, missing);
    let built = (entry.build)(&mut args);
    let said: Vec<&str> = diagnostics.iter().map(|d| d.message.as_str()).collect();
    built.filter(|_| !diagnostics.has_errors()).ok_or_else(|| said.join("\n"))
}

fn light(image: Image, params: Params) -> Box<dyn Light> {
    try_light(Some(image), params, Missing::Refuse).expect("a sound light")
}

/// A picture whose pixel at the place `(u, v)` is `pixel(u, v)`.
fn picture(width: u32, height: u32, pixel: impl Fn(f64, f64) -> [f64; 3]) -> Image {
    let place = |i: u32, n: u32| (f64::from(i) + 0.5) / f64::from(n);
    let row = |y: u32| (0..width).map(move |x| (x, y));
    let pixels = (0..height).flat_map(row).flat_map(|(x, y)| pixel(place(x, width), place(y, height)));
    Image { width, height, channels: 3, data: ImageData::F32(pixels.map(|v| v as f32).collect()) }
}

/// Direction of a place in a picture of latitude and longitude: z up, from +x by +y.
fn direction(u: f64, v: f64) -> DVec3 {
    let (azimuth, from_zenith) = (u * TAU, v * PI);
    DVec3::new(from_zenith.sin() * azimuth.cos(), from_zenith.sin() * azimuth.sin(), from_zenith.cos())
}

fn v(d: DVec3) -> Vector3 {
    Vector3::from_f64(d)
}

fn escaped(light: &dyn Light, d: DVec3) -> [f32; 3] {
    Basis::Rgb.to_rgb(light.escaped(Basis::Rgb, v(d)))
}

fn ambient(light: &dyn Light, n: DVec3) -> [f32; 3] {
    Basis::Rgb.to_rgb(light.ambient(Basis::Rgb, Normal3::from_f64(n)))
}

fn glossy(light: &dyn Light, d: DVec3, alpha: f32) -> [f32; 3] {
    Basis::Rgb.to_rgb(light.glossy_ambient(Basis::Rgb, v(d), alpha))
}

fn near(got: [f32; 3], expected: [f64; 3], error: f64) -> bool {
    got.iter().zip(expected).all(|(g, e)| (f64::from(*g) - e).abs() <= error)
}

#[test]
fn a_picture_of_one_colour_is_a_constant_sky() {
    let rgb = [0.5, 1.0, 4.0];
    for (width, height) in [(40, 20), (1, 1), (7, 3)] {
        let sky = light(picture(width, height, |_, _| rgb), Params::new().float("scale", 2.0));
        let mut random = Random::new(3);
        for i in 0..200 {
            let d = random.direction();
            let alpha = (i as f32 / 199.0).powi(2);
            for got in [escaped(&*sky, d), ambient(&*sky, d), glossy(&*sky, d, alpha)] {
                assert!(near(got, [1.0, 2.0, 8.0], 1e-4), "{width} x {height}, {d}: {got:?}");
            }
        }
    }
}

#[test]
fn irradiance_of_a_linear_sky_is_that_of_the_closed_form() {
    // L = 1 + d.a has the irradiance pi (1 + 2/3 n.a).
    let a = DVec3::new(0.3, -0.5, 0.6);
    let sky = light(picture(200, 100, |x, y| [1.0 + direction(x, y).dot(a), 1.0, 0.0]), Params::new());
    let mut random = Random::new(4);
    for _ in 0..300 {
        let n = random.direction();
        let expected = 1.0 + 2.0 / 3.0 * n.dot(a);
        assert!(near(ambient(&*sky, n), [expected, 1.0, 0.0], 4e-3), "{n}: {:?}", ambient(&*sky, n));
        assert!(near(escaped(&*sky, n), [1.0 + n.dot(a), 1.0, 0.0], 2e-3), "{n}");
    }
}

#[test]
fn glossy_views_are_the_integral_over_their_lobe() {
    let f = |d: DVec3| (1.0 + d.x * d.y * 2.0 + d.z.powi(3)).max(0.0);
    let sky = light(picture(256, 128, |x, y| [f(direction(x, y)), 0.0, 1.0]), Params::new());
    let mut random = Random::new(5);
    for i in 0..24 {
        let axis = random.direction();
        let alpha = [1.0, 4.0, 9.0, 25.0][i % 4] / 36.0;
        // What GGX mirrors when seen along the normal h: density D(h) cos / (4 cos), weighted by the cosine to the axis.
        let (mut sum, mut weights) = (0.0, 0.0);
        let (s, t) = axis.any_orthonormal_pair();
        for j in 0..200 {
            let u = (f64::from(j) + 0.5) / 200.0;
            let half = (alpha * (u / (1.0 - u)).sqrt()).atan();
            let cos = (2.0 * half).cos().max(0.0);
            for k in 0..64 {
                let (sin_p, cos_p) = (f64::from(k) / 64.0 * TAU).sin_cos();
                let d = axis * cos + (s * cos_p + t * sin_p) * (2.0 * half).sin();
                sum += f(d) * cos;
                weights += cos;
            }
        }
        let got = glossy(&*sky, axis, alpha as f32);
        assert!(near(got, [sum / weights, 0.0, 1.0], 0.02), "{axis} {alpha}: {got:?} {}", sum / weights);
    }
}

/// pbrt-v4's directions of the middles of some squares of an equal-area picture of 4 x 4 pixels, by symmetry: columns to
/// +x, rows to +y, the inner diamond above.
const SQUARES: [([u32; 2], DVec3); 4] = [
    ([2, 2], DVec3::new(1.0, 1.0, 1.0)),
    ([1, 2], DVec3::new(-1.0, 1.0, 1.0)),
    ([3, 3], DVec3::new(1.0, 1.0, -1.0)),
    ([3, 0], DVec3::new(1.0, -1.0, -1.0)),
];

#[test]
fn a_bright_pixel_stands_where_its_layout_has_it() {
    let mut random = Random::new(6);
    let spot = |width: u32, height: u32, [x, y]: [u32; 2]| {
        let hit =
            move |u: f64, v: f64| (u * f64::from(width)) as u32 == x && (v * f64::from(height)) as u32 == y;
        picture(width, height, move |u, v| if hit(u, v) { [100.0; 3] } else { [0.0; 3] })
    };
    let mut cases: Vec<(Image, DVec3)> = (0..3)
        .map(|_| {
            let (x, y) = ((random.unit() * 64.0) as u32, 2 + (random.unit() * 28.0) as u32);
            let d = direction((f64::from(x) + 0.5) / 64.0, (f64::from(y) + 0.5) / 32.0);
            (spot(64, 32, [x, y]), d)
        })
        .collect();
    for (pixel, towards) in SQUARES {
        // In the equal-area map the middle of a square of the 4 x 4 grid has |z| = 1 - r², r = 1/2.
        let z = 0.75f64.copysign(towards.z);
        let r = (1.0 - z * z).sqrt() / 2f64.sqrt();
        cases.push((spot(4, 4, pixel), DVec3::new(towards.x * r, towards.y * r, z)));
    }
    for (image, d) in cases {
        let wide = image.width == 4;
        let sky = light(image, Params::new());
        assert!(near(escaped(&*sky, d), [100.0; 3], 0.1), "{d}: {:?}", escaped(&*sky, d));
        let brightest = |f: &dyn Fn(DVec3) -> f32| {
            let mut random = Random::new(7);
            let all = (0..4000).map(|_| random.direction());
            all.max_by(|a, b| f(*a).total_cmp(&f(*b))).expect("directions")
        };
        let angle = |e: DVec3| e.dot(d).clamp(-1.0, 1.0).acos();
        let (matte, dull) = (brightest(&|n| ambient(&*sky, n)[0]), brightest(&|n| glossy(&*sky, n, 0.1)[0]));
        let reach = if wide { 0.35 } else { 0.1 };
        assert!(angle(matte) < reach && angle(dull) < reach, "{d}: {matte} {dull}");
    }
}

#[test]
fn a_sun_of_one_pixel_lights_like_a_distant_light() {
    let (x, y) = (77, 60);
    let hit = |u: f64, v: f64| (u * 512.0) as u32 == x && (v * 256.0) as u32 == y;
    let sky = light(picture(512, 256, |u, v| [if hit(u, v) { 1e5 } else { 0.0 }; 3]), Params::new());
    let d = direction((f64::from(x) + 0.5) / 512.0, (f64::from(y) + 0.5) / 256.0);
    let edge = |i: u32| (f64::from(i) / 256.0 * PI).cos();
    let facing = 1e5 * (edge(y) - edge(y + 1)) * TAU / 512.0 / PI;
    let mut random = Random::new(12);
    for _ in 0..300 {
        let n = random.direction();
        // Tables round off the edge of the shadow.
        if n.dot(d).abs() > 0.15 {
            let expected = facing * n.dot(d).max(0.0);
            assert!(near(ambient(&*sky, n), [expected; 3], 0.01 * facing), "{n}: {:?}", ambient(&*sky, n));
        }
    }
}

#[test]
fn the_edges_of_an_equal_area_picture_are_below_the_horizon() {
    // r = sqrt(1 - |z|) = 1/2 and no azimuth: half way out the map of the upper half, and on the right edge of the picture
    // half way from its middle to a corner in the lower half.
    let spots = |x: f64, y: f64| {
        let inner = (x - 0.75).abs() < 0.04 && (y - 0.5).abs() < 0.04;
        let edge = x > 0.96 && ((y - 0.5).abs() - 0.25).abs() < 0.04;
        [f64::from(u8::from(inner)), f64::from(u8::from(edge)), 0.0]
    };
    let sky = light(picture(64, 64, spots), Params::new());
    let out = (1.0f64 - 0.75 * 0.75).sqrt();
    assert!(near(escaped(&*sky, DVec3::new(out, 0.0, 0.75)), [1.0, 0.0, 0.0], 1e-6));
    assert!(near(escaped(&*sky, DVec3::new(out, 0.0, -0.75)), [0.0, 1.0, 0.0], 1e-6));
}

#[test]
fn no_light_is_lost_by_blurring() {
    // Odd sizes, a sun of 1 pixel, and one at a pole.
    let sun = |x: f64, y: f64| if (x - 0.3).abs() < 0.0025 && (y - 0.2).abs() < 0.006 { 1e4 } else { 0.1 };
    let pole = |_: f64, y: f64| if y < 0.006 { 50.0 } else { 0.0 };
    let sky = light(picture(203, 101, |x, y| [sun(x, y), pole(x, y), 1.0]), Params::new());
    let mut power = [0.0; 2];
    for y in 0..101 {
        let edge = |i: i32| (f64::from(i) / 101.0 * PI).cos();
        let omega = (edge(y) - edge(y + 1)) * TAU / 203.0;
        for x in 0..203 {
            let (u, v) = ((f64::from(x) + 0.5) / 203.0, (f64::from(y) + 0.5) / 101.0);
            power[0] += sun(u, v) * omega;
            power[1] += pole(u, v) * omega;
        }
    }
    for (channel, power) in power.into_iter().enumerate() {
        // The irradiance / pi, averaged over all normals, is the radiance averaged over all directions.
        let mean = quadrature::sphere(200, |n| f64::from(ambient(&*sky, n)[channel])) / (4.0 * PI);
        let expected = power / (4.0 * PI);
        assert!((mean / expected - 1.0).abs() < 0.01, "{channel}: {mean} {expected}");
    }
}

#[test]
fn a_picture_turns_with_its_light() {
    let colours = |x: f64, y: f64| direction(x, y).to_array().map(|c| 1.0 + c);
    let mut sky = light(picture(128, 64, colours), Params::new());
    let turn = DAffine3::from_rotation_x(-PI / 2.0) * DAffine3::from_rotation_z(0.7);
    sky.place(&Track::still(turn));
    let mut random = Random::new(8);
    for _ in 0..50 {
        let d = random.direction();
        let own = turn.inverse().matrix3 * d;
        assert!(near(escaped(&*sky, d), (own + 1.0).to_array(), 5e-3), "{d}");
        assert!(near(ambient(&*sky, d), (own * (2.0 / 3.0) + 1.0).to_array(), 5e-3), "{d}");
        assert!(near(glossy(&*sky, d, 0.01), (own + 1.0).to_array(), 5e-3), "{d}");
    }
}

#[test]
fn there_is_no_seam_where_the_edges_of_the_picture_meet() {
    let colours = |x: f64, y: f64| direction(x, y).to_array().map(|c| 1.0 + c);
    let sky = light(picture(32, 16, colours), Params::new());
    for i in 0..100 {
        let from_zenith = PI * (f64::from(i) + 0.5) / 100.0;
        let at = |azimuth: f64| {
            DVec3::new(
                from_zenith.sin() * azimuth.cos(),
                from_zenith.sin() * azimuth.sin(),
                from_zenith.cos(),
            )
        };
        let (a, b) = (escaped(&*sky, at(1e-6)), escaped(&*sky, at(-1e-6)));
        assert!(near(a, b.map(f64::from), 1e-4), "{from_zenith}: {a:?} {b:?}");
    }
    // Across the poles.
    for (z, turned) in [(1.0, 0.3), (-1.0, 2.0)] {
        let at = |s: f64| DVec3::new(s * f64::cos(turned), s * f64::sin(turned), z).normalize();
        let (a, b) = (escaped(&*sky, at(1e-6)), escaped(&*sky, at(-1e-6)));
        assert!(near(a, b.map(f64::from), 1e-4), "{a:?} {b:?}");
        assert!(near(a, [1.0, 1.0, 1.0 + z], 0.02), "{a:?}");
    }
}

#[test]
fn bytes_are_srgb_and_floats_are_linear() {
    let grey = |data| Image { width: 2, height: 1, channels: 1, data };
    for (data, expected) in [
        (ImageData::U8(vec![188; 2]), 0.502_886),
        (ImageData::U16(vec![188 * 257; 2]), 0.502_886),
        (ImageData::F32(vec![0.25; 2]), 0.25),
    ] {
        let sky = light(grey(data), Params::new());
        assert!(near(escaped(&*sky, DVec3::Z), [expected; 3], 1e-5), "{:?}", escaped(&*sky, DVec3::Z));
    }
}

#[test]
fn illuminance_is_that_of_a_plane_that_faces_up() {
    let params = Params::new().float("illuminance", 7.0).float("scale", 2.0);
    let sky = light(picture(64, 32, |_, y| if y < 0.5 { [3.0; 3] } else { [50.0; 3] }), params);
    assert!(near(ambient(&*sky, DVec3::Z), [14.0 / PI; 3], 0.03), "{:?}", ambient(&*sky, DVec3::Z));
}

#[test]
fn layouts_can_be_forced() {
    let half = |_: f64, y: f64| if y < 0.5 { [1.0; 3] } else { [0.0; 3] };
    let sky = light(picture(64, 64, half), Params::new().string("layout", "latlong"));
    assert!(near(escaped(&*sky, DVec3::new(0.6, 0.0, 0.8)), [1.0; 3], 1e-6));
    let octahedron = light(picture(64, 64, half), Params::new());
    assert!(near(escaped(&*octahedron, DVec3::new(0.0, -0.6, -0.8)), [1.0; 3], 1e-6));
    assert!(near(escaped(&*octahedron, DVec3::new(0.0, 0.6, 0.8)), [0.0; 3], 1e-6));
}

#[test]
fn the_first_and_the_last_row_can_lie_in_the_poles() {
    const ROWS: u32 = 5;
    let row = |v: f64| (v * f64::from(ROWS)).floor();
    let sky = |rows: u32| {
        let lit = picture(8, rows, |_, v| [1.0 + row(v); 3]);
        light(lit, Params::new().string("layout", "poletopole"))
    };
    let sky = sky(ROWS);
    // Rows 0 to 4 stand at 0, 45, 90, 135 and 180 degrees, straight lines between them.
    for (v, expected) in [(1e-4, 1.0), (0.25, 2.0), (0.375, 2.5), (0.5, 3.0), (0.9, 4.6), (0.9999, 5.0)] {
        let got = escaped(&*sky, direction(0.3, v));
        assert!(near(got, [expected; 3], 2e-3), "{v}: {got:?}");
    }
    // Columns stay in the middles of their cells.
    let ring =
        light(picture(8, 3, |u, _| [(u * 8.0).floor(); 3]), Params::new().string("layout", "poletopole"));
    for column in 0..8u8 {
        let got = escaped(&*ring, direction((f64::from(column) + 0.5) / 8.0, 0.5));
        assert!(near(got, [f64::from(column); 3], 2e-3), "{column}: {got:?}");
    }
    // A picture of one row has no poles.
    let one = light(picture(4, 1, |_, _| [2.0; 3]), Params::new().string("layout", "poletopole"));
    assert_eq!(escaped(&*one, direction(0.1, 0.9)), [2.0; 3]);
}

#[test]
fn directions_are_drawn_by_their_density_where_rows_lie_in_the_poles() {
    let uneven = picture(7, 6, |u, v| [0.2 + (9.0 * u + 5.0 * v).sin().powi(2) * 4.0; 3]);
    let sky = light(uneven, Params::new().string("layout", "poletopole"));
    let cx = LightCx { basis: Basis::Rgb, time: 0.0 };
    // The density is one of solid angle: its integral is 1, and what is drawn has it.
    let (mut sum, n) = (0.0, 512u32);
    for (i, j) in (0..2 * n).flat_map(|i| (0..n).map(move |j| (i, j))) {
        let z = 1.0 - 2.0 * (f64::from(j) + 0.5) / f64::from(n);
        let azimuth = TAU * (f64::from(i) + 0.5) / f64::from(2 * n);
        let r = (1.0 - z * z).sqrt();
        sum += f64::from(sky.pdf_escaped(
            &cx,
            Point3::ZERO,
            v(DVec3::new(r * azimuth.cos(), r * azimuth.sin(), z)),
        ));
    }
    let integral = sum * 4.0 * PI / f64::from(2 * n * n);
    assert!((integral - 1.0).abs() < 2e-3, "{integral}");
    for i in 0..200 {
        let sampler = Sampler::new(SamplerKind::Sobol, 3, [0, 0], i, 200);
        let drawn = sky.sample(&cx, Point3::ZERO, &sampler).expect("a direction");
        let pdf = sky.pdf_escaped(&cx, Point3::ZERO, drawn.wi);
        assert!((drawn.pdf.expect("extent") / pdf - 1.0).abs() < 1e-3, "{drawn:?} {pdf}");
    }
}

#[test]
fn pictures_that_are_no_light_are_refused_with_a_reason() {
    let refused =
        |image: Image, params: Params| try_light(Some(image), params, Missing::Refuse).expect_err("no light");
    let holed = picture(4, 2, |x, _| if x < 0.3 { [f64::NAN; 3] } else { [1.0; 3] });
    let said = refused(holed, Params::new());
    assert!(said.contains("sky.exr") && said.contains("2 pixels are infinite or not a number"), "{said}");
    assert!(refused(picture(4, 2, |_, _| [1.0; 3]), Params::new().rgb("L", [1.0; 3])).contains("not both"));
    let black = refused(picture(4, 2, |_, _| [0.0; 3]), Params::new().float("illuminance", 1.0));
    assert!(black.contains("black"), "{black}");
    let short = Image { width: 4, height: 2, channels: 3, data: ImageData::U8(vec![0; 9]) };
    assert!(refused(short, Params::new()).contains("not sound"));
    assert!(try_light(None, Params::new(), Missing::Refuse).expect_err("missing").contains("file not found"));
    let placeholder = try_light(None, Params::new(), Missing::Warn).expect("a placeholder");
    assert_eq!(escaped(&*placeholder, DVec3::Z), [1.0, 0.0, 1.0]);
}

#[test]
fn a_picture_that_gives_no_light_is_told() {
    let told = |value: f64| {
        let mut diagnostics = Diagnostics::default();
        let node = Node::new("infinite", Params::new().string("filename", "sky.exr"));
        let entry = find(LIGHTS, "light", &node, &mut diagnostics).expect("a registered light");
        let assets = Only(Some(Arc::new(picture(4, 2, |_, _| [-1.0, value, -2.0]))));
        let mut args = Args::check(&node, entry.schema, &[], &mut diagnostics);
        args = args.with_assets(&assets, Missing::Refuse);
        assert!((entry.build)(&mut args).is_some());
        diagnostics.iter().map(|d| d.message.clone()).collect::<Vec<_>>()
    };
    assert_eq!(told(0.5), Vec::<String>::new());
    let black = told(-0.5);
    assert!(black.len() == 1 && black[0].starts_with("the picture is black everywhere"), "{black:?}");
}
