//! Where an instance is, at each moment.
use durer_core::glam::{DAffine3, DMat3, DVec3};
use durer_core::math::{Bounds3, Guide, Motion, Point3, Ray, Transform, Vector3};

use wide::f32x4;

use crate::BuildError;

/// How a geometry is placed in render space.
///
/// ```
/// use durer_accel::Placement;
/// use durer_accel::glam::{DAffine3, DQuat};
/// use durer_accel::math::Motion;
///
/// // A quarter turn in one second, in straight pieces of at most 2 degrees.
/// let quarter = DAffine3::from_quat(DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2));
/// let motion = Motion::keyed(vec![(0.0, DAffine3::IDENTITY), (1.0, quarter)])?;
/// let Placement::Moving(keys) = Placement::from_motion(&motion) else { panic!("it moves") };
/// assert!(keys.len() >= 46);
/// # Ok::<(), &str>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum Placement {
    /// Object space is render space: rays are not transformed at all.
    Identity,
    /// The same `render_from_object` at all times.
    Still(Transform),
    /// `(seconds, render_from_object)` with strictly rising times. Between keys the matrix elements move linearly, so
    /// every point moves on a straight line; before the first and after the last key the placement is held. Where an
    /// interpolated matrix is singular (keys half a turn apart, say) the instance is not hit.
    Moving(Vec<(f32, Transform)>),
}

/// Rotation within one linear segment: the matrix is at most 1 - cos(1 degree) = 0.00015 off the arc.
const SEGMENT_DEGREES: f32 = 2.0;
/// Bounds the memory of one pair of keys: a half turn needs 90.
const SEGMENTS_MAX: f32 = 256.0;

impl Placement {
    /// The same motion in linear pieces of at most 2 degrees of rotation each. Translation and scale alone stay one
    /// piece per pair of keys.
    pub fn from_motion(motion: &Motion) -> Self {
        let keys = motion.keys();
        if motion.is_still() {
            let still = Transform::from_f64(&keys[0].1);
            return if still == Transform::IDENTITY { Self::Identity } else { Self::Still(still) };
        }
        let mut refined: Vec<(f32, Transform)> = Vec::new();
        let mut push = |time: f64, m: &DAffine3| {
            let key = (time as f32, Transform::from_f64(m));
            // Keys closer than f32 can tell apart: the later one holds.
            match refined.last_mut() {
                Some(last) if last.0 >= key.0 => *last = key,
                _ => refined.push(key),
            }
        };
        push(keys[0].0, &keys[0].1);
        for pair in keys.windows(2) {
            let (t0, t1) = (pair[0].0, pair[1].0);
            let n = segments(&pair[0].1, &pair[1].1);
            for i in 1..n {
                let time = t0 + (t1 - t0) * f64::from(i) / f64::from(n);
                push(time, &motion.at(time));
            }
            push(t1, &pair[1].1);
        }
        match refined.as_slice() {
            [(_, only)] => Self::Still(*only),
            _ => Self::Moving(refined),
        }
    }
}

/// Linear segments needed between two keys.
fn segments(a: &DAffine3, b: &DAffine3) -> u32 {
    let degrees = Motion::turn(a, b).to_degrees() as f32;
    // `as` turns NaN (a singular key, refused later) into 0.
    (degrees / SEGMENT_DEGREES).ceil().clamp(1.0, SEGMENTS_MAX) as u32
}

/// A placement checked and made ready for rays.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Pose {
    Identity,
    Still(Transform),
    Moving(Keys),
}

/// Keys of a motion.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Keys {
    /// Seconds, and matrices by rows, as they were given. In f32, for there may be hundreds of thousands.
    pub(crate) keys: Vec<(f32, [[f32; 4]; 3])>,
    /// To the seconds.
    guide: Guide,
}

impl Pose {
    /// Checks `placement` for what will be instance number `instance`.
    pub(crate) fn new(placement: Placement, instance: usize) -> Result<Self, BuildError> {
        let invertible = |key: usize, m: &Transform| {
            if m.is_invertible() { Ok(()) } else { Err(BuildError::TransformSingular { instance, key }) }
        };
        match placement {
            Placement::Identity => Ok(Self::Identity),
            Placement::Still(m) if m == Transform::IDENTITY => Ok(Self::Identity),
            Placement::Still(m) => invertible(0, &m).map(|()| Self::Still(m)),
            Placement::Moving(keys) => {
                let rises = |key: usize| key == 0 || keys[key - 1].0 < keys[key].0;
                for (key, (time, m)) in keys.iter().enumerate() {
                    if !time.is_finite() || !rises(key) {
                        return Err(BuildError::MotionKeyInvalid { instance, key });
                    }
                    invertible(key, m)?;
                }
                match keys.as_slice() {
                    [] => Err(BuildError::MotionKeyInvalid { instance, key: 0 }),
                    [(_, only)] => Self::new(Placement::Still(*only), instance),
                    _ => {
                        let times: Vec<f32> = keys.iter().map(|key| key.0).collect();
                        let keys = keys.iter().map(|(t, m)| (*t, *m.rows())).collect();
                        Ok(Self::Moving(Keys { keys, guide: Guide::new(&times) }))
                    }
                }
            }
        }
    }

    /// Where it stands still; `None` for the identity and what moves.
    pub(crate) fn place(&self) -> Option<Transform> {
        if let Self::Still(m) = self { Some(*m) } else { None }
    }

    /// `render_from_object` at `time` seconds; `None` stands for the identity.
    pub(crate) fn at(&self, time: f32) -> Option<Transform> {
        match self {
            Self::Identity => None,
            Self::Still(m) => Some(*m),
            Self::Moving(keys) => Some(Transform::from_f64(&keys.at(time))),
        }
    }
    /// Whether it stands still and left and right change places.
    pub(crate) fn mirrors(&self) -> bool {
        matches!(self, Self::Still(m) if m.swaps_handedness())
    }
    /// `ray` in object space; `None` stands for the identity.
    pub(crate) fn object_ray(&self, ray: &Ray) -> Option<Ray> {
        match self {
            Self::Identity => None,
            Self::Still(m) => Some(m.ray_back(ray)),
            Self::Moving(keys) => Some(back(&keys.at(ray.time), ray)),
        }
    }
    /// Box around everything an object inside `b` sweeps.
    pub(crate) fn bounds(&self, b: &Bounds3) -> Bounds3 {
        if b.is_empty() {
            return *b;
        }
        // A half-infinite box turned is no box, and one that overflows has lost its far side.
        let of = |m: &Transform| {
            let mapped = m.bounds(b);
            if b.is_finite() && mapped.is_finite() { mapped } else { Bounds3::UNBOUNDED }
        };
        match self {
            Self::Identity => *b,
            Self::Still(m) => of(m),
            Self::Moving(keys) => keys
                .keys
                .iter()
                .fold(Bounds3::EMPTY, |all, k| all.union(of(&Transform::from_f64(&matrix(&k.1))))),
        }
    }
    /// Heap memory held.
    pub(crate) fn bytes(&self) -> usize {
        match self {
            Self::Moving(keys) => size_of_val(keys.keys.as_slice()) + keys.guide.bytes(),
            _ => 0,
        }
    }
}

/// A key's matrix.
pub(crate) fn matrix(rows: &[[f32; 4]; 3]) -> DAffine3 {
    let column = |j: usize| DVec3::new(rows[0][j].into(), rows[1][j].into(), rows[2][j].into());
    DAffine3 { matrix3: DMat3::from_cols(column(0), column(1), column(2)), translation: column(3) }
}

impl Keys {
    /// Element by element between the keys around `time`.
    fn at(&self, time: f32) -> DAffine3 {
        let keys = &self.keys;
        let after = self.guide.upto(time, keys.len(), |i| keys[i].0);
        if after == 0 {
            return matrix(&keys[0].1);
        }
        let (t0, a) = &keys[after - 1];
        let Some((t1, b)) = keys.get(after) else { return matrix(a) };
        let u = f32x4::splat((time - t0) / (t1 - t0));
        let mean = |a: [f32; 4], b: [f32; 4]| {
            let a = f32x4::new(a);
            (a + (f32x4::new(b) - a) * u).to_array()
        };
        matrix(&[mean(a[0], b[0]), mean(a[1], b[1]), mean(a[2], b[2])])
    }
}

/// A ray where `m` is undone, by Cramer's rule; of a singular `m` one that hits nothing. PERF: a rounded inverse would be
/// made for one ray (bench render).
fn back(m: &DAffine3, ray: &Ray) -> Ray {
    let [a, b, c] = [m.matrix3.x_axis, m.matrix3.y_axis, m.matrix3.z_axis];
    let rows = [b.cross(c), c.cross(a), a.cross(b)];
    let inverse = 1.0 / a.dot(rows[0]);
    let map = |v: DVec3| DVec3::new(rows[0].dot(v), rows[1].dot(v), rows[2].dot(v)) * inverse;
    let (o, d) = (map(ray.o.to_f64() - m.translation), map(ray.d.to_f64()));
    Ray { o: Point3::from_f64(o), d: Vector3::from_f64(d), ..*ray }
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_core::glam::DQuat;

    #[test]
    fn a_turn_is_refined_and_a_shift_is_not() {
        let keyed = |b: DAffine3| {
            let motion = Motion::keyed(vec![(0.0, DAffine3::IDENTITY), (1.0, b)]).expect("valid keys");
            match Placement::from_motion(&motion) {
                Placement::Moving(keys) => keys,
                other => panic!("{other:?} does not move"),
            }
        };
        assert_eq!(keyed(DAffine3::from_translation(DVec3::X)).len(), 2);
        assert_eq!(keyed(DAffine3::from_scale(DVec3::new(2.0, 3.0, 4.0))).len(), 2);
        let quarter = keyed(DAffine3::from_quat(DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2)));
        assert!((45..=47).contains(&quarter.len()), "{}", quarter.len());
    }

    #[test]
    fn the_pieces_follow_the_motion() {
        let b = DAffine3::from_scale_rotation_translation(
            DVec3::new(1.0, 2.0, 0.5),
            DQuat::from_rotation_y(3.0),
            DVec3::new(4.0, 0.0, -1.0),
        );
        let motion = Motion::keyed(vec![(1.0, DAffine3::IDENTITY), (2.0, b)]).expect("valid keys");
        let pose = Pose::new(Placement::from_motion(&motion), 0).expect("valid placement");
        for i in 0..=100 {
            let time = 0.9 + 1.2 * i as f32 / 100.0;
            let m = pose.at(time).expect("moves").to_f64();
            let p = DVec3::new(0.3, -0.7, 0.9);
            let off = m.transform_point3(p) - motion.at(time.into()).transform_point3(p);
            assert!(off.length() < 5e-4, "{off} at {time}");
        }
    }

    #[test]
    fn a_ray_is_brought_back_to_where_it_was() {
        let b = DAffine3::from_scale_rotation_translation(
            DVec3::new(1.0, 2.0, 0.5),
            DQuat::from_rotation_y(1.0),
            DVec3::new(4.0, 0.0, -1.0),
        );
        let motion = Motion::keyed(vec![(0.0, DAffine3::IDENTITY), (1.0, b)]).expect("valid keys");
        let pose = Pose::new(Placement::from_motion(&motion), 0).expect("valid placement");
        for i in 0..=20 {
            let time = i as f32 / 20.0;
            let m = pose.at(time).expect("moves");
            let own = Ray { time, ..Ray::new(Point3::new(0.5, 2.0, -3.0), Vector3::new(0.6, 0.0, 0.8)) };
            let back = pose.object_ray(&m.ray(&own)).expect("moves");
            let off = (back.o - own.o).length() + (back.d - own.d).length();
            assert!(off < 1e-4, "{off} at {time}");
        }
    }

    #[test]
    fn stillness_and_identity_are_recognised() {
        assert_eq!(Placement::from_motion(&Motion::still(DAffine3::IDENTITY)), Placement::Identity);
        let shift = DAffine3::from_translation(DVec3::X);
        assert!(matches!(Placement::from_motion(&Motion::still(shift)), Placement::Still(_)));
        let close = Motion::keyed(vec![(1.0, DAffine3::IDENTITY), (1.0 + 1e-12, shift)]).expect("valid keys");
        assert_eq!(Placement::from_motion(&close), Placement::Still(Transform::from_f64(&shift)));
    }
}
