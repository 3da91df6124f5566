//! From what the renderer recorded to the document.
use std::sync::atomic::AtomicBool;

use crate::{
    Prepared, View,
    drive::{Antialias, Gather, Taken},
    film::Tile,
    math::Point3,
    probe::{RayTree, TreeNode},
    spectrum::{Basis, Spectrum},
};

use super::{
    document::{Light, Node, Tests, Tree, VERSION},
    ghost::GhostScene,
    number::{Metres, Number, Place, Rgb, rgb},
    page::{Dimensions, Page},
    picture::Thumbnail,
};

/// A scene that can be traced, and what it is called.
#[derive(Clone, Copy)]
pub struct Subject<'a> {
    /// As the user named it.
    pub name: &'a str,
    /// The scene with its settings.
    pub prepared: &'a Prepared,
}

/// What goes into a page beside the trees that were asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surroundings {
    /// Nothing.
    None,
    /// The picture, small, and the scene's camera, lights and geometry.
    Scene,
    /// And trees of the pixel's other samples, up to so many nodes in all.
    SceneAndSamples(usize),
}

impl Subject<'_> {
    /// The trees of some samples of a pixel, and what belongs to them.
    pub fn page(&self, pixel: [u32; 2], chosen: &[u32], around: Surroundings) -> Page {
        let samples = self.samples(pixel);
        let mut trees: Vec<Tree> = chosen.iter().map(|&s| self.tree(pixel, &samples, s)).collect();
        if let Surroundings::SceneAndSamples(most) = around {
            let mut nodes: usize = trees.iter().map(|t| t.nodes.len()).sum();
            for sample in (0..samples.len() as u32).filter(|s| !chosen.contains(s)) {
                let tree = self.tree(pixel, &samples, sample);
                nodes += tree.nodes.len();
                if nodes > most {
                    break;
                }
                trees.push(tree);
            }
        }
        let with_scene = around != Surroundings::None;
        Page {
            version: VERSION,
            trees,
            other: None,
            values: samples.iter().map(|s| rgb(s.rgb.unwrap_or_default())).collect(),
            dims: samples
                .iter()
                .map(|s| Dimensions {
                    film: s.film.map(Number),
                    lens: s.lens.map(|l| l.map(Number)),
                    time: Number(s.time),
                })
                .collect(),
            mean: rgb(self.mean(pixel)),
            picture: with_scene.then(|| Thumbnail::new(self.prepared)),
            scene: with_scene.then(|| GhostScene::new(self.name, self.prepared)),
        }
    }

    /// What the picture holds of a pixel, bit for bit.
    pub fn mean(&self, pixel: [u32; 2]) -> [f32; 3] {
        let [x, y] = pixel;
        let mut job = self.prepared.job();
        job.settings.crop = Some(Tile { x0: x, y0: y, x1: x + 1, y1: y + 1 });
        let film = job.render(Gather::Rays, &(), &AtomicBool::new(false)).film;
        film.pixels().get((y * film.width + x) as usize).map_or([0.0; 3], crate::film::Pixel::mean)
    }

    /// All samples of a pixel, in their order.
    pub fn samples(&self, pixel: [u32; 2]) -> Vec<Taken> {
        self.prepared.job().samples_of(pixel, Gather::Rays)
    }

    /// The document of one of them; `samples` are all of the pixel.
    pub fn tree(&self, pixel: [u32; 2], samples: &[Taken], sample: u32) -> Tree {
        let (recorded, value) = self.prepared.job().record(pixel, sample);
        let taken = samples.get(sample as usize);
        let view = &self.prepared.scene.view;
        let nodes: Vec<Node> =
            recorded.nodes.iter().enumerate().map(|(id, n)| node(self.prepared, &recorded, id, n)).collect();
        Tree {
            version: VERSION,
            durer: env!("CARGO_PKG_VERSION").to_owned(),
            scene: self.name.to_owned(),
            integrator: self.prepared.integrator_name.clone(),
            width: view.width,
            height: view.height,
            pixel,
            sample,
            samples: samples.len() as u32,
            antialias: match self.prepared.settings.antialias {
                Antialias::Supersample => "supersample",
                Antialias::Adaptive(_) => "adaptive",
            }
            .to_owned(),
            filter_weight: taken.and_then(|t| t.weight).map(Number),
            film: taken.map(|t| t.film.map(Number)).unwrap_or_default(),
            lens: taken.and_then(|t| t.lens).map(|l| l.map(Number)),
            time: taken.map(|t| Number(t.time)).unwrap_or_default(),
            rules: self.prepared.rules.clone(),
            rgb: rgb(as_film(value)),
            killed: std::array::from_fn(|i| Number(nodes.iter().map(|n| n.lost[i].0).sum())),
            max_radiance: Number(largest(&nodes)),
            nodes,
            diff: None,
        }
    }
}

/// The mean of a film that holds one sample. Differs from the sample in the sign of zero only, but bits are promised.
fn as_film(value: [f32; 3]) -> [f32; 3] {
    let mut pixel = crate::film::Pixel::default();
    pixel.add(value, 1.0);
    pixel.mean()
}

/// The largest radiance of the nodes, over their channels.
fn largest(nodes: &[Node]) -> f32 {
    let all = nodes.iter().flat_map(|n| n.result).map(|v| v.0);
    all.filter(|v| v.is_finite()).fold(0.0, f32::max)
}

fn node(prepared: &Prepared, tree: &RayTree, id: usize, node: &TreeNode) -> Node {
    let scene = &prepared.scene;
    let place = |p: Point3| world(&scene.view, p);
    let hit = node.hit.as_ref();
    let d = node.d.normalize();
    let _ = tree;
    Node {
        id,
        parent: node.parent,
        kind: node.kind.word().to_owned(),
        depth: node.depth,
        origin: place(node.o),
        direction: d.to_array().map(Number),
        t: node.length().map(Number),
        point: hit.map(|h| place(h.p)),
        object: hit.map(|h| scene.object(h.object).name.clone()),
        instance: hit.map(|h| h.hit.instance),
        primitive: hit.map(|h| scene.resolve(&h.hit).1),
        normal: hit.map(|h| h.n_s.to_array().map(Number)),
        geometric_normal: hit.map(|h| h.n_g.to_array().map(Number)),
        uv: hit.map(|h| h.uv.map(Number)),
        side: hit.map(|h| if h.from_outside { "outside" } else { "inside" }.to_owned()),
        cos: hit.map(|h| Number(h.n_s.dot(d).abs())),
        weight: of(node.weight),
        throughput: of(node.throughput),
        local: of(node.local),
        contribution: of(node.contribution()),
        result: of(node.result),
        arrived: rgb([1.0; 3]),
        stop: node.stop.map(|s| s.word().to_owned()),
        lost: of(node.lost),
        light: node.light.as_ref().map(|l| Light {
            index: l.light,
            name: scene.light_names.get(l.light as usize).cloned(),
            point: l.point.map(place),
            visible: l.visible,
            passed: of(l.passed),
            unoccluded: of(l.unoccluded),
        }),
        blocker: node.light.as_ref().and_then(|l| l.blocker).map(|b| scene.object(b).name.clone()),
        tests: Tests { boxes: node.node_tests, primitives: node.primitive_tests, ..Tests::default() },
        ..Node::default()
    }
}

fn world(view: &View, p: Point3) -> Place {
    let (exact, rounded) = (view.to_world(p), p.to_array());
    std::array::from_fn(|i| Metres::short(exact[i], rounded[i]))
}

fn of(s: Spectrum) -> Rgb {
    rgb(Basis::Rgb.to_rgb(s))
}
