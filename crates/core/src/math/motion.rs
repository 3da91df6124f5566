//! Transforms that change over time: keys in f64, interpolated between.
use glam::{DAffine3, DMat3, DQuat, DVec3};
use serde::Serialize;

/// A placement in space, still or keyed. Between keys translation and stretch (scale and shear) move linearly and
/// rotation on the shortest arc (Shoemake 1985); before the first and after the last key the transform is held.
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
        if *t0 == time {
            return *a;
        }
        let Some((t1, b)) = self.keys.get(after) else { return *a };
        let u = (time - t0) / (t1 - t0);
        let (from, to) = (Parts::of(a), Parts::of(b));
        let stretch = from.stretch * (1.0 - u) + to.stretch * u;
        DAffine3 {
            matrix3: DMat3::from_quat(from.rotation.slerp(to.rotation, u)) * stretch,
            translation: from.translation.lerp(to.translation, u),
        }
    }
    /// The angle of the turn between two placements, in radians.
    pub fn turn(a: &DAffine3, b: &DAffine3) -> f64 {
        let (a, b) = (Parts::of(a).rotation, Parts::of(b).rotation);
        // 2 asin(|a - b| / 2) and not acos(a.b), which cannot tell small angles from none.
        let apart = (a - b).length().min((a + b).length());
        4.0 * libm::asin((apart * 0.5).min(1.0))
    }
    /// `parent * self`, key by key.
    pub fn within(&self, parent: &DAffine3) -> Self {
        Self { keys: self.keys.iter().map(|(t, m)| (*t, *parent * *m)).collect() }
    }
}

/// `translation * rotation * stretch`, the polar decomposition (Shoemake and Duff 1992, "Matrix Animation and Polar
/// Decomposition"). A mirroring is part of the stretch.
struct Parts {
    translation: DVec3,
    rotation: DQuat,
    stretch: DMat3,
}

impl Parts {
    fn of(m: &DAffine3) -> Self {
        let linear = m.matrix3;
        let mut r = linear;
        // Newton's iteration to the nearest orthogonal matrix: doubles the correct digits each time. A singular matrix
        // has none; the result is then not finite, and refused where placements are checked.
        for _ in 0..100 {
            let next = (r + r.inverse().transpose()) * 0.5;
            let done = next.abs_diff_eq(r, 1e-14);
            r = next;
            if done {
                break;
            }
        }
        let r = if r.determinant() < 0.0 { r * -1.0 } else { r };
        Self {
            translation: m.translation,
            rotation: DQuat::from_mat3(&r).normalize(),
            stretch: r.transpose() * linear,
        }
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
    fn shear_and_mirroring_survive_between_equal_keys() {
        let sheared = DAffine3::from_scale(DVec3::new(2.0, 1.0, 1.0)) * DAffine3::from_rotation_z(0.8);
        for m in [sheared, sheared * DAffine3::from_scale(DVec3::new(1.0, -3.0, 1.0))] {
            let moved = DAffine3::from_translation(DVec3::X) * m;
            let motion = Motion::keyed(vec![(0.0, m), (1.0, moved)]).expect("valid keys");
            for u in [1e-9, 0.25, 0.5, 1.0 - 1e-9] {
                let expected = DAffine3::from_translation(DVec3::X * u) * m;
                assert!(motion.at(u).abs_diff_eq(expected, 1e-12), "{u}: {} {expected}", motion.at(u));
            }
        }
    }

    #[test]
    fn the_turn_between_placements_is_that_of_their_rotations() {
        let stretched = DAffine3::from_scale(DVec3::new(1.0, 2.0, 3.0));
        for angle in [0.0, 1e-6, 0.7, 3.0] {
            let turned = DAffine3::from_rotation_y(angle) * stretched;
            assert!((Motion::turn(&stretched, &turned) - angle).abs() < 1e-9, "{angle}");
        }
    }

    #[test]
    fn bad_keys_are_refused() {
        let i = DAffine3::IDENTITY;
        assert!(Motion::keyed(vec![]).is_err());
        assert!(Motion::keyed(vec![(1.0, i), (1.0, i)]).is_err());
        assert!(Motion::keyed(vec![(f64::NAN, i)]).is_err());
    }
}
