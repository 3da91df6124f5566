//! Rays that carry wavelengths: what is grey is as it is with colours, what is bent goes where its index says.
use durer::{Options, Prepared, builtin, film::Tile, spectrum::Carried};
use durer_tests::{prepared, render, scene};

/// Options of one or the other.
fn carrying(carried: Carried) -> Options {
    Options { carried: Some(carried), ..Options::default() }
}

/// The mean of a picture.
fn mean(prepared: &Prepared) -> [f64; 3] {
    let film = render(prepared).film;
    let count = film.pixels().len() as f64;
    film.pixels().iter().fold([0.0; 3], |mut sum, pixel| {
        sum.iter_mut().zip(pixel.mean()).for_each(|(sum, v)| *sum += f64::from(v) / count);
        sum
    })
}

/// Closed forms whose colours are all grey: what is expected, and the world. Eight pixels a side, looking along +z.
const GREY: &[(&str, f64, &str)] = &[
    // A closed sphere that shines (validation.md E1): 1 + a + a² + a³ with a = 0.5, three bounces.
    (
        "Integrator \"path\" \"integer maxdepth\" 3",
        1.875,
        "AreaLightSource \"diffuse\" \"bool twosided\" true Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5] \
         Shape \"sphere\" \"float radius\" 2",
    ),
    // The same of Whitted's integrator: light of a sky on a matte plane, and what a mirror leaves of it.
    (
        "Integrator \"whitted\"",
        0.5,
        "LightSource \"infinite\" \"rgb L\" [1 1 1] Material \"mirror\" \"rgb reflectance\" [0.5 0.5 0.5] \
         Shape \"plane\" \"point3 point\" [0 0 2] \"vector3 normal\" [0 0 -1]",
    ),
    // Glass that disappears under an even sky (I19), also where its index changes with wavelength.
    (
        "Integrator \"path\" \"integer maxdepth\" 100",
        1.0,
        "LightSource \"infinite\" \"rgb L\" [1 1 1] Material \"dielectric\" \"spectrum eta\" \"glass-SF11\" \
         Translate 0 0 4 Shape \"sphere\" \"float radius\" 1",
    ),
    (
        "Integrator \"whitted\" \"integer maxdepth\" 30 \"float mincontribution\" 0.0001",
        1.0,
        "LightSource \"infinite\" \"rgb L\" [1 1 1] Material \"dielectric\" \"spectrum eta\" \"glass-SF11\" \
         \"integer priority\" 1 Translate 0 0 4 Shape \"sphere\" \"float radius\" 1",
    ),
    // A lamp on a matte plane: E cos / pi x albedo, E = pi.
    (
        "Integrator \"distributed\"",
        0.25,
        "LightSource \"distant\" \"rgb L\" [3.14159265 3.14159265 3.14159265] \"point3 from\" [0 0 0] \
         \"point3 to\" [0 0 1] Material \"diffuse\" \"rgb reflectance\" [0.25 0.25 0.25] \
         Shape \"plane\" \"point3 point\" [0 0 2] \"vector3 normal\" [0 0 -1]",
    ),
    // The colour of a material, and light without bounces.
    (
        "Integrator \"cast\" \"string show\" \"albedo\"",
        0.75,
        "Material \"diffuse\" \"rgb reflectance\" [0.75 0.75 0.75] \
         Shape \"plane\" \"point3 point\" [0 0 2] \"vector3 normal\" [0 0 -1]",
    ),
    (
        "Integrator \"direct\"",
        0.6,
        "LightSource \"infinite\" \"rgb L\" [1 1 1] Material \"diffuse\" \"rgb reflectance\" [0.6 0.6 0.6] \
         Shape \"plane\" \"point3 point\" [0 0 2] \"vector3 normal\" [0 0 -1]",
    ),
];

fn small(integrator: &str, world: &str, options: &Options) -> Prepared {
    let head = "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\n\
                Sampler \"zsobol\" \"integer pixelsamples\" 64\nCamera \"perspective\" \"float fov\" 20\n";
    scene(&format!("{head}{integrator}\nWorldBegin\n{world}"), options)
}

#[test]
fn grey_scenes_are_the_same_in_both_modes() {
    for (integrator, expected, world) in GREY {
        for carried in [Carried::Rgb, Carried::Wavelengths] {
            let found = mean(&small(integrator, world, &carrying(carried)));
            assert!(
                found.iter().all(|v| (v / expected - 1.0).abs() < 5e-3),
                "{carried:?}, {integrator}: {found:?}, expected {expected}"
            );
        }
    }
}

#[test]
fn colours_that_light_meets_once_are_the_same_in_both_modes() {
    let world = |reflectance: &str, light: &str| {
        format!(
            "LightSource \"distant\" {light} \"float illuminance\" 3.14159265 \"point3 from\" [0 0 0] \
             \"point3 to\" [0 0 1] Material \"diffuse\" {reflectance} \
             Shape \"plane\" \"point3 point\" [0 0 2] \"vector3 normal\" [0 0 -1]"
        )
    };
    let red = "\"spectrum reflectance\" [400 0.05 560 0.06 600 0.5 640 0.6 760 0.62]";
    for (reflectance, light) in [
        ("\"rgb reflectance\" [0.63 0.065 0.05]", "\"rgb L\" [1 1 1]"),
        ("\"rgb reflectance\" [0.8 0.8 0.8]", "\"rgb L\" [1 0.7 0.4]"),
        ("\"rgb reflectance\" [0.8 0.8 0.8]", "\"blackbody L\" 3000"),
        (red, "\"rgb L\" [1 1 1]"),
    ] {
        let of =
            |carried| mean(&small("Integrator \"path\"", &world(reflectance, light), &carrying(carried)));
        let (rgb, waves) = (of(Carried::Rgb), of(Carried::Wavelengths));
        assert!((0..3).all(|i| (rgb[i] - waves[i]).abs() < 5e-3), "{reflectance} {light}: {rgb:?} {waves:?}");
    }
    // What light meets twice is not: a red wall lit by a red wall is redder than red times red.
    let gold = "\"spectrum eta\" \"metal-Au-eta\" \"spectrum k\" \"metal-Au-k\" \"float roughness\" 0";
    let sky = format!(
        "LightSource \"infinite\" \"rgb L\" [1 1 1] Material \"conductor\" {gold} \
         Shape \"plane\" \"point3 point\" [0 0 2] \"vector3 normal\" [0 0 -1]"
    );
    let of = |carried| mean(&small("Integrator \"whitted\"", &sky, &carrying(carried)));
    let (rgb, waves) = (of(Carried::Rgb), of(Carried::Wavelengths));
    // Gold's red is beyond Rec. 709: colours are cut at 1.
    assert!((0..3).all(|i| (rgb[i] - waves[i]).abs() < 0.03), "{rgb:?} {waves:?}");
}

#[test]
fn threads_change_no_bit_of_wavelengths() {
    let bits = |threads: usize| {
        let imported = builtin::find("prism").expect("a scene").import();
        let options =
            Options { threads: Some(threads), scale: Some(0.05), samples: Some(4), ..Options::default() };
        durer_tests::bits(&render(&prepared(imported, &options)))
    };
    assert_eq!(bits(1), bits(3));
}

/// Sellmeier's equation for SF11 (Schott's catalogue).
fn flint(nm: f64) -> f64 {
    let square = nm * nm * 1e-6;
    let terms = [(1.737_596_95, 0.013_188_707), (0.313_747_346, 0.062_306_814_2), (1.898_781_01, 155.236_29)];
    (1.0 + terms.iter().map(|(b, c)| b * square / (square - c)).sum::<f64>()).sqrt()
}

/// A ray in the plane, refracted where it crosses the line from `a` to `b`; `None` if it does not.
fn through(
    (o, d): ([f64; 2], [f64; 2]),
    (a, b): ([f64; 2], [f64; 2]),
    eta: f64,
) -> Option<([f64; 2], [f64; 2])> {
    let (ex, ez) = (b[0] - a[0], b[1] - a[1]);
    let across = d[0] * ez - d[1] * ex;
    let t = ((a[0] - o[0]) * ez - (a[1] - o[1]) * ex) / across;
    let share = ((a[0] - o[0]) * d[1] - (a[1] - o[1]) * d[0]) / across;
    let length = ex.hypot(ez);
    let mut n = [ez / length, -ex / length];
    if n[0] * d[0] + n[1] * d[1] > 0.0 {
        n = n.map(|v| -v);
    }
    let cos = -(n[0] * d[0] + n[1] * d[1]);
    let k = 1.0 - eta * eta * (1.0 - cos * cos);
    let f = eta * cos - k.max(0.0).sqrt();
    ((0.0..=1.0).contains(&share) && t > 0.0 && k >= 0.0)
        .then(|| ([o[0] + d[0] * t, o[1] + d[1] * t], [eta * d[0] + f * n[0], eta * d[1] + f * n[1]]))
}

/// The angle right of +z, in degrees, in which the eye of the scene `prism` sees the slit in light of a wavelength.
fn seen_at(nm: f64) -> f64 {
    let (apex, left, right) = ([-1.12645, 7.01085], [0.3178, 4.15531], [2.06865, 6.83384]);
    let slit = [27.898_71, 18.038_29];
    let miss = |degrees: f64| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let inside = through(([0.0, 0.0], [sin, cos]), (left, apex), 1.0 / flint(nm))?;
        let (p, d) = through(inside, (apex, right), flint(nm))?;
        Some(d[0].atan2(d[1]) - (slit[0] - p[0]).atan2(slit[1] - p[1]))
    };
    let steps: Vec<(f64, f64)> = (-900..400)
        .filter_map(|i| miss(f64::from(i) * 0.01).map(|miss| (f64::from(i) * 0.01, miss)))
        .collect();
    let crossing = steps.windows(2).find(|w| w[0].1 * w[1].1 <= 0.0).expect("the slit is seen");
    let [(a, at_a), (b, at_b)] = [crossing[0], crossing[1]];
    a + (b - a) * at_a / (at_a - at_b)
}

#[test]
fn a_prism_turns_each_wavelength_as_its_index_says() {
    // Least deviation: sin((60° + D) / 2) = n sin 30°.
    let least = 2.0 * (0.5 * flint(587.6)).asin().to_degrees() - 60.0;
    assert!((least - 66.342).abs() < 1e-3, "{least}");
    let imported = builtin::find("prism").expect("a scene").import();
    // Below the middle the lamp shines in five bands.
    let (width, rows) = (480u32, [150u32, 160]);
    let crop = Some(Tile { x0: 0, y0: rows[0], x1: width, y1: rows[1] });
    let options = Options { width: Some(width), samples: Some(256), crop, ..Options::default() };
    let film = render(&prepared(imported, &options)).film;
    let bright: Vec<f64> = (0..width)
        .map(|x| {
            let of = |y: u32| film.pixels()[(y * width + x) as usize].mean();
            (rows[0]..rows[1]).map(|y| of(y).iter().map(|v| f64::from(*v).max(0.0)).sum::<f64>()).sum()
        })
        .collect();
    // Half the width of the picture, for a field of 7 degrees across its shorter side.
    let half = 2.0 * (3.5f64).to_radians().tan();
    let column = |degrees: f64| (0.5 + 0.5 * (degrees + 2.0).to_radians().tan() / half) * f64::from(width);
    for nm in [447.0, 486.0, 502.0, 588.0, 656.0] {
        let expected = column(seen_at(nm));
        // The image is as wide as slit and band: the middle of what is bright within it.
        let near = (expected - 8.0) as usize..(expected + 9.0) as usize;
        let dark = bright[near.start.min(bright.len() - 1)].min(bright[near.end.min(bright.len() - 1)]);
        let (mut sum, mut weight) = (0.0, 0.0);
        for x in near {
            let light = (bright[x] - dark).max(0.0);
            (sum, weight) = (sum + light * (x as f64 + 0.5), weight + light);
        }
        assert!(weight > 0.0, "{nm} nm: nothing at column {expected:.1}");
        let found = sum / weight;
        let degree = f64::from(width) / (2.0 * half.atan().to_degrees());
        assert!(
            (found - expected).abs() < 0.12 * degree,
            "{nm} nm: column {found:.2}, expected {expected:.2}"
        );
    }
}
