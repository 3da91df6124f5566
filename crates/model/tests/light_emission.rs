//! Particles of lights without shape: densities as stated, the power, and the light that samples find at a place.
use std::{f64::consts::PI, sync::Arc};

use durer_core::{
    glam::{DAffine3, DVec3},
    math::{Point2, Point3, Transform},
    sampling::{Sampler, SamplerKind},
    spectrum::{Basis, Color, Spectrum},
};
use durer_model::light::{Emitted, Extent, LIGHTS, Leaving, Light, LightCx, Source, Track};
use durer_scene::{
    Args, AssetError, Assets, Data, Diagnostics, Image, ImageData, Mesh, Missing, Node, Params, ValueType,
    find,
};
use durer_testkit::random::Random;

const CX: LightCx = LightCx { basis: Basis::Rgb, time: 0.0 };
const WITHIN: Extent = Extent { center: Point3::new(0.2, -0.1, 0.3), radius: 1.5 };
const N: u32 = 1 << 18;

/// A picture and a luminaire.
struct Files;

impl Assets for Files {
    fn bytes(&self, _path: &str) -> Result<Arc<[u8]>, AssetError> {
        let text =
            "IESNA:LM-63-2002\nTILT=NONE\n1 1000 1 4 1 1 2 0 0 0 1 1 100\n0 45 90 120\n0\n100 80 10 0\n";
        Ok(text.as_bytes().into())
    }
    fn mesh(&self, path: &str) -> Result<Arc<Mesh>, AssetError> {
        Err(AssetError::Missing { path: path.to_owned() })
    }
    fn image(&self, _path: &str) -> Result<Arc<Image>, AssetError> {
        let data = ImageData::F32((0..192).map(|i| (i * i % 23) as f32).collect());
        Ok(Arc::new(Image { width: 8, height: 8, channels: 3, data }))
    }
}

fn light(kind: &str, params: Params) -> Box<dyn Light> {
    let (mut said, node) = (Diagnostics::default(), Node::new(kind, params));
    let entry = find(LIGHTS, "light", &node, &mut said).expect("a registered light");
    let mut args = Args::check(&node, entry.schema, &[], &mut said).with_assets(&Files, Missing::Refuse);
    (entry.build)(&mut args).unwrap_or_else(|| panic!("{kind}: {said:?}"))
}

fn point3(params: Params, name: &str, p: [f32; 3]) -> Params {
    params.with(name, ValueType::Point3, Data::Floats(p.to_vec()))
}

/// Every light that sends particles, somewhere, turned.
fn lights() -> Vec<(&'static str, Box<dyn Light>)> {
    let file = || Params::new().string("filename", "file");
    let beam = || point3(Params::new(), "to", [0.3, -0.2, 1.0]);
    let mut all = vec![
        ("point", light("point", Params::new().rgb("I", [3.0, 2.0, 1.0]))),
        ("spot", light("spot", beam().float("coneangle", 50.0).float("conedeltaangle", 30.0))),
        ("sharp spot", light("spot", beam().float("coneangle", 40.0).float("conedeltaangle", 0.0))),
        ("soft spot", light("spot", beam().float("coneangle", 40.0).float("conedeltaangle", 40.0))),
        ("projection", light("projection", file().float("fov", 60.0))),
        ("goniometric", light("goniometric", file())),
        ("ies", light("ies", file())),
        ("distant", light("distant", beam())),
        ("disk", light("distant", beam().float("angle", 40.0))),
        ("sun", light("sun", Params::new())),
        ("even sky", light("infinite", Params::new().rgb("L", [1.0, 2.0, 3.0]))),
        ("picture", light("infinite", file())),
        ("wide picture", light("infinite", file().string("layout", "latlong"))),
        ("gradient", light("gradientsky", Params::new())),
        ("sky", light("sky", Params::new())),
    ];
    let place = DAffine3::from_translation(DVec3::new(0.4, 0.3, -1.9)) * DAffine3::from_rotation_x(0.3);
    all.iter_mut().for_each(|(_, light)| light.place(&Track::from(Transform::from_f64(&place))));
    all
}

fn luminance(s: Spectrum) -> f64 {
    Color { rgb: Basis::Rgb.to_rgb(s) }.luminance().into()
}

fn particles(light: &dyn Light, n: u32) -> impl Iterator<Item = Option<Emitted>> + '_ {
    let mut random = Random::new(3);
    let mut u = move || Point2::new(random.unit() as f32, random.unit() as f32);
    (0..n).map(move |_| light.emit(&CX, &WITHIN, [u(), u()]))
}

#[test]
fn particles_have_the_stated_densities() {
    for (name, light) in lights() {
        assert!(light.is_emitter(), "{name}");
        let mut count = 0;
        for emitted in particles(&*light, 4096).flatten() {
            let (p, hit) = (emitted.p + emitted.d * 0.7, None);
            let [place, direction] = light.emission_pdf(&CX, &WITHIN, &Leaving { p, hit, d: emitted.d });
            let near = |a: f32, b: f32| (a / b - 1.0).abs() < 2e-3;
            // At the edges of cells rounding may tell the one beside.
            let as_stated = near(place, emitted.pdf_place) && near(direction, emitted.pdf_direction);
            count += u32::from(as_stated);
        }
        assert!(count >= 4090 || name == "projection" && count > 3900, "{name}: {count} of 4096");
    }
}

#[test]
fn particles_carry_the_power() {
    for (name, light) in lights() {
        let power: f64 =
            particles(&*light, N).flatten().map(|e| luminance(e.power())).sum::<f64>() / f64::from(N);
        // Of 40 degrees across, seen from the ball the rim's rays are no weaker: 2 (1 - cos 20°) / sin² 20°.
        let wide = if name == "disk" { 2.0 / (1.0 + 20f64.to_radians().cos()) } else { 1.0 };
        let expected = f64::from(light.power(WITHIN.radius)) * wide;
        // Pictures are bilinear where rays see them; the power is of the pixels.
        let slack = if name.contains("picture") { 0.03 } else { 0.01 };
        assert!((power / expected - 1.0).abs() < slack, "{name}: {power} W, expected {expected}");
    }
}

/// Of all directions with any density, and of all places, the shares by one over the density are those of the measure.
#[test]
fn one_over_the_density_measures_the_directions() {
    for (name, light) in lights() {
        let (mut solid, mut area, mut up) = (0.0, 0.0, 0.0);
        for e in particles(&*light, N).flatten() {
            let share = 1.0 / f64::from(e.pdf_direction) / f64::from(N);
            solid += share;
            up += share * f64::from(e.d.z);
            area += 1.0 / f64::from(e.pdf_place) / f64::from(N);
            assert_eq!(matches!(e.source, Source::Point), e.pdf_place == 1.0 && area < 1.1, "{name}");
        }
        let disk = PI * f64::from(WITHIN.radius).powi(2);
        if ["even sky", "gradient", "point"].contains(&name) {
            assert!((solid / (4.0 * PI) - 1.0).abs() < 0.02 && up.abs() < 0.1, "{name}: {solid} sr, {up}");
        }
        if ["distant", "disk", "even sky", "gradient"].contains(&name) {
            assert!((area / disk - 1.0).abs() < 0.02, "{name}: {area} m²");
        }
    }
}

/// Fluence in a small ball: by the way that particles make in it, and by samples at its points.
#[test]
fn particles_bring_what_samples_find() {
    let (middle, radius) = (DVec3::new(0.3, 0.1, 0.2), 0.8f64);
    let volume = 4.0 / 3.0 * PI * radius.powi(3);
    for (name, light) in lights() {
        let mut by_particles = 0.0;
        for e in particles(&*light, 2 * N).flatten() {
            let (o, d) = (e.p.to_f64() - middle, e.d.to_f64());
            let b = -o.dot(d);
            let inside = radius * radius - (o + d * b).length_squared();
            if b > 0.0 && inside > 0.0 {
                by_particles += luminance(e.power()) * 2.0 * inside.sqrt() / volume / f64::from(2 * N);
            }
        }
        let mut random = Random::new(9);
        let mut by_samples = 0.0;
        let n = N / 4;
        for i in 0..n {
            let p = loop {
                let p = DVec3::new(
                    random.between(-1.0, 1.0),
                    random.between(-1.0, 1.0),
                    random.between(-1.0, 1.0),
                );
                if p.length() < 1.0 {
                    break middle + p * radius;
                }
            };
            let sampler = Sampler::new(SamplerKind::Independent, 1, [2, 3], i, n);
            let sample = light.sample(&CX, Point3::from_f64(p), &sampler);
            by_samples += sample.map_or(0.0, |s| luminance(s.weight)) / f64::from(n);
        }
        assert!(
            (by_particles / by_samples - 1.0).abs() < 0.02,
            "{name}: {by_particles}, samples {by_samples}"
        );
    }
}

#[test]
fn light_that_does_not_fade_sends_no_particles() {
    for kind in ["point", "spot"] {
        let light = light(kind, Params::new().string("falloff", "none"));
        assert!(!light.is_emitter() && particles(&*light, 10).flatten().next().is_none());
    }
    assert!(!light("ambient", Params::new()).is_emitter());
}
