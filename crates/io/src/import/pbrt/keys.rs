//! `TransformKeys`: a motion by keys, our addition to pbrt's language.
//!
//! At each of its times it is translation times rotation times scale. Between keys the three change evenly: rotation by
//! its angle if both keys have the same axis, however many turns that is, else on the shortest arc (Shoemake 1985). What is
//! placed within it moves on the arcs that follow: there is a key every few degrees. Or its matrices are given, with no more
//! between them than that takes.
use durer_core::{
    glam::{DAffine3, DQuat, DVec3},
    math::Motion,
};
use durer_scene::{Args, Diagnostics, Node, ParamDefault, ParamSpec, ParamType, Schema};

use super::{
    placement::is_invertible,
    transform::{rotate, unit},
};

/// Degrees between keys: a point at distance r from the axis leaves its circle by r (1 - cos 2 degrees) = 0.0006 r.
const STEP: f64 = 4.0;

/// Most keys of one motion: 182 turns.
const MOST_KEYS: usize = 1 << 14;

/// Its parameters.
pub(super) const KEYS: Schema = Schema {
    name: "TransformKeys",
    aliases: &[],
    doc: "Multiplies the current transformation by one that changes over time.",
    params: &[
        ParamSpec::new(
            "times",
            ParamType::Floats,
            ParamDefault::Required,
            "The moments of the keys, rising.",
        )
        .unit("s"),
        ParamSpec::new("translate", ParamType::Point3s, ParamDefault::Unset, "Where the origin is at each.")
            .unit("m"),
        ParamSpec::new(
            "rotate",
            ParamType::Floats,
            ParamDefault::Unset,
            "Degrees and axis at each, as of Rotate.",
        ),
        ParamSpec::new("scale", ParamType::Vector3s, ParamDefault::Unset, "Factors along the axes at each."),
        ParamSpec::new(
            "matrices",
            ParamType::Floats,
            ParamDefault::Unset,
            "Instead of these three: twelve numbers at each, where the axes x, y and z and the origin go.",
        ),
    ],
};

/// One key.
#[derive(Clone, Copy, Debug)]
struct Key {
    time: f64,
    translate: DVec3,
    degrees: f64,
    axis: DVec3,
    scale: DVec3,
}

/// The motion that `node` describes; `None` after a complaint.
pub(super) fn read(node: &Node, diagnostics: &mut Diagnostics) -> Option<Motion> {
    let mut args = Args::check(node, KEYS, &[], diagnostics);
    if !args.is_sound() {
        return None;
    }
    let times = args.floats("times");
    if args.is_set("matrices") {
        return placed(&mut args, times);
    }
    let rotate = args.floats("rotate").as_chunks::<4>();
    let (translate, scale) = (args.triples("translate"), args.triples("scale"));
    if times.is_empty() || times.windows(2).any(|w| w.first() >= w.last()) {
        args.error("times", "\"times\" must be one moment or more, each later than the one before");
    }
    let whole = rotate.1.is_empty();
    let counts = [("translate", translate.len()), ("rotate", rotate.0.len()), ("scale", scale.len())];
    for (name, count) in counts {
        if args.is_set(name) && (count != times.len() || (name == "rotate" && !whole)) {
            let per_key = if name == "rotate" { "four numbers" } else { "three numbers" };
            let message = format!("\"{name}\" needs {per_key} for each of the {} times", times.len());
            args.error(name, message);
        }
    }
    let vector = |v: Option<&[f32; 3]>, default: DVec3| v.map_or(default, |v| DVec3::from(v.map(f64::from)));
    let keys: Vec<Key> = (0..times.len())
        .map(|i| {
            let [degrees, x, y, z] = rotate.0.get(i).map_or([0.0; 4], |r| r.map(f64::from));
            Key {
                time: times.get(i).copied().unwrap_or(0.0).into(),
                translate: vector(translate.get(i), DVec3::ZERO),
                degrees,
                axis: DVec3::new(x, y, z),
                scale: vector(scale.get(i), DVec3::ONE),
            }
        })
        .collect();
    if keys.iter().any(|k| k.degrees != 0.0 && unit(k.axis).is_none()) {
        args.error("rotate", "the axis of a rotation must not be 0 0 0");
    }
    if !args.is_sound() {
        return None;
    }
    let through_zero = |w: &[Key]| matches!(w, [a, b] if (a.scale * b.scale).min_element() < 0.0);
    if keys.windows(2).any(through_zero) {
        args.error(
            "scale",
            "a factor changes its sign from one key to the next: between them it is 0 and shapes would be flat",
        );
        return None;
    }
    let refined = refined(&keys).filter(|keys| keys.len() <= MOST_KEYS);
    let Some(refined) = refined else {
        let message = format!("this turns too far: a key every {STEP} degrees makes more than {MOST_KEYS}");
        args.error("rotate", message);
        return None;
    };
    let placed: Vec<_> = refined.iter().map(|(time, m)| (*time, *m)).collect();
    if placed.iter().any(|(_, m)| !is_invertible(m)) {
        args.error(
            "scale",
            "this makes the transformation singular: it has no inverse, so shapes would be flat",
        );
        return None;
    }
    Motion::keyed(placed).map_err(|why| args.error("times", why)).ok()
}

/// The motion through matrices.
fn placed(args: &mut Args<'_>, times: &[f32]) -> Option<Motion> {
    let (matrices, rest) = args.floats("matrices").as_chunks::<12>();
    if matrices.len() != times.len() || !rest.is_empty() {
        args.error(
            "matrices",
            format!("\"matrices\" needs twelve numbers for each of the {} times", times.len()),
        );
        return None;
    }
    if let Some(other) = ["translate", "rotate", "scale"].into_iter().find(|name| args.is_set(name)) {
        args.error(other, format!("\"matrices\" says all: leave \"{other}\" out"));
        return None;
    }
    let matrix = |m: &[f32; 12]| DAffine3::from_cols_array(&m.map(f64::from));
    let keys: Vec<_> = times.iter().map(|t| f64::from(*t)).zip(matrices.iter().map(matrix)).collect();
    if keys.iter().any(|(_, m)| !is_invertible(m)) {
        args.error("matrices", "a matrix is singular: it has no inverse, so shapes would be flat");
        return None;
    }
    Motion::keyed(keys).map_err(|why| args.error("times", why)).ok()
}

/// The keys with as many more between them as the rotation needs; `None` if these are too many.
fn refined(keys: &[Key]) -> Option<Vec<(f64, DAffine3)>> {
    let mut all = Vec::new();
    if let Some(first) = keys.first() {
        all.push((first.time, first.matrix()));
    }
    for pair in keys.windows(2) {
        let [a, b] = pair else { continue };
        let turn = Turn::between(a, b);
        let steps = (turn.degrees() / STEP).ceil().max(1.0);
        if all.len() as f64 + steps > MOST_KEYS as f64 {
            return None;
        }
        for step in 1..steps as u32 {
            let u = f64::from(step) / steps;
            let (translate, scale) = (a.translate.lerp(b.translate, u), a.scale.lerp(b.scale, u));
            let rest = DAffine3::from_scale(scale);
            let m = DAffine3::from_translation(translate) * turn.at(u) * rest;
            all.push((a.time + (b.time - a.time) * u, m));
        }
        all.push((b.time, b.matrix()));
    }
    Some(all)
}

impl Key {
    fn rotation(&self) -> DAffine3 {
        rotate(self.degrees, self.axis).unwrap_or(DAffine3::IDENTITY)
    }
    fn matrix(&self) -> DAffine3 {
        DAffine3::from_translation(self.translate) * self.rotation() * DAffine3::from_scale(self.scale)
    }
}

/// How the rotation of one key becomes that of the next.
enum Turn {
    About { axis: DVec3, from: f64, to: f64 },
    Arc(DQuat, DQuat),
}

impl Turn {
    fn between(a: &Key, b: &Key) -> Self {
        let (from, to) = (a.degrees, b.degrees);
        match (unit(a.axis).filter(|_| from != 0.0), unit(b.axis).filter(|_| to != 0.0)) {
            (Some(p), Some(q)) if (p - q).length() < 1e-6 => Self::About { axis: p, from, to },
            (Some(p), Some(q)) if (p + q).length() < 1e-6 => Self::About { axis: p, from, to: -to },
            (Some(_), Some(_)) => {
                let of = |k: &Key| DQuat::from_mat3(&k.rotation().matrix3).normalize();
                Self::Arc(of(a), of(b))
            }
            // No rotation is one about any axis.
            (p, q) => Self::About { axis: p.or(q).unwrap_or(DVec3::Z), from, to },
        }
    }
    fn degrees(&self) -> f64 {
        match self {
            Self::About { from, to, .. } => (to - from).abs(),
            Self::Arc(a, b) => a.angle_between(*b).to_degrees(),
        }
    }
    fn at(&self, u: f64) -> DAffine3 {
        match self {
            Self::About { axis, from, to } => {
                rotate(from + (to - from) * u, *axis).unwrap_or(DAffine3::IDENTITY)
            }
            Self::Arc(a, b) => DAffine3::from_quat(a.slerp(*b, u)),
        }
    }
}
