//! What the samples of one index share: the photons of their pass, their moment and their wavelengths.
//!
//! A pure function of (scene, seed, index), made by all threads before the first sample that asks for it: particles are sent
//! in parts, and kept in the order of the parts. A render takes samples pass by pass; whoever looks at single samples has
//! the passes kept that were made last, as many as fit.
use std::sync::{Arc, Mutex, PoisonError, atomic::AtomicBool};

use durer_core::{sampling::Sampler, spectrum::Basis};

use super::{Job, crew};
use crate::{
    SampleCx,
    integrator::{Gathering, Integrator, Photons, Sent, send},
};

/// Particles that a thread sends at a time.
const PART: u32 = 4096;
/// Bytes of passes that are kept for single samples; always one.
const KEPT_BYTES: u64 = 1 << 30;
/// The row of pixels whose numbers are those of passes: no picture is as high.
const ROW_OF_PASSES: u32 = u32::MAX;

/// What the samples of one index share.
pub(super) struct Shared {
    /// What takes them.
    integrator: Box<dyn Integrator>,
    /// The numbers that are the same for all of them.
    sampler: Sampler,
    basis: Basis,
    bytes: u64,
    /// Rays of particles.
    pub(super) rays: u64,
}

impl std::fmt::Debug for Shared {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Shared")
            .field("sampler", &self.sampler)
            .field("bytes", &self.bytes)
            .finish_non_exhaustive()
    }
}

/// Passes of a [`Job`] whose samples share something: those that were made, and the one that samples are taken of.
#[derive(Default)]
pub struct Passes<'a> {
    kept: Mutex<Vec<(u32, Arc<Shared>)>>,
    now: Option<&'a Shared>,
}

impl<'a> Passes<'a> {
    /// The meaning of the lanes, if it is that of the pass.
    pub(super) fn basis(&self) -> Option<Basis> {
        self.now.map(|shared| shared.basis)
    }
    /// The numbers of the pass, where it has some.
    pub(super) fn sampler(&self) -> Option<&'a Sampler> {
        self.now.map(|shared| &shared.sampler)
    }
}

impl Job<'_> {
    /// Makes what the samples of an index share; `None` if they share nothing. Of no use once `cancel` is set.
    pub(super) fn share(&self, index: u32, cancel: &AtomicBool) -> Option<Arc<Shared>> {
        let gathering = self.integrator.facts().gathering?;
        let s = &self.settings;
        let sampler = Sampler::new(s.sampler, s.seed, [index, ROW_OF_PASSES], index, s.samples);
        let basis = s.carried.basis(|| s.lambda(&sampler));
        let cx = SampleCx { scene: self.scene, basis };
        let (photons, rays) = self.photons(&cx, &gathering, (index, &sampler), cancel);
        let bytes = photons.len() as u64 * Photons::BYTES;
        let integrator = self.integrator.with(&Arc::new(photons))?;
        Some(Arc::new(Shared { integrator, sampler, basis, bytes, rays }))
    }

    fn photons(
        &self,
        cx: &SampleCx<'_>,
        gathering: &Gathering,
        (index, sampler): (u32, &Sampler),
        cancel: &AtomicBool,
    ) -> (Photons, u64) {
        let (s, view) = (&self.settings, &self.scene.view);
        let u = super::pass::moment(view, s.nesting, sampler).unwrap_or(0.5);
        let time = view.shutter.moment(u, view.height / 2, view.height);
        let count = gathering.particles(view);
        // Other numbers than those of any pixel or pass.
        let seed = s.seed ^ (u64::from(gathering.seed) << 32) ^ 0x9407_0115;
        let numbers = |particle| Sampler::new(s.sampler, seed, [index, ROW_OF_PASSES - 1], particle, count);
        let parts: Vec<u32> = (0..count.div_ceil(PART)).collect();
        let done: Mutex<Vec<Sent>> = Mutex::new(vec![Sent::default(); parts.len()]);
        crew::share_out(&parts, s.threads, cancel, |part, (): &mut ()| {
            let particles = part * PART..((part + 1) * PART).min(count);
            let sent = send(cx, gathering, (time, particles), numbers);
            super::lock(&done)[part as usize] = sent;
        });
        let done = done.into_inner().unwrap_or_else(PoisonError::into_inner);
        let rays = done.iter().map(|sent| sent.rays).sum();
        let parts: Vec<_> = done.into_iter().map(|sent| sent.photons).collect();
        (Photons::new(count, gathering.radius(cx, index), &parts), rays)
    }

    /// The same, of those that are kept if it is among them.
    pub(super) fn kept(&self, index: u32) -> Option<Arc<Shared>> {
        self.integrator.facts().gathering?;
        // Whoever else asks waits for what is being made.
        let mut kept = super::lock(&self.passes.kept);
        if let Some((_, shared)) = kept.iter().find(|(of, _)| *of == index) {
            return Some(Arc::clone(shared));
        }
        let shared = self.share(index, &AtomicBool::new(false))?;
        kept.push((index, Arc::clone(&shared)));
        while kept.len() > 1 && kept.iter().map(|(_, shared)| shared.bytes).sum::<u64>() > KEPT_BYTES {
            kept.remove(0);
        }
        Some(shared)
    }

    /// The job as samples of a pass are taken: with what they share.
    pub(super) fn of_pass<'s>(&'s self, shared: Option<&'s Arc<Shared>>) -> Job<'s> {
        let (scene, settings) = (self.scene, self.settings);
        let now = shared.map(|shared| &**shared);
        let integrator = now.map_or(self.integrator, |shared| &*shared.integrator);
        Job { scene, integrator, settings, passes: Passes { now, ..Passes::default() } }
    }
}
