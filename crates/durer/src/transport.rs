//! Light transport as options, scene and defaults together ask for it: the integrator's node, and what it says.
use std::collections::BTreeMap;

use durer_render::{
    compile,
    integrator::{HEED_MEDIA, INTEGRATORS, PATHS},
};
use durer_scene::{Data, Diagnostics, Location, Node, Param, ParamDefault, ParamSpec, SceneDesc, ValueType};

use crate::{Distribution, Options};

/// The word of the integrator that answers to `kind`.
pub(crate) fn registered_word(kind: &str) -> String {
    let entry = INTEGRATORS.iter().find(|e| e.answers_to(kind));
    entry.map_or("path", |e| e.schema.name).to_owned()
}

/// The integrator's parameters with their values, without those that have none.
pub(crate) fn rules(node: &Node) -> BTreeMap<String, serde_json::Value> {
    let takes = INTEGRATORS.iter().find(|e| e.answers_to(&node.kind)).map_or(&[][..], |e| e.schema.params);
    let rule = |spec: &ParamSpec| {
        let written = node.params.get(spec.name).map(|param| &param.data);
        let value = match (written, spec.default) {
            (Some(Data::Ints(v)), _) if v.len() == 1 => v[0].into(),
            (Some(Data::Floats(v)), _) if v.len() == 1 => short(v[0]),
            (Some(Data::Bools(v)), _) if v.len() == 1 => v[0].into(),
            (Some(Data::Strings(v)), _) if v.len() == 1 => v[0].clone().into(),
            (_, ParamDefault::Int(v)) => v.into(),
            (_, ParamDefault::Float(v)) => short(v),
            (_, ParamDefault::Bool(v)) => v.into(),
            (_, ParamDefault::Text(v)) => v.into(),
            _ => return None,
        };
        Some((rule_name(spec.name), value))
    };
    takes.iter().filter_map(rule).collect()
}

/// A number with no more digits than it has bits.
fn short(v: f32) -> serde_json::Value {
    v.to_string().parse().map_or(serde_json::Value::Null, |v: f64| v.into())
}

/// Keys are read by programs: words apart.
fn rule_name(parameter: &str) -> String {
    let words = [
        ("max", "depth"),
        ("min", "contribution"),
        ("shadow", "rays"),
        ("gloss", "rays"),
        ("time", "samples"),
    ];
    let more = [("lens", "samples"), ("aa", "samples"), ("attenuation", "distance")];
    let apart = words.into_iter().chain(more).find(|(a, b)| parameter.strip_prefix(a) == Some(b));
    apart.map_or_else(|| parameter.to_owned(), |(a, b)| format!("{a}_{b}"))
}

/// The integrator the options ask for, else the scene's, else the default; with the options' limits put in.
pub(crate) fn integrator_node(desc: &SceneDesc, options: &Options, diagnostics: &mut Diagnostics) -> Node {
    let of_scene = desc.integrator.clone();
    let mut node = match (&options.integrator, of_scene) {
        (Some(kind), Some(node)) if node.kind == *kind => node,
        (Some(kind), Some(node)) => of_kind(kind, &node),
        (Some(kind), None) => Node::new(kind, durer_scene::Params::new()),
        (None, Some(node)) => node,
        (None, None) => compile::default_integrator(desc),
    };
    node = with_usual_depth(desc, node);
    if !desc.media.is_empty() && !HEED_MEDIA.contains(&registered_word(&node.kind).as_str()) {
        let names: Vec<_> = desc.media.iter().map(|medium| format!("\"{}\"", medium.name)).collect();
        let message =
            format!("the integrator \"{}\" does not see the medium {}", node.kind, names.join(", "));
        diagnostics.warning(node.at.clone(), message).hint("--integrator volpath, bdpt and light heed media");
    }
    let takes = INTEGRATORS.iter().find(|e| e.answers_to(&node.kind)).map_or(&[][..], |e| e.schema.params);
    for (wish, name, ty, data) in wishes(options) {
        if takes.iter().any(|p| p.name == name) {
            node.params.set(Param { name: name.to_owned(), ty, data, at: Location::None });
        } else {
            let takers = INTEGRATORS.iter().filter(|e| e.schema.params.iter().any(|p| p.name == name));
            let takers: Vec<_> = takers.map(|e| e.schema.name).collect();
            let quoted: Vec<_> = takers.iter().map(|name| format!("\"{name}\"")).collect();
            let message =
                format!("{wish} concerns the integrator {} only, not \"{}\"", quoted.join(" or "), node.kind);
            let hint = format!("add --integrator {}", takers.join(" or "));
            diagnostics.warning(Location::None, message).hint(hint);
        }
    }
    node
}

/// Another integrator, with what the scene's says that means the same to both: depth, roulette, choice of lights.
fn of_kind(kind: &str, of_scene: &Node) -> Node {
    let mut node = Node::new(kind, durer_scene::Params::new());
    let entry = |kind: &str| INTEGRATORS.iter().find(|e| e.answers_to(kind)).map(|e| e.schema);
    let (Some(from), Some(to)) = (entry(&of_scene.kind), entry(kind)) else { return node };
    if PATHS.contains(&from.name) && PATHS.contains(&to.name) {
        let shared = |param: &&Param| to.params.iter().any(|spec| spec.name == param.name);
        of_scene.params.iter().filter(shared).for_each(|param| node.params.push(param.clone()));
    }
    node
}

/// The node with as many bounces as are usual for scenes of its format, if it says nothing of them and follows paths.
pub fn with_usual_depth(desc: &SceneDesc, mut node: Node) -> Node {
    let follows_paths = PATHS.contains(&registered_word(&node.kind).as_str());
    if let Some(depth) = desc.usual_depth.filter(|_| follows_paths && node.params.get("maxdepth").is_none()) {
        let data = Data::Ints(vec![depth.min(i32::MAX as u32) as i32]);
        let (name, at) = ("maxdepth".to_owned(), Location::None);
        node.params.push(Param { name, ty: ValueType::Integer, data, at });
    }
    node
}

/// What the options ask of an integrator: a name for people, the parameter and its value.
fn wishes(options: &Options) -> Vec<(&'static str, &'static str, ValueType, Data)> {
    let Distribution { shadow_rays, lights, gloss_rays, time_samples, lens_samples, aa_samples, sampling } =
        options.distribution;
    let text = |word: &str| (ValueType::String, Data::Strings(vec![word.to_owned()]));
    let int = |n: u32| (ValueType::Integer, Data::Ints(vec![n.min(i32::MAX as u32) as i32]));
    let float = |v: f32| (ValueType::Float, Data::Floats(vec![v]));
    let all = [
        ("what is shown of a hit", "show", options.show.map(|show| text(show.word()))),
        ("the depth limit", "maxdepth", options.max_depth.map(int)),
        ("the contribution limit", "mincontribution", options.min_contribution.map(float)),
        ("what transparent things do to shadows", "shadows", options.shadows.map(|s| text(s.word()))),
        ("the number of shadow rays", "shadowrays", shadow_rays.map(int)),
        ("the choice of lights", "lights", lights.map(|l| text(l.word()))),
        ("the number of gloss rays", "glossrays", gloss_rays.map(int)),
        ("the number of moments", "timesamples", time_samples.map(int)),
        ("the number of lens points", "lenssamples", lens_samples.map(int)),
        ("the number of pixel points", "aasamples", aa_samples.map(int)),
        ("the way samples are combined", "sampling", sampling.map(|s| text(s.word()))),
    ];
    all.into_iter().filter_map(|(wish, name, value)| value.map(|(ty, data)| (wish, name, ty, data))).collect()
}
