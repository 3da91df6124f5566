//! Sentences about what floats on the way of a ray.
use durer_model::{Volume, medium::Phase};

use crate::probe::{Floating, Particle, TreeNode};

use super::{super::words::number, Teller};

impl Teller<'_> {
    /// That a ray met a particle, as it is told of surfaces.
    pub(super) fn met_particle(&self, ray: &str, floating: &Floating, particle: &Particle) -> String {
        let length = number(f64::from(particle.t));
        format!(
            "{ray} meets a particle of \"{}\" after {length} m, where {} is scattered per metre and {} absorbed.",
            self.medium(floating),
            self.lanes(particle.sigma_s),
            self.lanes(particle.sigma_a)
        )
    }

    /// What is left of light on the way, and what the medium sends out.
    pub(super) fn floated(&self, node: &TreeNode) -> Vec<String> {
        let Some(floating) = &node.floating else { return Vec::new() };
        let name = self.medium(floating);
        let mut sentences = Vec::new();
        sentences.push(match floating.particle {
            Some(particle) => format!(
                "It scatters light {} with g = {}; what comes counts times {}, which is the share that is left and scattered divided by the density of the place.",
                self.phase(floating),
                number(f64::from(particle.g)),
                self.lanes(floating.weight)
            ),
            None => format!(
                "On its way through \"{name}\" the ray got by with probability {}; what comes counts times {}, the share that is left divided by that.",
                number(f64::from(floating.passed)),
                self.lanes(floating.weight)
            ),
        });
        if !floating.sent.is_black() {
            sentences.push(format!("\"{name}\" itself sends {}.", self.lanes(floating.sent)));
        }
        sentences
    }

    fn phase(&self, floating: &Floating) -> &'static str {
        match self.prepared.scene.volume_of(floating.fill).map(Volume::phase) {
            Some(Phase::Drops(_)) => "as drops of water do,",
            Some(Phase::Rayleigh) => "as molecules of air do (Rayleigh),",
            Some(Phase::Table(_)) => "as a table of cosines says,",
            Some(Phase::Flakes(_)) => "as flakes do that mirror (SGGX),",
            Some(Phase::Blend(_)) => "as several kinds of particles do side by side,",
            Some(Phase::HenyeyGreenstein(_)) | None => "by the phase function of Henyey and Greenstein",
        }
    }

    fn medium(&self, floating: &Floating) -> String {
        self.prepared.scene.fill_name(floating.fill).to_owned()
    }
}
