//! Instances as they were before a change: to put them back if it fails, and to see what has changed if it does not.
use durer_core::math::Bounds3;

use super::maker::Kind;
use crate::{accel::Instance, placement::Pose};

/// What a change replaces.
struct Before {
    kind: Kind,
    is_bounded: bool,
    bounds: Bounds3,
    finite: Bounds3,
    /// With whether it mirrored; `None` if it stays where it is.
    pose: Option<(Pose, bool)>,
}

/// Instances that were changed, in the order of the changes.
pub(super) struct Journal(Vec<(u32, Before)>);

/// An instance that is not as it was.
pub(super) struct Changed {
    pub(super) index: u32,
    /// Which tree it lay in.
    pub(super) was: Kind,
    /// Its finite part's box.
    pub(super) was_finite: Bounds3,
}

impl Journal {
    /// Nothing yet.
    pub(super) fn with_room_for(changes: usize) -> Self {
        Self(Vec::with_capacity(changes))
    }

    /// Notes how an instance is, then measures it, at `pose` if there is one; `boxes` are those of its geometry.
    pub(super) fn change(
        &mut self,
        instances: &mut [Instance],
        index: u32,
        pose: Option<Pose>,
        boxes: [Bounds3; 2],
    ) {
        let instance = &mut instances[index as usize];
        let kind = Kind::of(instance);
        let (is_bounded, bounds, finite) = (instance.is_bounded, instance.bounds, instance.finite);
        let pose = pose.map(|pose| {
            let mirrored = std::mem::replace(&mut instance.mirrors, pose.mirrors());
            (std::mem::replace(&mut instance.pose, pose), mirrored)
        });
        instance.measure(boxes);
        self.0.push((index, Before { kind, is_bounded, bounds, finite, pose }));
    }

    /// Puts everything back.
    pub(super) fn undo(self, instances: &mut [Instance]) {
        for (index, before) in self.0.into_iter().rev() {
            let instance = &mut instances[index as usize];
            (instance.is_bounded, instance.bounds, instance.finite) =
                (before.is_bounded, before.bounds, before.finite);
            if let Some((pose, mirrored)) = before.pose {
                (instance.pose, instance.mirrors) = (pose, mirrored);
            }
        }
    }

    /// What has changed, each once and in the order of instances.
    pub(super) fn changed(&self, instances: &[Instance]) -> Vec<Changed> {
        // The first note of an instance says how it was.
        let mut first: Vec<&(u32, Before)> = self.0.iter().collect();
        first.sort_by_key(|(index, _)| *index);
        first.dedup_by_key(|(index, _)| *index);
        let differs = |(index, before): &&(u32, Before)| {
            let now = &instances[*index as usize];
            let is_elsewhere = before.pose.as_ref().is_some_and(|(pose, _)| *pose != now.pose);
            is_elsewhere || before.bounds != now.bounds || before.finite != now.finite
        };
        let changed = first.into_iter().filter(|note| differs(note)).map(|(index, before)| Changed {
            index: *index,
            was: before.kind,
            was_finite: before.finite,
        });
        changed.collect()
    }
}
