//! Reconstruction filters, G10 and C6, against quadrature and against weighting of evenly spread samples.
use durer_core::math::Point2;
use durer_core::sampling::{Dim, Sampler, SamplerKind};
use durer_model::filter::{FILTERS, Filter};
use durer_scene::{Args, Diagnostics, Node, Params, find};
use durer_testkit::random::Random;

fn build(kind: &str, params: Params) -> Result<Filter, String> {
    let node = Node::new(kind, params);
    let mut said = Diagnostics::default();
    let entry = find(FILTERS, "filter", &node, &mut said).ok_or("unknown")?;
    let built = (entry.build)(&mut Args::check(&node, entry.schema, &[], &mut said));
    built.ok_or_else(|| format!("{said:?}"))
}

/// Every kind with its defaults, and some with other parameters.
fn all() -> Vec<(String, Filter)> {
    let plain = FILTERS.iter().map(|e| (e.schema.name, Params::new()));
    let odd = [
        ("box", Params::new().float("xradius", 1.25)),
        ("triangle", Params::new().float("xradius", 0.7).float("yradius", 3.1)),
        ("gaussian", Params::new().float("sigma", 0.15).float("xradius", 0.5)),
        ("mitchell", Params::new().float("B", 0.0).float("C", 0.75).float("yradius", 1.0)),
        ("sinc", Params::new().float("tau", 2.0).float("xradius", 7.0)),
    ];
    plain.chain(odd).map(|(kind, p)| (format!("{kind} {p:?}"), build(kind, p).expect("sound"))).collect()
}

/// The integral of the filter over `x` times `weigh(x)`, with y in the middle of 512 steps.
fn integral(filter: &Filter, weigh: impl Fn(f64) -> f64) -> f64 {
    let [rx, ry] = filter.radius().map(f64::from);
    let n = 512;
    let at = |i: i32, r: f64| (f64::from(i) + 0.5) / f64::from(n) * 2.0 * r - r;
    let mut sum = 0.0;
    for i in 0..n {
        let x = at(i, rx);
        for j in 0..n {
            sum += f64::from(filter.at([x as f32, at(j, ry) as f32])) * weigh(x);
        }
    }
    sum * 4.0 * rx * ry / f64::from(n * n)
}

#[test]
fn integrals_are_one_and_nothing_lies_outside_g10() {
    for (name, filter) in all() {
        let sum = integral(&filter, |_| 1.0);
        assert!((sum - 1.0).abs() < 2e-5, "{name}: {sum}");
        let [rx, ry] = filter.radius();
        for (x, y) in [(1.0001, 0.0), (-1.0001, 0.3), (0.2, 1.0001), (0.0, -1.0001)] {
            assert_eq!(filter.at([x * rx, y * ry]), 0.0, "{name}");
        }
    }
}

#[test]
fn samples_lie_inside_and_count_one_but_for_rounding() {
    for (name, filter) in all() {
        let [rx, ry] = filter.radius();
        let mut random = Random::new(5);
        for _ in 0..20_000 {
            let s = filter.sample(Point2::new(random.unit() as f32, random.unit() as f32));
            assert!(s.offset[0].abs() <= rx && s.offset[1].abs() <= ry, "{name}: {s:?}");
            let negative = filter.at(s.offset) < 0.0;
            assert_eq!(s.weight < 0.0, negative, "{name}: {s:?}");
            assert!(s.weight.abs() < 1.6, "{name}: {s:?}");
        }
        assert_eq!(filter.sample(Point2::new(0.5, 0.5)).offset, [0.0, 0.0], "{name}");
        for u in [0.0, 1.0 - f32::EPSILON / 2.0, f32::MIN_POSITIVE, 0.5 - f32::EPSILON] {
            let s = filter.sample(Point2::new(u, u));
            assert!(s.weight.is_finite() && s.offset[0].is_finite(), "{name}: {u}: {s:?}");
        }
    }
}

/// `sum w v / sum w` over `n` samples of a pixel.
fn picture(filter: &Filter, pixel: u32, n: u32, v: impl Fn([f32; 2]) -> f32) -> f64 {
    let (mut sum, mut weights) = (0.0, 0.0);
    for i in 0..n {
        let s = filter.sample(Sampler::new(SamplerKind::Stratified, 1, [pixel, 0], i, n).d2(Dim::Pixel));
        sum += s.weight * v(s.offset);
        weights += s.weight;
    }
    f64::from(sum / weights)
}

#[test]
fn a_constant_picture_is_unchanged_g10() {
    for (name, filter) in all() {
        for value in [0.0, 1.0, 0.25, -8.0] {
            for pixel in 0..50 {
                assert_eq!(picture(&filter, pixel, 64, |_| value), f64::from(value), "{name}");
            }
        }
        assert!((picture(&filter, 0, 64, |_| 0.3) - 0.3).abs() < 3e-6, "{name}");
    }
}

#[test]
fn an_edge_comes_out_as_the_integral_of_the_filter_on_its_side() {
    for (name, filter) in all() {
        let r = f64::from(filter.radius()[0]);
        for edge in [-0.8, -0.31, 0.0, 0.55, 0.9].map(|e| e * r) {
            // The step of the quadrature that the edge runs through is 1/256 radius wide.
            let expected = integral(&filter, |x| f64::from(u8::from(x < edge)));
            let n = 40;
            let of = |pixel| picture(&filter, pixel, 1024, |o| f32::from(u8::from(f64::from(o[0]) < edge)));
            let mean = (0..n).map(of).sum::<f64>() / f64::from(n);
            assert!((mean - expected).abs() < 0.006, "{name}: edge at {edge}: {mean}, expected {expected}");
        }
    }
}

#[test]
fn mitchells_lobes_darken_before_an_edge_and_brighten_behind() {
    let filter = build("mitchell", Params::new()).expect("sound");
    assert!(filter.has_negative_lobes() && !Filter::usual().has_negative_lobes());
    // The outer piece of the spline with B = C = 1/3, integrated from 1 to 2: of
    // (-7/18 x^3 + 2 x^2 - 10/3 x + 16/9) from 1 to 2 is 7/18 * -15/4 + 14/3 - 5 + 16/9 = -0.013889.
    let outer = -7.0 / 18.0 * 15.0 / 4.0 + 14.0 / 3.0 - 5.0 + 16.0 / 9.0;
    let white_beyond = |edge: f32| {
        let n = 60;
        (0..n).map(|p| picture(&filter, p, 1024, |o| f32::from(u8::from(o[0] > edge)))).sum::<f64>()
            / f64::from(n)
    };
    let (before, behind) = (white_beyond(1.0), white_beyond(-1.0));
    assert!(
        (before - outer).abs() < 1e-3 && (behind - 1.0 + outer).abs() < 1e-3,
        "{before} {behind} {outer}"
    );
}

/// Mean and variance over pixels.
fn statistics(n: u32, of: impl Fn(u32) -> f64) -> (f64, f64) {
    let all: Vec<f64> = (0..n).map(of).collect();
    let mean = all.iter().sum::<f64>() / f64::from(n);
    (mean, all.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / f64::from(n))
}

#[test]
fn density_of_rays_equals_weighting_in_mean_with_less_variance_c6() {
    let samples = 16;
    let edge = |at: f32| move |o: [f32; 2]| f32::from(u8::from(o[0] + 0.3 * o[1] < at));
    for kind in ["triangle", "gaussian", "blackmanharris"] {
        let filter = build(kind, Params::new()).expect("sound");
        let [rx, ry] = filter.radius();
        let scale = 4.0 * rx * ry;
        // Weighting of samples that are evenly spread over the filter's support: (1 / N) sum f v / density.
        let weighed = |pixel: u32, v: &dyn Fn([f32; 2]) -> f32| {
            let of = |i| {
                let u = Sampler::new(SamplerKind::Independent, 2, [pixel, 1], i, samples).d2(Dim::Pixel);
                let offset = [(2.0 * u.x - 1.0) * rx, (2.0 * u.y - 1.0) * ry];
                f64::from(filter.at(offset) * scale * v(offset))
            };
            (0..samples).map(of).sum::<f64>() / f64::from(samples)
        };
        let by_density = |pixel: u32, v: &dyn Fn([f32; 2]) -> f32| {
            let of = |i| {
                let u = Sampler::new(SamplerKind::Independent, 3, [pixel, 1], i, samples).d2(Dim::Pixel);
                let s = filter.sample(u);
                [s.weight * v(s.offset), s.weight]
            };
            let all: Vec<_> = (0..samples).map(of).collect();
            f64::from(all.iter().map(|s| s[0]).sum::<f32>() / all.iter().map(|s| s[1]).sum::<f32>())
        };
        let contents: [&dyn Fn([f32; 2]) -> f32; 3] = [&|_| 1.0, &edge(0.0), &edge(0.25)];
        for (k, content) in contents.into_iter().enumerate() {
            let (m0, v0) = statistics(4000, |p| weighed(p, content));
            let (m1, v1) = statistics(4000, |p| by_density(p, content));
            assert!((m0 - m1).abs() < 5.0 * ((v0 + v1) / 4000.0).sqrt() + 1e-6, "{kind} {k}: {m0} {m1}");
            assert!(v1 < 0.6 * v0, "{kind} {k}: {v1} is not less than {v0}");
        }
    }
}

#[test]
fn wrong_parameters_are_refused() {
    for (kind, name, value) in [
        ("box", "xradius", 0.0),
        ("gaussian", "sigma", 0.0),
        ("sinc", "tau", 0.0),
        ("triangle", "yradius", -1.0),
    ] {
        assert!(build(kind, Params::new().float(name, value)).is_err(), "{kind} {name}");
    }
    assert!(build("box", Params::new().float("sigma", 1.0)).is_err());
    assert!(build("tent", Params::new()).is_ok());
}
