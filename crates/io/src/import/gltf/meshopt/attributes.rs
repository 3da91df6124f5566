//! Mode ATTRIBUTES: elements in blocks of up to 256; in each the differences from element to element, byte position by byte
//! position, in groups of 16 with 0, 2, 4 or 8 bits each.
use super::Stream;

/// Elements of a group.
const GROUP: usize = 16;
/// Most bytes of a block, unpacked.
const BLOCK_BYTES: usize = 8192;
const BLOCK_ELEMENTS: usize = 256;
/// The first element stands at the end, behind as many zeros as it takes to make this many bytes.
const LEAST_TAIL: usize = 32;
/// Version 0 of the stream.
const HEADER: u8 = 0xa0;

/// `count` elements of `stride` bytes.
pub(super) fn unpack(bytes: &[u8], count: usize, stride: usize) -> Result<Vec<u8>, &'static str> {
    let tail = bytes.len().checked_sub(stride).and_then(|at| bytes.get(at..)).ok_or("it ends too early")?;
    let body = bytes.len().checked_sub(stride.max(LEAST_TAIL)).ok_or("it ends too early")?;
    let mut stream = Stream(bytes.get(..body).unwrap_or_default());
    match stream.byte()? {
        HEADER => {}
        0xa1 => {
            return Err("it is of version 1, which durer does not read: `gltf-transform copy` unpacks it");
        }
        _ => return Err("it does not begin as attributes do"),
    }
    let mut last = tail.to_vec();
    let most = ((BLOCK_BYTES / stride) & !(GROUP - 1)).clamp(GROUP, BLOCK_ELEMENTS);
    let mut all = Vec::new();
    let mut left = count;
    while left > 0 {
        let here = left.min(most);
        block(&mut stream, here, &mut last, &mut all)?;
        left -= here;
    }
    if stream.0.is_empty() { Ok(all) } else { Err("something stands behind its end") }
}

/// Appends a block of `count` elements, of which `last` is the one before, then the last.
fn block(
    stream: &mut Stream<'_>,
    count: usize,
    last: &mut [u8],
    all: &mut Vec<u8>,
) -> Result<(), &'static str> {
    let (start, stride) = (all.len(), last.len());
    let groups = count.div_ceil(GROUP);
    let mut columns = Vec::with_capacity(stride);
    for _ in 0..stride {
        let widths = stream.take(groups.div_ceil(4))?;
        let mut column = Vec::with_capacity(groups * GROUP);
        for group in 0..groups {
            let width = widths.get(group / 4).map_or(0, |w| (w >> (2 * (group % 4))) & 3);
            differences(stream, width, &mut column)?;
        }
        columns.push(column);
    }
    all.resize(start + count * stride, 0);
    let rows = all.get_mut(start..).unwrap_or_default();
    for (position, (column, value)) in columns.iter().zip(last).enumerate() {
        let places = rows.iter_mut().skip(position).step_by(stride);
        for (place, difference) in places.zip(column) {
            *value = value.wrapping_add((difference >> 1) ^ (difference & 1).wrapping_neg());
            *place = *value;
        }
    }
    Ok(())
}

/// Appends the differences of a group. Those that do not fit their bits stand behind as bytes.
fn differences(stream: &mut Stream<'_>, width: u8, column: &mut Vec<u8>) -> Result<(), &'static str> {
    let bits = match width {
        0 => {
            column.resize(column.len() + GROUP, 0);
            return Ok(());
        }
        1 => 2,
        2 => 4,
        _ => {
            column.extend_from_slice(stream.take(GROUP)?);
            return Ok(());
        }
    };
    let most = (1 << bits) - 1;
    for packed in stream.take(GROUP * bits / 8)? {
        for place in (0..8 / bits).rev() {
            let value = (packed >> (place * bits)) & most;
            column.push(value);
        }
    }
    let start = column.len() - GROUP;
    for value in column.get_mut(start..).unwrap_or_default() {
        if *value == most {
            *value = stream.byte()?;
        }
    }
    Ok(())
}
