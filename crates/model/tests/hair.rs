//! Hair against closed forms and against a ray traced through a cylinder.
use std::f64::consts::PI;

use durer_core::{
    math::{Point2, Vector3},
    spectrum::Spectrum,
};
use durer_model::bsdf::{Bsdf, Hair, Lobe, Strand};
use durer_testkit::{DVec3, quadrature, random::Random};

/// Along x; across, where h grows, is y.
fn strand(h: f64) -> Strand {
    Strand { along: Vector3::new(1.0, 0.0, 0.0), is_left: true, h: h as f32 }
}

fn hair(h: f64, sigma_a: f32, beta: [f32; 2], tilt: f32) -> Hair {
    Hair::new(&strand(h), Spectrum::splat(sigma_a), 1.55, beta, tilt.to_radians())
}

fn single(w: DVec3) -> Vector3 {
    Vector3::from_f64(w)
}

/// Share of light that leaves along `wo`, by sampling.
fn albedo(hair: &Hair, wo: DVec3, random: &mut Random, n: u32) -> f64 {
    let bsdf = Bsdf::default().with(Lobe::Hair(*hair));
    let mut sum = 0.0;
    for _ in 0..n {
        let u = Point2::new(random.unit().min(0.999_999) as f32, random.unit().min(0.999_999) as f32);
        let scattered = bsdf.scatter(single(wo), random.unit().min(0.999_999) as f32, u);
        sum += scattered.map_or(0.0, |s| f64::from(s.weight.mean()));
    }
    sum / f64::from(n)
}

#[test]
fn white_hair_sums_to_one() {
    let mut random = Random::new(3);
    for beta in [[0.1, 0.1], [0.3, 0.3], [0.6, 1.0], [1.0, 0.2]] {
        for h in [-0.95, -0.3, 0.0, 0.7] {
            for _ in 0..3 {
                let wo = random.direction();
                if wo.x.abs() > 0.97 {
                    continue;
                }
                let found = albedo(&hair(h, 0.0, beta, 2.0), wo, &mut random, 400);
                assert!((found - 1.0).abs() < 4e-3, "{beta:?} h {h} {wo:?}: {found}");
                // By quadrature, where the lobes are wide enough for it.
                if beta[0] >= 0.3 && beta[1] >= 0.2 {
                    let wide = hair(h, 0.0, beta, 2.0);
                    let sum = quadrature::sphere(700, |w| {
                        f64::from((wide.eval(single(wo), single(w)) * (w.z.abs() as f32)).mean())
                    });
                    assert!((sum - 1.0).abs() < 0.02, "{beta:?} h {h} {wo:?}: {sum}");
                }
            }
        }
    }
}

#[test]
fn absorption_is_beers_law_along_the_way_through() {
    // Seen straight on, through the middle: f is reflected; T = exp(-2 sigma) for each pass.
    let f = (0.55f64 / 2.55).powi(2);
    let mut random = Random::new(4);
    for sigma in [0.1f64, 0.5, 2.0] {
        let t = (-2.0 * sigma).exp();
        let expected = f + (1.0 - f).powi(2) * t / (1.0 - f * t);
        let found = albedo(&hair(0.0, sigma as f32, [0.3, 0.3], 0.0), DVec3::Z, &mut random, 4000);
        assert!((found / expected - 1.0).abs() < 0.02, "{sigma}: {found}, expected {expected}");
    }
}

/// Where the light that a ray meets leaves a smooth cylinder along x of radius 1: azimuths of reflection and of the first two
/// orders of transmission, by reflecting and refracting in the plane across.
fn azimuths(h: f64, eta: f64) -> [f64; 3] {
    // The eye looks along -z from above; y is across.
    let n = [h, (1.0 - h * h).sqrt()];
    let reflect = |d: [f64; 2], n: [f64; 2]| {
        let k = 2.0 * (d[0] * n[0] + d[1] * n[1]);
        [d[0] - k * n[0], d[1] - k * n[1]]
    };
    let refract = |d: [f64; 2], n: [f64; 2], ratio: f64| {
        let c = -(d[0] * n[0] + d[1] * n[1]);
        let k = (1.0 - ratio * ratio * (1.0 - c * c)).sqrt();
        [ratio * d[0] + (ratio * c - k) * n[0], ratio * d[1] + (ratio * c - k) * n[1]]
    };
    let next = |p: [f64; 2], d: [f64; 2]| {
        let t = -2.0 * (p[0] * d[0] + p[1] * d[1]);
        [p[0] + t * d[0], p[1] + t * d[1]]
    };
    let d = [0.0, -1.0];
    let out = |d: [f64; 2]| d[1].atan2(d[0]);
    let first = reflect(d, n);
    let inside = refract(d, n, 1.0 / eta);
    let far = next(n, inside);
    let inwards = |p: [f64; 2]| [-p[0], -p[1]];
    let passed = refract(inside, inwards(far), eta);
    let back = reflect(inside, inwards(far));
    let again = next(far, back);
    let third = refract(back, inwards(again), eta);
    [out(first), out(passed), out(third)]
}

#[test]
fn narrow_lobes_leave_where_a_ray_through_a_cylinder_does() {
    for h in [-0.9, -0.5, 0.0, 0.2, 0.6, 0.85] {
        for (order, phi) in azimuths(h, 1.55).into_iter().enumerate() {
            // A hair without tilt, seen across: the lobes are at theta = 0.
            let narrow = hair(h, 0.0, [0.2, 0.05], 0.0);
            let at = |phi: f64| {
                let wi = DVec3::new(0.0, phi.cos(), phi.sin());
                f64::from(narrow.pdf(Vector3::new(0.0, 0.0, 1.0), single(wi)))
            };
            let best =
                (-60..=60).map(|i| phi + f64::from(i) * 0.002).max_by(|a, b| at(*a).total_cmp(&at(*b)));
            let off = (best.expect("some") - phi).abs();
            // Other lobes lean on it where they overlap.
            assert!(off < 0.03, "h {h}, order {order}: {off} rad off {phi}");
        }
    }
}

#[test]
fn scales_turn_the_reflection_by_twice_their_tilt() {
    // Along the hair: reflected light leaves at -theta + 2 alpha.
    let (theta, alpha) = (0.4f64, 3.0f64);
    let narrow = hair(0.0, 50.0, [0.1, 0.3], alpha as f32);
    let wo = DVec3::new(theta.sin(), 0.0, theta.cos());
    let at = |t: f64| f64::from(narrow.pdf(single(wo), Vector3::from_f64(DVec3::new(t.sin(), 0.0, t.cos()))));
    let best = (0..4000).map(|i| -1.0 + f64::from(i) * 5e-4).max_by(|a, b| at(*a).total_cmp(&at(*b)));
    let expected = -theta + 2.0 * alpha * PI / 180.0;
    assert!((best.expect("some") - expected).abs() < 6e-3, "{best:?} {expected}");
}

#[test]
fn a_mirrored_hair_scatters_mirrored() {
    let mut random = Random::new(9);
    for _ in 0..200 {
        let (wo, wi) = (random.direction(), random.direction());
        let h = random.between(-0.95, 0.95);
        let right = hair(h, 0.2, [0.3, 0.4], 2.0).eval(single(wo), single(wi)).mean();
        let turned = |w: DVec3| single(DVec3::new(w.x, -w.y, w.z));
        let left = Hair::new(
            &Strand { is_left: false, ..strand(h) },
            Spectrum::splat(0.2),
            1.55,
            [0.3, 0.4],
            2f32.to_radians(),
        );
        let left = left.eval(turned(wo), turned(wi)).mean();
        assert!((right - left).abs() <= 2e-3 * right, "{right} {left}");
    }
}

#[test]
fn absorption_of_a_colour_is_that_of_the_published_fit() {
    // Chiang and others 2016, equation 9, worked out by hand for beta_n = 0.3.
    let polynomial = 5.969 - 0.215 * 0.3 + 2.532 * 0.09 - 10.73 * 0.027 + 5.574 * 0.0081 + 0.245 * 0.00243;
    for c in [0.05f64, 0.4, 0.9] {
        let expected = (c.ln() / polynomial).powi(2);
        let found = f64::from(Hair::absorption(c as f32, 0.3));
        assert!((found / expected - 1.0).abs() < 1e-4, "{c}: {found} {expected}");
    }
    assert!(Hair::absorption(0.0, 0.3).is_finite() && Hair::absorption(1.0, 0.3) == 0.0);
}

#[test]
fn a_hair_is_not_what_makes_lobes_large() {
    assert!(size_of::<Hair>() <= 56 && size_of::<Hair>() < size_of::<durer_model::bsdf::Layered>());
}
