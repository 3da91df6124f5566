//! The recorder: watches one sample and keeps everything.
use std::{cell::RefCell, time::Instant};

use durer_accel::{Hit, TraversalProbe};
use durer_core::{Id, math::Ray, spectrum::Spectrum};
use durer_model::{Surface, texture::TextureLookup};

use super::{
    Choice, Clock, Detail, Floating, Gathered, LightEvent, Limit, NodeId, Probe, RayKind, RayTree, Shaded,
    StopReason, TreeHit, TreeMedia, TreeNode, TreeShading,
    walk::{self, Step},
};
use crate::{Object, PathRay, SampleCx};

/// Makes the [`RayTree`] of a sample.
pub struct Recorder<'a> {
    cx: SampleCx<'a>,
    detail: Detail,
    tree: RayTree,
    /// How the next ray came about.
    chosen: Option<Choice>,
    /// When each ray was announced, if that matters.
    begun: Vec<Instant>,
    /// What the first rays met on their walks, if that matters.
    walks: Vec<Vec<Step>>,
}

impl<'a> Recorder<'a> {
    /// A recorder that has seen nothing.
    pub fn new(cx: &SampleCx<'a>, detail: Detail) -> Self {
        Self {
            cx: *cx,
            detail,
            tree: RayTree { basis: cx.basis, ..RayTree::default() },
            chosen: None,
            begun: Vec::new(),
            walks: Vec::new(),
        }
    }

    /// How the ray came about that is traced next.
    pub fn chose(&mut self, choice: &Choice) {
        self.chosen = Some(*choice);
    }

    /// The tree. `value` is what the film got: if it is infinite or NaN, the film leaves the sample out.
    pub fn finish(mut self, value: &[f32; 3]) -> RayTree {
        if !value.iter().all(|v| v.is_finite())
            && let Some(eye) = self.tree.nodes.first_mut()
        {
            eye.stop = Some(StopReason::NanRejected);
            eye.lost = eye.throughput;
            self.tree.bad = self.tree.first_bad();
        }
        for (node, steps) in self.tree.nodes.iter_mut().zip(&self.walks) {
            node.walk = walk::boxes(&self.cx.scene.accel, node, steps);
        }
        self.tree
    }

    /// Notes a step of one of the first rays.
    fn step(&mut self, id: NodeId, step: Step) {
        let index = id.0.map_or(0, |i| i as usize);
        if index < self.detail.walks {
            self.walks.resize_with(self.walks.len().max(index + 1), Vec::new);
            self.walks[index].push(step);
        }
    }

    fn node(&mut self, id: NodeId) -> &mut TreeNode {
        let index = id.0.map_or(0, |i| i as usize);
        &mut self.tree.nodes[index]
    }

    /// What the textures of a hit say, asked once more.
    fn textures(&self, ray: &Ray, object: Id<Object>, hit: &Hit) -> Vec<TextureLookup> {
        let scene = self.cx.scene;
        if scene.textures.is_empty() {
            return Vec::new();
        }
        let log = RefCell::default();
        let cx = durer_model::ShadeCx { log: Some(&log), ..self.cx.shade() };
        let mut surface = scene.surface(ray, hit).1;
        let material = scene.material(object);
        material.emission(&cx, &surface.texture_at());
        material.bsdf(&cx, &mut surface, -ray.d);
        log.into_inner()
    }
}

impl TraversalProbe for Recorder<'_> {
    type Id = NodeId;
    fn node(&mut self, id: NodeId, bvh_node: u32) {
        Recorder::node(self, id).node_tests += 1;
        self.step(id, Step::Node(bvh_node));
    }
    fn primitive(&mut self, id: NodeId, instance: u32, _: u32) {
        let is_triangle = self.cx.scene.is_mesh(instance);
        let node = Recorder::node(self, id);
        node.primitive_tests += 1;
        node.triangle_tests += u32::from(is_triangle);
        self.step(id, Step::Primitive(instance));
    }
}

impl Probe for Recorder<'_> {
    const RECORDS: bool = true;

    fn is_full(&self) -> bool {
        self.tree.nodes.len() >= self.detail.rays
    }
    fn chosen(&mut self, choice: &Choice) {
        self.chose(choice);
    }
    fn ray(&mut self, parent: NodeId, ray: &PathRay, kind: RayKind) -> NodeId {
        let chosen = self.chosen.take();
        self.tree.nodes.push(TreeNode {
            parent: parent.0,
            kind,
            depth: ray.depth,
            o: ray.ray.o,
            d: ray.ray.d,
            path: *ray,
            weight: ray.weight,
            throughput: ray.throughput,
            chosen,
            random: chosen.iter().flat_map(|c| c.light_choice.into_iter().chain(c.random)).collect(),
            local: Spectrum::BLACK,
            result: Spectrum::BLACK,
            hit: None,
            shading: None,
            floating: None,
            gathered: None,
            light: None,
            stop: None,
            limit: None,
            lost: Spectrum::BLACK,
            node_tests: 0,
            primitive_tests: 0,
            triangle_tests: 0,
            ns: None,
            walk: Vec::new(),
        });
        if self.detail.clock == Clock::On {
            self.begun.push(Instant::now());
        }
        NodeId(Some(self.tree.nodes.len() as u32 - 1))
    }
    fn surface(&mut self, id: NodeId, object: Id<Object>, hit: &Hit, surface: &Surface) {
        let scene = self.cx.scene;
        let node = Recorder::node(self, id);
        let wo = -node.d;
        node.hit = Some(TreeHit {
            object,
            hit: *hit,
            p: surface.p,
            n_g: surface.n_g,
            n_s: surface.n_s,
            uv: [surface.uv.x, surface.uv.y],
            from_outside: surface.is_outside(wo),
            cos: surface.n_s.dot(wo).abs().min(1.0),
            triangle: scene.triangle(hit, node.path.ray.time),
        });
    }
    fn shaded(&mut self, id: NodeId, event: &Shaded<'_>) {
        let (media, basis) = (&self.cx.scene.media, self.cx.basis);
        let fresnel = event.bsdf.fresnel(event.wo);
        let is_empty = event.before.is_empty() && event.after.is_empty();
        let of_media = (!is_empty).then(|| {
            let (n1, n2) = match fresnel {
                // As it was refracted, also where the account of the bodies is wrong.
                Some(fresnel) => {
                    let n2 = event.after.eta(media, &basis);
                    (n2 / fresnel.eta, n2)
                }
                None => (event.before.eta(media, &basis), event.before.eta(media, &basis)),
            };
            TreeMedia { before: event.before, after: event.after, n1, n2 }
        });
        let node = Recorder::node(self, id);
        let (ray, hit) = (node.path.ray, node.hit);
        let textures = hit.map_or_else(Vec::new, |h| self.textures(&ray, h.object, &h.hit));
        Recorder::node(self, id).shading = Some(TreeShading {
            lobes: event.bsdf.lobes().map(durer_model::bsdf::Lobe::view).collect(),
            fresnel,
            media: of_media,
            arrived: event.arrived,
            emission: event.emission,
            ambient: event.ambient,
            blurred_sky: event.blurred_sky,
            textures,
        });
    }
    fn floating(&mut self, id: NodeId, event: &Floating) {
        Recorder::node(self, id).floating = Some(*event);
    }
    fn gathered(&mut self, id: NodeId, event: &Gathered) {
        Recorder::node(self, id).gathered = Some(*event);
    }
    fn met_light(&mut self, id: NodeId, other_pdf: f32, mis: f32) {
        if let Some(chosen) = &mut Recorder::node(self, id).chosen {
            (chosen.other_pdf, chosen.mis) = (Some(other_pdf), Some(mis));
        }
    }
    fn light(&mut self, id: NodeId, event: &LightEvent) {
        Recorder::node(self, id).light = Some(*event);
    }
    fn local(&mut self, id: NodeId, radiance: Spectrum) {
        Recorder::node(self, id).local = radiance;
    }
    fn limit(&mut self, id: NodeId, limit: Limit) {
        Recorder::node(self, id).limit = Some(limit);
    }
    fn stop(&mut self, id: NodeId, reason: StopReason, lost: Spectrum) {
        let node = Recorder::node(self, id);
        node.stop = Some(reason);
        node.lost = lost;
    }
    fn result(&mut self, id: NodeId, radiance: Spectrum) {
        let begun = id.0.and_then(|i| self.begun.get(i as usize));
        let ns = begun.map(|begun| begun.elapsed().as_nanos() as u64);
        let node = Recorder::node(self, id);
        node.result = radiance;
        node.ns = ns;
    }
}
