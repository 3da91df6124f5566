//! Why no light arrives at what the camera sees: each light is asked at each place that an eye ray met.
use std::collections::BTreeMap;

use durer_core::{
    math::{Normal3, Ray},
    sampling::Sampler,
    spectrum::Basis,
};
use durer_model::light::LightCx;

use super::{
    Finding,
    look::{Look, Sight},
};
use crate::{Prepared, SampleCx};

/// Lights that are asked at most.
const ASKED: usize = 64;
/// Points of an extended light, per place.
const POINTS: u32 = 4;

/// What became of the light of one lamp.
#[derive(Default)]
struct Fate {
    /// How often it was asked.
    asked: usize,
    /// How often it sends nothing there.
    silent: usize,
    /// How often it comes from behind an opaque surface.
    behind: usize,
    /// How often something else was in between: by object.
    blocked: BTreeMap<u32, usize>,
}

/// What keeps the light of each lamp; nothing if any of them arrives anywhere.
pub(super) fn findings(prepared: &Prepared, look: &Look) -> Vec<Finding> {
    let scene = &prepared.scene;
    let asked = (0..scene.lights.len()).filter(|&i| scene.lights[i].is_sampled()).take(ASKED);
    let fates: Option<Vec<(usize, Fate)>> =
        asked.map(|light| Some((light, fate(prepared, look, light)?))).collect();
    let told = |(light, fate): (usize, Fate)| told(prepared, light, &fate);
    fates.unwrap_or_default().into_iter().filter_map(told).collect()
}

/// What becomes of a light; `None` if some of it arrives.
fn fate(prepared: &Prepared, look: &Look, light: usize) -> Option<Fate> {
    let scene = &prepared.scene;
    let mut fate = Fate::default();
    for (place, sight) in look.sights.iter().enumerate() {
        let cx = LightCx { basis: Basis::Rgb, time: sight.ray.time };
        for point in 0..POINTS {
            let sampler = Sampler::new(prepared.settings.sampler, 0, [place as u32, 0], point, POINTS);
            fate.asked += 1;
            let sample = scene.lights[light].sample(&cx, sight.surface.p, &sampler);
            let Some(sample) = sample.filter(|s| !s.weight.is_black()) else {
                fate.silent += 1;
                continue;
            };
            let Sight { surface, ray, object, .. } = sight;
            let facing: Normal3 = surface.n_g.face_forward(-ray.d);
            let lets_through = scene.material(*object).medium().is_some();
            if facing.dot(sample.wi) <= 0.0 && !lets_through {
                fate.behind += 1;
                continue;
            }
            let shadow: Ray = match sample.point {
                Some(to) => surface.spawn_to(to, ray.time),
                None => surface.spawn(sample.wi, ray.time),
            };
            let blocker = scene.blocker(&SampleCx { scene, basis: Basis::Rgb }, &shadow)?;
            *fate.blocked.entry(blocker.index() as u32).or_default() += 1;
        }
    }
    (fate.asked > 0).then_some(fate)
}

fn told(prepared: &Prepared, light: usize, fate: &Fate) -> Option<Finding> {
    let scene = &prepared.scene;
    let name = scene.light_names.get(light).map_or("", String::as_str);
    let blocked: usize = fate.blocked.values().sum();
    if fate.silent >= fate.behind.max(blocked) {
        let bounds = scene.accel.bounds();
        let sends = scene.lights[light].power((bounds.max - bounds.min).length() * 0.5) > 0.0;
        return Some(if sends {
            Finding::warning(format!("the light \"{name}\" shines away from all that is seen")).remedy(
                "turn it; a surface that shines does so where its normals point: ReverseOrientation, or \
                 \"bool twosided\" true",
            )
        } else {
            Finding::warning(format!("the light \"{name}\" is black"))
                .remedy("give its colour, scale or power a value above 0")
        });
    }
    if fate.behind >= blocked {
        let message = format!("the light \"{name}\" stands behind all surfaces that are seen");
        return Some(Finding::warning(message).remedy("move it to the side that the camera sees"));
    }
    let (&object, &times) = fate.blocked.iter().max_by_key(|(_, times)| **times)?;
    let blocker = &scene.objects[object as usize].name;
    let share = 100 * times / blocked;
    let message = format!(
        "none of the light of \"{name}\" arrives: \"{blocker}\" is in its way for {share} % of what is seen"
    );
    let remedy = format!(
        "move the light out of \"{blocker}\", or open it; glass shows light to paths that meet the lamp"
    );
    Some(Finding::warning(message).remedy(remedy))
}
