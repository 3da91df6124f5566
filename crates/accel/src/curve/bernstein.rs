//! Polynomials in Bernstein form on `[0, 1]`: `p(s) = sum_i c_i B_i,n(s)`, `N = n + 1` coefficients.
//!
//! Two properties carry everything here: a polynomial lies between its smallest and its largest coefficient, and it has
//! at most as many roots in `(0, 1)` as its coefficients change sign, none more than an even number fewer (Farouki 2012,
//! "The Bernstein polynomial basis: a centennial retrospective"). Halving with de Casteljau's scheme, which only
//! averages and so is stable, makes both sharp: roots are split off until one change of sign is left.
use super::bracket::bracketed;

/// How often an interval is halved in search of roots. Two roots closer than `2^-HALVINGS` count as none.
const HALVINGS: u32 = 30;

/// The coefficients.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bernstein<const N: usize>(pub(super) [f64; N]);

/// One coordinate or the radius of a curve.
pub(super) type Cubic = Bernstein<4>;

/// Numbers in rising order, no more than `N` of them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Roots<const N: usize> {
    s: [f64; N],
    count: usize,
}

impl<const N: usize> Roots<N> {
    const NONE: Self = Self { s: [0.0; N], count: 0 };

    fn push(&mut self, s: f64) {
        // A polynomial of N coefficients has N - 1 roots; only rounding could find more.
        if self.count < N {
            self.s[self.count] = s;
            self.count += 1;
        }
    }
    pub(super) fn as_slice(&self) -> &[f64] {
        &self.s[..self.count]
    }
}

/// `n` over `k`.
fn binomial(n: usize, k: usize) -> f64 {
    const ROWS: [[f64; 9]; 9] = [
        [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [1.0, 2.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [1.0, 3.0, 3.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [1.0, 4.0, 6.0, 4.0, 1.0, 0.0, 0.0, 0.0, 0.0],
        [1.0, 5.0, 10.0, 10.0, 5.0, 1.0, 0.0, 0.0, 0.0],
        [1.0, 6.0, 15.0, 20.0, 15.0, 6.0, 1.0, 0.0, 0.0],
        [1.0, 7.0, 21.0, 35.0, 35.0, 21.0, 7.0, 1.0, 0.0],
        [1.0, 8.0, 28.0, 56.0, 70.0, 56.0, 28.0, 8.0, 1.0],
    ];
    ROWS[n][k]
}

impl<const N: usize> Bernstein<N> {
    pub(super) fn min(&self) -> f64 {
        self.0.iter().fold(f64::INFINITY, |a, b| a.min(*b))
    }
    pub(super) fn max(&self) -> f64 {
        self.0.iter().fold(f64::NEG_INFINITY, |a, b| a.max(*b))
    }
    /// `self + scale other`.
    pub(super) fn plus(&self, scale: f64, other: &Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] + scale * other.0[i]))
    }
    /// The same polynomial with the other sign.
    pub(super) fn negated(&self) -> Self {
        Self(self.0.map(|c| -c))
    }

    /// The product, of `M = N + K - 1` coefficients.
    pub(super) fn times<const K: usize, const M: usize>(&self, other: &Bernstein<K>) -> Bernstein<M> {
        const { assert!(M + 1 == N + K) };
        // Times their binomials, coefficients multiply like those of powers.
        let a: [f64; N] = std::array::from_fn(|i| self.0[i] * binomial(N - 1, i));
        let b: [f64; K] = std::array::from_fn(|j| other.0[j] * binomial(K - 1, j));
        let mut product = [0.0; M];
        for i in 0..N {
            for j in 0..K {
                product[i + j] += a[i] * b[j];
            }
        }
        Bernstein(std::array::from_fn(|k| product[k] / binomial(M - 1, k)))
    }

    /// The derivative, of `M = N - 1` coefficients.
    pub(super) fn derivative<const M: usize>(&self) -> Bernstein<M> {
        const { assert!(M + 1 == N) };
        Bernstein(std::array::from_fn(|i| (self.0[i + 1] - self.0[i]) * (N - 1) as f64))
    }

    /// The value at `s` in `[0, 1]`; exactly the first and last coefficient at 0 and 1.
    pub(super) fn at(&self, s: f64) -> f64 {
        self.with_slope(s).0
    }
    /// Value and first derivative at `s`.
    pub(super) fn with_slope(&self, s: f64) -> (f64, f64) {
        let mut c = self.0;
        for row in (2..N).rev() {
            for i in 0..row {
                c[i] = c[i] * (1.0 - s) + c[i + 1] * s;
            }
        }
        (c[0] * (1.0 - s) + c[1] * s, (c[1] - c[0]) * (N - 1) as f64)
    }

    /// Value, first and second derivative at `s`.
    pub(super) fn jet(&self, s: f64) -> [f64; 3] {
        const { assert!(N >= 3) };
        let mut c = self.0;
        for row in (3..N).rev() {
            for i in 0..row {
                c[i] = c[i] * (1.0 - s) + c[i + 1] * s;
            }
        }
        let n = (N - 1) as f64;
        let second = (c[2] - c[1] - (c[1] - c[0])) * (n * (n - 1.0));
        let (a, b) = (c[0] * (1.0 - s) + c[1] * s, c[1] * (1.0 - s) + c[2] * s);
        [a * (1.0 - s) + b * s, (b - a) * n, second]
    }

    /// The polynomials of `[0, s]` and `[s, 1]`, each as one on `[0, 1]`.
    pub(super) fn split(&self, s: f64) -> (Self, Self) {
        let (mut c, mut below) = (self.0, self.0);
        for row in (1..N).rev() {
            for i in 0..row {
                c[i] = c[i] * (1.0 - s) + c[i + 1] * s;
            }
            below[N - row] = c[0];
        }
        (Self(below), Self(c))
    }
    /// The polynomial of `[a, b]` as one on `[0, 1]`.
    pub(super) fn part(&self, a: f64, b: f64) -> Self {
        let (below, _) = self.split(b);
        if a <= 0.0 { below } else { below.split(a / b).1 }
    }

    /// How often the coefficients change sign, zeros left out.
    fn variations(&self) -> usize {
        let (mut count, mut last) = (0, 0.0);
        for c in self.0.into_iter().filter(|c| *c != 0.0) {
            count += usize::from(last != 0.0 && (c < 0.0) != (last < 0.0));
            last = c;
        }
        count
    }

    /// The simple roots in the open interval `(0, 1)`, rising. Rounding decides whether a double one is found twice, once
    /// or not at all.
    pub(super) fn roots(&self) -> Roots<N> {
        let mut found = Roots::NONE;
        self.isolate(0.0, 1.0, HALVINGS, &mut found);
        found
    }

    fn isolate(&self, lo: f64, hi: f64, halvings: u32, found: &mut Roots<N>) {
        let middle = lo + (hi - lo) * 0.5;
        match self.variations() {
            0 => {}
            1 => found.push(lo + (hi - lo) * self.only_root()),
            _ if halvings == 0 => {
                if (self.0[0] < 0.0) != (self.0[N - 1] < 0.0) {
                    found.push(middle);
                }
            }
            _ => {
                let (below, above) = self.split(0.5);
                below.isolate(lo, middle, halvings - 1, found);
                // Neither half has a root at its ends.
                if above.0[0] == 0.0 {
                    found.push(middle);
                }
                above.isolate(middle, hi, halvings - 1, found);
            }
        }
    }

    /// The root of a polynomial whose coefficients change sign once.
    fn only_root(&self) -> f64 {
        let rising = self.0.iter().find(|c| **c != 0.0).is_some_and(|c| *c < 0.0);
        bracketed(0.0, 1.0, rising, |s| self.with_slope(s))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `prod (s - r_i)`.
    fn from_roots(r: [f64; 6]) -> Bernstein<7> {
        let line = |r: f64| Bernstein([-r, 1.0 - r]);
        let two: Bernstein<3> = line(r[0]).times(&line(r[1]));
        let three: Bernstein<4> = two.times(&line(r[2]));
        let four: Bernstein<5> = three.times(&line(r[3]));
        let five: Bernstein<6> = four.times(&line(r[4]));
        five.times(&line(r[5]))
    }

    #[test]
    fn the_roots_of_a_product_of_lines_are_those_of_its_factors() {
        for r in [
            [0.1, 0.25, 0.4, 0.5, 0.75, 0.9],
            [-1.0, 0.5, 2.0, 0.501, 0.75, 7.0],
            [0.125, 0.3, 0.300001, 1.5, -0.1, 0.99],
        ] {
            let mut expected: Vec<f64> = r.into_iter().filter(|r| *r > 0.0 && *r < 1.0).collect();
            expected.sort_by(f64::total_cmp);
            let found = from_roots(r).roots();
            assert_eq!(found.as_slice().len(), expected.len(), "{r:?}: {found:?}");
            for (a, b) in found.as_slice().iter().zip(&expected) {
                assert!((a - b).abs() < 1e-9, "{r:?}: {found:?}");
            }
        }
    }

    #[test]
    fn nothing_is_found_at_the_ends_and_little_where_zero_is_touched() {
        for r in [0.3, 0.25, 0.7] {
            let found = from_roots([r, r, 2.0, 3.0, 4.0, 5.0]).roots();
            assert!(found.as_slice().len() <= 2 && found.as_slice().iter().all(|s| (s - r).abs() < 1e-6));
        }
        assert!(from_roots([0.0, 1.0, 2.0, 3.0, 4.0, 5.0]).roots().as_slice().is_empty());
        assert!(Bernstein([0.0; 7]).roots().as_slice().is_empty());
    }

    #[test]
    fn parts_values_and_slopes_agree() {
        let p = Bernstein([1.0, -2.0, 0.5, 3.0]);
        let power = |s: f64| 1.0 - 9.0 * s + 16.5 * s * s - 5.5 * s * s * s;
        let part = p.part(0.25, 0.75);
        for i in 0..=8 {
            let s = f64::from(i) / 8.0;
            assert!((p.at(s) - power(s)).abs() < 1e-14);
            assert!((part.at(s) - power(0.25 + 0.5 * s)).abs() < 1e-14);
            let slope = -9.0 + 33.0 * s - 16.5 * s * s;
            assert!((p.with_slope(s).1 - slope).abs() < 1e-13);
            assert!((p.derivative::<3>().at(s) - slope).abs() < 1e-13);
            let (bend, jet) = (33.0 - 33.0 * s, p.jet(s));
            assert!((jet[0] - power(s)).abs() < 1e-14 && (jet[1] - slope).abs() < 1e-13);
            assert!((jet[2] - bend).abs() < 1e-12);
        }
    }
}
