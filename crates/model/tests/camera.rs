//! Cameras against closed forms.
use durer_core::math::{Point2, Point3, Ray, Vector3};
use durer_model::camera::{CAMERAS, Camera, Lens};
use durer_scene::{Args, Data, Diagnostics, Node, Params, ValueType};

fn build(kind: &str, params: Params, width: u32, height: u32) -> Result<(Box<dyn Camera>, String), String> {
    let node = Node::new(kind, params);
    let entry = CAMERAS.iter().find(|e| e.answers_to(kind)).expect("a registered word");
    let mut diagnostics = Diagnostics::default();
    let camera = (entry.build)(&mut Args::check(&node, entry.schema, &[], &mut diagnostics));
    let said = diagnostics.iter().map(|d| d.message.as_str()).collect::<Vec<_>>().join("; ");
    let Some(mut camera) = camera else {
        return Err(said);
    };
    camera.fit(width, height);
    Ok((camera, said))
}

fn camera(kind: &str, params: Params, width: u32, height: u32) -> Box<dyn Camera> {
    build(kind, params, width, height).expect("sound parameters").0
}

fn through(camera: &dyn Camera, x: f32, y: f32) -> Ray {
    camera.ray(Point2::new(x, y), Lens::CENTRE, 0.25)
}

/// Slopes x / z and y / z of a ray.
fn slopes(ray: &Ray) -> [f64; 2] {
    [f64::from(ray.d.x) / f64::from(ray.d.z), f64::from(ray.d.y) / f64::from(ray.d.z)]
}

fn four(v: [f32; 4]) -> (ValueType, Data) {
    (ValueType::Float, Data::Floats(v.to_vec()))
}

#[test]
fn the_centre_looks_along_z_whatever_the_shape_of_the_picture() {
    for (w, h) in [(1, 1), (640, 480), (480, 640), (1920, 1)] {
        for kind in ["perspective", "orthographic"] {
            let ray = through(camera(kind, Params::new(), w, h).as_ref(), 0.5, 0.5);
            assert_eq!(
                (ray.o, ray.d, ray.time),
                (Point3::ZERO, Vector3::new(0.0, 0.0, 1.0), 0.25),
                "{kind} {w} {h}"
            );
        }
    }
}

#[test]
fn corners_are_where_the_closed_form_says() {
    let t = 20f64.to_radians().tan();
    for (axis, w, h, x, y) in [
        ("shorter", 300, 200, 1.5 * t, t),
        ("shorter", 200, 300, t, 1.5 * t),
        ("x", 300, 200, t, t / 1.5),
        ("x", 200, 300, t, 1.5 * t),
        ("y", 300, 200, 1.5 * t, t),
        ("y", 200, 300, t / 1.5, t),
    ] {
        let camera = camera("perspective", Params::new().float("fov", 40.0).string("fovaxis", axis), w, h);
        for (film_x, film_y, right, up) in
            [(0.0, 0.0, -1.0, 1.0), (1.0, 0.0, 1.0, 1.0), (0.0, 1.0, -1.0, -1.0)]
        {
            let ray = through(camera.as_ref(), film_x, film_y);
            let [sx, sy] = slopes(&ray);
            assert!((sx - right * x).abs() < 1e-6 && (sy - up * y).abs() < 1e-6, "{axis} {w}x{h}: {sx} {sy}");
        }
    }
}

#[test]
fn directions_have_unit_length_and_depth_is_length_times_cosine() {
    // G7: a wall at depth 7 is met at t = 7 / cos a.
    let camera = camera("perspective", Params::new().float("fov", 100.0), 160, 90);
    for i in 0..=20 {
        for j in 0..=20 {
            let ray = through(camera.as_ref(), i as f32 / 20.0, j as f32 / 20.0);
            let [sx, sy] = slopes(&ray);
            let cosine = 1.0 / (1.0 + sx * sx + sy * sy).sqrt();
            assert!((ray.d.length() - 1.0).abs() < 1e-6);
            let t = 7.0 / f64::from(ray.d.z);
            assert!((t * cosine - 7.0).abs() < 1e-5, "{t} {cosine}");
        }
    }
}

#[test]
fn windows_and_aspect_ratios_replace_the_defaults() {
    let (ty, data) = four([0.0, 0.5, -1.0, 0.0]);
    let cut = camera("perspective", Params::new().with("screenwindow", ty, data.clone()), 100, 100);
    let near = |ray: &Ray, x: f64, y: f64| {
        let [sx, sy] = slopes(ray);
        (sx - x).abs() < 1e-6 && (sy - y).abs() < 1e-6
    };
    assert!(
        near(&through(cut.as_ref(), 0.0, 0.0), 0.0, 0.0) && near(&through(cut.as_ref(), 1.0, 1.0), 0.5, -1.0)
    );
    let wide = camera("perspective", Params::new().float("frameaspectratio", 2.0), 100, 100);
    assert!(near(&through(wide.as_ref(), 1.0, 0.0), 2.0, 1.0));
    let parallel = camera("orthographic", Params::new().with("screenwindow", ty, data), 100, 100);
    assert_eq!(through(parallel.as_ref(), 1.0, 1.0).o, Point3::new(0.5, -1.0, 0.0));
    let parallel = camera("orthographic", Params::new(), 200, 100);
    assert_eq!(through(parallel.as_ref(), 0.0, 0.0).o, Point3::new(-2.0, 1.0, 0.0));
}

#[test]
fn what_makes_no_picture_is_refused() {
    let (ty, data) = four([1.0, 1.0, 0.0, 1.0]);
    for params in [
        Params::new().float("fov", 0.0),
        Params::new().float("fov", 180.0),
        Params::new().float("fov", 200.0),
        Params::new().float("frameaspectratio", 0.0),
        Params::new().with("screenwindow", ty, data),
        Params::new().with("screenwindow", ValueType::Float, Data::Floats(vec![1.0; 3])),
    ] {
        assert!(build("perspective", params.clone(), 8, 8).is_err(), "{params:?}");
    }
}

/// Where the film (from the left, in pictures' widths) sees the point `(0, 0, z)` through the lens point of number `u`:
/// rays shift evenly with the film.
fn seen(camera: &dyn Camera, z: f64, u: Point2) -> f64 {
    let x = |film: f32| {
        let ray = camera.ray(Point2::new(film, 0.5), u, 0.0);
        let slope = f64::from(ray.d.x) / f64::from(ray.d.z);
        // At infinity the direction alone counts.
        if z.is_infinite() { slope } else { f64::from(ray.o.x) + slope * z }
    };
    let (left, right) = (x(0.0), x(1.0));
    -left / (right - left)
}

/// Diameter in mm of the image of the point `(0, 0, z)` on the film behind a lens of 50 mm that is focused at `focus`.
fn circle_of_confusion(n: f32, focus: f32, z: f64) -> f64 {
    // 20 degrees wide at the distance where the film is.
    let params = Params::new().float("fov", 20.0).float("fnumber", n).float("focallength", 50.0);
    let camera = camera("perspective", params.float("focaldistance", focus), 100, 100);
    // The lens's rim, left and right.
    let across = |y| seen(camera.as_ref(), z, Point2::new(y, 0.5));
    let widths = (across(0.0) - across(1.0)).abs();
    let film_mm = 50.0 * f64::from(focus) / (f64::from(focus) - 0.05);
    widths * 2.0 * 10f64.to_radians().tan() * film_mm
}

#[test]
fn circles_of_confusion_have_the_diameters_of_f3() {
    for (z, expected) in [(1.0, 0.641_026), (4.0, 0.320_513), (f64::INFINITY, 0.641_026), (2.0, 0.0)] {
        let found = circle_of_confusion(2.0, 2.0, z);
        assert!((found - expected).abs() < 2e-5, "{z} m: {found} mm, expected {expected}");
    }
}

#[test]
fn from_half_the_hyperfocal_distance_everything_is_sharp_f5() {
    let (f, n, c) = (50.0, 2.0, 0.03);
    let hyperfocal: f64 = (f * f / (n * c) + f) * 1e-3;
    assert!((hyperfocal - 41.7167).abs() < 1e-4);
    let blur = |z: f64| circle_of_confusion(2.0, 41.7167, z);
    let nearest = hyperfocal * 0.5;
    for z in [f64::INFINITY, nearest] {
        assert!((blur(z) - c).abs() < 2e-4, "{z}: {}", blur(z));
    }
    for z in [nearest * 1.01, 30.0, 60.0, 1000.0] {
        assert!(blur(z) < c, "{z}: {}", blur(z));
    }
    assert!(blur(nearest * 0.97) > c);
}

fn lens(params: Params) -> Lens {
    camera("perspective", params.float("lensradius", 0.5), 1, 1).lens().clone()
}

/// Points of the lens for `n x n` cells.
fn aperture(lens: &Lens, n: u32) -> impl Iterator<Item = [f64; 2]> {
    let at = move |i: u32| (i as f32 + 0.5) / n as f32;
    (0..n * n).map(move |i| lens.at(Point2::new(at(i % n), at(i / n))).map(f64::from))
}

#[test]
fn round_lenses_are_evenly_covered() {
    let (n, lens) = (256, lens(Params::new()));
    let of = |weigh: fn(f64) -> f64| {
        aperture(&lens, n).map(|[x, y]| weigh(x.hypot(y))).sum::<f64>() / f64::from(n * n)
    };
    // The RMS radius is r / sqrt 2, the mean radius 2 r / 3, and a quarter lies within half the radius.
    assert!((of(|r| r * r).sqrt() - 0.5 / 2f64.sqrt()).abs() < 1e-4);
    assert!((of(|r| r) - 1.0 / 3.0).abs() < 1e-4);
    assert!((of(|r| f64::from(u8::from(r < 0.25))) - 0.25).abs() < 2e-3);
    assert!(aperture(&lens, n).all(|[x, y]| x.hypot(y) <= 0.5));
    assert_eq!(lens.at(Lens::CENTRE), [0.0; 2]);
}

#[test]
fn blades_make_polygons_that_are_evenly_covered() {
    for blades in [3, 5, 6, 8] {
        let lens = lens(Params::new().int("blades", blades).float("bladerotation", 10.0));
        let top = (90f64 + 10.0).to_radians();
        let step = std::f64::consts::TAU / f64::from(blades);
        // Inside of every side; each side is the same distance from the centre.
        let inner = 0.5 * (step / 2.0).cos();
        let normal = |k: i32| top + step * (f64::from(k) + 0.5);
        let beyond = |[x, y]: [f64; 2]| {
            (0..blades).map(|k| x * normal(k).cos() + y * normal(k).sin() - inner).fold(f64::MIN, f64::max)
        };
        let n = 240;
        assert!(aperture(&lens, n).all(|p| beyond(p) < 1e-6), "{blades}");
        // As many in each cell of a grid as its share of the polygon's area, for the cells wholly inside.
        let area = 0.5 * 0.25 * f64::from(blades) * step.sin();
        let (cell, mut counts) = (0.1, std::collections::HashMap::new());
        for [x, y] in aperture(&lens, n) {
            *counts.entry(((x / cell).floor() as i32, (y / cell).floor() as i32)).or_insert(0u32) += 1;
        }
        let mut whole = 0;
        for (&(i, j), &count) in &counts {
            let corner = |a: i32, b: i32| [f64::from(i + a) * cell, f64::from(j + b) * cell];
            if [(0, 0), (0, 1), (1, 0), (1, 1)].iter().all(|&(a, b)| beyond(corner(a, b)) < 0.0) {
                whole += 1;
                let expected = cell * cell / area * f64::from(n * n);
                let off = (f64::from(count) / expected - 1.0).abs();
                assert!(off < 0.05, "{blades} blades, cell {i},{j}: {count}, expected {expected}");
            }
        }
        assert!(whole >= 8, "{blades}: {whole}");
    }
}

#[test]
fn rays_of_a_lens_meet_in_the_plane_in_focus_f4() {
    for kind in ["perspective", "orthographic"] {
        let params = Params::new().float("lensradius", 0.3).float("focaldistance", 4.0).int("blades", 6);
        let camera = camera(kind, params, 30, 20);
        for (x, y) in [(0.5, 0.5), (0.1, 0.9), (1.0, 0.0)] {
            let film = Point2::new(x, y);
            let at = |u: Point2, z: f32| {
                let ray = camera.ray(film, u, 0.0);
                assert!((ray.d.length() - 1.0).abs() < 1e-6);
                ray.at((z - ray.o.z) / ray.d.z)
            };
            let middle = |z| at(Lens::CENTRE, z);
            for z in [1.0, 4.0, 10.0] {
                let widest = (0..400)
                    .map(|i| at(Point2::new((i % 20) as f32 / 19.0, (i / 20) as f32 / 19.0), z) - middle(z))
                    .fold(0.0f32, |m, v| m.max(v.length()));
                // Diameter A |z - z_f| / z_f at depth z: A |z - z_f| / z seen on the plane in focus.
                let expected = 0.3 * (z - 4.0).abs() / 4.0;
                assert!(
                    (widest - expected).abs() < 2e-5 + 0.01 * expected,
                    "{kind} {z}: {widest} {expected}"
                );
            }
        }
    }
}

#[test]
fn f_numbers_stand_for_radii_and_contradictions_are_refused() {
    let of = |params: Params| camera("perspective", params, 300, 200).lens().radius();
    // 24 mm high at 40 degrees: f = 12 mm / tan 20 degrees.
    let f = 12.0 / 20f64.to_radians().tan() * 1e-3;
    let radius = of(Params::new().float("fov", 40.0).float("fnumber", 2.8));
    assert!((f64::from(radius) - f / 5.6).abs() < 1e-8, "{radius}");
    assert_eq!(of(Params::new().float("fnumber", 2.0).float("focallength", 50.0)), 0.0125);
    for (kind, params) in [
        ("perspective", Params::new().float("fnumber", 2.0).float("lensradius", 0.1)),
        ("perspective", Params::new().float("fnumber", 0.0)),
        ("perspective", Params::new().float("focaldistance", 0.0)),
        ("perspective", Params::new().int("blades", 2)),
        ("perspective", Params::new().with("shuttercurve", ValueType::Float, Data::Floats(vec![1.0]))),
        ("perspective", Params::new().with("shuttercurve", ValueType::Float, Data::Floats(vec![0.0; 3]))),
        ("orthographic", Params::new().float("fnumber", 2.0)),
    ] {
        assert!(build(kind, params.clone(), 8, 8).is_err(), "{params:?}");
    }
}

#[test]
fn moments_follow_the_shutter_curve_and_rows() {
    let params =
        Params::new().float("shutteropen", 2.0).float("shutterclose", 4.0).float("rollingshutter", 0.5);
    let tent = params.clone().with("shuttercurve", ValueType::Float, Data::Floats(vec![0.0, 1.0, 0.0]));
    let of = |params: Params| camera("perspective", params, 1, 1).shutter().clone();
    let (even, tent) = (of(params), of(tent));
    assert_eq!(even.moment(0.25, 0, 10), 2.5 + 0.025);
    assert_eq!(even.moment(1.0, 9, 10), 4.0 + 0.475);
    // The integral of the tent up to t in [0, 1] from opening is t^2 / 2 of 1.
    for u in [0.02f32, 0.125, 0.3, 0.5] {
        let expected = 2.0 + (2.0 * u).sqrt();
        assert!((tent.moment(u, 0, 10) - 0.025 - expected).abs() < 1e-5, "{u}");
        assert!((tent.moment(1.0 - u, 0, 10) - 0.025 - (6.0 - expected)).abs() < 1e-5, "{u}");
    }
    assert!(!even.is_instant() && !even.sees_one_moment());
    let row = even.during(durer_core::math::Interval::point(1.0));
    assert!(row.is_instant() && !row.sees_one_moment() && row.moment(0.5, 4, 10) == 1.0 + 0.225);
}

/// pbrt-v4's directions (`x` right, `y` up, `z` ahead) of places in the picture, worked out by hand from its formulas.
#[test]
fn spherical_pictures_lie_as_pbrts() {
    let r = f64::sqrt(0.5);
    let sees = |mapping: &str, film: [f32; 2], expected: [f64; 3]| {
        let camera = camera("spherical", Params::new().string("mapping", mapping), 64, 64);
        let ray = through(camera.as_ref(), film[0], film[1]);
        assert_eq!((ray.o, ray.time), (Point3::ZERO, 0.25));
        let off =
            [ray.d.x, ray.d.y, ray.d.z].into_iter().zip(expected).map(|(a, b)| (f64::from(a) - b).abs());
        assert!(off.fold(0.0, f64::max) < 2e-6, "{mapping} {film:?}: {:?}, expected {expected:?}", ray.d);
    };
    for (film, expected) in [
        // Angle from the top down, longitude from +x by +z.
        ([0.3, 0.0], [0.0, 1.0, 0.0]),
        ([0.0, 0.5], [1.0, 0.0, 0.0]),
        ([0.25, 0.5], [0.0, 0.0, 1.0]),
        ([0.5, 0.5], [-1.0, 0.0, 0.0]),
        ([0.75, 0.5], [0.0, 0.0, -1.0]),
        ([0.25, 0.75], [0.0, -r, r]),
        // Beyond the edges, where filters reach: over the pole and over the seam.
        ([0.25, -0.25], [0.0, r, -r]),
        ([1.25, 0.5], [0.0, 0.0, 1.0]),
    ] {
        sees("equirectangular", film, expected);
    }
    // The ring half-way between the middle and an edge has height 1 - (1/2)² and radius sqrt(7)/4.
    let ring = 7f64.sqrt() / 4.0;
    for (film, expected) in [
        ([0.5, 0.5], [0.0, 1.0, 0.0]),
        ([1.0, 0.5], [1.0, 0.0, 0.0]),
        ([0.0, 0.5], [-1.0, 0.0, 0.0]),
        ([0.5, 1.0], [0.0, 0.0, 1.0]),
        ([0.5, 0.0], [0.0, 0.0, -1.0]),
        ([0.0, 0.0], [0.0, -1.0, 0.0]),
        ([1.0, 1.0], [0.0, -1.0, 0.0]),
        ([0.75, 0.5], [ring, 0.75, 0.0]),
        ([0.5, 0.25], [0.0, 0.75, -ring]),
        ([0.75, 0.75], [r, 0.0, r]),
    ] {
        sees("equalarea", film, expected);
    }
    // Beyond an edge lies what is within it, mirrored about the edge's middle.
    let camera = camera("spherical", Params::new(), 8, 8);
    for ([x, y], inside) in [([1.25, 0.625], [0.75, 0.375]), ([0.625, -0.25], [0.375, 0.25])] {
        assert_eq!(through(camera.as_ref(), x, y).d, through(camera.as_ref(), inside[0], inside[1]).d);
    }
}

/// Solid angle of the spherical triangle of three unit vectors (Van Oosterom and Strackee 1983).
fn solid_angle([a, b, c]: [[f64; 3]; 3]) -> f64 {
    let dot = |p: [f64; 3], q: [f64; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
    let cross = [b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0]];
    2.0 * dot(a, cross).atan2(1.0 + dot(a, b) + dot(b, c) + dot(c, a))
}

#[test]
fn spherical_pixels_cover_the_sphere_once() {
    // Of the two only the longitudes run the wrong way round: so they do in pbrt-v4.
    for (mapping, w, h, sign) in [("equalarea", 32usize, 32usize, 1.0), ("equirectangular", 64, 32, -1.0)] {
        let params = Params::new().string("mapping", mapping);
        let camera = camera("spherical", params, w as u32, h as u32);
        let at = |x: usize, y: usize| {
            let d = through(camera.as_ref(), x as f32 / w as f32, y as f32 / h as f32).d;
            assert!((d.length() - 1.0).abs() < 1e-6);
            [d.x, d.y, d.z].map(f64::from)
        };
        let mut sum = 0.0;
        for y in 0..h {
            for x in 0..w {
                let [a, b, c, d] = [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)];
                let found = sign * (solid_angle([a, c, b]) + solid_angle([a, d, c]));
                // A map that turns the same way everywhere meets no direction twice.
                assert!(
                    found > 0.0 || (mapping == "equirectangular" && found.abs() < 1e-6),
                    "{mapping} {x} {y}"
                );
                sum += found;
                if mapping == "equalarea" {
                    let share = found * (w * h) as f64 / (4.0 * std::f64::consts::PI);
                    // Pixels' edges are curved: the polygon differs, least where pixels are small.
                    assert!((share - 1.0).abs() < 0.12, "{x} {y}: {share}");
                }
            }
        }
        assert!((sum / (4.0 * std::f64::consts::PI) - 1.0).abs() < 1e-4, "{mapping}: {sum}");
    }
}

#[test]
fn what_a_spherical_camera_does_not_heed_is_said() {
    let (_, said) = build("spherical", Params::new().float("lensradius", 1.0), 8, 8).expect("sound");
    assert!(said.contains("\"lensradius\" has no effect"), "{said}");
    assert!(build("spherical", Params::new().string("mapping", "mercator"), 8, 8).is_err());
    let open = camera("spherical", Params::new(), 8, 8);
    assert!(!open.lens().is_open());
}
