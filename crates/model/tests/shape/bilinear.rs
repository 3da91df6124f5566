//! Bilinear patches: against an oracle that solves them another way, a fine mesh, and closed forms.
use durer_core::{
    glam::DVec3,
    math::{Point2, Point3, Ray, Vector3},
};
use durer_model::shape::{Geometry, Patch, SHAPES, Shape};
use durer_scene::{Args, Data, Diagnostics, Node, Params, ValueType};
use durer_testkit::{bilinear::meetings, random::Random};

use super::{build, points, ray, shape};

/// A saddle: z = 2 (u - 1/2)(v - 1/2) over the unit square.
const SADDLE: [[f32; 3]; 4] = [[0.0, 0.0, 0.5], [1.0, 0.0, -0.5], [0.0, 1.0, -0.5], [1.0, 1.0, 0.5]];

fn patch(corners: [[f32; 3]; 4]) -> Patch {
    Patch::new(corners.map(Point3::from))
}

fn exact(corners: [[f32; 3]; 4]) -> [DVec3; 4] {
    corners.map(|p| Point3::from(p).to_f64())
}

fn any_corners(random: &mut Random, scale: f64) -> [[f32; 3]; 4] {
    let flat = random.unit() < 0.3;
    let base = [[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]];
    base.map(|[x, y]| {
        let away = random.direction() * 0.8;
        [x + away.x, y + away.y, if flat { 0.3 } else { away.z }].map(|c| (c * scale) as f32)
    })
}

#[test]
fn hits_are_those_of_the_oracle() {
    let mut random = Random::new(21);
    for scale in [1e-4, 1.0, 1e6] {
        let (mut hits, mut twice) = (0, 0);
        for _ in 0..20_000 {
            let corners = any_corners(&mut random, scale);
            let o = random.direction() * 4.0 * scale;
            let target = random.direction() * random.between(0.0, 1.0) * scale;
            let ray = ray(o, target - o);
            let found = patch(corners).intersect(&ray);
            let expected = meetings(exact(corners), ray.o.to_f64(), ray.d.to_f64());
            let ahead: Vec<_> = expected.into_iter().filter(|m| m.0 > 0.0).collect();
            // An edge, or a silhouette, may go either way.
            let Some(&(t, u, v)) = ahead.first() else {
                assert!(found.is_none_or(|h| near_an_edge(h.u.into(), h.v.into())), "{corners:?} {ray:?}");
                continue;
            };
            let Some(hit) = found else {
                assert!(near_an_edge(u, v), "{corners:?} {ray:?} {t} {u} {v}");
                continue;
            };
            hits += 1;
            twice += usize::from(ahead.len() > 1);
            let meant = ahead.iter().any(|m| (m.0 - f64::from(hit.t)).abs() < 1e-6 * (1.0 + m.0));
            assert!(meant && f64::from(hit.t) <= t * (1.0 + 1e-6), "{corners:?} {ray:?}: {hit:?} {ahead:?}");
        }
        assert!(hits > 2000 && twice > 20, "{hits} {twice}");
    }
}

fn near_an_edge(u: f64, v: f64) -> bool {
    [u, v].iter().any(|x| x.min(1.0 - x).abs() < 1e-6)
}

#[test]
fn the_point_lies_on_the_patch_within_its_error() {
    let mut random = Random::new(22);
    for _ in 0..20_000 {
        let scale = 10f64.powf(random.between(-4.0, 6.0));
        let corners = any_corners(&mut random, scale);
        let size = exact(corners)[3].length();
        let o = random.direction() * size * 10f64.powf(random.between(0.3, 5.0));
        let ray = ray(o, random.direction() * 0.3 * size - o);
        let shape = patch(corners);
        let Some(hit) = shape.intersect(&ray) else { continue };
        let s = shape.surface(&ray, &hit);
        // Nearest point of the patch, by Newton's method from the hit.
        let [p00, p10, p01, p11] = exact(corners);
        let at = |u: f64, v: f64| p00.lerp(p10, u).lerp(p01.lerp(p11, u), v);
        let (mut u, mut v) = (f64::from(hit.u), f64::from(hit.v));
        for _ in 0..20 {
            let (du, dv) = ((p10 - p00).lerp(p11 - p01, v), (p01 - p00).lerp(p11 - p10, u));
            let off = s.p.to_f64() - at(u, v);
            let (a, b, c) = (du.dot(du), du.dot(dv), dv.dot(dv));
            let (x, y) = (du.dot(off), dv.dot(off));
            let det = a * c - b * b;
            (u, v) = (u + (x * c - y * b) / det, v + (y * a - x * b) / det);
        }
        // The surface passes through the box of uncertainty: its distance is less than that of the box's corners.
        let off = (s.p.to_f64() - at(u.clamp(0.0, 1.0), v.clamp(0.0, 1.0))).length();
        assert!(off <= s.n_g.to_f64().abs().dot(s.p_error.to_f64()), "{off:?} {:?}", s.p_error);
    }
}

#[test]
fn a_saddle_is_the_surface_of_its_formula() {
    let shape = patch(SADDLE);
    for (x, y) in [(0.5, 0.5), (0.25, 0.75), (0.9, 0.1), (0.0, 0.0), (1.0, 0.3)] {
        for side in [3.0, -3.0] {
            let down = ray(DVec3::new(x, y, side), DVec3::new(0.0, 0.0, -side));
            let hit = shape.intersect(&down).expect("over the square");
            let s = shape.surface(&down, &hit);
            let z = 2.0 * (x - 0.5) * (y - 0.5);
            assert!((s.p.to_f64() - DVec3::new(x, y, z)).length() < 1e-6, "{s:?}");
            assert!((s.uv.x - x as f32).abs() < 1e-6 && (s.uv.y - y as f32).abs() < 1e-6);
            let normal = DVec3::new(-2.0 * (y - 0.5), -2.0 * (x - 0.5), 1.0).normalize();
            assert!((s.n_g.to_f64() - normal).length() < 1e-6);
            let (dpdu, dpdv) = (DVec3::new(1.0, 0.0, 2.0 * (y - 0.5)), DVec3::new(0.0, 1.0, 2.0 * (x - 0.5)));
            assert!((s.dpdu.to_f64() - dpdu).length() < 1e-6 && (s.dpdv.to_f64() - dpdv).length() < 1e-6);
        }
    }
    // The integral of sqrt(1 + 4 (x^2 + y^2)) over the square of side 1 around the origin, by Simpson's rule.
    let (n, mut area) = (200, 0.0);
    let weight = |i: i32| {
        if i == 0 || i == n {
            1.0
        } else if i % 2 == 1 {
            4.0
        } else {
            2.0
        }
    };
    let h = 1.0 / f64::from(n);
    for (i, j) in (0..=n).flat_map(|i| (0..=n).map(move |j| (i, j))) {
        let (x, y) = (f64::from(i) * h - 0.5, f64::from(j) * h - 0.5);
        area += weight(i) * weight(j) * (1.0 + 4.0 * (x * x + y * y)).sqrt() * h * h / 9.0;
    }
    assert!((f64::from(shape.area()) - area).abs() < 1e-6 * area, "{} {area}", shape.area());
}

#[test]
fn a_line_through_both_sheets_meets_both() {
    // Along y = x the saddle is z = 2 (x - 1/2)^2: at height 0.2 there are two places.
    let at = |x: f64| DVec3::new(x, x, 0.2);
    let shape = patch(SADDLE);
    let along = ray(at(-1.0), at(1.0) - at(0.0));
    let root = 0.1f64.sqrt();
    let first = shape.intersect(&along).expect("the first sheet");
    assert!((f64::from(first.t) - (1.5 - root)).abs() < 1e-6);
    let second = shape.intersect(&Ray { t_min: first.t, ..along }).expect("the second");
    assert!((f64::from(second.t) - (1.5 + root)).abs() < 1e-6);
    assert!(shape.intersect(&Ray { t_min: second.t, ..along }).is_none());
}

#[test]
fn nothing_leaks_between_neighbours() {
    let mut random = Random::new(23);
    for _ in 0..300 {
        // Two patches that share the edge from b to c; rays aimed at points of it.
        let mut corner = |x: f64, y: f64| {
            let a = random.direction() * 0.4;
            [(x + a.x) as f32, (y + a.y) as f32, a.z as f32]
        };
        let [a, b, e] = [corner(-2.0, -1.0), corner(0.0, -1.0), corner(2.0, -1.0)];
        let [d, c, f] = [corner(-2.0, 1.0), corner(0.0, 1.0), corner(2.0, 1.0)];
        let (left, right) = (patch([a, b, d, c]), patch([b, e, c, f]));
        let [b, c] = [b, c].map(|p| Point3::from(p).to_f64());
        for _ in 0..100 {
            let target = Point3::from_f64(b.lerp(c, random.between(0.01, 0.99)));
            let o = Point3::new(random.between(-1.0, 1.0) as f32, random.between(-1.0, 1.0) as f32, 5.0);
            let aimed = Ray::new(o, target - o);
            assert!(left.intersect(&aimed).is_some() || right.intersect(&aimed).is_some(), "{aimed:?}");
        }
    }
}

#[test]
fn normals_and_texture_coordinates_of_the_corners_are_mixed() {
    let flat = patch([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0], [2.0, 1.0, 0.0]]);
    let uvs = [[0.0, 0.0], [4.0, 0.0], [0.0, 3.0], [4.0, 3.0]].map(Point2::from);
    let down = [durer_core::math::Normal3::new(0.0, 0.0, -2.0); 4];
    let shape = flat.with_uvs(uvs).with_normals(down);
    let r = ray(DVec3::new(0.5, 0.5, 1.0), -DVec3::Z);
    let s = shape.surface(&r, &shape.intersect(&r).expect("below"));
    assert_eq!((s.uv.x, s.uv.y), (1.0, 1.5));
    assert_eq!((s.n_g.z, s.n_s.z), (-1.0, -1.0));
    assert!((s.dpdu - Vector3::new(0.5, 0.0, 0.0)).length() < 1e-7);
    assert!((s.dpdv - Vector3::new(0.0, 1.0 / 3.0, 0.0)).length() < 1e-7);
}

#[test]
fn patches_without_area_give_no_nan() {
    let point = [[1.0, 2.0, 3.0]; 4];
    let line = [[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [3.0, 0.0, 0.0]];
    let triangle = [[0.0; 3], [0.0; 3], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
    let mut random = Random::new(24);
    for corners in [point, line, triangle] {
        let shape = patch(corners);
        let mut hits = 0;
        for _ in 0..5000 {
            let o = random.direction() * 3.0;
            let r = ray(o, DVec3::new(random.unit(), random.unit(), 0.0) - o);
            if let Some(hit) = shape.intersect(&r) {
                hits += 1;
                let s = shape.surface(&r, &hit);
                assert!(
                    s.p.is_finite() && (s.n_g.length() - 1.0).abs() < 1e-6 && s.dpdu.is_finite(),
                    "{s:?}"
                );
            }
        }
        assert_eq!(hits > 1000, corners == triangle, "{corners:?}: {hits}");
    }
}

#[test]
fn meshes_of_patches_are_checked() {
    let (ty, data) = points(&SADDLE);
    let with = |indices: &[i32]| {
        let params = Params::new().with("P", ty, data.clone());
        params.with("indices", ValueType::Integer, Data::Ints(indices.to_vec()))
    };
    assert_eq!(shape("bilinearmesh", Params::new().with("P", ty, data.clone())).bounds().min.z, -0.5);
    let Ok(Geometry::Shapes(two)) = build("bilinearmesh", with(&[0, 1, 2, 3, 3, 2, 1, 0])) else {
        panic!("two")
    };
    assert_eq!(two.len(), 2);
    assert!(build("bilinearmesh", with(&[0, 1, 2])).is_err_and(|m| m.contains("multiple of 4")));
    assert!(build("bilinearmesh", with(&[0, 1, 2, 4])).is_err_and(|m| m.contains("vertex 4")));
    assert!(build("bilinearmesh", with(&[0, 1, 2, -1])).is_err());
    let short = with(&[0, 1, 2, 3]).with("uv", ValueType::Point2, Data::Floats(vec![0.0; 4]));
    assert!(build("bilinearmesh", short).is_err_and(|m| m.contains("texture coordinates")));
    let (ty, five) = points(&[[0.0; 3]; 5]);
    assert!(build("bilinearmesh", Params::new().with("P", ty, five)).is_err_and(|m| m.contains("needs")));
}

#[test]
fn patches_without_area_are_told() {
    let told = |corners: [[f32; 3]; 4]| {
        let (kind, data) = points(&corners);
        let node = Node::new("bilinearmesh", Params::new().with("P", kind, data));
        let entry = SHAPES.iter().find(|e| e.answers_to("bilinearmesh")).expect("a registered word");
        let mut diagnostics = Diagnostics::default();
        assert!((entry.build)(&mut Args::check(&node, entry.schema, &[], &mut diagnostics)).is_some());
        diagnostics.iter().map(|d| d.message.clone()).collect::<Vec<_>>()
    };
    assert_eq!(told(SADDLE), Vec::<String>::new());
    // Two corners in one place: a triangle.
    assert_eq!(told([[0.0; 3], [0.0; 3], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]]), Vec::<String>::new());
    let said = ["no patch has an area: nothing of this shape will be seen"];
    assert_eq!(told([[0.0; 3]; 4]), said);
    assert_eq!(told([0.0, 1.0, 2.0, 3.0].map(|x| [x, 2.0 * x, 0.0])), said);
}
