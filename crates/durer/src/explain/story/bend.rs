//! Sentences about interfaces: Snell's law, Fresnel's equations, total internal reflection.
use crate::{
    math::Vector3,
    probe::{RayKind, StopReason, TreeHit, TreeShading},
};

use super::{
    super::words::{degrees, number, percent},
    Teller,
};

impl Teller<'_> {
    pub(super) fn interface(&self, index: usize, hit: &TreeHit, shading: &TreeShading) -> Vec<String> {
        let Some(fresnel) = &shading.fresnel else { return Vec::new() };
        let node = self.node(index);
        let n_s = Vector3::from(hit.n_s).to_f64();
        let sin = |d: Vector3| n_s.cross(d.to_f64().normalize_or_zero()).length().min(1.0);
        let sin_a = sin(node.d);
        let a = degrees(sin_a.asin());
        let (n1, n2) = match shading.media {
            Some(media) => (f64::from(media.n1), f64::from(media.n2)),
            None => (1.0, f64::from(fresnel.eta)),
        };
        let indices = format!("n1 = {} to n2 = {}", number(n1), number(n2));
        if fresnel.is_total {
            let critical = fresnel.critical_angle.map(|c| degrees(c.into())).unwrap_or_default();
            return vec![format!(
                "From {indices} at {a} degrees n1 sin a / n2 = {} x {} / {} = {} exceeds 1, as the critical angle is {critical} \
                 degrees: total internal reflection, no ray is refracted.",
                number(n1),
                number(sin_a),
                number(n2),
                number(n1 * sin_a / n2)
            )];
        }
        let mut sentences = Vec::new();
        let refracted = self.children[index]
            .iter()
            .map(|&c| self.node(c as usize))
            .find(|c| c.kind == RayKind::Refraction && c.stop != Some(StopReason::TirNoRefraction));
        if let Some(child) = refracted {
            let sin_b = sin(child.d);
            sentences.push(format!(
                "Snell's law bends the ray from {a} to {} degrees: n1 sin a = n2 sin b, {} x {} = {} x {}.",
                degrees(sin_b.asin()),
                number(n1),
                number(sin_a),
                number(n2),
                number(sin_b)
            ));
        }
        if fresnel.is_constant {
            let lobe = shading.lobes.iter().find(|l| l.name == "glass" || l.name == "frosted");
            let (r, t) = lobe
                .map_or_else(Default::default, |l| (self.lanes(l.reflectance), self.lanes(l.transmittance)));
            sentences.push(format!(
                "The material shares the light by Whitted's constants, ks = {r} and kt = {t}; Fresnel's equations would \
                 reflect {}.",
                percent(fresnel.reflect.into())
            ));
        } else {
            let critical = match fresnel.critical_angle {
                Some(c) => format!(" (the critical angle is {} degrees)", degrees(c.into())),
                None => String::new(),
            };
            sentences.push(format!(
                "From {indices} at {a} degrees Fresnel's equations reflect R = {} and let T = {} through{critical}.",
                percent(fresnel.reflect.into()),
                percent(fresnel.transmit.into())
            ));
        }
        sentences
    }
}
