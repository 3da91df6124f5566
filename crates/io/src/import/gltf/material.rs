//! Materials: metallic-roughness with its extensions to the kind `principled`.
//!
//! `doubleSided` is ignored knowingly: rays hit both sides. Occlusion textures are ignored too: rays find out.
use durer_core::Id;
use durer_scene::{MaterialRef, NamedNode, Node, Params};

use super::{
    document::Document,
    element::{Checked, Element},
    texture::{Role, Textures},
};

/// The materials of a document, by index; one that is at fault stays in its place with no parameters.
pub(super) fn materials<'a>(
    document: &Document<'a>,
    textures: &mut Textures<'_, 'a>,
) -> Checked<Vec<NamedNode>> {
    let list = document.root.list("materials")?.into_iter().enumerate();
    let made = list.map(|(index, element)| {
        let name = match element.name() {
            "" => format!("material:{index}"),
            name => name.to_owned(),
        };
        let params = document.keep(principled(document, &element, textures)).unwrap_or_default();
        NamedNode { name, node: Node::new("principled", params) }
    });
    Ok(made.collect())
}

/// The material of a primitive.
pub(super) fn reference<'a>(
    document: &Document<'a>,
    primitive: &Element<'a>,
) -> Checked<Option<MaterialRef>> {
    let Some(reference) = primitive.get("material")? else {
        return Ok(None);
    };
    document.item("materials", &reference)?;
    Ok(Some(Id::new(reference.index()? as u32)))
}

struct Builder<'m, 'b, 'a> {
    document: &'m Document<'a>,
    textures: &'m mut Textures<'b, 'a>,
    params: Params,
}

fn principled<'a>(
    document: &Document<'a>,
    material: &Element<'a>,
    textures: &mut Textures<'_, 'a>,
) -> Checked<Params> {
    let mut builder = Builder { document, textures, params: Params::new() };
    let unlit = material.extension("KHR_materials_unlit")?.is_some();
    let pbr = material.get("pbrMetallicRoughness")?;
    builder.base(material, pbr.as_ref(), if unlit { "emission" } else { "basecolor" })?;
    if unlit {
        document.warn(material, "unlit materials are drawn as black ones that emit their colour");
        // An index of 1 reflects nothing.
        builder.params = builder.params.rgb("basecolor", [0.0; 3]).float("eta", 1.0);
        return Ok(builder.params);
    }
    builder.metal(pbr.as_ref())?;
    builder.emission(material)?;
    builder.normal(material)?;
    builder.dielectric(material)?;
    Ok(builder.params)
}

impl<'a> Builder<'_, '_, 'a> {
    fn put(&mut self, make: impl FnOnce(Params) -> Params) {
        self.params = make(std::mem::take(&mut self.params));
    }
    /// The number `key` of `from`, brought into `[low, high]` with a warning.
    fn ranged(&self, from: Option<&Element<'a>>, key: &str, default: f64, range: [f64; 2]) -> Checked<f64> {
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
    fn float(
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
    /// A colour parameter: a texture times `factor`, or `factor` alone.
    fn color(&mut self, name: &str, info: Option<Element<'a>>, factor: [f64; 3]) -> Checked<()> {
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

    fn base(&mut self, material: &Element<'a>, pbr: Option<&Element<'a>>, name: &str) -> Checked<()> {
        let (factor, info) = match pbr {
            Some(pbr) => (pbr.numbers_or("baseColorFactor", [1.0; 4])?, pbr.get("baseColorTexture")?),
            None => ([1.0; 4], None),
        };
        if factor.iter().any(|f| !(0.0..=1.0).contains(f)) {
            self.document.warn(material, "baseColorFactor lies outside 0 to 1");
        }
        let [r, g, b, a] = factor.map(|f: f64| f.clamp(0.0, 1.0));
        self.color(name, info.clone(), [r, g, b])?;
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
            let cutoff = material.number_or("alphaCutoff", 0.5)?;
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
            let strength = extension.number_or("emissiveStrength", 1.0)?;
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
        Ok(())
    }

    fn dielectric(&mut self, material: &Element<'a>) -> Checked<()> {
        if let Some(extension) = material.extension("KHR_materials_ior")? {
            let eta = extension.number_or("ior", 1.5)?;
            if eta >= 1.0 {
                self.put(|p| p.float("eta", eta as f32));
            } else {
                let message = format!("an index of refraction of {eta} is not supported; 1.5 is used");
                self.document.warn(&extension, message);
            }
        }
        if let Some(extension) = material.extension("KHR_materials_transmission")? {
            let factor = self.ranged(Some(&extension), "transmissionFactor", 0.0, [0.0, 1.0])?;
            self.float("transmission", extension.get("transmissionTexture")?, "r", factor)?;
        }
        Ok(())
    }
}
