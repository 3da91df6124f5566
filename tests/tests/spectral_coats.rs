//! Coats and panes whose index changes with wavelength: the colours that closed forms have, of each wavelength alone.
use durer::{
    Options,
    spectrum::{Basis, Carried, Color, Curve},
};
use durer_testkit::interface::fresnel_mean;
use durer_tests::{render, scene};

/// Far more than any glass has, so that colours tell: the index at a wavelength, and as a file has it.
const INDEX: &str = "[400 2.4 700 1.2]";

fn index(nm: f64) -> f64 {
    let share = ((nm - 400.0) / 300.0).clamp(0.0, 1.0);
    2.4 - 1.2 * share
}

/// At helium's yellow line, which colours without wavelengths take.
const YELLOW: f64 = 587.6;

/// The colour of a share of white light, by its value at each wavelength; in RGB that at one.
fn colour(carried: Carried, share: impl Fn(f64) -> f64) -> [f64; 3] {
    const STEPS: u32 = 2000;
    if carried == Carried::Rgb {
        return [share(YELLOW); 3];
    }
    let curve = Curve::of(&share);
    let mut sum = [0.0; 3];
    for i in 0..STEPS {
        let basis = carried.basis(|| (i as f32 + 0.5) / STEPS as f32);
        let rgb: [f32; 3] = basis.under_white(basis.curve(&curve, Color::WHITE));
        sum.iter_mut().zip(rgb).for_each(|(sum, v)| *sum += f64::from(v) / f64::from(STEPS));
    }
    assert!(matches!(carried.basis(|| 0.5), Basis::Spectral(_)));
    sum
}

/// The mean of a picture of what is straight ahead, in parallel rays.
fn seen(carried: Carried, integrator: &str, samples: u32, world: &str) -> [f64; 3] {
    let head = "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\n\
                Camera \"orthographic\" \"float screenwindow\" [-0.1 0.1 -0.1 0.1]\n";
    let options = Options { carried: Some(carried), samples: Some(samples), ..Options::default() };
    let pixels = render(&scene(&format!("{head}{integrator}\nWorldBegin\n{world}"), &options)).film.pixels();
    let of = |c: usize| pixels.iter().map(|pixel| f64::from(pixel.mean()[c])).sum::<f64>();
    [0, 1, 2].map(|c| of(c) / pixels.len() as f64)
}

fn assert_near(found: [f64; 3], expected: [f64; 3], within: f64, of: &str) {
    assert!(
        (0..3).all(|c| (found[c] - expected[c]).abs() < within),
        "{of}: {found:?}, expected {expected:?}"
    );
}

/// `2 integral of f(cos) cos dcos`.
fn over_cosines(f: impl Fn(f64) -> f64) -> f64 {
    const STEPS: i32 = 2000;
    (0..STEPS).map(|i| f(((f64::from(i) + 0.5) / f64::from(STEPS)).sqrt())).sum::<f64>() / f64::from(STEPS)
}

const BOTH: [Carried; 2] = [Carried::Rgb, Carried::Wavelengths];

#[test]
fn panes_divide_each_wavelength_by_its_own_index() {
    // A lamp behind a pane that is turned by 60 degrees, and one that it mirrors: R' = 2 R / (1 + R) of validation.md I10.
    let once = |nm: f64| fresnel_mean(0.5, index(nm));
    let reflected = |nm: f64| 2.0 * once(nm) / (1.0 + once(nm));
    let pane = format!(
        "AttributeBegin Material \"thindielectric\" \"spectrum eta\" {INDEX} \
         Shape \"plane\" \"point3 point\" [0 0 2] \"vector3 normal\" [0.8660254 0 -0.5] AttributeEnd "
    );
    let behind = "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] \"bool twosided\" true \
                  Shape \"bilinearmesh\" \"point3 P\" [-2 -2 9  -2 2 9  2 -2 9  2 2 9]";
    let beside = "Material \"diffuse\" \"rgb reflectance\" [0 0 0] AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] \"bool twosided\" true Shape \"sphere\" \
                  \"float radius\" 1000";
    for carried in BOTH {
        for integrator in ["whitted", "path", "bdpt"] {
            let integrator = format!("Integrator \"{integrator}\"");
            let found = seen(carried, &integrator, 256, &format!("{pane}{behind}"));
            let expected = colour(carried, |nm| 1.0 - reflected(nm));
            assert_near(found, expected, 9e-3, &format!("{carried:?}, {integrator}, behind"));
            // What passes and what is mirrored is all.
            let found = seen(carried, &integrator, 256, &format!("{pane}{beside}"));
            assert_near(found, [1.0; 3], 9e-3, &format!("{carried:?}, {integrator}, all around"));
        }
    }
    // These are colours, not grey.
    let expected = colour(Carried::Wavelengths, |nm| 1.0 - reflected(nm));
    assert!(expected[0] - expected[2] > 0.15, "{expected:?}");
}

#[test]
fn coats_on_matte_bodies_reflect_each_wavelength_by_its_own_index() {
    for albedo in [0.5, 1.0] {
        // Seen straight on under an even sky: the coat's own share, and what gets in, walks and comes out.
        let share = |nm: f64| {
            let n = index(nm);
            let enters = 1.0 - over_cosines(|cos| fresnel_mean(cos, n));
            let back = 1.0 - enters / (n * n);
            let straight = fresnel_mean(1.0, n);
            straight + (1.0 - straight) * enters / (n * n) * albedo / (1.0 - albedo * back)
        };
        let world = |roughness: f64| {
            format!(
                "LightSource \"infinite\" \"rgb L\" [1 1 1] Material \"coateddiffuse\" \"spectrum eta\" {INDEX} \
                 \"rgb reflectance\" [{albedo} {albedo} {albedo}] \"float roughness\" {roughness} \
                 \"float thickness\" 0 \"integer maxdepth\" 1000 \
                 Shape \"plane\" \"point3 point\" [0 0 2] \"vector3 normal\" [0 0 -1]"
            )
        };
        // Nearly smooth facets are another way through the code; a little is lost at each bounce between them.
        for (carried, roughness) in [(BOTH[0], 0.0), (BOTH[1], 0.0), (BOTH[1], 1e-3)] {
            if roughness > 0.0 && albedo == 1.0 {
                continue;
            }
            let found = seen(carried, "Integrator \"path\"", 1024, &world(roughness));
            let what = format!("{carried:?}, albedo {albedo}, roughness {roughness}");
            let within = if roughness > 0.0 { 0.012 } else { 0.006 };
            assert_near(found, colour(carried, share), within, &what);
        }
        let found = colour(Carried::Wavelengths, share);
        assert!(albedo == 1.0 || (found[0] - found[2]).abs() > 0.02, "{found:?}");
    }
}

#[test]
fn coats_on_metal_reflect_each_wavelength_by_its_own_index() {
    const METAL: (f64, f64) = (4.0, 0.3);
    // Straight on: the coat, and metal below it that is met again and again.
    let share = |nm: f64| {
        let n = index(nm);
        let coat = fresnel_mean(1.0, n);
        let of = |sign: f64| (METAL.0 + sign * n).powi(2) + METAL.1 * METAL.1;
        let metal = of(-1.0) / of(1.0);
        coat + (1.0 - coat).powi(2) * metal / (1.0 - coat * metal)
    };
    let world = |roughness: f64| {
        format!(
            "LightSource \"infinite\" \"rgb L\" [1 1 1] Material \"coatedconductor\" \"spectrum interface.eta\" {INDEX} \
             \"spectrum conductor.eta\" [400 {0} 700 {0}] \"spectrum conductor.k\" [400 {1} 700 {1}] \
             \"float interface.roughness\" 0 \"float conductor.roughness\" {roughness} \"float thickness\" 0 \
             \"integer maxdepth\" 1000 Shape \"plane\" \"point3 point\" [0 0 2] \"vector3 normal\" [0 0 -1]",
            METAL.0, METAL.1
        )
    };
    for (carried, integrator, roughness, samples) in [
        (BOTH[0], "path", 0.0, 64),
        (BOTH[1], "path", 0.0, 1024),
        (BOTH[1], "bdpt", 0.0, 1024),
        (BOTH[1], "whitted", 0.0, 1024),
        // By random walks.
        (BOTH[0], "path", 2e-3, 1024),
        (BOTH[1], "path", 2e-3, 1024),
    ] {
        let found = seen(carried, &format!("Integrator \"{integrator}\""), samples, &world(roughness));
        assert_near(found, colour(carried, share), 0.005, &format!("{carried:?}, {integrator}, {roughness}"));
    }
    let expected = colour(Carried::Wavelengths, share);
    assert!((expected[0] - expected[2]).abs() > 0.012, "{expected:?}");
}
