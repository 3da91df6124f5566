//! Transforms that change over time: keys in f64, interpolated between.
use glam::DAffine3;
use serde::Serialize;

/// A placement in space, still or keyed. Between keys translation and scale move linearly and rotation on the shortest
/// arc (Shoemake 1985); before the first and after the last key the transform is held.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Motion {
    /// `(seconds, transform)`, never empty, times strictly rising.
    keys: Vec<(f64, DAffine3)>,
}

impl Motion {
    /// The same placement at all times.
    pub fn still(transform: DAffine3) -> Self {
        Self { keys: vec![(0.0, transform)] }
    }
    /// From `(seconds, transform)` pairs.
    ///
    /// # Errors
    /// Says what is wrong if there is no key, a time is not finite, or times do not rise strictly.
    pub fn keyed(keys: Vec<(f64, DAffine3)>) -> Result<Self, &'static str> {
        if keys.is_empty() {
            return Err("a motion needs at least one key");
        }
        if keys.iter().any(|k| !k.0.is_finite()) {
            return Err("key times must be finite");
        }
        if keys.windows(2).any(|w| w[0].0 >= w[1].0) {
            return Err("key times must rise");
        }
        Ok(Self { keys })
    }
    /// The keys.
    pub fn keys(&self) -> &[(f64, DAffine3)] {
        &self.keys
    }
    /// True if the placement never changes.
    pub fn is_still(&self) -> bool {
        self.keys.windows(2).all(|w| w[0].1 == w[1].1)
    }
    /// The placement at `time` seconds.
    pub fn at(&self, time: f64) -> DAffine3 {
        let after = self.keys.partition_point(|k| k.0 <= time);
        if after == 0 {
            return self.keys[0].1;
        }
        let (t0, a) = &self.keys[after - 1];
        let Some((t1, b)) = self.keys.get(after) else { return *a };
        let u = (time - t0) / (t1 - t0);
        let (s0, r0, p0) = a.to_scale_rotation_translation();
        let (s1, r1, p1) = b.to_scale_rotation_translation();
        DAffine3::from_scale_rotation_translation(s0.lerp(s1, u), r0.slerp(r1, u), p0.lerp(p1, u))
    }
    /// `parent * self`, key by key.
    pub fn within(&self, parent: &DAffine3) -> Self {
        Self { keys: self.keys.iter().map(|(t, m)| (*t, *parent * *m)).collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DQuat, DVec3};

    #[test]
    fn rotation_moves_on_an_arc_and_is_held_outside() {
        let turn = |a: f64| DAffine3::from_quat(DQuat::from_rotation_y(a));
        let m = Motion::keyed(vec![(1.0, turn(0.0)), (3.0, turn(1.0))]).expect("valid keys");
        let p = m.at(2.0).transform_point3(DVec3::X);
        assert!((p - DQuat::from_rotation_y(0.5) * DVec3::X).length() < 1e-12);
        assert_eq!(m.at(0.0), turn(0.0));
        assert_eq!(m.at(9.0), turn(1.0));
        assert!(!m.is_still() && Motion::still(turn(0.3)).is_still());
    }

    #[test]
    fn bad_keys_are_refused() {
        let i = DAffine3::IDENTITY;
        assert!(Motion::keyed(vec![]).is_err());
        assert!(Motion::keyed(vec![(1.0, i), (1.0, i)]).is_err());
        assert!(Motion::keyed(vec![(f64::NAN, i)]).is_err());
    }
}
