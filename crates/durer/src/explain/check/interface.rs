//! Refraction by Snell's law and the division of light by Fresnel's equations, from the bodies on both sides.
use super::{
    super::{bodies::present, words},
    Checked, Law, angle, unit,
};
use crate::{
    glam::DVec3,
    math::Vector3,
    probe::{RayKind, StopReason, TreeHit, TreeNode},
    spectrum::Spectrum,
};

/// Largest error of a ratio of sines; and of a share of light.
const TOLERANCE: f64 = 2e-3;
/// Sines below this say nothing about their ratio.
const SMALL: f64 = 0.02;

/// The sides of an interface as they should be.
struct Sides {
    n1: f64,
    n2: f64,
    cos: f64,
    sin: f64,
}

impl Sides {
    /// Sine of the angle of refraction; above 1 all light is reflected.
    fn sin_behind(&self) -> f64 {
        self.sin * self.n1 / self.n2
    }
    /// Share that is reflected: the mean of both polarisations.
    fn reflected(&self) -> f64 {
        let sin = self.sin_behind();
        if sin >= 1.0 {
            return 1.0;
        }
        let (c1, c2) = (self.cos, (1.0 - sin * sin).sqrt());
        let (n1, n2) = (self.n1, self.n2);
        let s = (n1 * c1 - n2 * c2) / (n1 * c1 + n2 * c2);
        let p = (n1 * c2 - n2 * c1) / (n1 * c2 + n2 * c1);
        0.5 * (s * s + p * p)
    }
    /// So near to the critical angle that single precision cannot tell the sides of it.
    fn is_critical(&self) -> bool {
        (self.sin_behind() - 1.0).abs() < 1e-3
    }
}

impl Checked<'_> {
    pub(super) fn interfaces(&mut self, index: usize, node: &TreeNode, hit: &TreeHit) {
        if self.is_passed(index) {
            return;
        }
        let Some(sides) = self.sides(node, hit) else { return };
        let children: Vec<_> = self
            .below(index)
            .filter(|(_, child)| {
                let lobe = child.chosen.and_then(|c| c.lobe);
                lobe.is_none_or(|lobe| lobe == "glass" || lobe == "frosted")
            })
            .filter(|(_, child)| matches!(child.kind, RayKind::Reflection | RayKind::Refraction))
            .map(|(number, child)| (number, child.clone()))
            .collect();
        let mut is_bent_wrongly = false;
        for (number, child) in &children {
            if child.kind == RayKind::Refraction {
                is_bent_wrongly |= self.snell(*number, (node, hit), child, &sides);
            }
        }
        // Shares that follow from wrong indices are not wrong by themselves.
        if !is_bent_wrongly {
            for (number, child) in &children {
                self.fresnel(*number, (node, hit), child, &sides);
            }
        }
    }

    /// What lies on both sides; `None` where there is no interface, or its sides are not known.
    fn sides(&self, node: &TreeNode, hit: &TreeHit) -> Option<Sides> {
        let scene = &self.prepared.scene;
        let shading = node.shading.as_ref()?;
        shading.fresnel.as_ref()?;
        let medium = scene.media.of_material(self.object(hit).material)?;
        let own = scene.media.get(medium);
        let before = node.path.media;
        let basis = &self.tree.basis;
        let n1 = present(&scene.media, basis, &before).0;
        let n2 = match own.priority {
            None if hit.from_outside => n1 * f64::from(own.eta(basis)),
            None => n1 / f64::from(own.eta(basis)),
            // What is wrong with the account is told of that.
            Some(_) if !hit.from_outside && !before.iter().any(|id| id == medium) => return None,
            Some(_) => present(&scene.media, basis, &shading.media?.after).0,
        };
        let cos = unit(Vector3::from(hit.n_s)).dot(unit(node.d)).abs().min(1.0);
        let sin = unit(Vector3::from(hit.n_s)).cross(unit(node.d)).length();
        Some(Sides { n1, n2, cos, sin })
    }

    /// Whether the direction of a refracted ray, or that there is none, breaks Snell's law.
    fn snell(
        &mut self,
        number: usize,
        (node, hit): (&TreeNode, &TreeHit),
        child: &TreeNode,
        sides: &Sides,
    ) -> bool {
        if sides.is_critical() {
            return false;
        }
        let name = self.name(hit);
        let wrong = match child.stop {
            Some(StopReason::TirNoRefraction) => sides.wrongly_reflected(&name),
            _ => sides.wrongly_refracted(&name, (node, hit), child),
        };
        let is_wrong = wrong.is_some();
        if let Some(text) = wrong {
            self.add(Law::Snell, number, &name, text);
        }
        is_wrong
    }

    /// Whether weights are what Fresnel's equations give.
    fn fresnel(
        &mut self,
        number: usize,
        (node, hit): (&TreeNode, &TreeHit),
        child: &TreeNode,
        sides: &Sides,
    ) {
        let Some(shading) = &node.shading else { return };
        let is_constant = shading.fresnel.is_none_or(|f| f.is_constant);
        let lobes: Vec<_> =
            shading.lobes.iter().filter(|l| l.name == "glass" || l.name == "frosted").collect();
        let &[lobe] = lobes.as_slice() else { return };
        if is_constant || sides.is_critical() || child.stop == Some(StopReason::TirNoRefraction) {
            return;
        }
        let reflected = sides.reflected();
        let (share, factor, verb) = match child.kind {
            RayKind::Reflection => (reflected, lobe.reflectance, "reflected"),
            _ => (1.0 - reflected, lobe.transmittance, "transmitted"),
        };
        let all = shading.arrived * factor;
        let full = lanes(all);
        let told = lanes(child.share(node));
        let is_wrong = |i: usize| (told[i] - share * full[i]).abs() > TOLERANCE * full[i].max(1e-3);
        if !(0..4).any(is_wrong) {
            return;
        }
        let name = self.name(hit);
        let text = format!(
            "of light on \"{name}\" {} must be {verb} (n1 = {}, n2 = {}, {} degrees, factor {}), but the ray weighs {}",
            words::percent(share),
            words::number(sides.n1),
            words::number(sides.n2),
            words::degrees_of(sides.cos),
            words::lanes(&self.tree.basis, all),
            words::lanes(&self.tree.basis, child.share(node))
        );
        self.add(Law::Fresnel, number, &name, text);
    }
}

const SWAPPED: &str = "n1 and n2 are swapped";

impl Sides {
    fn words(&self) -> String {
        let [n1, n2] = [self.n1, self.n2].map(words::number);
        format!("n1 = {n1}, n2 = {n2} at {} degrees", words::degrees(self.sin.asin()))
    }

    /// What is wrong where a ray is said to be reflected altogether.
    fn wrongly_reflected(&self, name: &str) -> Option<String> {
        let sin_behind = self.sin_behind();
        let swapped = if self.sin * self.n2 > self.n1 { format!("; {SWAPPED}") } else { String::new() };
        (sin_behind < 1.0).then(|| {
            format!(
                "at \"{name}\" all light is said to be reflected inside, but {} give sin b = {}{swapped}",
                self.words(),
                words::number(sin_behind)
            )
        })
    }

    /// What is wrong with a refracted ray.
    fn wrongly_refracted(
        &self,
        name: &str,
        (node, hit): (&TreeNode, &TreeHit),
        child: &TreeNode,
    ) -> Option<String> {
        let [n_g, n_s] = [hit.n_g, hit.n_s].map(|n| unit(Vector3::from(n)));
        let (d, out) = (unit(node.d), unit(child.d));
        let Some(expected) = refracted(d, n_s, self) else {
            let swapped = if self.sin * self.n2 < self.n1 { format!("; {SWAPPED}") } else { String::new() };
            return Some(format!(
                "a ray is refracted at \"{name}\" where all light must be reflected: {} give sin b = {}{swapped}",
                self.words(),
                words::number(self.sin_behind())
            ));
        };
        let stays = (expected.dot(n_g) > 0.0) != (d.dot(n_g) > 0.0);
        let expected = if stays { expected - n_g * (2.0 * n_g.dot(expected)) } else { expected };
        let off = angle(out, expected);
        let (media, sin_out) = (self.n2 / self.n1, n_s.cross(out).length());
        let measured = if self.sin > SMALL && sin_out > SMALL {
            let ratio = self.sin / sin_out;
            let is_swapped = (ratio * media - 1.0).abs() < 0.01;
            let swapped = if is_swapped { format!(": {SWAPPED}") } else { String::new() };
            let [ratio, media] = [ratio, media].map(words::number);
            format!("sin a / sin b = {ratio}, the media say {media}{swapped}")
        } else {
            format!("the media say sin a / sin b = {}", words::number(media))
        };
        (off > TOLERANCE).then(|| {
            let (off, sides) = (words::degrees(off), self.words());
            format!("the ray refracted at \"{name}\" is {off} degrees off: {measured} ({sides})")
        })
    }
}

/// The direction behind an interface; `None` if there is none.
fn refracted(d: DVec3, n: DVec3, sides: &Sides) -> Option<DVec3> {
    let n = if n.dot(d) > 0.0 { -n } else { n };
    let ratio = sides.n1 / sides.n2;
    let sin = sides.sin_behind();
    let cos = (1.0 - sin * sin >= 0.0).then(|| (1.0 - sin * sin).sqrt())?;
    Some((d * ratio + n * (ratio * sides.cos - cos)).normalize_or_zero())
}

fn lanes(s: Spectrum) -> [f64; 4] {
    s.lanes().map(f64::from)
}
