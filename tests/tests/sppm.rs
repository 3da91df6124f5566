//! Photon mapping: the pictures of paths, what photons bring in closed form, and what no other way finds.
use durer::{Options, Prepared};
use durer_tests::{
    bits, render, scene,
    small::{AHEAD, BOX, LAMP, THINGS, difference, means, picture, total},
};

/// With so small discs that their blur is less than the noise, and so many photons that both are small.
const FINE: &str = "\"float radius\" 0.12 \"integer photonsperiteration\" 3000";

fn agrees(name: &str, view: &str, world: &str, samples: u32, limits: (f64, f64)) {
    let of = |integrator: &str, more: &str, samples| {
        means(&picture(view, &format!("\"{integrator}\" \"integer maxdepth\" 4 {more}"), world, samples))
    };
    let (path, found) = (of("path", "", 1024), of("sppm", FINE, samples));
    let (bias, error) = difference(&path, &found);
    assert!(total(&path) > 1e-3, "{name} is dark");
    assert!(
        bias.abs() < limits.0 && error < limits.1,
        "{name}: {bias}, pixels {error}\n{path:?}\n{found:?}"
    );
}

#[test]
fn photons_bring_what_paths_find_with_every_light() {
    let from = "\"point3 from\" [1 3 -2] \"point3 to\" [0 0 0]";
    for (name, lights) in [
        ("lamp", LAMP.to_owned()),
        ("point", "LightSource \"point\" \"point3 from\" [1 3 -2] \"rgb I\" [9 8 7]".to_owned()),
        ("distant", format!("LightSource \"distant\" {from} \"rgb L\" [2 2 1]")),
        ("even sky", "LightSource \"infinite\" \"rgb L\" [0.4 0.5 0.6]".to_owned()),
        ("many", format!("{LAMP}LightSource \"point\" \"point3 from\" [-2 2 -2] \"rgb I\" [2 3 4]\nLightSource \"infinite\" \"rgb L\" [0.1 0.1 0.1]")),
    ] {
        agrees(name, &format!("{AHEAD}\n{BOX}"), &format!("{lights}\n{THINGS}"), 64, (0.015, 0.06));
    }
}
