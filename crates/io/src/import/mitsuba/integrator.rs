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
const INTEGRATORS: [(&str, &str); 20] = [
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
    // Those of 0.x.
    ("pssmlt", "bdpt"),
    ("mlt", "bdpt"),
    ("erpt", "bdpt"),
    ("photonmapper", "sppm"),
    ("ppm", "sppm"),
    ("sppm", "sppm"),
    ("vpl", "path"),
];
/// Parameters of integrators of 0.x that others stand for.
const OF_OLD: [&str; 30] = [
    "photon_count",
    "initial_radius",
    "global_photons",
    "caustic_photons",
    "volume_photons",
    "global_lookup_radius",
    "caustic_lookup_radius",
    "volume_lookup_radius",
    "lookup_size",
    "granularity",
    "glossy_samples",
    "max_passes",
    "alpha",
    "bidirectional",
    "luminance_samples",
    "two_stage",
    "p_large",
    "direct_samples",
    "separate_direct",
    "technique",
    "num_chains",
    "max_chains",
    "chain_length",
    "mutation_type",
    "bidirectional_mutation",
    "lens_perturbation",
    "caustic_perturbation",
    "multi_chain_perturbation",
    "manifold_perturbation",
    "lambda",
];
/// Those that hold another, which alone is done.
const AROUND: [(&str, &str); 5] = [
    ("moment", "variances are told by durer itself"),
    ("aov", "other pictures of the scene are left out: --integrator cast shows them"),
    ("stokes", "light is not polarised here"),
    ("adaptive", "every pixel gets as many samples"),
    ("irrcache", "no light is kept from place to place"),
];

/// What a scene without integrator gets: paths.
pub(super) fn usual() -> Node {
    Node::new("path", Params::new().int("maxdepth", NO_LIMIT).int("roulettedepth", 5))
}

/// The integrator that `object` is or holds.
pub(super) fn integrator(world: &mut World<'_>, object: &Rc<Object>) -> Option<Node> {
    if let Some((word, why)) = AROUND.iter().find(|(word, _)| *word == object.plugin) {
        let own =
            &["aovs", "max_error", "p_value", "max_sample_factor", "resolution", "quality", "gradients"];
        world.check(object, own, &["clamp_neighbor", "clamp_screen", "overture", "quality_adjustment"]);
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
    if object.plugin != *ours && ["bdpt", "sppm"].contains(ours) || *theirs == "vpl" || *theirs == "sppm" {
        takes.extend(OF_OLD);
    }
    let hides = ["path", "volpath"].contains(ours);
    let mut lacks = vec!["hide_emitters"];
    if hides {
        takes.append(&mut lacks);
    }
    world.check(object, &takes, &lacks);
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
    let mut params = Params::new().int("maxdepth", bounces).int("roulettedepth", roulette);
    if hides && object.truth("hide_emitters", false, world.said) {
        params = params.bool("hideemitters", true);
    }
    if *ours == "sppm" {
        params = photons(world, object, params);
    }
    Some(node(ours, params, object.at))
}

/// How many photons a pass sends, and the first radius, where they are given.
fn photons(world: &mut World<'_>, object: &Object, params: Params) -> Params {
    let mut above_zero = |names: [&str; 2]| {
        names.into_iter().find_map(|name| object.number(name, world.said)).filter(|v| *v > 0.0)
    };
    let params = match above_zero(["photon_count", "global_photons"]) {
        Some(count) => params.int("photonsperiteration", count.min(1e9) as i32),
        None => params,
    };
    match above_zero(["initial_radius", "radius"]) {
        Some(radius) => params.float("radius", radius as f32),
        None => params,
    }
}
