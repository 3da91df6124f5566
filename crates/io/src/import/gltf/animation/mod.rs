//! Animations: curves over time (`curve.rs`), what they change (`target.rs`), and the moments at which the scene is looked
//! at while the shutter is open (`keys.rs`).
pub(super) mod curve;
mod keys;
pub(super) mod target;

use std::collections::BTreeMap;

use durer_core::math::Interval;
use durer_scene::AnimationDesc;
use serde_json::{Number, Value};

use super::{
    buffer::Buffers,
    document::{Document, only},
    element::{Checked, Element},
    node::Hierarchy,
    stance::Stance,
};
use curve::Curve;
use target::{Bearer, Target};

use crate::import::{Moment, Play};

/// Something that changes over time.
#[derive(Debug)]
struct Channel {
    target: Target,
    curve: Curve,
    /// Where it is described.
    pointer: String,
}

/// What is played.
#[derive(Debug)]
pub(super) struct Animation {
    channels: Vec<Channel>,
    /// Its first and last key, in seconds.
    pub(super) span: Interval,
}

/// What the channels of an animation say at a moment.
#[derive(Debug, Default)]
pub(super) struct Changes {
    /// Translations, rotations and scales of nodes.
    pub(super) places: Vec<(Target, Vec<f64>)>,
    /// Weights of morph targets.
    pub(super) weights: BTreeMap<Bearer, Vec<f32>>,
}

impl Animation {
    /// The animation that is to be played, if the file has one.
    pub(super) fn read(document: &Document<'_>, buffers: &Buffers, play: &Play) -> Checked<Option<Self>> {
        let all = document.root.list("animations")?;
        let chosen: Vec<&Element<'_>> = match play {
            Play::Rest => return Ok(None),
            // Who asked for it says so: no file but of this format could have one.
            Play::Named(_) if all.is_empty() => return Ok(None),
            Play::First => all.first().into_iter().collect(),
            Play::Named(name) => named(document, &all, name)?,
        };
        if chosen.is_empty() {
            return Ok(None);
        }
        let mut channels = Vec::new();
        for animation in chosen {
            for channel in animation.list("channels")? {
                let read = read_channel(document, buffers, animation, &channel);
                channels.extend(document.keep(read).flatten());
            }
        }
        check_twice(document, &channels);
        let mut span = Interval::new(f32::INFINITY, f32::NEG_INFINITY);
        for time in channels.iter().flat_map(|channel| channel.curve.times()) {
            span = Interval::new(span.min.min(*time), span.max.max(*time));
        }
        let span = if span.min > span.max { Interval::point(0.0) } else { span };
        Ok(Some(Self { channels, span }))
    }

    /// The scene at moments that follow its motion while the shutter is open.
    pub(super) fn stances(
        &self,
        document: &Document<'_>,
        nodes: &Hierarchy<'_>,
        shutter: Interval,
    ) -> Checked<Vec<Stance>> {
        let curves = self.channels.iter().map(|channel| &channel.curve);
        keys::stances(shutter, curves, nodes.locals.len(), |time| {
            Stance::of(document, nodes, time, &self.changes(document, time)?)
        })
    }

    /// What nodes and morph targets are at `time`.
    fn changes(&self, document: &Document<'_>, time: f32) -> Checked<Changes> {
        let mut changes = Changes::default();
        for Channel { target, curve, .. } in &self.channels {
            match target {
                Target::Translation(_) | Target::Rotation(_) | Target::Scale(_) => {
                    changes.places.push((target.clone(), curve.at(time)));
                }
                Target::Weights(bearer, None) => {
                    let weights = curve.at(time).into_iter().map(|w| w as f32).collect();
                    changes.weights.insert(*bearer, weights);
                }
                Target::Weights(bearer, Some(index)) => {
                    let weights = match changes.weights.remove(bearer) {
                        Some(weights) => weights,
                        None => own_weights(document, *bearer)?,
                    };
                    let one = curve.at(time).first().copied().unwrap_or(0.0) as f32;
                    let with = |(i, w)| if i == *index { one } else { w };
                    changes.weights.insert(*bearer, weights.into_iter().enumerate().map(with).collect());
                }
                Target::Numbers(_) | Target::Truth(_) => {}
            }
        }
        Ok(changes)
    }

    /// The nodes that it moves, by index, whatever hangs below them.
    pub(super) fn moved(&self) -> impl Iterator<Item = usize> {
        self.channels.iter().filter_map(|channel| match channel.target {
            Target::Translation(node) | Target::Rotation(node) | Target::Scale(node) => Some(node),
            _ => None,
        })
    }
    /// Whether it changes these weights.
    pub(super) fn morphs(&self, bearer: Bearer) -> bool {
        self.channels.iter().any(|c| matches!(c.target, Target::Weights(own, _) if own == bearer))
    }

    /// Whether it changes numbers of the document.
    pub(super) fn edits(&self) -> bool {
        self.channels.iter().any(|c| matches!(c.target, Target::Numbers(_) | Target::Truth(_)))
    }

    /// Writes the numbers of `time` into the document.
    pub(super) fn edit(&self, document: &mut Value, time: f32) {
        for Channel { target, curve, .. } in &self.channels {
            let (names, truth) = match target {
                Target::Numbers(names) => (names, false),
                Target::Truth(names) => (names, true),
                _ => continue,
            };
            let numbers = curve.at(time);
            let number = |v: &f64| Number::from_f64(*v).map_or(Value::Null, Value::Number);
            let value = match numbers.as_slice() {
                [one] if truth => Value::Bool(*one != 0.0),
                [one] => number(one),
                several => Value::Array(several.iter().map(number).collect()),
            };
            put(document, names, value);
        }
    }
}

/// The animations of the file; says what is not played of them.
pub(super) fn told(document: &Document<'_>, play: &Play, moment: Moment) -> Checked<Vec<AnimationDesc>> {
    let elements = document.root.list("animations")?;
    let mut all = Vec::with_capacity(elements.len());
    for animation in &elements {
        let mut span: Option<(f64, f64)> = None;
        for sampler in animation.list("samplers")? {
            let input = document.item("accessors", &sampler.required("input")?)?;
            // Both must be written (section 3.11): nothing is read of animations that are not played.
            let bound = |key| Ok(input.list(key)?.first().map(Element::number).transpose()?.unwrap_or(0.0));
            let (least, most) = (bound("min")?, bound("max")?);
            span = Some(span.map_or((least, most), |(a, b)| (a.min(least), b.max(most))));
        }
        let (start, end) = span.unwrap_or_default();
        all.push(AnimationDesc { name: animation.name().to_owned(), start: start as f32, end: end as f32 });
    }
    let (Some(first), Some(element)) = (all.first(), elements.first()) else { return Ok(all) };
    if *play == Play::Rest {
        let what = durer_scene::counted(all.len(), "animation");
        let is = if all.len() == 1 { "is" } else { "are" };
        let message =
            format!("{what} {is} not played: the scene is drawn at rest; --time-at SECONDS plays one");
        document.warn(element, message);
    } else if moment.time > all.iter().fold(first.end, |end, other| end.max(other.end)) {
        document.warn(element, "the moment lies behind the last key: everything rests where that leaves it");
    }
    Ok(all)
}

/// The animations that a name or an index stands for.
fn named<'e, 'a>(
    document: &Document<'a>,
    all: &'e [Element<'a>],
    wanted: &str,
) -> Checked<Vec<&'e Element<'a>>> {
    let by_name = all.iter().find(|animation| animation.name() == wanted);
    if let Some(found) = by_name.or_else(|| all.get(wanted.parse::<usize>().ok()?)) {
        return Ok(vec![found]);
    }
    if wanted == "all" {
        return Ok(all.iter().collect());
    }
    let names: Vec<&str> = all.iter().map(Element::name).filter(|name| !name.is_empty()).collect();
    let near = durer_scene::nearest_word(wanted, names.iter().copied());
    let mut fault = document.root.fault_at("animations", format!("no animation \"{wanted}\""));
    fault.hint = Some(match (near, all.len()) {
        (Some(near), _) => format!("did you mean \"{near}\"?"),
        (None, 1) => "there is one, with the index 0".to_owned(),
        (None, n) => format!("there are {n}: {}, or an index from 0 to {}", names.join(", "), n - 1),
    });
    Err(fault)
}

fn read_channel<'a>(
    document: &Document<'a>,
    buffers: &Buffers,
    animation: &Element<'a>,
    channel: &Element<'a>,
) -> Checked<Option<Channel>> {
    let Some(target) = Target::read(document, channel)? else {
        return Ok(None);
    };
    let reference = channel.required("sampler")?;
    let index = reference.index()?;
    let Some(sampler) = animation.list_item("samplers", index)? else {
        let count = animation.list("samplers")?.len();
        let message = format!("refers to sampler {index}, but {}", only(count, "samplers"));
        return Err(reference.fault(message));
    };
    let curve = Curve::read(document, buffers, &sampler, target.meaning())?;
    if let Target::Weights(bearer, which) = &target {
        let targets = own_weights(document, *bearer)?.len();
        let (found, fits) = match which {
            None => (curve.lanes, curve.lanes == targets),
            Some(index) => (*index, *index < targets),
        };
        if !fits {
            let message = match which {
                None => format!("{found} weights a key, but the mesh has {targets} morph targets"),
                Some(_) => format!("weight {found}, but the mesh has {targets} morph targets"),
            };
            return Err(channel.fault(message));
        }
    }
    Ok(Some(Channel { target, curve, pointer: channel.pointer().to_owned() }))
}

/// The weights of a node or mesh that nothing changes: one for each morph target.
fn own_weights(document: &Document<'_>, bearer: Bearer) -> Checked<Vec<f32>> {
    let (holder, mesh) = match bearer {
        Bearer::Node(index) => {
            let node = document.root.list_item("nodes", index)?;
            let mesh = node.as_ref().map(|node| document.member(node, "mesh", "meshes")).transpose()?;
            (node, mesh.flatten())
        }
        Bearer::Mesh(index) => (None, document.root.list_item("meshes", index)?),
    };
    let Some(mesh) = mesh else { return Ok(Vec::new()) };
    let targets = match mesh.list("primitives")?.first() {
        Some(primitive) => primitive.list("targets")?.len(),
        None => 0,
    };
    let own = match holder {
        Some(node) if node.get("weights")?.is_some() => node.list("weights")?,
        _ => mesh.list("weights")?,
    };
    let mut weights = own.iter().map(|w| Ok(w.number()? as f32)).collect::<Checked<Vec<f32>>>()?;
    weights.resize(targets, 0.0);
    Ok(weights)
}

/// No two channels may change the same.
fn check_twice(document: &Document<'_>, channels: &[Channel]) {
    let mut known: BTreeMap<String, &str> = BTreeMap::new();
    for Channel { target, pointer, .. } in channels {
        if let Some(first) = known.insert(format!("{target:?}"), pointer) {
            let message = format!("{first} already changes the same");
            let hint = first.split('/').nth(2) != pointer.split('/').nth(2);
            let hint = hint.then(|| "these animations cannot be played together: choose one".to_owned());
            document.error(super::element::Fault { pointer: pointer.clone(), message, hint });
        }
    }
}

/// Puts a value where the names lead to; those before the last are there.
fn put(document: &mut Value, names: &[String], value: Value) {
    let Some((last, way)) = names.split_last() else { return };
    let holder = way.iter().try_fold(document, |at, name| match at {
        Value::Array(array) => array.get_mut(name.parse::<usize>().ok()?),
        other => other.get_mut(name),
    });
    if let Some(Value::Object(members)) = holder {
        members.insert(last.clone(), value);
    }
}
