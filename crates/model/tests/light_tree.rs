//! The tree of lights: chances that are frequencies, that sum to 1 and are above 0 wherever light arrives (E13).
use std::{f64::consts::PI, sync::Arc};

use durer_core::{
    glam::{DAffine3, DQuat, DVec3},
    math::{Normal3, Point3, Vector3},
    sampling::{Sampler, SamplerKind},
    spectrum::Basis,
};
use durer_model::{
    light::{AREA_LIGHTS, Area, Cone, LIGHTS, Light, LightBounds, LightCx, LightTree, Orientation, Track},
    shape::{Disk, Geometry, Patch, Sphere},
};
use durer_scene::{Args, Data, Diagnostics, Mesh, Node, Params, ValueType, find};
use durer_testkit::random::Random;

const CX: LightCx = LightCx { basis: Basis::Rgb, time: 0.5 };

fn described(kind: &str, params: Params, track: &Track) -> Box<dyn Light> {
    let mut said = Diagnostics::default();
    let node = Node::new(kind, params);
    let entry = find(LIGHTS, "light", &node, &mut said).expect("a registered light");
    let mut light = (entry.build)(&mut Args::check(&node, entry.schema, &[], &mut said)).expect("sound");
    light.place(track);
    light
}

fn area(geometry: &Geometry, params: Params, track: Track, orientation: Orientation) -> Area {
    let mut said = Diagnostics::default();
    let node = Node::new("diffuse", params);
    let mut args = Args::check(&node, AREA_LIGHTS[0].schema, &[], &mut said);
    let emission = (AREA_LIGHTS[0].build)(&mut args).expect("sound parameters");
    Area::new(&emission, geometry, track, orientation).expect("it shines")
}

/// A mesh of `columns` times `rows` times 2 triangles in the unit square, facing +z.
fn grid(columns: u32, rows: u32) -> Geometry {
    let at = |i: u32, n: u32| i as f32 / n as f32;
    let positions = (0..=rows)
        .flat_map(|y| (0..=columns).map(move |x| Point3::new(at(x, columns), at(y, rows), 0.0)))
        .collect();
    let cell = |i: u32| {
        let a = i / columns * (columns + 1) + i % columns;
        [[a, a + 1, a + columns + 2], [a, a + columns + 2, a + columns + 1]]
    };
    let indices = (0..columns * rows).flat_map(cell).collect();
    Geometry::Mesh(Arc::new(Mesh { positions, indices, ..Mesh::default() }))
}

/// Lights of all kinds that have bounds, still and moving, in a box of 10 m.
fn lights(count: usize) -> Vec<Box<dyn Light>> {
    let mut random = Random::new(21);
    let patch =
        Patch::new([[0.0, 0.0, 0.0], [1.0, 0.0, 0.3], [0.0, 1.0, 0.2], [1.0, 1.0, 0.0]].map(Point3::from));
    let shapes = [
        Geometry::shape(Disk::new(0.0, 0.5, 0.0, 360.0)),
        Geometry::shape(Sphere::new(0.3)),
        Geometry::shape(patch),
        grid(1, 1),
        grid(3, 2),
    ];
    let one = |i: usize| {
        let place = |random: &mut Random| {
            let at = DVec3::from_array([(); 3].map(|()| random.between(-5.0, 5.0)));
            DAffine3::from_rotation_translation(
                DQuat::from_axis_angle(random.direction(), random.between(0.0, PI)),
                at,
            )
        };
        let m = place(&mut random);
        let track = match i % 7 {
            0 => Track::keyed(vec![(0.0, m), (1.0, place(&mut random))]),
            1 => Track::keyed(vec![(0.0, m), (1.0, DAffine3::from_translation(DVec3::X) * m)]),
            _ => Track::still(m),
        };
        let strength = random.between(0.1, 4.0) as f32;
        let gray = |name: &str| Params::new().rgb(name, [strength; 3]);
        let light: Box<dyn Light> = match i % 9 {
            0 => described("point", gray("I"), &track),
            1 => described("spot", gray("I").float("coneangle", 20.0), &track),
            2 => described("spot", gray("I").float("coneangle", 140.0).float("conedeltaangle", 90.0), &track),
            k => {
                let params =
                    gray("L").with("twosided", ValueType::Bool, Data::Bools(vec![i.is_multiple_of(4)]));
                let side = if i.is_multiple_of(5) { Orientation::Reversed } else { Orientation::AsMade };
                Box::new(area(&shapes[k % shapes.len()], params, track, side))
            }
        };
        light
    };
    (0..count).map(one).collect()
}

fn tree_of(lights: &[Box<dyn Light>]) -> LightTree {
    let bounds: Vec<_> = lights.iter().map(|light| light.bounds().expect("a place")).collect();
    LightTree::new(bounds.into_iter()).expect("some shine")
}

/// Points with normals, inside and around the lights.
fn places(count: usize) -> Vec<(Point3, Option<Normal3>)> {
    let mut random = Random::new(5);
    let one = |i| {
        let p = random.direction() * random.between(0.0, 14.0);
        (Point3::from_f64(p), (i % 4 != 0).then(|| Normal3::from_f64(random.direction())))
    };
    (0..count).map(one).collect()
}

#[test]
fn chances_sum_to_one_and_are_above_zero_where_light_arrives() {
    let lights = lights(180);
    let tree = tree_of(&lights);
    let (mut arriving, mut all) = (0, 0.0);
    for (p, n) in places(300) {
        let chances: Vec<f64> = (0..lights.len()).map(|i| tree.chance(p, n, i)).collect();
        let sum: f64 = chances.iter().sum();
        // Less where a node promises what none of its lights keeps: then nothing is chosen.
        assert!(sum < 1.0 + 1e-9, "{p:?}: {sum}");
        all += sum / 300.0;
        for (i, light) in lights.iter().enumerate() {
            for k in 0..16 {
                let sampler = Sampler::new(SamplerKind::Sobol, i as u64, [0, 0], k, 16);
                let Some(s) = light.sample(&CX, p, &sampler) else { continue };
                // What rounding makes of grazing light is of no account.
                if n.is_none_or(|n| n.dot(s.wi) > 1e-5) {
                    arriving += 1;
                    assert!(chances[i] > 0.0, "{light:?} sends {s:?} to {p:?} {n:?}");
                }
            }
        }
    }
    assert!(arriving > 100_000 && all > 0.85, "{arriving} {all}");
}

#[test]
fn lights_are_chosen_as_often_as_their_chance_says() {
    const N: u32 = 1 << 16;
    let lights = lights(60);
    let tree = tree_of(&lights);
    for (p, n) in places(24) {
        let mut counts = vec![0.0; lights.len()];
        for i in 0..N {
            let Some(picked) = tree.choose(p, n, f64::from(i) / f64::from(N)) else { continue };
            counts[picked.index] += 1.0 / f64::from(N);
            assert!((0.0..1.0).contains(&picked.rest));
            let chance = tree.chance(p, n, picked.index);
            assert!((picked.chance / chance - 1.0).abs() < 1e-12, "{} {chance}", picked.chance);
        }
        for (i, count) in counts.iter().enumerate() {
            // Each light has one interval of the numbers.
            assert!((count - tree.chance(p, n, i)).abs() <= 1.0001 / f64::from(N), "{i}: {count}");
        }
    }
}

/// One to four lights are looked at without a tree.
#[test]
fn few_lights_are_chosen_as_their_chances_say_and_never_left_out() {
    const N: u32 = 1 << 10;
    let lights = lights(60);
    let mut arriving = 0;
    for count in 1..=4 {
        for few in lights.windows(count) {
            let tree = tree_of(few);
            for (p, n) in places(8) {
                let chances: Vec<f64> = (0..count).map(|i| tree.chance(p, n, i)).collect();
                let sum: f64 = chances.iter().sum();
                assert!(sum == 0.0 || (sum - 1.0).abs() < 1e-12, "{chances:?}");
                let mut counts = vec![0.0; count];
                for i in 0..N {
                    let Some(picked) = tree.choose(p, n, f64::from(i) / f64::from(N)) else { continue };
                    counts[picked.index] += 1.0 / f64::from(N);
                    assert!((0.0..1.0).contains(&picked.rest));
                    assert!(
                        (picked.chance / chances[picked.index] - 1.0).abs() < 1e-12,
                        "{picked:?} {chances:?}"
                    );
                }
                for (light, (count, chance)) in few.iter().zip(counts.iter().zip(&chances)) {
                    assert!((count - chance).abs() <= 1.0001 / f64::from(N), "{count} {chance}");
                    for k in 0..8 {
                        let Some(s) =
                            light.sample(&CX, p, &Sampler::new(SamplerKind::Sobol, 3, [0, 0], k, 8))
                        else {
                            continue;
                        };
                        if n.is_none_or(|n| n.dot(s.wi) > 1e-5) {
                            arriving += 1;
                            assert!(*chance > 0.0, "{light:?} sends {s:?} to {p:?} {n:?}");
                        }
                    }
                }
            }
        }
    }
    assert!(arriving > 10_000, "{arriving}");
}

#[test]
fn what_shines_to_both_sides_is_chosen_on_both() {
    let known = |both_sides| LightBounds {
        bounds: durer_core::math::Bounds3::around([Point3::new(5.0, -0.1, 0.0), Point3::new(5.0, 0.1, 0.0)]),
        normals: Cone::direction(Vector3::new(1.0, 0.0, 0.0)),
        end: std::f32::consts::FRAC_PI_2,
        both_sides,
        intensity: 1.0,
    };
    for (both_sides, behind) in [(false, 0.0), (true, 1.0)] {
        let tree = LightTree::new([known(both_sides)].into_iter()).expect("it shines");
        assert_eq!(tree.chance(Point3::new(9.0, 0.0, 0.0), None, 0), 1.0);
        assert_eq!(tree.chance(Point3::ZERO, None, 0), behind);
        assert_eq!(tree.choose(Point3::ZERO, None, 0.5).is_some(), both_sides);
    }
}

#[test]
fn what_is_dark_turned_away_or_behind_is_never_chosen() {
    let flat = |at: f32, axis: Vector3, intensity: f32| LightBounds {
        bounds: durer_core::math::Bounds3::around([Point3::new(at, -0.1, 0.0), Point3::new(at, 0.1, 0.0)]),
        normals: Cone::direction(axis),
        end: std::f32::consts::FRAC_PI_2,
        both_sides: false,
        intensity,
    };
    let (left, right) = (Vector3::new(-1.0, 0.0, 0.0), Vector3::new(1.0, 0.0, 0.0));
    let known = [flat(5.0, left, 1.0), flat(5.0, right, 9.0), flat(-5.0, right, 1.0), flat(5.0, left, 0.0)];
    let tree = LightTree::new(known.into_iter()).expect("three shine");
    let chances = |n: Option<Normal3>| [0, 1, 2, 3].map(|i| tree.chance(Point3::ZERO, n, i));
    let [to_me, away, behind, dark] = chances(None);
    assert!(to_me > 0.0 && behind > 0.0 && (to_me + behind - 1.0).abs() < 1e-9 && away + dark == 0.0);
    let [to_me, away, behind, dark] = chances(Some(right.into()));
    assert!(to_me == 1.0 && away + behind + dark == 0.0);
    assert!(tree.choose(Point3::new(6.0, 0.0, 9e9), Some(Normal3::new(0.0, 0.0, 1.0)), 0.5).is_none());
    assert!(LightTree::new([flat(0.0, left, 0.0)].into_iter()).is_none());
}

/// E13: the same lamp in one piece and in a thousand.
#[test]
fn a_thousand_triangles_give_the_light_of_one_rectangle_with_less_noise() {
    const N: u32 = 1 << 14;
    let place = || {
        Track::still(
            DAffine3::from_translation(DVec3::new(-2.0, 0.0, 0.2))
                * DAffine3::from_scale(DVec3::new(8.0, 1.0, 1.0)),
        )
    };
    let [one, many] = [grid(1, 1), grid(25, 20)]
        .map(|geometry| area(&geometry, Params::new(), place(), Orientation::AsMade));
    let moments = |light: &Area, p: Point3| {
        let sum = (0..N).fold([0.0; 2], |sum, i| {
            let sampler = Sampler::new(SamplerKind::Independent, 3, [0, 0], i, N);
            let e = light
                .sample(&CX, p, &sampler)
                .map_or(0.0, |s| f64::from(s.weight.mean() * (-s.wi.z).max(0.0)));
            [sum[0] + e, sum[1] + e * e]
        });
        let mean = sum[0] / f64::from(N);
        (mean, sum[1] / f64::from(N) - mean * mean)
    };
    for p in [Point3::new(0.0, 0.5, 1.0), Point3::new(3.0, -1.0, 2.0), Point3::new(-3.0, 0.2, 0.3)] {
        let ((a, va), (b, vb)) = (moments(&one, p), moments(&many, p));
        let sigma = ((va + vb) / f64::from(N)).sqrt();
        assert!((a - b).abs() < 4.0 * sigma, "{p:?}: {a} {b}, sigma {sigma}");
        // Sampling the rectangle by solid angle is hard to beat.
        assert!(vb < 4.0 * va, "{p:?}: variance {va} of one piece, {vb} of many");
    }
}

#[test]
fn of_ten_thousand_triangles_the_near_ones_are_asked() {
    let light = area(&grid(100, 50), Params::new(), Track::still(DAffine3::IDENTITY), Orientation::AsMade);
    // A point close to one corner asks what is near: by area it would be half of all.
    let near = (0..4096).filter(|&i| {
        let sampler = Sampler::new(SamplerKind::Sobol, 0, [0, 0], i, 4096);
        let s = light.sample(&CX, Point3::new(0.02, 0.02, 0.02), &sampler).expect("lit");
        s.point.is_some_and(|p| p.x < 0.5)
    });
    let share = near.count() as f64 / 4096.0;
    assert!(share > 0.75, "{share}");
}
