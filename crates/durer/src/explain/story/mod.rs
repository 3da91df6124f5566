//! The text: a paragraph about the pixel, then what happened along the ray that brought most.
mod bend;
mod data;
mod floating;
mod hit;
mod light;
mod pixel;
mod rest;

use crate::{
    Prepared,
    probe::{RayTree, TreeNode},
    spectrum::Spectrum,
    tree::Subject,
};

use super::{
    Explanation, Sample,
    explanation::Paragraph,
    words::{lanes, luminance, percent, rgb, tint},
};

/// Surfaces along the brightest way that everybody is told of.
const SURFACES: usize = 3;
/// Surfaces that are told of at all.
const MOST_SURFACES: usize = 40;
/// Share in the pixel of what is worth a sentence; and with details.
const WORTH: f64 = 0.1;
const WORTH_DETAIL: f64 = 0.005;

/// Tells of one recorded sample.
struct Teller<'a> {
    prepared: &'a Prepared,
    tree: &'a RayTree,
    children: Vec<Vec<u32>>,
    /// Luminance of the sample, which shares are of.
    whole: f64,
}

/// All paragraphs.
pub(super) fn tell(
    subject: &Subject<'_>,
    samples: &[Sample],
    detailed: &Sample,
    explanation: &Explanation,
) -> Vec<Paragraph> {
    let prepared = subject.prepared;
    let mut paragraphs = vec![pixel::summary(prepared, samples, detailed, explanation)];
    if let crate::Output::Data(show) = prepared.integrator.facts().output {
        paragraphs.push(data::shown(prepared, show, detailed));
    } else {
        paragraphs.extend(pixel::samples(prepared, samples, explanation));
        let teller = Teller {
            prepared,
            tree: &detailed.tree,
            children: detailed.tree.children(),
            whole: luminance(detailed.arriving()),
        };
        paragraphs.extend(teller.way());
        paragraphs.extend(rest::sources(explanation));
        paragraphs.extend(rest::cut(prepared, samples, explanation));
    }
    paragraphs.extend(rest::findings(samples, explanation));
    paragraphs
}

impl<'a> Teller<'a> {
    fn node(&self, index: usize) -> &'a TreeNode {
        &self.tree.nodes[index]
    }
    /// What a ray brings of the sample's light, 0 to 1.
    fn share(&self, node: &TreeNode) -> f64 {
        self.share_of(self.rgb(node.throughput * node.result))
    }
    /// What makes a ray worth following: what it brings, or could have brought if nothing comes from anywhere.
    fn rank(&self, node: &TreeNode) -> f64 {
        if self.whole > 0.0 { self.share(node) } else { luminance(tint(&self.tree.basis, node.throughput)) }
    }
    /// The colour of light.
    fn rgb(&self, s: Spectrum) -> [f64; 3] {
        rgb(&self.tree.basis, s)
    }
    /// What rays carry, lane by lane.
    fn lanes(&self, s: Spectrum) -> String {
        lanes(&self.tree.basis, s)
    }
    fn share_of(&self, v: [f64; 3]) -> f64 {
        if self.whole > 0.0 { luminance(v) / self.whole } else { 0.0 }
    }
    /// The same in words; nothing where the sample is black.
    fn of_pixel(&self, v: [f64; 3]) -> String {
        if self.whole > 0.0 {
            format!(", {} of the sample", percent(self.share_of(v)))
        } else {
            String::new()
        }
    }

    /// Paragraphs about surfaces, from the eye on: the brightest way for everybody, what else matters for those who want
    /// to know more.
    fn way(&self) -> Vec<Paragraph> {
        let mut paragraphs = Vec::new();
        // The next of the brightest way comes first, the others wait in the order of what they bring.
        let mut waiting: Vec<(usize, bool)> = vec![(0, true)];
        let mut told = 0;
        while let Some((index, is_main)) = waiting.pop() {
            let node = self.node(index);
            if paragraphs.len() >= MOST_SURFACES {
                break;
            }
            let is_worth = index == 0 || self.rank(node) >= WORTH;
            let is_detail = !(is_main && is_worth && told < SURFACES);
            told += usize::from(!is_detail);
            paragraphs.push(Paragraph {
                about: "ray",
                node: Some(index as u32),
                is_detail,
                sentences: self.surface(index),
            });
            let mut next: Vec<usize> = self.children[index]
                .iter()
                .map(|&c| c as usize)
                .filter(|&c| self.node(c).kind.is_followed() && self.node(c).is_traced())
                .filter(|&c| self.node(c).hit.is_some() || self.node(c).floating.is_some())
                .filter(|&c| self.rank(self.node(c)) >= WORTH_DETAIL)
                .collect();
            next.sort_by(|&a, &b| self.rank(self.node(a)).total_cmp(&self.rank(self.node(b))));
            let brightest = next.len().checked_sub(1);
            waiting.extend(
                next.into_iter().enumerate().map(|(place, c)| (c, is_main && Some(place) == brightest)),
            );
        }
        paragraphs
    }
}
