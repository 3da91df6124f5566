//! Lights of KHR_lights_punctual: points, spots and parallel rays. Those that surround the scene have no place in glTF.
use durer_core::{
    glam::{DAffine3, DMat3, DVec3},
    math::Point3,
    sampling::{Sampler, SamplerKind},
    spectrum::Basis,
};
use durer_model::light::{LIGHTS, LightCx};
use durer_scene::{Args, Diagnostics, find};
use serde_json::json;

use super::Writer;

pub(super) const PUNCTUAL: &str = "KHR_lights_punctual";

impl Writer<'_> {
    pub(super) fn lights(&mut self) {
        let desc = self.desc;
        // Lights that were made up are made up again.
        let made_up = ["studio sky", "studio key"];
        if desc.lights.len() == 2 && desc.lights.iter().zip(made_up).all(|(light, name)| light.name == name) {
            return;
        }
        for index in 0..desc.lights.len() {
            self.light(index);
        }
        if self.lights.is_empty() {
            // Files without lights are lit by those who open them, also by durer: this one keeps them from it.
            self.lights.push(json!({ "type": "point", "name": "no light", "intensity": 0.0 }));
            self.node("no light", &DAffine3::IDENTITY, json!({ "extensions": { PUNCTUAL: { "light": 0 } } }));
        }
    }

    /// What a light does is asked of the light itself, a metre away on its axis: whatever says how strong it is.
    fn light(&mut self, index: usize) {
        let (desc, scene) = (self.desc, &self.whole.prepared.scene);
        let Some(light) = desc.lights.get(index) else { return };
        let name = if light.name.is_empty() { format!("light {index}") } else { light.name.clone() };
        let mut said = Diagnostics::default();
        let Some(entry) = find(LIGHTS, "light", &light.node, &mut said) else { return };
        let args = Args::check(&light.node, entry.schema, &desc.textures, &mut said);
        let kind = entry.schema.name;
        let ty = match kind {
            "point" => "point",
            "spot" => "spot",
            "distant" => "directional",
            other => {
                self.warn(format!("light \"{name}\" of kind \"{other}\" is left out: glTF has none such"));
                return;
            }
        };
        if kind != "distant" && args.text("falloff") == "none" {
            self.warn(format!("light \"{name}\" fades with the square of the distance in the file"));
        }
        if kind == "distant" && args.float("angle") != 0.0 {
            self.warn(format!("light \"{name}\" has no angle in the file: its shadows have hard edges"));
        }
        let place = self.placed(&light.world_from_light, &name);
        let triple = |param: &str| DVec3::from_array(args.triple(param).map(f64::from));
        let (from, to) = if kind == "point" {
            (triple("from"), triple("from") - DVec3::Z)
        } else {
            (triple("from"), triple("to"))
        };
        let (from, to) = (place.transform_point3(from), place.transform_point3(to));
        let axis = (to - from).normalize_or(-DVec3::Z);
        let Some(lamp) = scene.lights.get(index) else { return };
        // In the space of the compiled scene.
        let back = self.mirror;
        let at = back.transform_point3(from + axis) - scene.view.world_from_render;
        let cx = LightCx { basis: Basis::Rgb, time: self.whole.options.time };
        let sampler = Sampler::new(SamplerKind::default(), 0, [0, 0], 0, 1);
        let Some(sample) = lamp.sample(&cx, Point3::from_f64(at), &sampler) else { return };
        let light_of = Basis::Rgb.to_rgb(sample.weight).map(f64::from);
        let intensity = light_of.into_iter().fold(0.0, f64::max);
        if intensity <= 0.0 {
            return;
        }
        let mut written = json!({
            "type": ty, "name": name, "color": light_of.map(|v| (v / intensity).max(0.0)), "intensity": intensity,
        });
        if kind == "spot" {
            let outer = f64::from(args.float("coneangle")).to_radians();
            let inner = outer - f64::from(args.float("conedeltaangle")).to_radians();
            written["spot"] = json!({ "outerConeAngle": outer, "innerConeAngle": inner.max(0.0) });
        }
        self.lights.push(written);
        let number = self.lights.len() - 1;
        // They shine along -z.
        let z = -axis;
        let x = z.any_orthonormal_vector();
        let turned = DAffine3 { matrix3: DMat3::from_cols(x, z.cross(x), z), translation: from };
        let node = json!({ "extensions": { PUNCTUAL: { "light": number } } });
        self.node(&light.name, &turned, node);
    }
}
