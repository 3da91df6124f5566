//! Particles of surfaces that shine.
use std::f64::consts::PI;

use durer_core::{
    glam::DVec3,
    math::{Point2, Point3},
    sampling::{Sampler, SamplerKind},
};
use durer_model::light::{Area, Emitted, Extent, Leaving, Light, Source};
use durer_scene::Params;
use durer_testkit::random::Random;

use super::lamps::*;

const WITHIN: Extent = Extent { center: Point3::ZERO, radius: 1.0 };
const N: u32 = 1 << 17;

fn particles(light: &Area) -> impl Iterator<Item = Emitted> + '_ {
    let mut random = Random::new(3);
    let mut u = move || Point2::new(random.unit() as f32, random.unit() as f32);
    (0..N).filter_map(move |_| light.emit(&CX, &WITHIN, [u(), u()]))
}

#[test]
fn particles_have_the_stated_densities_and_carry_the_power() {
    for lamp in &lamps() {
        for params in [Params::new(), two_sided()] {
            let light = shines(params, lamp);
            let mut power = 0.0;
            for (i, e) in particles(&light).enumerate() {
                power += f64::from(e.power().mean()) / f64::from(N);
                if i % 64 == 0 {
                    let Source::Surface(hit) = e.source else { panic!("{}", lamp.name) };
                    let ray = Leaving { p: e.p, hit: Some(hit), d: e.d };
                    let [place, direction] = light.emission_pdf(&CX, &WITHIN, &ray);
                    let near = |a: f32, b: f32| (a / b - 1.0).abs() < 1e-3;
                    let found = [place, direction];
                    assert!(near(place, e.pdf_place) && near(direction, e.pdf_direction), "{found:?} {e:?}");
                }
            }
            let expected = f64::from(light.power(1.0));
            let Lamp { name, geometry, .. } = lamp;
            assert!(
                (power / expected - 1.0).abs() < 0.01,
                "{name} {geometry:?}: {power} W, expected {expected}"
            );
        }
    }
}

/// Fluence in a small ball: by the way that particles make in it, and by samples at its points.
#[test]
fn particles_bring_what_samples_find() {
    let radius = 0.35f64;
    let volume = 4.0 / 3.0 * PI * radius.powi(3);
    let mut compared = 0;
    for lamp in &lamps() {
        let light = shines(Params::new(), lamp);
        for middle in [DVec3::new(0.1, -0.2, 2.0), DVec3::new(2.0, 0.4, 0.9), DVec3::new(-1.2, 1.4, -1.9)] {
            let (mut by_particles, mut crossed) = (0.0, 0);
            for e in particles(&light) {
                let (o, d) = (e.p.to_f64() - middle, e.d.to_f64());
                let b = -o.dot(d);
                let inside = radius * radius - (o + d * b).length_squared();
                if b > 0.0 && inside > 0.0 {
                    by_particles += f64::from(e.power().mean()) * 2.0 * inside.sqrt() / volume / f64::from(N);
                    crossed += 1;
                }
            }
            let mut random = Random::new(9);
            let mut by_samples = 0.0;
            let n = 1 << 13;
            for i in 0..n {
                let p = loop {
                    let mut u = || random.between(-1.0, 1.0);
                    let p = DVec3::new(u(), u(), u());
                    if p.length() < 1.0 {
                        break middle + p * radius;
                    }
                };
                let sampler = Sampler::new(SamplerKind::Independent, 1, [2, 3], i, n);
                let sample = light.sample(&CX, Point3::from_f64(p), &sampler);
                by_samples += sample.map_or(0.0, |s| f64::from(s.weight.mean())) / f64::from(n);
            }
            if crossed < 400 {
                continue;
            }
            compared += 1;
            let slack = 0.03 + 2.5 / f64::from(crossed).sqrt();
            let Lamp { name, geometry, .. } = lamp;
            assert!(
                (by_particles / by_samples - 1.0).abs() < slack,
                "{name} {middle} {geometry:?}: {by_particles}, samples {by_samples}"
            );
        }
    }
    assert!(compared > 50, "{compared}");
}
