//! Parts of a pixel's colour: by what the first surface does with light, and by where light comes from.
use serde::Serialize;

use crate::{
    Prepared,
    probe::{RayKind, RayTree, StopReason, TreeNode},
    spectrum::{Basis, Spectrum},
};

use super::words::{luminance, rgb};

/// Where light comes from, or by which way.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum PartKind {
    /// What a surface sends out by itself.
    Emission,
    /// The ambient term.
    Ambient,
    /// The sky's blurred image in glossy lobes that no ray is drawn from.
    BlurredSky,
    /// What lies around the scene, seen by a ray that left it.
    Sky,
    /// A light's, asked by shadow rays.
    Light,
    /// Lights without shadows, of ray casting.
    Shading,
    /// The colour of the surface itself, of ray casting.
    Albedo,
    /// What a mirrored ray brings.
    Reflection,
    /// What a refracted ray brings.
    Refraction,
    /// What comes straight through something thin.
    Straight,
    /// What rays about the mirror direction bring.
    Gloss,
    /// What rays of surfaces without a main direction bring: light that other surfaces hand on.
    Bounce,
    /// What photons brought to surfaces: light that other surfaces hand on.
    Gathered,
    /// What rays about the refracted direction bring.
    Translucency,
    /// What rays that particles sent on bring.
    Particles,
}

/// A part of a colour.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Part {
    /// What it is.
    pub kind: PartKind,
    /// Of which light or object; `None` where there is no such thing.
    pub name: Option<String>,
    /// How much: linear RGB.
    pub rgb: [f64; 3],
    /// Its share in the luminance of all parts, 0 to 1; 0 if all are black.
    pub share: f64,
}

impl Part {
    /// What it is, in words.
    pub fn words(&self) -> String {
        let name = self.name.as_deref().unwrap_or("?");
        match self.kind {
            PartKind::Emission => format!("what \"{name}\" sends out by itself"),
            PartKind::Ambient => "the ambient term".to_owned(),
            PartKind::BlurredSky => "the sky's blurred image in its gloss".to_owned(),
            PartKind::Sky => "the sky".to_owned(),
            PartKind::Light => format!("light of \"{name}\""),
            PartKind::Shading => "light of the lamps (shadows left out)".to_owned(),
            PartKind::Albedo => "the colour of the material".to_owned(),
            PartKind::Reflection => "the mirrored ray".to_owned(),
            PartKind::Refraction => "the refracted ray".to_owned(),
            PartKind::Straight => "what shines straight through".to_owned(),
            PartKind::Gloss => "gloss rays about the mirror direction".to_owned(),
            PartKind::Bounce => "light that other surfaces hand on".to_owned(),
            PartKind::Gathered => "light gathered from photons".to_owned(),
            PartKind::Translucency => "rays scattered through the surface".to_owned(),
            PartKind::Particles => "light that particles hand on".to_owned(),
        }
    }
}

/// Parts that are summed up, each once.
#[derive(Clone, Debug, Default)]
pub(super) struct Parts(Vec<(PartKind, Option<String>, [f64; 3])>);

impl Parts {
    /// Adds to a part; black adds nothing.
    pub(super) fn add(&mut self, kind: PartKind, name: Option<&str>, v: [f64; 3]) {
        if v == [0.0; 3] {
            return;
        }
        match self.0.iter_mut().find(|(k, n, _)| *k == kind && n.as_deref() == name) {
            Some((.., sum)) => (0..3).for_each(|i| sum[i] += v[i]),
            None => self.0.push((kind, name.map(str::to_owned), v)),
        }
    }
    /// Adds all parts of another sum by a factor.
    pub(super) fn merge(&mut self, others: &Self, factor: f64) {
        for (kind, name, v) in &others.0 {
            self.add(*kind, name.as_deref(), v.map(|v| v * factor));
        }
    }
    /// The largest first.
    pub(super) fn sorted(self) -> Vec<Part> {
        let total: f64 = self.0.iter().map(|(.., v)| luminance(*v)).sum();
        let share = |v| if total == 0.0 { 0.0 } else { luminance(v) / total };
        let mut parts: Vec<Part> =
            self.0.into_iter().map(|(kind, name, rgb)| Part { kind, name, rgb, share: share(rgb) }).collect();
        parts.sort_by(|a, b| b.share.total_cmp(&a.share));
        parts
    }
}

/// The name of the light of a shadow ray.
pub(super) fn light_name<'a>(prepared: &'a Prepared, node: &TreeNode) -> Option<&'a str> {
    let index = node.light?.light as usize;
    prepared.scene.light_names.get(index).map(String::as_str)
}

/// What a ray brings from no other ray, as it is shared in the pixel.
fn own(prepared: &Prepared, (basis, node): (&Basis, &TreeNode), is_cast: bool, parts: &mut Parts) {
    let mut rest = rgb(basis, node.throughput * node.local);
    let mut add = |kind, name: Option<&str>, s: Spectrum| {
        let v = rgb(basis, node.throughput * s);
        parts.add(kind, name, v);
        (0..3).for_each(|i| rest[i] -= v[i]);
    };
    match (&node.hit, &node.shading) {
        (Some(hit), Some(shading)) => {
            let object = prepared.scene.object(hit.object);
            add(PartKind::Emission, Some(&object.name), shading.emission);
            add(PartKind::Ambient, None, shading.ambient);
            add(PartKind::BlurredSky, None, shading.blurred_sky);
            add(PartKind::Gathered, None, node.gathered.map_or(Spectrum::BLACK, |event| event.radiance));
        }
        _ if node.stop == Some(StopReason::MissedScene) => add(PartKind::Sky, None, node.local),
        _ if node.light.is_some() => add(PartKind::Light, light_name(prepared, node), node.local),
        _ => {}
    }
    if is_cast && node.hit.is_some() {
        let is_albedo = prepared.rules.get("show").and_then(|v| v.as_str()) == Some("albedo");
        let kind = if is_albedo { PartKind::Albedo } else { PartKind::Shading };
        parts.add(kind, None, rest);
    }
}

/// Parts by what happens at the first surface that is there.
pub(super) fn by_way(prepared: &Prepared, tree: &RayTree) -> Parts {
    let mut parts = Parts::default();
    let children = tree.children();
    let mut open: Vec<u32> = if tree.nodes.is_empty() { Vec::new() } else { vec![0] };
    while let Some(index) = open.pop() {
        own(prepared, (&tree.basis, &tree.nodes[index as usize]), is_cast(prepared), &mut parts);
        for &number in &children[index as usize] {
            let child = &tree.nodes[number as usize];
            let kind = match child.kind {
                RayKind::Eye | RayKind::Passing => {
                    open.push(number);
                    continue;
                }
                RayKind::Shadow => PartKind::Light,
                RayKind::Reflection => PartKind::Reflection,
                RayKind::Refraction if is_straight(child) => PartKind::Straight,
                RayKind::Refraction => PartKind::Refraction,
                RayKind::GlossyReflection if is_matte(child) => PartKind::Bounce,
                RayKind::GlossyReflection => PartKind::Gloss,
                RayKind::GlossyRefraction => PartKind::Translucency,
                // What particles bring came by another surface.
                RayKind::Connection => PartKind::Bounce,
                RayKind::Photon => continue,
                RayKind::Scattered => PartKind::Particles,
            };
            parts.add(kind, light_name(prepared, child), rgb(&tree.basis, child.throughput * child.result));
        }
    }
    parts
}

/// Parts by where light comes from, however it came.
pub(super) fn by_source(prepared: &Prepared, tree: &RayTree) -> Parts {
    let mut parts = Parts::default();
    for node in &tree.nodes {
        own(prepared, (&tree.basis, node), is_cast(prepared), &mut parts);
    }
    parts
}

/// Whether a ray goes straight on through something thin.
pub(super) fn is_straight(node: &TreeNode) -> bool {
    node.chosen.and_then(|c| c.lobe) == Some("clear")
}

/// Whether a ray was drawn from a lobe without a main direction.
pub(super) fn is_matte(node: &TreeNode) -> bool {
    matches!(node.chosen.and_then(|c| c.lobe), Some("diffuse" | "matte" | "translucent"))
}

/// Whether hits spawn no rays, so that their light is theirs alone.
pub(super) fn is_cast(prepared: &Prepared) -> bool {
    prepared.integrator_name == "cast"
}
