//! The ray tree for programs. Field names are keys: a contract.
use durer::{
    View,
    math::Point3,
    probe::{RayKind, StopReason, TreeNode},
    spectrum::{Basis, Spectrum},
};
use serde::Serialize;

use super::Traced;

/// The tree of a sample.
#[derive(Serialize)]
pub(super) struct Tree<'a> {
    version: u32,
    scene: &'a str,
    integrator: &'a str,
    width: u32,
    height: u32,
    pixel: [u32; 2],
    sample: u32,
    rgb: [f32; 3],
    nodes: Vec<Node<'a>>,
}

#[derive(Serialize)]
struct Node<'a> {
    id: usize,
    parent: Option<u32>,
    kind: RayKind,
    depth: u32,
    origin: [f64; 3],
    direction: [f32; 3],
    t: Option<f32>,
    point: Option<[f64; 3]>,
    object: Option<&'a str>,
    primitive: Option<u32>,
    normal: Option<[f32; 3]>,
    uv: Option<[f32; 2]>,
    side: Option<&'static str>,
    weight: [f32; 3],
    throughput: [f32; 3],
    local: [f32; 3],
    contribution: [f32; 3],
    result: [f32; 3],
    stop: Option<StopReason>,
    lost: [f32; 3],
    light: Option<Light<'a>>,
    blocker: Option<&'a str>,
    tests: Tests,
}

#[derive(Serialize)]
struct Light<'a> {
    index: u32,
    name: Option<&'a str>,
    point: Option<[f64; 3]>,
    visible: bool,
    passed: [f32; 3],
    unoccluded: [f32; 3],
}

#[derive(Serialize)]
struct Tests {
    boxes: u32,
    primitives: u32,
}

impl<'a> Tree<'a> {
    pub(super) fn new(traced: &'a Traced<'a>) -> Self {
        let view = &traced.prepared.scene.view;
        Self {
            version: 1,
            scene: traced.scene,
            integrator: &traced.prepared.integrator_name,
            width: view.width,
            height: view.height,
            pixel: traced.pixel,
            sample: traced.sample,
            rgb: traced.rgb,
            nodes: traced.tree.nodes.iter().enumerate().map(|(id, n)| node(traced, id, n)).collect(),
        }
    }
}

fn node<'a>(traced: &'a Traced<'a>, id: usize, node: &'a TreeNode) -> Node<'a> {
    let scene = &traced.prepared.scene;
    let place = |p: Point3| world(&scene.view, p);
    let hit = node.hit.as_ref();
    let light = node.light.as_ref();
    Node {
        id,
        parent: node.parent,
        kind: node.kind,
        depth: node.depth,
        origin: place(node.o),
        direction: node.d.normalize().to_array(),
        t: node.length(),
        point: hit.map(|h| place(h.p)),
        object: hit.map(|h| scene.object(h.object).name.as_str()),
        primitive: hit.map(|h| scene.resolve(&h.hit).1),
        normal: hit.map(|h| h.n_s.to_array()),
        uv: hit.map(|h| h.uv),
        side: hit.map(|h| if h.from_outside { "outside" } else { "inside" }),
        weight: rgb(node.weight),
        throughput: rgb(node.throughput),
        local: rgb(node.local),
        contribution: rgb(node.contribution()),
        result: rgb(node.result),
        stop: node.stop,
        lost: rgb(node.lost),
        light: light.map(|l| Light {
            index: l.light,
            name: scene.light_names.get(l.light as usize).map(String::as_str),
            point: l.point.map(place),
            visible: l.visible,
            passed: rgb(l.passed),
            unoccluded: rgb(l.unoccluded),
        }),
        blocker: light.and_then(|l| l.blocker).map(|b| scene.object(b).name.as_str()),
        tests: Tests { boxes: node.node_tests, primitives: node.primitive_tests },
    }
}

fn world(view: &View, p: Point3) -> [f64; 3] {
    view.to_world(p)
}

fn rgb(s: Spectrum) -> [f32; 3] {
    Basis::Rgb.to_rgb(s)
}
