//! Where a light is, at each moment.
//!
//! Between keys matrix elements move linearly, as the kernel moves instances: given the keys that the kernel has, a light
//! is exactly where rays find its shape.
use durer_core::{
    glam::{DAffine3, DMat3},
    math::{Bounds3, Point3, Transform, Vector3},
};

use super::Cone;

/// The placement of a light in render space, still or moving.
#[derive(Clone, Debug, PartialEq)]
pub struct Track {
    first: DAffine3,
    /// `(seconds, placement)` from the first on; empty if it stands still.
    keys: Vec<(f32, DAffine3)>,
}

impl Track {
    /// The same placement at all times.
    pub fn still(render_from_light: DAffine3) -> Self {
        Self { first: render_from_light, keys: Vec::new() }
    }
    /// From `(seconds, placement)` with rising times, of which there is at least one; it is held before the first and
    /// after the last. The identity if there is none.
    pub fn keyed(keys: Vec<(f32, DAffine3)>) -> Self {
        match keys.as_slice() {
            [] => Self::still(DAffine3::IDENTITY),
            [(_, only)] => Self::still(*only),
            [(_, first), ..] => Self { first: *first, keys },
        }
    }
    /// True if the placement never changes.
    pub fn is_still(&self) -> bool {
        self.keys.is_empty()
    }
    /// All placements between which it moves.
    pub fn stations(&self) -> impl Iterator<Item = &DAffine3> {
        std::iter::once(&self.first).chain(self.keys.iter().skip(1).map(|(_, m)| m))
    }
    /// The placement at `time` seconds.
    pub fn at(&self, time: f32) -> DAffine3 {
        let after = self.keys.partition_point(|key| key.0 <= time);
        let Some((t0, a)) = after.checked_sub(1).map(|i| self.keys[i]) else { return self.first };
        let Some((t1, b)) = self.keys.get(after) else { return a };
        let u = f64::from(time - t0) / f64::from(t1 - t0);
        let (m, n) = (&a.matrix3, &b.matrix3);
        let column = |from: durer_core::glam::DVec3, to| from.lerp(to, u);
        DAffine3 {
            matrix3: DMat3::from_cols(
                column(m.x_axis, n.x_axis),
                column(m.y_axis, n.y_axis),
                column(m.z_axis, n.z_axis),
            ),
            translation: column(a.translation, b.translation),
        }
    }
}

impl From<Transform> for Track {
    fn from(render_from_light: Transform) -> Self {
        Self::still(render_from_light.to_f64())
    }
}

/// A point with a direction that a track carries along: what places a light without extent.
#[derive(Clone, Debug)]
pub(super) struct Anchor {
    position: Point3,
    direction: Vector3,
    /// Not yet applied to the two; `None` for what stands still.
    track: Option<Track>,
}

impl Anchor {
    /// At `position`, pointing along unit `direction`.
    pub(super) fn new(position: Point3, direction: Vector3) -> Self {
        Self { position, direction, track: None }
    }
    /// Moves it from the light's own space into render space.
    pub(super) fn place(&mut self, track: &Track) {
        if track.is_still() {
            (self.position, self.direction) = self.moved(&track.at(0.0));
        } else {
            self.track = Some(track.clone());
        }
    }
    /// Position and unit direction at `time` seconds.
    pub(super) fn at(&self, time: f32) -> (Point3, Vector3) {
        match &self.track {
            None => (self.position, self.direction),
            Some(track) => self.moved(&track.at(time)),
        }
    }
    /// A box around it at all times.
    pub(super) fn bounds(&self) -> Bounds3 {
        match &self.track {
            None => Bounds3::around([self.position]),
            Some(track) => Bounds3::around(track.stations().map(|m| self.moved(m).0)),
        }
    }
    /// All directions within `angle` of the one it points along, at all times.
    pub(super) fn directions(&self, angle: f32) -> Cone {
        let still = |m: &DAffine3| m.matrix3 == DMat3::IDENTITY;
        match &self.track {
            None => Cone { axis: self.direction, angle },
            Some(track) if track.stations().all(still) => Cone { axis: self.direction, angle },
            // Between two directions it may pass any other.
            Some(_) => Cone::ALL,
        }
    }
    /// The position, if it stands still.
    pub(super) fn still(&self) -> Option<Point3> {
        self.track.is_none().then_some(self.position)
    }
    fn moved(&self, m: &DAffine3) -> (Point3, Vector3) {
        let p = Point3::from_f64(m.transform_point3(self.position.to_f64()));
        (p, Vector3::from_f64(m.transform_vector3(self.direction.to_f64()).normalize()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_core::glam::DVec3;

    #[test]
    fn what_a_track_carries_moves_evenly_between_keys_and_is_held_outside() {
        let shift = |x: f64| DAffine3::from_translation(DVec3::X * x);
        let mut anchor = Anchor::new(Point3::new(0.0, 1.0, 0.0), Vector3::new(0.0, 0.0, 1.0));
        anchor.place(&Track::keyed(vec![(1.0, shift(0.0)), (2.0, shift(4.0)), (4.0, shift(0.0))]));
        for (time, x) in [(0.0, 0.0), (1.0, 0.0), (1.25, 1.0), (2.0, 4.0), (3.0, 2.0), (9.0, 0.0)] {
            assert_eq!(anchor.at(time), (Point3::new(x, 1.0, 0.0), Vector3::new(0.0, 0.0, 1.0)), "{time}");
        }
    }
}
