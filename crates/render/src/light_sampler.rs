//! Which light a path asks: one per hit, with a known probability.
use durer_core::math::{Normal3, Point3};

use crate::Scene;

/// By what one of the lights is chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LightSampler {
    /// Each as often.
    #[default]
    Uniform,
}

impl LightSampler {
    /// All words, in the order of the variants.
    pub const WORDS: [&'static str; 1] = ["uniform"];

    /// The word in files and on the command line.
    pub fn word(self) -> &'static str {
        Self::WORDS[self as usize]
    }
    /// The variant of a word.
    pub fn from_word(word: &str) -> Option<Self> {
        [Self::Uniform].into_iter().find(|by| by.word() == word)
    }
}

/// Where light is wanted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lit {
    /// The point.
    pub p: Point3,
    /// Unit normal of the surface there, on the side that light is wanted on; `None` if it may come from all around.
    pub n: Option<Normal3>,
    /// The moment, in seconds.
    pub time: f32,
}

/// A light, as chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chosen {
    /// Its index in the scene.
    pub light: usize,
    /// The probability of that.
    pub chance: f32,
}

impl Scene {
    /// One of all lights that a path can ask, those around the scene among them, chosen by `u` in `[0, 1)`; `None` if
    /// nothing can come from any.
    pub fn choose_light(&self, by: LightSampler, at: &Lit, u: f32) -> Option<Chosen> {
        let _ = at;
        match by {
            LightSampler::Uniform => {
                let n = self.sources.len();
                let light = *self.sources.get(((u * n as f32) as usize).min(n.checked_sub(1)?))? as usize;
                Some(Chosen { light, chance: 1.0 / n as f32 })
            }
        }
    }

    /// The probability with which [`Scene::choose_light`] gives `light`.
    pub fn light_chance(&self, by: LightSampler, at: &Lit, light: usize) -> f32 {
        let _ = (at, light);
        match by {
            LightSampler::Uniform => 1.0 / self.sources.len() as f32,
        }
    }
}
