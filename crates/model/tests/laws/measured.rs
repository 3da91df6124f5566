//! Files of known surfaces, read: the lobe is the surface that the file was made of.
use std::{collections::BTreeMap, f64::consts::PI, sync::LazyLock};

use durer_core::{
    math::{Point2, Vector3},
    spectrum::{Basis, Wavelengths},
};
use durer_model::bsdf::{Bsdf, Lobe, Measured, Measurement};
use durer_scene::{Tensor, TensorType, Tensors};
use durer_testkit::{
    DVec3,
    measured::{Brushed, Field, Grid, Known, Numbers, azimuths, fields},
    microfacet, quadrature,
    random::Random,
};

use super::{sampling::energy, unit, v};

/// Fields as a reader finds them.
fn tensors(fields: &[Field]) -> Tensors {
    let (mut file, mut all) = (Vec::new(), BTreeMap::new());
    for field in fields {
        let start = file.len();
        file.extend(field.packed());
        let ty = if matches!(field.numbers, Numbers::Bytes(_)) { TensorType::U8 } else { TensorType::F32 };
        let tensor = Tensor { ty, shape: field.shape.clone(), place: start..file.len() };
        all.insert(field.name.to_owned(), tensor);
    }
    Tensors::new(file.into(), all).expect("all are there")
}

fn read(known: Known<'_>, grid: &Grid) -> Measurement {
    Measurement::new(&tensors(&fields(known, grid))).expect("a measurement")
}

fn grid(azimuths: Vec<f64>, wavelengths: Vec<f64>) -> Grid {
    let round = azimuths.len() == 1;
    Grid {
        azimuths,
        elevations: if round { 20 } else { 11 },
        // An even number of steps: parts of a turn then have the same lattices.
        normals: if round { [96, 33] } else { [64, 65] },
        colours: if round { 33 } else { 25 },
        wavelengths,
    }
}

/// What a metal reflects in red, green and blue.
const METAL: [f64; 3] = [1.0, 0.7, 0.3];
const BRUSHED: Brushed = Brushed(0.5, 0.25);

fn metal(facets: Brushed, grid: &Grid) -> Measurement {
    let value = |o: DVec3, i: DVec3, c: f64| METAL[c as usize] * facets.value(o, i);
    read(Known { normals: &|m| facets.normals(m), value: &value }, grid)
}

/// A share of light by wavelength in nm: rises from blue to red.
fn share(nm: f64) -> f64 {
    0.2 + 0.6 * (nm - 360.0) / 480.0
}

static ROUND: LazyLock<Measurement> =
    LazyLock::new(|| metal(Brushed(0.4, 0.4), &grid(vec![0.0], Vec::new())));
static LONG: LazyLock<Measurement> = LazyLock::new(|| metal(BRUSHED, &grid(azimuths(17, 1.0), Vec::new())));
static QUARTER: LazyLock<Measurement> = LazyLock::new(|| metal(BRUSHED, &grid(azimuths(5, 4.0), Vec::new())));
static HALF: LazyLock<Measurement> = LazyLock::new(|| metal(BRUSHED, &grid(azimuths(9, 2.0), Vec::new())));
static MATTE: LazyLock<Measurement> = LazyLock::new(|| {
    let known = Known { normals: &|m| Brushed(0.5, 0.5).normals(m), value: &|_, _, nm| share(nm) / PI };
    read(known, &grid(vec![0.0], (0..33).map(|i| 360.0 + 15.0 * f64::from(i)).collect()))
});

fn lobe(of: &'static Measurement, along: Vector3) -> Lobe<'static> {
    Lobe::Measured(Measured::new(of, Basis::Rgb, along))
}

/// One of each kind of file.
pub(super) fn lobes() -> Vec<Lobe<'static>> {
    let along = Vector3::new(0.6, -0.8, 0.0);
    [&*ROUND, &*LONG, &*QUARTER, &*MATTE].map(|of| lobe(of, along)).into()
}

/// Pairs of directions above the surface, neither too flat.
fn pairs(random: &mut Random, count: usize) -> Vec<[DVec3; 2]> {
    let above = |random: &mut Random| {
        let mut w = random.direction();
        while w.z.abs() < 0.15 {
            w = random.direction();
        }
        DVec3::new(w.x, w.y, w.z.abs())
    };
    (0..count).map(|_| [above(random), above(random)]).collect()
}

/// The mean difference of two numbers by the larger one, and that which one of a hundred exceeds: where light grazes, the
/// lattice of colours is coarse.
fn off(found: impl Iterator<Item = (f64, f64)>) -> (f64, f64) {
    let mut all: Vec<f64> = found.map(|(a, b)| (a - b).abs() / a.max(b).max(0.02)).collect();
    assert!(all.len() >= 500);
    all.sort_by(f64::total_cmp);
    (all.iter().sum::<f64>() / all.len() as f64, all[all.len() * 99 / 100])
}

/// How far off a lobe is that was read from the file of these facets.
fn off_metal(of: &Measurement, facets: Brushed) -> (f64, f64) {
    let lobe = Measured::new(of, Basis::Rgb, Vector3::new(1.0, 0.0, 0.0));
    let pairs = pairs(&mut Random::new(401), 1500).into_iter();
    off(pairs.flat_map(|[o, i]| {
        let rgb = Basis::Rgb.to_rgb(lobe.eval(v(o), v(i))).map(f64::from);
        rgb.into_iter().zip(METAL.map(|metal| metal * facets.value(o, i)))
    }))
}

#[test]
fn metal_read_from_a_file_is_the_metal() {
    let (mean, most) = off_metal(&ROUND, Brushed(0.4, 0.4));
    assert!(mean < 0.006 && most < 0.06, "{mean} {most}");
    for of in [&*LONG, &*QUARTER] {
        let (mean, most) = off_metal(of, BRUSHED);
        assert!(mean < 0.035 && most < 0.35, "{of:?}: {mean} {most}");
    }
    // What is missing is the lattice's: twice as fine, a third of it is left.
    let usual = grid(azimuths(9, 4.0), Vec::new());
    let fine = metal(BRUSHED, &Grid { elevations: 21, normals: [97, 129], colours: 49, ..usual });
    let (mean, most) = off_metal(&fine, BRUSHED);
    assert!(mean < 0.0105 && most < 0.11, "{mean} {most}");
}

#[test]
fn what_does_not_change_with_wavelength_or_direction_is_matte() {
    let lobe = Lobe::Measured(Measured::new(&MATTE, Basis::Rgb, Vector3::new(1.0, 0.0, 0.0)));
    let pairs: Vec<f32> = (360..=830).flat_map(|nm| [nm as f32, share(f64::from(nm)) as f32]).collect();
    let color = durer_core::spectrum::Sampled::new(&pairs).expect("a spectrum").share();
    let mut random = Random::new(402);
    let mut found = Vec::new();
    for [o, i] in self::pairs(&mut random, 1000) {
        let rgb = Basis::Rgb.to_rgb(lobe.eval(v(o), v(i)));
        found.extend(rgb.into_iter().zip(color.rgb).map(|(a, b)| (f64::from(a) * PI, f64::from(b))));
        // From below, and through the surface.
        assert_eq!(rgb, Basis::Rgb.to_rgb(lobe.eval(v(-o), v(-i))));
        assert!(lobe.eval(v(o), v(-i)).is_black());
    }
    let (mean, most) = off(found.into_iter());
    assert!(mean < 0.006 && most < 0.05, "{mean} {most}");
    // With wavelengths of their own, rays see the curve itself, not the colour's.
    for u in [0.05, 0.4, 0.9] {
        let wavelengths = Wavelengths::drawn(u);
        let lobe = Measured::new(&MATTE, Basis::Spectral(wavelengths), Vector3::new(1.0, 0.0, 0.0));
        let value = lobe.eval(v(DVec3::new(0.6, 0.0, 0.8)), v(DVec3::new(0.0, 0.6, 0.8)));
        let off = wavelengths.map(value, |nm, f| (f * PI as f32 / share(f64::from(nm)) as f32 - 1.0).abs());
        assert!(off.max() < 0.01, "{u}: {off:?}");
    }
}

#[test]
fn parts_of_a_turn_are_the_whole() {
    let mut random = Random::new(403);
    let along = Vector3::new(0.0, 1.0, 0.0);
    for part in [&*HALF, &*QUARTER] {
        let (part, whole) = (Measured::new(part, Basis::Rgb, along), Measured::new(&LONG, Basis::Rgb, along));
        // Integrals of densities begin elsewhere: colours stand on lattices that are not the same.
        let pairs = pairs(&mut random, 1000);
        let values = |lobe: &Measured, [o, i]: &[DVec3; 2]| f64::from(lobe.eval(v(*o), v(*i)).mean());
        let (mean, most) = off(pairs.iter().map(|pair| (values(&part, pair), values(&whole, pair))));
        assert!(mean < 0.01 && most < 0.12, "{mean} {most}");
        let densities = |lobe: &Measured, [o, i]: &[DVec3; 2]| f64::from(lobe.pdf(v(*o), v(*i)));
        let (mean, most) = off(pairs.iter().map(|pair| (densities(&part, pair), densities(&whole, pair))));
        assert!(mean < 0.01 && most < 0.12, "{mean} {most}");
    }
}

#[test]
fn as_much_is_reflected_as_the_surface_reflects() {
    let mut random = Random::new(404);
    let bsdf = |of| Bsdf::default().with(lobe(of, Vector3::new(1.0, 0.0, 0.0)));
    for mu in [0.95f64, 0.7, 0.4] {
        let wo = DVec3::new((1.0 - mu * mu).sqrt(), 0.0, mu);
        let (a, b) = microfacet::Facets::ggx(0.4).albedo(mu, 400);
        let (found, sigma) = energy(&bsdf(&*ROUND), v(wo), 40_000, &mut random);
        assert!((found - (a + b)).abs() < 0.01 + 4.0 * sigma, "{mu}: {found} +- {sigma}, expected {}", a + b);
        let expected = quadrature::sphere(400, |wi| BRUSHED.value(wo, wi) * wi.z.max(0.0));
        let (found, sigma) = energy(&bsdf(&*LONG), v(wo), 40_000, &mut random);
        assert!(
            (found - expected).abs() < 0.02 + 4.0 * sigma,
            "{mu}: {found} +- {sigma}, expected {expected}"
        );
    }
    let tint = Basis::Rgb.to_rgb(bsdf(&*ROUND).albedo());
    let (a, b) = microfacet::Facets::ggx(0.4).albedo(1.0, 400);
    for (found, metal) in tint.into_iter().zip(METAL) {
        assert!((f64::from(found) - metal * (a + b)).abs() < 0.01, "{tint:?}");
    }
}

/// Draws follow value times cosine so closely that their weights hardly differ.
#[test]
fn draws_follow_what_is_reflected() {
    let mut random = Random::new(405);
    for (of, most) in [(&*ROUND, 0.1), (&*LONG, 0.2), (&*MATTE, 0.1)] {
        let bsdf = Bsdf::default().with(lobe(of, Vector3::new(1.0, 0.0, 0.0)));
        let wo = v(DVec3::new(0.48, 0.36, 0.8));
        let (mut sum, mut squares, count) = (0.0, 0.0, 20_000.0);
        for _ in 0..count as u32 {
            let u = unit(&mut random);
            let weight =
                bsdf.scatter(wo, 0.5, Point2::new(u.x, u.y)).map_or(0.0, |s| f64::from(s.weight.mean()));
            sum += weight;
            squares += weight * weight;
        }
        let mean = sum / count;
        let deviation = (squares / count - mean * mean).sqrt() / mean;
        assert!(deviation < most, "{of:?}: {deviation}");
    }
}

#[test]
fn files_that_are_no_measurement_are_refused_by_name() {
    let known = Known { normals: &|_| 1.0 / PI, value: &|_, _, _| 1.0 / PI };
    let small = Grid { azimuths: vec![0.0], elevations: 3, normals: [4, 4], colours: 3, wavelengths: vec![] };
    let sound = fields(known, &small);
    assert!(Measurement::new(&tensors(&sound)).is_ok());
    let refused = |change: &dyn Fn(&mut Vec<Field>)| {
        let mut fields = sound.clone();
        change(&mut fields);
        Measurement::new(&tensors(&fields)).err().unwrap_or_default()
    };
    for name in ["description", "jacobian", "theta_i", "phi_i", "ndf", "sigma", "vndf", "luminance", "rgb"] {
        let without = refused(&|fields| fields.retain(|f| f.name != name));
        assert!(without.contains(&format!("no field \"{name}\"")), "{without}");
        let misshaped = refused(&|fields| {
            fields.iter_mut().filter(|f| f.name == name).for_each(|f| f.shape.push(1));
        });
        assert!(misshaped.contains(&format!("\"{name}\" is [")), "{misshaped}");
    }
    let number = |name: &'static str, at: usize, value: f32| {
        move |fields: &mut Vec<Field>| {
            let found = fields.iter_mut().find(|f| f.name == name);
            if let Some(Field { numbers: Numbers::Floats(values), .. }) = found {
                values[at] = value;
            }
        }
    };
    assert!(refused(&number("vndf", 5, f32::NAN)).contains("\"vndf\" holds NaN at place 5"));
    assert!(refused(&number("sigma", 3, -1.0)).contains("\"sigma\" holds -1 at place 3"));
    assert!(refused(&number("theta_i", 1, 9.0)).contains("do not rise"));
    let dark = refused(&|fields| {
        for i in 9..18 {
            number("luminance", i, 0.0)(fields);
        }
    });
    assert!(dark.contains("elevation 44.1 degrees, is no density"), "{dark}");
    let turned = Grid { azimuths: vec![0.0, 2.0, 4.0, 6.2], ..small };
    let turned = Measurement::new(&tensors(&fields(known, &turned))).err().unwrap_or_default();
    assert!(turned.contains("\"phi_i\" goes from 0"), "{turned}");
    // Colours that are none are black, and counted.
    let mut damaged = sound.clone();
    number("rgb", 4, f32::INFINITY)(&mut damaged);
    assert_eq!(Measurement::new(&tensors(&damaged)).expect("usable").damaged(), 1);
}
