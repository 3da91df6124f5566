//! Accessors: typed arrays in buffer views. Every range is checked before the first byte is read.
use durer_scene::counted;
use rayon::prelude::*;

use super::{
    buffer::Buffers,
    document::Document,
    element::{Checked, Element},
};

/// Fewer elements than this are not worth another thread.
const AT_ONCE: usize = 1 << 14;

/// The type of one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    fn parse(element: &Element<'_>) -> Checked<Self> {
        Ok(match element.index()? {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            other => {
                let message = format!("expected 5120, 5121, 5122, 5123, 5125 or 5126, found {other}");
                return Err(element.fault(message));
            }
        })
    }
    pub(super) const fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }
    /// Appends a number as files hold it, the nearest that there is.
    pub(super) fn put(self, value: f32, bytes: &mut Vec<u8>) {
        match self {
            Self::I8 => bytes.extend((value as i8).to_le_bytes()),
            Self::I16 => bytes.extend((value as i16).to_le_bytes()),
            Self::F32 => bytes.extend(value.to_le_bytes()),
            Self::U8 | Self::U16 | Self::U32 => self.put_index(value as u32, bytes),
        }
    }
    /// The same of a whole number.
    pub(super) fn put_index(self, value: u32, bytes: &mut Vec<u8>) {
        match self {
            Self::U8 => bytes.push(u8::try_from(value).unwrap_or(u8::MAX)),
            Self::U16 => bytes.extend(u16::try_from(value).unwrap_or(u16::MAX).to_le_bytes()),
            Self::U32 => bytes.extend(value.to_le_bytes()),
            Self::I8 | Self::I16 | Self::F32 => self.put(value as f32, bytes),
        }
    }
}

/// What an accessor says that it holds, wherever that is.
pub(super) struct Announced<'a> {
    /// Where it is described.
    pub(super) element: Element<'a>,
    /// Number of elements.
    pub(super) count: usize,
    /// The type of its numbers.
    pub(super) component: Component,
    columns: usize,
    rows: usize,
}

impl<'a> Announced<'a> {
    /// What `element` says.
    pub(super) fn read(element: Element<'a>) -> Checked<Self> {
        let component = Component::parse(&element.required("componentType")?)?;
        let shape = element.required("type")?;
        let (columns, rows) = match shape.text()? {
            "SCALAR" => (1, 1),
            "VEC2" => (1, 2),
            "VEC3" => (1, 3),
            "VEC4" => (1, 4),
            "MAT2" => (2, 2),
            "MAT3" => (3, 3),
            "MAT4" => (4, 4),
            other => {
                let message =
                    format!("expected SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3 or MAT4, found \"{other}\"");
                return Err(shape.fault(message));
            }
        };
        let count = element.required("count")?.index()?;
        Ok(Self { element, count, component, columns, rows })
    }
    /// Bytes of an element.
    fn size(&self) -> usize {
        // The columns of a matrix begin at multiples of 4 bytes.
        let column = self.rows * self.component.size();
        if self.columns == 1 { column } else { self.columns * column.next_multiple_of(4) }
    }
    /// Bytes of all elements.
    pub(super) fn bytes(&self) -> u64 {
        (self.count as u64).saturating_mul(self.size() as u64)
    }
    /// Complains unless it says that it holds this.
    pub(super) fn expect(&self, count: usize, lanes: usize) -> Checked<()> {
        let own = self.columns * self.rows;
        if (self.count, own) == (count, lanes) {
            return Ok(());
        }
        let of = |count, lanes| format!("{} of {}", counted(count, "element"), counted(lanes, "number"));
        let message =
            format!("announces {}, but its Draco stream holds {}", of(self.count, own), of(count, lanes));
        Err(self.element.fault(message))
    }
}

/// Elements at equal distances.
#[derive(Clone, Copy)]
struct Strided<'b> {
    bytes: &'b [u8],
    stride: usize,
}

/// Elements that replace others.
struct Sparse<'b, 'a> {
    places: Strided<'b>,
    place_type: Component,
    count: usize,
    values: Strided<'b>,
    element: Element<'a>,
}

/// A typed array whose ranges were checked.
pub(super) struct Accessor<'b, 'a> {
    /// Where it is described.
    pub(super) element: Element<'a>,
    /// Number of elements.
    pub(super) count: usize,
    /// Numbers per element.
    pub(super) lanes: usize,
    component: Component,
    normalized: bool,
    base: Option<Strided<'b>>,
    sparse: Option<Sparse<'b, 'a>>,
}

/// `count` elements of `size` bytes in the view that the member `bufferView` of `from` names.
fn strided<'b, 'a>(
    document: &Document<'a>,
    buffers: &'b Buffers,
    from: &Element<'a>,
    count: usize,
    size: usize,
) -> Checked<Strided<'b>> {
    let reference = from.required("bufferView")?;
    let view = buffers.view(document, &reference)?;
    let start = from.index_or("byteOffset", 0)?;
    let stride = view.stride.unwrap_or(size);
    if stride < size {
        let message = format!("{stride} is less than the {} of an element", counted(size, "byte"));
        return Err(view.element.fault_at("byteStride", message));
    }
    let reach =
        count.saturating_sub(1).checked_mul(stride).and_then(|b| b.checked_add(size)?.checked_add(start));
    if reach.is_none_or(|reach| reach > view.length) {
        let (have, at) = (view.length, view.element.pointer());
        let message = format!(
            "{} of {} from byte {start} {} not fit {at}, which has {}",
            counted(count, "element"),
            counted(stride, "byte"),
            if count == 1 { "does" } else { "do" },
            counted(have, "byte")
        );
        return Err(from.fault(message));
    }
    Ok(Strided { bytes: view.bytes?.get(start..).unwrap_or_default(), stride })
}

impl<'b, 'a> Accessor<'b, 'a> {
    /// The accessor that `reference` names by index.
    pub(super) fn open(
        document: &Document<'a>,
        buffers: &'b Buffers,
        reference: &Element<'a>,
    ) -> Checked<Self> {
        Self::at(document, buffers, (document.item("accessors", reference)?, reference.index()?))
    }
    /// The accessor `element`, number `index`.
    pub(super) fn at(
        document: &Document<'a>,
        buffers: &'b Buffers,
        (element, index): (Element<'a>, usize),
    ) -> Checked<Self> {
        let announced = Announced::read(element)?;
        let size = announced.size();
        let Announced { element, count, component, columns, rows } = announced;
        let lanes = columns * rows;
        let column = buffers.column(index)?;
        // Strips are unpacked to triangles.
        let count = column.map_or(count, |bytes| bytes.len() / size);
        let base = match (column, element.get("bufferView")?) {
            (Some(bytes), _) => Some(Strided { bytes, stride: size }),
            (None, Some(_)) => Some(strided(document, buffers, &element, count, size)?),
            (None, None) => None,
        };
        let sparse = match element.get("sparse")? {
            Some(sparse) => Some(Sparse::open(document, buffers, sparse, count, size)?),
            None => None,
        };
        let normalized = element.flag("normalized")?;
        Ok(Self { element, count, lanes, component, normalized, base, sparse })
    }

    /// All elements, or those that `which` names, as floats; normalised integers become fractions of 1. The accessor
    /// must have `N` lanes.
    pub(super) fn floats<const N: usize>(
        &self,
        document: &Document<'a>,
        which: Option<&[u32]>,
    ) -> Checked<Vec<[f32; N]>> {
        let scale = |most: f32| if self.normalized { 1.0 / most } else { 1.0 };
        let (s8, s16) = (scale(127.0), scale(32767.0));
        let (u8s, u16s, u32s) = (scale(255.0), scale(65535.0), scale(u32::MAX as f32));
        // The most negative integer is a little less than -1 (glTF 2.0, section 3.6.2.2).
        let floor = if self.normalized { -1.0 } else { f32::MIN };
        let n = (document, which);
        match self.component {
            Component::I8 => self.gather(n, |[b]: [u8; 1]| (f32::from(b as i8) * s8).max(floor)),
            Component::U8 => self.gather(n, |[b]: [u8; 1]| f32::from(b) * u8s),
            Component::I16 => {
                self.gather(n, |b: [u8; 2]| (f32::from(i16::from_le_bytes(b)) * s16).max(floor))
            }
            Component::U16 => self.gather(n, |b: [u8; 2]| f32::from(u16::from_le_bytes(b)) * u16s),
            Component::U32 => self.gather(n, |b: [u8; 4]| u32::from_le_bytes(b) as f32 * u32s),
            Component::F32 => self.gather(n, f32::from_le_bytes),
        }
    }

    /// All numbers of scalars or vectors, one after another, as [`Self::floats`] reads them.
    pub(super) fn numbers(&self, document: &Document<'a>) -> Checked<Vec<f32>> {
        Ok(match self.lanes {
            1 => self.floats::<1>(document, None)?.into_flattened(),
            2 => self.floats::<2>(document, None)?.into_flattened(),
            3 => self.floats::<3>(document, None)?.into_flattened(),
            4 => self.floats::<4>(document, None)?.into_flattened(),
            _ => return Err(self.element.fault("expected scalars or vectors")),
        })
    }

    /// All elements, or those that `which` names, of an accessor that holds indices: into vertices or joints.
    pub(super) fn indices<const N: usize>(
        &self,
        document: &Document<'a>,
        which: Option<&[u32]>,
    ) -> Checked<Vec<[u32; N]>> {
        let n = (document, which);
        match self.component {
            Component::U8 => self.gather(n, |[b]: [u8; 1]| u32::from(b)),
            Component::U16 => self.gather(n, |b: [u8; 2]| u32::from(u16::from_le_bytes(b))),
            Component::U32 => self.gather(n, u32::from_le_bytes),
            _ => Err(self.element.fault("indices must be unsigned integers")),
        }
    }
    /// The same numbers, read as fractions of 1 if they are integers.
    pub(super) fn into_fractions(self) -> Self {
        Self { normalized: true, ..self }
    }
    /// True if these are integers that stand for themselves.
    pub(super) fn holds_integers(&self) -> bool {
        self.component != Component::F32 && !self.normalized
    }

    fn gather<T: Copy + Default + Send + Sync, const N: usize, const S: usize>(
        &self,
        (document, which): (&Document<'a>, Option<&[u32]>),
        convert: impl Fn([u8; S]) -> T + Sync,
    ) -> Checked<Vec<[T; N]>> {
        if self.lanes != N {
            let message = format!("expected {} per element, found {}", counted(N, "number"), self.lanes);
            return Err(self.element.fault(message));
        }
        if let (Some(_), Some(which)) = (&self.sparse, which) {
            let all = self.gather((document, None), convert)?;
            return Ok(which.iter().filter_map(|&i| all.get(i as usize).copied()).collect());
        }
        let count = which.map_or(self.count, <[u32]>::len);
        document.spend(&self.element, count, N * size_of::<T>())?;
        let read = |source: Strided<'_>, i: usize| source.row(i).unwrap_or([[0; S]; N]).map(&convert);
        let mut rows: Vec<[T; N]> = match (self.base, which) {
            (None, _) => vec![[T::default(); N]; count],
            (Some(base), None) => {
                (0..self.count).into_par_iter().with_min_len(AT_ONCE).map(|i| read(base, i)).collect()
            }
            (Some(base), Some(which)) => {
                which.par_iter().with_min_len(AT_ONCE).map(|&i| read(base, i as usize)).collect()
            }
        };
        if let Some(sparse) = &self.sparse {
            for i in 0..sparse.count {
                let place = sparse.place(i);
                let Some(row) = rows.get_mut(place) else {
                    let message = format!("index {place} in a list of {}", counted(self.count, "element"));
                    return Err(sparse.element.fault(message));
                };
                *row = read(sparse.values, i);
            }
        }
        Ok(rows)
    }
}

impl Strided<'_> {
    /// Element `i` as `N` numbers of `S` bytes; `None` beyond the end.
    #[inline]
    fn row<const N: usize, const S: usize>(&self, i: usize) -> Option<[[u8; S]; N]> {
        let bytes = self.bytes.get(i * self.stride..)?.get(..N * S)?;
        bytes.as_chunks::<S>().0.first_chunk::<N>().copied()
    }
}

impl<'b, 'a> Sparse<'b, 'a> {
    fn open(
        document: &Document<'a>,
        buffers: &'b Buffers,
        element: Element<'a>,
        most: usize,
        size: usize,
    ) -> Checked<Self> {
        let count = element.required("count")?.index()?;
        if count > most {
            return Err(element.fault(format!("replaces {count} of {}", counted(most, "element"))));
        }
        let (indices, values) = (element.required("indices")?, element.required("values")?);
        let kind = indices.required("componentType")?;
        let place_type = Component::parse(&kind)?;
        if !matches!(place_type, Component::U8 | Component::U16 | Component::U32) {
            return Err(kind.fault("indices must be unsigned integers"));
        }
        let places = strided(document, buffers, &indices, count, place_type.size())?;
        let values = strided(document, buffers, &values, count, size)?;
        Ok(Self { places, place_type, count, values, element: indices })
    }
    fn place(&self, i: usize) -> usize {
        match self.place_type {
            Component::U8 => self.places.row::<1, 1>(i).map_or(0, |[[b]]| usize::from(b)),
            Component::U16 => self.places.row::<1, 2>(i).map_or(0, |[b]| usize::from(u16::from_le_bytes(b))),
            _ => self.places.row::<1, 4>(i).map_or(0, |[b]| u32::from_le_bytes(b) as usize),
        }
    }
}
