//! Samples taken once more, watched: ray trees, parts of them, and what was cut off.
use std::sync::{Mutex, atomic::AtomicBool};

use durer_core::{math::Point2, sampling::Dim};

use super::{Job, adaptive, crew, film_value, lock, pass, pass::Eye};
use crate::{
    Contribution, SampleCx, Value,
    film::{Developing, Tile},
    integrator::Particles,
    probe::{Detail, RandomNumbers, RayKind, RayTree, Recorder, TreeEye},
};

/// What was cut off in each pixel of a part of the picture.
#[derive(Clone, Debug, PartialEq)]
pub struct KilledMap {
    /// The part.
    pub window: Tile,
    /// Row by row, linear RGB: mean over the samples of the shares in the pixel that rays given up would have had. Times
    /// the largest radiance in the scene it bounds what the pixel lacks.
    pub shares: Vec<[f32; 3]>,
    /// The largest radiance that any ray brought.
    pub max_radiance: f32,
}

impl Job<'_> {
    /// The ray tree of one sample, made by running it again, watched; and the linear RGB that the film stores of it.
    /// Of adaptive antialiasing it is the `sample`-th place of the pixel: first its corners, upper left, upper right,
    /// lower left and lower right; then, for each split, what its square lacks of the middles of its upper and left edges,
    /// its centre and the middles of its right and lower edges, before the four parts are looked at in the order of the
    /// corners; a part that is not split may have one more, somewhere inside. An empty tree and black if the pixel has no
    /// such sample there.
    pub fn record(&self, pixel: [u32; 2], sample: u32) -> (RayTree, [f32; 3]) {
        self.record_in(pixel, sample, Detail::default())
    }

    /// The same in more or less detail.
    pub fn record_in(&self, pixel: [u32; 2], sample: u32, detail: Detail) -> (RayTree, [f32; 3]) {
        match self.adaptive() {
            None => {
                let shared = self.kept(sample);
                let job = self.of_pass(shared.as_ref());
                let eye = job.eye(pixel, sample).0;
                let place = pass::place(&self.scene.view, self.settings.nesting, pixel, &eye.ray.sampler);
                job.watch(&eye, place, detail)
            }
            Some(how) => match adaptive::places(self, &how, pixel).get(sample as usize) {
                Some(&place) => {
                    self.watch(&adaptive::eye(self, place), (adaptive::film_of(place), 1.0), detail)
                }
                None => (RayTree::default(), [0.0; 3]),
            },
        }
    }

    /// The linear RGB of one sample, unwatched: that of [`Job::record`], bit for bit, but faster.
    pub fn value(&self, pixel: [u32; 2], sample: u32) -> [f32; 3] {
        let shared = self.kept(sample);
        let job = self.of_pass(shared.as_ref());
        let eye = match self.adaptive() {
            None => Some(job.eye(pixel, sample).0),
            Some(how) => adaptive::places(self, &how, pixel)
                .get(sample as usize)
                .map(|&place| adaptive::eye(self, place)),
        };
        let mut out = Contribution::default();
        eye.and_then(|eye| job.value_of(&eye, &mut out)).unwrap_or([0.0; 3])
    }

    /// Traces an eye ray through a place of the picture.
    fn watch(&self, eye: &Eye, (film, weight): (Point2, f32), detail: Detail) -> (RayTree, [f32; 3]) {
        let Eye { ray, gain } = eye;
        let cx = self.cx(&ray.sampler);
        let mut recorder = Recorder::new(&cx, detail);
        let mut out = Contribution::default();
        self.integrator.record(&cx, ray, &mut out, &mut recorder);
        let value = film_value(&cx, &out, *gain).unwrap_or([0.0; 3]);
        let mut tree = recorder.finish(&value);
        let (view, nesting) = (&self.scene.view, self.settings.nesting);
        let lens = pass::on_lens(view, nesting, &ray.sampler);
        if let Some(eye) = tree.nodes.first_mut() {
            if self.adaptive().is_none() {
                let u = pass::in_pixel(nesting, &ray.sampler).to_array();
                eye.random.push(RandomNumbers::two(Dim::Pixel, u));
            }
            let common = self.passes.sampler().unwrap_or(&ray.sampler);
            let moment = pass::moment(view, nesting, common);
            eye.random.extend(moment.map(|u| RandomNumbers::one(Dim::Time, u)));
            eye.random.extend(lens.map(|u| RandomNumbers::two(Dim::Lens, u.to_array())));
            if cx.basis.wavelengths().is_some() {
                eye.random.push(RandomNumbers::one(Dim::Lambda, self.settings.lambda(common)));
            }
        }
        tree.eye = Some(TreeEye {
            film: film.to_array(),
            lens: lens.map(|u| view.on_lens(film, u)),
            time: ray.ray.time,
            filter_weight: weight,
            gain: *gain,
            developing: match out.value {
                Value::Radiance(radiance) => {
                    view.sensor.developing(cx.basis.to_rgb(radiance).map(|v| v * gain))
                }
                Value::Data(_) => Developing::NONE,
            },
        });
        (tree, value)
    }

    /// The part of a tree below a node, traced again from what the node holds: its ray, sampler and bodies. Equal to that
    /// part bit for bit, with ids from 0. `None` for rays that were never traced but for limits: what is known of those is
    /// their parents'.
    pub fn replay(&self, tree: &RayTree, id: u32) -> Option<RayTree> {
        let node = tree.nodes.get(id as usize)?;
        if !node.is_traced() && node.limit.is_none() {
            return None;
        }
        let cx = SampleCx { scene: self.scene, basis: tree.basis };
        let mut recorder = Recorder::new(&cx, Detail::default());
        if self.integrator.facts().particles != Particles::None {
            // What a ray brings depends on all of the two walks, or on what was gathered before it.
            let mut out = Contribution::default();
            let eye = &tree.nodes.first()?.path;
            let shared = self.kept(eye.sampler.index());
            let job = self.of_pass(shared.as_ref());
            job.integrator.record(&cx, eye, &mut out, &mut recorder);
            let gain = tree.eye.map_or(1.0, |eye| eye.gain);
            let value = film_value(&cx, &out, gain).unwrap_or([0.0; 3]);
            let mut again = recorder.finish(&value).below(id);
            if let Some(first) = again.nodes.first_mut() {
                first.random.clone_from(&node.random);
            }
            return Some(again);
        }
        if let Some(choice) = &node.chosen {
            recorder.chose(choice);
        }
        let mut out = Contribution::default();
        self.integrator.replay(&cx, node, &mut out, &mut recorder);
        let value = match node.kind {
            RayKind::Eye => film_value(&cx, &out, 1.0).unwrap_or([0.0; 3]),
            _ => [0.0; 3],
        };
        let mut again = recorder.finish(&value);
        if let Some(first) = again.nodes.first_mut() {
            first.random.clone_from(&node.random);
        }
        Some(again)
    }

    /// What is cut off in each pixel, by recording all samples. Does not depend on threads. Takes several times as long as
    /// a render.
    pub fn killed(&self, cancel: &AtomicBool) -> KilledMap {
        let window = self.window();
        let width = (window.x1 - window.x0) as usize;
        let shares = vec![[0.0; 3]; window.area() as usize];
        let all = Mutex::new(KilledMap { window, shares, max_radiance: 0.0 });
        let rows: Vec<u32> = (window.y0..window.y1).collect();
        crew::share_out(&rows, self.settings.threads, cancel, |y, (): &mut ()| {
            let row: Vec<_> = (window.x0..window.x1).map(|x| self.killed_in([x, y])).collect();
            let mut all = lock(&all);
            let start = (y - window.y0) as usize * width;
            for (place, (share, largest)) in (start..).zip(row) {
                all.shares[place] = share;
                all.max_radiance = all.max_radiance.max(largest);
            }
        });
        all.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner)
    }

    fn killed_in(&self, pixel: [u32; 2]) -> ([f32; 3], f32) {
        let samples = self.sample_count(pixel);
        let (mut sum, mut largest) = ([0.0; 3], 0.0f32);
        for sample in 0..samples {
            let (tree, _) = self.record(pixel, sample);
            let killed = tree.basis.under_white(tree.killed());
            sum.iter_mut().zip(killed).for_each(|(sum, v)| *sum += v);
            largest = largest.max(tree.max_radiance());
        }
        (sum.map(|v| v / samples.max(1) as f32), largest)
    }
}
