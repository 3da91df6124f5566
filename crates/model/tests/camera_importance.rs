//! Cameras as light meets them: the places they see things at, and their importance.
use durer_core::math::{Point2, Point3, Vector3};
use durer_model::camera::{CAMERAS, Camera, Lens};
use durer_scene::{Args, Diagnostics, Node, Params, find};
use durer_testkit::{quadrature, random::Random};

const SIZE: [u32; 2] = [300, 200];

fn camera(kind: &str, params: Params) -> Box<dyn Camera> {
    let (node, mut said) = (Node::new(kind, params), Diagnostics::default());
    let entry = find(CAMERAS, "camera", &node, &mut said).expect("a registered word");
    let mut camera = (entry.build)(&mut Args::check(&node, entry.schema, &[], &mut said)).expect("sound");
    camera.fit(SIZE[0], SIZE[1]);
    camera
}

fn cameras() -> Vec<(&'static str, Box<dyn Camera>)> {
    let lens = || Params::new().float("lensradius", 0.4).float("focaldistance", 3.0);
    vec![
        ("pinhole", camera("perspective", Params::new().float("fov", 70.0))),
        ("thin lens", camera("perspective", lens().float("fov", 50.0))),
        ("blades", camera("perspective", lens().int("blades", 5))),
        ("parallel", camera("orthographic", Params::new())),
        ("parallel with a lens", camera("orthographic", lens())),
        ("equal area", camera("spherical", Params::new())),
        ("equirectangular", camera("spherical", Params::new().string("mapping", "equirectangular"))),
    ]
}

fn point(random: &mut Random) -> Point2 {
    Point2::new(random.unit() as f32, random.unit() as f32)
}

#[test]
fn points_are_seen_where_rays_through_their_place_meet_them() {
    for (name, camera) in cameras() {
        assert!(camera.is_connectible(), "{name}");
        let mut random = Random::new(7);
        for _ in 0..2000 {
            let (film, lens) = (point(&mut random), point(&mut random));
            let ray = camera.ray(film, lens, 0.0);
            let t = (0.2 + 6.0 * random.unit()) as f32;
            let seen = camera.sees(ray.at(t), lens).unwrap_or_else(|| panic!("{name}: {film:?}"));
            assert!((seen.film.x - film.x).hypot(seen.film.y - film.y) < 2e-5, "{name}: {film:?} {seen:?}");
            assert!(
                (seen.from - ray.o).length() < 1e-5 && (seen.d - ray.d).length() < 1e-5,
                "{name}: {seen:?}"
            );
        }
        let behind = camera.sees(Point3::new(0.1, 0.2, -1.0), Lens::CENTRE);
        assert_eq!(behind.is_some(), name.starts_with("equ"), "{name}");
    }
}

/// Rays spread evenly over a small square of the picture cover an area there: one over the importance.
#[test]
fn importance_is_the_density_of_rays() {
    for (name, camera) in cameras() {
        let mut random = Random::new(11);
        for _ in 0..500 {
            let at = Point2::new((0.1 + 0.8 * random.unit()) as f32, (0.1 + 0.8 * random.unit()) as f32);
            // The octahedral map has creases.
            let crease = [
                at.x - 0.5,
                at.y - 0.5,
                at.x + at.y - 1.0,
                at.x - at.y,
                at.x + at.y - 0.5,
                at.x + at.y - 1.5,
            ];
            let beside = [at.x - at.y - 0.5, at.x - at.y + 0.5];
            if crease.iter().chain(&beside).any(|v| v.abs() < 0.02) {
                continue;
            }
            let (lens, t) = (point(&mut random), (0.5 + 3.0 * random.unit()) as f32);
            let middle = camera.ray(at, lens, 0.0);
            let p = middle.at(t).to_f64();
            let n = middle.d.to_f64();
            const STEP: f32 = 1.0 / 256.0;
            let met = |dx: f32, dy: f32| {
                let ray = camera.ray(Point2::new(at.x + dx, at.y + dy), lens, 0.0);
                let (o, d) = (ray.o.to_f64(), ray.d.to_f64());
                o + d * ((p - o).dot(n) / d.dot(n))
            };
            let across = met(STEP, 0.0) - met(-STEP, 0.0);
            let down = met(0.0, STEP) - met(0.0, -STEP);
            let area = across.cross(down).dot(n).abs() / f64::from(2.0 * STEP).powi(2);
            let found = f64::from(camera.importance(middle.d, t)) * area;
            assert!((found - 1.0).abs() < 5e-3, "{name} at {at:?}: {found}");
        }
    }
}

/// All rays of the picture cross a sphere around the point of the lens: the integral of the density is 1.
#[test]
fn importance_has_the_integral_one_over_the_picture() {
    for (name, camera) in cameras().into_iter().filter(|(name, _)| !name.starts_with("parallel")) {
        let lens = Point2::new(0.3, 0.9);
        let from = camera.sees(Point3::new(0.0, 0.0, 1.0), lens).expect("ahead").from;
        let inside = |d: durer_core::glam::DVec3| {
            let d = Vector3::from_f64(d);
            let p = from + d * 2.0;
            let seen = camera
                .sees(p, lens)
                .filter(|s| (0.0..1.0).contains(&s.film.x) && (0.0..1.0).contains(&s.film.y));
            seen.map_or(0.0, |s| f64::from(camera.importance(s.d, 1.0)))
        };
        let integral = quadrature::sphere(1200, inside);
        assert!((integral - 1.0).abs() < 4e-3, "{name}: {integral}");
    }
    // Parallel rays cross a plane.
    let parallel = camera("orthographic", Params::new());
    let area = 2.0 * 2.0 * 1.5;
    assert!((parallel.importance(Vector3::new(0.0, 0.0, 1.0), 9.0) * area - 1.0).abs() < 1e-6);
}

#[test]
fn what_lies_beyond_the_edges_of_a_sphere_is_within_too() {
    for mapping in ["equalarea", "equirectangular"] {
        let camera = camera("spherical", Params::new().string("mapping", mapping));
        let mut random = Random::new(5);
        for _ in 0..1000 {
            let at = point(&mut random);
            let d = camera.ray(at, Lens::CENTRE, 0.0).d;
            for other in camera.repeats(at) {
                let seen = camera.ray(other, Lens::CENTRE, 0.0).d;
                assert!((seen - d).length() < 1e-5, "{mapping}: {at:?} {other:?}");
            }
            // And all that is near: a place beyond an edge leads to a repeat of the one within.
            let beyond = Point2::new(at.x * 0.1 - 0.1, at.y);
            let d = camera.ray(beyond, Lens::CENTRE, 0.0).d;
            let inside = camera.sees(Point3::ZERO + d, Lens::CENTRE).expect("all is seen").film;
            let near = |p: &Point2| (p.x - beyond.x).hypot(p.y - beyond.y) < 1e-4;
            assert!(camera.repeats(inside).iter().any(near), "{mapping}: {beyond:?} {inside:?}");
        }
    }
}
