//! Materials: `principled` with the extensions that the reader knows; other kinds as the nearest thing to them.
use std::{collections::HashMap, sync::Arc};

use durer_core::spectrum::abbe_number;
use durer_model::{Medium, light::AREA_LIGHTS, material::MATERIALS};
use durer_scene::{Args, Data, Diagnostics, Node, Param, Params, ShapeDesc, TextureValue, ValueType, find};
use serde_json::{Map, Value, json};

use super::{Writer, texture::Mapped};

/// Materials by number and light.
pub(super) type Known = HashMap<(Option<usize>, Option<*const Node>), Option<usize>>;

/// A number, or a picture of it.
#[derive(Clone, Debug)]
pub(super) enum Number {
    Flat(f32),
    Map(Box<Mapped>),
}

/// A material in the making.
#[derive(Default)]
pub(super) struct Made {
    pub(super) pbr: Map<String, Value>,
    pub(super) extensions: Map<String, Value>,
    pub(super) other: Map<String, Value>,
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
            self.extensions.extend(made.extensions.keys().cloned());
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
                    made.body(&mut args);
                } else {
                    made.pbr("roughnessFactor", 0.0);
                    made.extend("KHR_materials_ior", "ior", args.index("eta").into());
                }
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
            "phong" => {
                self.warn(format!(
                    "{owner}: \"phong\" becomes a matte colour: highlights are not in the file"
                ));
                made.matte([1.0; 3]);
                self.color_to(&mut made.pbr, "baseColor", &mut args, node, ("diffuse", owner));
            }
            "disney" => {
                self.warn(format!(
                    "{owner}: Disney's formulas become glTF's, without tints, sheen and flatness"
                ));
                self.node_material(made, &disney_as_principled(node), owner);
            }
            "classic" => self.classic(made, &mut args, node, owner),
            other => {
                self.warn(format!("{owner}: \"{other}\" becomes grey, as glTF has none such"));
                made.matte([0.5; 3]);
            }
        }
    }

    /// Whitted's terms: the strongest one says whether it is glass, a mirror, or matte.
    fn classic(&mut self, made: &mut Made, args: &mut Args<'_>, node: &Node, owner: &str) {
        let most = |args: &mut Args<'_>, name: &str| args.color(name).rgb.into_iter().fold(0.0f32, f32::max);
        let [diffuse, mirrored, through] =
            ["diffuse", "reflection", "transmission"].map(|name| most(args, name));
        let kind = if through > 0.0 && through >= diffuse.max(mirrored) {
            made.pbr("metallicFactor", 0.0);
            made.pbr("roughnessFactor", 0.0);
            made.base(args.color("transmission").rgb);
            made.extend("KHR_materials_transmission", "transmissionFactor", 1.0.into());
            made.body(args);
            "glass"
        } else if mirrored > diffuse {
            made.pbr("metallicFactor", 1.0);
            made.pbr("roughnessFactor", 0.0);
            made.base(args.color("reflection").rgb);
            "a mirror"
        } else {
            made.matte([1.0; 3]);
            self.color_to(&mut made.pbr, "baseColor", args, node, ("diffuse", owner));
            "a matte colour"
        };
        self.warn(format!("{owner}: \"classic\" becomes {kind}, the strongest of its terms"));
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
        if args.text("distribution") == "beckmann" {
            self.warn(format!("{owner}: Beckmann's distribution of microfacets becomes GGX"));
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
    pub(super) fn emission(&mut self, made: &mut Made, rgb: [f32; 3], strength: f32) {
        let most = rgb.into_iter().fold(1.0f32, f32::max);
        made.other.insert("emissiveFactor".to_owned(), json!(rgb.map(|v| (v / most).max(0.0))));
        if most * strength != 1.0 {
            made.extend("KHR_materials_emissive_strength", "emissiveStrength", (most * strength).into());
        }
    }

    /// A float parameter.
    pub(super) fn number(&mut self, args: &Args<'_>, node: &Node, name: &str, owner: &str) -> Number {
        match textured(node, name) {
            None => Number::Flat(args.float(name)),
            Some(texture) => match self.mapped(&texture, TextureValue::Float, owner) {
                Ok(map) => Number::Map(Box::new(map)),
                Err([v, ..]) => Number::Flat(v),
            },
        }
    }

    /// A factor, and the texture in one channel.
    pub(super) fn share(&mut self, number: Number, channel: usize, owner: &str) -> (f32, Option<Value>) {
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
    pub(super) fn color_to(
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
    pub(super) fn directions(
        &mut self,
        args: &Args<'_>,
        node: &Node,
        name: &str,
        owner: &str,
    ) -> Option<Value> {
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

impl Made {
    pub(super) fn pbr(&mut self, key: &str, value: f32) {
        self.pbr.insert(key.to_owned(), value.into());
    }

    pub(super) fn base(&mut self, [r, g, b]: [f32; 3]) {
        self.pbr.insert("baseColorFactor".to_owned(), json!([r, g, b, 1.0]));
    }

    /// A surface without gloss.
    pub(super) fn matte(&mut self, color: [f32; 3]) {
        self.pbr("metallicFactor", 0.0);
        self.pbr("roughnessFactor", 1.0);
        self.base(color);
        self.extend("KHR_materials_specular", "specularFactor", 0.0.into());
    }

    /// A body of glass, as it bends light; how that changes with wavelength is told by Abbe's number alone.
    fn body(&mut self, args: &mut Args<'_>) {
        let (eta, curve) = Medium::refraction(args);
        self.extend("KHR_materials_volume", "thicknessFactor", 1.0.into());
        self.extend("KHR_materials_ior", "ior", eta.max(1.0).into());
        let abbe = curve.map_or(f64::INFINITY, |curve| abbe_number(eta.into(), &curve));
        if abbe.is_finite() && abbe > 0.0 {
            self.extend("KHR_materials_dispersion", "dispersion", ((20.0 / abbe) as f32).into());
        }
    }

    pub(super) fn extend(&mut self, extension: &str, key: &str, value: Value) {
        let own = self.extensions.entry(extension.to_owned()).or_insert_with(|| json!({}));
        own[key] = value;
    }
}

/// What glTF's material has of Disney's.
fn disney_as_principled(node: &Node) -> Node {
    const SAME: [(&str, &str); 7] = [
        ("color", "basecolor"),
        ("roughness", "roughness"),
        ("metallic", "metallic"),
        ("anisotropic", "anisotropy"),
        ("spectrans", "transmission"),
        ("clearcoat", "clearcoat"),
        ("eta", "eta"),
    ];
    let color = Params::new().rgb("basecolor", [0.5; 3]);
    let color = if node.params.get("color").is_some() { Params::new() } else { color };
    let params = SAME.iter().filter_map(|(theirs, ours)| Some((node.params.get(theirs)?, ours))).fold(
        color,
        |mut params, (param, ours)| {
            params.push(Param { name: (*ours).to_owned(), ..param.clone() });
            params
        },
    );
    let thin = node.params.get("thin").is_some_and(|p| p.data == Data::Bools(vec![true]));
    let is_body = !thin && node.params.get("spectrans").is_some();
    let params = if is_body { params.float("thickness", 1.0) } else { params };
    Node { kind: "principled".to_owned(), params, ..node.clone() }
}
