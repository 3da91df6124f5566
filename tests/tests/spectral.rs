//! Rays that carry wavelengths: what is grey is as it is with colours, what is bent goes where its index says.
use durer::{Options, Prepared, builtin, film::Tile, spectrum::Carried};
use durer_tests::{import, prepared, render, scene};

/// Options of one or the other.
fn carrying(carried: Carried) -> Options {
    Options { carried: Some(carried), ..Options::default() }
}

/// The mean of a picture.
fn mean(prepared: &Prepared) -> [f64; 3] {
    let pixels = render(prepared).film.pixels();
    let count = pixels.len() as f64;
    pixels.iter().fold([0.0; 3], |mut sum, pixel| {
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
fn colours_of_grids_dim_each_wavelength_as_the_same_colour_everywhere() {
    // A curve may rise above the components of its colour, by which steps through a grid are bounded.
    let through = |medium: &str| {
        let world = format!(
            "LightSource \"infinite\" \"rgb L\" [1 1 1] MakeNamedMedium \"m\" {medium} Translate 0 0 4 \
             AttributeBegin Material \"interface\" MediumInterface \"m\" \"\" Scale 3 3 1 Translate -0.5 -0.5 -0.5 \
             Shape \"trianglemesh\" \"integer indices\" [0 2 1 1 2 3  4 5 6 5 7 6  0 1 4 1 5 4  2 6 3 3 6 7 \
             0 4 2 2 4 6  1 3 5 3 7 5] \"point3 P\" [0 0 0  1 0 0  0 1 0  1 1 0  0 0 1  1 0 1  0 1 1  1 1 1] AttributeEnd"
        );
        mean(&small("Integrator \"volpath\"", &world, &carrying(Carried::Wavelengths)))
    };
    for red in ["2 0.02 0.02", "0.02 0.02 2"] {
        let even = through(&format!(
            "\"string type\" \"homogeneous\" \"rgb sigma_a\" [{red}] \"rgb sigma_s\" [0 0 0]"
        ));
        // Even between the middles of its outermost cells.
        let grid = through(&format!(
            "\"string type\" \"rgbgrid\" \"integer nx\" 3 \"integer ny\" 3 \"integer nz\" 3 \
             \"rgb sigma_a\" [{}] \"rgb sigma_s\" [{}] \"point3 p0\" [-6 -6 1] \"point3 p1\" [6 6 7]",
            format!("{red} ").repeat(27),
            "0 0 0 ".repeat(27)
        ));
        assert!((0..3).all(|i| (even[i] - grid[i]).abs() < 0.01), "{red}: {even:?} {grid:?}");
    }
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

/// The angle right of +z, in degrees, in which the eye of the scene `prism` sees the slit in light of this index, on the
/// way of which `rise` metres go up or down for each one along the plane. Such light is bent as if by glass of the index
/// `sqrt(n² + (n² - 1) rise²)`, more than light in the plane: lines in prisms are bent.
fn seen_at(n: f64, rise: f64) -> f64 {
    let n = (n * n + (n * n - 1.0) * rise * rise).sqrt();
    let (apex, left, right) = ([-1.12645, 7.01085], [0.3178, 4.15531], [2.06865, 6.83384]);
    let slit = [27.898_71, 18.038_29];
    let miss = |degrees: f64| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let inside = through(([0.0, 0.0], [sin, cos]), (left, apex), 1.0 / n)?;
        let (p, d) = through(inside, (apex, right), n)?;
        Some(d[0].atan2(d[1]) - (slit[0] - p[0]).atan2(slit[1] - p[1]))
    };
    let steps: Vec<(f64, f64)> = (-900..400)
        .filter_map(|i| miss(f64::from(i) * 0.01).map(|miss| (f64::from(i) * 0.01, miss)))
        .collect();
    let crossing = steps.windows(2).find(|w| w[0].1 * w[1].1 <= 0.0).expect("the slit is seen");
    let [(a, at_a), (b, at_b)] = [crossing[0], crossing[1]];
    a + (b - a) * at_a / (at_a - at_b)
}

/// Looks for the bands of the scene `prism`, of this material, where its index sends them.
fn check_bands(material: &str, index: impl Fn(f64) -> f64, samples: u32) {
    const FLINT: &str = "\"dielectric\" \"spectrum eta\" \"glass-SF11\"";
    let text = builtin::find("prism").expect("a scene").text;
    assert!(text.contains(FLINT));
    // Below the middle the lamp shines in five bands.
    let (width, columns, rows) = (480u32, [120u32, 440], [150u32, 160]);
    let crop = Some(Tile { x0: columns[0], y0: rows[0], x1: columns[1], y1: rows[1] });
    let options = Options { width: Some(width), samples: Some(samples), crop, ..Options::default() };
    let pixels = render(&scene(&text.replace(FLINT, material), &options)).film.pixels();
    let bright: Vec<f64> = (0..width)
        .map(|x| {
            let of = |y: u32| pixels[(y * width + x) as usize].mean();
            (rows[0]..rows[1]).map(|y| of(y).iter().map(|v| f64::from(*v).max(0.0)).sum::<f64>()).sum()
        })
        .collect();
    // Half the width of the picture, for a field of 7 degrees across its shorter side.
    let half = 2.0 * (3.5f64).to_radians().tan();
    let rise = (155.0 / 120.0 - 1.0) * (3.5f64).to_radians().tan();
    let column = |degrees: f64| (0.5 + 0.5 * (degrees + 2.0).to_radians().tan() / half) * f64::from(width);
    for nm in [447.0, 486.0, 502.0, 588.0, 656.0] {
        let expected = column(seen_at(index(nm), rise));
        // The image is as wide as slit and band: the middle of what is bright within it.
        let near = (expected - 8.0) as usize..(expected + 9.0) as usize;
        let dark = bright[near.start].min(bright[near.end]);
        let (mut sum, mut weight) = (0.0, 0.0);
        for x in near {
            let light = (bright[x] - dark).max(0.0);
            (sum, weight) = (sum + light * (x as f64 + 0.5), weight + light);
        }
        assert!(weight > 0.0, "{material}, {nm} nm: nothing at column {expected:.1}");
        let found = sum / weight;
        let degree = f64::from(width) / (2.0 * half.atan().to_degrees());
        assert!(
            (found - expected).abs() < 0.015 * degree,
            "{material}, {nm} nm: column {found:.2}, expected {expected:.2}"
        );
    }
}

#[test]
fn a_prism_turns_each_wavelength_as_its_index_says() {
    // Least deviation: sin((60° + D) / 2) = n sin 30°.
    let least = 2.0 * (0.5 * flint(587.6)).asin().to_degrees() - 60.0;
    assert!((least - 66.342).abs() < 1e-3, "{least}");
    check_bands("\"dielectric\" \"spectrum eta\" \"glass-SF11\"", flint, 256);
}

#[test]
fn a_prism_of_any_glass_does_so_by_whatever_its_index_is_given() {
    let square = |nm: f64| nm * nm * 1e-6;
    check_bands(
        "\"dielectric\" \"float cauchy\" [1.7385 0.0145 0.0005]",
        |nm| 1.7385 + 0.0145 / square(nm) + 0.0005 / square(nm).powi(2),
        64,
    );
    // glTF's dispersion is 20 by Abbe's number (n_d - 1) / (n_F - n_C).
    let by_abbe = |nm: f64| {
        let term = |nm: f64| 1.0 / square(nm);
        1.78 + 0.78 * (0.8 / 20.0) * (term(nm) - term(587.6)) / (term(486.13) - term(656.27))
    };
    for glass in [
        "\"dielectric\" \"float eta\" 1.78 \"float dispersion\" 0.8",
        "\"classic\" \"rgb diffuse\" [0 0 0] \"rgb transmission\" [1 1 1] \"bool fresnel\" true \"float eta\" 1.78 \"float dispersion\" 0.8",
        "\"principled\" \"float roughness\" 0 \"float transmission\" 1 \"float thickness\" 1 \"float eta\" 1.78 \"float dispersion\" 0.8",
    ] {
        check_bands(glass, by_abbe, 64);
    }
}

/// Where drops of this index send most light after `chords` chords, in degrees from the point opposite to the sun: the turn is
/// stationary for `cos² i = (n² - 1) / (chords² - 1)` (Descartes).
fn bow(n: f64, chords: f64) -> f64 {
    let i = ((n * n - 1.0) / (chords * chords - 1.0)).sqrt().acos();
    let turned = 2.0 * i - 2.0 * chords * (i.sin() / n).asin() + (chords - 1.0) * std::f64::consts::PI;
    (turned.to_degrees() - 180.0).abs()
}

/// Brightness of the scene `rainbow` straight up from the point opposite to the sun, where `from` of its text is `to`: degrees
/// from that point, and red, green and blue.
fn upwards(changes: &[(&str, &str)], carried: Carried, samples: u32) -> Vec<(f64, [f64; 3])> {
    let mut text = builtin::find("rainbow").expect("a scene").text.to_owned();
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    let (width, height, columns) = (1920u32, 960u32, 956..964);
    let crop = Some(Tile { x0: columns.start, y0: 0, x1: columns.end, y1: 500 });
    let options = Options { width: Some(width), samples: Some(samples), crop, ..carrying(carried) };
    let pixels = render(&scene(&text, &options)).film.pixels();
    (0..500)
        .map(|y| {
            let mut sum = [0.0; 3];
            for x in columns.clone() {
                let pixel = pixels[(y * width + x) as usize].mean();
                sum.iter_mut().zip(pixel).for_each(|(sum, v)| *sum += f64::from(v) / 8.0);
            }
            // Up from the middle of the picture, which is 13.35 degrees above the horizon; the opposite point is 20 below.
            let up = (1.0 - (f64::from(y) + 0.5) / (0.5 * f64::from(height))) * 30.0f64.to_radians().tan();
            (up.atan().to_degrees() + 0.230_868f64.asin().to_degrees() + 20.0, sum)
        })
        .collect()
}

/// Where between two angles a channel is brightest.
fn brightest(rows: &[(f64, [f64; 3])], channel: usize, (low, high): (f64, f64)) -> f64 {
    let inside = rows.iter().filter(|row| (low..high).contains(&row.0));
    inside.max_by(|a, b| a.1[channel].total_cmp(&b.1[channel])).expect("rows").0
}

/// The sun as a point, without the sky.
const POINT_SUN: (&str, &str) = ("\"float angle\" 0.53", "\"float angle\" 0");
const SUNLIGHT: &str = "\"rgb L\" [7.4 6.9 6.1]";
const NO_SKY: (&str, &str) = (
    "LightSource \"gradientsky\" \"string name\" \"clouds\"",
    "LightSource \"gradientsky\" \"float scale\" 0",
);

#[test]
fn both_bows_of_each_colour_stand_where_descartes_says() {
    let water = |nm: f64| durer::spectrum::index("water", nm).expect("known");
    for (nm, band, channel) in
        [(440.0, "\"spectrum L\" [435 0 440 90 445 0]", 2), (650.0, "\"spectrum L\" [645 0 650 90 655 0]", 0)]
    {
        let rows = upwards(&[POINT_SUN, NO_SKY, (SUNLIGHT, band)], Carried::Wavelengths, 64);
        for (chords, between) in [(2.0, (36.0, 46.0)), (3.0, (47.0, 57.0))] {
            let (found, expected) = (brightest(&rows, channel, between), bow(water(nm), chords));
            // A row of pixels is 0.066 degrees high there.
            assert!((found - expected).abs() < 0.1, "{nm} nm: {found}, expected {expected}");
        }
    }
    // Colours stand for a wavelength each.
    let rows = upwards(&[POINT_SUN, NO_SKY], Carried::Rgb, 4);
    for (channel, nm) in [611.4, 549.1, 464.2].into_iter().enumerate() {
        for (chords, between) in [(2.0, (36.0, 46.0)), (3.0, (47.0, 57.0))] {
            let (found, expected) = (brightest(&rows, channel, between), bow(water(nm), chords));
            assert!((found - expected).abs() < 0.1, "{nm} nm: {found}, expected {expected}");
        }
    }
}

#[test]
fn the_rainbow_is_red_outside_the_second_one_inside_and_dark_between() {
    let rows = upwards(&[], Carried::Wavelengths, 32);
    let at = |channel, between| brightest(&rows, channel, between);
    let first = [0, 1, 2].map(|channel| at(channel, (38.0, 44.0)));
    let second = [0, 1, 2].map(|channel| at(channel, (48.0, 56.0)));
    assert!(first[0] > first[1] + 0.2 && first[1] > first[2] + 0.2, "{first:?}");
    assert!(second[0] + 0.3 < second[1] && second[1] + 0.3 < second[2], "{second:?}");
    assert!((first[0] - 42.0).abs() < 0.3 && (second[0] - 51.0).abs() < 0.4, "{first:?} {second:?}");
    let mean = |(low, high): (f64, f64)| {
        let inside: Vec<f64> =
            rows.iter().filter(|row| (low..high).contains(&row.0)).map(|row| row.1[1]).collect();
        inside.iter().sum::<f64>() / inside.len() as f64
    };
    let [inside, dark, outside] = [(34.0, 38.0), (44.0, 49.0), (56.0, 60.0)].map(mean);
    assert!(dark < 0.6 * inside && dark < 0.95 * outside, "{inside} {dark} {outside}");
}

#[test]
fn indices_that_contradict_each_other_are_refused() {
    for (glass, message) in [
        ("\"float eta\" 1.5 \"float cauchy\" [1.5 0.004]", "give one of them"),
        ("\"float cauchy\" [1.5 0.004 0 0]", "expected A B or A B C"),
        ("\"float cauchy\" [0.5 -3]", "expected 0.1 to 10"),
        ("\"spectrum eta\" \"glass-BK7\" \"float dispersion\" 1", "no place beside a curve"),
    ] {
        let mut imported = import(&format!("WorldBegin Material \"dielectric\" {glass} Shape \"sphere\""));
        assert!(durer::prepare(&mut imported, &Options::default()).is_none(), "{glass}");
        let said = format!("{:?}", imported.diagnostics);
        assert!(said.contains(message), "{glass}: {said}");
    }
    let rain =
        "MakeNamedMedium \"m\" \"string phase\" \"waterdrops\" \"float g\" 0.5 WorldBegin Shape \"sphere\"";
    let mut imported = import(&rain.replace("\"m\"", "\"m\" \"string type\" \"homogeneous\""));
    assert!(durer::prepare(&mut imported, &Options::default()).is_some());
    assert!(format!("{:?}", imported.diagnostics).contains("no effect beside"));
}
