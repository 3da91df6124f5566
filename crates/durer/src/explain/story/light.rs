//! Sentences about lights: the formula with its numbers where one counts, the reason where it does not.
use crate::{
    glam::DVec3,
    math::Vector3,
    model::bsdf::LobeView,
    probe::{StopReason, TreeHit, TreeNode, TreeShading},
    spectrum::{Basis, Spectrum},
};

use super::{
    super::{
        part::light_name,
        words::{counted, degrees, degrees_of, each, lanes, number},
    },
    Teller,
};

/// Rays to one light that are told of one by one.
const RAYS: usize = 1;
/// Share in the sample of what is not worth a formula.
const NOTHING: f64 = 1e-3;

impl Teller<'_> {
    /// All lights at a hit, those that bring most first.
    pub(super) fn lights(&self, index: usize) -> Vec<String> {
        let parent = self.node(index);
        let mut by_light: Vec<(u32, Vec<&TreeNode>)> = Vec::new();
        for node in self.children[index].iter().map(|&c| self.node(c as usize)) {
            let Some(event) = &node.light else { continue };
            match by_light.iter_mut().find(|(light, _)| *light == event.light) {
                Some((_, rays)) => rays.push(node),
                None => by_light.push((event.light, vec![node])),
            }
        }
        let brings = |rays: &[&TreeNode]| rays.iter().map(|n| self.share(n)).sum::<f64>();
        by_light.sort_by(|(_, a), (_, b)| brings(b).total_cmp(&brings(a)));
        by_light.iter().flat_map(|(_, rays)| self.light(parent, rays)).collect()
    }

    /// One light: all rays to it.
    fn light(&self, parent: &TreeNode, rays: &[&TreeNode]) -> Vec<String> {
        let name = rays.first().and_then(|n| light_name(self.prepared, n)).unwrap_or("?");
        let mut sorted = rays.to_vec();
        sorted.sort_by(|a, b| self.share(b).total_cmp(&self.share(a)));
        let mut sentences: Vec<String> =
            sorted.iter().take(RAYS).map(|n| self.shadow_ray(parent, n, name)).collect();
        if rays.len() > RAYS {
            let lit = rays.iter().filter(|n| n.light.is_some_and(|l| l.visible)).count();
            let sum = rays.iter().fold(Spectrum::BLACK, |sum, node| sum + node.throughput * node.result);
            sentences.push(match lit {
                0 => format!("Nor does any other of its {} arrive.", counted(rays.len(), "shadow ray")),
                _ => format!(
                    "In all, {lit} of {} reach \"{name}\" and bring {}{}.",
                    counted(rays.len(), "shadow ray"),
                    self.lanes(sum),
                    self.of_pixel(self.rgb(sum))
                ),
            });
        }
        sentences
    }

    fn shadow_ray(&self, parent: &TreeNode, node: &TreeNode, name: &str) -> String {
        let (Some(hit), Some(shading), Some(event)) = (&parent.hit, &parent.shading, &node.light) else {
            return String::new();
        };
        let wi = node.d.to_f64().normalize_or_zero();
        let n = facing(hit, parent.d);
        let cos = n.dot(wi);
        let off = degrees_of(cos);
        let would = node.weight * event.unoccluded;
        let would = match would.is_black() {
            true => String::new(),
            false => format!("; free it would add {}", self.lanes(would)),
        };
        if !event.visible {
            return match (node.stop, event.blocker) {
                (Some(StopReason::LightBehindSurface), _) => {
                    format!(
                        "Light \"{name}\" does not count: it lies behind the surface, {off} degrees off the normal."
                    )
                }
                (Some(StopReason::BelowHorizon), _) => format!(
                    "Light \"{name}\" does not count: it lies below the horizon of the true surface, though {off} degrees \
                     off the shading normal."
                ),
                (Some(StopReason::Absorbed), _) => {
                    format!("Light \"{name}\" does not count: all of it is absorbed on its way{would}.")
                }
                (_, Some(blocker)) => {
                    let blocker = &self.prepared.scene.object(blocker).name;
                    let itself =
                        if hit.object == event.blocker.unwrap_or(hit.object) { " itself" } else { "" };
                    format!("Light \"{name}\" does not count: it is blocked by \"{blocker}\"{itself}{would}.")
                }
                (_, None) => format!("Light \"{name}\" does not count: it is blocked{would}."),
            };
        }
        let far = match event.point {
            Some(_) => format!("from {} m, ", number(node.d.to_f64().length())),
            None => String::new(),
        };
        if self.share(node) < NOTHING && (self.whole > 0.0 || node.weight.is_black()) {
            return format!(
                "Light \"{name}\" arrives {far}{off} degrees off the normal, but next to nothing of it goes this way."
            );
        }
        let share = self.rgb(node.throughput * node.result);
        format!(
            "Light \"{name}\" arrives {far}{off} degrees off the normal: {} = {}{}.",
            self.formula(parent, node, shading, (n, wi)),
            self.lanes(node.weight * node.result),
            self.of_pixel(share)
        )
    }

    /// What the surface makes of arriving light, with numbers.
    fn formula(
        &self,
        parent: &TreeNode,
        node: &TreeNode,
        shading: &TreeShading,
        (n, wi): (DVec3, DVec3),
    ) -> String {
        let cos = n.dot(wi).abs();
        let basis = &self.tree.basis;
        let (e_symbol, e) = irradiance(basis, node);
        let f = Reflectance::of(shading, node, (n, wi, -parent.d.to_f64().normalize_or_zero()));
        let (symbols, numbers) = f.words(basis);
        let (more_symbols, more) = factors(basis, node, shading);
        format!("{symbols} {e_symbol} cos a{more_symbols} = {numbers} x {e} x {}{more}", number(cos))
    }
}

/// The shading normal on the side of the ray.
fn facing(hit: &TreeHit, d: Vector3) -> DVec3 {
    let n = Vector3::from(hit.n_s).to_f64();
    if Vector3::from(hit.n_g).to_f64().dot(d.to_f64()) > 0.0 { -n } else { n }
}

/// What arrives: irradiance, or of lights with extent radiance by density.
fn irradiance(basis: &Basis, node: &TreeNode) -> (String, String) {
    let Some(event) = &node.light else { return Default::default() };
    let through = |text: String| {
        if event.passed == Spectrum::ONE {
            return text;
        }
        format!("{text} x {} (what its way leaves)", lanes(basis, event.passed))
    };
    match node.chosen.and_then(|c| c.pdf) {
        Some(pdf) => {
            let radiance = event.unoccluded * pdf;
            ("L / p".to_owned(), through(format!("{} / {}", lanes(basis, radiance), number(pdf.into()))))
        }
        None => ("E".to_owned(), through(lanes(basis, event.unoccluded))),
    }
}

/// Factors beside reflectance, light and cosine.
fn factors(basis: &Basis, node: &TreeNode, shading: &TreeShading) -> (String, String) {
    let (mut symbols, mut numbers) = (String::new(), String::new());
    let mut add = |symbol: &str, text: String| {
        symbols += symbol;
        numbers += &text;
    };
    if shading.arrived != Spectrum::ONE {
        add(" T", format!(" x {}", lanes(basis, shading.arrived)));
    }
    if let Some(chosen) = &node.chosen {
        if let Some(mis) = chosen.mis.filter(|m| *m < 0.9995) {
            add(" w", format!(" x {}", number(mis.into())));
        }
        if chosen.chance < 1.0 {
            add(" / chance", format!(" / {}", number(chosen.chance.into())));
        }
        if chosen.rays > 1 {
            add(" / rays", format!(" / {}", chosen.rays));
        }
    }
    (symbols, numbers)
}

/// The value of the lobes for a pair of directions, divided into what formulas there are for.
struct Reflectance {
    diffuse: [f64; 4],
    /// `ks`, `n`, the cosine to the halfway vector and the cosine to the light.
    highlight: Option<([f64; 4], f64, f64, f64)>,
    /// What microfacets and others make of the rest, and their name.
    others: Option<(String, [f64; 4])>,
}

impl Reflectance {
    fn of(shading: &TreeShading, node: &TreeNode, (n, wi, wo): (DVec3, DVec3, DVec3)) -> Self {
        let sum = |name: &str| {
            let all =
                shading.lobes.iter().filter(|l| l.name == name).map(|l| l.reflectance.lanes().map(f64::from));
            all.fold([0.0; 4], |a: [f64; 4], b| std::array::from_fn(|i| a[i] + b[i]))
        };
        let is_same_side = n.dot(wi) > 0.0;
        let diffuse = if is_same_side { sum("diffuse") } else { [0.0; 4] };
        let highlight = shading.lobes.iter().find(|l| l.name == "specular" && is_same_side).map(|l| {
            let half = (wi + wo).normalize_or_zero();
            (
                l.reflectance.lanes().map(f64::from),
                f64::from(l.exponent.unwrap_or(0.0)),
                n.dot(half).abs().min(1.0),
                n.dot(wi),
            )
        });
        let arrived = shading.arrived.lanes().map(f64::from);
        let f = node.chosen.and_then(|c| c.f).map(|f| f.lanes().map(f64::from)).unwrap_or_default();
        let told = Self { diffuse, highlight, others: None };
        // Two thousandths of the whole are rounding, and MIS weights that differ from lobe to lobe.
        let rest: [f64; 4] =
            std::array::from_fn(|i| if arrived[i] > 0.0 { f[i] / arrived[i] - told.named(i) } else { 0.0 });
        let is_off = (0..4).any(|i| rest[i].abs() > 2e-3 * (told.named(i) + rest[i].abs()).max(1e-9));
        if !is_off {
            return told;
        }
        let is_negative = (0..4).any(|i| rest[i] < -2e-3 * told.named(i).max(1e-9));
        let others = shading.lobes.iter().find(|l| !matches!(l.name, "diffuse" | "specular" | "ambient"));
        if is_negative {
            // Lobes that count less than in full beside rays of their own.
            let all: [f64; 4] =
                std::array::from_fn(|i| if arrived[i] > 0.0 { f[i] / arrived[i] } else { 0.0 });
            return Self { diffuse: [0.0; 4], highlight: None, others: Some(("f".to_owned(), all)) };
        }
        Self { others: Some((others.map_or_else(|| "f".to_owned(), name), rest)), ..told }
    }

    /// What the formulas give.
    fn named(&self, i: usize) -> f64 {
        let highlight = self.highlight.map_or(0.0, |(ks, n, cos_h, cos)| {
            if cos > 0.0 { ks[i] * cos_h.powf(n) / (std::f64::consts::PI * cos) } else { 0.0 }
        });
        self.diffuse[i] / std::f64::consts::PI + highlight
    }

    /// Symbols, and the numbers in their places.
    fn words(&self, basis: &Basis) -> (String, String) {
        let mut symbols = Vec::new();
        let mut numbers = Vec::new();
        if self.diffuse != [0.0; 4] {
            symbols.push("kd / pi".to_owned());
            numbers.push(format!("{} / 3.142", each(basis, self.diffuse)));
        }
        if let Some((ks, n, cos_h, cos)) = self.highlight
            && cos_h.powf(n) > 1e-4
        {
            symbols.push("ks cos^n h / (pi cos a)".to_owned());
            numbers.push(format!(
                "{} x cos^{}({} degrees) / (3.142 x {})",
                each(basis, ks),
                number(n),
                degrees(cos_h.acos()),
                number(cos)
            ));
        }
        if let Some((name, f)) = &self.others {
            symbols.push(name.clone());
            numbers.push(each(basis, *f));
        }
        match symbols.len() {
            0 => ("f".to_owned(), "0".to_owned()),
            1 => (symbols.concat(), numbers.concat()),
            _ => (format!("({})", symbols.join(" + ")), format!("({})", numbers.join(" + "))),
        }
    }
}

/// What a lobe's value is called.
fn name(lobe: &LobeView) -> String {
    match lobe.alpha {
        Some(alpha) => format!("f(microfacets, alpha {})", number(alpha.into())),
        None => format!("f({})", lobe.name),
    }
}
