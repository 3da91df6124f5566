//! Phase functions of media.
use std::rc::Rc;

use durer_core::glam::DAffine3;
use durer_scene::{Data, Params, ValueType};

use super::{
    object::Object,
    value::{numbers, told},
    volume::{self, Grid},
    world::World,
};

/// One that is not blended.
#[derive(Clone, Debug, PartialEq)]
enum Leaf {
    /// By the mean cosine.
    Mean(f32),
    Rayleigh,
    /// Values at even steps of the cosine.
    Table(Vec<f32>),
    /// The matrix of flakes, the same everywhere.
    Flakes(Vec<f32>),
    /// The one of [`Phase::flakes`].
    Varied,
}

/// How particles scatter.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Phase {
    /// What it is blended of, with its shares where the weight is 0 and where it is 1.
    parts: Vec<(Leaf, [f32; 2])>,
    /// The weight, if it changes.
    weight: Option<Grid<1>>,
    /// Flakes that change.
    flakes: Option<Grid<6>>,
}

impl Leaf {
    /// The word, and numbers that follow it.
    fn parts(&self) -> (&'static str, &[f32]) {
        match self {
            Self::Mean(g) => ("henyeygreenstein", std::slice::from_ref(g)),
            Self::Rayleigh => ("rayleigh", &[]),
            Self::Table(values) => ("table", values),
            Self::Flakes(values) => ("sggx", values),
            Self::Varied => ("sggx", &[]),
        }
    }
    fn text(&self) -> String {
        let (word, values) = self.parts();
        values.iter().fold(word.to_owned(), |text, v| format!("{text} {v}"))
    }
}

impl Phase {
    const EVEN: Leaf = Leaf::Mean(0.0);

    fn one(leaf: Leaf) -> Self {
        Self { parts: vec![(leaf, [1.0; 2])], weight: None, flakes: None }
    }
    /// Where its grids lie, if it has any.
    pub(super) fn place(&self) -> Option<DAffine3> {
        self.flakes.as_ref().map(|grid| grid.place).or(self.weight.as_ref().map(|grid| grid.place))
    }
    /// `params` of a medium that lies in `place`, with it.
    pub(super) fn with(&self, params: Params, place: DAffine3) -> Params {
        let floats = |values: Vec<f32>| Data::Floats(values);
        let params = match self.parts.as_slice() {
            [(Leaf::Mean(g), _)] => return params.float("g", *g),
            [(leaf, _)] => {
                let (word, values) = leaf.parts();
                let params = params.string("phase", word);
                if values.is_empty() {
                    params
                } else {
                    params.with("phasevalues", ValueType::Float, floats(values.to_vec()))
                }
            }
            parts => {
                let texts = parts.iter().map(|(leaf, _)| leaf.text()).collect();
                params.string("phase", "blend").with("phases", ValueType::String, Data::Strings(texts))
            }
        };
        let size = self.flakes.as_ref().map(|grid| grid.size).or(self.weight.as_ref().map(|grid| grid.size));
        let params = match size {
            Some(size) => {
                params.with("phasesize", ValueType::Integer, Data::Ints(size.map(|n| n as i32).to_vec()))
            }
            None => params,
        };
        let size = size.unwrap_or([1; 3]);
        let params = match &self.flakes {
            Some(grid) => {
                params.with("phasevalues", ValueType::Float, floats(grid.onto(size, place).concat()))
            }
            None => params,
        };
        if self.parts.len() == 1 {
            return params;
        }
        let weights = match &self.weight {
            Some(grid) => grid.onto(size, place),
            None => vec![[0.0]],
        };
        let share = |[a, b]: [f32; 2], w: f32| a + (b - a) * w.clamp(0.0, 1.0);
        let all = weights.iter().flat_map(|[w]| self.parts.iter().map(|(_, shares)| share(*shares, *w)));
        params.with("phaseweights", ValueType::Float, floats(all.collect()))
    }
}

/// The phase function in a medium.
pub(super) fn phase(world: &mut World<'_>, medium: &Object) -> Phase {
    let found = world.of_tag(medium, "phase").into_iter().next();
    found.and_then(|object| made(world, &object)).unwrap_or(Phase::one(Phase::EVEN))
}

fn made(world: &mut World<'_>, object: &Rc<Object>) -> Option<Phase> {
    let leaf = match object.plugin.as_str() {
        word @ ("isotropic" | "rayleigh") => {
            world.check(object, &[], &[]);
            if word == "rayleigh" { Leaf::Rayleigh } else { Phase::EVEN }
        }
        "hg" => {
            world.check(object, &["g"], &[]);
            Leaf::Mean(object.number_or("g", 0.8, world.said).clamp(-0.999, 0.999) as f32)
        }
        "tabphase" => {
            world.check(object, &["values"], &[]);
            let text = object.text("values", world.said).unwrap_or_default().to_owned();
            let at = object.get("values").map_or(object.at, |p| p.at);
            let values = told(numbers(&text), at, world.said)?;
            if values.len() < 2 || values.iter().any(|v| *v < 0.0) || values.iter().all(|v| *v == 0.0) {
                let message =
                    "\"values\" of tabphase: expected two or more numbers, none below 0 and not all 0";
                world.said.error(at, message);
                return None;
            }
            Leaf::Table(values.into_iter().map(|v| v as f32).collect())
        }
        "sggx" => return flakes(world, object),
        "blendphase" => return world.deeper(object, |world| blend(world, object)),
        other => {
            let known = ["isotropic", "hg", "rayleigh", "tabphase", "sggx", "blendphase"];
            world.said.unknown(object.at, "phase", other, known);
            return None;
        }
    };
    Some(Phase::one(leaf))
}

/// Flakes: six numbers, or a grid of them.
fn flakes(world: &mut World<'_>, object: &Object) -> Option<Phase> {
    world.check(object, &["S"], &[]);
    let Some(volume) = world.named(object, "S") else {
        world.said.error(object.at, "sggx needs the volume \"S\": xx, yy, zz, xy, xz and yz of a matrix");
        return None;
    };
    if volume.plugin == "constvolume" {
        world.check(&volume, &["value", "to_world"], &[]);
        let text = volume.text("value", world.said).unwrap_or_default().to_owned();
        let values = told(numbers(&text), volume.at, world.said)?;
        if values.len() != 6 {
            let message = format!("\"S\" has {} numbers, expected xx, yy, zz, xy, xz and yz", values.len());
            world.said.error(volume.at, message);
            return None;
        }
        return Some(Phase::one(Leaf::Flakes(values.into_iter().map(|v| v as f32).collect())));
    }
    let grid = volume::grid_of(world, &volume)?;
    Some(Phase { flakes: Some(grid), ..Phase::one(Leaf::Varied) })
}

/// Two phase functions in the order of their names, the second one by the weight.
fn blend(world: &mut World<'_>, object: &Object) -> Option<Phase> {
    let mut inner: Vec<_> = world.inner(object).into_iter().filter(|(_, o)| o.tag == "phase").collect();
    world.check(
        object,
        &inner.iter().map(|(name, _)| name.as_str()).chain(["weight"]).collect::<Vec<_>>(),
        &[],
    );
    inner.sort_by(|(a, _), (b, _)| a.cmp(b));
    let [(_, first), (_, second)] = inner.as_slice() else {
        world.said.error(object.at, format!("blendphase has {} phases in it, expected 2", inner.len()));
        return None;
    };
    let weight = match world.named(object, "weight") {
        Some(volume) => Some(volume::grid_of::<1>(world, &volume)?),
        None => None,
    };
    let even = object.number("weight", world.said).unwrap_or(0.5).clamp(0.0, 1.0) as f32;
    // Where the weight is 0 and where it is 1: the same if it does not change.
    let ends = if weight.is_some() { [0.0, 1.0] } else { [even; 2] };
    let mut both = Phase { parts: Vec::new(), weight, flakes: None };
    for (inner, shares) in [(first, ends.map(|w| 1.0 - w)), (second, ends)] {
        let Phase { parts, weight, flakes } = made(world, inner)?;
        if weight.is_some() || flakes.is_some() && both.flakes.is_some() {
            let message =
                "blendphase: one weight of the outermost blend and one \"S\" may be a grid, no more";
            world.said.error(inner.at, message);
            return None;
        }
        both.flakes = both.flakes.or(flakes);
        both.parts.extend(parts.into_iter().map(|(leaf, [share, _])| (leaf, shares.map(|s| s * share))));
    }
    Some(both)
}
