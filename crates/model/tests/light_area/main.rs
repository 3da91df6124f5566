//! Area lights: densities that integrate to 1, samples that follow them, irradiance in closed form.
mod lamps;
mod particles;

use std::{
    f64::consts::{PI, TAU},
    sync::Arc,
};

use durer_core::{
    glam::{DAffine3, DQuat, DVec3},
    math::{Normal3, Point3, Vector3},
};
use durer_model::{
    light::{Area, Light, LightHit, LightSample, Orientation},
    shape::{Disk, Geometry, Plane, Shape, Sphere},
};
use durer_scene::{Data, Mesh, Params, ValueType};
use durer_testkit::{quadrature, random::Random};

use lamps::*;

/// Cells of the grid of directions: its edge, and how many of them a lamp must fill to be measured by it.
const GRID: usize = 180;
const FILLED: u32 = 2600;

/// Where a lamp that is seen under a slant has directions of nearly no width, densities have no bound. So it is asked how
/// much of all light lies where they are below a bound, of the density and of the samples.
#[test]
fn densities_integrate_to_one_over_all_directions() {
    const N: u32 = 4096;
    let mut measured = 0;
    for lamp in &lamps() {
        let light = shines(two_sided(), lamp);
        for eye in EYES {
            let from = Point3::from_f64(eye);
            let mut sampled: Vec<f32> = (0..N).filter_map(|i| sample(&light, eye, i, N)?.pdf).collect();
            sampled.sort_by(f32::total_cmp);
            let bound = 4.0 * sampled[sampled.len() / 2];
            let expected = sampled.partition_point(|pdf| *pdf < bound) as f64 / f64::from(N);
            let mut filled = 0;
            let integral = quadrature::sphere(GRID, |d| {
                let densities = hits(lamp, eye, d).into_iter().map(|hit| light.pdf(&CX, from, &hit));
                let sum: f32 = densities.filter(|pdf| *pdf < bound).sum();
                filled += u32::from(sum > 0.0);
                sum.into()
            });
            if filled < FILLED {
                continue;
            }
            measured += 1;
            let Lamp { name, geometry, .. } = lamp;
            // Cells at the edge count whole or not at all.
            assert!((integral - expected).abs() < 0.03, "{name} {eye} {integral} {expected} {geometry:?}");
        }
    }
    assert!(measured > 40, "{measured}");
}

#[test]
fn samples_follow_their_density_and_give_the_irradiance_of_uniform_directions() {
    const N: u32 = 4096;
    let moments: [fn(DVec3) -> f64; 5] =
        [|_| 1.0, |d| d.z.max(0.0), |d| (-d.z).max(0.0), |d| d.x.max(0.0), |d| d.y * d.y];
    for lamp in &lamps() {
        let light = shines(two_sided(), lamp);
        for eye in EYES {
            let mut by_light = [0.0; 5];
            for s in (0..N).filter_map(|i| sample(&light, eye, i, N)) {
                let wi = s.wi.to_f64();
                let (pdf, weight) = (f64::from(s.pdf.expect("extended")), f64::from(s.weight.mean()));
                assert!((pdf * weight - 1.0).abs() < 1e-5);
                (0..5).for_each(|k| by_light[k] += moments[k](wi) * weight / f64::from(N));
            }
            let mut by_direction = [0.0; 5];
            let mut filled = 0;
            quadrature::sphere(GRID, |d| {
                let may = |hit: &&LightHit| light.pdf(&CX, Point3::from_f64(eye), hit) > 0.0;
                let seen = hits(lamp, eye, d).iter().filter(may).count() as f64;
                filled += u32::from(seen > 0.0);
                (0..5)
                    .for_each(|k| by_direction[k] += seen * moments[k](d) * 2.0 * TAU / (GRID * GRID) as f64);
                0.0
            });
            for k in (0..5).filter(|_| filled >= FILLED) {
                let Lamp { name, geometry, .. } = lamp;
                let (got, expected) = (by_light[k], by_direction[k]);
                let tolerance = 0.02 * expected + 0.01 * by_direction[0];
                assert!(
                    (got - expected).abs() < tolerance,
                    "{name} {eye} moment {k}: {got} {expected} {geometry:?}"
                );
            }
        }
    }
}

#[test]
fn the_density_of_a_sampled_point_is_that_of_its_sample() {
    for lamp in &lamps() {
        let light = shines(two_sided(), lamp);
        for (eye, i) in EYES.into_iter().flat_map(|eye| (0..64).map(move |i| (eye, i))) {
            let Some(s) = sample(&light, eye, i, 64) else { continue };
            let towards = s.point.expect("a point").to_f64() - eye;
            let off = |hit: &LightHit| (hit.p.to_f64() - eye - towards).length();
            let all = hits(lamp, eye, s.wi.to_f64());
            // Rounding may push the direction off the edge of the lamp.
            let Some(hit) = all.iter().min_by(|a, b| off(a).total_cmp(&off(b))) else { continue };
            if off(hit) > 1e-3 {
                continue;
            }
            let (pdf, expected) = (light.pdf(&CX, Point3::from_f64(eye), hit), s.pdf.expect("extended"));
            // Rounding of the point counts for more the more edge on the lamp is seen.
            let tolerance = 5e-4 * (1.0 + 1.0 / hit.n.dot(s.wi).abs());
            assert!((pdf / expected - 1.0).abs() < tolerance, "{} {eye}: {pdf} {expected}", lamp.name);
        }
    }
}

/// Irradiance at `p` on a surface facing unit `n`, from `count` samples.
fn irradiance(light: &Area, p: DVec3, n: DVec3, count: u32) -> f64 {
    let one = |s: LightSample| f64::from(s.weight.mean()) * s.wi.to_f64().dot(n).max(0.0);
    (0..count).filter_map(|i| sample(light, p, i, count)).map(one).sum::<f64>() / f64::from(count)
}

/// Lambert's formula (1760) for a polygon all of which is above the horizon, unit radiance.
fn lambert(corners: &[DVec3], p: DVec3, n: DVec3) -> f64 {
    let rays: Vec<DVec3> = corners.iter().map(|c| (*c - p).normalize()).collect();
    let edge = |i: usize| {
        let (a, b) = (rays[i], rays[(i + 1) % rays.len()]);
        a.angle_between(b) * a.cross(b).normalize().dot(n)
    };
    (0.5 * (0..rays.len()).map(edge).sum::<f64>()).abs()
}

#[test]
fn a_disk_on_the_axis_gives_e9_and_a_square_gives_e10() {
    let up = DAffine3::from_rotation_x(PI);
    let at = |height: f64| DAffine3::from_translation(DVec3::Z * height) * up;
    let disk = lamp("disk", Geometry::shape(Disk::new(0.0, 1.0, 0.0, 360.0)), at(2.0));
    let got = irradiance(&shines(Params::new(), &disk), DVec3::ZERO, DVec3::Z, 4096);
    assert!((got - 0.628_319).abs() < 2e-5, "E9: {got}");

    let half = DAffine3::from_scale(DVec3::splat(0.5));
    let squares = [
        polygon(&[&SQUARE]),
        mesh(&SQUARE, &[[0, 1, 2], [0, 2, 3]]),
        mesh(&SQUARE, &[[2, 3, 0], [1, 2, 0]]),
        patch([SQUARE[0], SQUARE[1], SQUARE[3], SQUARE[2]]),
    ];
    for geometry in squares {
        let square = lamp("square", geometry, at(1.0) * half);
        let light = shines(Params::new(), &square);
        let got = irradiance(&light, DVec3::ZERO, DVec3::Z, 4096);
        assert!((got - 0.752_275).abs() < 2e-5, "E10: {got} {:?}", square.geometry);
        // Uniform in solid angle: a rectangle's samples all weigh the same, whatever it is made of.
        let weight = |i| sample(&light, DVec3::ZERO, i, 64).expect("lit").weight.mean();
        assert!((1..64).all(|i| weight(i) == weight(0)), "{:?}", square.geometry);
    }
    let corners = SQUARE.map(|c| DVec3::new(0.5 * f64::from(c[0]), 0.5 * f64::from(c[1]), 1.0));
    assert!((lambert(&corners, DVec3::ZERO, DVec3::Z) - 0.752_275).abs() < 1e-6);
}

#[test]
fn rectangles_and_triangles_anywhere_give_lamberts_formula() {
    let mut random = Random::new(3);
    let mut tried = 0;
    while tried < 60 {
        let turn = DQuat::from_axis_angle(random.direction(), random.between(0.0, TAU));
        let far = DVec3::new(random.between(-2.0, 2.0), random.between(-2.0, 2.0), random.between(1.5, 4.0));
        let size = DVec3::new(random.between(0.2, 2.0), random.between(0.2, 2.0), 1.0);
        let place = DAffine3::from_scale_rotation_translation(size, turn, far);
        let three = tried % 2 == 0;
        let corners: Vec<DVec3> = SQUARE
            .iter()
            .take(if three { 3 } else { 4 })
            .map(|c| place.transform_point3(Point3::from(*c).to_f64()))
            .collect();
        if corners.iter().any(|c| c.z < 0.05) {
            continue;
        }
        tried += 1;
        let geometry = if three { mesh(&SQUARE, &[[0, 1, 2]]) } else { polygon(&[&SQUARE]) };
        let light = shines(two_sided(), &lamp("anywhere", geometry, place));
        let (got, expected) =
            (irradiance(&light, DVec3::ZERO, DVec3::Z, 1024), lambert(&corners, DVec3::ZERO, DVec3::Z));
        // The integrand is a smooth cosine: a net of n points is off by less than 1/n of its range, often far less.
        assert!((got - expected).abs() < 2e-3 * expected + 1e-5, "{tried}: {got} {expected}");
    }
}

#[test]
fn spheres_near_and_far_give_pi_sin_squared() {
    for (distance, radius) in [(1.001, 1.0), (2.0, 1.0), (1e3, 1.0), (1e6, 1.0), (3e-3, 1e-3)] {
        let place = DAffine3::from_translation(DVec3::Z * distance);
        let light = shines(Params::new(), &lamp("sphere", Geometry::shape(Sphere::new(radius)), place));
        let sin2 = (f64::from(radius) / distance).powi(2);
        let got = irradiance(&light, DVec3::ZERO, DVec3::Z, 1024);
        assert!((got / (PI * sin2) - 1.0).abs() < 1e-4, "{distance}: {got}");
    }
}

#[test]
fn only_the_outside_shines_unless_both_do() {
    let disk = lamp("disk", Geometry::shape(Disk::new(0.0, 1.0, 0.0, 360.0)), DAffine3::IDENTITY);
    let mirrored = Lamp { place: DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0)), ..square() };
    for lamp in [disk, square(), mirrored] {
        let lit = |light: &Area| [1.0, -1.0].map(|z| sample(light, DVec3::Z * z, 0, 1).is_some());
        assert_eq!(lit(&shines(Params::new(), &lamp)), [true, false]);
        assert_eq!(lit(&area(Params::new(), &lamp, Orientation::Reversed).expect("finite")), [false, true]);
        assert_eq!(lit(&shines(two_sided(), &lamp)), [true, true]);
    }
    let turned = Mesh {
        positions: points(&SQUARE),
        indices: vec![[0, 1, 2], [0, 2, 3]],
        normals: vec![Normal3::new(0.0, 0.0, -1.0); 4],
        ..Mesh::default()
    };
    let turned = lamp("vertex normals", Geometry::Mesh(Arc::new(turned)), DAffine3::IDENTITY);
    let light = shines(Params::new(), &turned);
    assert!(sample(&light, DVec3::Z, 0, 1).is_none() && sample(&light, -DVec3::Z, 0, 1).is_some());
}

fn square() -> Lamp {
    lamp("square", mesh(&SQUARE, &[[0, 1, 2], [0, 2, 3]]), DAffine3::IDENTITY)
}

#[test]
fn power_is_what_leaves_the_surface() {
    // Far away on the axis a flat light of power P has E = P / (pi d²), a sphere P / (4 pi d²).
    let far = DVec3::Z * 1e4;
    let of = |params: Params, geometry: Geometry, place: DAffine3| {
        irradiance(&shines(params, &lamp("power", geometry, place)), far, -DVec3::Z, 4096) * 1e8
    };
    let power = || Params::new().float("power", 12.0).rgb("L", [0.2, 0.2, 0.2]);
    let flat = [
        Geometry::shape(Disk::new(0.0, 1.0, 0.5, 90.0)),
        mesh(&SQUARE, &[[0, 1, 2], [0, 2, 3]]),
        polygon(&[&SQUARE, &HOLE]),
    ];
    for geometry in flat {
        let stretch = DAffine3::from_scale(DVec3::new(3.0, 0.5, 2.0));
        let got = of(power(), geometry.clone(), stretch);
        assert!((got / (12.0 / PI) - 1.0).abs() < 1e-3, "{got}");
        let both = power().with("twosided", ValueType::Bool, Data::Bools(vec![true])).float("scale", 2.0);
        assert!((of(both, geometry, stretch) / (12.0 / PI) - 1.0).abs() < 1e-3);
    }
    let got = of(power(), Geometry::shape(Sphere::new(2.0)), DAffine3::from_scale(DVec3::splat(3.0)));
    assert!((got / (12.0 / (4.0 * PI)) - 1.0).abs() < 1e-3, "{got}");
    // An ellipsoid of half axes 1, 1, 2: its area is 2 pi (1 + 2 asin(e) / e), e² = 3/4; its silhouette from the tip a circle.
    let e = 0.75f64.sqrt();
    let expected = 12.0 / (PI * TAU * (1.0 + 2.0 * e.asin() / e)) * PI;
    let got = of(power(), Geometry::shape(Sphere::new(1.0)), DAffine3::from_scale(DVec3::new(1.0, 1.0, 2.0)));
    assert!((got / expected - 1.0).abs() < 5e-3, "{got} {expected}");
}

#[test]
fn what_cannot_shine_says_so() {
    let plane = Plane::new(Point3::ZERO, Vector3::new(0.0, 1.0, 0.0), 1.0);
    let plane = lamp("plane", Geometry::Shapes(vec![Arc::new(plane) as Arc<dyn Shape>]), DAffine3::IDENTITY);
    let error = |lamp: &Lamp| area(Params::new(), lamp, Orientation::AsMade).expect_err("no light");
    assert!(error(&plane).contains("without end"));
    let flat = mesh(&[[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]], &[[0, 1, 2]]);
    assert!(error(&lamp("line", flat, DAffine3::IDENTITY)).contains("no area"));
}

#[test]
fn strata_of_the_random_numbers_are_strata_of_the_light() {
    // 16 triangles in a row, so far away that they count alike: every one gets its share of a net of 256 points.
    let positions: Vec<[f32; 3]> =
        (0..=16).flat_map(|i| [[i as f32, 0.0, 0.0], [i as f32, 1.0, 0.0]]).collect();
    let indices: Vec<[u32; 3]> = (0..16).map(|i| [2 * i, 2 * i + 2, 2 * i + 1]).collect();
    let light = shines(two_sided(), &lamp("row", mesh(&positions, &indices), DAffine3::IDENTITY));
    let mut counts = [0; 16];
    for i in 0..256 {
        let point = sample(&light, DVec3::new(8.0, 0.5, 2000.0), i, 256).expect("lit").point.expect("near");
        counts[point.x as usize] += 1;
    }
    assert_eq!(counts, [16; 16]);
}
