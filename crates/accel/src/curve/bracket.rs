//! One root of a function between two places where its signs differ: Newton's method, halving where that fails.

/// Steps before the bracket is taken as it is: halving alone needs 47 to reach [`NARROW`].
const STEPS: u32 = 64;
/// Smallest step along a curve's parameter that still counts.
const NARROW: f64 = 1e-14;

/// The root of `f` in `[lo, hi]`. `f` returns value and slope; `rising` says that it is negative at `lo` and positive at
/// `hi`, otherwise it is the other way round. Values at the ends themselves are not asked for.
pub(super) fn bracketed(mut lo: f64, mut hi: f64, rising: bool, f: impl Fn(f64) -> (f64, f64)) -> f64 {
    let mut s = lo + (hi - lo) * 0.5;
    let (mut step, mut before) = (hi - lo, hi - lo);
    for _ in 0..STEPS {
        let (value, slope) = f(s);
        if value == 0.0 {
            break;
        }
        if (value > 0.0) == rising {
            hi = s;
        } else {
            lo = s;
        }
        let newton = s - value / slope;
        // False for the NaN and infinity of a vanishing slope. A step that is not half of the one before the last
        // does not converge faster than halving does.
        let good = newton > lo && newton < hi && (newton - s).abs() <= 0.5 * before;
        let next = if good { newton } else { lo + (hi - lo) * 0.5 };
        before = step;
        step = (next - s).abs();
        s = next;
        if step <= NARROW {
            break;
        }
    }
    s
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_are_found_where_newton_alone_would_leave() {
        let far = |s: f64| ((s - 0.3) / (1e-4 + (s - 0.3).abs()), 0.0);
        assert!((bracketed(0.0, 1.0, true, far) - 0.3).abs() < 1e-13, "no slope");
        let triple = |s: f64| (-(s - 0.7).powi(3), -3.0 * (s - 0.7) * (s - 0.7));
        assert!((bracketed(0.0, 1.0, false, triple) - 0.7).abs() < 1e-9, "triple root");
        let root = |s: f64| (s.sqrt() - 0.01, 0.5 / s.sqrt());
        assert!((bracketed(0.0, 1.0, true, root) - 1e-4).abs() < 1e-13, "steep at one end");
        let wild = bracketed(0.0, 1.0, true, |_| (f64::NAN, f64::NAN));
        assert!((0.0..=1.0).contains(&wild));
    }
}
