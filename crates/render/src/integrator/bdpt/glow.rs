//! What glows along the eye's walk, by the share of having been met there.
use durer_core::spectrum::Spectrum;
use durer_model::{Fill, medium::Flier};

use super::{
    super::{
        vertices::{End, Flight},
        walk::{draws, span},
    },
    eye::EyeWalk,
};
use crate::{PathRay, probe::Probe};

impl<P: Probe> EyeWalk<'_, P> {
    /// What the medium sends along a ray that gets to parameter `t` if nothing scatters it, by shares; `sent` if each place
    /// counted in full.
    pub(super) fn glow(&self, ray: &PathRay, flight: Flight, (sent, t): (Spectrum, f32)) -> Spectrum {
        let ways = self.own.ways;
        let seen = self.vertices.len() + 2;
        let scene = self.walk.cx.scene;
        let fill = ray.media.fill(&scene.media);
        // What is seen straight from the camera is found in no other way.
        let (Some(volume), Fill::Volume(number), false) =
            (scene.volume_of(fill), fill, self.vertices.is_empty())
        else {
            return sent * ways.weight(0, seen, || 1.0);
        };
        let mut sum = Spectrum::BLACK;
        if volume.is_dark() {
            return sum;
        }
        let walk = &self.walk;
        let absorption = walk.absorption(&ray.media);
        let flier = Flier { basis: walk.cx.basis, lanes: ray.lanes, absorption };
        let way = span(ray.from, &ray.ray, t);
        volume.glimpse(&flier, &ray.ray, way, &draws(ray), |added, t| {
            let end = End::glow(walk.cx, number as usize, ray.ray.at(t));
            let share = || {
                let own = end.by_volume(self.density(flight, ray, (end.p, 1.0)));
                self.share_of_met(&end, ray.ray.d, (own, false))
            };
            sum += added * ways.weight(0, seen, share);
        });
        sum
    }
}
