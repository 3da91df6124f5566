//! Lobes and whole materials, drawn from: density, weight, energy, reciprocity.
use durer_core::{
    math::Vector3,
    spectrum::{Basis, Spectrum},
};
use durer_model::bsdf::{BranchKind, Bsdf, Lobe};
use durer_testkit::{DVec3, chi_square::Histogram, quadrature, random::Random};

use super::{
    lobes::{self, coated, frosted, glossy, layered, metal},
    number, seen_from, slow, unit, v,
};

/// One lobe, and some together.
fn bsdfs() -> Vec<(String, Bsdf<'static>)> {
    let of = |lobes: &[Lobe<'static>]| lobes.iter().fold(Bsdf::default(), |bsdf, lobe| bsdf.with(*lobe));
    let mut all: Vec<(String, Bsdf)> =
        lobes::spread().iter().map(|lobe| (format!("{lobe:?}"), of(&[*lobe]))).collect();
    let round = durer_model::bsdf::Facets::round;
    let half = Lobe::Diffuse { albedo: Spectrum::splat(0.5) };
    all.push(("plastic".into(), of(&[coated(0.8, 0.3, 5), metal(round(0.3))])));
    all.push(("varnish".into(), of(&[coated(0.8, 0.0, 5), Lobe::Mirror { weight: Spectrum::splat(0.1) }])));
    all.push(("lacquer".into(), of(&[layered(round(0.2), round(0.3)), metal(round(0.2))])));
    all.push(("leaf".into(), of(&[half, Lobe::Behind { albedo: Spectrum::splat(0.25) }])));
    all.push((
        "window".into(),
        of(&[frosted(1.5, round(0.3)), Lobe::PassThrough { weight: Spectrum::splat(0.2) }]),
    ));
    all.push(("satin".into(), of(&[half, glossy(round(0.25))])));
    all
}

#[test]
fn scattered_directions_have_the_density_they_say() {
    let mut random = Random::new(71);
    let count = if slow() { 200_000 } else { 15_000 };
    let mut tests = Vec::new();
    // Beside other lobes an estimate that happens to be black is no direction.
    for (name, bsdf) in bsdfs().into_iter().filter(|(name, _)| name != "lacquer") {
        for wo in seen_from() {
            let mut histogram = Histogram::default();
            for _ in 0..count {
                match bsdf.scatter(wo, number(&mut random), unit(&mut random)) {
                    Some(s) if s.pdf.is_some() => histogram.add(s.wi.to_f64()),
                    _ => histogram.miss(),
                }
            }
            // What is sharp is a miss: the density counts that it may be chosen.
            let density = |w: DVec3| f64::from(bsdf.eval_with_pdf(wo, v(w)).1);
            tests.push((histogram.p_value(density), format!("{name} {wo:?}")));
        }
    }
    // Sidak: the chance that one of n right densities fails is 1 percent.
    let level = 1.0 - 0.99f64.powf(1.0 / tests.len() as f64);
    assert!(tests.len() > 60);
    for (p, what) in tests {
        assert!(p > level, "p = {p:e} for {what}");
    }
}

#[test]
fn densities_integrate_to_one_at_most() {
    let n = if slow() { 600 } else { 160 };
    for (name, bsdf) in bsdfs() {
        for wo in seen_from() {
            let mass = quadrature::sphere(n, |w| f64::from(bsdf.eval_with_pdf(wo, v(w)).1));
            assert!(mass < 1.02, "{name} {wo:?}: {mass}");
        }
    }
}

#[test]
fn weights_are_the_value_times_cosine_by_density() {
    let mut random = Random::new(72);
    for (name, bsdf) in bsdfs() {
        for wo in seen_from() {
            for _ in 0..200 {
                let Some(s) = bsdf.scatter(wo, number(&mut random), unit(&mut random)) else { continue };
                assert!(s.weight.is_finite() && s.weight.max() >= 0.0 && (s.wi.length() - 1.0).abs() < 1e-4);
                let Some(pdf) = s.pdf else { continue };
                let (f, density) = bsdf.eval_with_pdf(wo, s.wi);
                assert!(pdf > 0.0 && (pdf - density).abs() <= 2e-3 * pdf, "{name} {wo:?} {s:?} {density}");
                let expected = (f * (s.wi.z.abs() / pdf)).mean();
                let off = (expected - s.weight.mean()).abs();
                assert!(off <= 3e-3 * expected.max(0.01), "{name} {wo:?} {s:?}: {expected}");
            }
        }
    }
}

/// Mean weight of the colour that has most, and its standard error; radiance across an interface by what energy it is.
pub(super) fn energy(bsdf: &Bsdf, wo: Vector3, count: u32, random: &mut Random) -> (f64, f64) {
    let (mut sums, mut squares) = ([0.0; 3], [0.0; 3]);
    for _ in 0..count {
        let Some(s) = bsdf.scatter(wo, number(random), unit(random)) else { continue };
        let weights = Basis::Rgb.to_rgb(s.weight / s.compression).map(f64::from);
        for lane in 0..3 {
            sums[lane] += weights[lane];
            squares[lane] += weights[lane] * weights[lane];
        }
    }
    let n = f64::from(count);
    let lane = (0..3).max_by(|a, b| sums[*a].total_cmp(&sums[*b])).unwrap_or(0);
    let mean = sums[lane] / n;
    (mean, ((squares[lane] / n - mean * mean).max(0.0) / n).sqrt())
}

#[test]
fn no_lobe_scatters_more_than_arrives() {
    let mut random = Random::new(73);
    let count = if slow() { 400_000 } else { 20_000 };
    for lobe in lobes::spread().into_iter().chain(lobes::sharp()) {
        // The classic highlight is what its formula is (Whitted 1980).
        if matches!(lobe, Lobe::Highlight(_)) {
            continue;
        }
        for wo in seen_from() {
            let (mean, sigma) = energy(&Bsdf::default().with(lobe), wo, count, &mut random);
            assert!(mean <= 1.0 + 4.0 * sigma + 1e-4, "{lobe:?} {wo:?}: {mean} +- {sigma}");
        }
    }
}

/// The square of the index on the side of `w` of a transparent lobe, relative to its outside.
fn index_squared(lobe: &Lobe, w: Vector3) -> f32 {
    match lobe {
        Lobe::Blurred(blurred) if w.z < 0.0 => blurred.interface.eta * blurred.interface.eta,
        _ => 1.0,
    }
}

#[test]
fn values_are_reciprocal_e5() {
    let mut random = Random::new(74);
    for lobe in lobes::spread() {
        let exempt = match lobe {
            // Not reciprocal by design (Whitted 1980; Cook 1984: the lobe is about the sharp direction of one side).
            Lobe::Highlight(_) | Lobe::Gloss(_) => true,
            Lobe::Blurred(b) => matches!(b.blur, durer_model::bsdf::Blur::Cosine { .. }),
            // An estimate: its mean is.
            Lobe::Layered(_) => true,
            // Attenuated by what `wo` sees (Chiang and others 2016).
            Lobe::Hair(_) => true,
            // Below one direction belongs to one above: only what is kept on the whole is right.
            Lobe::Matte(durer_model::bsdf::Matte::Leaving(_)) => true,
            // About a normal of its own: see below.
            Lobe::Tilted(_) => true,
            // As it was measured, with straight lines in between that follow one direction.
            Lobe::Measured(_) => true,
            _ => false,
        };
        if exempt {
            continue;
        }
        let bsdf = Bsdf::default().with(lobe);
        for _ in 0..2000 {
            let (o, i) = (v(random.direction()), v(random.direction()));
            if o.z.abs().min(i.z.abs()) < 0.02 {
                continue;
            }
            let there = bsdf.eval_radiance(o, i).mean() / index_squared(&lobe, o);
            let back = bsdf.eval_radiance(i, o).mean() / index_squared(&lobe, i);
            // Rounding counts most where facets just let light out.
            assert!(
                (there - back).abs() <= 4e-3 * there.max(back).max(1e-3),
                "{lobe:?} {o:?} {i:?}: {there} {back}"
            );
        }
    }
}

#[test]
fn tilted_layers_are_reciprocal_by_their_own_cosines() {
    let mut random = Random::new(77);
    for lobe in lobes::spread() {
        let Lobe::Tilted(tilted) = lobe else { continue };
        let mut lit = 0;
        for _ in 0..2000 {
            let (o, i) = (v(random.direction()), v(random.direction()));
            let by_own_cosine = |o: Vector3, i: Vector3| {
                let cos = i.dot(tilted.normal) * i.z.signum();
                f64::from(tilted.eval(o, i).mean() * i.z.abs() / cos)
            };
            let (there, back) = (by_own_cosine(o, i), by_own_cosine(i, o));
            assert!((there - back).abs() <= 2e-3 * there.max(back).max(1e-3), "{o:?} {i:?}: {there} {back}");
            lit += u32::from(there > 0.0);
        }
        assert!(lit > 200, "{lit}");
    }
}

#[test]
fn layers_are_reciprocal_in_the_mean() {
    let mut random = Random::new(75);
    let count = if slow() { 400_000 } else { 40_000 };
    for lobe in lobes::spread().into_iter().filter(|l| matches!(l, Lobe::Layered(_))) {
        for (a, b) in [((0.3, 0.1), (-0.35, 0.0)), ((0.8, 0.0), (-0.6, 0.2))] {
            let at = |(x, y): (f64, f64)| DVec3::new(x, y, (1.0 - x * x - y * y).sqrt());
            // Nearly the same directions give other numbers.
            let mut mean = |a: DVec3, b: DVec3| {
                let (mut sum, mut squares) = (0.0, 0.0);
                for _ in 0..count {
                    let near = |w: DVec3, r: &mut Random| v((w + 1e-4 * r.direction()).normalize());
                    let value = f64::from(lobe.eval(near(a, &mut random), near(b, &mut random)).mean());
                    sum += value;
                    squares += value * value;
                }
                let n = f64::from(count);
                (sum / n, (squares / n - (sum / n).powi(2)).max(0.0) / n)
            };
            let ((there, va), (back, vb)) = (mean(at(a), at(b)), mean(at(b), at(a)));
            let sigma = (va + vb).sqrt();
            assert!(
                (there - back).abs() <= 4.0 * sigma + 1e-3 * there,
                "{lobe:?}: {there} {back} +- {sigma}"
            );
        }
    }
}

#[test]
fn scattering_goes_where_it_says() {
    let mut random = Random::new(76);
    for (name, bsdf) in bsdfs() {
        for wo in seen_from() {
            for _ in 0..100 {
                if let Some(s) = bsdf.scatter(wo, number(&mut random), unit(&mut random)) {
                    let same = s.wi.z * wo.z > 0.0;
                    assert_eq!(same, s.kind == BranchKind::Reflection, "{name} {wo:?} {s:?}");
                }
            }
        }
    }
}
