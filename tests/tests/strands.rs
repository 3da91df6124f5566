//! Curves and hair in scenes: where they are, how wide, and that white hair vanishes in an even sky.
use durer::{Options, Prepared};
use durer_tests::{render, scene};

/// A picture of 100 x 100 pixels of the square from -1 to 1 at z = 0, seen along +z; one sample in the middle of each.
fn parallel(world: &str) -> Prepared {
    let head = "Translate 0 0 5 Camera \"orthographic\"\nFilm \"rgb\" \"integer xresolution\" 100 \"integer yresolution\" 100\n\
                Sampler \"independent\" \"integer pixelsamples\" 1\nPixelFilter \"box\"\nIntegrator \"cast\" \"string show\" \"depth\"\n\
                WorldBegin\n";
    scene(&format!("{head}{world}"), &Options::default())
}

/// Middle and width of what is met in the row at height `y`, in metres; NaN where nothing is.
fn row(prepared: &Prepared, y: f64) -> [f64; 2] {
    let film = render(prepared).film;
    let row = ((1.0 - y) * 50.0) as u32;
    let met = (0..100).filter(|&x| film.pixel(x, row).is_some_and(|p| p.weight > 0.0));
    let at: Vec<f64> = met.map(|x| (f64::from(x) + 0.5) / 50.0 - 1.0).collect();
    [at.iter().sum::<f64>() / at.len() as f64, at.len() as f64 * 0.02]
}

#[test]
fn curves_are_where_their_bases_say_and_as_wide() {
    // A parabola x = y² from y = -0.8 to 0.8: as Bezier and B-spline of both degrees, by hand.
    let a = 0.8f64;
    let cubic = format!(
        "[ {} {} 0  {} {} 0  {} {} 0  {} {} 0 ]",
        a * a,
        -a,
        -a * a / 3.0,
        -a / 3.0,
        -a * a / 3.0,
        a / 3.0,
        a * a,
        a
    );
    let quadratic = format!("[ {} {} 0  {} 0 0  {} {} 0 ]", a * a, -a, -a * a, a * a, a);
    // The quadratic spline's knots are the middles of its control points: polar forms of y² at (t, t + 1).
    let spline: Vec<String> = (-2..=2)
        .map(|k| {
            let (s, t) = (f64::from(k) * 0.4 - 0.2, f64::from(k) * 0.4 + 0.2);
            format!("{} {} 0", s * t, (s + t) / 2.0)
        })
        .collect();
    let quadratic_spline = format!("[ {} ]", spline.join("  "));
    let polar: Vec<String> = (-3..=3)
        .map(|k| {
            let knots = [f64::from(k) * 0.4 - 0.4, f64::from(k) * 0.4, f64::from(k) * 0.4 + 0.4];
            let [r, s, t] = knots;
            format!("{} {} 0", (r * s + s * t + t * r) / 3.0, s)
        })
        .collect();
    let cubic_spline = format!("[ {} ]", polar.join("  "));
    for (points, basis, degree) in [
        (&cubic, "bezier", 3),
        (&quadratic, "bezier", 2),
        (&quadratic_spline, "bspline", 2),
        (&cubic_spline, "bspline", 3),
    ] {
        for form in ["flat", "cylinder", "ribbon"] {
            let segments = match (basis, degree) {
                ("bspline", 2) => 3,
                ("bspline", _) => 4,
                _ => 1,
            };
            let normals = if form == "ribbon" {
                format!("\"normal N\" [ {} ]", "0 0 -1 ".repeat(segments + 1))
            } else {
                String::new()
            };
            let shape = format!(
                "Shape \"curve\" \"point3 P\" {points} \"string basis\" \"{basis}\" \"integer degree\" {degree} \
                 \"string type\" \"{form}\" \"float width\" 0.1 {normals}"
            );
            let prepared = parallel(&shape);
            for y in [-0.39, -0.01, 0.31, 0.51] {
                let [middle, width] = row(&prepared, y);
                // Rows cross the strand at an angle: wider by 1 / cos.
                let expected = 0.1 * (1.0 + 4.0 * y * y).sqrt();
                assert!((middle - y * y).abs() < 0.02, "{basis} {degree} {form} {y}: {middle}");
                assert!(
                    (width - expected).abs() < 0.031,
                    "{basis} {degree} {form} {y}: {width}, expected {expected}"
                );
            }
        }
    }
}

#[test]
fn placed_curves_are_the_same_as_moved_and_instanced_ones() {
    let strand = "Shape \"curve\" \"point3 P\" [ 0 -0.5 0  0.1 -0.2 0  -0.1 0.2 0  0 0.5 0 ] \"float width0\" 0.2 \"float width1\" 0.05";
    let of = |world: &str| {
        let prepared = parallel(world);
        [-0.6, -0.2, 0.0, 0.3, 0.7].map(|y| row(&prepared, y).map(|v| (v * 1e6).round()))
    };
    let placed = of(&format!("Scale 1.5 1.5 1.5 Translate 0.2 0 0 {strand}"));
    let instanced = of(&format!(
        "ObjectBegin \"s\" {strand} ObjectEnd\nScale 1.5 1.5 1.5 Translate 0.2 0 0 ObjectInstance \"s\" Translate 9 0 0 ObjectInstance \"s\""
    ));
    assert_eq!(placed.map(|r| r.map(f64::to_bits)), instanced.map(|r| r.map(f64::to_bits)));
    assert!(placed[2][1] > 1e5, "{placed:?}");
}

#[test]
fn white_hair_vanishes_in_an_even_sky() {
    let mut world = String::from(
        "LightSource \"infinite\" \"rgb L\" [1 1 1]\nMaterial \"hair\" \"rgb sigma_a\" [0 0 0] \"float beta_m\" 0.4\n",
    );
    for i in 0..40 {
        let (x, z) = (f64::from(i % 8) * 0.12 - 0.42, f64::from(i / 8) * 0.15);
        world += &format!(
            "Shape \"curve\" \"point3 P\" [ {x} -0.9 {z}  {} -0.3 {z}  {} 0.3 {z}  {x} 0.9 {z} ] \"float width\" 0.08\n",
            x + 0.2,
            x - 0.2
        );
    }
    let head = "Translate 0 0 5 Camera \"orthographic\"\nFilm \"rgb\" \"integer xresolution\" 12 \"integer yresolution\" 12\n\
                Sampler \"sobol\" \"integer pixelsamples\" 256\nPixelFilter \"box\"\nIntegrator \"path\" \"integer maxdepth\" 300\nWorldBegin\n";
    let film = render(&scene(&format!("{head}{world}"), &Options::default())).film;
    let mut sum = 0.0;
    for p in film.pixels() {
        let v = p.mean()[1];
        assert!((v - 1.0).abs() < 0.06, "{v}");
        sum += f64::from(v) / 144.0;
    }
    assert!((sum - 1.0).abs() < 4e-3, "{sum}");
}

#[test]
fn wrong_curves_are_refused_with_what_was_expected() {
    let said = |shape: &str| {
        let mut imported = durer_tests::import(&format!("WorldBegin\n{shape}"));
        assert!(durer::prepare(&mut imported, &Options::default()).is_none(), "{shape}");
        imported.diagnostics.iter().map(|d| d.message.clone()).collect::<Vec<_>>().join("; ")
    };
    for (shape, expected) in [
        (
            "Shape \"curve\" \"point3 P\" [ 0 0 0  1 0 0  2 0 0 ]",
            "\"P\" has 3 points, expected 4 and then 3 for each further segment",
        ),
        (
            "Shape \"curve\" \"point3 P\" [ 0 0 0  1 0 0 ] \"string basis\" \"bspline\" \"integer degree\" 2",
            "\"P\" has 2 points, expected 3 or more",
        ),
        (
            "Shape \"curve\" \"point3 P\" [ 0 0 0  1 0 0  2 0 0  3 0 0 ] \"string type\" \"ribbon\"",
            "\"N\" has 0 normals, expected 2",
        ),
        (
            "Shape \"curve\" \"point3 P\" [ 0 0 0  1 0 0  2 0 0  3 0 0 ] \"integer degree\" 4",
            "\"degree\" is 4",
        ),
        (
            "AreaLightSource \"diffuse\" Shape \"curve\" \"point3 P\" [ 0 0 0  1 0 0  2 0 0  3 0 0 ]",
            "a curve cannot be an area light",
        ),
    ] {
        assert!(said(shape).contains(expected), "{}", said(shape));
    }
}
