//! Instances that move: a tree for each stretch of time, whose boxes move with them.
use durer_core::math::{Bounds3, Transform, Vector3};

use super::subject::Stretch;
use crate::{
    accel::{Instance, Movers},
    placement::{Keys, Pose},
    slab::{extent, grown},
};

/// Most trees for the time in which things move.
const STRETCHES_MAX: usize = 8;

/// The moments at which stretches begin and end.
pub(super) fn times(instances: &[Instance], moving: &[u32]) -> Vec<f32> {
    let (mut first, mut last, mut pieces) = (f32::INFINITY, f32::NEG_INFINITY, 1);
    for &index in moving {
        if let Pose::Moving(Keys { keys, .. }) = &instances[index as usize].pose {
            first = first.min(keys.first().map_or(first, |key| key.0));
            last = last.max(keys.last().map_or(last, |key| key.0));
            pieces = pieces.max(keys.len() - 1);
        }
    }
    let count = pieces.min(STRETCHES_MAX);
    let mut times: Vec<f32> =
        (0..=count).map(|i| first + (last - first) * (i as f32 / count as f32)).collect();
    // Keys may lie closer together than this arithmetic can tell apart.
    times.dedup();
    if times.len() == 1 {
        times.push(times[0] + 1.0);
    }
    times
}

/// The box of a thing with box `object` and this pose, from moment `a` to moment `b`: at each time between it lies in the
/// mean of the two boxes, weighted by time.
///
/// Between keys each corner moves on a straight line, so that the lower planes, minima of straight lines, lie above the
/// line between their ends. A key inside the stretch may lie below it: then both ends go out by as much.
pub(super) fn stretch(pose: &Pose, object: &Bounds3, a: f32, b: f32) -> Stretch {
    let at = |time: f32| pose.at(time).unwrap_or(Transform::IDENTITY).bounds(object);
    let (start, end) = (at(a), at(b));
    let (mut low, mut high) = ([0f32; 3], [0f32; 3]);
    let inside = |time: &f32| a < *time && *time < b;
    let keys: Vec<f32> = match pose {
        Pose::Moving(keys) => keys.keys.iter().map(|key| key.0).filter(inside).collect(),
        Pose::Identity | Pose::Still(_) => Vec::new(),
    };
    for time in keys {
        let (u, knot) = ((time - a) / (b - a), at(time));
        for axis in 0..3 {
            let mean = |x: f32, y: f32| x * (1.0 - u) + y * u;
            low[axis] = low[axis].max(mean(start.min[axis], end.min[axis]) - knot.min[axis]);
            high[axis] = high[axis].max(knot.max[axis] - mean(start.max[axis], end.max[axis]));
        }
    }
    [start, end].map(|b| {
        let out = Bounds3 { min: b.min - Vector3::from(low), max: b.max + Vector3::from(high) };
        grown(&out, extent(&out))
    })
}

impl Movers {
    /// The box of mover `number` at `time`, as its own test sees it.
    pub(crate) fn own_box(&self, number: u32, time: f32) -> Bounds3 {
        let times = &self.times;
        let at = durer_core::math::Segment::at(time, times.len(), |i| times[i]);
        let [a, b] = &self.boxes[at.key][number as usize];
        let mean = |x: f32, y: f32| x * (1.0 - at.u) + y * at.u;
        let between = |p: durer_core::math::Point3, q: durer_core::math::Point3| {
            durer_core::math::Point3::new(mean(p.x, q.x), mean(p.y, q.y), mean(p.z, q.z))
        };
        Bounds3 { min: between(a.min, b.min), max: between(a.max, b.max) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Placement;
    use durer_core::glam::{DAffine3, DQuat, DVec3};
    use durer_core::math::{Motion, Point3};

    #[test]
    fn a_turning_box_stays_in_its_stretch_and_the_stretch_is_tight() {
        let turned = |degrees: f64| {
            let turn = DQuat::from_rotation_z(degrees.to_radians());
            DAffine3::from_rotation_translation(turn, DVec3::new(degrees / 9.0, 0.0, 0.0))
        };
        let motion = Motion::keyed(vec![(0.0, turned(0.0)), (1.0, turned(90.0))]).expect("valid keys");
        let pose = Pose::new(Placement::from_motion(&motion), 0).expect("valid placement");
        let object = Bounds3::new(Point3::new(-1.0, -0.5, -0.5), Point3::new(1.0, 0.5, 0.5));
        let whole = pose.bounds(&object);
        for step in 0..8 {
            let (a, b) = (step as f32 / 8.0, (step + 1) as f32 / 8.0);
            let boxes = stretch(&pose, &object, a, b);
            for i in 0..=50 {
                let u = i as f32 / 50.0;
                let time = a + (b - a) * u;
                let tight = pose.at(time).expect("moves").bounds(&object);
                for axis in 0..3 {
                    let mean = |x: f32, y: f32| x * (1.0 - u) + y * u;
                    assert!(mean(boxes[0].min[axis], boxes[1].min[axis]) <= tight.min[axis]);
                    assert!(mean(boxes[0].max[axis], boxes[1].max[axis]) >= tight.max[axis]);
                }
            }
            assert!(boxes[0].diagonal().x < 0.35 * whole.diagonal().x, "{boxes:?} {whole:?}");
        }
    }
}
