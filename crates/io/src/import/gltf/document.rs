//! The parsed file: references between its lists, complaints, and the budget of what it may unpack to.
use std::{
    cell::{Cell, RefCell},
    collections::BTreeSet,
    sync::{
        Arc,
        atomic::{AtomicBool, AtomicU64, Ordering},
    },
};

use durer_scene::{Diagnostic, Diagnostics, Location, Severity};

use super::element::{Checked, Element, Fault};

/// A glTF document under import.
pub(super) struct Document<'a> {
    /// Its outermost object.
    pub(super) root: Element<'a>,
    file: Arc<str>,
    complaints: RefCell<Diagnostics>,
    said: RefCell<BTreeSet<String>>,
    errors: Cell<usize>,
    warnings: Cell<usize>,
    budget: Arc<AtomicU64>,
    exhausted: Arc<AtomicBool>,
}

/// What is said, once, of a file whose budget is spent.
const FAR_MORE: &str = "the geometry of this file unpacks to far more than its buffers hold";

/// How many there are of the list `list`, which is called by the plural of what it holds.
pub(super) fn only(count: usize, list: &str) -> String {
    let one = match list {
        "meshes" => "mesh",
        list => list.strip_suffix('s').unwrap_or(list),
    };
    match count {
        0 => "there are none".to_owned(),
        1 => format!("there is only 1 {one}"),
        n => format!("there are only {n} {list}"),
    }
}

impl<'a> Document<'a> {
    /// The document `root` of `file`.
    pub(super) fn new(root: Element<'a>, file: &str) -> Self {
        let (complaints, said) = (RefCell::default(), RefCell::default());
        let (errors, warnings) = (Cell::new(0), Cell::new(0));
        let (budget, exhausted) = (Arc::default(), Arc::default());
        Self { root, file: file.into(), complaints, said, errors, warnings, budget, exhausted }
    }
    /// The same document with complaints of its own, for work on another thread; the budget stays shared.
    pub(super) fn apart(&self) -> Self {
        let apart = Self::new(self.root.clone(), &self.file);
        Self { budget: Arc::clone(&self.budget), exhausted: Arc::clone(&self.exhausted), ..apart }
    }
    /// Takes over the complaints of [`Self::apart`], less those that were said before.
    pub(super) fn absorb(&self, other: Self) {
        for Diagnostic { severity, at, message, hint } in other.complaints.into_inner().iter() {
            let Location::Path { pointer, .. } = at else { continue };
            match severity {
                Severity::Error => self.error(Fault {
                    pointer: pointer.clone(),
                    message: message.clone(),
                    hint: hint.clone(),
                }),
                Severity::Warning => self.warn_at(pointer, message.clone()),
                Severity::Note => {
                    self.complaints.borrow_mut().note(at.clone(), message.clone());
                }
            }
        }
    }
    /// Element of the list `list` that `reference` names by index.
    pub(super) fn item(&self, list: &str, reference: &Element<'a>) -> Checked<Element<'a>> {
        let index = reference.index()?;
        if let Some(item) = self.root.list_item(list, index)? {
            return Ok(item);
        }
        let count = self.root.get(list)?.map_or(Ok(0), |list| list.items().map(|items| items.len()))?;
        Err(reference.fault(format!("refers to /{list}/{index}, but {}", only(count, list))))
    }
    /// [`Self::item`] for the optional member `key` of `from`.
    pub(super) fn member(&self, from: &Element<'a>, key: &str, list: &str) -> Checked<Option<Element<'a>>> {
        from.get(key)?.map(|reference| self.item(list, &reference)).transpose()
    }

    /// The place in the file that `pointer` leads to.
    pub(super) fn location(&self, pointer: &str) -> Location {
        Location::Path { file: self.file.to_string(), pointer: pointer.to_owned() }
    }
    /// Adds an error, once: many things may fail by the same cause.
    pub(super) fn error(&self, fault: Fault) {
        let key = match fault.message.starts_with(FAR_MORE) {
            true => FAR_MORE.to_owned(),
            false => format!("{} {}", fault.pointer, fault.message),
        };
        if !self.said.borrow_mut().insert(key) {
            return;
        }
        let mut complaints = self.complaints.borrow_mut();
        if self.errors.replace(self.errors.get().saturating_add(1)) >= Diagnostics::MOST_ERRORS {
            return;
        }
        let hint = fault.hint.or_else(|| user(&self.root, &fault.pointer));
        complaints.error(self.location(&fault.pointer), fault.message).hint = hint;
    }
    /// Keeps a value; turns a fault into an error.
    pub(super) fn keep<T>(&self, checked: Checked<T>) -> Option<T> {
        checked.map_err(|fault| self.error(fault)).ok()
    }
    /// Turns a fault that counts into an error.
    pub(super) fn keep_if<T>(&self, checked: Checked<T>, counts: impl FnOnce(&Fault) -> bool) {
        if let Some(fault) = checked.err().filter(counts) {
            self.error(fault);
        }
    }
    /// Adds a warning, unless the same words were said before about another place.
    pub(super) fn warn(&self, at: &Element<'_>, message: impl Into<String>) {
        self.warn_at(at.pointer(), message.into());
    }
    fn warn_at(&self, pointer: &str, message: String) {
        if !self.said.borrow_mut().insert(message.clone()) {
            return;
        }
        let before = self.warnings.replace(self.warnings.get().saturating_add(1));
        let message = match before.cmp(&Diagnostics::MOST_ERRORS) {
            std::cmp::Ordering::Less => message,
            std::cmp::Ordering::Equal => "from here on warnings are left out: there are too many".to_owned(),
            std::cmp::Ordering::Greater => return,
        };
        self.complaints.borrow_mut().warning(self.location(pointer), message);
    }
    /// Adds a note.
    pub(super) fn note(&self, at: &Element<'_>, message: impl Into<String>) {
        self.complaints.borrow_mut().note(self.location(at.pointer()), message);
    }
    /// True if an error was found.
    pub(super) fn has_errors(&self) -> bool {
        self.errors.get() > 0
    }
    /// All complaints.
    pub(super) fn into_complaints(self) -> Diagnostics {
        self.complaints.into_inner()
    }

    /// Sets what geometry may unpack to, from the size of the buffers it is unpacked from. Quantised, sparse and
    /// shared accessors make arrays grow a few times; a file that wants more than this is an attack.
    pub(super) fn set_budget(&self, buffer_bytes: u64) {
        self.budget.store(buffer_bytes.saturating_mul(256).saturating_add(64 << 20), Ordering::Relaxed);
    }
    /// Takes `bytes` from that budget before they are allocated.
    pub(super) fn spend(&self, at: &Element<'_>, count: usize, size: usize) -> Checked<()> {
        let bytes = (count as u64).saturating_mul(size as u64);
        let take = |left: u64| left.checked_sub(bytes);
        match self.budget.fetch_update(Ordering::Relaxed, Ordering::Relaxed, take) {
            Ok(_) => Ok(()),
            Err(_) => {
                self.exhausted.store(true, Ordering::Relaxed);
                Err(at.fault(format!("{FAR_MORE} ({count} elements here)")))
            }
        }
    }
    /// Complains if there are more than `most` of `what`; nothing is to be made then.
    pub(super) fn at_most(&self, at: &Element<'_>, count: usize, most: usize, what: &str) -> Checked<()> {
        if count <= most {
            return Ok(());
        }
        self.exhausted.store(true, Ordering::Relaxed);
        Err(at.fault(format!("this file makes {count} {what}; durer draws at most {most} of one file")))
    }
    /// True if the file wants more than it may have: what follows need not be looked at.
    pub(super) fn is_exhausted(&self) -> bool {
        self.exhausted.load(Ordering::Relaxed)
    }
}

/// Which mesh uses the accessor that `pointer` leads into first, or is led into itself.
fn user(root: &Element<'_>, pointer: &str) -> Option<String> {
    let mut names = pointer.split('/').skip(1);
    let (list, index) = (names.next()?, names.next()?.parse().ok()?);
    match list {
        "accessors" => first_mesh(root, index).ok()?,
        "meshes" => {
            let name = root.list_item(list, index).ok()??.name();
            (!name.is_empty()).then(|| format!("the mesh is called \"{name}\""))
        }
        _ => None,
    }
}

fn first_mesh(root: &Element<'_>, accessor: usize) -> Checked<Option<String>> {
    let is_it = |value: Element<'_>| value.index().is_ok_and(|index| index == accessor);
    for (number, mesh) in root.list("meshes")?.iter().enumerate() {
        for primitive in mesh.list("primitives")? {
            let attributes = primitive.get("attributes")?.into_iter().chain(primitive.list("targets")?);
            let mut values = attributes.flat_map(|set| {
                let values = set.keys().filter_map(|key| set.get(key).ok()?).collect::<Vec<_>>();
                values.into_iter()
            });
            if values.any(is_it) || primitive.get("indices")?.is_some_and(is_it) {
                let name = match mesh.name() {
                    "" => String::new(),
                    name => format!(", \"{name}\""),
                };
                return Ok(Some(format!("used by mesh {number}{name}")));
            }
        }
    }
    Ok(None)
}

#[cfg(test)]
mod tests {
    use super::{only, user};
    use crate::import::gltf::element::Element;

    #[test]
    fn counts_are_told_in_words() {
        assert_eq!(only(0, "bufferViews"), "there are none");
        assert_eq!(only(1, "meshes"), "there is only 1 mesh");
        assert_eq!(only(1, "accessors"), "there is only 1 accessor");
        assert_eq!(only(2, "meshes"), "there are only 2 meshes");
    }

    #[test]
    fn the_mesh_of_an_accessor_is_named() {
        let value = serde_json::json!({"meshes": [
            {"primitives": [{"attributes": {"POSITION": 0}}]},
            {"name": "Body", "primitives": [{"attributes": {"POSITION": 2}, "indices": 3}]},
        ]});
        let said = |pointer| user(&Element::root(&value), pointer);
        assert_eq!(said("/accessors/0").as_deref(), Some("used by mesh 0"));
        assert_eq!(said("/accessors/3/count").as_deref(), Some("used by mesh 1, \"Body\""));
        assert_eq!(said("/meshes/1/primitives/0").as_deref(), Some("the mesh is called \"Body\""));
        assert_eq!(said("/accessors/9"), None);
        assert_eq!(said("/nodes/0"), None);
    }
}
