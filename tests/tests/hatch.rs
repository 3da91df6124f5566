//! Hatching: strokes lie in the shade, on surfaces, apart from each other, and bend with the form.
use durer::{
    draw::{DVec2, Kind, Line, Machine, Tones, hatch},
    glam::DVec3,
};
use durer_tests::look::Look;

const LOOK: Look = Look { eye: DVec3::new(1.3, 1.9, -4.0), size: [240, 180] };
const SPACING: f64 = 5.0;
/// The planes of the first layer have this normal: right, up and ahead of the camera.
const PLANES: [f64; 3] = [0.55, 0.75, 0.35];

/// A picture that is of middle brightness on the left, bright on the right, and black in a strip below.
fn tones() -> Tones {
    let [w, h] = LOOK.size;
    let grey = |x: u32, y: u32| {
        if y >= h - 12 {
            0.0
        } else if x < w / 2 {
            0.25
        } else {
            1.0
        }
    };
    let pixels: Vec<[f32; 3]> = (0..h).flat_map(|y| (0..w).map(move |x| [grey(x, y); 3])).collect();
    Tones::new(LOOK.size, &pixels).expect("as many as pixels")
}

fn strokes(world: &str) -> Vec<Line> {
    let scene = LOOK.scene(world);
    hatch(&scene.scene, &Machine::default(), &tones(), SPACING, &Default::default()).expect("nobody cancels")
}

/// Where the ray through a point of the picture meets the sphere of the radius 1 at the origin.
fn on_sphere(at: DVec2) -> Option<DVec3> {
    let (o, d) = (LOOK.eye, LOOK.ray(at));
    let b = o.dot(d);
    let root = b * b - o.length_squared() + 1.0;
    (root >= 0.0).then(|| o + d * (-b - root.sqrt()))
}

#[test]
fn strokes_lie_in_the_shade_on_the_ball_in_parallel_planes() {
    let strokes = strokes("Shape \"sphere\"");
    assert!(strokes.len() > 10, "{}", strokes.len());
    let [right, up, ahead] = LOOK.axes();
    let normal = (right * PLANES[0] + up * PLANES[1] + ahead * PLANES[2]).normalize();
    for stroke in &strokes {
        assert!(stroke.kind == Kind::Hatch && !stroke.closed);
        let heights: Vec<f64> = stroke
            .points(8)
            .iter()
            .map(|at| {
                // Tones are blurred by two pixels.
                assert!(at.x < 123.0, "{at} is bright");
                on_sphere(*at).unwrap_or_else(|| panic!("{at} is beside the ball")).dot(normal)
            })
            .collect();
        let [low, high] = heights.iter().fold([f64::MAX, f64::MIN], |m, &v| [m[0].min(v), m[1].max(v)]);
        assert!(high - low < 0.05, "a stroke leaves its plane by {}", high - low);
    }
}

#[test]
fn strokes_keep_apart_and_leave_no_gaps() {
    // A wall that fills the picture.
    let strokes = strokes("Shape \"polygon\" \"point3 P\" [-9 -9 0  9 -9 0  9 9 0  -9 9 0]");
    // Below two other layers cross.
    let high: Vec<Vec<DVec2>> =
        strokes.iter().map(|s| s.points(16)).filter(|s| s.iter().all(|p| p.y < 160.0)).collect();
    for (i, a) in high.iter().enumerate() {
        for b in &high[i + 1..] {
            let nearest =
                a.iter().flat_map(|p| b.iter().map(move |q| p.distance(*q))).fold(f64::MAX, f64::min);
            assert!(nearest > 0.5 * SPACING, "{nearest}: {} {}", a[0], b[0]);
        }
    }
    let all: Vec<DVec2> = strokes.iter().flat_map(|s| s.points(16)).collect();
    for y in 1..16 {
        for x in 1..11 {
            let at = DVec2::new(f64::from(x), f64::from(y)) * 10.0;
            let nearest = all.iter().map(|p| p.distance(at)).fold(f64::MAX, f64::min);
            assert!(nearest < 2.5 * SPACING, "no stroke near {at}: {nearest}");
        }
    }
    assert!(all.iter().all(|p| p.x < 123.0 || p.y > 163.0));
}

#[test]
fn tones_need_a_picture() {
    assert_eq!(Tones::new([2, 2], &[[0.5; 3]; 3]), None);
    assert_eq!(Tones::new([0, 0], &[]), None);
}
