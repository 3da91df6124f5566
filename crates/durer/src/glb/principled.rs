//! `principled` in glTF's words: metal and roughness with the extensions that the reader knows.
use durer_scene::{Args, Node};
use serde_json::{Map, json};

use super::{
    Writer,
    material::{Made, Number},
};

impl Writer<'_> {
    pub(super) fn principled(&mut self, made: &mut Made, args: &mut Args<'_>, node: &Node, owner: &str) {
        made.other.insert("doubleSided".to_owned(), (!args.bool("onesided")).into());
        self.color_to(&mut made.pbr, "baseColor", args, node, ("basecolor", owner));
        self.alpha(made, args, node, owner);
        if args.bool("unlit") {
            made.extensions.insert("KHR_materials_unlit".to_owned(), json!({}));
            return;
        }
        let (metallic, roughness) =
            (self.number(args, node, "metallic", owner), self.number(args, node, "roughness", owner));
        self.metal_and_roughness(made, metallic, roughness, owner);
        if args.is_set("emission") {
            let mut emission = Map::new();
            self.color_to(&mut emission, "emissive", args, node, ("emission", owner));
            let factor: [f32; 3] = emission
                .get("emissiveFactor")
                .and_then(|f| serde_json::from_value(f.clone()).ok())
                .unwrap_or([1.0; 3]);
            self.emission(made, factor, args.float("emissionstrength"));
            if let Some(info) = emission.remove("emissiveTexture") {
                made.other.insert("emissiveTexture".to_owned(), info);
            }
        }
        if let Some(mut info) = self.directions(args, node, "normal", owner) {
            info["scale"] = args.float("normalscale").into();
            made.other.insert("normalTexture".to_owned(), info);
        }
        if args.is_set("eta") {
            made.extend("KHR_materials_ior", "ior", args.float("eta").into());
        }
        self.layers(made, args, node, owner);
        if args.is_set("thickness") {
            let volume = "KHR_materials_volume";
            made.extend(volume, "thicknessFactor", args.float("thickness").into());
            made.extend(volume, "attenuationColor", json!(args.color("attenuationcolor").rgb));
            if let Some(distance) = args.optional_float("attenuationdistance") {
                made.extend(volume, "attenuationDistance", distance.into());
            }
            if args.is_set("dispersion") {
                made.extend("KHR_materials_dispersion", "dispersion", args.float("dispersion").into());
            }
        }
        if args.bool("energycompensation") {
            self.warn(format!("{owner}: energy compensation is not in the file"));
        }
    }

    /// Extensions, as the reader reads them.
    fn layers(&mut self, made: &mut Made, args: &mut Args<'_>, node: &Node, owner: &str) {
        // Parameter, extension, key, channel of its texture.
        const SHARES: [(&str, &str, &str, usize); 9] = [
            ("transmission", "KHR_materials_transmission", "transmission", 0),
            ("specular", "KHR_materials_specular", "specular", 3),
            ("clearcoat", "KHR_materials_clearcoat", "clearcoat", 0),
            ("clearcoatroughness", "KHR_materials_clearcoat", "clearcoatRoughness", 1),
            ("sheenroughness", "KHR_materials_sheen", "sheenRoughness", 3),
            ("anisotropy", "KHR_materials_anisotropy", "anisotropy", 2),
            ("iridescence", "KHR_materials_iridescence", "iridescence", 0),
            ("iridescencethickness", "KHR_materials_iridescence", "iridescenceThickness", 1),
            ("diffusetransmission", "KHR_materials_diffuse_transmission", "diffuseTransmission", 3),
        ];
        for (param, extension, key, channel) in SHARES.into_iter().filter(|s| args.is_set(s.0)) {
            let number = self.number(args, node, param, owner);
            let (factor, info) = self.share(number, channel, owner);
            let word = match key {
                "anisotropy" => "anisotropyStrength".to_owned(),
                "iridescenceThickness" => "iridescenceThicknessMaximum".to_owned(),
                key => format!("{key}Factor"),
            };
            made.extend(extension, &word, factor.into());
            if key == "iridescenceThickness" {
                // What is read as 0 to the most.
                made.extend(
                    extension,
                    "iridescenceThicknessMinimum",
                    if info.is_some() { 0.0.into() } else { factor.into() },
                );
            }
            if let Some(info) = info {
                made.extend(extension, &format!("{key}Texture"), info);
            }
        }
        const COLORS: [(&str, &str, &str); 3] = [
            ("specularcolor", "KHR_materials_specular", "specularColor"),
            ("sheencolor", "KHR_materials_sheen", "sheenColor"),
            ("diffusetransmissioncolor", "KHR_materials_diffuse_transmission", "diffuseTransmissionColor"),
        ];
        for (param, extension, key) in COLORS {
            if !args.is_set(param) {
                continue;
            }
            let mut color = Map::new();
            self.color_to(&mut color, key, args, node, (param, owner));
            color.into_iter().for_each(|(key, value)| made.extend(extension, &key, value));
        }
        if let Some(mut info) = self.directions(args, node, "clearcoatnormal", owner) {
            info["scale"] = args.float("clearcoatnormalscale").into();
            made.extend("KHR_materials_clearcoat", "clearcoatNormalTexture", info);
        }
        if args.is_set("anisotropyrotation") {
            made.extend(
                "KHR_materials_anisotropy",
                "anisotropyRotation",
                args.float("anisotropyrotation").into(),
            );
        }
        if let Some(info) = self.directions(args, node, "anisotropydirection", owner) {
            made.extend("KHR_materials_anisotropy", "anisotropyTexture", info);
        }
        if args.is_set("iridescenceeta") {
            made.extend("KHR_materials_iridescence", "iridescenceIor", args.float("iridescenceeta").into());
        }
    }

    fn alpha(&mut self, made: &mut Made, args: &mut Args<'_>, node: &Node, owner: &str) {
        let mode = args.text("alphamode");
        if mode == "opaque" {
            return;
        }
        made.other.insert("alphaMode".to_owned(), mode.to_uppercase().into());
        if mode == "mask" {
            made.other.insert("alphaCutoff".to_owned(), args.float("alphacutoff").into());
        }
        let alpha = match self.number(args, node, "alpha", owner) {
            Number::Flat(alpha) => alpha,
            Number::Map(map) => {
                // glTF's alpha is that of the base colour's picture.
                let info = self.number_info([None, None, None, Some(&map)]);
                match (made.pbr.get("baseColorTexture"), &info) {
                    (Some(color), Some(alpha)) if color["index"] != alpha["index"] => {
                        self.warn(format!(
                            "{owner}: alpha of another picture than the colour's is not in the file"
                        ));
                    }
                    (None, Some(alpha)) => {
                        let alpha = alpha.clone();
                        made.pbr.insert("baseColorTexture".to_owned(), alpha);
                    }
                    _ => {}
                }
                map.factor[0]
            }
        };
        let color: [f32; 3] = made
            .pbr
            .get("baseColorFactor")
            .and_then(|f| f.as_array().map(|f| std::array::from_fn(|i| f[i].as_f64().unwrap_or(1.0) as f32)))
            .unwrap_or([1.0; 3]);
        let [r, g, b] = color;
        made.pbr.insert("baseColorFactor".to_owned(), json!([r, g, b, alpha]));
    }

    fn metal_and_roughness(&mut self, made: &mut Made, metallic: Number, roughness: Number, owner: &str) {
        let maps = match (&metallic, &roughness) {
            (Number::Flat(_), Number::Flat(_)) => None,
            (Number::Map(m), Number::Map(r)) => Some([None, Some(&**r), Some(&**m), None]),
            (Number::Flat(_), Number::Map(r)) => Some([None, Some(&**r), None, None]),
            (Number::Map(m), Number::Flat(_)) => Some([None, None, Some(&**m), None]),
        };
        let factor = |number: &Number| match number {
            Number::Flat(v) => *v,
            Number::Map(map) => map.factor[0],
        };
        made.pbr("metallicFactor", factor(&metallic));
        made.pbr("roughnessFactor", factor(&roughness));
        let Some(maps) = maps else { return };
        // A picture that is taken as it is has something in the other number's channel, too.
        let info = match (&metallic, &roughness) {
            (Number::Flat(other), Number::Map(_)) | (Number::Map(_), Number::Flat(other))
                if *other != 0.0 =>
            {
                self.number_copy(maps)
            }
            _ => self.number_info(maps),
        };
        match info {
            Some(info) => {
                made.pbr.insert("metallicRoughnessTexture".to_owned(), info);
            }
            None => self.warn(format!(
                "{owner}: pictures of metal and roughness that differ in size are not in the file"
            )),
        }
    }
}
