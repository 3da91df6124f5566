//! The directives that name a kind of thing in the world and give it parameters.
use std::sync::Arc;

use durer_scene::{Data, LightDesc, Location, MaterialRef, Node, Param, TextureValue, ValueType};

use super::{
    cutout::take_alpha,
    input::{Reported, Word},
    lexer::Token,
    params::{ParamList, stored, take},
    parser::Parser,
    retired,
    state::Target,
    world::PlacedShape,
};

impl Parser<'_> {
    /// A kind and its parameters; `what` is "a kind of" something where older versions had other words.
    pub(super) fn kind_and_params(&mut self, head: Token, what: &str) -> Result<(Word, ParamList), Reported> {
        let kind = self.input.string(head, what)?;
        let mut params = self.params()?;
        retired::sift(&mut params, self.input.diagnostics);
        let family = what.strip_prefix("a kind of ").unwrap_or("");
        let retired = retired::complain(family, &kind, self.input.diagnostics);
        if retired { Err(Reported) } else { Ok((kind, params)) }
    }

    /// The parameters of a directive, their colours in our space.
    pub(super) fn params(&mut self) -> Result<ParamList, Reported> {
        let mut params = self.input.params()?;
        let space = self.state.color_space;
        let outside: Vec<Location> =
            params.iter_mut().filter_map(|param| space.convert(param).then(|| param.at.clone())).collect();
        for at in outside {
            if self.first_time("colour outside") {
                let message = format!("a colour of {} lies outside Rec. 709: it is cut off", space.name);
                self.input.diagnostics.warning(at, message);
            }
        }
        Ok(params)
    }

    pub(super) fn node(&mut self, head: Token, what: &str) -> Result<Node, Reported> {
        let (kind, params) = self.kind_and_params(head, what)?;
        Ok(Node { kind: kind.text, params: stored(params), at: kind.at.into() })
    }

    /// Our addition: what the parameter "string name" calls a shape, light or camera.
    pub(super) fn name(&mut self, params: &mut ParamList) -> String {
        let Some(param) = take(params, "name") else {
            return String::new();
        };
        if let (ValueType::String, Data::Strings(names)) = (param.ty, &param.data)
            && let [name] = names.as_slice()
        {
            return name.clone();
        }
        self.input.diagnostics.error(param.at, "\"name\" must be one string");
        String::new()
    }

    /// Adds what `Attribute` gave to `target`.
    pub(super) fn inherit(&mut self, target: Target, mut params: ParamList, at: &Word) -> ParamList {
        let inherited = self.state.inherited.of(target);
        let missing = inherited.iter().filter(|new| params.iter().all(|own| own.name != new.name));
        let missing: Vec<_> = missing.collect();
        if missing.is_empty() {
            return params;
        }
        if self.world.may_copy(missing.iter().copied()) {
            params.extend(missing.into_iter().cloned());
        } else if self.first_time("copied parameters") {
            self.input.error(at.at, "the parameters given by Attribute take more than 1 GiB in all");
        }
        params
    }

    /// `Attribute`
    pub(super) fn attribute(&mut self, head: Token) -> Result<(), Reported> {
        let (word, params) = self.kind_and_params(head, "shape, light, material or texture")?;
        let target = match word.text.as_str() {
            "shape" => Target::Shape,
            "light" => Target::Light,
            "material" => Target::Material,
            "texture" => Target::Texture,
            "medium" => Target::Medium,
            other => {
                let words = ["shape", "light", "material", "texture", "medium"];
                self.input.diagnostics.unknown(word.at, "target of Attribute", other, words);
                return Ok(());
            }
        };
        // Every AttributeBegin shares these, every change copies them.
        if !self.world.may_copy(self.state.inherited.of(target)) || !self.state.inherited.add(target, params)
        {
            self.input.error(word.at, "Attribute gives too many parameters");
        }
        Ok(())
    }

    /// `Shape`
    pub(super) fn shape(&mut self, head: Token) -> Result<(), Reported> {
        let (kind, params) = self.kind_and_params(head, "a kind of shape")?;
        let mut params = self.inherit(Target::Shape, params, &kind);
        let name = self.name(&mut params);
        let alpha = take_alpha(&mut params);
        let at = kind.at;
        let material = match alpha {
            Some(alpha) => Some(self.masked(alpha)),
            None => self.state.material,
        };
        let fits = self.world.shape(PlacedShape {
            name,
            node: Arc::new(Node { kind: kind.text, params: stored(params), at: kind.at.into() }),
            placement: self.state.ctm.clone(),
            material,
            reverse: self.state.reverse,
            area_light: self.state.area_light.clone(),
            // Where both sides are the same the surface says nothing, as in pbrt.
            media: self.state.media.filter(|sides| sides.inside != sides.outside),
        });
        if let Err(message) = fits
            && self.first_time(message)
        {
            self.input.error(at, message);
        }
        Ok(())
    }

    /// The material of a shape of which only the share `alpha` is there.
    fn masked(&mut self, alpha: Param) -> MaterialRef {
        if self.state.area_light.is_some() && alpha.data == Data::Floats(vec![0.0]) {
            let message = "a light of which nothing is there sends nothing; pbrt has it shine unseen";
            self.warn_once("unseen light", alpha.at.clone(), message);
        }
        self.world.masked(self.state.material, alpha)
    }

    /// `LightSource`
    pub(super) fn light(&mut self, head: Token) -> Result<(), Reported> {
        let (kind, params) = self.kind_and_params(head, "a kind of light")?;
        let mut params = self.inherit(Target::Light, params, &kind);
        let name = self.name(&mut params);
        if self.world.in_object() {
            let message = "lights in object definitions are not repeated by its instances";
            self.warn_once("light in object", kind.at, message);
        }
        let node = Node { kind: kind.text, params: stored(params), at: kind.at.into() };
        let world_from_light = self.state.ctm.motion(self.world.times);
        self.world.desc.lights.push(LightDesc { name, node, world_from_light });
        Ok(())
    }

    /// `AreaLightSource`
    pub(super) fn area_light(&mut self, head: Token) -> Result<(), Reported> {
        let (kind, params) = self.kind_and_params(head, "a kind of area light")?;
        let params = self.inherit(Target::Light, params, &kind);
        let node = Node { kind: kind.text, params: stored(params), at: kind.at.into() };
        self.state.area_light = Some(Arc::new(node));
        Ok(())
    }

    /// `Material`
    pub(super) fn material(&mut self, head: Token) -> Result<(), Reported> {
        let (mut kind, params) = self.kind_and_params(head, "a kind of material")?;
        let params = self.inherit(Target::Material, params, &kind);
        if kind.text.is_empty() {
            kind.text.push_str("interface");
        }
        let node = Node { kind: kind.text, params: stored(params), at: kind.at.into() };
        self.state.material = Some(self.world.material(node));
        Ok(())
    }

    /// `MakeNamedMaterial`
    pub(super) fn make_named_material(&mut self, head: Token) -> Result<(), Reported> {
        let name = self.input.string(head, "a name")?;
        let mut params = self.params();
        if let Ok(params) = &mut params {
            retired::sift(params, self.input.diagnostics);
        }
        let node = params.as_ref().ok().cloned().and_then(|params| self.named_node(params, &name));
        self.world.define_material(&name, node, self.input.diagnostics);
        params.map(|_| ())
    }

    /// The node of a named material, whose kind is the parameter "string type".
    fn named_node(&mut self, params: ParamList, name: &Word) -> Option<Node> {
        let mut params = self.inherit(Target::Material, params, name);
        let (kind, at) = self.type_of(&mut params, (name, "MakeNamedMaterial"))?;
        let word = Word { text: kind.clone(), at: name.at };
        if retired::complain("material", &word, self.input.diagnostics) {
            return None;
        }
        let kind = if kind.is_empty() { "interface".to_owned() } else { kind };
        Some(Node { kind, params: stored(params), at })
    }

    /// Takes the kind of a named node, which is its parameter "string type"; complains if there is none.
    pub(super) fn type_of(
        &mut self,
        params: &mut ParamList,
        (name, directive): (&Word, &str),
    ) -> Option<(String, Location)> {
        let Some(ty) = take(params, "type") else {
            self.input.error(name.at, format!("{directive} needs the parameter \"string type\""));
            return None;
        };
        let (ValueType::String, Data::Strings(kinds)) = (ty.ty, ty.data) else {
            self.input.diagnostics.error(ty.at, "\"type\" must be a string");
            return None;
        };
        Some((kinds.into_iter().next().unwrap_or_default(), ty.at))
    }

    /// `NamedMaterial`
    pub(super) fn named_material(&mut self, head: Token) -> Result<(), Reported> {
        let name = self.input.string(head, "the name of a material")?;
        self.state.material = Some(self.world.use_material(&name));
        Ok(())
    }

    /// `Texture`
    pub(super) fn texture(&mut self, head: Token) -> Result<(), Reported> {
        let name = self.input.string(head, "a name")?;
        let ty = self.input.string(head, "float or spectrum")?;
        let value = match ty.text.as_str() {
            "float" => Some(TextureValue::Float),
            "spectrum" => Some(TextureValue::Color),
            "color" => {
                self.warn_once(
                    "color texture",
                    ty.at,
                    "\"color\" is pbrt-v3's word; it is read as \"spectrum\"",
                );
                Some(TextureValue::Color)
            }
            other => {
                self.input.diagnostics.unknown(ty.at, "texture type", other, ["float", "spectrum"]);
                None
            }
        };
        let node = self.kind_and_params(head, "a kind of texture").map(|(kind, params)| {
            let params = self.inherit(Target::Texture, params, &kind);
            Node { kind: kind.text, params: stored(params), at: kind.at.into() }
        });
        if let Some(value) = value {
            let placed = (node.as_ref().ok().cloned(), &self.state.ctm);
            self.world.texture(&name, value, placed, self.input.diagnostics);
        }
        node.map(|_| ())
    }
}
