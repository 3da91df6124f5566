//! EXT_meshopt_compression and KHR_meshopt_compression: buffer views that are packed, by the specification's appendix A
//! (bitstream) and B (filters). What a stream unpacks to is bounded by its length: nothing is allocated on its word.
mod attributes;
mod filter;
mod indices;

use durer_scene::counted;

use super::element::{Checked, Element};

/// The names that the extension has, the newer one last.
pub(super) const NAMES: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];

/// How a buffer view is packed.
pub(super) struct Packed<'a> {
    /// The extension object.
    pub(super) element: Element<'a>,
    count: usize,
    stride: usize,
}

impl<'a> Packed<'a> {
    /// How `view` is packed, if it is.
    pub(super) fn of(view: &Element<'a>) -> Checked<Option<Self>> {
        let mut found = None;
        for name in NAMES {
            found = found.or(view.extension(name)?);
        }
        let Some(element) = found else { return Ok(None) };
        let (count, stride) = (element.required("count")?, element.required("byteStride")?);
        let (count, stride) = (count.index()?, stride.index()?);
        Ok(Some(Self { element, count, stride }))
    }

    /// How many bytes it unpacks to.
    pub(super) fn length(&self) -> usize {
        self.count.saturating_mul(self.stride)
    }

    /// What `bytes` unpack to.
    pub(super) fn unpack(&self, bytes: &[u8]) -> Checked<Vec<u8>> {
        let Self { element, count, stride } = self;
        let strides = |ok: bool, what: &str| match ok {
            true => Ok(()),
            false => Err(element.fault_at("byteStride", format!("expected {what}, found {stride}"))),
        };
        let mode = element.required("mode")?;
        let unpacked = match mode.text()? {
            "ATTRIBUTES" => {
                strides((1..=256).contains(stride) && stride % 4 == 0, "a multiple of 4 up to 256")?;
                attributes::unpack(bytes, *count, *stride)
            }
            "TRIANGLES" => {
                strides([2, 4].contains(stride), "2 or 4")?;
                indices::triangles(bytes, *count).map(|all| narrowed(&all, *stride))
            }
            "INDICES" => {
                strides([2, 4].contains(stride), "2 or 4")?;
                indices::sequence(bytes, *count).map(|all| narrowed(&all, *stride))
            }
            other => {
                let message = format!("expected ATTRIBUTES, TRIANGLES or INDICES, found \"{other}\"");
                return Err(mode.fault(message));
            }
        };
        let mut unpacked = unpacked.map_err(|why| {
            let (elements, found) = (counted(*count, "element"), counted(bytes.len(), "byte"));
            element.fault(format!("packed data is damaged: {why} ({elements} in {found})"))
        })?;
        match element.text_or("filter", "NONE")? {
            "NONE" => {}
            "OCTAHEDRAL" => {
                strides([4, 8].contains(stride), "4 or 8")?;
                filter::octahedral(&mut unpacked, *stride);
            }
            "QUATERNION" => {
                strides(*stride == 8, "8")?;
                filter::quaternion(&mut unpacked);
            }
            "EXPONENTIAL" => {
                strides(stride % 4 == 0, "a multiple of 4")?;
                filter::exponential(&mut unpacked);
            }
            "COLOR" => {
                strides([4, 8].contains(stride), "4 or 8")?;
                filter::color(&mut unpacked, *stride);
            }
            other => {
                let message =
                    format!("expected NONE, OCTAHEDRAL, QUATERNION, EXPONENTIAL or COLOR, found \"{other}\"");
                return Err(element.fault_at("filter", message));
            }
        }
        Ok(unpacked)
    }
}

/// Indices of 2 or 4 bytes.
fn narrowed(indices: &[u32], stride: usize) -> Vec<u8> {
    match stride {
        2 => indices.iter().flat_map(|i| (*i as u16).to_le_bytes()).collect(),
        _ => indices.iter().flat_map(|i| i.to_le_bytes()).collect(),
    }
}

/// A stream that is read from its start.
struct Stream<'b>(&'b [u8]);

impl<'b> Stream<'b> {
    fn take(&mut self, count: usize) -> Result<&'b [u8], &'static str> {
        let (head, rest) = self.0.split_at_checked(count).ok_or("it ends too early")?;
        self.0 = rest;
        Ok(head)
    }
    fn byte(&mut self) -> Result<u8, &'static str> {
        self.take(1).map(|byte| byte.first().copied().unwrap_or(0))
    }
    /// A number in groups of 7 bits, the lowest first.
    fn number(&mut self) -> Result<u32, &'static str> {
        let mut value = 0u32;
        for shift in [0, 7, 14, 21, 28] {
            let byte = self.byte()?;
            value |= u32::from(byte & 127) << shift;
            if byte < 128 {
                return Ok(value);
            }
        }
        Err("a number has more than 5 bytes")
    }
}

/// A number whose sign is its lowest bit.
fn signed(v: u32) -> u32 {
    (v >> 1) ^ (v & 1).wrapping_neg()
}
