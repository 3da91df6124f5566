//! Plastic: a matte body under a dielectric coat.
//!
//! Mitsuba's body sends `T(wi) T(wo) r / (pi eta² (1 - r F))`, with the share `F` of diffuse light that the coat reflects back
//! from inside, where `nonlinear`; else `1 - F` stands in place of `1 - r F`. Ours is the first. It gives the second, too,
//! for a body that reflects `r' = r / (1 - F + r F)`, with the `F` of rough coats: GGX, each microfacet once.
use durer_core::{glam::DVec3, spectrum::Sampled};
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
    let alpha = if object.plugin == "plastic" { 0.0 } else { object.number_or("alpha", 0.1, world.said) };
    let inside = diffuse_reflectance(1.0 / eta, alpha.clamp(0.0, 1.0)) as f32;
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

/// The share of diffuse light that an interface reflects, from the side on which the index of the other side is `eta` times as
/// large: `2 integral of R(c) c dc`. `R` is Fresnel's where it is smooth, else the mean over the normals that are seen of
/// `F(w . m) G1(w')`, with the mirrored direction `w'` (Heitz 2018, "Sampling the GGX Distribution of Visible Normals").
fn diffuse_reflectance(eta: f64, alpha: f64) -> f64 {
    let steps = if alpha > 0.0 { 64 } else { 4096 };
    let middle = |i: u32, n: u32| (f64::from(i) + 0.5) / f64::from(n);
    let of = |c: f64| if alpha > 0.0 { rough(c, eta, alpha) } else { fresnel(c, eta) };
    let sum: f64 = (0..steps).map(|i| middle(i, steps)).map(|c| of(c) * c).sum();
    2.0 * sum / f64::from(steps)
}

/// `R` of microfacets seen along this cosine.
fn rough(cos: f64, eta: f64, alpha: f64) -> f64 {
    const SIDE: u32 = 24;
    let w = DVec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
    let stretched = DVec3::new(alpha * w.x, 0.0, w.z).normalize();
    let (x, y) = (DVec3::new(stretched.z, 0.0, -stretched.x), DVec3::Y);
    let mut sum = 0.0;
    for (i, j) in (0..SIDE).flat_map(|i| (0..SIDE).map(move |j| (i, j))) {
        let [u, v] = [i, j].map(|k| (f64::from(k) + 0.5) / f64::from(SIDE));
        let (r, (sin, cos)) = (u.sqrt(), (std::f64::consts::TAU * v).sin_cos());
        let t1 = r * cos;
        let s = 0.5 * (1.0 + stretched.z);
        let t2 = (1.0 - s) * (1.0 - t1 * t1).max(0.0).sqrt() + s * r * sin;
        let n = x * -t2 + y * t1 + stretched * (1.0 - t1 * t1 - t2 * t2).max(0.0).sqrt();
        let m = DVec3::new(alpha * n.x, alpha * n.y, n.z.max(0.0)).normalize_or(DVec3::Z);
        let mirrored = m * (2.0 * w.dot(m)) - w;
        if mirrored.z > 0.0 {
            let tan = (1.0 - mirrored.z * mirrored.z).max(0.0).sqrt() / mirrored.z;
            let shadow = 2.0 / (1.0 + (1.0 + (alpha * tan).powi(2)).sqrt());
            sum += fresnel(w.dot(m).clamp(0.0, 1.0), eta) * shadow;
        }
    }
    sum / f64::from(SIDE * SIDE)
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
        assert!((diffuse_reflectance(1.0 / 1.5, 0.0) - 0.5963).abs() < 1e-3);
        assert!((diffuse_reflectance(1.5, 0.0) - 0.0918).abs() < 1e-3);
        // What comes out from inside is what came in, by the square of the index.
        let (inside, outside) = (diffuse_reflectance(1.0 / 1.9, 0.0), diffuse_reflectance(1.9, 0.0));
        assert!(((1.0 - inside) * 1.9 * 1.9 - (1.0 - outside)).abs() < 1e-3);
        // Rough ones go over into smooth ones, and lose light that is shadowed.
        assert!((diffuse_reflectance(1.0 / 1.5, 1e-3) - diffuse_reflectance(1.0 / 1.5, 0.0)).abs() < 5e-3);
        assert!(diffuse_reflectance(1.0 / 1.5, 1.0) < 0.9 * diffuse_reflectance(1.0 / 1.5, 0.0));
    }
}
