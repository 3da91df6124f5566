//! What light transport by particles from the lights leaves out of a scene.
use durer_model::light::Light;
use durer_render::{
    Scene,
    integrator::{Integrator, Particles},
};
use durer_scene::{Diagnostics, Location};

/// Says what particles from the lights cannot bring; `None` if they are all there is and the camera sees none of them.
pub(crate) fn check(scene: &Scene, integrator: &dyn Integrator, diagnostics: &mut Diagnostics) -> Option<()> {
    let particles = integrator.facts().particles;
    if particles == Particles::None {
        return Some(());
    }
    let are_all = particles == Particles::All;
    if particles == Particles::Gathered {
        if scene.view.shutter.is_rolling() {
            let message = "integrator \"sppm\" cannot take this picture: with a rolling shutter each row has a moment of its \
                           own, and photons lie where things are at one";
            diagnostics.error(Location::None, message).hint("take \"bdpt\" or \"path\"");
            return None;
        }
    } else if !scene.view.is_connectible() {
        let why = match scene.view.shutter.is_rolling() {
            true => "with a rolling shutter the row that sees it has a moment of its own",
            false => "no light can be traced to a camera of this kind",
        };
        if are_all {
            let message = format!("integrator \"light\" cannot take this picture: {why}");
            diagnostics.error(Location::None, message).hint("take \"bdpt\" or \"path\"");
            return None;
        }
        diagnostics.note(Location::None, format!("particles are not joined to the camera: {why}"));
    }
    let what = match particles {
        Particles::All => "what it lights stays dark",
        Particles::Gathered => "only its straight light is found",
        Particles::None | Particles::Some => "it is only found from the eye",
    };
    for (light, name) in scene.lights.iter().zip(&*scene.light_names) {
        if light.is_sampled() && !light.is_emitter() {
            let message =
                format!("light \"{name}\" sends no particles, as it does not fade with distance: {what}");
            diagnostics.warning(Location::None, message);
        }
    }
    if are_all {
        check_glow(scene, diagnostics);
    }
    let is_far = |light: &dyn Light| light.is_emitter() && (light.surrounds() || light.bounds().is_none());
    if particles != Particles::Some && scene.is_endless() && scene.lights.iter().any(|light| is_far(&**light))
    {
        let message = format!(
            "particles from far away reach no further than {} m around what has an end: a plane is dark beyond",
            scene.extent.radius
        );
        diagnostics.warning(Location::None, message).hint("give the plane an edge, or take \"bdpt\"");
    }
    Some(())
}

/// Says what glows where no particle starts.
fn check_glow(scene: &Scene, diagnostics: &mut Diagnostics) {
    for (_, name) in (0..).zip(&*scene.volume_names).filter(|(number, _)| scene.glows_endlessly(*number)) {
        let message = format!(
            "medium \"{name}\" glows without an end: what it sends from further than {} m around what has an end is missing",
            scene.extent.radius
        );
        diagnostics
            .warning(Location::None, message)
            .hint("put a body around it, or take \"bdpt\" or \"volpath\"");
    }
}
