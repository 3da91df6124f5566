//! XML to objects: files and those they include, defaults and `$names`, ids. Parameters: `prop.rs`.
//!
//! No document type is allowed, so that no entities unfold. Nesting is limited, and so are the number and the total size of the
//! files, as those of pbrt are.
use std::{
    collections::{BTreeMap, HashMap, HashSet},
    rc::Rc,
    sync::Arc,
};

use durer_scene::{Assets, Diagnostics, Location, SourceId, Sources, Span};
use roxmltree::{Attribute, Document, Node, ParsingOptions};

use super::{
    object::{Child, Object, Prop, What},
    upgrade,
};
use crate::FileAssets;

/// Elements that are objects.
const OBJECTS: [&str; 15] = [
    "sensor",
    "emitter",
    "film",
    "sampler",
    "integrator",
    "rfilter",
    "shape",
    "bsdf",
    "texture",
    "medium",
    "phase",
    "volume",
    "subsurface",
    "camera",
    "luminaire",
];
/// Elements that are values.
const VALUES: [&str; 10] =
    ["float", "integer", "boolean", "string", "point", "vector", "rgb", "srgb", "spectrum", "transform"];
/// The rest.
const OTHERS: [&str; 6] = ["ref", "include", "default", "path", "alias", "scene"];
/// Most files that are included.
const MOST_FILES: usize = 1 << 12;
/// Most nodes of a file.
const MOST_NODES: u32 = 1 << 24;

/// What is read so far.
pub(super) struct Reader<'i> {
    pub(super) assets: &'i FileAssets,
    pub(super) sources: &'i mut Sources,
    pub(super) said: &'i mut Diagnostics,
    /// What `$names` stand for.
    values: BTreeMap<String, String>,
    /// Those that the user gave and no file has asked for.
    pub(super) unused: HashSet<String>,
    /// Folders in which files are looked for, the last named first.
    pub(super) folders: Vec<String>,
    /// What the scene holds, in order.
    pub(super) top: Vec<Child>,
    pub(super) ids: HashMap<String, Rc<Object>>,
    open: Vec<String>,
    files: usize,
    bytes: u64,
}

/// The file that an element stands in.
#[derive(Clone, Copy)]
pub(super) struct Place {
    source: SourceId,
    /// Names are to be changed as Mitsuba 3 changes those of 0.x.
    pub(super) old: bool,
}

impl Place {
    fn span(self, range: std::ops::Range<usize>) -> Span {
        Span { source: self.source, start: range.start as u32, end: range.end as u32 }
    }
    pub(super) fn tag(self, node: Node<'_, '_>) -> Span {
        let start = node.range().start;
        self.span(start..start + 1 + node.tag_name().name().len())
    }
    pub(super) fn value(self, attribute: &Attribute<'_, '_>) -> Span {
        self.span(attribute.range_value())
    }
}

impl<'i> Reader<'i> {
    /// A reader with the values that the user gives.
    pub(super) fn new(
        assets: &'i FileAssets,
        sources: &'i mut Sources,
        said: &'i mut Diagnostics,
        given: &[(String, String)],
    ) -> Self {
        Self {
            assets,
            sources,
            said,
            values: given.iter().cloned().collect(),
            unused: given.iter().map(|(name, _)| name.clone()).collect(),
            folders: vec![String::new()],
            top: Vec::new(),
            ids: HashMap::new(),
            open: Vec::new(),
            files: 0,
            bytes: 0,
        }
    }

    /// Reads the file `name`, whose text is `bytes`.
    pub(super) fn file(&mut self, name: &str, bytes: &[u8], at: impl Into<Location>) {
        let at = at.into();
        self.bytes = self.bytes.saturating_add(bytes.len() as u64);
        let most = self.assets.limits().file_bytes.min(u64::from(u32::MAX) - 4);
        if self.bytes > most {
            self.said.error(at, format!("{name}: the scene's files are too large together"));
            return;
        }
        let Ok(text) = std::str::from_utf8(bytes) else {
            self.said.error(at, format!("{name}: this is no text in UTF-8")).hint("save it as UTF-8");
            return;
        };
        let text: Arc<str> = Arc::from(text);
        let source = self.sources.add(name, Arc::clone(&text));
        let options = ParsingOptions { nodes_limit: MOST_NODES, ..ParsingOptions::default() };
        match Document::parse_with_options(&text, options) {
            Ok(document) => self.document(&document, source),
            Err(error) => {
                let place = Place { source, old: false };
                let start = offset(&text, error.pos()).min(text.len());
                // The place stands before the message already.
                let message = error.to_string();
                let message = message.rsplit_once(" at ").map_or(message.as_str(), |(what, _)| what);
                let error = self.said.error(place.span(start..start), format!("no proper XML: {message}"));
                if message.contains("DTD") {
                    error.hint("leave out <!DOCTYPE ...>: entities are not read");
                }
            }
        }
    }

    fn document(&mut self, document: &Document<'_>, source: SourceId) {
        let root = document.root_element();
        let mut place = Place { source, old: false };
        let version = match root.attribute("version") {
            Some(version) => version,
            None if root.tag_name().name() == "scene" => {
                self.said.error(place.tag(root), "the scene has no version").hint("add version=\"3.0.0\"");
                "3"
            }
            None => "3",
        };
        place.old = upgrade::is_old(version);
        if place.old {
            let message = format!("written for Mitsuba {version}: parameters are renamed as Mitsuba 3 does");
            self.said.note(place.tag(root), message);
        }
        if root.tag_name().name() == "scene" {
            self.attributes(root, &["version"], place);
            self.content(root, place, 0);
        } else if let Some(child) = self.child(root, place, 0) {
            self.top.push(child);
        }
    }

    /// What stands in a `scene`.
    fn content(&mut self, scene: Node<'_, '_>, place: Place, depth: usize) {
        for node in scene.children().filter(Node::is_element) {
            if self.said.is_full() {
                return;
            }
            match node.tag_name().name() {
                "default" => self.default(node, place),
                "include" => self.include(node, place),
                "path" => self.path(node, place),
                "alias" => self.alias(node, place),
                tag if VALUES.contains(&tag) && node.attribute("type").is_none() => {
                    self.said.error(
                        place.tag(node),
                        format!("<{tag}> stands for itself: it belongs in an object"),
                    );
                }
                _ => {
                    let child = self.child(node, place, depth + 1);
                    self.top.extend(child);
                }
            }
        }
    }

    fn default(&mut self, node: Node<'_, '_>, place: Place) {
        self.attributes(node, &["name", "value"], place);
        let (Some(name), Some(value)) = (self.needed(node, "name", place), self.needed(node, "value", place))
        else {
            return;
        };
        self.unused.remove(&name);
        self.values.entry(name).or_insert(value);
    }

    fn path(&mut self, node: Node<'_, '_>, place: Place) {
        self.attributes(node, &["value"], place);
        if let Some(folder) = self.needed(node, "value", place) {
            self.folders.insert(0, format!("{}/", folder.trim_end_matches(['/', '\\'])));
        }
    }

    fn alias(&mut self, node: Node<'_, '_>, place: Place) {
        self.attributes(node, &["id", "as"], place);
        let (Some(id), Some(new)) = (self.needed(node, "id", place), self.needed(node, "as", place)) else {
            return;
        };
        match self.ids.get(&id).map(Rc::clone) {
            Some(object) => drop(self.ids.insert(new, object)),
            None => self.said.unknown(place.tag(node), "id", &id, self.ids.keys().map(String::as_str)),
        }
    }

    fn include(&mut self, node: Node<'_, '_>, place: Place) {
        self.attributes(node, &["filename"], place);
        let Some(name) = self.needed(node, "filename", place) else { return };
        let at = place.tag(node);
        self.files += 1;
        let path = self.found(&name);
        if self.open.contains(&path) {
            self.said.error(at, format!("{name}: the file includes itself, perhaps through others"));
        } else if self.files > MOST_FILES || self.open.len() >= self.assets.limits().depth {
            self.said.error(at, "too many files are included, or too deep");
        } else {
            match self.assets.bytes(&path) {
                Ok(bytes) => {
                    self.open.push(path.clone());
                    self.file(&path, &bytes, at);
                    self.open.pop();
                }
                Err(error) => {
                    let hint = self.assets.advice(&error);
                    let said = self.said.error(at, error.to_string());
                    if let Some(hint) = hint {
                        said.hint(hint);
                    }
                }
            }
        }
    }

    /// The path of the file `name` in the first folder that has it; as it is if none has.
    pub(super) fn found(&self, name: &str) -> String {
        found(self.assets, &self.folders, name)
    }

    /// An object, or a reference to one.
    fn child(&mut self, node: Node<'_, '_>, place: Place, depth: usize) -> Option<Child> {
        let tag = node.tag_name().name();
        let at = place.tag(node);
        if depth > self.assets.limits().depth {
            self.said.error(at, format!("nested more than {} deep", self.assets.limits().depth));
            return None;
        }
        let name = self.optional(node, "name", place).unwrap_or_default();
        let name = if place.old { upgrade::name(&name) } else { name };
        if tag == "ref" {
            self.attributes(node, &["id", "name"], place);
            return Some(Child { name, what: What::Ref(self.needed(node, "id", place)?), at });
        }
        let is_object = OBJECTS.contains(&tag) || (tag == "spectrum" && node.has_attribute("type"));
        if !is_object {
            let known = OBJECTS.iter().chain(&VALUES).chain(&OTHERS).copied();
            self.said.unknown(at, "element", tag, known);
            return None;
        }
        self.attributes(node, &["type", "id", "name"], place);
        let plugin = self.needed(node, "type", place)?;
        let plugin_at = node.attribute_node("type").map_or(at, |a| place.value(&a));
        let mut object = Object {
            tag: upgrade::tag(tag).to_owned(),
            plugin,
            id: self.optional(node, "id", place).unwrap_or_default(),
            at: plugin_at,
            props: Vec::new(),
            children: Vec::new(),
        };
        for inner in node.children().filter(Node::is_element) {
            let word = inner.tag_name().name();
            if VALUES.contains(&word) && !inner.has_attribute("type") {
                let prop = self.prop(inner, place);
                object.props.extend(prop);
            } else if word == "default" {
                self.default(inner, place);
            } else {
                let child = self.child(inner, place, depth + 1);
                object.children.extend(child);
            }
        }
        if let Some(twice) = repeated(&object) {
            self.said.error(twice.at, format!("\"{}\" is given twice", twice.name));
        }
        if place.old {
            upgrade::object(&mut object);
        }
        let object = Rc::new(object);
        // Of several of one id the last counts: 0.x took such files.
        if !object.id.is_empty() && self.ids.insert(object.id.clone(), Rc::clone(&object)).is_some() {
            self.said.warning(at, format!("the id \"{}\" is given twice; the last counts", object.id));
        }
        Some(Child { name, what: What::Object(object), at })
    }

    /// Complains about attributes that are not `known`.
    pub(super) fn attributes(&mut self, node: Node<'_, '_>, known: &[&str], place: Place) {
        for attribute in node.attributes().filter(|a| !known.contains(&a.name())) {
            let what = format!("attribute of <{}>", node.tag_name().name());
            self.said.unknown(
                place.span(attribute.range_qname()),
                &what,
                attribute.name(),
                known.iter().copied(),
            );
        }
    }

    /// The value of an attribute, if it is there and every `$name` in it is known.
    pub(super) fn optional(&mut self, node: Node<'_, '_>, name: &str, place: Place) -> Option<String> {
        let attribute = node.attribute_node(name)?;
        match substituted(attribute.value(), &self.values) {
            Ok(value) => Some(value),
            Err(unknown) => {
                let names = self.values.keys().map(String::as_str);
                self.said.unknown(place.value(&attribute), "value", &format!("${unknown}"), names);
                None
            }
        }
    }

    pub(super) fn attribute(&self, node: Node<'_, '_>, name: &str) -> Option<String> {
        let value = node.attribute(name)?;
        Some(substituted(value, &self.values).unwrap_or_else(|_| value.to_owned()))
    }

    /// The value of an attribute; complains if it is not there.
    pub(super) fn needed(&mut self, node: Node<'_, '_>, name: &str, place: Place) -> Option<String> {
        if !node.has_attribute(name) {
            let tag = node.tag_name().name();
            self.said.error(place.tag(node), format!("<{tag}> has no attribute \"{name}\""));
        }
        self.optional(node, name, place)
    }
}

/// The path of the file `name` in the first of `folders` that has it; as it is if none has.
pub(super) fn found(assets: &FileAssets, folders: &[String], name: &str) -> String {
    let paths = folders.iter().map(|folder| format!("{folder}{name}"));
    paths.into_iter().find(|path| assets.resolve(path).is_ok()).unwrap_or_else(|| name.to_owned())
}

/// The first parameter whose name another has.
fn repeated(object: &Object) -> Option<&Prop> {
    let mut names = HashSet::new();
    object.props.iter().find(|prop| !names.insert(prop.name.as_str()))
}

/// `text` with the values of all `$names`; the name that has none.
fn substituted(text: &str, values: &BTreeMap<String, String>) -> Result<String, String> {
    let mut parts = text.split('$');
    let mut whole = parts.next().unwrap_or("").to_owned();
    for part in parts {
        let end = part.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(part.len());
        // The longest name that is known: other letters may follow at once.
        let lengths = (1..=end).rev();
        let known = lengths.filter_map(|n| Some((values.get(part.get(..n)?)?, part.get(n..)?))).next();
        let (value, rest) = known.ok_or_else(|| part.get(..end).unwrap_or("").to_owned())?;
        whole.push_str(value);
        whole.push_str(rest);
    }
    Ok(whole)
}

/// The byte at a row and column, both counted from 1.
fn offset(text: &str, at: roxmltree::TextPos) -> usize {
    let row =
        text.split_inclusive('\n').take((at.row as usize).saturating_sub(1)).map(str::len).sum::<usize>();
    let line = text.get(row..).unwrap_or("");
    row + line.chars().take((at.col as usize).saturating_sub(1)).map(char::len_utf8).sum::<usize>()
}
