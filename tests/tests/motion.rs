//! Motion blur: closed forms, and slices of time that add up to the blurred picture.
use durer::{Options, Prepared, Rendered, Show, math::Interval};
use durer_tests::{bits, render, scene};

fn cast(options: Options) -> Options {
    Options { integrator: Some("cast".into()), show: Some(Show::Albedo), ..options }
}

fn values(rendered: &Rendered) -> Vec<f64> {
    rendered.film.pixels().iter().map(|p| f64::from(p.mean()[0])).collect()
}

/// A white bar, `w` pixels wide, that moves right by `v` in the second that the shutter is open.
fn bar(w: f64, v: f64, shutter: &str) -> Prepared {
    let text = format!(
        "Film \"rgb\" \"integer xresolution\" 64 \"integer yresolution\" 3\n\
         Sampler \"stratified\" \"integer xsamples\" 20 \"integer ysamples\" 20 PixelFilter \"box\"\n\
         Camera \"orthographic\" \"float screenwindow\" [0 64 0 3] {shutter}\nWorldBegin\n\
         Material \"diffuse\" \"rgb reflectance\" [1 1 1]\n\
         TransformKeys \"float times\" [0 1] \"point3 translate\" [10 0 0  {to} 0 0]\n\
         Shape \"polygon\" \"point3 P\" [0 -1 1  {w} -1 1  {w} 9 1  0 9 1]\n",
        to = 10.0 + v
    );
    scene(&text, &cast(Options::default()))
}

#[test]
fn a_moving_bar_becomes_a_trapezoid_f6() {
    for (w, v) in [(8.0f64, 24.0), (20.0, 10.0), (16.0, 14.0)] {
        let all = values(&render(&bar(w, v, "")));
        // The share of the second that x is covered in: min(1, w / v) high, with ramps of min(w, v).
        let covered = |x: f64| {
            let (enters, leaves) = ((x - 10.0 - w) / v, (x - 10.0) / v);
            (leaves.clamp(0.0, 1.0) - enters.clamp(0.0, 1.0)).max(0.0)
        };
        for (x, value) in all.iter().take(64).enumerate() {
            let expected =
                (0..100).map(|i| covered(x as f64 + (f64::from(i) + 0.5) / 100.0)).sum::<f64>() / 100.0;
            assert!((value - expected).abs() < 0.02, "{w} {v}: pixel {x}: {value}, expected {expected}");
        }
        let (highest, total) = (all.iter().fold(0.0, |m: f64, v| m.max(*v)), all.iter().sum::<f64>() / 3.0);
        assert!((highest - (w / v).min(1.0)).abs() < 0.02, "{w} {v}: {highest}");
        assert!((total - w).abs() < 0.05, "{w} {v}: {total}");
    }
}

#[test]
fn a_shutter_curve_is_convolved_with_the_bar_f6() {
    let (w, v) = (6.0, 30.0);
    let all = values(&render(&bar(w, v, "\"float shuttercurve\" [0 1 0]")));
    // The share of a tent's area before t.
    let before = |t: f64| {
        let t = t.clamp(0.0, 1.0);
        if t < 0.5 { 2.0 * t * t } else { 1.0 - 2.0 * (1.0 - t) * (1.0 - t) }
    };
    for (x, value) in all.iter().take(64).enumerate() {
        let covered = |x: f64| before((x - 10.0) / v) - before((x - 10.0 - w) / v);
        let expected =
            (0..100).map(|i| covered(x as f64 + (f64::from(i) + 0.5) / 100.0)).sum::<f64>() / 100.0;
        assert!((value - expected).abs() < 0.02, "pixel {x}: {value}, expected {expected}");
    }
}

const HEAD: &str = "Film \"rgb\" \"integer xresolution\" 40 \"integer yresolution\" 40\n\
    Sampler \"sobol\" \"integer pixelsamples\" 64 PixelFilter \"box\"\n\
    Camera \"orthographic\" \"float screenwindow\" [-2 2 -2 2]\n";

/// A blade that turns by 350 degrees and grows; the picture of a fan.
const TURNING: &str = "WorldBegin\nMaterial \"diffuse\" \"rgb reflectance\" [1 1 1]\n\
    TransformKeys \"float times\" [0 1] \"float rotate\" [20 0 0 1  370 0 0 1] \"vector3 scale\" [1 1 1  1.5 1.5 1]\n\
    Shape \"polygon\" \"point3 P\" [0 -.2 1  1.2 -.2 1  1.2 .2 1  0 .2 1]\n";

/// A square whose corners go their own ways, by three keys.
const DEFORMING: &str = "WorldBegin\nMaterial \"diffuse\" \"rgb reflectance\" [1 1 1]\n\
    Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"float times\" [0 .3 1]\n\
    \"point3 P\" [-1 -1 1  0 -1 1  0 0 1  -1 0 1]\n\
    \"point3 P1\" [-1.5 -1 1  1 -1.5 1  1 1 1  -1 .5 1]\n\
    \"point3 P2\" [0 0 1  1.5 0 1  1 1.5 1  .5 1 1]\n";

/// The mean of pictures at single moments in the middles of `n` slices of the interval.
fn sliced(text: &str, n: u32, interval: Interval) -> Vec<f64> {
    let mut sum = vec![0.0; 1600];
    for i in 0..n {
        let time = interval.at((i as f32 + 0.5) / n as f32);
        let options = Options {
            time,
            shutter: Some(Interval::point(0.0)),
            samples: Some(6),
            seed: Some(i.into()),
            ..Options::default()
        };
        let slice = values(&render(&scene(text, &cast(options))));
        sum.iter_mut().zip(slice).for_each(|(s, v)| *s += v / f64::from(n));
    }
    sum
}

fn rms(a: &[f64], b: &[f64]) -> f64 {
    (a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>() / a.len() as f64).sqrt()
}

#[test]
fn slices_of_time_add_up_to_the_blurred_picture_f8() {
    for (what, text) in [("turning", TURNING), ("deforming", DEFORMING)] {
        let text = format!("{HEAD}{text}");
        let blurred = values(&render(&scene(&text, &cast(Options::default()))));
        let slices = sliced(&text, 40, Interval::new(0.0, 1.0));
        let (light, expected) = (blurred.iter().sum::<f64>(), slices.iter().sum::<f64>());
        assert!((light / expected - 1.0).abs() < 0.01, "{what}: {light}, expected {expected}");
        // Noise of 64 samples and of 40 slices; another motion is five times as far.
        let off = rms(&blurred, &slices);
        assert!(off < 0.03, "{what}: {off}");
        let other = sliced(&text, 8, Interval::new(0.0, 0.2));
        assert!(rms(&blurred, &other) > 5.0 * off, "{what}");
    }
}

#[test]
fn a_turn_of_350_degrees_goes_the_long_way() {
    let at = |time: f32| {
        let options =
            Options { time, shutter: Some(Interval::point(0.0)), samples: Some(1), ..Options::default() };
        values(&render(&scene(&format!("{HEAD}{TURNING}"), &cast(options))))
    };
    // At half time the blade points 195 degrees from +x, not 15.
    let half = at(0.5);
    let lit = |degrees: f64| {
        let (x, y) = (degrees.to_radians().cos(), degrees.to_radians().sin());
        half[((2.0 - y) * 10.0) as usize * 40 + ((2.0 + x) * 10.0) as usize] > 0.0
    };
    assert!(lit(195.0) && !lit(15.0) && !lit(105.0));
}

#[test]
fn rows_of_a_rolling_shutter_are_stills_at_their_times_f8() {
    let rolling =
        format!("{HEAD}{TURNING}").replace("[-2 2 -2 2]", "[-2 2 -2 2] \"float rollingshutter\" 0.5");
    let instant = |time: f32, text: &str| {
        let options =
            Options { time, shutter: Some(Interval::point(0.0)), samples: Some(4), ..Options::default() };
        bits(&render(&scene(text, &cast(options))))
    };
    let picture = instant(0.25, &rolling);
    let mut differing = 0;
    for row in 0..40usize {
        let time = 0.25 + (row as f32 + 0.5) / 40.0 * 0.5;
        let still = instant(time, &format!("{HEAD}{TURNING}"));
        let of = |picture: &[[u32; 3]]| picture[row * 40..row * 40 + 40].to_vec();
        assert!(of(&picture) == of(&still), "row {row}");
        differing += u32::from(of(&picture) != of(&instant(0.25, &format!("{HEAD}{TURNING}"))));
    }
    assert!(differing > 8, "the rows show different moments: {differing}");
}

#[test]
fn a_moving_camera_sees_what_a_still_one_sees_of_things_that_move_the_other_way() {
    let keys = "TransformKeys \"float times\" [0 .5 1] \"point3 translate\" [0 0 0  .4 -.2 .5  .1 .3 .2]\n\
                \"float rotate\" [0 0 1 0  30 0 1 0  50 0 1 0]\n";
    let world = "Translate .2 -.1 4 Shape \"sphere\" \"float radius\" .6 Translate 1 .8 1\n\
                 Material \"diffuse\" \"rgb reflectance\" [.2 .2 .2] Shape \"sphere\" \"float radius\" .9\n";
    let head = "Film \"rgb\" \"integer xresolution\" 40 \"integer yresolution\" 40 PixelFilter \"box\"\n\
                Sampler \"sobol\" \"integer pixelsamples\" 32\n";
    let camera = "Camera \"perspective\" \"float fov\" 70\nWorldBegin\n";
    let picture = |text: String| values(&render(&scene(&text, &cast(Options::default()))));
    let by_camera = picture(format!("{head}{keys}{camera}{world}"));
    let by_things = picture(format!("{head}{camera}{keys}{world}"));
    let still = picture(format!("{head}{camera}{world}"));
    // The inverse of a matrix between two keys is not quite the matrix between the inverses: samples at edges differ.
    assert!(rms(&by_camera, &by_things) < 0.01, "{}", rms(&by_camera, &by_things));
    assert!(rms(&by_camera, &still) > 0.05, "{}", rms(&by_camera, &still));
}
