//! glTF 2.0 and GLB.
use std::path::Path;

use super::Imported;

/// Reads the file at `path`.
pub(super) fn read(_path: &Path, _imported: &mut Imported) {}
