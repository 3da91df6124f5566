//! Which light a path asks: one per hit, with a known probability.
//!
//! Lights that are somewhere and fade with distance stand in a tree ([`LightTree`]); those beside it, infinitely far away or
//! never fading, are few and are asked one by one what they could send. The tree counts as one of them with what all of it
//! could send. As nobody knows yet what is in the way, half of the choice is left to chance: with `n` of them that may give
//! anything, each is chosen with probability `1/2 (1/n + e_i / sum e)`, for an estimate `e_i` of the irradiance (a
//! defensive mixture, Hesterberg 1995). A sun outside a room costs lamps in the room at most half of their shadow rays, and
//! a lamp in the sun at most half of the sun's.
use durer_core::math::{Normal3, Point3};
use durer_model::light::{Light, LightBounds, LightTree, Steps};

use crate::Scene;

/// By what one of the lights is chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LightSampler {
    /// Each as often.
    Uniform,
    /// In proportion to their power.
    Power,
    /// In proportion to what could arrive, by a tree.
    #[default]
    Tree,
}

impl LightSampler {
    /// All words, in the order of the variants; the last two are pbrt-v4's for a tree, and for asking each light what a tree
    /// asks of groups.
    pub const WORDS: [&'static str; 5] = ["uniform", "power", "tree", "bvh", "exhaustive"];

    /// The word in files and on the command line.
    pub fn word(self) -> &'static str {
        Self::WORDS[self as usize]
    }
    /// The variant of a word.
    pub fn from_word(word: &str) -> Option<Self> {
        match word {
            "bvh" | "exhaustive" => Some(Self::Tree),
            _ => [Self::Uniform, Self::Power, Self::Tree].into_iter().find(|by| by.word() == word),
        }
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

/// Where the chooser has a light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    /// Nowhere: it is never asked.
    None,
    /// As this one of the lights in the tree.
    Tree(u32),
    /// Beside it.
    Beside,
}

/// Which of the lights beside the tree are meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Among {
    /// All.
    All,
    /// Those that are not around the scene.
    Lamps,
}

/// What is known of all lights of a scene by which one is chosen.
#[derive(Debug)]
pub(crate) struct LightChooser {
    /// The lights that may give something, as the scene numbers them.
    sources: Vec<u32>,
    /// Of those, by their power; `None` if none has any.
    powers: Option<Steps>,
    /// Those in the tree.
    members: Vec<u32>,
    tree: Option<LightTree>,
    /// Those beside it, lamps first.
    beside: Vec<u32>,
    /// How many of those are lamps.
    lamps: usize,
    /// Of all lights of the scene.
    places: Vec<Place>,
}

impl LightChooser {
    /// That of the lights of a scene of this radius, in metres.
    pub(crate) fn new(lights: &[Box<dyn Light>], radius: f32) -> Self {
        let of = |light: &u32| &lights[*light as usize];
        let sources: Vec<u32> =
            (0..lights.len() as u32).filter(|i| of(i).is_sampled() && !of(i).is_even()).collect();
        let powers = Steps::new(sources.iter().map(|i| of(i).power(radius)).collect());
        let known = |i: u32| of(&i).bounds().map(|bounds| (i, bounds));
        let (members, bounds): (Vec<u32>, Vec<LightBounds>) =
            sources.iter().copied().filter_map(known).unzip();
        let outside = sources.iter().copied().filter(|i| of(i).bounds().is_none());
        let (mut beside, around): (Vec<u32>, Vec<u32>) = outside.partition(|i| !of(i).surrounds());
        let lamps = beside.len();
        beside.extend(around);
        let mut places = vec![Place::None; lights.len()];
        (0..).zip(&members).for_each(|(place, &light)| places[light as usize] = Place::Tree(place));
        beside.iter().for_each(|&light| places[light as usize] = Place::Beside);
        let tree = LightTree::new(bounds.into_iter());
        Self { sources, powers, members, tree, beside, lamps, places }
    }

    /// Those of these lights that are beside the tree.
    fn beside(&self, among: Among) -> &[u32] {
        match among {
            Among::All => &self.beside,
            Among::Lamps => &self.beside[..self.lamps],
        }
    }
}

/// The shares of the lights beside the tree and of the tree, which is the last of them.
struct Shares<'s> {
    scene: &'s Scene,
    at: &'s Lit,
    beside: &'s [u32],
    /// What the tree could send.
    tree: f32,
    /// What all could send, and how many could send something.
    total: f32,
    count: f32,
}

impl<'s> Shares<'s> {
    fn new(scene: &'s Scene, at: &'s Lit, among: Among) -> Self {
        let chooser = &scene.chooser;
        let beside = chooser.beside(among);
        let tree = chooser.tree.as_ref().map_or(0.0, |tree| tree.estimate(at.p, at.n));
        let one = |estimate: f32| f32::from(u8::from(estimate > 0.0));
        let mut shares = Self { scene, at, beside, tree, total: tree, count: one(tree) };
        for &light in beside {
            let estimate = shares.reach(light);
            shares.total += estimate;
            shares.count += one(estimate);
        }
        shares
    }
    fn reach(&self, light: u32) -> f32 {
        self.scene.lights[light as usize].reach(self.at.p, self.at.n, self.at.time)
    }
    /// The share of what could send so much.
    fn of(&self, estimate: f32) -> f32 {
        if estimate > 0.0 { 0.5 * (1.0 / self.count + estimate / self.total) } else { 0.0 }
    }
    /// The share of the tree.
    fn of_tree(&self) -> f32 {
        if self.beside.is_empty() { 1.0 } else { self.of(self.tree) }
    }
}

impl Scene {
    /// One of all lights that a path can ask, those around the scene among them, chosen by `u` in `[0, 1)`, which is asked
    /// for if there is a choice; `None` if nothing can come from any.
    pub fn choose_light(&self, by: LightSampler, at: &Lit, u: impl FnOnce() -> f32) -> Option<Chosen> {
        let chooser = &self.chooser;
        // PERF: most scenes have one light, or few (bench render).
        let u = if chooser.sources.len() == 1 { 0.0 } else { u() };
        let (place, chance) = match by {
            LightSampler::Tree => return self.choose_by_tree(at, Among::All, u),
            LightSampler::Power => chooser.powers.as_ref()?.choose(u),
            LightSampler::Uniform => {
                let n = chooser.sources.len();
                (((u * n as f32) as usize).min(n.checked_sub(1)?), 1.0 / n as f32)
            }
        };
        Some(Chosen { light: chooser.sources[place] as usize, chance })
    }

    /// The probability with which [`Scene::choose_light`] gives `light`.
    pub fn light_chance(&self, by: LightSampler, at: &Lit, light: usize) -> f32 {
        let chooser = &self.chooser;
        let Ok(place) = chooser.sources.binary_search(&(light as u32)) else { return 0.0 };
        match by {
            LightSampler::Tree => self.chance_by_tree(at, Among::All, light),
            LightSampler::Power => chooser.powers.as_ref().map_or(0.0, |powers| powers.chance(place)),
            LightSampler::Uniform => 1.0 / chooser.sources.len() as f32,
        }
    }

    /// One of the lights but those around the scene, chosen by `u` in `[0, 1)` for point `p`; `None` if nothing can come
    /// from any.
    pub(crate) fn choose_lamp(&self, p: Point3, time: f32, u: f32) -> Option<(usize, f32)> {
        let chosen = self.choose_by_tree(&Lit { p, n: None, time }, Among::Lamps, u)?;
        Some((chosen.light, chosen.chance))
    }

    /// The probability with which [`Scene::choose_lamp`] gives `light`.
    pub(crate) fn lamp_chance(&self, light: usize, p: Point3, time: f32) -> f32 {
        self.chance_by_tree(&Lit { p, n: None, time }, Among::Lamps, light)
    }

    fn choose_by_tree(&self, at: &Lit, among: Among, u: f32) -> Option<Chosen> {
        if let (Some(tree), []) = (&self.chooser.tree, self.chooser.beside(among)) {
            let picked = tree.choose(at.p, at.n, f64::from(u))?;
            let light = self.chooser.members[picked.index] as usize;
            return Some(Chosen { light, chance: picked.chance as f32 });
        }
        let shares = Shares::new(self, at, among);
        let mut left = f64::from(u);
        let mut last = None;
        for &light in shares.beside {
            let share = shares.of(shares.reach(light));
            if share > 0.0 {
                last = Some(Chosen { light: light as usize, chance: share });
                if left < f64::from(share) {
                    return last;
                }
            }
            left -= f64::from(share);
        }
        let Some(tree) = self.chooser.tree.as_ref().filter(|_| shares.of_tree() > 0.0) else { return last };
        let share = f64::from(shares.of_tree());
        let picked = tree.choose(at.p, at.n, (left / share).clamp(0.0, 1.0 - f64::EPSILON))?;
        let light = self.chooser.members[picked.index] as usize;
        Some(Chosen { light, chance: (picked.chance * share) as f32 })
    }

    fn chance_by_tree(&self, at: &Lit, among: Among, light: usize) -> f32 {
        if let (Place::Tree(member), Some(tree), []) =
            (self.chooser.places[light], &self.chooser.tree, self.chooser.beside(among))
        {
            return tree.chance(at.p, at.n, member as usize) as f32;
        }
        let shares = Shares::new(self, at, among);
        match (self.chooser.places[light], &self.chooser.tree) {
            (Place::Tree(member), Some(tree)) => {
                (tree.chance(at.p, at.n, member as usize) * f64::from(shares.of_tree())) as f32
            }
            (Place::Beside, _) if shares.beside.contains(&(light as u32)) => {
                shares.of(shares.reach(light as u32))
            }
            _ => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_lead_back() {
        for word in LightSampler::WORDS {
            let led = LightSampler::from_word(word).map(LightSampler::word);
            let ours = if ["bvh", "exhaustive"].contains(&word) { "tree" } else { word };
            assert_eq!(led, Some(ours));
        }
        assert_eq!(LightSampler::from_word("best"), None);
    }
}
