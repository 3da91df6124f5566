//! What objects become: the description as it grows, and what it shares.
use std::{
    collections::{HashMap, HashSet},
    rc::Rc,
    sync::Arc,
};

use durer_core::spectrum::Sampled;
use durer_scene::{
    Data, Diagnostics, Location, MaterialRef, MediumRef, Mesh, NamedNode, Node, Param, Params, SceneDesc,
    Span, TextureValue, ValueType,
};

use super::{
    object::{Child, Object, Value, What},
    reader::found,
    texture,
};
use crate::FileAssets;

/// An object by its address: each is made once.
pub(super) type Known<T> = HashMap<*const Object, Option<T>>;

/// The description as it grows.
pub(super) struct World<'i> {
    pub(super) desc: &'i mut SceneDesc,
    pub(super) assets: &'i mut FileAssets,
    pub(super) said: &'i mut Diagnostics,
    pub(super) folders: Vec<String>,
    pub(super) ids: HashMap<String, Rc<Object>>,
    pub(super) materials: Known<MaterialRef>,
    pub(super) media: Known<MediumRef>,
    pub(super) textures: HashMap<(*const Object, bool), Option<String>>,
    /// By file and how it is read.
    pub(super) meshes: HashMap<String, Vec<durer_core::Id<Mesh>>>,
    /// What was said once for all.
    told: HashSet<String>,
    /// Objects that are being made, outermost first.
    depth: usize,
    /// Objects that were made, those of instances again for each.
    made: usize,
}

/// Most objects that are made: instances of instances, and materials of materials, multiply.
const MOST_MADE: usize = 1 << 20;

/// A plugin that we have a counterpart of.
pub(super) struct Plugin<B> {
    /// Its word in the file.
    pub(super) name: &'static str,
    /// Parameters and objects it takes.
    pub(super) takes: &'static [&'static str],
    /// Those of Mitsuba that have no counterpart or no effect.
    pub(super) lacks: &'static [&'static str],
    /// Makes it.
    pub(super) build: B,
}

/// A colour as a parameter of ours.
#[derive(Clone, Debug)]
pub(super) enum Shade {
    Rgb([f32; 3]),
    Curve(Vec<f32>),
    Texture(String),
}

/// What a colour is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    /// Of something that reflects.
    Surface,
    /// Of something that shines.
    Light,
}

impl<'i> World<'i> {
    pub(super) fn new(
        desc: &'i mut SceneDesc,
        assets: &'i mut FileAssets,
        said: &'i mut Diagnostics,
        (folders, ids): (Vec<String>, HashMap<String, Rc<Object>>),
    ) -> Self {
        Self {
            desc,
            assets,
            said,
            folders,
            ids,
            materials: HashMap::new(),
            media: HashMap::new(),
            textures: HashMap::new(),
            meshes: HashMap::new(),
            told: HashSet::new(),
            depth: 0,
            made: 0,
        }
    }

    /// The plugin of `object` in `list`, once its parameters are checked; complains about one that is not there.
    pub(super) fn plugin<B: Copy>(&mut self, list: &[Plugin<B>], object: &Object) -> Option<B> {
        let Some(plugin) = list.iter().find(|p| p.name == object.plugin) else {
            let known = list.iter().map(|p| p.name);
            self.said.unknown(object.at, &object.tag, &object.plugin, known);
            return None;
        };
        self.check(object, plugin.takes, plugin.lacks);
        Some(plugin.build)
    }

    /// Complains about parameters of `object` that are neither taken nor known, and tells those that are only known.
    pub(super) fn check(&mut self, object: &Object, takes: &[&str], lacks: &[&str]) {
        let named = object.children.iter().filter(|c| !c.name.is_empty()).map(|c| (&c.name, c.at));
        for (name, at) in object.props.iter().map(|p| (&p.name, p.at)).chain(named) {
            if lacks.contains(&name.as_str()) {
                self.once(at, format!("{}: \"{name}\" has no counterpart and no effect", object.shown()));
            } else if !takes.contains(&name.as_str()) && !is_free(object, name) {
                let what = format!("parameter of {}", object.shown());
                self.said.unknown(at, &what, name, takes.iter().chain(lacks).copied());
            }
        }
    }

    /// Warns, but of the same thing only once.
    pub(super) fn once(&mut self, at: Span, message: String) {
        if self.told.insert(message.clone()) {
            self.said.warning(at, message);
        }
    }
    /// Notes, but the same thing only once.
    pub(super) fn note(&mut self, at: Span, message: String) {
        if self.told.insert(message.clone()) {
            self.said.note(at, message);
        }
    }

    /// What a child is: itself, or what it names; complains if nothing has that id.
    pub(super) fn object(&mut self, child: &Child) -> Option<Rc<Object>> {
        match &child.what {
            What::Object(object) => Some(Rc::clone(object)),
            What::Ref(id) => {
                let found = self.ids.get(id).map(Rc::clone);
                if found.is_none() {
                    self.said.unknown(child.at, "id", id, self.ids.keys().map(String::as_str));
                }
                found
            }
        }
    }

    /// All objects in `object`, with the names they have there.
    pub(super) fn inner(&mut self, object: &Object) -> Vec<(String, Rc<Object>)> {
        object.children.iter().filter_map(|c| Some((c.name.clone(), self.object(c)?))).collect()
    }
    /// The objects of an element within another.
    pub(super) fn of_tag(&mut self, object: &Object, tag: &str) -> Vec<Rc<Object>> {
        self.inner(object).into_iter().filter(|(_, o)| o.tag == tag).map(|(_, o)| o).collect()
    }
    /// The object that is for the parameter `name`.
    pub(super) fn named(&mut self, object: &Object, name: &str) -> Option<Rc<Object>> {
        let child = object.children.iter().find(|c| c.name == name)?;
        self.object(child)
    }

    /// Does something one level deeper; complains if objects contain themselves, or are too many.
    pub(super) fn deeper<T>(
        &mut self,
        object: &Object,
        make: impl FnOnce(&mut Self) -> Option<T>,
    ) -> Option<T> {
        const DEEPEST: usize = 64;
        if self.depth >= DEEPEST {
            self.said
                .error(object.at, format!("{} is in itself, or more than {DEEPEST} deep", object.shown()));
            return None;
        }
        self.made += 1;
        if self.made == MOST_MADE {
            let message = format!("more than {MOST_MADE} objects, those in groups counted for each instance");
            self.said.error(object.at, message).hint("groups in groups and materials in materials multiply");
        }
        if self.made >= MOST_MADE {
            return None;
        }
        self.depth += 1;
        let made = make(self);
        self.depth -= 1;
        made
    }

    /// The path of a file that a parameter names.
    pub(super) fn path(&mut self, object: &Object, name: &str) -> Option<String> {
        match object.text(name, self.said) {
            Some(file) => Some(found(self.assets, &self.folders, file)),
            None => {
                if object.get(name).is_none() {
                    self.said.error(object.at, format!("{} has no \"{name}\"", object.shown()));
                }
                None
            }
        }
    }

    /// A colour; `None` if it is not given.
    pub(super) fn shade(&mut self, object: &Object, name: &str, role: Role) -> Option<Shade> {
        if let Some(texture) = self.named(object, name) {
            if texture.tag == "spectrum" {
                return texture::spectrum(self, &texture);
            }
            return texture::name(self, &texture, TextureValue::Color).map(Shade::Texture);
        }
        let prop = object.get(name)?;
        Some(match (&prop.value, role) {
            (Value::Color(rgb), _) => Shade::Rgb(*rgb),
            (Value::Number(v), _) => Shade::Rgb([*v as f32; 3]),
            (Value::Even(v), Role::Surface) => Shade::Rgb([*v; 3]),
            // The same at all wavelengths is not white, which is daylight.
            (Value::Even(v), Role::Light) => Shade::Curve(vec![360.0, *v, 830.0, *v]),
            (Value::Curve(curve), _) => Shade::Curve(curve.clone()),
            (other, _) => {
                let message = format!("\"{name}\" is {}, expected a colour", other.word());
                self.said.error(prop.at, message);
                return None;
            }
        })
    }

    /// A number or a texture as the parameter `ours`; nothing if it is not given.
    pub(super) fn number(&mut self, params: Params, object: &Object, (theirs, ours): (&str, &str)) -> Params {
        match self.named(object, theirs) {
            Some(texture) => match texture::name(self, &texture, TextureValue::Float) {
                Some(name) => params.texture(ours, &name),
                None => params,
            },
            None => match object.number(theirs, self.said) {
                Some(v) => params.float(ours, v as f32),
                None => params,
            },
        }
    }

    /// A colour as the parameter `ours`; nothing if it is not given.
    pub(super) fn color(&mut self, params: Params, object: &Object, (theirs, ours): (&str, &str)) -> Params {
        let at = object.get(theirs).map_or(object.at, |p| p.at);
        match self.shade(object, theirs, Role::Surface) {
            Some(shade) => with_shade(params, ours, shade, at),
            None => params,
        }
    }

    /// What a light sends as the parameter `ours` and `scale`, white if it is not given, `factor` times as much.
    pub(super) fn light(&mut self, object: &Object, (theirs, ours): (&str, &str), factor: f64) -> Params {
        let at = object.get(theirs).map_or(object.at, |p| p.at);
        let shade = self.shade(object, theirs, Role::Light).unwrap_or(Shade::Rgb([1.0; 3]));
        // Curves of lights are brought to luminance 1.
        let strength = match &shade {
            Shade::Curve(curve) => Sampled::new(curve).map_or(1.0, |s| s.luminance()),
            _ => 1.0,
        };
        with_shade(Params::new(), ours, shade, at).float("scale", strength * factor as f32)
    }

    /// Adds a material.
    pub(super) fn material(&mut self, name: &str, kind: &str, params: Params, at: Span) -> MaterialRef {
        let materials = &mut self.desc.materials;
        let used = |name: &str| materials.iter().any(|m| m.name == name);
        let name = if name.is_empty() || used(name) {
            format!("{kind} {}", materials.len())
        } else {
            name.to_owned()
        };
        materials.push(NamedNode { name, node: node(kind, params, at) });
        MaterialRef::new(materials.len() as u32 - 1)
    }
    /// The name of a material.
    pub(super) fn material_name(&self, material: MaterialRef) -> String {
        self.desc.materials.get(material.index()).map(|m| m.name.clone()).unwrap_or_default()
    }
    /// Adds a mesh.
    pub(super) fn mesh(&mut self, mesh: Mesh) -> durer_core::Id<Mesh> {
        self.desc.meshes.push(Arc::new(mesh));
        durer_core::Id::new(self.desc.meshes.len() as u32 - 1)
    }
}

/// A node whose kind stands at `at`.
pub(super) fn node(kind: &str, params: Params, at: Span) -> Node {
    Node { at: Location::Span(at), ..Node::new(kind, params) }
}

/// `params` with a colour.
pub(super) fn with_shade(mut params: Params, name: &str, shade: Shade, at: Span) -> Params {
    let (ty, data) = match shade {
        Shade::Rgb(rgb) => (ValueType::Rgb, Data::Floats(rgb.to_vec())),
        Shade::Curve(curve) => (ValueType::Spectrum, Data::Floats(curve)),
        Shade::Texture(name) => (ValueType::Texture, Data::Strings(vec![name])),
    };
    params.push(Param { name: name.to_owned(), ty, data, at: at.into() });
    params
}

/// Whether an object within another may have any name: its kind says what it is for.
fn is_free(object: &Object, name: &str) -> bool {
    let child = object.children.iter().find(|c| c.name == name);
    child.is_some_and(|c| match &c.what {
        What::Object(o) => !matches!(o.tag.as_str(), "texture" | "spectrum" | "volume"),
        What::Ref(_) => matches!(name, "bsdf" | "emitter" | "medium" | "interior" | "exterior" | "material"),
    })
}
