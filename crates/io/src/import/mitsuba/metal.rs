//! Conductors that Mitsuba knows by name. Measured curves where durer has them (docs/reference.md); of the others index and
//! extinction for red, green and blue.
use durer_scene::{Data, Params, ValueType};

use super::{
    object::Object,
    world::{Role, Shade},
    world::{World, with_shade},
};

/// Metals of which durer has curves.
const MEASURED: [&str; 7] = ["Ag", "Al", "Au", "Cu", "CuZn", "MgO", "TiO2"];

/// Name, `eta`, `k`.
type Metal = (&'static str, [f32; 3], [f32; 3]);

/// Averages over linear Rec. 709's three functions of what Palik, "Handbook of Optical Constants of Solids", tabulates.
const COLORS: [Metal; 19] = [
    ("a-C", [2.944, 2.2272, 1.9682], [0.8874, 0.7993, 0.8153]),
    ("Be", [4.1851, 3.1851, 2.7841], [3.8354, 3.0101, 2.869]),
    ("Cr", [4.3697, 2.9167, 1.6547], [5.2064, 4.2314, 3.7549]),
    ("CsI", [2.1449, 1.7023, 1.6624], [0.0; 3]),
    ("Cu2O", [3.5493, 2.9521, 2.7369], [0.1132, 0.1947, 0.6002]),
    ("CuO", [3.2454, 2.4496, 2.1974], [0.5203, 0.5707, 0.7172]),
    ("d-C", [2.7113, 2.3186, 2.2289], [0.0; 3]),
    ("Hg", [2.3989, 1.44, 0.9096], [6.3276, 4.3719, 3.4218]),
    ("Ir", [3.0864, 2.0822, 1.6179], [5.5922, 4.0672, 3.2673]),
    ("K", [0.064, 0.0464, 0.0382], [2.1042, 1.3489, 0.9132]),
    ("Li", [0.2658, 0.1956, 0.2209], [3.5402, 2.3111, 1.6686]),
    ("Mo", [4.4837, 3.5255, 2.7761], [4.1111, 3.4209, 3.1506]),
    ("Na", [0.0603, 0.0561, 0.062], [3.1793, 2.1125, 1.5791]),
    ("Nb", [3.4201, 2.7902, 2.3956], [3.4414, 2.7376, 2.5799]),
    ("Ni", [2.3673, 1.6634, 1.4671], [4.4988, 3.0502, 2.3454]),
    ("Rh", [2.5858, 1.8602, 1.5544], [6.7823, 4.703, 3.9761]),
    ("TiC", [3.7005, 2.8374, 2.5823], [3.2657, 2.3516, 2.1728]),
    ("TiN", [1.6485, 1.1504, 1.3798], [3.3685, 1.9435, 1.102]),
    ("W", [4.3707, 3.3002, 2.9983], [3.5007, 2.6049, 2.2732]),
];

/// `eta` and `k` of a conductor: as they are given, or of the substance that is named. A mirror if nothing is.
pub(super) fn conductor(world: &mut World<'_>, object: &Object) -> Option<Params> {
    let params = Params::new();
    let outside = super::index::index(world, object, "ext_eta", "vacuum") as f32;
    let (eta, k) = (world.shade(object, "eta", Role::Surface), world.shade(object, "k", Role::Surface));
    if let (Some(eta), Some(k)) = (&eta, &k) {
        if [eta, k].iter().any(|s| matches!(s, Shade::Texture(_))) {
            world.said.error(object.at, "\"eta\" and \"k\" must be the same everywhere");
            return None;
        }
        let over = |shade: &Shade| match shade.clone() {
            Shade::Rgb(rgb) => Shade::Rgb(rgb.map(|v| v / outside)),
            Shade::Curve(c) => Shade::Curve(
                c.iter().enumerate().map(|(i, v)| if i % 2 == 1 { v / outside } else { *v }).collect(),
            ),
            other => other,
        };
        let params = with_shade(params, "eta", over(eta), object.at);
        return Some(with_shade(params, "k", over(k), object.at));
    }
    if eta.is_some() || k.is_some() {
        world.said.error(object.at, format!("{} needs both \"eta\" and \"k\"", object.shown()));
        return None;
    }
    let name = object.text("material", world.said).unwrap_or("none").to_owned();
    if name == "none" {
        return Some(params.rgb("reflectance", [1.0; 3]));
    }
    if MEASURED.contains(&name.as_str()) {
        let curve = |what: &str| Data::Strings(vec![format!("metal-{name}-{what}")]);
        let params = params.with("eta", ValueType::Spectrum, curve("eta"));
        return Some(params.with("k", ValueType::Spectrum, curve("k")));
    }
    if let Some((_, eta, k)) = COLORS.iter().find(|(n, ..)| *n == name) {
        world.note(object.at, format!("{name}: three colours stand for its curve over wavelengths"));
        return Some(params.rgb("eta", *eta).rgb("k", *k));
    }
    let at = object.get("material").map_or(object.at, |p| p.at);
    let known = MEASURED.iter().copied().chain(COLORS.iter().map(|(n, ..)| *n)).chain(["none"]);
    world.said.unknown(at, "conductor", &name, known);
    None
}
