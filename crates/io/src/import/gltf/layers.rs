//! Extensions of the material: coats, fibres, films, brushes, and what fills a body.
use super::{
    element::{Checked, Element},
    material::Builder,
};

const POSITIVE: [f64; 2] = [0.0, f32::MAX as f64];

impl<'a> Builder<'_, '_, 'a> {
    /// What lies on the surface, or tints and turns its reflection.
    pub(super) fn layers(&mut self, material: &Element<'a>) -> Checked<()> {
        if let Some(own) = material.extension("KHR_materials_specular")? {
            self.share(&own, "specular", ("specularFactor", 1.0), ("specularTexture", "a"))?;
            self.tint(&own, "specularcolor", ("specularColorFactor", [1.0; 3]), "specularColorTexture")?;
        }
        if let Some(own) = material.extension("KHR_materials_clearcoat")? {
            self.share(&own, "clearcoat", ("clearcoatFactor", 0.0), ("clearcoatTexture", "r"))?;
            let texture = ("clearcoatRoughnessTexture", "g");
            self.share(&own, "clearcoatroughness", ("clearcoatRoughnessFactor", 0.0), texture)?;
            if let Some(map) = own.get("clearcoatNormalTexture")? {
                self.direction("clearcoatnormal", &map)?;
                let scale = map.number_or("scale", 1.0)?;
                if scale != 1.0 {
                    self.put(|p| p.float("clearcoatnormalscale", scale as f32));
                }
            }
        }
        if let Some(own) = material.extension("KHR_materials_sheen")? {
            self.tint(&own, "sheencolor", ("sheenColorFactor", [0.0; 3]), "sheenColorTexture")?;
            let texture = ("sheenRoughnessTexture", "a");
            self.share(&own, "sheenroughness", ("sheenRoughnessFactor", 0.0), texture)?;
        }
        if let Some(own) = material.extension("KHR_materials_anisotropy")? {
            self.share(&own, "anisotropy", ("anisotropyStrength", 0.0), ("anisotropyTexture", "b"))?;
            if let Some(map) = own.get("anisotropyTexture")? {
                self.direction("anisotropydirection", &map)?;
            }
            let rotation = own.number_or("anisotropyRotation", 0.0)?;
            self.put(|p| p.float("anisotropyrotation", rotation as f32));
        }
        if let Some(own) = material.extension("KHR_materials_iridescence")? {
            self.share(&own, "iridescence", ("iridescenceFactor", 0.0), ("iridescenceTexture", "r"))?;
            let eta = self.ranged(Some(&own), "iridescenceIor", 1.3, [1.0, 10.0])?;
            let [least, most] =
                [("iridescenceThicknessMinimum", 100.0), ("iridescenceThicknessMaximum", 400.0)]
                    .map(|(key, default)| self.ranged(Some(&own), key, default, [0.0, 1e6]));
            let (least, most) = (least?, most?);
            if let Some(map) = own.get("iridescenceThicknessTexture")?
                && least > 0.0
            {
                let message =
                    format!("the film's thickness is read as 0 to {most} nm, not from {least} nm on");
                self.document.warn(&map, message);
            }
            self.put(|p| p.float("iridescenceeta", eta as f32));
            self.float("iridescencethickness", own.get("iridescenceThicknessTexture")?, "g", most)?;
        }
        Ok(())
    }

    /// What shines through, and what fills the body.
    pub(super) fn body(&mut self, material: &Element<'a>) -> Checked<()> {
        if let Some(own) = material.extension("KHR_materials_diffuse_transmission")? {
            let factor = self.ranged(Some(&own), "diffuseTransmissionFactor", 0.0, [0.0, 1.0])?;
            if factor > 0.0 {
                self.float("diffusetransmission", own.get("diffuseTransmissionTexture")?, "a", factor)?;
                let key = ("diffuseTransmissionColorFactor", [1.0; 3]);
                self.tint(&own, "diffusetransmissioncolor", key, "diffuseTransmissionColorTexture")?;
            }
        }
        if let Some(own) = material.extension("KHR_materials_volume")? {
            let thickness = self.ranged(Some(&own), "thicknessFactor", 0.0, POSITIVE)?;
            let color = own.numbers_or("attenuationColor", [1.0; 3])?.map(|c: f64| c.clamp(0.0, 1.0) as f32);
            self.put(|p| p.float("thickness", thickness as f32).rgb("attenuationcolor", color));
            if own.get("attenuationDistance")?.is_some() {
                let distance = self.ranged(Some(&own), "attenuationDistance", 1.0, POSITIVE)?;
                self.put(|p| p.float("attenuationdistance", distance as f32));
            }
            if let Some(own) = material.extension("KHR_materials_dispersion")? {
                let dispersion = self.ranged(Some(&own), "dispersion", 0.0, POSITIVE)?;
                self.put(|p| p.float("dispersion", dispersion as f32));
            }
        }
        Ok(())
    }

    /// A share in `[0, 1]`: factor times a channel of a texture.
    fn share(
        &mut self,
        own: &Element<'a>,
        name: &str,
        (key, default): (&str, f64),
        (texture, channel): (&str, &'static str),
    ) -> Checked<()> {
        let factor = self.ranged(Some(own), key, default, [0.0, 1.0])?;
        self.float(name, own.get(texture)?, channel, factor)
    }

    /// A colour: factor times a texture.
    fn tint(
        &mut self,
        own: &Element<'a>,
        name: &str,
        (key, default): (&str, [f64; 3]),
        texture: &str,
    ) -> Checked<()> {
        let factor = own.numbers_or(key, default)?.map(|c: f64| c.max(0.0));
        let factor = if name == "specularcolor" { factor } else { factor.map(|c| c.min(1.0)) };
        self.color(name, own.get(texture)?, factor)
    }
}
