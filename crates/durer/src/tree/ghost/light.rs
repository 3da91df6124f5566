//! Where lights are: found by asking them for light at some places, as surfaces do.
use serde::{Deserialize, Serialize};

use crate::{
    Scene,
    math::{Bounds3, Point2, Point3},
    model::light::LightCx,
    sampling::{Sampler, SamplerKind},
    spectrum::Basis,
    tree::number::{Metres, Number, Place, Rgb, rgb},
};

/// Places where a light is asked for: spots shine on few.
const PLACES: u32 = 512;

/// A light.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct GhostLight {
    /// Its index in the scene.
    pub index: u32,
    /// Its name.
    pub name: String,
    /// `point` (spots too), `distant`, `area` or `surroundings`.
    pub kind: String,
    /// Where it is; of one with extent some point of it.
    pub point: Option<Place>,
    /// Of a distant light: where its light goes.
    pub direction: Option<[Number; 3]>,
    /// The colour of its light; the largest channel is 1.
    pub color: Rgb,
}

/// All lights of a scene, at the time when its shutter opens.
pub(super) fn lights(scene: &Scene, bounds: &Bounds3) -> Vec<GhostLight> {
    (0..scene.lights.len()).map(|index| light(scene, index, bounds)).collect()
}

fn light(scene: &Scene, index: usize, bounds: &Bounds3) -> GhostLight {
    let light = &*scene.lights[index];
    let name = scene.light_names.get(index).cloned().unwrap_or_default();
    let known = GhostLight { index: index as u32, name, color: rgb([1.0; 3]), ..GhostLight::default() };
    if light.surrounds() {
        return GhostLight { kind: "surroundings".to_owned(), ..known };
    }
    let cx = LightCx { basis: Basis::Rgb, time: scene.view.shutter.interval().min };
    let middle = Sampler::middle();
    let sample = places(bounds).find_map(|p| light.sample(&cx, p, &middle));
    let Some(sample) = sample else {
        return GhostLight { kind: "area".to_owned(), ..known };
    };
    let world = scene.view.world_from_render;
    let point = sample.point.map(|p| (p.to_f64() + world).to_array().map(Metres));
    let kind = match (&point, sample.pdf) {
        (_, Some(_)) => "area",
        (Some(_), None) => "point",
        (None, None) => "distant",
    };
    let light = Basis::Rgb.to_rgb(sample.weight);
    let most = light.iter().copied().fold(f32::MIN_POSITIVE, f32::max);
    GhostLight {
        kind: kind.to_owned(),
        direction: point.is_none().then(|| (-sample.wi).to_array().map(Number)),
        point,
        color: rgb(light.map(|v| v / most)),
        ..known
    }
}

/// The middle of the scene, then places spread over its box and a little beyond.
fn places(bounds: &Bounds3) -> impl Iterator<Item = Point3> + use<> {
    let (middle, size) = match bounds.is_empty() {
        true => (Point3::ZERO, [1.0; 3]),
        false => (bounds.center(), bounds.diagonal().to_array()),
    };
    let around = (0..PLACES).map(move |i| {
        let sampler = Sampler::new(SamplerKind::Sobol, 0, [0, 0], i, PLACES);
        let (Point2 { x, y }, z) =
            (sampler.d2(crate::sampling::Dim::Pixel), sampler.d1(crate::sampling::Dim::Time));
        let [x, y, z] = [(x, size[0]), (y, size[1]), (z, size[2])].map(|(u, size)| (u - 0.5) * 1.1 * size);
        Point3::new(middle.x + x, middle.y + y, middle.z + z)
    });
    std::iter::once(middle).chain(around)
}
