//! One property over time: keys, and what lies between them (glTF 2.0, appendix C).
//!
//! With `t` from 0 to 1 on the way from key `k` to the next, `d` the seconds between them, values `v`, and the tangents
//! `a` into and `b` out of a key: STEP `v_k`; LINEAR `(1 - t) v_k + t v_k+1`, of rotations the shortest arc (Shoemake
//! 1985); CUBICSPLINE `(2t^3 - 3t^2 + 1) v_k + d (t^3 - 2t^2 + t) b_k + (3t^2 - 2t^3) v_k+1 + d (t^3 - t^2) a_k+1`, of
//! rotations brought to length 1. Before the first and after the last key the value is held.
use durer_core::glam::DQuat;
use durer_scene::counted;

use crate::import::gltf::{
    accessor::Accessor,
    buffer::Buffers,
    document::Document,
    element::{Checked, Element},
};

/// What lies between keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Between {
    Step,
    Linear,
    Cubic,
}

/// What the numbers of a key are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::import::gltf) enum Meaning {
    /// A quaternion: x, y, z, w.
    Rotation,
    /// So many numbers, each by itself.
    Numbers(usize),
    /// As many weights as there are.
    Weights,
}

/// The sampler of an animation, read.
#[derive(Debug)]
pub(in crate::import::gltf) struct Curve {
    /// Strictly rising, never empty.
    times: Vec<f32>,
    /// By key: of cubic splines the tangents in, the values, the tangents out.
    values: Vec<f32>,
    /// Numbers of one value.
    pub(in crate::import::gltf) lanes: usize,
    between: Between,
    meaning: Meaning,
}

impl Curve {
    /// The sampler `element`.
    pub(in crate::import::gltf) fn read<'a>(
        document: &Document<'a>,
        buffers: &Buffers,
        element: &Element<'a>,
        meaning: Meaning,
    ) -> Checked<Self> {
        let between = match element.text_or("interpolation", "LINEAR")? {
            "LINEAR" => Between::Linear,
            "STEP" => Between::Step,
            "CUBICSPLINE" => Between::Cubic,
            other => {
                let message = format!("expected LINEAR, STEP or CUBICSPLINE, found \"{other}\"");
                return Err(element.fault_at("interpolation", message));
            }
        };
        let times = times(document, buffers, &element.required("input")?)?;
        let output = Accessor::open(document, buffers, &element.required("output")?)?;
        if output.holds_integers() && meaning != Meaning::Numbers(1) {
            return Err(output.element.fault("animated values must be floats or normalised integers"));
        }
        let values = output.numbers(document)?;
        if values.iter().any(|v| !v.is_finite()) {
            return Err(output.element.fault("an animated value is infinite or NaN"));
        }
        let per_key = if between == Between::Cubic { 3 } else { 1 };
        let lanes = match meaning {
            Meaning::Rotation => 4,
            Meaning::Numbers(lanes) => lanes,
            Meaning::Weights => values.len() / (times.len() * per_key),
        };
        let shape = if meaning == Meaning::Weights { 1 } else { lanes };
        if output.lanes != shape {
            let message =
                format!("expected {} per element, found {}", counted(shape, "number"), output.lanes);
            return Err(output.element.fault(message));
        }
        if lanes == 0 || values.len() != times.len() * per_key * lanes {
            let (keys, found) = (counted(times.len(), "key"), counted(output.count, "value"));
            let each = if per_key == 3 { " with two tangents each" } else { "" };
            return Err(output.element.fault(format!("{found} for {keys}{each}")));
        }
        Ok(Self { times, values, lanes, between, meaning })
    }

    /// The moments of its keys.
    pub(in crate::import::gltf) fn times(&self) -> &[f32] {
        &self.times
    }
    /// Whether the value jumps at its keys.
    pub(in crate::import::gltf) fn jumps(&self) -> bool {
        self.between == Between::Step
    }

    /// The value at `time` seconds.
    pub(in crate::import::gltf) fn at(&self, time: f32) -> Vec<f64> {
        let next = self.times.partition_point(|t| *t <= time);
        let key = next.saturating_sub(1);
        let moments = self.times.get(key).zip(self.times.get(next));
        match moments.filter(|(start, _)| *start <= &time) {
            Some((&start, &end)) if self.between != Between::Step => {
                let seconds = f64::from(end) - f64::from(start);
                self.within(key, (f64::from(time) - f64::from(start)) / seconds, seconds)
            }
            _ => self.row(key, Row::Value).collect(),
        }
    }

    /// The value a share `t` of the way from `key` to the next, which takes so many `seconds`.
    fn within(&self, key: usize, t: f64, seconds: f64) -> Vec<f64> {
        let from = self.row(key, Row::Value);
        let to = self.row(key + 1, Row::Value);
        if self.between == Between::Linear {
            return match self.meaning {
                Meaning::Rotation => arc(from.collect(), to.collect(), t),
                _ => from.zip(to).map(|(a, b)| a * (1.0 - t) + b * t).collect(),
            };
        }
        let (t2, t3) = (t * t, t * t * t);
        let start = 2.0 * t3 - 3.0 * t2 + 1.0;
        let (out, into) = (seconds * (t3 - 2.0 * t2 + t), seconds * (t3 - t2));
        let values = from.zip(to).map(|(a, b)| a * start + b * (1.0 - start));
        let tangents = self.row(key, Row::Out).zip(self.row(key + 1, Row::In));
        let mut all: Vec<f64> = values.zip(tangents).map(|(v, (b, a))| v + b * out + a * into).collect();
        if self.meaning == Meaning::Rotation {
            let length = all.iter().map(|v| v * v).sum::<f64>().sqrt();
            all.iter_mut().for_each(|v| *v /= length);
        }
        all
    }

    fn row(&self, key: usize, which: Row) -> impl Iterator<Item = f64> {
        let row = match self.between {
            Between::Cubic => 3 * key + which as usize,
            _ => key,
        };
        let values = self.values.get(row * self.lanes..).unwrap_or_default();
        values.iter().take(self.lanes).map(|v| f64::from(*v))
    }
}

/// Numbers of a key of a cubic spline, in the order of the file.
#[derive(Clone, Copy)]
enum Row {
    In,
    Value,
    Out,
}

/// The rotation a share `t` of the way from one to another, on the shorter arc.
fn arc(from: Vec<f64>, to: Vec<f64>, t: f64) -> Vec<f64> {
    let quaternion = |v: &[f64]| match *v {
        [x, y, z, w] => DQuat::from_xyzw(x, y, z, w).normalize(),
        _ => DQuat::IDENTITY,
    };
    quaternion(&from).slerp(quaternion(&to), t).to_array().to_vec()
}

/// The moments of keys: finite, and each later than the one before.
fn times<'a>(document: &Document<'a>, buffers: &Buffers, reference: &Element<'a>) -> Checked<Vec<f32>> {
    let input = Accessor::open(document, buffers, reference)?;
    let times: Vec<f32> = input.floats::<1>(document, None)?.into_iter().map(|[t]| t).collect();
    if times.is_empty() {
        return Err(input.element.fault("an animation needs at least one key"));
    }
    if let Some(key) = times.iter().position(|t| !t.is_finite()) {
        return Err(input.element.fault(format!("the time of key {key} is infinite or NaN")));
    }
    let falls = times.iter().zip(times.iter().skip(1)).position(|(a, b)| a >= b);
    match falls.and_then(|key| Some((key, times.get(key)?, times.get(key + 1)?))) {
        None => Ok(times),
        Some((key, a, b)) => {
            let message = format!("times must rise: key {key} is at {a} s, key {} at {b} s", key + 1);
            Err(input.element.fault(message))
        }
    }
}
