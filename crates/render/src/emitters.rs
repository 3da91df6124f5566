//! From what particles start: lights, and media that glow, by their power.
use durer_core::{
    Id,
    math::{Bounds3, Vector3},
};
use durer_model::{Fill, Medium, light::Steps, medium::Glowing};

use crate::{Object, Scene, scene::Target};

/// What sends a particle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Emitter {
    /// The light of this index in the scene.
    Light(usize),
    /// The volume of this one.
    Glow(usize),
}

/// All that sends particles.
#[derive(Debug)]
pub(crate) struct Emitters {
    lights: Vec<u32>,
    powers: Option<Steps>,
    /// The volumes that glow.
    volumes: Vec<u32>,
    glowing: Vec<Glowing>,
    /// By their power.
    glows: Option<Steps>,
    /// What of all power media send out.
    share: f32,
}

impl Emitters {
    fn new(scene: &Scene) -> Self {
        let of = |light: &u32| &scene.lights[*light as usize];
        let lights: Vec<u32> = (0..scene.lights.len() as u32).filter(|i| of(i).is_emitter()).collect();
        let power: Vec<f32> = lights.iter().map(|i| of(i).power(scene.extent.radius)).collect();
        let all_lights: f32 = power.iter().sum();
        let around = scene.finite_box();
        let (mut volumes, mut glowing) = (Vec::new(), Vec::new());
        for (number, volume) in (0..).zip(scene.volumes.iter()).filter(|(_, volume)| !volume.is_dark()) {
            if let Some(places) = volume.glowing(&scene.bodies_with(Fill::Volume(number)), around) {
                volumes.push(number);
                glowing.push(places);
            }
        }
        let glow: Vec<f32> = glowing.iter().map(Glowing::power).collect();
        let all_glows: f32 = glow.iter().sum();
        let (powers, glows) = (Steps::new(power), Steps::new(glow));
        let share = match (&powers, &glows) {
            (_, None) => 0.0,
            (None, Some(_)) => 1.0,
            // Estimates of either may be far off.
            (Some(_), Some(_)) => (all_glows / (all_glows + all_lights)).clamp(0.1, 0.9),
        };
        Self { lights, powers, volumes, glowing, glows, share }
    }
}

impl Scene {
    fn emitters(&self) -> &Emitters {
        self.emitters.get_or_init(|| Emitters::new(self))
    }

    /// What sends a particle, chosen by `u` in `[0, 1)`, which is asked for if there is a choice, and the probability of that;
    /// `None` if nothing sends any. Media that glow only where media are heeded.
    pub(crate) fn choose_emitter(
        &self,
        heeds_media: bool,
        u: impl FnOnce() -> f32,
    ) -> Option<(Emitter, f32)> {
        let emitters = self.emitters();
        let share = if heeds_media { emitters.share } else { 0.0 };
        // PERF: most scenes have one light (bench render).
        let one = share == 0.0 && emitters.lights.len() == 1;
        let u = if one { 0.0 } else { u() };
        match &emitters.glows {
            Some(glows) if u < share => {
                let (place, chance) = glows.choose((u / share).min(BELOW_ONE));
                Some((Emitter::Glow(emitters.volumes[place] as usize), chance * share))
            }
            _ => {
                let rest = if share > 0.0 { ((u - share) / (1.0 - share)).min(BELOW_ONE) } else { u };
                let (place, chance) = emitters.powers.as_ref()?.choose(rest);
                Some((Emitter::Light(emitters.lights[place] as usize), chance * (1.0 - share)))
            }
        }
    }

    /// The probability with which [`Scene::choose_emitter`] gives this one.
    pub(crate) fn emitter_chance(&self, heeds_media: bool, emitter: Emitter) -> f32 {
        let emitters = self.emitters();
        let share = if heeds_media { emitters.share } else { 0.0 };
        let (numbers, steps, number, share) = match emitter {
            Emitter::Light(light) => (&emitters.lights, &emitters.powers, light, 1.0 - share),
            Emitter::Glow(volume) => (&emitters.volumes, &emitters.glows, volume, share),
        };
        match (steps, numbers.binary_search(&(number as u32))) {
            (Some(steps), Ok(place)) => steps.chance(place) * share,
            _ => 0.0,
        }
    }

    /// The places of a volume that glows; `None` if it does not.
    pub(crate) fn glowing(&self, volume: usize) -> Option<&Glowing> {
        let emitters = self.emitters();
        emitters.volumes.binary_search(&(volume as u32)).ok().map(|place| &emitters.glowing[place])
    }

    /// Whether a volume glows that, as the file says, is not only within bodies and has no bounds of its own.
    pub fn glows_endlessly(&self, volume: u32) -> bool {
        let fill = Fill::Volume(volume);
        let is_around = || self.start.fill(&self.media) == fill;
        let is_outside =
            |medium: Option<Id<Medium>>| medium.is_some_and(|id| self.media.get(id).outside == Some(fill));
        let volume = &self.volumes[volume as usize];
        let objects = || (0..self.objects.len() as u32).map(|object| self.medium_of(Id::new(object)));
        !volume.is_dark() && volume.is_even() && (is_around() || objects().any(is_outside))
    }

    /// A box around everything finite.
    fn finite_box(&self) -> Bounds3 {
        let reach = Vector3::splat(self.extent.radius);
        Bounds3::new(self.extent.center - reach, self.extent.center + reach)
    }

    /// Boxes around the bodies that this fills, as they are when the shutter opens and closes; all in one if there are many.
    fn bodies_with(&self, fill: Fill) -> Vec<Bounds3> {
        const MANY: usize = 16;
        let is_filled = |object: Id<Object>| {
            let medium = self.medium_of(object).map(|id| self.media.get(id));
            medium.is_some_and(|medium| medium.inside == Some(fill))
        };
        let shutter = self.view.shutter.interval();
        let mut boxes = Vec::new();
        for (number, target) in (0..).zip(self.targets.iter()) {
            let placed = |own: Bounds3| {
                [shutter.min, shutter.max]
                    .map(|time| self.accel.instance_transform(number, time).bounds(&own))
                    .into_iter()
                    .fold(Bounds3::EMPTY, Bounds3::union)
            };
            match target {
                Target::Baked(object, mesh) | Target::Mesh(object, mesh) if is_filled(*object) => {
                    boxes.push(placed(Bounds3::around(mesh.positions.iter().copied())));
                }
                Target::Mover(index) if is_filled(self.movers[*index as usize].object) => {
                    boxes.push(placed(self.movers[*index as usize].shape.bounds()));
                }
                Target::Shapes => boxes.extend(
                    self.shapes
                        .iter()
                        .filter(|shape| is_filled(shape.object))
                        .map(|shape| shape.render_from_object.bounds(&shape.shape.bounds())),
                ),
                _ => {}
            }
        }
        match boxes.len() > MANY {
            true => vec![boxes.into_iter().fold(Bounds3::EMPTY, Bounds3::union)],
            false => boxes,
        }
    }
}

/// The largest number below 1.
const BELOW_ONE: f32 = 1.0 - f32::EPSILON / 2.0;
