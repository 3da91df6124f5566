//! The lens of glass against an oracle that traces it apart, against brute force, and against the thin lens.
use std::sync::Arc;

use durer_core::math::Point2;
use durer_model::camera::{CAMERAS, Camera, EyeRay, FilmBack, Lens};
use durer_scene::{Args, AssetError, Assets, Diagnostics, Image, ImageData, Mesh, Missing, Node, Params};
use durer_testkit::{
    DVec3,
    lens::{Row, backwards, forwards, rows, system_matrix},
};

const DOUBLE_GAUSS: &str = include_str!("lenses/double-gauss.dat");
const SINGLET: &str = include_str!("lenses/plano-convex.dat");

/// The file "lens" with this text, and a picture whose upper half is white.
struct Files(String);

impl Assets for Files {
    fn bytes(&self, path: &str) -> Result<Arc<[u8]>, AssetError> {
        match path {
            "lens" => Ok(self.0.clone().into_bytes().into()),
            _ => Err(AssetError::Missing { path: path.to_owned() }),
        }
    }
    fn mesh(&self, path: &str) -> Result<Arc<Mesh>, AssetError> {
        Err(AssetError::Missing { path: path.to_owned() })
    }
    fn image(&self, path: &str) -> Result<Arc<Image>, AssetError> {
        let data = match path {
            "half.png" => [vec![255; 32], vec![0; 32]].concat(),
            "black.png" => vec![0; 64],
            _ => return Err(AssetError::Missing { path: path.to_owned() }),
        };
        Ok(Arc::new(Image { width: 8, height: 8, channels: 1, data: ImageData::U8(data) }))
    }
}

fn build(text: &str, params: Params) -> Result<(Box<dyn Camera>, String), String> {
    let params = params.string("lensfile", "lens");
    let node = Node::new("realistic", params);
    let entry = CAMERAS.iter().find(|e| e.answers_to("realistic")).expect("a registered word");
    let (files, mut said) = (Files(text.to_owned()), Diagnostics::default());
    let mut args = Args::check(&node, entry.schema, &[], &mut said).with_assets(&files, Missing::Refuse);
    let camera = (entry.build)(&mut args);
    let said = said.iter().map(|d| d.message.as_str()).collect::<Vec<_>>().join("; ");
    let Some(mut camera) = camera else {
        return Err(said);
    };
    // 36 x 24 mm.
    camera.load(FilmBack { diagonal: 0.043_266_6 });
    camera.fit(36, 24);
    Ok((camera, said))
}

fn camera(text: &str, params: Params) -> Box<dyn Camera> {
    build(text, params).expect("a sound lens").0
}

/// `n x n` points of the lens: Roberts's sequence, so that no edge lies along them.
fn grid(n: u32) -> impl Iterator<Item = Point2> + Clone {
    let along = |i: u32, step: f64| ((f64::from(i) + 0.5) * step).fract() as f32;
    (0..n * n).map(move |i| Point2::new(along(i, 0.754_877_666_246_692_8), along(i, 0.569_840_290_998_053_3)))
}

/// The picture is upside down on the film: the place of the picture at a place of the film in mm, right and up as seen from
/// behind the camera.
fn shown(x: f64, y: f64) -> Point2 {
    Point2::new((0.5 - x / 36.0) as f32, (0.5 + y / 24.0) as f32)
}

fn mean_weight(camera: &dyn Camera, film: Point2, n: u32) -> f64 {
    grid(n).map(|u| f64::from(camera.eye(film, u, 0.0).weight)).sum::<f64>() / f64::from(n * n)
}

/// In mm: focal length by the system matrix, and distance of the rear principal plane behind the last surface.
fn cardinal(rows: &[Row]) -> [f64; 2] {
    let [a, _, c, _] = system_matrix(rows);
    let focal = -1.0 / c;
    [focal, focal * a - focal]
}

/// The same of the front: where the front principal plane is behind the first surface.
fn front_plane(rows: &[Row]) -> f64 {
    let [_, _, c, d] = system_matrix(rows);
    (d - 1.0) / c
}

/// Distance of the film behind the last surface, found from where a ray on the axis leaves the glass.
fn film_distance(camera: &dyn Camera, rows: &[Row]) -> f64 {
    let length: f64 = rows.iter().rev().skip(1).map(|r| r[1]).sum();
    let o = camera.eye(Point2::new(0.5, 0.5), Lens::CENTRE, 0.0).ray.o.to_f64() * 1e3;
    // Beside the axis the front surface lies behind its vertex.
    let radius = rows.first().expect("a surface")[0];
    o.z + radius - (radius * radius - o.x * o.x - o.y * o.y).sqrt() - length
}

#[test]
fn focal_lengths_are_those_of_the_system_matrix() {
    for (text, known) in [(DOUBLE_GAUSS, 50.0), (SINGLET, 50.0)] {
        let expected = cardinal(&rows(text))[0];
        assert!((expected - known).abs() < 0.6, "{expected}: the file says {known}");
        let found = 2.0 * 8.0 * f64::from(camera(text, Params::new().float("fnumber", 8.0)).lens().radius());
        assert!((found * 1e3 / expected - 1.0).abs() < 1e-6, "{found} {expected}");
    }
}

#[test]
fn rays_near_the_axis_meet_in_the_plane_in_focus() {
    for (text, focus) in [(DOUBLE_GAUSS, 0.5), (DOUBLE_GAUSS, 2.0), (SINGLET, 1.0), (DOUBLE_GAUSS, 100.0)] {
        let params = Params::new().float("aperturediameter", 1.0).float("focusdistance", focus);
        let camera = camera(text, params);
        // Conjugate by the system matrix: a ray from the film's middle crosses the axis again there.
        let rows = rows(text);
        let [a, b, c, d] = system_matrix(&rows);
        let behind = film_distance(camera.as_ref(), &rows);
        let length: f64 = rows.iter().rev().skip(1).map(|r| r[1]).sum();
        let object = (b + d * behind) / (a + c * behind);
        let expected = -object + length + behind;
        assert!((expected / f64::from(focus) * 1e-3 - 1.0).abs() < 2e-4, "{expected} mm, asked {focus} m");
        for u in grid(12) {
            let EyeRay { ray, weight } = camera.eye(Point2::new(0.5, 0.5), u, 0.0);
            if weight > 0.0 {
                let at = ray.at((focus - ray.o.z) / ray.d.z);
                // Of a stop of 1 mm; what is left is spherical aberration.
                assert!(at.x.hypot(at.y) < 2e-3 * focus * 0.5e-3 / 0.05 + 1e-6, "{focus}: {at:?}");
            }
        }
    }
}

/// RMS distance from the axis, at a depth, of what the middle of the picture sees.
fn cone(camera: &dyn Camera, z: f32) -> f64 {
    let rays = grid(160).map(|u| camera.eye(Point2::new(0.5, 0.5), u, 0.0)).filter(|eye| eye.weight > 0.0);
    let at = rays.map(|EyeRay { ray, .. }| ray.at((z - ray.o.z) / ray.d.z)).map(|p| p.x * p.x + p.y * p.y);
    let squares: Vec<f64> = at.map(f64::from).collect();
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

/// Where in front of the film the image of the stop is that the scene sees, in mm behind the first surface.
fn entrance(rows: &[Row]) -> f64 {
    let stop = rows.iter().position(|row| row[0] == 0.0).expect("a stop");
    // Up to the stop, the last way included.
    let [a, b, ..] = system_matrix(&rows[..=stop]);
    b / a
}

#[test]
fn near_the_axis_it_is_a_thin_lens() {
    // The singlet's spherical aberration moves the focus by several per cent of the depth of field at wider stops.
    for (text, n) in [(DOUBLE_GAUSS, 22.0), (SINGLET, 90.0)] {
        let focus = 2.0f32;
        let glass = camera(text, Params::new().float("fnumber", n).float("focusdistance", focus));
        let rows = rows(text);
        let [focal, rear] = cardinal(&rows);
        let behind = film_distance(glass.as_ref(), &rows);
        let front = behind + rows.iter().rev().skip(1).map(|r| r[1]).sum::<f64>();
        // Things s before the front principal plane have images s' behind the rear one.
        let magnified = (f64::from(focus) * 1e3 - front + front_plane(&rows)) / (behind - rear);
        let image = focal + focal / magnified;
        assert!((image / (behind - rear) - 1.0).abs() < 1e-4, "in focus: {image} {}", behind - rear);
        // A thin lens where the entrance pupil is, as wide, that sees as much of the plane in focus.
        let plane = ((front - entrance(&rows)) * 1e-3) as f32;
        let half = 12.0 * magnified * 1e-3 / f64::from(focus - plane);
        let node = Node::new(
            "perspective",
            Params::new()
                .float("fov", (2.0 * half.atan()).to_degrees() as f32)
                .float("focaldistance", focus - plane)
                .float("fnumber", n)
                .float("focallength", focal as f32),
        );
        let entry = CAMERAS.iter().find(|e| e.answers_to("perspective")).expect("a registered word");
        let mut said = Diagnostics::default();
        let mut thin = (entry.build)(&mut Args::check(&node, entry.schema, &[], &mut said)).expect("sound");
        thin.fit(36, 24);
        for z in [0.7, 1.0, 1.5, 3.0, 4.0, 20.0] {
            let (found, expected) = (cone(glass.as_ref(), z), cone(thin.as_ref(), z - plane));
            assert!((found / expected - 1.0).abs() < 0.01, "{z} m: {found}, thin {expected}");
        }
        assert!(cone(glass.as_ref(), focus) < 0.01 * cone(glass.as_ref(), 1.0));
        // The same scale: what is seen a millimetre beside the middle of the picture.
        let beside = |camera: &dyn Camera, z: f32| {
            let seen = grid(40).map(|u| camera.eye(shown(1.0, 0.0), u, 0.0)).filter(|eye| eye.weight > 0.0);
            let at: Vec<f64> = seen.map(|eye| eye.ray.at((z - eye.ray.o.z) / eye.ray.d.z).x.into()).collect();
            at.iter().sum::<f64>() / at.len() as f64
        };
        let (found, expected) = (beside(glass.as_ref(), focus), beside(thin.as_ref(), focus - plane));
        assert!((found / expected - 1.0).abs() < 2e-3, "{found}, thin {expected}");
        assert!(expected < 0.0, "what is on the right of the film is seen on the left");
    }
}

#[test]
fn rays_go_the_way_that_the_oracle_traces_and_never_through_the_barrel() {
    for (text, params) in [
        (DOUBLE_GAUSS, Params::new().float("fnumber", 2.0)),
        (DOUBLE_GAUSS, Params::new().float("fnumber", 8.0).float("focusdistance", 0.4)),
        (SINGLET, Params::new().float("aperturediameter", 10.0)),
    ] {
        let camera = camera(text, params);
        let rows = rows(text);
        let length: f64 = rows.iter().rev().skip(1).map(|r| r[1]).sum();
        let behind = film_distance(camera.as_ref(), &rows);
        let mut passed = 0;
        for (x, y) in [(0.0, 0.0), (3.0, -5.0), (-9.0, 2.0), (14.0, 8.0), (-17.0, -11.0), (17.9, 11.9)] {
            for u in grid(24) {
                let EyeRay { ray, weight } = camera.eye(shown(x, y), u, 0.0);
                if weight == 0.0 {
                    continue;
                }
                passed += 1;
                assert!((ray.d.length() - 1.0).abs() < 1e-6 && ray.d.z > 0.0);
                // The oracle has its front vertex at 0 and the film along +z.
                let turn = |v: DVec3| DVec3::new(v.x, v.y, -v.z);
                let o = turn(ray.o.to_f64() * 1e3) + DVec3::Z * (behind + length);
                let d = turn(DVec3::new(ray.d.x.into(), ray.d.y.into(), ray.d.z.into()));
                // Back from a centimetre in front of the lens.
                let back = forwards(&rows, o + d * 10.0, -d).expect("the same way back");
                assert!(back.height < 1.0 + 1e-5, "{}", back.height);
                let film = back.p + back.d * ((length + behind - back.p.z) / back.d.z);
                let off = (film.x - x).hypot(film.y - y);
                assert!(off < 2e-4, "{off} mm beside {x}, {y}");
            }
        }
        assert!(passed > 1000, "{passed}");
    }
}

/// What a point of the film receives of an even scene: `cos^4 / z^2` over the plane of the last surface, by brute force.
fn brute(rows: &[Row], behind: f64, (x, y): (f64, f64), n: u32) -> f64 {
    let length: f64 = rows.iter().rev().skip(1).map(|r| r[1]).sum();
    let half = rows.last().expect("a surface")[3] / 2.0 * 1.5;
    let from = DVec3::new(x, y, length + behind);
    let at = |i: u32| half * ((2 * i + 1) as f64 / f64::from(n) - 1.0);
    let mut sum = 0.0;
    for i in 0..n * n {
        let d = DVec3::new(at(i % n), at(i / n), length) - from;
        let through = backwards(rows, from, d).filter(|t| t.height < 1.0 && t.d.z < 0.0);
        if through.is_some() {
            let cosine = -d.normalize().z;
            sum += cosine.powi(4) / (behind * behind);
        }
    }
    sum * (2.0 * half / f64::from(n)).powi(2)
}

#[test]
fn pupils_are_sampled_whole_and_with_the_right_weight() {
    for (text, stop) in [(DOUBLE_GAUSS, 17.1), (DOUBLE_GAUSS, 5.0), (SINGLET, 18.0)] {
        let camera = camera(text, Params::new().float("aperturediameter", stop as f32));
        let mut rows = rows(text);
        rows.iter_mut().filter(|row| row[0] == 0.0).for_each(|row| row[3] = stop);
        let behind = film_distance(camera.as_ref(), &rows);
        let mut last = f64::INFINITY;
        for (x, y) in [(0.0, 0.0), (3.0, 4.0), (6.0, -8.0), (-12.0, 9.0), (-16.5, -11.0), (17.9, 11.9)] {
            let expected = brute(&rows, behind, (x, y), 500);
            let found = mean_weight(camera.as_ref(), shown(x, y), 300);
            assert!((found / expected - 1.0).abs() < 4e-3, "stop {stop}, {x} {y}: {found}, {expected}");
            assert!(found < last, "corners are darker: {found} at {x} {y}, {last} nearer to the middle");
            last = found;
        }
    }
}

#[test]
fn no_ray_that_passes_lies_outside_of_the_pupil_that_is_sampled() {
    // Were part of a pupil left out, its share would be missing: a million rays of brute force see 1e-4 of it.
    let camera = camera(DOUBLE_GAUSS, Params::new().float("aperturediameter", 17.1));
    let rows = rows(DOUBLE_GAUSS);
    let behind = film_distance(camera.as_ref(), &rows);
    for x in [0.4, 7.03, 13.37, 19.9] {
        let expected = brute(&rows, behind, (x, 0.0), 1600);
        let found = mean_weight(camera.as_ref(), shown(x, 0.0), 1600);
        assert!((found / expected - 1.0).abs() < 6e-4, "{x}: {found}, {expected}");
    }
}

#[test]
fn light_on_the_film_falls_with_the_square_of_the_f_number() {
    for n in [2.8, 4.0, 8.0, 16.0, 200.0] {
        let params = Params::new().float("fnumber", n).float("focusdistance", 1000.0);
        let found = mean_weight(camera(DOUBLE_GAUSS, params.clone()).as_ref(), Point2::new(0.5, 0.5), 400);
        // Abbe's sine condition: E = pi L sin^2, sin = 1 / 2N.
        let expected = std::f64::consts::PI / (4.0 * f64::from(n) * f64::from(n));
        assert!((found / expected - 1.0).abs() < 0.01, "f/{n}: {found}, {expected}");
        let even = camera(DOUBLE_GAUSS, params.string("exposure", "even").float("shutterclose", 0.01));
        let middle = mean_weight(even.as_ref(), Point2::new(0.5, 0.5), 400);
        assert!((middle - 1.0).abs() < 3e-3, "f/{n}: {middle}");
    }
    let short = Params::new().float("fnumber", 4.0).float("shutteropen", 0.5).float("shutterclose", 0.75);
    let whole =
        mean_weight(camera(DOUBLE_GAUSS, Params::new().float("fnumber", 4.0)).as_ref(), Lens::CENTRE, 50);
    let part = mean_weight(camera(DOUBLE_GAUSS, short).as_ref(), Lens::CENTRE, 50);
    assert!((part / whole - 0.25).abs() < 1e-6, "a quarter of a second");
}

#[test]
fn a_tiny_stop_is_found_all_over_the_film() {
    let camera = camera(DOUBLE_GAUSS, Params::new().float("aperturediameter", 0.02));
    let middle = mean_weight(camera.as_ref(), shown(0.0, 0.0), 100);
    assert!(middle > 0.0);
    for (x, y) in [(3.0, 0.0), (8.0, -3.0), (-13.0, 4.0)] {
        let found = mean_weight(camera.as_ref(), shown(x, y), 100) / middle;
        assert!((0.2..1.0).contains(&found), "{x} {y}: {found}");
    }
}

#[test]
fn all_shapes_of_the_stop_let_the_same_light_through() {
    let of = |word: &str| {
        let params = Params::new().float("fnumber", 11.0).string("aperture", word);
        let camera = camera(DOUBLE_GAUSS, params);
        let lit = grid(300).filter(|u| camera.eye(Point2::new(0.5, 0.5), *u, 0.0).weight > 0.0).count();
        (mean_weight(camera.as_ref(), Point2::new(0.5, 0.5), 300), lit as f64 / 9e4)
    };
    let (round, disk) = of("circular");
    // Areas by the disk's: a square of half the side, pbrt's pentagon of circumradius 0.8, its star.
    let golden =
        (72f64.to_radians().cos() / 36f64.to_radians().cos()) * 10.0 / 2.0 * 36f64.to_radians().sin();
    let pi = std::f64::consts::PI;
    for (word, area) in [
        ("square", 1.0 / pi),
        ("pentagon", 2.5 * 0.64 * 72f64.to_radians().sin() / pi),
        ("star", golden / pi),
        ("gaussian", 1.0),
    ] {
        let (light, lit) = of(word);
        assert!((light / round - 1.0).abs() < 0.01, "{word}: {light}, round {round}");
        assert!(
            (lit / disk / area - 1.0).abs() < 0.01,
            "{word}: {} of the disk, expected {area}",
            lit / disk
        );
    }
}

#[test]
fn a_picture_can_be_the_stop_and_stands_upright_in_it() {
    let camera = camera(DOUBLE_GAUSS, Params::new().float("fnumber", 11.0).string("aperture", "half.png"));
    let mut above = 0;
    for u in grid(60) {
        let EyeRay { ray, weight } = camera.eye(Point2::new(0.5, 0.5), u, 0.0);
        if weight > 0.0 {
            // Half a texel is blurred over the edge.
            assert!(f64::from(ray.o.y) > -0.13 * f64::from(camera.lens().radius()), "{:?}", ray.o);
            above += u32::from(ray.o.y > 0.0);
        }
    }
    assert!(above > 500, "{above}");
}

#[test]
fn what_is_no_lens_is_refused_with_its_place() {
    let refused = |text: &str, params: Params| build(text, params).expect_err("refused");
    for (text, params, expected) in [
        ("25 5 1.5", Params::new(), "lens: line 1: 3 numbers, expected 4"),
        ("# nothing", Params::new(), "lens: it has no refracting surface"),
        ("-25 5 1.5 20\n-1e6 0 1 20", Params::new(), "lens: this lens gathers no parallel light"),
        (SINGLET, Params::new().float("focusdistance", 0.15), "cannot focus nearer than 0.20"),
        (SINGLET, Params::new().float("aperturediameter", 0.0), "\"aperturediameter\" is 0"),
        (SINGLET, Params::new().float("fnumber", 0.0), "\"fnumber\" is 0"),
        (SINGLET, Params::new().float("fnumber", 4.0).float("aperturediameter", 1.0), "each says how wide"),
        (SINGLET, Params::new().string("aperture", "hexagon"), "hexagon"),
        (SINGLET, Params::new().string("aperture", "black.png"), "lets no light through"),
        ("10 30 1.9 20\n-10 0 1 20", Params::new(), "there is no place for a film"),
    ] {
        let said = refused(text, params);
        assert!(said.contains(expected), "{said}, expected {expected}");
    }
    let (_, said) = build(SINGLET, Params::new().float("aperturediameter", 30.0)).expect("clamped");
    assert!(said.contains("it opens to 18.0000 mm"), "{said}");
    let (_, said) =
        build("25.84 5 1.5168 20\n1e6 0 1 20", Params::new().float("aperturediameter", 3.0)).expect("sound");
    assert!(said.contains("has no aperture stop"), "{said}");
}
