//! Files that a document names or holds: pictures and luminaires.
use super::{
    buffer::{Buffers, Uri, parse_uri},
    document::Document,
    element::{Checked, Element},
};
use crate::FileAssets;

/// The name under which the file is known that `element` describes by "uri" or "bufferView"; `embedded` if the document
/// holds it.
pub(super) fn file(
    (document, buffers): (&Document<'_>, &Buffers),
    assets: &mut FileAssets,
    element: &Element<'_>,
    embedded: String,
) -> Checked<String> {
    let bytes = match element.get("uri")? {
        Some(uri) => match parse_uri(&uri)? {
            Uri::Path(path) => return Ok(path.into_owned()),
            Uri::Data(bytes) => bytes,
        },
        None => buffers.view(document, &element.required("bufferView")?)?.bytes?.to_vec(),
    };
    assets.insert(embedded.clone(), bytes);
    Ok(embedded)
}
