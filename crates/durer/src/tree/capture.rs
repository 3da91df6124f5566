//! From what the renderer recorded to the document.
use std::sync::atomic::AtomicBool;

use crate::{
    Output, Prepared, View,
    drive::{Antialias, Gather, Taken},
    film::{BLOCK, Film, Pixel, Tile},
    math::Point3,
    probe::{Detail, RayTree, TreeHit, TreeNode},
    spectrum::{Basis, Spectrum},
};

use super::{
    document::{Lanes, Light, Limit, Node, Random, TestedBox, Tests, Tree, VERSION},
    drawn::drawn,
    floating::floating,
    gathered::gathered,
    ghost::GhostScene,
    material,
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
    /// The trees of some samples of a pixel in as much `detail`, and what belongs to them. Other samples than the one are
    /// taken only if there are several, or if their trees are wanted too: else the page has no values of samples.
    pub fn page(&self, pixel: [u32; 2], chosen: &[u32], around: Surroundings, detail: Detail) -> Page {
        let count = self.prepared.job().sample_count(pixel);
        let mut trees: Vec<Tree> = chosen.iter().map(|&s| self.tree_of(pixel, count, s, detail)).collect();
        if let Surroundings::SceneAndSamples(most) = around {
            let mut nodes: usize = trees.iter().map(|t| t.nodes.len()).sum();
            for sample in (0..count).filter(|s| !chosen.contains(s)) {
                let tree = self.tree_of(pixel, count, sample, Detail::default());
                nodes += tree.nodes.len();
                if nodes > most {
                    break;
                }
                trees.push(tree);
            }
        }
        let with_scene = around != Surroundings::None;
        let mut page = Page {
            version: VERSION,
            trees,
            picture: with_scene.then(|| Thumbnail::new(self.prepared)),
            scene: with_scene.then(|| GhostScene::new(self.name, self.prepared)),
            ..Page::default()
        };
        if chosen.len() != 1 || matches!(around, Surroundings::SceneAndSamples(_)) {
            self.add_samples(&mut page, pixel);
        }
        page
    }

    /// Takes all samples of the pixel and adds to the page what they say.
    pub fn add_samples(&self, page: &mut Page, pixel: [u32; 2]) {
        let samples = self.samples(pixel);
        page.values = samples.iter().map(|s| rgb(s.rgb.unwrap_or_default())).collect();
        let dims = |s: &Taken| Dimensions {
            film: s.film.map(Number),
            lens: s.lens.map(|l| l.map(Number)),
            time: Number(s.time),
        };
        page.dims = samples.iter().map(dims).collect();
        page.mean = rgb(self.mean(pixel, &samples));
    }

    /// What the picture holds of a pixel, bit for bit; `samples` are all of it.
    pub fn mean(&self, pixel: [u32; 2], samples: &[Taken]) -> [f32; 3] {
        let finite = |t: &Taken| t.rgb.filter(|rgb| rgb.iter().all(|v| v.is_finite()));
        let weighed: Option<Vec<_>> = samples.iter().map(|t| t.weight.map(|w| (finite(t), w))).collect();
        match weighed {
            Some(weighed) => mean_of(&weighed),
            None => self.adaptive_mean(pixel),
        }
    }

    /// The same where weights are a matter of the pixel's neighbours.
    fn adaptive_mean(&self, [x, y]: [u32; 2]) -> [f32; 3] {
        let mut job = self.prepared.job();
        job.settings.crop = Some(Tile { x0: x, y0: y, x1: x + 1, y1: y + 1 });
        let film = job.render(Gather::Rays, &(), &AtomicBool::new(false)).film;
        film.pixels().get((y * film.width + x) as usize).map_or([0.0; 3], Pixel::mean)
    }

    /// All samples of a pixel, in their order.
    pub fn samples(&self, pixel: [u32; 2]) -> Vec<Taken> {
        self.prepared.job().samples_of(pixel, Gather::Rays)
    }

    /// The document of one sample; `samples` are all of the pixel.
    pub fn tree(&self, pixel: [u32; 2], samples: &[Taken], sample: u32, detail: Detail) -> Tree {
        self.tree_of(pixel, samples.len() as u32, sample, detail)
    }

    /// The document of one of so many samples of a pixel; no other is taken.
    pub fn tree_of(&self, pixel: [u32; 2], samples: u32, sample: u32, detail: Detail) -> Tree {
        let (recorded, value) = self.prepared.job().record_in(pixel, sample, detail);
        let (view, settings) = (&self.prepared.scene.view, &self.prepared.settings);
        let data = match self.prepared.integrator.facts().output {
            Output::Data(show) => Some(show.word().to_owned()),
            Output::Radiance | Output::Survey(_) => None,
        };
        let is_adaptive = settings.antialias != Antialias::Supersample;
        let nodes: Vec<Node> = recorded
            .nodes
            .iter()
            .enumerate()
            .map(|(id, n)| node(self.prepared, &recorded.basis, id, n))
            .collect();
        let eye = recorded.eye.as_ref();
        let developing = eye.map(|eye| eye.developing);
        let mut tree = Tree {
            version: VERSION,
            durer: env!("CARGO_PKG_VERSION").to_owned(),
            scene: self.name.to_owned(),
            integrator: self.prepared.integrator_name.clone(),
            width: view.width,
            height: view.height,
            pixel,
            sample,
            samples,
            antialias: if is_adaptive { "adaptive" } else { "supersample" }.to_owned(),
            filter_weight: eye
                .filter(|_| !is_adaptive || data.is_some())
                .map(|eye| Number(eye.filter_weight)),
            gain: eye.map(|eye| eye.gain).filter(|gain| *gain != 1.0).map(Number),
            clamp: developing.map(|film| film.clamp).filter(|clamp| *clamp != 1.0).map(Number),
            balance: developing.and_then(|film| film.balance).map(|rows| rows.map(rgb)),
            film: eye.map(|eye| eye.film.map(Number)).unwrap_or_default(),
            lens: eye.and_then(|eye| eye.lens).map(|l| l.map(Number)),
            time: eye.map(|eye| Number(eye.time)).unwrap_or_default(),
            wavelengths: recorded.basis.wavelengths().map(|w| w.nm().map(Number)),
            lane_weights: recorded.basis.wavelengths().map(|w| w.weights().map(rgb)),
            rules: self.prepared.rules.clone(),
            rgb: rgb(as_film(value)),
            killed: of_weight(&recorded.basis, recorded.killed()),
            max_radiance: Number(recorded.max_radiance()),
            bad: recorded.bad,
            data,
            nodes,
            ..Tree::default()
        };
        self.bound(&recorded, &mut tree);
        tree
    }

    /// What rays that were given up could have brought.
    fn bound(&self, recorded: &RayTree, tree: &mut Tree) {
        match recorded.is_cut().then(|| self.prepared.brightest()) {
            None => tree.missing = Some(of_light(&recorded.basis, recorded.lost_bound(0.0))),
            Some(Ok(brightest)) => {
                tree.brightest = Some(Number(brightest));
                tree.missing = Some(of_light(&recorded.basis, recorded.lost_bound(brightest)));
            }
            Some(Err(why)) => tree.no_bound = Some(why.to_owned()),
        }
    }
}

/// The mean of a film of one pixel; what is infinite or NaN has no value and is left out.
fn mean_of(samples: &[(Option<[f32; 3]>, f32)]) -> [f32; 3] {
    let mut film = Film::new(1, 1);
    let whole = Tile { x0: 0, y0: 0, x1: 1, y1: 1 };
    let mut pixels = Vec::new();
    for block in samples.chunks(BLOCK as usize) {
        film.read(whole, &mut pixels);
        for (value, weight) in block {
            if let (Some(value), Some(pixel)) = (value, pixels.first_mut()) {
                pixel.add(*value, *weight);
            }
        }
        film.write(whole, &pixels);
        if block.len() == BLOCK as usize {
            film.finish_block();
        }
    }
    film.pixels().first().map_or([0.0; 3], Pixel::mean)
}

/// The mean of a film that holds one sample. Differs from the sample in the sign of zero only, but bits are promised.
fn as_film(value: [f32; 3]) -> [f32; 3] {
    let mut pixel = Pixel::default();
    pixel.add(value, 1.0);
    pixel.mean()
}

fn node(prepared: &Prepared, basis: &Basis, id: usize, node: &TreeNode) -> Node {
    let scene = &prepared.scene;
    let place = |p: Point3| world(&scene.view, p);
    let shading = node.shading.as_ref();
    let mut told = Node {
        id,
        parent: node.parent,
        kind: node.kind.word().to_owned(),
        depth: node.depth,
        origin: place(node.o),
        direction: node.d.normalize().to_array().map(Number),
        t: node.length().map(Number),
        time: Number(node.path.ray.time),
        weight: of_weight(basis, node.weight),
        throughput: of_weight(basis, node.throughput),
        lanes: lanes(basis, node),
        local: of_light(basis, node.local),
        emission: shading.map(|s| of_light(basis, s.emission)),
        ambient: shading.map(|s| of_light(basis, s.ambient)),
        blurred_sky: shading.map(|s| of_light(basis, s.blurred_sky)),
        arrived: shading.map_or(rgb([1.0; 3]), |s| of_weight(basis, s.arrived)),
        contribution: of_light(basis, node.contribution()),
        result: of_light(basis, node.result),
        stop: node.stop.map(|s| s.word().to_owned()),
        limit: node.limit.map(|l| Limit { value: Number(l.value), threshold: Number(l.threshold) }),
        lost: of_weight(basis, node.lost),
        light: node.light.as_ref().map(|l| Light {
            index: l.light,
            name: scene.light_names.get(l.light as usize).cloned(),
            point: l.point.map(place),
            visible: l.visible,
            passed: of_weight(basis, l.passed),
            unoccluded: of_light(basis, l.unoccluded),
        }),
        blocker: node.light.as_ref().and_then(|l| l.blocker).map(|b| scene.object(b).name.clone()),
        media: shading.and_then(|s| s.media.as_ref()).map(|m| material::media(scene, basis, m)),
        gathered: node.gathered.as_ref().map(|event| gathered(basis, event)),
        floating: node.floating.as_ref().map(|event| floating(scene, basis, event)),
        fresnel: shading.and_then(|s| s.fresnel.as_ref()).map(material::fresnel),
        lobes: shading
            .map(|s| s.lobes.iter().map(|l| material::lobe(basis, l)).collect())
            .unwrap_or_default(),
        drawn: node.chosen.as_ref().map(|chosen| drawn(basis, chosen)),
        random: random(node),
        sampler: Some(node.path.sampler.to_hex()),
        textures: shading.map(|s| material::lookups(scene, &s.textures)).unwrap_or_default(),
        tests: Tests {
            boxes: node.node_tests,
            primitives: node.primitive_tests,
            triangles: node.triangle_tests,
            shapes: node.primitive_tests - node.triangle_tests,
            ..Tests::default()
        },
        ns: node.ns,
        walk: node
            .walk
            .iter()
            .map(|b| TestedBox { corners: b.bounds.map(place), depth: b.depth, hit: b.hit })
            .collect(),
        ..Node::default()
    };
    if let Some(hit) = &node.hit {
        add_hit(&mut told, prepared, hit);
    }
    told
}

/// Where a ray hit, and what.
fn add_hit(told: &mut Node, prepared: &Prepared, hit: &TreeHit) {
    let scene = &prepared.scene;
    let place = |p: Point3| world(&scene.view, p);
    let object = scene.object(hit.object);
    told.point = Some(place(hit.p));
    told.object = Some(object.name.clone());
    told.instance = Some(hit.hit.instance);
    told.primitive = Some(scene.resolve(&hit.hit).1);
    told.material = Some(prepared.material_name(object.material));
    told.normal = Some(hit.n_s.to_array().map(Number));
    told.geometric_normal = Some(hit.n_g.to_array().map(Number));
    told.uv = Some(hit.uv.map(Number));
    told.barycentric = hit.barycentric().map(|b| b.map(Number));
    told.triangle = hit.triangle.map(|t| t.map(place));
    told.side = Some(if hit.from_outside { "outside" } else { "inside" }.to_owned());
    told.cos = Some(Number(hit.cos));
}

/// The random numbers that led to a ray, one list for each purpose.
fn random(node: &TreeNode) -> Vec<Random> {
    let chosen = node.chosen.as_ref().and_then(|c| c.random.as_ref());
    let all = node.random.iter().chain(chosen.filter(|c| !node.random.contains(c)));
    all.map(|r| Random { dim: r.dim.word().to_owned(), u: r.numbers().iter().copied().map(Number).collect() })
        .collect()
}

pub(super) fn world(view: &View, p: Point3) -> Place {
    let (exact, rounded) = (view.to_world(p), p.to_array());
    std::array::from_fn(|i| Metres::short(exact[i], rounded[i]))
}

/// The colour of light.
pub(super) fn of_light(basis: &Basis, s: Spectrum) -> Rgb {
    rgb(basis.to_rgb(s))
}

/// The colour that a weight gives to white light.
pub(super) fn of_weight(basis: &Basis, s: Spectrum) -> Rgb {
    rgb(basis.under_white(s))
}

/// What a ray carries, by wavelength.
fn lanes(basis: &Basis, node: &TreeNode) -> Option<Lanes> {
    basis.wavelengths()?;
    let of = |s: Spectrum| s.lanes().map(Number);
    Some(Lanes {
        weight: of(node.weight),
        throughput: of(node.throughput),
        local: of(node.local),
        result: of(node.result),
    })
}
