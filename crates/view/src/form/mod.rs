//! Forms: what can be chosen, made from the schemas of the registries. A new parameter of a kind is in its form at once.
mod edit;
mod hand;
mod param;

use std::{fmt, str::FromStr, sync::Arc};

use durer::{
    integrator::INTEGRATORS,
    model::{
        camera::CAMERAS,
        light::{AREA_LIGHTS, LIGHTS},
        material::MATERIALS,
    },
    sampling::SamplerKind,
    scene::{Entry, Node, SceneDesc, Schema},
};
use serde::Serialize;

use crate::settings::Settings;

pub(crate) use edit::{Complaint, Effort, kind, reset, set, unknown, with};
pub(crate) use param::Field;

/// Which form.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FormId {
    Look,
    Film,
    Moment,
    Integrator,
    Sampler,
    Camera,
    Material(usize),
    Light(usize),
    /// The light of a shape, by the first shape that has it.
    AreaLight(usize),
}

/// A form as the page shows it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Form {
    id: String,
    title: String,
    family: &'static str,
    kind: Option<String>,
    /// Words that the kind can be changed to; empty if it cannot.
    kinds: Vec<&'static str>,
    doc: &'static str,
    params: Vec<Field>,
    /// It is not as it was opened.
    changed: bool,
}

impl fmt::Display for FormId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Look => f.write_str("look"),
            Self::Film => f.write_str("film"),
            Self::Moment => f.write_str("moment"),
            Self::Integrator => f.write_str("integrator"),
            Self::Sampler => f.write_str("sampler"),
            Self::Camera => f.write_str("camera"),
            Self::Material(n) => write!(f, "material/{n}"),
            Self::Light(n) => write!(f, "light/{n}"),
            Self::AreaLight(n) => write!(f, "arealight/{n}"),
        }
    }
}

impl FromStr for FormId {
    type Err = ();
    fn from_str(text: &str) -> Result<Self, ()> {
        let number = |n: &str| n.parse().map_err(|_| ());
        Ok(match text.split_once('/') {
            None => match text {
                "look" => Self::Look,
                "film" => Self::Film,
                "moment" => Self::Moment,
                "integrator" => Self::Integrator,
                "sampler" => Self::Sampler,
                "camera" => Self::Camera,
                _ => return Err(()),
            },
            Some(("material", n)) => Self::Material(number(n)?),
            Some(("light", n)) => Self::Light(number(n)?),
            Some(("arealight", n)) => Self::AreaLight(number(n)?),
            Some(_) => return Err(()),
        })
    }
}

/// The schemas of a registry.
fn schemas<T>(registry: &'static [Entry<T>]) -> Vec<&'static Schema> {
    registry.iter().map(|entry| &entry.schema).collect()
}

impl FormId {
    /// What the kinds of its node are; empty if it has none.
    fn schemas(self) -> Vec<&'static Schema> {
        match self {
            Self::Integrator => schemas(INTEGRATORS),
            Self::Camera => schemas(CAMERAS),
            Self::Material(_) => schemas(MATERIALS),
            Self::Light(_) => schemas(LIGHTS),
            Self::AreaLight(_) => schemas(AREA_LIGHTS),
            Self::Look | Self::Film | Self::Moment | Self::Sampler => Vec::new(),
        }
    }

    /// The schema of one of its kinds, by any of its words.
    fn schema(self, kind: &str) -> Option<&'static Schema> {
        self.schemas().into_iter().find(|s| s.name == kind || s.aliases.contains(&kind))
    }

    /// The node that it is about.
    pub(crate) fn node(self, settings: &Settings) -> Option<Node> {
        let desc = &settings.desc;
        match self {
            Self::Integrator => Some(settings.integrator()),
            Self::Camera => Some(settings.camera().node.clone()),
            Self::Material(n) => desc.materials.get(n).map(|m| m.node.clone()),
            Self::Light(n) => desc.lights.get(n).map(|l| l.node.clone()),
            Self::AreaLight(n) => desc.shapes.get(n)?.area_light.as_deref().cloned(),
            Self::Look | Self::Film | Self::Moment | Self::Sampler => None,
        }
    }

    /// Puts a node in the place of [`FormId::node`]; all shapes that share a light go on sharing it.
    pub(crate) fn put(self, settings: &mut Settings, node: Node) {
        let camera = settings.camera;
        let desc = &mut settings.desc;
        match self {
            Self::Integrator => desc.integrator = Some(node),
            Self::Camera => desc.cameras[camera].node = node,
            Self::Material(n) => desc.materials[n].node = node,
            Self::Light(n) => desc.lights[n].node = node,
            Self::AreaLight(n) => {
                let (Some(old), new) = (desc.shapes[n].area_light.clone(), Arc::new(node)) else { return };
                let lights = desc.shapes.iter_mut().filter_map(|s| s.area_light.as_mut());
                lights.filter(|light| Arc::ptr_eq(light, &old)).for_each(|light| *light = Arc::clone(&new));
            }
            Self::Look | Self::Film | Self::Moment | Self::Sampler => {}
        }
    }

    pub(crate) fn family(self) -> &'static str {
        match self {
            Self::Look => "look",
            Self::Film => "film",
            Self::Moment => "moment",
            Self::Integrator => "integrator",
            Self::Sampler => "sampler",
            Self::Camera => "camera",
            Self::Material(_) => "material",
            Self::Light(_) => "light",
            Self::AreaLight(_) => "area light",
        }
    }

    pub(crate) fn title(self, settings: &Settings) -> String {
        let desc = &settings.desc;
        let called = |name: &str, kind: &str, n: usize| match name {
            "" => format!("{kind} {n}"),
            name => name.to_owned(),
        };
        match self {
            Self::Material(n) => desc.materials.get(n).map(|m| called(&m.name, &m.node.kind, n)),
            Self::Light(n) => desc.lights.get(n).map(|l| called(&l.name, &l.node.kind, n)),
            Self::AreaLight(n) => desc.shapes.get(n).map(|s| called(&s.name, "shape", n)),
            Self::Camera => Some(settings.camera().name.clone()).filter(|name| !name.is_empty()),
            _ => None,
        }
        .unwrap_or_else(|| self.family().to_owned())
    }

    /// All forms of a scene.
    pub(crate) fn all(desc: &SceneDesc) -> Vec<Self> {
        let mut all =
            vec![Self::Look, Self::Film, Self::Moment, Self::Integrator, Self::Sampler, Self::Camera];
        all.extend((0..desc.materials.len()).map(Self::Material));
        all.extend((0..desc.lights.len()).map(Self::Light));
        let mut seen: Vec<&Arc<Node>> = Vec::new();
        for (n, shape) in desc.shapes.iter().enumerate() {
            if let Some(light) = &shape.area_light
                && !seen.last().is_some_and(|last| Arc::ptr_eq(last, light))
                && !seen.iter().any(|known| Arc::ptr_eq(known, light))
            {
                seen.push(light);
                all.push(Self::AreaLight(n));
            }
        }
        all
    }

    /// The form as the settings have it; `None` if there is no such thing in the scene. `opened` is how it was opened.
    pub(crate) fn form(self, settings: &Settings, opened: &Settings) -> Option<Form> {
        let (kind, kinds, doc, params) = match self.node(settings) {
            Some(node) => {
                let schema = self.schema(&node.kind);
                let kinds = if schema.is_some() {
                    self.schemas().iter().map(|s| s.name).collect()
                } else {
                    Vec::new()
                };
                let params = schema.map_or(&[][..], |s| s.params);
                let fields = params.iter().map(|spec| Field::of(spec, node.params.get(spec.name)));
                (Some(node.kind.clone()), kinds, schema.map_or("", |s| s.doc), fields.collect())
            }
            None => match self {
                Self::Sampler => {
                    let kind = hand::sampler(settings).word().to_owned();
                    (
                        Some(kind),
                        SamplerKind::ALL.iter().map(|k| k.word()).collect(),
                        "How samples become random numbers.",
                        Vec::new(),
                    )
                }
                Self::Look | Self::Film | Self::Moment => {
                    (None, Vec::new(), "", hand::fields(self, settings))
                }
                _ => return None,
            },
        };
        Some(Form {
            id: self.to_string(),
            title: self.title(settings),
            family: self.family(),
            kind,
            kinds,
            doc,
            params,
            changed: self.node(settings) != self.node(opened) || hand::differs(self, settings, opened),
        })
    }
}
