//! Plastic: a matte body under a dielectric coat.
//!
//! Mitsuba's body sends `T(wi) T(wo) r / (pi eta² (1 - r F))`, with the share `F` of diffuse light that the coat reflects back
//! from inside, where `nonlinear`; else `1 - F` stands in place of `1 - r F`. Ours is the first. It gives the second, too,
//! for a body that reflects `r' = r / (1 - F + r F)`.
use durer_core::spectrum::Sampled;
use durer_scene::Params;

use super::{
    bsdf::{even, roughness},
    index::relative,
    object::Object,
    world::{Role, Shade, World, with_shade},
};

pub(super) fn plastic(world: &mut World<'_>, object: &Object) -> Option<(&'static str, Params)> {
    let eta = relative(world, object, "polypropylene").max(1.0);
    let nonlinear = object.truth("nonlinear", false, world.said);
    let at = object.get("diffuse_reflectance").map_or(object.at, |p| p.at);
    let shade = world.shade(object, "diffuse_reflectance", Role::Surface).unwrap_or(Shade::Rgb([0.5; 3]));
    let shade = if nonlinear { shade } else { linear(world, object, shade, eta.into()) };
    // A coat that is there, but in which nothing is lost; as many reflections in it as there may be.
    let params = Params::new().float("eta", eta).float("thickness", 0.0).int("maxdepth", 1000);
    let params = with_shade(params, "reflectance", shade, at);
    if object.plugin == "pplastic" {
        world.once(object.at, "pplastic: light is not polarised here".to_owned());
    }
    Some((
        "coateddiffuse",
        if object.plugin == "plastic" { params } else { roughness(world, object, params) },
    ))
}

/// What the body must reflect so that our formula gives Mitsuba's linear one.
fn linear(world: &mut World<'_>, object: &Object, shade: Shade, eta: f64) -> Shade {
    let inside = diffuse_reflectance(1.0 / eta) as f32;
    let of = |r: f32| r / (1.0 - inside + r * inside);
    match (even(&shade), shade) {
        (Some(rgb), _) => Shade::Rgb(rgb.map(of)),
        (None, Shade::Curve(curve)) if Sampled::new(&curve).is_ok() => Shade::Curve(
            curve.iter().enumerate().map(|(i, v)| if i % 2 == 1 { of(*v) } else { *v }).collect(),
        ),
        (None, shade) => {
            let message =
                format!("{}: with a texture it reflects as if \"nonlinear\" were true", object.plugin);
            world.once(object.at, message);
            shade
        }
    }
}

/// The share of diffuse light that a smooth interface reflects, from the side on which the index of the other side is `eta`
/// times as large: `2 integral of F(c) c dc`.
fn diffuse_reflectance(eta: f64) -> f64 {
    const STEPS: u32 = 4096;
    let sum: f64 =
        (0..STEPS).map(|i| (f64::from(i) + 0.5) / f64::from(STEPS)).map(|c| fresnel(c, eta) * c).sum();
    2.0 * sum / f64::from(STEPS)
}

fn fresnel(cos: f64, eta: f64) -> f64 {
    let squared = 1.0 - (1.0 - cos * cos) / (eta * eta);
    if squared <= 0.0 {
        return 1.0;
    }
    let inside = squared.sqrt();
    let s = (cos - eta * inside) / (cos + eta * inside);
    let p = (eta * cos - inside) / (eta * cos + inside);
    0.5 * (s * s + p * p)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coats_reflect_diffuse_light_as_is_known() {
        // Egan and Hilgeman 1973: n = 1.5 reflects 0.596 from inside and 0.092 from outside.
        assert!((diffuse_reflectance(1.0 / 1.5) - 0.5963).abs() < 1e-3);
        assert!((diffuse_reflectance(1.5) - 0.0918).abs() < 1e-3);
        // What comes out from inside is what came in, by the square of the index.
        let (inside, outside) = (diffuse_reflectance(1.0 / 1.9), diffuse_reflectance(1.9));
        assert!(((1.0 - inside) * 1.9 * 1.9 - (1.0 - outside)).abs() < 1e-3);
    }
}
