//! Ray trees that are known without tracing a ray (D2): a plate of glass, and two mirrors that face each other.
use durer::{
    Options, Prepared,
    probe::{ChosenBy, Limit, RayKind, RayTree, StopReason, TreeNode},
};
use durer_tests::scene;

/// The tree of one pixel that looks along +z from the origin.
fn tree(integrator: &str, world: &str) -> (Prepared, RayTree) {
    let text = format!(
        "Film \"rgb\" \"integer xresolution\" 1 \"integer yresolution\" 1\n\
         Sampler \"independent\" \"integer pixelsamples\" 1\nCamera \"perspective\" \"float fov\" 1\n\
         Integrator \"whitted\" {integrator}\nWorldBegin\n{world}"
    );
    let prepared = scene(&text, &Options::default());
    let tree = prepared.job().record([0, 0], 0).0;
    (prepared, tree)
}

fn close(a: f32, b: f64) -> bool {
    (f64::from(a) - b).abs() <= 2e-6 * b.abs().max(1e-6)
}

/// Where a ray is that meets a plate from z = 2 to z = 3 upright.
#[derive(Clone, Copy, PartialEq)]
enum Place {
    Before,
    Inside,
    Behind,
}

/// What is expected of a ray.
struct Expected {
    parent: Option<u32>,
    kind: RayKind,
    depth: u32,
    throughput: f64,
    /// Where it hits, if it does.
    z: Option<f64>,
    result: f64,
    stop: Option<StopReason>,
}

/// The tree of a plate with R = 0.04 before a sky of radiance 1, as the lecture's recursion has it: a mirrored ray, then a
/// refracted one, at each surface. Derived from the places only.
struct Plate {
    max_depth: u32,
    nodes: Vec<Expected>,
}

impl Plate {
    const R: f64 = 0.04;

    fn follow(
        &mut self,
        (at, forward): (Place, bool),
        kind: RayKind,
        parent: Option<u32>,
        throughput: f64,
    ) -> f64 {
        let depth = parent.map_or(0, |p| self.nodes[p as usize].depth + 1);
        let id = self.nodes.len() as u32;
        let z = match (at, forward) {
            (Place::Before, true) | (Place::Inside, false) => Some(2.0),
            (Place::Inside, true) => Some(3.0),
            _ => None,
        };
        let is_traced = depth <= self.max_depth;
        let stop = match (is_traced, z) {
            (false, _) => Some(StopReason::DepthLimit),
            (true, None) => Some(StopReason::MissedScene),
            (true, Some(_)) => None,
        };
        let z = z.filter(|_| is_traced);
        self.nodes.push(Expected { parent, kind, depth, throughput, z, result: 0.0, stop });
        let result = match (is_traced, z) {
            (false, _) => 0.0,
            // The sky shines from behind the plate only.
            (true, None) => f64::from(u8::from(at == Place::Behind)),
            (true, Some(_)) => {
                let beyond = match (at, forward) {
                    (Place::Inside, true) => Place::Behind,
                    (Place::Inside, false) => Place::Before,
                    _ => Place::Inside,
                };
                let (r, t) = (Self::R, 1.0 - Self::R);
                r * self.follow((at, !forward), RayKind::Reflection, Some(id), throughput * r)
                    + t * self.follow((beyond, forward), RayKind::Refraction, Some(id), throughput * t)
            }
        };
        self.nodes[id as usize].result = result;
        result
    }
}

#[test]
fn a_plate_of_glass_has_exactly_the_rays_that_it_should_d2() {
    let world = "LightSource \"gradientsky\" \"rgb zenith\" [1 1 1] \"rgb horizon\" [1 1 1] \"rgb ground\" [0 0 0] \
         \"vector3 up\" [0 0 1]\nMaterial \"dielectric\" \"float eta\" 1.5\n\
         Shape \"plane\" \"point3 point\" [0 0 2] \"vector3 normal\" [0 0 -1]\n\
         Shape \"plane\" \"point3 point\" [0 0 3] \"vector3 normal\" [0 0 1]\n";
    for max_depth in [0, 1, 2, 3, 4] {
        // Of the two that a surface sends on one is inside and meets the other surface; the other leaves.
        let rays = 2 * max_depth as usize + 3;
        let mut plate = Plate { max_depth, nodes: Vec::new() };
        plate.follow((Place::Before, true), RayKind::Eye, None, 1.0);
        assert_eq!(plate.nodes.len(), rays, "depth {max_depth}: by the formula");
        let (_, tree) = tree(&format!("\"integer maxdepth\" {max_depth} \"float mincontribution\" 0"), world);
        assert_eq!(tree.nodes.len(), rays, "depth {max_depth}");
        for (id, (node, expected)) in tree.nodes.iter().zip(&plate.nodes).enumerate() {
            let is = (node.parent, node.kind, node.depth, node.stop);
            assert_eq!(is, (expected.parent, expected.kind, expected.depth, expected.stop), "ray {id}");
            assert!(close(node.throughput.max(), expected.throughput), "ray {id}: {:?}", node.throughput);
            assert!(close(node.result.max(), expected.result), "ray {id}: {:?}", node.result);
            assert_eq!(node.hit.map(|h| f64::from(h.p.z).round()), expected.z, "ray {id}");
            if let Some(z) = expected.z {
                check_hit(node, z);
            }
        }
        let lost: f64 =
            plate.nodes.iter().filter(|n| n.stop == Some(StopReason::DepthLimit)).map(|n| n.throughput).sum();
        assert!(close(tree.killed().max(), lost) && lost > 0.0);
        // Light that is cut off came from a sky of radiance 1: the bound holds, as the infinite sum is T / (1 + R).
        let lacks = 0.96 / 1.04 - f64::from(tree.nodes[0].result.max());
        assert!(lacks <= lost * (1.0 + 1e-6) && lacks >= 0.0, "{lacks} of at most {lost}");
    }
}

/// What a ray that meets the plate at `z` upright must know.
fn check_hit(node: &TreeNode, z: f64) {
    let shading = node.shading.as_ref().expect("shaded");
    let fresnel = shading.fresnel.expect("glass");
    assert!(close(fresnel.reflect, 0.04) && close(fresnel.transmit, 0.96) && !fresnel.is_total);
    let media = shading.media.expect("glass");
    let enters = (z == 2.0) == (node.d.z > 0.0);
    assert_eq!(node.hit.map(|h| h.from_outside), Some(enters));
    let [air, glass] = [1.0, 1.5];
    let (n1, n2) = if enters { (air, glass) } else { (glass, air) };
    assert!(close(media.n1, n1) && close(media.n2, n2), "{media:?}");
    assert_eq!(
        (media.before.iter().count(), media.after.iter().count()),
        (usize::from(!enters), usize::from(enters))
    );
    match fresnel.critical_angle {
        Some(angle) => assert!(!enters && close(angle, (1.0f64 / 1.5).asin())),
        None => assert!(enters),
    }
    let lobes: Vec<_> = shading.lobes.iter().map(|l| l.name).collect();
    assert_eq!((lobes, shading.arrived.max()), (vec!["glass"], 1.0));
    assert!((node.hit.expect("hit").cos - 1.0).abs() < 1e-6);
}

/// Two mirrors of reflectance `k` at z = 1 and z = -1.
fn mirrors(k: f64, integrator: &str) -> RayTree {
    let world = format!(
        "LightSource \"infinite\" \"rgb L\" [1 1 1]\nMaterial \"mirror\" \"rgb reflectance\" [{k} {k} {k}]\n\
         Shape \"plane\" \"point3 point\" [0 0 1] \"vector3 normal\" [0 0 -1]\n\
         Shape \"plane\" \"point3 point\" [0 0 -1] \"vector3 normal\" [0 0 1]\n"
    );
    tree(integrator, &world).1
}

/// The tree is one row of reflections, each `k` times the one before; its last ray.
fn row(tree: &RayTree, k: f64) -> &TreeNode {
    for (i, node) in tree.nodes.iter().enumerate() {
        assert_eq!((node.parent, node.depth), (i.checked_sub(1).map(|p| p as u32), i as u32));
        assert!((f64::from(node.throughput.max()) / k.powi(i as i32) - 1.0).abs() < 1e-5);
        let chosen = node.chosen.map(|c| (c.by, c.lobe));
        assert_eq!(chosen, (i > 0).then_some((ChosenBy::Sharp, Some("mirror"))));
        assert_eq!(node.stop.is_none(), i + 1 < tree.nodes.len());
    }
    tree.nodes.last().expect("a ray")
}

#[test]
fn facing_mirrors_stop_by_depth_d2() {
    for (k, depth) in [(0.9, 1), (0.9, 5), (0.5, 20), (1.0, 100)] {
        let tree = mirrors(k, &format!("\"integer maxdepth\" {depth} \"float mincontribution\" 0"));
        let last = row(&tree, k);
        assert_eq!((last.stop, last.depth), (Some(StopReason::DepthLimit), depth + 1));
        let limit = Limit { value: depth as f32 + 1.0, threshold: depth as f32 };
        assert_eq!(last.limit, Some(limit));
        assert_eq!(tree.killed(), last.throughput);
    }
}

#[test]
fn facing_mirrors_stop_by_contribution_d2() {
    for (k, e) in [(0.5f64, 1.0f64 / 256.0), (0.9, 0.01), (0.7, 0.003), (0.99, 0.1)] {
        let tree = mirrors(k, &format!("\"integer maxdepth\" 1000 \"float mincontribution\" {e}"));
        let last = row(&tree, k);
        assert_eq!(last.stop, Some(StopReason::ContributionBelowCutoff));
        assert_eq!(f64::from(last.depth), (e.ln() / k.ln()).ceil(), "k {k}, e {e}");
        let limit = last.limit.expect("a limit");
        assert_eq!((limit.value, limit.threshold), (last.throughput.max(), e as f32));
        assert!(limit.value <= limit.threshold);
    }
}
