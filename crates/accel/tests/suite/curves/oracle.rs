//! Curves again, slowly: textbook blending in world space, f64, and distances by dense sampling.
use durer_accel::curve::{CurveBasis, CurveHit, Curves};
use durer_core::{glam::DVec3, math::Ray};

/// Samples along a segment before refining.
const SAMPLES: u32 = 256;

/// Centre and radius at `s`, by the polynomials that define each basis.
pub(super) fn at(curves: &Curves, segment: u32, s: f64) -> (DVec3, f64) {
    let first = curves.segments[segment as usize] as usize;
    let (s2, s3, w) = (s * s, s * s * s, 1.0 - s);
    let blend = match curves.basis {
        CurveBasis::Bezier => vec![w * w * w, 3.0 * w * w * s, 3.0 * w * s2, s3],
        CurveBasis::BSpline => {
            [w * w * w, 3.0 * s3 - 6.0 * s2 + 4.0, -3.0 * s3 + 3.0 * s2 + 3.0 * s + 1.0, s3]
                .map(|b| b / 6.0)
                .to_vec()
        }
        CurveBasis::CatmullRom => {
            [-s + 2.0 * s2 - s3, 2.0 - 5.0 * s2 + 3.0 * s3, s + 4.0 * s2 - 3.0 * s3, -s2 + s3]
                .map(|b| b / 2.0)
                .to_vec()
        }
        CurveBasis::Linear => vec![w, s],
    };
    blend.iter().enumerate().fold((DVec3::ZERO, 0.0), |(p, r), (i, b)| {
        (p + *b * curves.points[first + i].to_f64(), r + *b * f64::from(curves.radii[first + i]))
    })
}

/// The curve's derivative at `s`, by central differences.
pub(super) fn heading(curves: &Curves, segment: u32, s: f64) -> DVec3 {
    let (a, b) = ((s - 1e-5).max(0.0), (s + 1e-5).min(1.0));
    (at(curves, segment, b).0 - at(curves, segment, a).0) / (b - a)
}

/// The least of `f` on `[0, 1]`, and where: sampled, then the best brackets refined by golden section.
fn least(f: impl Fn(f64) -> f64) -> (f64, f64) {
    let values: Vec<f64> = (0..=SAMPLES).map(|i| f(f64::from(i) / f64::from(SAMPLES))).collect();
    let best = values.iter().copied().fold(f64::INFINITY, f64::min);
    let mut found = (best, 0.0);
    for i in 0..values.len() {
        let (before, after) = (i.saturating_sub(1), (i + 1).min(values.len() - 1));
        if values[i] > values[before] || values[i] > values[after] {
            continue;
        }
        let golden = 0.618_033_988_749_895;
        let (mut lo, mut hi) = (before as f64 / f64::from(SAMPLES), after as f64 / f64::from(SAMPLES));
        for _ in 0..60 {
            let (a, b) = (hi - golden * (hi - lo), lo + golden * (hi - lo));
            if f(a) < f(b) { hi = b } else { lo = a }
        }
        for s in [lo, hi, i as f64 / f64::from(SAMPLES)] {
            if f(s) <= found.0 {
                found = (f(s), s);
            }
        }
    }
    found
}

/// Signed distance to the union of balls: exact outside, and never too large in magnitude inside.
pub(super) fn distance(curves: &Curves, segment: u32, p: DVec3) -> f64 {
    least(|s| {
        let (c, r) = at(curves, segment, s);
        (p - c).length() - r
    })
    .0
}

/// What the ray meets the round segment within: the largest radius times 2e-6, and the rounding of `t`.
pub(super) fn tolerance(curves: &Curves, segment: u32, ray: &Ray, t: f64) -> f64 {
    let r = (0..=16).fold(0f64, |r, i| r.max(at(curves, segment, f64::from(i) / 16.0).1));
    2e-6 * r + 1.2e-7 * t.abs() * ray.d.to_f64().length()
}

/// Checks a round hit, or that there is none, by tracing spheres along the ray: it lies on the surface, `u` and `n_g`
/// name that place, and the ray does not change sides before.
pub(super) fn assert_round(curves: &Curves, segment: u32, ray: &Ray, hit: Option<CurveHit>) {
    let (o, d) = (ray.o.to_f64(), ray.d.to_f64());
    let length = d.length();
    let bounds = curves.bounds(segment);
    let away = (bounds.center().to_f64() - o).length() + bounds.diagonal().to_f64().length();
    let end = hit.map_or(away / length, |h| f64::from(h.t));
    if let Some(h) = hit {
        let (p, allowed) = (o + d * end, tolerance(curves, segment, ray, end));
        let off = distance(curves, segment, p);
        assert!(off.abs() <= allowed, "{curves:?} {ray:?} {h:?}: {off} from the surface");
        let (c, r) = at(curves, segment, h.u.into());
        let named = (c + h.n_g.to_f64() * r - p).length();
        let moved = 1e-7 * heading(curves, segment, h.u.into()).length();
        assert!(named <= 2.0 * allowed + 3e-7 * r + moved, "{curves:?} {ray:?} {h:?}: {named} off");
        let grown = 1e-6 * (p.abs().max_element() + r) + allowed;
        let (min, max) = (bounds.min.to_f64() - grown, bounds.max.to_f64() + grown);
        assert!(p.cmpge(min).all() && p.cmple(max).all(), "{h:?} outside of {bounds:?}");
    }
    let mut t = f64::from(ray.t_min).max(0.0);
    let side = distance(curves, segment, o + d * t);
    for _ in 0..3000 {
        let (here, allowed) = (distance(curves, segment, o + d * t), tolerance(curves, segment, ray, t));
        let crossed = here * side.signum() < -allowed && side.abs() > allowed;
        // Behind the hit by more than rounding is no longer before it.
        t += here.abs().max(0.5 * allowed) / length;
        if t >= end {
            return;
        }
        assert!(!crossed, "{curves:?} {ray:?} {hit:?}: crosses at {t}");
    }
    // So many steps only happen along the surface.
}
