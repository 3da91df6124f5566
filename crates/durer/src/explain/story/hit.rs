//! Sentences about a surface that a ray met, or about a ray that met none.
use crate::{
    model::bsdf::LobeView,
    probe::{RayKind, StopReason, TreeHit, TreeNode, TreeShading},
    spectrum::{Basis, Spectrum},
};

use super::{
    super::{
        bodies::present,
        part::{is_cast, is_matte, is_straight},
        words::{color, degrees_of, lanes, list, number, percent},
    },
    Teller,
};

/// Share in the sample of what is worth a formula.
const WORTH: f64 = 0.02;

impl Teller<'_> {
    /// All about where a ray ended.
    pub(super) fn surface(&self, index: usize) -> Vec<String> {
        let node = self.node(index);
        let mut sentences = vec![self.met(index)];
        sentences.extend(self.floated(node));
        if node.particle().is_some() {
            sentences.extend(self.lights(index));
            return sentences;
        }
        let (Some(hit), Some(shading)) = (&node.hit, &node.shading) else { return sentences };
        if self.children[index].iter().any(|&c| self.node(c as usize).kind == RayKind::Passing) {
            let name = &self.prepared.scene.object(hit.object).name;
            sentences.push(match self.prepared.scene.object(hit.object).light {
                Some(_) => format!("The lamp \"{name}\" is hidden from the eye, so the ray goes on as if it was not there."),
                None => format!(
                    "What is behind the surface of \"{name}\" is what is before it, so the ray goes on as if it was not there."
                ),
            });
            return sentences;
        }
        sentences.extend(self.absorbed(node, hit, shading));
        sentences.extend(self.own(node, hit, shading));
        if is_cast(self.prepared) {
            sentences.extend(self.cast(node, shading));
        }
        sentences.extend(self.lights(index));
        sentences.extend(self.interface(index, hit, shading));
        sentences.extend(self.branches(index));
        sentences
    }

    /// Which ray, and what it met.
    fn met(&self, index: usize) -> String {
        let node = self.node(index);
        let ray = self.ray(index);
        if let (Some(floating), Some(particle)) = (&node.floating, node.particle()) {
            return self.met_particle(&ray, floating, particle);
        }
        let Some(hit) = &node.hit else {
            let result = self.lanes(node.result);
            return match node.result.is_black() {
                true => format!("{ray} leaves the scene without meeting anything, and nothing shines there."),
                false => {
                    format!("{ray} leaves the scene without meeting anything and sees the sky: {result}.")
                }
            };
        };
        let object = self.prepared.scene.object(hit.object);
        let material = self.prepared.material_name(object.material);
        let side = if hit.from_outside { "outside" } else { "inside" };
        let length = number(f64::from(hit.hit.t) * f64::from(node.d.length()));
        let lobes = node.shading.as_ref().map(|s| lobes(&self.tree.basis, s)).filter(|l| !l.is_empty());
        let lobes = lobes.map(|l| format!(": {}", list(&l))).unwrap_or_default();
        format!(
            "{ray} meets the {side} of \"{}\" (material \"{material}\"{lobes}) after {length} m, {} degrees off its normal.",
            object.name,
            degrees_of(f64::from(hit.cos))
        )
    }

    /// The ray as a subject.
    fn ray(&self, index: usize) -> String {
        let node = self.node(index);
        let what = match node.kind {
            RayKind::Eye => return "The eye ray".to_owned(),
            RayKind::Shadow => "shadow ray",
            RayKind::Reflection => "mirrored ray",
            RayKind::Refraction if is_straight(node) => "ray that goes straight through",
            RayKind::Refraction => "refracted ray",
            RayKind::GlossyReflection if is_matte(node) => "scattered ray",
            RayKind::GlossyReflection => "gloss ray",
            RayKind::GlossyRefraction => "scattered ray",
            RayKind::Passing => "ray that goes on",
            RayKind::Connection => "joint",
            RayKind::Photon => "particle",
            RayKind::Scattered => "ray that a particle sends on",
        };
        let brings = match self.share(node) {
            share if share > 0.0 => format!(", which brings {},", percent(share)),
            _ => String::new(),
        };
        format!("The {what} (ray {index}, bounce {}){brings}", node.depth)
    }

    /// What ray casting makes of a hit, of which it follows no ray.
    fn cast(&self, node: &TreeNode, shading: &TreeShading) -> Option<String> {
        if self.prepared.rules.get("show").and_then(|v| v.as_str()) == Some("albedo") {
            return Some(format!(
                "The picture shows the colour of the material: {}.",
                self.lanes(node.local)
            ));
        }
        let parts = [shading.emission, shading.ambient, shading.blurred_sky].map(|s| self.rgb(s));
        let all = self.rgb(node.local);
        let lamps: [f64; 3] =
            std::array::from_fn(|i| (all[i] - parts.iter().map(|p| p[i]).sum::<f64>()).max(0.0));
        Some(format!(
            "Ray casting follows no more rays: the lamps add {}{}, whatever stands in their way.",
            color(lamps),
            self.of_pixel(lamps)
        ))
    }

    /// Absorption on the way of a ray to its hit.
    fn absorbed(&self, node: &TreeNode, hit: &TreeHit, shading: &TreeShading) -> Option<String> {
        let arrived = shading.arrived;
        if arrived == Spectrum::ONE || node.floating.is_some() {
            return None;
        }
        let media = &self.prepared.scene.media;
        let length = (hit.p.to_f64() - node.path.from.to_f64()).length();
        let id = present(media, &self.tree.basis, &node.path.media).1.filter(|&id| media.get(id).absorbs());
        let Some(id) = id else {
            return Some(format!(
                "Whitted's attenuation by distance leaves {} of its light.",
                self.lanes(arrived)
            ));
        };
        let sigma = self.tree.basis.unbounded(media.get(id).absorption);
        let left = sigma.map(|s| (-f64::from(s) * length).exp() as f32);
        let more = left.zip(arrived, |left, arrived| (left - arrived).abs()).max() > 2e-3;
        let more = if more {
            format!("; with attenuation by distance {}", self.lanes(arrived))
        } else {
            String::new()
        };
        Some(format!(
            "On {} m through {} absorption leaves exp(-sigma d) = exp(-{} x {}) = {} of the light (Beer and Lambert){more}.",
            number(length),
            self.body(id),
            self.lanes(sigma),
            number(length),
            self.lanes(left)
        ))
    }

    /// A body by the name of something that it fills.
    pub(super) fn body(&self, id: crate::Id<crate::model::Medium>) -> String {
        let scene = &self.prepared.scene;
        scene.filled_with(id).map_or_else(|| "a body".to_owned(), |o| format!("\"{}\"", o.name))
    }

    /// Emission, ambient term, blurred sky and photons.
    fn own(&self, node: &TreeNode, hit: &TreeHit, shading: &TreeShading) -> Vec<String> {
        let adds = |s: Spectrum| self.of_pixel(self.rgb(node.throughput * s));
        let mut sentences = Vec::new();
        let emission = shading.emission;
        if !emission.is_black() {
            let name = &self.prepared.scene.object(hit.object).name;
            let mis = node.chosen.and_then(|c| c.mis).filter(|m| *m < 1.0);
            let mis =
                mis.map(|m| format!(" (of it {}, as shadow rays bring the rest)", percent(f64::from(m))));
            sentences.push(format!(
                "\"{name}\" shines by itself: L = {}{}{}.",
                self.lanes(emission),
                mis.unwrap_or_default(),
                adds(emission)
            ));
        }
        let ambient = shading.ambient;
        if !ambient.is_black() {
            let of = shading
                .lobes
                .iter()
                .filter(|l| l.name == "ambient")
                .map(|l| l.reflectance)
                .reduce(|a, b| a + b);
            let (k, name) = match of {
                Some(k) => (k, "ka"),
                None => {
                    let diffuse = shading.lobes.iter().filter(|l| l.name == "diffuse").map(|l| l.reflectance);
                    (diffuse.fold(Default::default(), |a, b| a + b), "kd")
                }
            };
            let k = k * shading.arrived;
            let around = ambient.zip(k, |ambient, k| if k > 0.0 { ambient / k } else { 0.0 });
            sentences.push(format!(
                "The ambient term is {name} x surroundings = {} x {} = {}{}.",
                self.lanes(k),
                self.lanes(around),
                self.lanes(ambient),
                adds(ambient)
            ));
        }
        let sky = shading.blurred_sky;
        if !sky.is_black() {
            sentences.push(format!("Its gloss shows the sky blurred: {}{}.", self.lanes(sky), adds(sky)));
        }
        if let Some(event) = node.gathered {
            let (found, radius) = (event.photons, number(f64::from(event.radius)));
            let photons = if found == 1 { "photon lies" } else { "photons lie" };
            sentences.push(format!(
                "{found} {photons} within {radius} m: of what they bring it scatters {}{}.",
                self.lanes(event.radiance),
                adds(event.radiance)
            ));
        }
        sentences
    }

    /// Rays that follow.
    fn branches(&self, index: usize) -> Vec<String> {
        let mut all: Vec<usize> = self.children[index]
            .iter()
            .map(|&c| c as usize)
            .filter(|&c| self.node(c).kind.is_followed() && self.node(c).kind != RayKind::Passing)
            .filter(|&c| self.node(c).stop != Some(StopReason::TirNoRefraction))
            .collect();
        all.sort_by(|&a, &b| self.share(self.node(b)).total_cmp(&self.share(self.node(a))));
        let told = all.iter().take(4).map(|&c| self.branch(c));
        let mut sentences: Vec<String> = told.collect();
        if all.len() > 4 {
            sentences.push(format!("{} more rays follow.", all.len() - 4));
        }
        sentences
    }

    fn branch(&self, index: usize) -> String {
        let node = self.node(index);
        let what = match node.kind {
            RayKind::Reflection => "The mirrored ray",
            RayKind::Refraction if is_straight(node) => "What shines straight through",
            RayKind::Refraction => "The refracted ray",
            RayKind::GlossyReflection if is_matte(node) => "A scattered ray",
            RayKind::GlossyReflection => "A gloss ray",
            _ => "A scattered ray",
        };
        let weight = self.lanes(node.weight);
        if let Some(reason) = self.given_up(node) {
            return format!("{what} would weigh {weight}, but is not traced: {reason}.");
        }
        let (r, product) = (self.lanes(node.result), self.lanes(node.weight * node.result));
        let of = self.of_pixel(self.rgb(node.throughput * node.result));
        let meets = match &node.hit {
            Some(hit) => format!("meets \"{}\"", self.prepared.scene.object(hit.object).name),
            None if node.result.is_black() => "leaves the scene".to_owned(),
            None => "leaves for the sky".to_owned(),
        };
        if node.result.is_black() || node.weight.is_black() {
            return format!("{what} {meets} and brings nothing.");
        }
        let drawn = self.drawn(node);
        if self.share(node) < WORTH && self.whole > 0.0 {
            return format!("{what} {meets} and brings {weight} x {r} = {product}{of}.");
        }
        format!("{what} {meets} and brings weight x light = {weight} x {r} = {product}{of}{drawn}.")
    }

    /// How the weight of a drawn ray came about.
    fn drawn(&self, node: &TreeNode) -> String {
        let Some(chosen) = &node.chosen else { return String::new() };
        let (Some(f), Some(cos), Some(pdf)) = (chosen.f, chosen.cos, chosen.pdf) else {
            return String::new();
        };
        let rays = if chosen.rays > 1 { format!(" / {} rays", chosen.rays) } else { String::new() };
        format!(
            "; its weight is f cos / p = {} x {} / {}{rays}",
            self.lanes(f),
            number(cos.into()),
            number(pdf.into())
        )
    }

    /// Why a ray was not traced, if it was not.
    pub(super) fn given_up(&self, node: &TreeNode) -> Option<String> {
        let limit = node.limit.map(|l| [l.value, l.threshold].map(|v| number(v.into())));
        Some(match (node.stop?, limit) {
            (StopReason::DepthLimit, Some([depth, most]))
                if node.path.passed == 0 || node.depth as f32 > node.limit?.threshold =>
            {
                format!("it would be bounce {depth}, and {most} are allowed (--max-depth)")
            }
            (StopReason::DepthLimit, _) => "it passed too many surfaces that are not there".to_owned(),
            (StopReason::ContributionBelowCutoff, Some([share, least])) => {
                format!("its share in the pixel, {share}, is not above {least} (--min-contribution)")
            }
            (StopReason::BelowHorizon, _) => {
                "a microfacet sends it below the horizon of its surface".to_owned()
            }
            (StopReason::Cancelled, _) => "the record was given up".to_owned(),
            _ => return None,
        })
    }
}

/// The lobes in words.
fn lobes(basis: &Basis, shading: &TreeShading) -> Vec<String> {
    let of = |l: &LobeView| {
        let [r, t] = [l.reflectance, l.transmittance].map(|s| lanes(basis, s));
        match l.name {
            "diffuse" => format!("diffuse kd {r}"),
            "ambient" => format!("ambient ka {r}"),
            "specular" => format!("highlight ks {r}, n {}", number(l.exponent.unwrap_or(0.0).into())),
            "mirror" => format!("mirror {r}"),
            "clear" => format!("lets {t} straight through"),
            "glossy" => format!("microfacets F0 {r}, alpha {}", number(l.alpha.unwrap_or(0.0).into())),
            "gloss" => format!("gloss {r}, n {}", number(l.exponent.unwrap_or(0.0).into())),
            name => name.to_owned(),
        }
    };
    let counts = |l: &&LobeView| !l.reflectance.is_black() || !l.transmittance.is_black();
    shading.lobes.iter().filter(counts).map(of).collect()
}
