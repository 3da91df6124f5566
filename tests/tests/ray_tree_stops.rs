//! Every reason for which rays end today is given by some scene (D3), names what is the case, and keeps what was lost.
use durer::{
    Options, Prepared,
    probe::{Detail, RayKind, RayTree, StopReason, TreeNode},
};
use durer_tests::scene;

/// One pixel that looks along +z from the origin.
fn look(integrator: &str, world: &str) -> Prepared {
    scene(
        &format!(
            "Film \"rgb\" \"integer xresolution\" 1 \"integer yresolution\" 1\n\
             Sampler \"independent\" \"integer pixelsamples\" 1\nCamera \"perspective\" \"float fov\" 1\n\
             Integrator {integrator}\nWorldBegin\n{world}"
        ),
        &Options::default(),
    )
}

const SKY: &str = "LightSource \"infinite\" \"rgb L\" [1 1 1]\n";
const LAMP: &str = "LightSource \"point\" \"rgb I\" [9 9 9] \"point3 from\" [1 2 0]\n";
const GREY: &str = "Material \"diffuse\" \"rgb reflectance\" [.5 .5 .5]\n";
const WALL: &str =
    "Shape \"plane\" \"string name\" \"wall\" \"point3 point\" [0 0 4] \"vector3 normal\" [0 0 -1]\n";
const MIRRORS: &str = "Material \"mirror\" \"rgb reflectance\" [.5 .5 .5]\n\
    Shape \"plane\" \"point3 point\" [0 0 1] \"vector3 normal\" [0 0 -1]\n\
    Shape \"plane\" \"point3 point\" [0 0 -1] \"vector3 normal\" [0 0 1]\n";

/// The scenes that give a reason, with their integrators; `None` for reasons of integrators to come. A new reason does not
/// compile before somebody has said how to reach it.
fn scenes(reason: StopReason) -> Option<Vec<(&'static str, String)>> {
    let lit = format!("{LAMP}{GREY}{WALL}");
    let ink = "Material \"dielectric\" \"float eta\" 1 \"rgb absorption\" [1e9 1e9 1e9]\n";
    Some(match reason {
        StopReason::MissedScene => vec![("\"whitted\"", SKY.to_owned()), ("\"cast\"", SKY.to_owned())],
        StopReason::HitLight | StopReason::OpaqueNoChildren => vec![("\"whitted\"", lit)],
        StopReason::LightOccluded => {
            let screen = "Shape \"polygon\" \"string name\" \"screen\" \"point3 P\" [-5 1 -5  5 1 -5  5 1 5  -5 1 5]\n";
            let glass = "Material \"dielectric\"\nShape \"plane\" \"point3 point\" [0 1 0] \"vector3 normal\" [0 -1 0]\n";
            vec![
                ("\"whitted\"", format!("{lit}{screen}")),
                ("\"whitted\" \"string shadows\" \"tinted\"", format!("{lit}{screen}")),
                ("\"whitted\"", format!("{lit}{glass}")),
            ]
        }
        StopReason::DepthLimit => vec![("\"whitted\" \"integer maxdepth\" 2", format!("{SKY}{MIRRORS}"))],
        StopReason::ContributionBelowCutoff => {
            vec![("\"whitted\" \"float mincontribution\" 0.1", format!("{SKY}{MIRRORS}"))]
        }
        StopReason::TirNoRefraction => {
            // From inside a prism at 45 degrees: beyond the critical angle of 41.8.
            let prism = "Material \"dielectric\" \"float eta\" 1.5\n\
                Shape \"plane\" \"point3 point\" [0 0 1] \"vector3 normal\" [0 0 -1]\n\
                Shape \"plane\" \"point3 point\" [0 0 2] \"vector3 normal\" [0 1 1]\n";
            let constant = "Material \"classic\" \"rgb transmission\" [.4 .4 .4] \"rgb reflection\" [.3 .3 .3] \"float eta\" 1.5\n\
                Shape \"plane\" \"point3 point\" [0 0 2] \"vector3 normal\" [0 1 1]\nShape \"sphere\" \"float radius\" 9\n";
            vec![("\"whitted\"", format!("{SKY}{prism}")), ("\"whitted\"", format!("{SKY}{constant}"))]
        }
        StopReason::Absorbed => {
            let black = "Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n";
            let faded = "Material \"mirror\"\nShape \"plane\" \"point3 point\" [0 0 4] \"vector3 normal\" [0 0 -1]\n\
                Material \"diffuse\"\nShape \"plane\" \"point3 point\" [0 0 -9] \"vector3 normal\" [0 0 1]\n";
            let body = "Shape \"sphere\" \"float radius\" 3\n";
            vec![
                ("\"whitted\"", format!("{LAMP}{black}{WALL}")),
                ("\"whitted\" \"float attenuationdistance\" 5", format!("{SKY}{faded}")),
                // A shadow ray through ink, seen from inside.
                ("\"whitted\" \"string shadows\" \"tinted\"", {
                    let far = "LightSource \"distant\" \"rgb L\" [1 1 1] \"point3 from\" [0 5 -3] \"point3 to\" [0 0 0]\n";
                    let slab = "Shape \"plane\" \"point3 point\" [0 0.5 0] \"vector3 normal\" [0 -1 0]\n\
                                Shape \"plane\" \"point3 point\" [0 1.5 0] \"vector3 normal\" [0 1 0]\n";
                    format!("{far}{ink}{slab}{GREY}AttributeBegin\nTranslate 0 0 6\n{body}AttributeEnd\n")
                }),
            ]
        }
        StopReason::LightBehindSurface => {
            let behind = "LightSource \"point\" \"rgb I\" [9 9 9] \"point3 from\" [0 0 9]\n";
            vec![
                ("\"whitted\"", format!("{behind}{GREY}{WALL}")),
                ("\"distributed\"", format!("{behind}{GREY}{WALL}")),
            ]
        }
        StopReason::BelowHorizon => {
            // Vertex normals that lean towards a lamp behind the triangle, and microfacets that lean too far.
            let lamp = "LightSource \"point\" \"rgb I\" [9 9 9] \"point3 from\" [9 0 5]\n";
            let leaning = "Shape \"trianglemesh\" \"point3 P\" [-9 -9 4 0 9 4 9 -9 4] \"integer indices\" [0 1 2] \
                \"normal N\" [.7 0 -.7 .7 0 -.7 .7 0 -.7]\n";
            let rough = "Material \"principled\" \"float metallic\" 1 \"float roughness\" 1\n\
                Shape \"plane\" \"point3 point\" [0 0 1] \"vector3 normal\" [0 1 -.05]\n";
            let frosted = "Material \"dielectric\" \"float roughness\" 1\n\
                Shape \"plane\" \"point3 point\" [0 0 1] \"vector3 normal\" [0 1 -.05]\n";
            let many = "\"distributed\" \"integer glossrays\" 64 \"string sampling\" \"nested\" \"integer maxdepth\" 1";
            vec![
                ("\"whitted\"", format!("{lamp}{GREY}{leaning}")),
                (many, format!("{SKY}{rough}")),
                (many, format!("{SKY}{frosted}")),
            ]
        }
        StopReason::NanRejected => {
            let sun = "LightSource \"distant\" \"rgb L\" [3e38 3e38 3e38] \"float scale\" 3e38 \
                \"point3 from\" [0 0 0] \"point3 to\" [0 0 1]\n";
            vec![("\"whitted\"", format!("{sun}{GREY}{WALL}")), ("\"cast\"", format!("{sun}{GREY}{WALL}"))]
        }
        StopReason::Cancelled => vec![("\"whitted\" \"float mincontribution\" 0", format!("{SKY}{MIRRORS}"))],
        StopReason::Roulette => {
            let dark = "Material \"diffuse\" \"rgb reflectance\" [.01 .02 .03]\n";
            vec![("\"path\" \"integer roulettedepth\" 0", format!("{SKY}{dark}{WALL}"))]
        }
        StopReason::Clamped => return None,
    })
}

fn record(prepared: &Prepared, reason: StopReason) -> RayTree {
    let rays = if reason == StopReason::Cancelled { 4 } else { usize::MAX };
    prepared.job().record_in([0, 0], 0, Detail { rays, ..Detail::default() }).0
}

/// What must be true of a ray that ended for its reason.
fn check(node: &TreeNode, tree: &RayTree, what: &str) {
    let reason = node.stop.expect("it ended");
    let is_shadow = node.kind == RayKind::Shadow;
    assert_eq!(
        node.limit.is_some(),
        matches!(reason, StopReason::DepthLimit | StopReason::ContributionBelowCutoff | StopReason::Roulette),
        "{what}"
    );
    if reason.is_untraced() {
        assert!(
            node.hit.is_none() && node.result.is_black() && node.node_tests + node.primitive_tests == 0,
            "{what}"
        );
    } else if reason != StopReason::NanRejected {
        assert!(node.lost.is_black(), "{what}");
    }
    match reason {
        StopReason::MissedScene => assert!(node.hit.is_none() && !is_shadow, "{what}"),
        StopReason::HitLight => assert!(is_shadow && node.light.is_some_and(|l| l.visible), "{what}"),
        StopReason::LightOccluded => {
            assert!(is_shadow && node.light.is_some_and(|l| !l.visible && l.blocker.is_some()), "{what}")
        }
        StopReason::OpaqueNoChildren => assert!(node.hit.is_some(), "{what}"),
        StopReason::Absorbed if is_shadow => {
            assert!(
                node.light.is_some_and(|l| !l.visible && l.passed.is_black() && l.blocker.is_none()),
                "{what}"
            )
        }
        StopReason::Absorbed => assert!(node.hit.is_some() && node.shading.is_some(), "{what}"),
        StopReason::DepthLimit | StopReason::ContributionBelowCutoff | StopReason::Cancelled => {
            assert!(node.lost == node.throughput && node.lost.max() > 0.0, "{what}")
        }
        // Fresnel's equations hand all of it to the reflected ray; Whitted's constants lose it.
        StopReason::TirNoRefraction => {
            assert!(node.lost == node.throughput && node.kind == RayKind::Refraction, "{what}")
        }
        StopReason::LightBehindSurface => {
            assert!(is_shadow && node.light.is_some() && node.lost.is_black(), "{what}")
        }
        StopReason::BelowHorizon => assert!(node.lost == node.throughput && node.lost.max() > 0.0, "{what}"),
        StopReason::NanRejected => {
            let bad = &tree.nodes[tree.bad.expect("it comes from somewhere") as usize];
            assert!(
                node.parent.is_none() && !bad.result.is_finite() && node.lost == node.throughput,
                "{what}"
            );
        }
        // Those that live carry what these do not.
        StopReason::Roulette => {
            assert!(node.limit.is_some_and(|l| l.value >= l.threshold) && node.lost.is_black(), "{what}")
        }
        StopReason::Clamped => panic!("{what}: nothing gives that yet"),
    }
}

#[test]
fn every_reason_is_given_by_a_scene_or_reserved_d3() {
    for reason in StopReason::ALL {
        let Some(scenes) = scenes(reason) else {
            assert!(StopReason::RESERVED.contains(&reason), "{}", reason.word());
            continue;
        };
        assert!(!StopReason::RESERVED.contains(&reason));
        for (number, (integrator, world)) in scenes.iter().enumerate() {
            let tree = record(&look(integrator, world), reason);
            let ended: Vec<_> = tree.nodes.iter().filter(|n| n.stop == Some(reason)).collect();
            let what = format!("{} in scene {number}", reason.word());
            let found: Vec<_> =
                tree.nodes.iter().map(|n| (n.kind.word(), n.stop.map(StopReason::word))).collect();
            assert!(!ended.is_empty(), "{what}: {found:?}");
            ended.iter().for_each(|node| check(node, &tree, &what));
        }
    }
}

#[test]
fn every_ray_ends_or_goes_on() {
    for (integrator, world) in StopReason::ALL.into_iter().filter_map(scenes).flatten() {
        let prepared = look(integrator, &world);
        let tree = prepared.job().record([0, 0], 0).0;
        for (node, children) in tree.nodes.iter().zip(tree.children()) {
            let goes_on = children.iter().any(|&c| tree.nodes[c as usize].kind != RayKind::Shadow);
            assert!(node.stop.is_some() || goes_on, "{:?} ends for no reason", node.kind);
        }
        // Rays that were given up are not counted as traced.
        let mut out = durer::Contribution::default();
        let cx = durer::SampleCx { scene: &prepared.scene, basis: Default::default() };
        prepared.integrator.sample(
            &cx,
            &durer::PathRay { media: Default::default(), ..tree.nodes[0].path },
            &mut out,
        );
        assert_eq!(out.rays, tree.nodes.iter().filter(|n| n.is_traced()).count() as u64);
    }
}

#[test]
fn counters_and_records_tell_the_same_stops() {
    for reason in StopReason::ALL {
        // What only those who record see: the film's verdict, and that the record is full.
        if matches!(reason, StopReason::NanRejected | StopReason::Cancelled) {
            continue;
        }
        for (integrator, world) in scenes(reason).into_iter().flatten() {
            let prepared = look(integrator, &world);
            let tree = record(&prepared, reason);
            let rendered = prepared.job().render(durer::Gather::Counters, &(), &Default::default());
            let counters = rendered.counters.expect("asked for");
            for r in StopReason::ALL {
                let recorded = tree.nodes.iter().filter(|n| n.stop == Some(r)).count() as u64;
                assert_eq!(counters.stops(r), recorded, "{} where {} is wanted", r.word(), reason.word());
            }
            assert_eq!(counters.all_rays(), rendered.rays);
        }
    }
}

#[test]
fn the_film_leaves_out_what_the_record_calls_rejected() {
    let (integrator, world) = &scenes(StopReason::NanRejected).expect("scenes")[0];
    let prepared = look(integrator, world);
    let rendered = prepared.job().render(Default::default(), &(), &Default::default());
    assert_eq!((rendered.bad_samples, rendered.film.pixels()[0].weight), (1, 0.0));
    let (tree, rgb) = prepared.job().record([0, 0], 0);
    assert!(rgb.iter().all(|v| !v.is_finite()));
    let bad = &tree.nodes[tree.bad.expect("a source") as usize];
    assert_eq!((bad.kind, bad.stop), (RayKind::Shadow, Some(StopReason::HitLight)));
}
