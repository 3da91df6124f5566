//! The current transformation, as it changes over time.
//!
//! pbrt keeps two matrices, one for the start and one for the end of the shutter interval; `ActiveTransform` says which
//! of them the directives change. They multiply from the right (`CTM * M`). Our `TransformKeys` multiplies by a motion
//! with keys of its own: the current transformation is then a product of pairs and motions, which becomes one motion,
//! with a key wherever a factor has one, where it is used.
use std::sync::Arc;

use durer_core::{glam::DAffine3, math::Motion};

/// The matrices at the two transform times.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Pair {
    start: DAffine3,
    end: DAffine3,
}

impl Pair {
    const IDENTITY: Self = Self { start: DAffine3::IDENTITY, end: DAffine3::IDENTITY };

    fn is_still(&self) -> bool {
        self.start == self.end
    }
    fn inverse(&self) -> Self {
        Self { start: self.start.inverse(), end: self.end.inverse() }
    }
    fn compose(&self, inner: &Self) -> Self {
        Self { start: self.start * inner.start, end: self.end * inner.end }
    }
    /// As keys at `times`; one key if it does not move.
    fn motion(&self, times: (f64, f64)) -> Motion {
        let still = Motion::still(self.start);
        if self.is_still() {
            return still;
        }
        Motion::keyed(vec![(times.0, self.start), (times.1, self.end)]).unwrap_or(still)
    }
}

/// Shared, because every shape and every block has a copy; `None` for none, which costs nothing.
type Factors = Option<Arc<[(Pair, Arc<Motion>)]>>;

/// `world_from_current`: the product of all factors, from the left, and of the last pair.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Placement {
    /// What stands before each use of `TransformKeys`, and what that gave.
    factors: Factors,
    last: Pair,
    /// The way back from the two matrices of `last`, where that was written instead of them.
    back: [Option<DAffine3>; 2],
}

impl Placement {
    /// Where the world is.
    pub(super) fn identity() -> Self {
        Self { factors: None, last: Pair::IDENTITY, back: [None; 2] }
    }

    fn factors(&self) -> &[(Pair, Arc<Motion>)] {
        self.factors.as_deref().unwrap_or_default()
    }

    /// The way back. Every matrix was checked when it came about.
    pub(super) fn inverse(&self) -> Self {
        let [start, end] = self.back;
        let mut before = self.last.inverse();
        before = Pair { start: start.unwrap_or(before.start), end: end.unwrap_or(before.end) };
        let mut factors = Vec::with_capacity(self.factors().len());
        for (pair, motion) in self.factors().iter().rev() {
            let keys = motion.keys().iter().map(|(t, m)| (*t, m.inverse())).collect();
            let back = Motion::keyed(keys).map_or_else(|_| Arc::clone(motion), Arc::new);
            factors.push((std::mem::replace(&mut before, pair.inverse()), back));
        }
        Self { factors: (!factors.is_empty()).then(|| factors.into()), last: before, back: [None; 2] }
    }

    /// `self * inner`: something placed within something placed.
    pub(super) fn compose(&self, inner: &Self) -> Self {
        let Some(((pair, motion), others)) = inner.factors().split_first() else {
            let last = self.last.compose(&inner.last);
            return Self { factors: self.factors.clone(), last, back: [None; 2] };
        };
        let joint = (self.last.compose(pair), Arc::clone(motion));
        let factors = self.factors().iter().cloned().chain([joint]).chain(others.iter().cloned());
        Self { factors: Some(factors.collect()), last: inner.last, back: inner.back }
    }

    /// `self * motion`.
    pub(super) fn keyed(&self, motion: Motion) -> Self {
        let factor = (self.last, Arc::new(motion));
        let factors = Some(self.factors().iter().cloned().chain([factor]).collect());
        Self { factors, last: Pair::IDENTITY, back: [None; 2] }
    }

    /// How often `TransformKeys` was used.
    pub(super) fn depth(&self) -> usize {
        self.factors().len()
    }

    /// `self * m` where `active`.
    ///
    /// # Errors
    /// If the product cannot be inverted.
    pub(super) fn times(&self, active: Active, m: &DAffine3) -> Result<Self, &'static str> {
        self.changed(active, |old| *old * *m)
    }

    /// `m` where `active`; `times` are those of the two matrices.
    ///
    /// # Errors
    /// If it cannot be inverted.
    pub(super) fn with(&self, active: Active, m: &DAffine3, times: (f64, f64)) -> Result<Self, &'static str> {
        let time = match active {
            Active::All => return Self::identity().changed(active, |_| *m),
            Active::Start => times.0,
            Active::End => times.1,
        };
        // Only the pairs have a start and an end: the last one makes up for what stands before it.
        let before = self.before(time, times).inverse();
        self.changed(active, |_| before * *m)
    }

    /// The inverse of `m` where `active`; going back from there leads to `m` itself, without rounding.
    ///
    /// # Errors
    /// If it has none.
    pub(super) fn with_inverse(
        &self,
        active: Active,
        m: &DAffine3,
        times: (f64, f64),
    ) -> Result<Self, &'static str> {
        if !is_invertible(m) {
            return Err(SINGULAR);
        }
        let mut new = self.with(active, &m.inverse(), times)?;
        if new.factors.is_none() {
            let [start, end] = &mut new.back;
            *start = if active == Active::End { *start } else { Some(*m) };
            *end = if active == Active::Start { *end } else { Some(*m) };
        }
        Ok(new)
    }

    fn changed(&self, active: Active, change: impl Fn(&DAffine3) -> DAffine3) -> Result<Self, &'static str> {
        let (mut last, [mut start, mut end]) = (self.last, self.back);
        if active != Active::End {
            last.start = change(&last.start);
            start = None;
        }
        if active != Active::Start {
            last.end = change(&last.end);
            end = None;
        }
        let sound = is_invertible(&last.start) && is_invertible(&last.end);
        if sound {
            Ok(Self { factors: self.factors.clone(), last, back: [start, end] })
        } else {
            Err(SINGULAR)
        }
    }

    /// The product of all but the last pair at `time`.
    fn before(&self, time: f64, times: (f64, f64)) -> DAffine3 {
        let at = |(pair, motion): &(Pair, Arc<Motion>)| pair.motion(times).at(time) * motion.at(time);
        self.factors().iter().fold(DAffine3::IDENTITY, |product, factor| product * at(factor))
    }

    /// The matrix at `time`.
    pub(super) fn at(&self, time: f64, times: (f64, f64)) -> DAffine3 {
        self.before(time, times) * self.last.motion(times).at(time)
    }

    /// As one motion; `times` are those of the two matrices of each pair.
    pub(super) fn motion(&self, times: (f64, f64)) -> Motion {
        if self.factors.is_none() {
            return self.last.motion(times);
        }
        let pairs = self.factors().iter().map(|f| &f.0).chain([&self.last]);
        let mut moments: Vec<f64> = self.factors().iter().flat_map(|f| f.1.keys()).map(|key| key.0).collect();
        if pairs.into_iter().any(|pair| !pair.is_still()) {
            moments.extend([times.0, times.1]);
        }
        moments.sort_by(f64::total_cmp);
        moments.dedup();
        let keys: Vec<_> = moments.into_iter().map(|time| (time, self.at(time, times))).collect();
        let still = Motion::still(self.at(times.0, times));
        let motion = Motion::keyed(keys).unwrap_or_else(|_| still.clone());
        if motion.is_still() { still } else { motion }
    }
}

/// Which matrices a directive changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Active {
    /// `ActiveTransform StartTime`
    Start,
    /// `ActiveTransform EndTime`
    End,
    /// `ActiveTransform All`
    All,
}

impl Active {
    /// The words of the language.
    pub(super) const WORDS: [(&str, Self); 3] =
        [("StartTime", Self::Start), ("EndTime", Self::End), ("All", Self::All)];
}

const SINGULAR: &str =
    "this makes the current transformation singular: it has no inverse, so shapes would be flat";

/// True if the matrix is finite and has a finite inverse.
pub(super) fn is_invertible(m: &DAffine3) -> bool {
    if !m.is_finite() {
        return false;
    }
    let lengths = m.matrix3.x_axis.length() * m.matrix3.y_axis.length() * m.matrix3.z_axis.length();
    let det = m.matrix3.determinant().abs();
    // Relative to the columns, so that a small scale is no reason; rounding leaves about 1e-16 of a singular one.
    det > 1e-15 * lengths && m.inverse().is_finite()
}

#[cfg(test)]
#[expect(clippy::expect_used, reason = "a test may panic")]
mod tests {
    use super::*;
    use durer_core::glam::DVec3;

    const TIMES: (f64, f64) = (0.0, 1.0);

    fn shift(x: f64) -> DAffine3 {
        DAffine3::from_translation(DVec3::X * x)
    }

    #[test]
    fn what_has_no_inverse_is_refused() {
        let times = |m: DAffine3| Placement::identity().times(Active::All, &m);
        assert!(times(DAffine3::from_scale(DVec3::new(1.0, 0.0, 1.0))).is_err());
        assert!(times(DAffine3::from_scale(DVec3::new(1e-20, 1e-30, 1e-20))).is_ok());
        assert!(times(DAffine3::from_scale(DVec3::splat(1e200))).is_err());
    }

    #[test]
    fn only_active_matrices_change() {
        let p = Placement::identity().times(Active::End, &shift(1.0)).expect("invertible");
        assert_eq!((p.last.start.translation, p.last.end.translation), (DVec3::ZERO, DVec3::X));
        let motion = p.motion((2.0, 4.0));
        assert_eq!(motion.keys().iter().map(|k| k.0).collect::<Vec<_>>(), [2.0, 4.0]);
        assert_eq!(Placement::identity().motion(TIMES).keys().len(), 1);
    }

    #[test]
    fn products_have_the_keys_of_all_factors_and_inverses_undo_them() {
        let keys = vec![(0.25, shift(0.0)), (0.5, DAffine3::from_rotation_z(1.0)), (2.0, shift(3.0))];
        let p = Placement::identity().times(Active::End, &shift(4.0)).expect("invertible");
        let p =
            p.keyed(Motion::keyed(keys).expect("keys")).times(Active::All, &shift(7.0)).expect("invertible");
        let motion = p.motion(TIMES);
        assert_eq!(motion.keys().iter().map(|k| k.0).collect::<Vec<_>>(), [0.0, 0.25, 0.5, 1.0, 2.0]);
        let back = p.inverse();
        for time in [-1.0, 0.0, 0.25, 0.5, 2.0] {
            // At half time the pair has moved by 2, the motion turns by 1, the shift of 7 goes along.
            let both = p.at(time, TIMES) * back.at(time, TIMES);
            assert!(both.abs_diff_eq(DAffine3::IDENTITY, 1e-12), "{time}: {both:?}");
        }
        let expected = DVec3::new(2.0 + 7.0 * 1f64.cos(), 7.0 * 1f64.sin(), 0.0);
        assert!((p.at(0.5, TIMES).translation - expected).length() < 1e-12);
        // Within another, whose own keys join.
        let outer = Placement::identity()
            .keyed(Motion::keyed(vec![(0.1, shift(1.0)), (0.7, shift(2.0))]).expect("keys"));
        let both = outer.compose(&p);
        assert_eq!(both.motion(TIMES).keys().len(), 7);
        assert!((both.at(0.5, TIMES).translation - expected - DVec3::X * (1.0 + 0.4 / 0.6)).length() < 1e-12);
    }

    #[test]
    fn setting_one_time_holds_there_also_behind_keys() {
        let keys = vec![(0.0, shift(1.0)), (1.0, shift(5.0))];
        let p = Placement::identity().keyed(Motion::keyed(keys).expect("keys"));
        let p = p.with(Active::End, &shift(9.0), TIMES).expect("invertible");
        assert_eq!([0.0, 1.0].map(|t| p.at(t, TIMES).translation.x), [1.0, 9.0]);
        let p = p.with(Active::All, &shift(2.0), TIMES).expect("invertible");
        assert_eq!(p, Placement::identity().times(Active::All, &shift(2.0)).expect("invertible"));
    }
}
