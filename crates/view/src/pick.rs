//! What is seen in the middle of a pixel: which object, of what, how far away.
use durer::{Prepared, SampleCx, math::Point2, model::camera::Lens, probe::NoProbe, spectrum::Basis};
use serde_json::{Value, json};

use crate::form::FormId;

/// What the page is told; `None` if the pixel lies outside the picture.
pub(crate) fn seen(prepared: &Prepared, [x, y]: [u32; 2]) -> Option<Value> {
    let scene = &prepared.scene;
    let view = &scene.view;
    if x >= view.width || y >= view.height {
        return None;
    }
    let time = view.shutter.moment(0.5, y, view.height);
    let ray = view.ray(Point2::new(x as f32 + 0.5, y as f32 + 0.5), Lens::CENTRE, time);
    let cx = SampleCx { scene, basis: Basis::Rgb };
    let Some(hit) = scene.closest(&cx, &ray, &mut NoProbe, ()) else {
        let nothing = json!({
            "type": "pick", "pixel": [x, y], "object": null, "index": null, "material": null, "form": null, "light": null,
            "t": null, "depth": null, "point": null, "normal": null, "uv": null, "primitive": null,
        });
        return Some(nothing);
    };
    let (id, surface) = scene.surface(&ray, &hit);
    let (object, primitive) = (scene.object(id), scene.resolve(&hit).1);
    let described = (object.material as usize) < prepared.material_names.len();
    Some(json!({
        "type": "pick",
        "pixel": [x, y],
        "object": object.name,
        "index": id.index(),
        "material": prepared.material_name(object.material),
        "form": described.then(|| FormId::Material(object.material as usize).to_string()),
        "light": object.light.map(|_| id.index()),
        "t": hit.t,
        "depth": hit.t * view.cos_to_axis(ray.d, time),
        "point": view.to_world(surface.p),
        "normal": surface.n_s.to_array(),
        "uv": [surface.uv.x, surface.uv.y],
        "primitive": primitive,
    }))
}
