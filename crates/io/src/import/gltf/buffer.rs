//! Buffers: the binary chunk of a GLB, `data:` URIs and files; and views into them.
use std::{borrow::Cow, sync::Arc};

use base64::{
    Engine, alphabet,
    engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig},
};
use durer_scene::{AssetError, Assets, counted};
use percent_encoding::percent_decode_str;
use rayon::prelude::*;

use super::{
    accessor::Accessor,
    document::Document,
    element::{Checked, Element, Fault},
};
use crate::FileAssets;

/// Padding is often forgotten.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &alphabet::STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// What a URI says.
pub(super) enum Uri<'a> {
    /// The bytes are in the URI itself.
    Data(Vec<u8>),
    /// A path relative to the scene file.
    Path(Cow<'a, str>),
}

/// Reads a URI: `data:` is decoded, percent signs are resolved.
pub(super) fn parse_uri<'a>(element: &Element<'a>) -> Checked<Uri<'a>> {
    let uri = element.text()?;
    if uri.is_empty() {
        return Err(element.fault("an empty URI; expected a path beside the file or data:"));
    }
    let Some(rest) = uri.strip_prefix("data:") else {
        if uri.split_once("://").is_some() {
            return Err(
                element.fault("addresses of the web are not followed; expected a path beside the file")
            );
        }
        let path = percent_decode_str(uri).decode_utf8();
        return path.map(Uri::Path).map_err(|_| element.fault("the percent-encoded path is not UTF-8"));
    };
    let (kind, data) = rest.split_once(',').ok_or_else(|| element.fault("a data: URI without comma"))?;
    if !kind.ends_with(";base64") {
        return Ok(Uri::Data(percent_decode_str(data).collect()));
    }
    let bytes = BASE64.decode(data).map_err(|e| element.fault(format!("not valid base64: {e}")))?;
    Ok(Uri::Data(bytes))
}

enum Bytes<'a> {
    Chunk(&'a [u8]),
    Owned(Vec<u8>),
    File(Arc<[u8]>),
}

impl Bytes<'_> {
    fn as_slice(&self) -> &[u8] {
        match self {
            Self::Chunk(bytes) => bytes,
            Self::Owned(bytes) => bytes,
            Self::File(bytes) => bytes,
        }
    }
}

/// All buffers of a document. One whose bytes are not there is complained about when it is used.
pub(super) struct Buffers<'a> {
    list: Vec<Checked<Bytes<'a>>>,
}

/// A stretch of a buffer.
#[derive(Clone)]
pub(super) struct View<'b, 'a> {
    /// The stretch, or why it is not there.
    pub(super) bytes: Checked<&'b [u8]>,
    /// How long it is, there or not.
    pub(super) length: usize,
    /// Bytes from one element to the next, if the file says so.
    pub(super) stride: Option<usize>,
    /// Where it is described.
    pub(super) element: Element<'a>,
}

impl<'a> Buffers<'a> {
    /// Loads every buffer; `bin` is the binary chunk.
    pub(super) fn load(document: &Document<'a>, bin: Option<&'a [u8]>, assets: &FileAssets) -> Checked<Self> {
        let buffers = document.root.list("buffers")?.into_par_iter().enumerate();
        let load = |(index, element)| load(&element, bin.filter(|_| index == 0), assets);
        let loaded: Vec<_> = buffers.map(load).collect();
        Ok(Self { list: loaded.into_iter().collect::<Checked<_>>()? })
    }
    /// Checks the ranges of all buffer views and accessors, used or not. That bytes are not there does not matter yet.
    pub(super) fn check(&self, document: &Document<'a>) -> Checked<()> {
        let matters = |fault: &Fault| !self.list.iter().flat_map(|b| b.as_ref().err()).any(|f| f == fault);
        for view in document.root.list("bufferViews")? {
            document.keep_if(self.view_at(document, view), matters);
        }
        for accessor in document.root.list("accessors")? {
            document.keep_if(Accessor::at(document, self, accessor), matters);
        }
        Ok(())
    }
    /// Bytes of all buffers together.
    pub(super) fn total(&self) -> u64 {
        self.list.iter().flatten().map(|b| b.as_slice().len() as u64).sum()
    }
    /// Warns about buffers that could not be loaded, which nobody has used, or that would have been complained about.
    pub(super) fn warn_of_unused(&self, document: &Document<'a>) -> Checked<()> {
        for (element, loaded) in document.root.list("buffers")?.iter().zip(&self.list) {
            if let (Err(fault), false) = (loaded, document.has_errors()) {
                document.warn(element, format!("{}; nothing uses this buffer", fault.message));
            }
        }
        Ok(())
    }
    /// The buffer view that `reference` names by index.
    pub(super) fn view<'b>(
        &'b self,
        document: &Document<'a>,
        reference: &Element<'a>,
    ) -> Checked<View<'b, 'a>> {
        self.view_at(document, document.item("bufferViews", reference)?)
    }
    fn view_at<'b>(&'b self, document: &Document<'a>, element: Element<'a>) -> Checked<View<'b, 'a>> {
        let buffer = element.required("buffer")?;
        let described = document.item("buffers", &buffer)?;
        let bytes = match self.list.get(buffer.index()?) {
            Some(Ok(bytes)) => Ok(bytes.as_slice()),
            Some(Err(fault)) => Err(fault.clone()),
            None => Ok(&[][..]),
        };
        let whole = match &bytes {
            Ok(bytes) => bytes.len(),
            Err(_) => described.required("byteLength")?.index()?,
        };
        let start = element.index_or("byteOffset", 0)?;
        let size = element.required("byteLength")?.index()?;
        let reach = start.saturating_add(size);
        if reach > whole {
            return Err(element
                .fault(format!("reaches to byte {reach}, but the buffer has {}", counted(whole, "byte"))));
        }
        let stride = element.get("byteStride")?.map(|s| s.index()).transpose()?;
        let bytes = bytes.map(|bytes| bytes.get(start..reach).unwrap_or_default());
        Ok(View { bytes, length: size, stride, element })
    }
}

/// The bytes of a buffer, or why they are not there: that is a fault only of those who use them.
///
/// # Errors
/// If what is there is wrong.
fn load<'a>(
    element: &Element<'a>,
    bin: Option<&'a [u8]>,
    assets: &FileAssets,
) -> Checked<Checked<Bytes<'a>>> {
    let length = element.required("byteLength")?;
    let wanted = length.index()?;
    let bytes = match element.get("uri")? {
        None => {
            let missing = "expected \"uri\" or, for the first buffer of a .glb file, a binary chunk";
            match bin {
                Some(bin) => Bytes::Chunk(bin),
                None => return Ok(Err(element.fault(missing))),
            }
        }
        Some(uri) => match parse_uri(&uri)? {
            Uri::Data(bytes) => Bytes::Owned(bytes),
            Uri::Path(path) => match assets.bytes(&path) {
                Ok(bytes) => Bytes::File(bytes),
                Err(error) => {
                    let hint = assets.advice(&error);
                    let fault = Fault { hint, ..uri.fault(error.to_string()) };
                    return if matches!(error, AssetError::Missing { .. }) {
                        Ok(Err(fault))
                    } else {
                        Err(fault)
                    };
                }
            },
        },
    };
    let found = bytes.as_slice().len();
    if found < wanted {
        return Err(
            length.fault(format!("announces {}, but the buffer has {found}", counted(wanted, "byte")))
        );
    }
    Ok(Ok(bytes))
}
