//! Placements: one matrix, one for each end of the time in which things move, or keys of their own.
use std::fmt::Write;

use durer_core::{glam::DAffine3, math::Motion};
use durer_scene::SceneDesc;

/// Where something is.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Frame {
    Still(DAffine3),
    /// At the two times of the file.
    Moving(DAffine3, DAffine3),
    /// At other times: our addition to the language, in single precision.
    Keyed(Vec<(f64, DAffine3)>),
}

/// The two times that the language has: those of the first thing that moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Times(Option<(f64, f64)>);

impl Times {
    pub(super) fn of(desc: &SceneDesc) -> Self {
        let motions = (desc.cameras.iter().map(|c| &c.world_from_camera))
            .chain(desc.shapes.iter().map(|s| &s.world_from_object))
            .chain(desc.lights.iter().map(|l| &l.world_from_light));
        let pair = |motion: &Motion| match motion.keys() {
            [(start, _), (end, _)] => Some((*start, *end)),
            _ => None,
        };
        Self(motions.filter(|motion| !motion.is_still()).find_map(pair))
    }

    /// In seconds, if anything moves.
    pub(super) fn seconds(self) -> Option<(f64, f64)> {
        self.0
    }

    /// The matrices of a motion.
    pub(super) fn frame(self, motion: &Motion) -> Frame {
        match motion.keys() {
            _ if motion.is_still() => Frame::Still(motion.at(0.0)),
            [(start, a), (end, b)] if Some((*start, *end)) == self.0 => Frame::Moving(*a, *b),
            keys => Frame::Keyed(keys.to_vec()),
        }
    }
}

impl Frame {
    /// Appends the directives.
    pub(super) fn write(&self, text: &mut String) {
        self.with(text, |m, text| matrix("Transform", m, text));
    }

    /// Appends the directives of the way back.
    pub(super) fn write_inverse(&self, text: &mut String) {
        match self {
            Self::Keyed(keys) => {
                Self::Keyed(keys.iter().map(|(time, m)| (*time, m.inverse())).collect()).write(text);
            }
            _ => self.with(text, inverse),
        }
    }

    fn with(&self, text: &mut String, one: fn(&DAffine3, &mut String)) {
        match self {
            Self::Still(m) => one(m, text),
            Self::Moving(start, end) => {
                text.push_str("ActiveTransform StartTime\n");
                one(start, text);
                text.push_str("ActiveTransform EndTime\n");
                one(end, text);
                text.push_str("ActiveTransform All\n");
            }
            Self::Keyed(keys) => {
                text.push_str("Identity\nTransformKeys \"float times\" [");
                for (time, _) in keys {
                    let _ = write!(text, " {}", *time as f32);
                }
                text.push_str(" ]\n    \"float matrices\" [");
                for (_, m) in keys {
                    text.push_str("\n       ");
                    for v in m.to_cols_array() {
                        let _ = write!(text, " {}", v as f32);
                    }
                }
                text.push_str(" ]\n");
            }
        }
    }
}

/// The inverse of `m`, so that its own inverse is `m`.
fn inverse(m: &DAffine3, text: &mut String) {
    let back = m.inverse();
    if back.inverse() == *m { matrix("Transform", &back, text) } else { matrix("InverseTransform", m, text) }
}

fn matrix(directive: &str, m: &DAffine3, text: &mut String) {
    if *m == DAffine3::IDENTITY {
        text.push_str("Identity\n");
        return;
    }
    let [x, y, z] = [m.matrix3.x_axis, m.matrix3.y_axis, m.matrix3.z_axis].map(|v| v.to_array());
    let t = m.translation.to_array();
    let _ = write!(text, "{directive} [");
    for (column, w) in [(x, 0), (y, 0), (z, 0), (t, 1)] {
        let [a, b, c] = column;
        let _ = write!(text, " {a} {b} {c} {w}");
    }
    text.push_str(" ]\n");
}
