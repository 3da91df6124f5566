//! Paths against the pictures that pbrt-v4 made of the same files.
//!
//! Means of blocks of 8 x 8 pixels, the brightest 1 % of the reference's left out; each picture comes in two independent
//! halves, whose difference tells its noise. The luminance of all must agree within 0.5 % and four standard errors, the
//! blocks within 1.6 times what the noise of both pictures makes expected.
use std::path::Path;

use durer::{Options, image, prepare, spectrum::Carried};
use durer_tests::shared;

/// Edge of a block, in pixels.
const BLOCK: usize = 8;

/// What is expected of a scene.
#[derive(Clone, Copy)]
enum Verdict {
    /// The pictures agree.
    Agrees,
    /// pbrt computes with wavelengths, and strong colours that light meets again and again come out otherwise with three
    /// numbers: the pictures agree if our rays carry wavelengths too.
    NeedsWavelengths,
    /// pbrt's own estimate of a coat is too bright (docs/pbrt-language.md): blocks are left out where it is clearly brighter, which
    /// are few and brighter by as much as that estimate makes coats. The others agree if our rays carry wavelengths.
    Coat,
}

struct Case {
    name: &'static str,
    file: &'static str,
    verdict: Verdict,
}

const fn case(name: &'static str, file: &'static str, verdict: Verdict) -> Case {
    Case { name, file, verdict }
}

const QUICK: &[Case] = &[
    case("smallpt", "cornell-box-variants/smallpt.pbrt", Verdict::Agrees),
    case("cornell-box-silver", "cornell-box-variants/cornell-box-silver.pbrt", Verdict::Agrees),
    case("cornell-box-specular", "cornell-box-variants/cornell-box-specular.pbrt", Verdict::Agrees),
    // Its plates are of metal, whose curves three numbers make 0.4 % darker.
    case("veach-mis", "veach-mis/scene-v4.pbrt", Verdict::NeedsWavelengths),
    case("cornell-box", "cornell-box/scene-v4.pbrt", Verdict::NeedsWavelengths),
];

const OTHERS: &[Case] = &[
    case("classroom", "classroom/scene-v4.pbrt", Verdict::Agrees),
    case("veach-ajar", "veach-ajar/scene-v4.pbrt", Verdict::Agrees),
    case("buddha-fractal", "buddha-fractal/buddha-fractal.pbrt", Verdict::Agrees),
    case("cornell-box-volume", "cornell-box-variants/cornell-box-volume.pbrt", Verdict::NeedsWavelengths),
    case("coffee", "coffee/scene-v4.pbrt", Verdict::NeedsWavelengths),
    case("volumetric-caustic", "volumetric-caustic/scene-v4.pbrt", Verdict::Agrees),
    case("smoke-grid", "smoke-grid/smoke.pbrt", Verdict::Agrees),
    case("staircase2", "staircase2/scene-v4.pbrt", Verdict::Agrees),
    case("teapot-full", "teapot-full/scene-v4.pbrt", Verdict::Agrees),
    case("killeroo-simple", "killeroos/killeroo-simple.pbrt", Verdict::Coat),
    case("killeroo-moving", "killeroos/killeroo-moving.pbrt", Verdict::Coat),
    case("killeroo-coated-gold", "killeroos/killeroo-coated-gold.pbrt", Verdict::Coat),
];

/// Luminances of blocks.
type Blocks = Vec<f64>;

fn blocks(width: usize, pixels: &[[f32; 3]]) -> Blocks {
    let height = pixels.len() / width;
    let mut all = Vec::new();
    for y in 0..height / BLOCK {
        for x in 0..width / BLOCK {
            let inside = (0..BLOCK * BLOCK).map(|i| {
                let [r, g, b] =
                    pixels[(y * BLOCK + i / BLOCK) * width + x * BLOCK + i % BLOCK].map(f64::from);
                0.2126 * r + 0.7152 * g + 0.0722 * b
            });
            all.push(inside.sum::<f64>() / (BLOCK * BLOCK) as f64);
        }
    }
    all
}

fn reference(folder: &Path, name: &str) -> (u32, u32, Blocks) {
    let path = folder.join(format!("references/{name}.exr"));
    let bytes = std::fs::read(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let picture = image::read(&bytes, name, durer::scene::Limits::default())
        .unwrap_or_else(|e| panic!("{name}: {e:?}"));
    let durer::scene::ImageData::F32(data) = &picture.data else { panic!("{name}: not in floats") };
    let pixels: Vec<[f32; 3]> = data.chunks(picture.channels as usize).map(|p| [p[0], p[1], p[2]]).collect();
    (picture.width, picture.height, blocks(picture.width as usize, &pixels))
}

/// By paths, or by `other` of as many bounces as the file asks for; the upper left part that the reference shows, of a
/// picture that may be larger: a file may ask for a part only.
fn ours(
    file: &Path,
    (other, carried): (Option<&str>, Carried),
    (width, height): (u32, u32),
    (samples, seed): (u32, u64),
) -> Blocks {
    let is_part = file.ends_with("smoke.pbrt");
    let (whole, rows) = if is_part { (200, 200) } else { (width, height) };
    let mut imported = durer::open(&file.to_string_lossy());
    if let (Some(other), Some(node)) = (other, &mut imported.desc.integrator) {
        node.kind = other.to_owned();
    }
    // A file without an integrator asks pbrt for paths.
    let options = Options {
        integrator: imported.desc.integrator.is_none().then(|| other.unwrap_or("path").to_owned()),
        width: Some(whole),
        height: Some(rows),
        samples: Some(samples),
        carried: Some(carried),
        seed: Some(seed),
        ..Options::default()
    };
    let prepared = prepare(&mut imported, &options).unwrap_or_else(|| panic!("{:#?}", imported.diagnostics));
    let film = durer_tests::render(&prepared).film;
    let shown = |i: &usize| i % (whole as usize) < width as usize && i / (whole as usize) < height as usize;
    let pixels = film.pixels();
    let pixels: Vec<[f32; 3]> = (0..pixels.len()).filter(shown).map(|i| pixels[i].mean()).collect();
    blocks(width as usize, &pixels)
}

/// How two pictures agree, each in two halves.
#[derive(Debug)]
struct Agreement {
    /// Relative difference of all luminance.
    bias: f64,
    /// Its standard error.
    sigma: f64,
    /// Mean difference of blocks, relative to their mean, and what noise makes expected.
    error: f64,
    expected: f64,
}

/// Of a block: the reference, ours less that, its absolute value, and the noise of both.
type Difference = [f64; 4];

fn differences([a, b]: [&Blocks; 2], [p, q]: [&Blocks; 2]) -> Vec<Difference> {
    let mut of: Vec<Difference> = (0..a.len())
        .map(|i| {
            let (reference, ours) = (0.5 * (a[i] + b[i]), 0.5 * (p[i] + q[i]));
            let noise = (0.5 * (a[i] - b[i])).hypot(0.5 * (p[i] - q[i]));
            [reference, ours - reference, (ours - reference).abs(), noise]
        })
        .collect();
    of.sort_by(|x, y| x[0].total_cmp(&y[0]));
    of.truncate(of.len() - of.len() / 100);
    of
}

fn compare(of: &[Difference]) -> Agreement {
    let sum = |f: fn(&Difference) -> f64| of.iter().map(f).sum::<f64>();
    let all = sum(|b| b[0]);
    Agreement {
        bias: sum(|b| b[1]) / all,
        sigma: sum(|b| b[3] * b[3]).sqrt() / all,
        error: sum(|b| b[2]) / all,
        expected: sum(|b| b[3]) / all,
    }
}

impl Agreement {
    fn is_close(&self) -> bool {
        self.bias.abs() < 5e-3 + 4.0 * self.sigma && self.error <= 1.6 * self.expected
    }
}

/// Coats that reflect the light of body and coat: 3 to 12 % brighter in pbrt, by its formula.
fn has_bright_coats(of: &[Difference]) -> bool {
    let is_brighter = |b: &Difference| b[1] + 3.0 * b[3] < -0.01 * b[0];
    let (coats, others): (Vec<Difference>, Vec<Difference>) = of.iter().partition(|b| is_brighter(b));
    let (coats, share) = (compare(&coats), coats.len() as f64 / of.len() as f64);
    let others = compare(&others);
    eprintln!("coats, {share} of the blocks: {coats:?}, others: {others:?}");
    others.is_close() && share < 0.15 && (-0.12..-0.03).contains(&coats.bias)
}

impl Verdict {
    /// What rays carry first of all.
    fn carried(self) -> Carried {
        match self {
            Self::NeedsWavelengths | Self::Coat => Carried::Wavelengths,
            Self::Agrees => Carried::Rgb,
        }
    }
}

fn check(folder: &Path, case: &Case, (other, carried): (Option<&str>, Carried), samples: u32) {
    let (width, height, a) = reference(folder, &format!("{}-a", case.name));
    let (_, _, b) = reference(folder, &format!("{}-b", case.name));
    let file = folder.join("assets/pbrt").join(case.file);
    let [p, q] = [1, 2].map(|seed| ours(&file, (other, carried), (width, height), (samples / 2, seed)));
    let of = differences([&a, &b], [&p, &q]);
    let found = compare(&of);
    eprintln!("{}, {carried:?}: {found:?}", case.name);
    let is_right = match case.verdict {
        Verdict::Agrees | Verdict::NeedsWavelengths => found.is_close(),
        Verdict::Coat => found.bias.abs() < 8e-3 && has_bright_coats(&of),
    };
    assert!(is_right, "{}, {carried:?}: {found:?}", case.name);
}

#[test]
fn paths_make_the_pictures_of_pbrt() {
    let Some(folder) = shared("paths_make_the_pictures_of_pbrt") else { return };
    for case in QUICK {
        check(&folder, case, (None, case.verdict.carried()), 8);
    }
}

#[test]
fn walks_from_both_ends_make_the_pictures_of_pbrt() {
    let Some(folder) = shared("walks_from_both_ends_make_the_pictures_of_pbrt") else { return };
    let samples = if std::env::var_os("DURER_SLOW").is_some() { 64 } else { 8 };
    for case in &QUICK[..3] {
        check(&folder, case, (Some("bdpt"), case.verdict.carried()), samples);
    }
}

#[test]
fn paths_make_all_pictures_of_pbrt() {
    let Some(wanted) = std::env::var_os("DURER_SLOW") else {
        eprintln!("SKIPPED: paths_make_all_pictures_of_pbrt: set DURER_SLOW=1, or to the name of a scene");
        return;
    };
    let Some(folder) = shared("paths_make_all_pictures_of_pbrt") else { return };
    let all = || QUICK.iter().chain(OTHERS);
    let is_one = all().any(|case| wanted == *case.name);
    for case in all().filter(|case| !is_one || wanted == *case.name) {
        check(&folder, case, (None, case.verdict.carried()), 256);
        if matches!(case.verdict, Verdict::Agrees) {
            check(&folder, case, (None, Carried::Wavelengths), 256);
        }
    }
}
