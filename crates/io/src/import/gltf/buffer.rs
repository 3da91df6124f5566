//! Buffers: the binary chunk of a GLB, `data:` URIs and files; and views into them.
use std::{borrow::Cow, ops::Range, sync::Arc};

use base64::{
    Engine, alphabet,
    engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig},
};
use durer_scene::{AssetError, Assets, counted};
use percent_encoding::percent_decode_str;
use rayon::prelude::*;

use super::{
    accessor::Accessor,
    document::{Document, only},
    draco::{self, Columns},
    element::{Checked, Element, Fault},
    meshopt::{self, Packed},
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

/// The binary chunk of a GLB.
#[derive(Clone, Debug)]
pub(super) struct Chunk {
    /// The whole file.
    pub(super) bytes: Arc<Vec<u8>>,
    /// Where the chunk is.
    pub(super) range: Range<usize>,
}

#[derive(Debug)]
enum Bytes {
    Chunk(Chunk),
    Owned(Vec<u8>),
    File(Arc<[u8]>),
}

impl Bytes {
    fn as_slice(&self) -> &[u8] {
        match self {
            Self::Chunk(chunk) => chunk.bytes.get(chunk.range.clone()).unwrap_or_default(),
            Self::Owned(bytes) => bytes,
            Self::File(bytes) => bytes,
        }
    }
}

/// All buffers of a document. One whose bytes are not there is complained about when it is used.
#[derive(Debug)]
pub(super) struct Buffers {
    list: Vec<Checked<Bytes>>,
    /// By buffer view: what those unpack to that are packed.
    unpacked: Vec<Option<Checked<Vec<u8>>>>,
    /// By accessor: what those hold that are packed together with others.
    columns: Columns,
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

impl Buffers {
    /// Loads every buffer; `bin` is the binary chunk.
    pub(super) fn load(document: &Document<'_>, bin: Option<&Chunk>, assets: &FileAssets) -> Checked<Self> {
        let buffers = document.root.list("buffers")?.into_par_iter().enumerate();
        let load = |(index, element)| load(&element, bin.filter(|_| index == 0), assets);
        let loaded: Vec<_> = buffers.map(load).collect();
        let list = loaded.into_iter().collect::<Checked<_>>()?;
        let mut buffers = Self { list, unpacked: Vec::new(), columns: Columns::new() };
        let views = document.root.list("bufferViews")?;
        buffers.unpacked = views.into_par_iter().map(|view| buffers.unpack(&view).transpose()).collect();
        buffers.columns = draco::unpack(document, &buffers)?;
        Ok(buffers)
    }
    /// All that an accessor holds, if it is packed together with others.
    pub(super) fn column(&self, accessor: usize) -> Checked<Option<&[u8]>> {
        self.columns.get(&accessor).map(|bytes| bytes.as_deref().map_err(Fault::clone)).transpose()
    }
    /// What a buffer view unpacks to, if it is packed.
    fn unpack(&self, view: &Element<'_>) -> Checked<Option<Vec<u8>>> {
        let Some(packed) = Packed::of(view)? else { return Ok(None) };
        let element = &packed.element;
        let buffer = element.required("buffer")?;
        let bytes = match self.list.get(buffer.index()?) {
            Some(Ok(bytes)) => bytes.as_slice(),
            Some(Err(fault)) => return Err(fault.clone()),
            None => return Err(buffer.fault(format!("there {}", only(self.list.len(), "buffers")))),
        };
        let start = element.index_or("byteOffset", 0)?;
        let size = element.required("byteLength")?.index()?;
        match bytes.get(start..start.saturating_add(size)) {
            Some(bytes) => packed.unpack(bytes).map(Some),
            None => {
                let have = counted(bytes.len(), "byte");
                Err(element.fault(format!("reaches beyond its buffer, which has {have}")))
            }
        }
    }
    /// Checks the ranges of all buffer views and accessors, used or not. That bytes are not there does not matter yet.
    pub(super) fn check(&self, document: &Document<'_>) -> Checked<()> {
        let matters = |fault: &Fault| !self.list.iter().flat_map(|b| b.as_ref().err()).any(|f| f == fault);
        for (index, view) in document.root.list("bufferViews")?.into_iter().enumerate() {
            document.keep_if(self.view_at(document, (view, index)), matters);
        }
        for (index, accessor) in document.root.list("accessors")?.into_iter().enumerate() {
            document.keep_if(Accessor::at(document, self, (accessor, index)), matters);
        }
        Ok(())
    }
    /// Bytes of all buffers together.
    pub(super) fn total(&self) -> u64 {
        let unpacked = self.unpacked.iter().flatten().chain(self.columns.values());
        let unpacked = unpacked.flatten().map(|bytes| bytes.len() as u64);
        self.list.iter().flatten().map(|b| b.as_slice().len() as u64).chain(unpacked).sum()
    }
    /// Warns about buffers that could not be loaded, which nobody has used, or that would have been complained about.
    pub(super) fn warn_of_unused(&self, document: &Document<'_>) -> Checked<()> {
        for (element, loaded) in document.root.list("buffers")?.iter().zip(&self.list) {
            if stands_in(element)? {
                continue;
            }
            if let (Err(fault), false) = (loaded, document.has_errors()) {
                document.warn(element, format!("{}; nothing uses this buffer", fault.message));
            }
        }
        Ok(())
    }
    /// The buffer view that `reference` names by index.
    pub(super) fn view<'b, 'a>(
        &'b self,
        document: &Document<'a>,
        reference: &Element<'a>,
    ) -> Checked<View<'b, 'a>> {
        self.view_at(document, (document.item("bufferViews", reference)?, reference.index()?))
    }
    fn view_at<'b, 'a>(
        &'b self,
        document: &Document<'a>,
        (element, index): (Element<'a>, usize),
    ) -> Checked<View<'b, 'a>> {
        let stride = element.get("byteStride")?.map(|s| s.index()).transpose()?;
        if let Some(Some(unpacked)) = self.unpacked.get(index) {
            let length = Packed::of(&element)?.map_or(0, |packed| packed.length());
            let bytes = unpacked.as_ref().map(Vec::as_slice).map_err(Fault::clone);
            return match bytes {
                Ok(bytes) => Ok(View { bytes: Ok(bytes), length, stride, element }),
                Err(fault) => Err(fault),
            };
        }
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
        let bytes = bytes.map(|bytes| bytes.get(start..reach).unwrap_or_default());
        Ok(View { bytes, length: size, stride, element })
    }
}

/// Whether a buffer is there for programs alone that cannot unpack: it may have no bytes.
fn stands_in(buffer: &Element<'_>) -> Checked<bool> {
    for name in meshopt::NAMES {
        if let Some(extension) = buffer.extension(name)?
            && extension.flag("fallback")?
        {
            return Ok(true);
        }
    }
    Ok(false)
}

/// The bytes of a buffer, or why they are not there: that is a fault only of those who use them.
///
/// # Errors
/// If what is there is wrong.
fn load(element: &Element<'_>, bin: Option<&Chunk>, assets: &FileAssets) -> Checked<Checked<Bytes>> {
    let length = element.required("byteLength")?;
    let wanted = length.index()?;
    let bytes = match element.get("uri")? {
        None => {
            let missing = "expected \"uri\" or, for the first buffer of a .glb file, a binary chunk";
            match bin {
                Some(bin) => Bytes::Chunk(bin.clone()),
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
