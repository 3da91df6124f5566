//! Materials: `principled` with the extensions that the reader knows; other kinds as the nearest thing to them.
use std::{collections::HashMap, sync::Arc};

use durer_model::{light::AREA_LIGHTS, material::MATERIALS};
use durer_scene::{Args, Data, Diagnostics, Node, ShapeDesc, TextureValue, ValueType, find};
use serde_json::{Map, Value, json};

use super::{Writer, texture::Mapped};

/// Materials by number and light.
pub(super) type Known = HashMap<(Option<usize>, Option<*const Node>), Option<usize>>;

/// A number, or a picture of it.
#[derive(Clone, Debug)]
enum Number {
    Flat(f32),
    Map(Box<Mapped>),
}

/// A material in the making.
#[derive(Default)]
struct Made {
    pbr: Map<String, Value>,
    extensions: Map<String, Value>,
    other: Map<String, Value>,
}

impl Writer<'_> {
    /// The number of a shape's material with the light that it sends out; `None` if it has neither.
    pub(super) fn material_of(&mut self, shape: &ShapeDesc, called: &str) -> Option<usize> {
        let light = shape.area_light.as_ref();
        let key = (shape.material.map(|m| m.index()), light.map(Arc::as_ptr));
        if let Some(known) = self.memo.materials.get(&key) {
            return *known;
        }
        let number = self.made(shape, called);
        self.memo.materials.insert(key, number);
        number
    }

    fn made(&mut self, shape: &ShapeDesc, called: &str) -> Option<usize> {
        let named = shape.material.and_then(|m| self.desc.materials.get(m.index()));
        if named.is_none() && shape.area_light.is_none() {
            return None;
        }
        let mut made = Made::default();
        let mut name = called.to_owned();
        if let Some(named) = named {
            if !named.name.is_empty() {
                name.clone_from(&named.name);
            }
            self.node_material(&mut made, &named.node, &format!("material \"{name}\""));
        } else {
            made.matte([0.5; 3]);
        }
        if let Some(light) = &shape.area_light {
            self.emits(&mut made, light, called);
        }
        let mut material = made.other;
        material.insert("name".to_owned(), name.into());
        material.insert("pbrMetallicRoughness".to_owned(), made.pbr.into());
        if !made.extensions.is_empty() {
            for used in made.extensions.keys() {
                self.extensions.extend(EXTENSIONS.iter().find(|known| *known == used));
            }
            material.insert("extensions".to_owned(), made.extensions.into());
        }
        self.materials.push(material.into());
        Some(self.materials.len() - 1)
    }

    fn node_material(&mut self, made: &mut Made, node: &Node, owner: &str) {
        let mut said = Diagnostics::default();
        let Some(entry) = find(MATERIALS, "material", node, &mut said) else { return made.matte([0.5; 3]) };
        let mut args = Args::check(node, entry.schema, &self.desc.textures, &mut said)
            .with_assets(self.whole.assets, durer_scene::Missing::Warn);
        let kind = entry.schema.name;
        if kind != "principled" {
            made.other.insert("doubleSided".to_owned(), true.into());
        }
        match kind {
            "principled" => self.principled(made, &mut args, node, owner),
            "diffuse" => {
                made.matte([1.0; 3]);
                if args.float_input("sigma") != durer_scene::FloatInput::Constant(0.0) {
                    self.warn(format!("{owner}: its roughness as of clay is not in the file"));
                }
                self.color_to(&mut made.pbr, "baseColor", &mut args, node, ("reflectance", owner));
            }
            "coateddiffuse" => {
                self.warn(format!("{owner}: the layers of \"{kind}\" become one surface under a gloss"));
                made.pbr("metallicFactor", 0.0);
                self.rough(made, &args, owner);
                self.color_to(&mut made.pbr, "baseColor", &mut args, node, ("reflectance", owner));
                made.extend("KHR_materials_ior", "ior", args.index("eta").into());
            }
            "dielectric" | "thindielectric" => {
                made.pbr("metallicFactor", 0.0);
                if kind == "dielectric" {
                    self.rough(made, &args, owner);
                    made.extend("KHR_materials_volume", "thicknessFactor", 1.0.into());
                } else {
                    made.pbr("roughnessFactor", 0.0);
                }
                made.extend("KHR_materials_ior", "ior", args.index("eta").into());
                made.extend("KHR_materials_transmission", "transmissionFactor", 1.0.into());
            }
            "conductor" | "coatedconductor" | "mirror" => {
                made.pbr("metallicFactor", 1.0);
                if kind == "mirror" {
                    made.pbr("roughnessFactor", 0.0);
                } else {
                    self.rough(made, &args, owner);
                }
                if kind == "mirror" || args.is_set("reflectance") {
                    self.color_to(&mut made.pbr, "baseColor", &mut args, node, ("reflectance", owner));
                } else {
                    let (eta, k) = (args.color("eta").rgb, args.color("k").rgb);
                    // At normal incidence; the rise towards grazing angles is Schlick's in glTF.
                    let seen: [f32; 3] = std::array::from_fn(|i| {
                        let (n, k) = (eta[i], k[i] * k[i]);
                        ((n - 1.0).powi(2) + k) / ((n + 1.0).powi(2) + k)
                    });
                    self.warn(format!(
                        "{owner}: the curves of a metal become its colour at normal incidence"
                    ));
                    made.base(seen);
                }
                if kind == "coatedconductor" {
                    self.warn(format!("{owner}: the layers of \"{kind}\" become a metal without coat"));
                }
            }
            "phong" | "classic" => {
                self.warn(format!(
                    "{owner}: \"{kind}\" becomes a matte colour: highlights and mirrors are not in the file"
                ));
                made.matte([1.0; 3]);
                self.color_to(&mut made.pbr, "baseColor", &mut args, node, ("diffuse", owner));
            }
            other => {
                self.warn(format!("{owner}: \"{other}\" becomes grey, as glTF has none such"));
                made.matte([0.5; 3]);
            }
        }
    }

    /// Roughness in pbrt's words: the GGX width is its square root, glTF's is the square of its own.
    fn rough(&mut self, made: &mut Made, args: &Args<'_>, owner: &str) {
        let of = |name: &str| match args.is_set(name) {
            true => args.float(name),
            false => args.float("roughness"),
        };
        let is_textured = args.is_set("uroughness") || args.is_set("vroughness");
        if is_textured {
            self.warn(format!("{owner}: roughness that differs along u and v becomes its mean"));
        }
        let mean = 0.5 * (of("uroughness") + of("vroughness"));
        let width = if args.bool("remaproughness") { mean.max(0.0).sqrt() } else { mean };
        made.pbr("roughnessFactor", width.max(0.0).sqrt().min(1.0));
    }

    /// Area lights become light of the material.
    fn emits(&mut self, made: &mut Made, light: &Node, called: &str) {
        let mut said = Diagnostics::default();
        let Some(entry) = find(AREA_LIGHTS, "area light", light, &mut said) else { return };
        let mut args = Args::check(light, entry.schema, &self.desc.textures, &mut said);
        if args.is_set("power") || args.is_set("filename") {
            self.warn(format!("\"{called}\": \"power\" and \"filename\" of its light are not in the file"));
        }
        if !args.bool("twosided") {
            self.warn(format!("\"{called}\" shines from both sides in the file"));
        }
        let scale = args.float("scale");
        let rgb = args.color("L").rgb.map(|v| v * scale);
        self.emission(made, rgb, 1.0);
    }

    /// Factors go to 1 in glTF, the rest is strength.
    fn emission(&mut self, made: &mut Made, rgb: [f32; 3], strength: f32) {
        let most = rgb.into_iter().fold(1.0f32, f32::max);
        made.other.insert("emissiveFactor".to_owned(), json!(rgb.map(|v| (v / most).max(0.0))));
        if most * strength != 1.0 {
            made.extend("KHR_materials_emissive_strength", "emissiveStrength", (most * strength).into());
        }
    }

    fn principled(&mut self, made: &mut Made, args: &mut Args<'_>, node: &Node, owner: &str) {
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

    /// A float parameter.
    fn number(&mut self, args: &Args<'_>, node: &Node, name: &str, owner: &str) -> Number {
        match textured(node, name) {
            None => Number::Flat(args.float(name)),
            Some(texture) => match self.mapped(&texture, TextureValue::Float, owner) {
                Ok(map) => Number::Map(Box::new(map)),
                Err([v, ..]) => Number::Flat(v),
            },
        }
    }

    /// A factor, and the texture in one channel.
    fn share(&mut self, number: Number, channel: usize, owner: &str) -> (f32, Option<Value>) {
        match number {
            Number::Flat(v) => (v, None),
            Number::Map(map) => {
                let mut maps = [None; 4];
                maps[channel] = Some(&*map);
                let info = self.number_info(maps);
                if info.is_none() {
                    self.warn(format!("{owner}: a picture is not in the file"));
                }
                (map.factor[0], info)
            }
        }
    }

    /// A colour parameter as `keyFactor` and `keyTexture`.
    fn color_to(
        &mut self,
        to: &mut Map<String, Value>,
        key: &str,
        args: &mut Args<'_>,
        node: &Node,
        (name, owner): (&str, &str),
    ) {
        let flat = match textured(node, name) {
            None => args.color(name).rgb,
            Some(texture) => match self.mapped(&texture, TextureValue::Color, owner) {
                Ok(map) => {
                    if let Some(info) = self.color_info(&map, true) {
                        to.insert(format!("{key}Texture"), info);
                    }
                    map.factor
                }
                Err(flat) => flat,
            },
        };
        let factor = if key == "baseColor" {
            if flat.iter().any(|v| *v > 1.0) {
                self.warn(format!("{owner}: a colour above 1 is cut off"));
            }
            let [r, g, b] = flat.map(|v| v.clamp(0.0, 1.0));
            json!([r, g, b, 1.0])
        } else {
            json!(flat)
        };
        to.insert(format!("{key}Factor"), factor);
    }

    /// The textureInfo of a parameter that holds directions.
    fn directions(&mut self, args: &Args<'_>, node: &Node, name: &str, owner: &str) -> Option<Value> {
        let texture = textured(node, name).filter(|_| args.is_set(name))?;
        let map = self.mapped(&texture, TextureValue::Color, owner).ok()?;
        self.color_info(&map, false)
    }
}

/// The texture that a parameter refers to.
fn textured(node: &Node, name: &str) -> Option<String> {
    let param = node.params.get(name).filter(|p| p.ty == ValueType::Texture)?;
    match &param.data {
        Data::Strings(names) => names.first().cloned(),
        _ => None,
    }
}

/// Those that materials use.
const EXTENSIONS: [&str; 12] = [
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
];

impl Made {
    fn pbr(&mut self, key: &str, value: f32) {
        self.pbr.insert(key.to_owned(), value.into());
    }

    fn base(&mut self, [r, g, b]: [f32; 3]) {
        self.pbr.insert("baseColorFactor".to_owned(), json!([r, g, b, 1.0]));
    }

    /// A surface without gloss.
    fn matte(&mut self, color: [f32; 3]) {
        self.pbr("metallicFactor", 0.0);
        self.pbr("roughnessFactor", 1.0);
        self.base(color);
        self.extend("KHR_materials_specular", "specularFactor", 0.0.into());
    }

    fn extend(&mut self, extension: &str, key: &str, value: Value) {
        let own = self.extensions.entry(extension.to_owned()).or_insert_with(|| json!({}));
        own[key] = value;
    }
}
