//! Shadow rays lead to the light that they claim to ask: where that is its own business, not the integrator's.
use super::{super::words, Checked, Law, angle, unit};
use crate::{
    SampleCx,
    glam::DVec3,
    math::{Point3, Ray},
    model::light::LightCx,
    probe::{NoProbe, TreeNode},
    sampling::{Sampler, SamplerKind},
};

/// Largest angle between directions that are the same, in radians.
const SAME: f64 = 2e-3;
/// Points of a light that are looked at.
const POINTS: u32 = 64;

impl Checked<'_> {
    pub(super) fn shadow_rays(&mut self, index: usize, node: &TreeNode) {
        let Some(event) = &node.light else { return };
        let Some(light) = self.prepared.scene.lights.get(event.light as usize) else {
            let text =
                format!("shadow ray {index} asks light {}, which the scene does not have", event.light);
            return self.add(Law::ShadowRay, index, "no light", text);
        };
        let asked = LightCx { basis: self.tree.basis, time: node.path.ray.time };
        let from = node.path.from;
        let d = unit(node.d);
        // A light that gives nothing here cannot say where it is.
        let Some(middle) = light.sample(&asked, from, &Sampler::middle()) else { return };
        // PERF: the points of lights with extent are only looked at where nothing of theirs lies on the ray.
        if middle.pdf.is_some() && self.meets(node, event.light, event.point) {
            return;
        }
        let points = if middle.pdf.is_some() { POINTS } else { 1 };
        let samples: Vec<DVec3> = (0..points)
            .filter_map(|i| {
                let sampler = Sampler::new(SamplerKind::Sobol, 1, [0, 0], i, points);
                light.sample(&asked, from, &sampler).map(|sample| toward(from, sample.point, unit(sample.wi)))
            })
            .collect();
        let Some(off) = samples.iter().map(|wi| angle(d, *wi)).reduce(f64::min) else { return };
        if off <= SAME + 3.0 * spread(&samples) {
            return;
        }
        let name = self.prepared.scene.light_names.get(event.light as usize).cloned().unwrap_or_default();
        let instead = self.aims_at(node, event.light);
        let text = format!(
            "the shadow ray to light \"{name}\" points {} degrees away from it{instead}",
            words::degrees(off)
        );
        self.add(Law::ShadowRay, index, &name, text);
    }

    /// Which other light it leads to, if to any.
    fn aims_at(&self, node: &TreeNode, claimed: u32) -> String {
        let scene = &self.prepared.scene;
        let asked = LightCx { basis: self.tree.basis, time: node.path.ray.time };
        let from = node.path.from;
        let leads = |light: &dyn crate::model::light::Light| {
            let sample = light.sample(&asked, from, &Sampler::middle());
            sample.is_some_and(|s| angle(unit(node.d), toward(from, s.point, unit(s.wi))) < 10.0 * SAME)
        };
        let other = (0..).zip(scene.lights.iter()).find(|(i, light)| *i != claimed && leads(&***light));
        let name = other.and_then(|(i, _)| scene.light_names.get(i as usize));
        name.map(|name| format!("; it points to light \"{name}\"")).unwrap_or_default()
    }

    /// Whether something that is this light lies on the ray, at the point that it goes to.
    fn meets(&self, node: &TreeNode, light: u32, point: Option<Point3>) -> bool {
        let scene = &self.prepared.scene;
        let cx = SampleCx { scene, basis: self.tree.basis };
        let Some(point) = point else { return false };
        let way = point - node.path.from;
        let (length, d) = (way.length(), way.normalize());
        let mut ray = Ray {
            t_min: 0.99 * length,
            t_max: 1.01 * length,
            time: node.path.ray.time,
            ..Ray::new(node.path.from, d)
        };
        let leads_there = angle(unit(node.d), unit(way)) <= SAME;
        for _ in 0..16 {
            let Some(hit) = scene.closest(&cx, &ray, &mut NoProbe, ()) else { return false };
            if scene.object(scene.resolve(&hit).0).light == Some(light) {
                return leads_there;
            }
            ray.t_min = hit.t.next_up() + 1e-5 * length;
        }
        false
    }
}

/// Unit direction to a point, or the given one to what is infinitely far away.
fn toward(from: Point3, point: Option<Point3>, wi: DVec3) -> DVec3 {
    point.map_or(wi, |p| (p.to_f64() - from.to_f64()).normalize_or_zero())
}

/// The largest distance of a direction to the nearest other one.
fn spread(all: &[DVec3]) -> f64 {
    let nearest = |(i, a): (usize, &DVec3)| {
        let others = all.iter().enumerate().filter(move |(j, _)| *j != i);
        others.map(|(_, b)| angle(*a, *b)).fold(f64::INFINITY, f64::min)
    };
    let largest = all.iter().enumerate().map(nearest).fold(0.0, f64::max);
    if largest.is_finite() { largest } else { 0.0 }
}
