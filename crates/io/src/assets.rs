//! The folder a scene may read from.
//!
//! A scene file is hostile until proven otherwise: a path that leads out of its folder (absolute, `..`, a symbolic
//! link) is refused, and lengths are checked before anything is read or decoded.
use std::{
    collections::{BTreeMap, BTreeSet, HashMap},
    fs::File,
    io::{ErrorKind, Read},
    path::{Path, PathBuf},
    sync::{Arc, Mutex, MutexGuard, PoisonError},
};

use durer_scene::{AssetError, Assets, Image, Limits, Mesh, Ptex, Tensors, Voxels};

use crate::gzip;

/// Files below one folder, and images embedded in the scene file itself.
#[derive(Debug)]
pub struct FileAssets {
    folder: PathBuf,
    /// The folder that holds all files, if it lies above that, and how many folders above.
    root: Option<(PathBuf, usize)>,
    limits: Limits,
    embedded: BTreeMap<String, Arc<[u8]>>,
    users: BTreeMap<String, String>,
    images: Cache<Image>,
    meshes: Cache<Mesh>,
    tensors: Cache<Tensors>,
    ptexs: Cache<Ptex>,
    listings: Cache<HashMap<String, String>>,
    /// Files that were asked for and found.
    found: Mutex<BTreeSet<PathBuf>>,
}

/// Names in a folder that are looked through for one that differs in letter case alone.
const MOST_NAMES: usize = 1 << 16;

/// What was decoded, by path.
type Cache<T> = Mutex<HashMap<String, Arc<T>>>;

impl FileAssets {
    /// Assets below `folder`; the empty path is the current folder.
    pub fn new(folder: PathBuf, limits: Limits) -> Self {
        let folder = if folder.as_os_str().is_empty() { PathBuf::from(".") } else { folder };
        Self {
            folder,
            root: None,
            limits,
            embedded: BTreeMap::new(),
            users: BTreeMap::new(),
            images: Cache::default(),
            meshes: Cache::default(),
            tensors: Cache::default(),
            ptexs: Cache::default(),
            listings: Cache::default(),
            found: Mutex::default(),
        }
    }
    /// Lets files be read from all of `root`, the folder or one above it. Paths stay relative to the folder.
    ///
    /// # Errors
    /// If it is neither.
    pub fn widen(&mut self, root: &Path) -> Result<(), String> {
        let canonical = |p: &Path| p.canonicalize().map_err(|e| format!("{}: {e}", p.display()));
        let (folder, above) = (canonical(&self.folder)?, canonical(root)?);
        let below = folder.strip_prefix(&above).map_err(|_| {
            format!(
                "{} is not a folder that holds the scene: its folder is {}",
                root.display(),
                folder.display()
            )
        })?;
        self.root = Some((above.clone(), below.components().count()));
        Ok(())
    }
    /// How many folders above its own a path may climb.
    fn above(&self) -> usize {
        self.root.as_ref().map_or(0, |(_, above)| *above)
    }
    /// Registers an embedded file under `name`, which then goes before a file of that name.
    pub fn insert(&mut self, name: impl Into<String>, bytes: impl Into<Arc<[u8]>>) {
        let name = name.into();
        entries(&self.images).remove(&name);
        entries(&self.meshes).remove(&name);
        entries(&self.tensors).remove(&name);
        self.embedded.insert(name, bytes.into());
    }
    /// The limits that reading keeps to.
    pub fn limits(&self) -> Limits {
        self.limits
    }
    /// Where the file at `path` is, once it is certain that it lies in the folder.
    ///
    /// # Errors
    /// If it does not, or is not there.
    pub fn resolve(&self, path: &str) -> Result<PathBuf, AssetError> {
        let outside = || AssetError::Outside { path: path.to_owned() };
        let relative = relative_names(path, self.above()).ok_or_else(outside)?;
        let canonical = |p: &Path| p.canonicalize().map_err(|e| io_error(path, &e));
        let file = canonical(&self.folder.join(relative))?;
        // Only the canonical paths tell whether a symbolic link leads out.
        let within = match &self.root {
            Some((root, _)) => root.clone(),
            None => canonical(&self.folder)?,
        };
        if !file.starts_with(within) {
            return Err(outside());
        }
        if file.is_file() {
            self.found.lock().unwrap_or_else(PoisonError::into_inner).insert(file.clone());
        }
        Ok(file)
    }
    /// Whether a file of this name is embedded.
    pub fn is_embedded(&self, name: &str) -> bool {
        self.embedded.contains_key(name)
    }
    /// The files of the folder that were asked for so far.
    pub fn files_read(&self) -> Vec<PathBuf> {
        self.found.lock().unwrap_or_else(PoisonError::into_inner).iter().cloned().collect()
    }
    /// The file at `path`, if it was asked for and found before.
    pub(crate) fn read_as(&self, path: &str) -> Option<PathBuf> {
        let file = self.folder.join(relative_names(path, self.above())?).canonicalize().ok()?;
        let found = self.found.lock().unwrap_or_else(PoisonError::into_inner);
        found.contains(&file).then_some(file)
    }
    /// The path of the file in the folder of `path` whose name is that of `path` but for the letter case, if there is
    /// one: models are made on systems that do not tell them apart.
    pub(crate) fn in_other_case(&self, path: &str) -> Option<String> {
        let path = path.replace('\\', "/");
        let (folder, name) = path.rsplit_once('/').map_or((".", path.as_str()), |(f, n)| (f, n));
        let names = cached(&self.listings, folder, || {
            let read = self.resolve(folder)?.read_dir().map_err(|e| io_error(folder, &e))?;
            let names =
                read.take(MOST_NAMES).flatten().filter_map(|entry| entry.file_name().into_string().ok());
            let mut names: Vec<String> = names.collect();
            // Of several, always the same one.
            names.sort_unstable_by(|a, b| b.cmp(a));
            Ok(names.into_iter().map(|name| (name.to_lowercase(), name)).collect())
        });
        let names = names.ok()?;
        let found = names.get(&name.to_lowercase())?;
        Some(if folder == "." { found.clone() } else { format!("{folder}/{found}") })
    }
}

impl FileAssets {
    /// For messages about the file `name`: what uses it first.
    pub(crate) fn used_by(&mut self, name: &str, user: String) {
        self.users.entry(name.to_owned()).or_insert(user);
    }
    /// For messages about a missing file: the folder it should be in, and which file there is called nearly the same.
    pub(crate) fn looked_in(&self, path: &str) -> Option<String> {
        let relative = relative_names(path, self.above())?;
        let folder = match relative.parent() {
            Some(parent) => self.folder.join(parent),
            None => self.folder.clone(),
        };
        Some(looked_in(&folder, &relative.file_name()?.to_string_lossy()))
    }
}

/// `looked in FOLDER`, with the name there that is nearest to `name`.
pub(crate) fn looked_in(folder: &Path, name: &str) -> String {
    // Nobody waits for a folder of millions of files.
    const MOST: usize = 1000;
    let names: Vec<String> = std::fs::read_dir(folder)
        .into_iter()
        .flatten()
        .take(MOST)
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .collect();
    // "." is the folder itself: "./textures/." would only be longer.
    let shown = Path::new(".").join(folder.strip_prefix(".").unwrap_or(folder));
    let shown = shown.display().to_string();
    let slash = if shown.ends_with('/') { "" } else { "/" };
    let gone = if folder.is_dir() { "" } else { ", which is not there" };
    let near = durer_scene::nearest_word(name, names.iter().map(String::as_str));
    let near = near.map(|near| format!("; did you mean \"{near}\"?")).unwrap_or_default();
    format!("looked in {shown}{slash}{gone}{near}")
}

fn entries<T>(cache: &Cache<T>) -> MutexGuard<'_, HashMap<String, Arc<T>>> {
    // The map is whole even if a thread died while it held the lock: entries are inserted in one step.
    cache.lock().unwrap_or_else(PoisonError::into_inner)
}

/// What is known by the name of `path`, or what `read` makes of it. Read without the lock, so that several files can be
/// read at the same time.
fn cached<T>(
    cache: &Cache<T>,
    path: &str,
    read: impl FnOnce() -> Result<T, AssetError>,
) -> Result<Arc<T>, AssetError> {
    if let Some(known) = entries(cache).get(path) {
        return Ok(Arc::clone(known));
    }
    let read = Arc::new(read()?);
    Ok(Arc::clone(entries(cache).entry(path.to_owned()).or_insert(read)))
}

impl Assets for FileAssets {
    /// The contents of the file at `path` (relative to the folder, `/` or `\` between names) or of the embedded file
    /// of that name.
    fn bytes(&self, path: &str) -> Result<Arc<[u8]>, AssetError> {
        if let Some(bytes) = self.embedded.get(path) {
            return match gzip::is_packed(bytes) {
                true => gzip::unpack(bytes, path, self.limits).map(Arc::from),
                false => Ok(Arc::clone(bytes)),
            };
        }
        read_file(&self.resolve(path)?, path, self.limits).map(Arc::from)
    }
    fn advice(&self, error: &AssetError) -> Option<String> {
        let advice = match error {
            AssetError::Missing { path } => self.looked_in(path),
            AssetError::Outside { .. } => Some(
                "copy the file into the scene's folder, or name a folder with --root that holds both"
                    .to_owned(),
            ),
            _ => None,
        };
        let user = self.users.get(error.path()).map(|user| format!("used by {user}"));
        let all: Vec<String> = user.into_iter().chain(advice).collect();
        (!all.is_empty()).then(|| all.join("; "))
    }
    fn mesh(&self, path: &str) -> Result<Arc<Mesh>, AssetError> {
        cached(&self.meshes, path, || crate::import::ply::mesh(&self.bytes(path)?, path))
    }
    fn grids(&self, path: &str) -> Result<Vec<String>, AssetError> {
        crate::volume::names(&self.bytes(path)?, path)
    }
    fn voxels(&self, path: &str, name: &str) -> Result<Voxels, AssetError> {
        crate::volume::voxels(&self.bytes(path)?, path, name)
    }
    fn tensors(&self, path: &str) -> Result<Arc<Tensors>, AssetError> {
        cached(&self.tensors, path, || crate::tensor::read(self.bytes(path)?, path))
    }
    fn ptex(&self, path: &str) -> Result<Arc<Ptex>, AssetError> {
        cached(&self.ptexs, path, || crate::ptex::read(&self.bytes(path)?, path, self.limits))
    }
    fn image(&self, path: &str) -> Result<Arc<Image>, AssetError> {
        cached(&self.images, path, || crate::image::read(&self.bytes(path)?, path, self.limits))
    }
}

/// `path` without `.` and without `..` but for `above` at its beginning; `None` if it is absolute or climbs higher.
fn relative_names(path: &str, above: usize) -> Option<PathBuf> {
    let path = path.replace('\\', "/");
    let drive = path.as_bytes().get(1) == Some(&b':');
    if path.starts_with('/') || drive || path.contains('\0') {
        return None;
    }
    let mut names: Vec<&str> = Vec::new();
    for name in path.split('/') {
        match name {
            "" | "." => {}
            ".." if names.last().is_none_or(|last| *last == "..") => names.push(name),
            ".." => drop(names.pop()),
            _ => names.push(name),
        }
    }
    (names.iter().filter(|name| **name == "..").count() <= above).then(|| names.iter().collect())
}

fn io_error(path: &str, error: &std::io::Error) -> AssetError {
    match error.kind() {
        ErrorKind::NotFound => AssetError::Missing { path: path.to_owned() },
        _ => AssetError::Io { path: path.to_owned(), reason: error.to_string() },
    }
}

/// Reads `file`, which messages call `name`, if it is no longer than the limits allow; unpacks it if it is gzip.
///
/// # Errors
/// If it is longer, damaged, or cannot be read.
pub(crate) fn read_file(file: &Path, name: &str, limits: Limits) -> Result<Vec<u8>, AssetError> {
    let fail = |e: std::io::Error| io_error(name, &e);
    let too_long = |length: u64| AssetError::Limits {
        path: name.to_owned(),
        reason: format!("{length} bytes, but the limit is {}", limits.file_bytes),
    };
    // Before it is opened: that waits for ever on a pipe to which nobody writes.
    let metadata = file.metadata().map_err(fail)?;
    if !metadata.is_file() {
        let reason = "not a file".to_owned();
        return Err(AssetError::Io { path: name.to_owned(), reason });
    }
    let handle = File::open(file).map_err(fail)?;
    if metadata.len() > limits.file_bytes {
        return Err(too_long(metadata.len()));
    }
    let mut bytes = Vec::with_capacity(usize::try_from(metadata.len()).unwrap_or(0));
    // The file may grow while it is read.
    handle.take(limits.file_bytes.saturating_add(1)).read_to_end(&mut bytes).map_err(fail)?;
    if bytes.len() as u64 > limits.file_bytes {
        return Err(too_long(bytes.len() as u64));
    }
    if gzip::is_packed(&bytes) { gzip::unpack(&bytes, name, limits) } else { Ok(bytes) }
}
