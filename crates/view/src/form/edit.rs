//! Forms filled in: values into the description, checked as those of a file are.
use durer::{
    compile::LensOptions,
    sampling::SamplerKind,
    scene::{
        Args, Diagnostics, Node, Param, ParamSpec, ParamType, Params, SceneDesc, Severity, nearest_word,
    },
};
use serde::Serialize;
use serde_json::{Map, Value};

use super::{FormId, hand, param::read};
use crate::settings::Settings;

/// What a change makes necessary.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Effort {
    /// Nothing.
    #[default]
    None,
    /// The picture is shown in another way.
    Develop,
    /// It is taken anew, of the same scene.
    Retake,
    /// The scene is compiled anew.
    Again,
}

/// Why a change is not made.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub(crate) struct Complaint {
    pub(crate) about: String,
    pub(crate) param: Option<String>,
    pub(crate) message: String,
    pub(crate) hint: Option<String>,
}

impl Complaint {
    pub(crate) fn of(about: impl ToString, param: Option<&str>, message: impl Into<String>) -> Self {
        Self {
            about: about.to_string(),
            param: param.map(str::to_owned),
            message: message.into(),
            hint: None,
        }
    }

    /// The errors among diagnostics; `None` if there is none.
    pub(crate) fn errors(about: impl ToString, diagnostics: &Diagnostics) -> Option<Self> {
        let mut errors = diagnostics.iter().filter(|d| d.severity == Severity::Error);
        let first = errors.next()?;
        let more = errors.map(|d| d.message.as_str());
        let all: Vec<&str> = std::iter::once(first.message.as_str()).chain(more).collect();
        Some(Self { hint: first.hint.clone(), ..Self::of(about, None, all.join("\n")) })
    }

    /// Complains about numbers outside the range of a parameter, in the words that are used of files.
    pub(super) fn range(about: FormId, spec: &ParamSpec, param: &Param) -> Result<(), Self> {
        let numbers: Vec<f32> = match &param.data {
            durer::scene::Data::Floats(v) => v.clone(),
            durer::scene::Data::Ints(v) => v.iter().map(|&v| v as f32).collect(),
            durer::scene::Data::Strings(v) => {
                let ParamType::Choice(words) = spec.ty else { return Ok(()) };
                let Some(wrong) = v.iter().find(|v| !words.contains(&v.as_str())) else { return Ok(()) };
                return Err(unknown(about, "word", wrong, words.iter().copied()));
            }
            durer::scene::Data::Bools(_) => return Ok(()),
        };
        match numbers.into_iter().find(|v| !spec.allows(*v)) {
            None => Ok(()),
            Some(v) => {
                let message = format!("\"{}\" is {v}, expected {}", spec.name, spec.expected());
                Err(Self::of(about, Some(spec.name), message))
            }
        }
    }
}

/// The complaint about a word that names nothing.
pub(crate) fn unknown<'w>(
    about: impl ToString,
    what: &str,
    word: &str,
    known: impl Iterator<Item = &'w str>,
) -> Complaint {
    let near = nearest_word(word, known);
    let hint = near.map(|near| format!("did you mean \"{near}\"?"));
    Complaint { hint, ..Complaint::of(about, None, format!("there is no {what} \"{word}\"")) }
}

fn nothing(about: impl ToString) -> Complaint {
    Complaint::of(about, None, "there is no such form")
}

/// The node with a parameter set, or without it for `null`.
fn with_param(id: FormId, node: &Node, (name, value): (&str, &Value)) -> Result<Node, Complaint> {
    let schema = id.schema(&node.kind).ok_or_else(|| nothing(id))?;
    let spec = schema.params.iter().find(|spec| spec.name == name);
    let known = schema.params.iter().map(|spec| spec.name);
    let spec = spec.ok_or_else(|| unknown(id, &format!("parameter of {}", schema.name), name, known))?;
    let mut node = node.clone();
    if value.is_null() {
        let others = node.params.iter().filter(|p| p.name != name).cloned();
        node.params = collected(others);
    } else {
        let param = read(spec, value).map_err(|message| Complaint::of(id, Some(name), message))?;
        node.params.set(param);
    }
    Ok(node)
}

fn collected(params: impl Iterator<Item = Param>) -> Params {
    params.fold(Params::new(), |mut all, param| {
        all.push(param);
        all
    })
}

/// Checks a node as that of a file is checked before it is built.
fn checked(id: FormId, node: Node, settings: &Settings, param: Option<&str>) -> Result<Node, Complaint> {
    let schema = id.schema(&node.kind).ok_or_else(|| nothing(id))?;
    let mut said = Diagnostics::default();
    Args::check(&node, *schema, &settings.desc.textures, &mut said);
    match Complaint::errors(id, &said) {
        Some(complaint) => Err(Complaint { param: param.map(str::to_owned), ..complaint }),
        None => Ok(node),
    }
}

/// What a change of this form makes necessary.
fn effort(id: FormId) -> Effort {
    match id {
        FormId::Look => Effort::Develop,
        FormId::Film | FormId::Integrator | FormId::Sampler | FormId::Camera => Effort::Retake,
        FormId::Moment | FormId::Material(_) | FormId::Light(_) | FormId::AreaLight(_) => Effort::Again,
    }
}

/// Sets a parameter.
///
/// # Errors
/// If there is none of that name, or the value is not for it; nothing is changed then.
pub(crate) fn set(
    id: FormId,
    (settings, opened): (&mut Settings, &Settings),
    (name, value): (&str, &Value),
) -> Result<Effort, Complaint> {
    let Some(node) = id.node(settings) else {
        return match hand::spec(id, name) {
            Some(spec) => hand::set(id, (settings, opened), spec, value),
            None => Err(unknown(id, "setting", name, hand::names(id))),
        };
    };
    let node = checked(id, with_param(id, &node, (name, value))?, settings, Some(name))?;
    id.put(settings, node);
    if id == FormId::Camera && ["lensradius", "fnumber", "focaldistance", "focuspixel"].contains(&name) {
        // What the command line says of the lens would count, whatever is typed here.
        settings.options.lens = LensOptions::default();
    }
    Ok(effort(id))
}

/// Changes the kind; parameters that the new one has too are kept.
///
/// # Errors
/// If there is no such kind, or it needs a parameter that cannot be guessed.
pub(crate) fn kind(id: FormId, settings: &mut Settings, kind: &str) -> Result<Effort, Complaint> {
    if id == FormId::Sampler {
        let words = SamplerKind::ALL.map(SamplerKind::word);
        let found = SamplerKind::from_word(kind);
        settings.options.sampler =
            Some(found.ok_or_else(|| unknown(id, "sampler", kind, words.into_iter()))?);
        return Ok(effort(id));
    }
    let node = id.node(settings).ok_or_else(|| nothing(id))?;
    let node = checked(id, with_kind(id, &settings.desc, &node, kind)?, settings, None)?;
    id.put(settings, node);
    Ok(effort(id))
}

fn with_kind(id: FormId, desc: &SceneDesc, node: &Node, kind: &str) -> Result<Node, Complaint> {
    let known = id.schemas();
    let names = known.iter().map(|s| s.name);
    let schema = id.schema(kind).ok_or_else(|| unknown(id, id.family(), kind, names))?;
    let fits = |param: &&Param| {
        let spec = schema.params.iter().find(|spec| spec.name == param.name);
        spec.is_some_and(|spec| {
            spec.ty.accepts().contains(&param.ty) && Complaint::range(id, spec, param).is_ok()
        })
    };
    let params = collected(node.params.iter().filter(fits).cloned());
    let node = Node { kind: schema.name.to_owned(), params, at: node.at.clone() };
    Ok(if id == FormId::Integrator { durer::with_usual_depth(desc, node) } else { node })
}

/// The integrator of another kind, or with other parameters.
///
/// # Errors
/// If there is no such kind or parameter, or a value is not for it.
pub(crate) fn with(
    settings: &Settings,
    kind: Option<&str>,
    params: &Map<String, Value>,
) -> Result<Node, Complaint> {
    let id = FormId::Integrator;
    let mut node = settings.integrator();
    if let Some(kind) = kind {
        node = with_kind(id, &settings.desc, &node, kind)?;
    }
    for (name, value) in params {
        node = with_param(id, &node, (name, value))?;
    }
    checked(id, node, settings, None)
}

/// Puts a form back as it was opened.
///
/// # Errors
/// If there is no such form.
pub(crate) fn reset(id: FormId, settings: &mut Settings, opened: &Settings) -> Result<Effort, Complaint> {
    match id.node(opened) {
        Some(node) => {
            id.node(settings).ok_or_else(|| nothing(id))?;
            if id == FormId::Camera {
                settings.options.lens = opened.options.lens;
            }
            id.put(settings, node);
            Ok(effort(id))
        }
        None if matches!(id, FormId::Look | FormId::Film | FormId::Moment | FormId::Sampler) => {
            Ok(hand::reset(id, settings, opened))
        }
        None => Err(nothing(id)),
    }
}
