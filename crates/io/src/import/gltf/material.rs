//! Materials: metallic-roughness with its extensions to the kind `principled`.
//!
//! Occlusion textures are ignored knowingly: rays find out what is hidden from what.
use durer_core::Id;
use durer_scene::{Data, LightDesc, MaterialRef, NamedNode, Node, Params, ValueType};

use super::{
    document::Document,
    element::{Checked, Element},
    texture::{Role, Textures, linear_part, uv_set},
};

/// What a primitive gets from its material.
pub(super) struct Look {
    /// The material.
    pub(super) material: Option<MaterialRef>,
    /// Numbers of the texture coordinates it uses; normal maps use the first.
    pub(super) sets: [usize; 2],
}

/// The materials of a document.
#[derive(Debug, Default)]
pub(super) struct Looks {
    /// Those of the file, by index, then variants of them. One that is at fault stays in its place with no parameters.
    pub(super) list: Vec<NamedNode>,
    sets: Vec<[usize; 2]>,
    /// The files of luminaires, and what shines all around.
    pub(super) luminaires: Vec<String>,
    pub(super) surround: Option<LightDesc>,
    /// By index: the variant for meshes with tangents of their own.
    with_tangents: Vec<Option<usize>>,
}

impl Looks {
    /// Reads all materials.
    pub(super) fn read<'a>(document: &Document<'a>, textures: &mut Textures<'_, 'a>) -> Checked<Self> {
        let mut looks = Self::default();
        let mut variants = Vec::new();
        for (index, element) in document.root.list("materials")?.into_iter().enumerate() {
            let name = match element.name() {
                "" => format!("material:{index}"),
                name => name.to_owned(),
            };
            let sets = document.keep(sets(document, &element)).unwrap_or([0, 1]);
            textures.sets = sets;
            textures.material.clone_from(&name);
            let params = document.keep(principled(document, &element, textures)).unwrap_or_default();
            looks.with_tangents.push(params.get(NORMAL_UV).map(|_| variants.len()));
            if params.get(NORMAL_UV).is_some() {
                let mut plain = Params::new();
                params.iter().filter(|p| p.name != NORMAL_UV).for_each(|p| plain.push(p.clone()));
                variants.push(NamedNode { name: name.clone(), node: Node::new(KIND, plain) });
            }
            looks.sets.push(sets);
            looks.list.push(NamedNode { name, node: Node::new(KIND, params) });
        }
        let count = looks.list.len();
        looks.with_tangents.iter_mut().flatten().for_each(|variant| *variant += count);
        looks.list.append(&mut variants);
        Ok(looks)
    }

    /// The look of a primitive.
    pub(super) fn of<'a>(&self, document: &Document<'a>, primitive: &Element<'a>) -> Checked<Look> {
        let Some(reference) = primitive.get("material")? else {
            return Ok(Look { material: None, sets: [0, 1] });
        };
        document.item("materials", &reference)?;
        let index = reference.index()?;
        let attributes = primitive.required("attributes")?;
        let tangents = attributes.get("TANGENT")?.is_some() && attributes.get("NORMAL")?.is_some();
        let variant = self.with_tangents.get(index).copied().flatten().filter(|_| tangents);
        let sets = self.sets.get(index).copied().unwrap_or([0, 1]);
        Ok(Look { material: Some(Id::new(variant.unwrap_or(index) as u32)), sets })
    }
}

const KIND: &str = "principled";
const NORMAL_UV: &str = "normaluv";

/// The two sets of texture coordinates that a material uses: that of its normal map, from which tangents follow, or else
/// the lowest, comes first.
fn sets<'a>(document: &Document<'a>, material: &Element<'a>) -> Checked<[usize; 2]> {
    let mut infos = Vec::new();
    let mut holders = vec![material.clone()];
    holders.extend(material.get("pbrMetallicRoughness")?);
    if let Some(extensions) = material.get("extensions")? {
        for name in extensions.keys() {
            holders.extend(extensions.get(name)?);
        }
    }
    for holder in &holders {
        for key in holder.keys().filter(|key| key.ends_with("Texture") && *key != "occlusionTexture") {
            infos.extend(holder.get(key)?);
        }
    }
    let mut used = infos.iter().map(uv_set).collect::<Checked<Vec<usize>>>()?;
    used.sort_unstable();
    used.dedup();
    let first = match material.get("normalTexture")? {
        Some(info) => uv_set(&info)?,
        None => used.first().copied().unwrap_or(0).min(1),
    };
    let mut others = used.into_iter().filter(|set| *set != first);
    let second = others.next().unwrap_or(usize::from(first == 0));
    if let Some(set) = others.next() {
        let message =
            format!("a material with more than two sets of texture coordinates: TEXCOORD_{set} is not read");
        document.warn(material, message);
    }
    Ok([first, second])
}

pub(super) struct Builder<'m, 'b, 'a> {
    pub(super) document: &'m Document<'a>,
    textures: &'m mut Textures<'b, 'a>,
    params: Params,
}

fn principled<'a>(
    document: &Document<'a>,
    material: &Element<'a>,
    textures: &mut Textures<'_, 'a>,
) -> Checked<Params> {
    let mut builder = Builder { document, textures, params: Params::new() };
    let pbr = material.get("pbrMetallicRoughness")?;
    builder.base(material, pbr.as_ref())?;
    if material.extension("KHR_materials_unlit")?.is_some() {
        builder.put(|p| p.bool("unlit", true));
    } else {
        builder.metal(pbr.as_ref())?;
        builder.emission(material)?;
        builder.normal(material)?;
        builder.dielectric(material)?;
        builder.layers(material)?;
        builder.body(material)?;
    }
    // Light that comes through a surface leaves it from behind.
    let clear = ["transmission", "diffusetransmission"].iter().any(|name| builder.params.get(name).is_some());
    if !material.flag("doubleSided")? && !clear {
        builder.put(|p| p.bool("onesided", true));
    }
    Ok(builder.params)
}

impl<'a> Builder<'_, '_, 'a> {
    pub(super) fn put(&mut self, make: impl FnOnce(Params) -> Params) {
        self.params = make(std::mem::take(&mut self.params));
    }
    /// The number `key` of `from`, brought into `[low, high]` with a warning.
    pub(super) fn ranged(
        &self,
        from: Option<&Element<'a>>,
        key: &str,
        default: f64,
        range: [f64; 2],
    ) -> Checked<f64> {
        let Some(from) = from else { return Ok(default) };
        let value = from.number_or(key, default)?;
        let [low, high] = range;
        if value < low || value > high {
            let at = from.get(key)?.unwrap_or_else(|| from.clone());
            self.document.warn(&at, format!("{key} {value} lies outside {low} to {high}"));
        }
        Ok(value.clamp(low, high))
    }
    /// A float parameter: the channel of a texture times `factor`, or `factor` alone.
    pub(super) fn float(
        &mut self,
        name: &str,
        info: Option<Element<'a>>,
        channel: &'static str,
        factor: f64,
    ) -> Checked<()> {
        let texture = match info {
            // A factor of 0 makes the texture idle.
            Some(info) if factor != 0.0 => self.textures.texture(&info, Role::Channel(channel, factor))?,
            _ => None,
        };
        self.put(|p| match &texture {
            Some(texture) => p.texture(name, texture),
            None => p.float(name, factor as f32),
        });
        Ok(())
    }
    /// A parameter that holds directions in the colours of a texture.
    pub(super) fn direction(&mut self, name: &str, info: &Element<'a>) -> Checked<()> {
        if let Some(texture) = self.textures.texture(info, Role::Normal)? {
            self.put(|p| p.texture(name, &texture));
        }
        Ok(())
    }
    /// A colour parameter: a texture times `factor`, or `factor` alone.
    pub(super) fn color(&mut self, name: &str, info: Option<Element<'a>>, factor: [f64; 3]) -> Checked<()> {
        let texture = match info {
            Some(info) if factor != [0.0; 3] => self.textures.texture(&info, Role::Color(factor))?,
            _ => None,
        };
        self.put(|p| match &texture {
            Some(texture) => p.texture(name, texture),
            None => p.rgb(name, factor.map(|v| v as f32)),
        });
        Ok(())
    }

    fn base(&mut self, material: &Element<'a>, pbr: Option<&Element<'a>>) -> Checked<()> {
        let (factor, info) = match pbr {
            Some(pbr) => (pbr.numbers_or("baseColorFactor", [1.0; 4])?, pbr.get("baseColorTexture")?),
            None => ([1.0; 4], None),
        };
        if factor.iter().any(|f| !(0.0..=1.0).contains(f)) {
            self.document.warn(material, "baseColorFactor lies outside 0 to 1");
        }
        let [r, g, b, a] = factor.map(|f: f64| f.clamp(0.0, 1.0));
        self.color("basecolor", info.clone(), [r, g, b])?;
        let mode = match material.text_or("alphaMode", "OPAQUE")? {
            "OPAQUE" => return Ok(()),
            "MASK" => "mask",
            "BLEND" => "blend",
            other => {
                let message = format!("expected OPAQUE, MASK or BLEND, found \"{other}\"");
                return Err(material.fault_at("alphaMode", message));
            }
        };
        self.put(|p| p.string("alphamode", mode));
        if mode == "mask" {
            let cutoff = self.ranged(Some(material), "alphaCutoff", 0.5, [0.0, 1e6])?;
            self.put(|p| p.float("alphacutoff", cutoff as f32));
        }
        self.float("alpha", info, "a", a)
    }

    fn metal(&mut self, pbr: Option<&Element<'a>>) -> Checked<()> {
        let info = match pbr {
            Some(pbr) => pbr.get("metallicRoughnessTexture")?,
            None => None,
        };
        let metallic = self.ranged(pbr, "metallicFactor", 1.0, [0.0, 1.0])?;
        let roughness = self.ranged(pbr, "roughnessFactor", 1.0, [0.0, 1.0])?;
        self.float("metallic", info.clone(), "b", metallic)?;
        self.float("roughness", info, "g", roughness)
    }

    fn emission(&mut self, material: &Element<'a>) -> Checked<()> {
        let factor = material.numbers_or("emissiveFactor", [0.0; 3])?.map(|f: f64| f.max(0.0));
        if factor == [0.0; 3] {
            return Ok(());
        }
        self.color("emission", material.get("emissiveTexture")?, factor)?;
        if let Some(extension) = material.extension("KHR_materials_emissive_strength")? {
            let strength =
                self.ranged(Some(&extension), "emissiveStrength", 1.0, [0.0, f64::from(f32::MAX)])?;
            self.put(|p| p.float("emissionstrength", strength as f32));
        }
        Ok(())
    }

    fn normal(&mut self, material: &Element<'a>) -> Checked<()> {
        let Some(info) = material.get("normalTexture")? else {
            return Ok(());
        };
        let Some(texture) = self.textures.texture(&info, Role::Normal)? else {
            return Ok(());
        };
        let scale = info.number_or("scale", 1.0)?;
        self.put(|p| p.texture("normal", &texture));
        if scale != 1.0 {
            self.put(|p| p.float("normalscale", scale as f32));
        }
        if let Some(matrix) = linear_part(&info)? {
            self.put(|p| p.with(NORMAL_UV, ValueType::Float, Data::Floats(matrix.to_vec())));
        }
        Ok(())
    }

    fn dielectric(&mut self, material: &Element<'a>) -> Checked<()> {
        if let Some(extension) = material.extension("KHR_materials_ior")? {
            let eta = extension.number_or("ior", 1.5)?;
            // 0 stands for a surface that reflects everything.
            if eta >= 1.0 || eta == 0.0 {
                self.put(|p| p.float("eta", eta as f32));
            } else {
                let message = format!("an index of refraction of {eta} is not supported; 1.5 is used");
                self.document.warn(&extension, message);
            }
        }
        if let Some(extension) = material.extension("KHR_materials_transmission")? {
            let factor = self.ranged(Some(&extension), "transmissionFactor", 0.0, [0.0, 1.0])?;
            if factor > 0.0 {
                self.float("transmission", extension.get("transmissionTexture")?, "r", factor)?;
            }
        }
        Ok(())
    }
}
