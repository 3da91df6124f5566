//! Light transport.
use std::rc::Rc;

use durer_scene::{Node, Params};

use super::{
    object::Object,
    world::{World, node},
};

/// Bounces of paths that have no limit in Mitsuba.
const NO_LIMIT: i32 = 1000;
/// Theirs and ours.
const INTEGRATORS: [(&str, &str); 13] = [
    ("path", "path"),
    ("volpath", "volpath"),
    ("volpathmis", "volpath"),
    ("volpath_simple", "volpath"),
    ("direct", "path"),
    ("ptracer", "light"),
    ("depth", "cast"),
    ("prb", "path"),
    ("prb_basic", "path"),
    ("prbvolpath", "volpath"),
    ("bdpt", "bdpt"),
    ("direct_projective", "path"),
    ("prb_projective", "path"),
];
/// Those that hold another, which alone is done.
const AROUND: [(&str, &str); 3] = [
    ("moment", "variances are told by durer itself"),
    ("aov", "other pictures of the scene are left out: --integrator cast shows them"),
    ("stokes", "light is not polarised here"),
];

/// What a scene without integrator gets: paths.
pub(super) fn usual() -> Node {
    Node::new("path", Params::new().int("maxdepth", NO_LIMIT).int("roulettedepth", 5))
}

/// The integrator that `object` is or holds.
pub(super) fn integrator(world: &mut World<'_>, object: &Rc<Object>) -> Option<Node> {
    if let Some((word, why)) = AROUND.iter().find(|(word, _)| *word == object.plugin) {
        world.check(object, &["aovs"], &[]);
        world.note(object.at, format!("integrator \"{word}\": the one in it is used; {why}"));
        let inner = world.of_tag(object, "integrator").into_iter().next();
        return match inner {
            Some(inner) => world.deeper(&inner, |world| integrator(world, &inner)),
            None => Some(usual()),
        };
    }
    let Some((theirs, ours)) = INTEGRATORS.iter().find(|(theirs, _)| *theirs == object.plugin) else {
        let known = INTEGRATORS.iter().map(|i| i.0).chain(AROUND.iter().map(|i| i.0));
        world.said.unknown(object.at, "integrator", &object.plugin, known);
        return None;
    };
    let idle = [
        "emitter_samples",
        "bsdf_samples",
        "shading_samples",
        "samples_per_pass",
        "block_size",
        "timeout",
        "strict_normals",
        "light_image",
        "sampling_threshold",
    ];
    let mut takes = vec!["max_depth", "rr_depth"];
    takes.extend(idle);
    world.check(object, &takes, &["hide_emitters"]);
    for prop in object.props.iter().filter(|p| idle.contains(&p.name.as_str())) {
        world.note(prop.at, format!("\"{}\" has no effect", prop.name));
    }
    if *theirs == "depth" {
        return Some(node("cast", Params::new().string("show", "depth"), object.at));
    }
    if theirs != ours && *theirs != "direct" {
        world.note(object.at, format!("integrator \"{theirs}\": \"{ours}\" is used"));
    }
    // Mitsuba counts edges: 1 is what shines by itself, 2 direct light.
    let depth = object.number_or("max_depth", if *theirs == "direct" { 2.0 } else { -1.0 }, world.said);
    let bounces = if depth < 0.0 { NO_LIMIT } else { (depth as i32 - 1).clamp(0, NO_LIMIT) };
    let roulette = (object.number_or("rr_depth", 5.0, world.said) as i32).clamp(0, 10_000);
    let params = Params::new().int("maxdepth", bounces).int("roulettedepth", roulette);
    Some(node(ours, params, object.at))
}
