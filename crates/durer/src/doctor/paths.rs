//! What a few samples of the picture come to, and how their paths end.
use durer_core::spectrum::Color;

use super::{Finding, look::places};
use crate::{
    Output, Prepared,
    probe::{RayKind, RayTree, StopReason},
};

/// Pixels per row and column.
const PIXELS: [u32; 2] = [16, 12];
/// Samples of each.
const SAMPLES: u32 = 4;
/// A cause is told if it holds for this share of the samples.
const MOST: f64 = 0.5;

/// What a few samples say.
pub(super) struct Survey {
    /// Luminance of each pixel; none if the picture shows no light.
    pub(super) light: Vec<f32>,
    /// Samples of which a ray was given up for the number of its bounces.
    cut: usize,
    /// Samples whose eye ray met something.
    hits: usize,
    /// Those of them that met what keeps all light.
    kept: usize,
    /// The materials that do.
    keeping: Vec<u32>,
}

impl Survey {
    pub(super) fn take(prepared: &Prepared) -> Self {
        let mut survey = Self { light: Vec::new(), cut: 0, hits: 0, kept: 0, keeping: Vec::new() };
        if prepared.integrator.facts().output != Output::Radiance {
            return survey;
        }
        let job = prepared.job();
        let places = places(prepared, PIXELS);
        for pixel in places {
            let samples = SAMPLES.min(prepared.settings.samples);
            let light = (0..samples).map(|sample| {
                let (tree, rgb) = job.record(pixel, sample);
                survey.add(prepared, &tree);
                Color { rgb }.luminance() / samples as f32
            });
            let light = light.sum();
            survey.light.push(light);
        }
        survey
    }

    fn add(&mut self, prepared: &Prepared, tree: &RayTree) {
        self.cut += usize::from(tree.nodes.iter().any(|n| n.stop == Some(StopReason::DepthLimit)));
        let Some(eye) = tree.nodes.iter().find(|n| n.kind == RayKind::Eye) else { return };
        let Some(hit) = &eye.hit else { return };
        self.hits += 1;
        if eye.stop == Some(StopReason::Absorbed) {
            self.kept += 1;
            self.keeping.push(prepared.scene.object(hit.object).material);
        }
    }

    /// Of the samples that saw something.
    fn share(&self, samples: usize) -> f64 {
        samples as f64 / self.hits.max(1) as f64
    }

    /// Paths that end before they find light.
    pub(super) fn ends(&self, prepared: &Prepared) -> Vec<Finding> {
        let mut found = Vec::new();
        let depth = prepared.integrator.facts().depth_limit;
        if let Some(depth) = depth.filter(|_| self.share(self.cut) > MOST) {
            let share = (100.0 * self.share(self.cut)).round();
            let message =
                format!("{share} % of what is seen has rays that were given up after {depth} bounces");
            found.push(Finding::warning(message).remedy(format!("try --max-depth {}", 2 * depth + 4)));
        }
        if self.share(self.kept) > MOST {
            let mut keeping = self.keeping.clone();
            keeping.sort_unstable();
            let most = keeping.chunk_by(|a, b| a == b).max_by_key(|same| same.len()).and_then(<[u32]>::first);
            let name = most.map(|&material| prepared.material_name(material)).unwrap_or_default();
            let message = format!("what is seen reflects nothing: the material \"{name}\" is black");
            found.push(Finding::warning(message).remedy("give it a colour above 0"));
        }
        found
    }
}
