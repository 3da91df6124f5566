//! Mode ATTRIBUTES: elements in blocks of up to 256; in each the differences from element to element, byte position by byte
//! position, in groups of 16 with 0, 1, 2, 4 or 8 bits each.
//!
//! Version 1 says for each byte position of a block how it is packed, and for each four bytes of an element, which it calls a
//! channel, whether their differences are of bytes, of 16 bits, or bits of 32 that change.
use super::Stream;

/// Elements of a group.
const GROUP: usize = 16;
/// Most bytes of a block, unpacked.
const BLOCK_BYTES: usize = 8192;
const BLOCK_ELEMENTS: usize = 256;
/// The first element and, in version 1, the kinds of its channels stand at the end, behind as many zeros as it takes to make
/// this many bytes in either version.
const LEAST_TAIL: [usize; 2] = [32, 24];
/// Bytes of a channel.
const CHANNEL: usize = 4;

/// How the differences of a channel are meant.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Channel {
    /// Of whole numbers of so many bytes, the sign in the lowest bit.
    Numbers(usize),
    /// Bits that change in 32, turned so far to the right.
    Bits(u32),
}

impl Channel {
    fn of(byte: u8) -> Result<Self, &'static str> {
        match byte & 3 {
            0 => Ok(Self::Numbers(1)),
            1 => Ok(Self::Numbers(2)),
            2 => Ok(Self::Bits(u32::from(byte >> 4))),
            _ => Err("it has a channel of no kind"),
        }
    }
    /// The bytes of a number.
    fn size(self) -> usize {
        match self {
            Self::Numbers(size) => size,
            Self::Bits(_) => 4,
        }
    }
    /// What comes after `last` by this difference.
    fn next(self, last: u32, difference: u32) -> u32 {
        match self {
            Self::Numbers(_) => last.wrapping_add((difference >> 1) ^ (difference & 1).wrapping_neg()),
            Self::Bits(turned) => last ^ difference.rotate_right(turned),
        }
    }
}

/// `count` elements of `stride` bytes.
pub(super) fn unpack(bytes: &[u8], count: usize, stride: usize) -> Result<Vec<u8>, &'static str> {
    const SHORT: &str = "it ends too early";
    let version = match bytes.first().ok_or(SHORT)? {
        0xa0 => 0,
        0xa1 => 1,
        _ => return Err("it does not begin as attributes do"),
    };
    let kinds = stride / CHANNEL * version;
    let tail = bytes.len().checked_sub(stride + kinds).and_then(|at| bytes.get(at..)).ok_or(SHORT)?;
    let (first, kinds) = tail.split_at_checked(stride).ok_or(SHORT)?;
    let channels = match version {
        0 => Ok(vec![Channel::Numbers(1); stride / CHANNEL]),
        _ => kinds.iter().map(|byte| Channel::of(*byte)).collect(),
    }?;
    let least = LEAST_TAIL.get(version).copied().unwrap_or_default();
    let body = bytes.len().checked_sub(tail.len().max(least)).ok_or(SHORT)?;
    let mut stream = Stream(bytes.get(1..body).ok_or(SHORT)?);
    let mut last = first.to_vec();
    let most = ((BLOCK_BYTES / stride) & !(GROUP - 1)).clamp(GROUP, BLOCK_ELEMENTS);
    let mut all = Vec::new();
    let mut left = count;
    while left > 0 {
        let here = left.min(most);
        let columns = match version {
            0 => (0..stride).map(|_| column(&mut stream, here, [0, 2, 4, 8])).collect(),
            _ => columns(&mut stream, here, stride),
        }?;
        join(&columns, &channels, (here, &mut last), &mut all);
        left -= here;
    }
    if stream.0.is_empty() { Ok(all) } else { Err("something stands behind its end") }
}

/// The differences of a block at each byte position, which say how they are packed.
fn columns(stream: &mut Stream<'_>, count: usize, stride: usize) -> Result<Vec<Vec<u8>>, &'static str> {
    let ways = stream.take(stride / CHANNEL)?;
    let of = |position: usize| {
        let way = ways.get(position / CHANNEL).map_or(0, |w| (w >> (2 * (position % CHANNEL))) & 3);
        match way {
            0 => column(stream, count, [0, 1, 2, 4]),
            1 => column(stream, count, [1, 2, 4, 8]),
            2 => Ok(vec![0; count]),
            _ => Ok(stream.take(count)?.to_vec()),
        }
    };
    (0..stride).map(of).collect()
}

/// The differences at a byte position, group by group, each with one of four numbers of bits.
fn column(stream: &mut Stream<'_>, count: usize, bits: [u8; 4]) -> Result<Vec<u8>, &'static str> {
    let groups = count.div_ceil(GROUP);
    let widths = stream.take(groups.div_ceil(4))?;
    let mut column = Vec::with_capacity(groups * GROUP);
    for group in 0..groups {
        let width = widths.get(group / 4).map_or(0, |w| (w >> (2 * (group % 4))) & 3);
        let bits = bits.get(usize::from(width)).copied().unwrap_or_default();
        differences(stream, bits.into(), &mut column)?;
    }
    Ok(column)
}

/// Appends a block of `count` elements, of which `last` is the one before, then the last.
fn join(columns: &[Vec<u8>], channels: &[Channel], (count, last): (usize, &mut [u8]), all: &mut Vec<u8>) {
    let (start, stride) = (all.len(), last.len());
    all.resize(start + count * stride, 0);
    let rows = all.get_mut(start..).unwrap_or_default();
    let whole = |bytes: &mut dyn DoubleEndedIterator<Item = u8>| {
        bytes.rev().fold(0u32, |sum, byte| sum << 8 | u32::from(byte))
    };
    let numbers = channels.iter().enumerate().flat_map(|(i, channel)| {
        (0..CHANNEL).step_by(channel.size()).map(move |at| (*channel, CHANNEL * i + at))
    });
    for (channel, position) in numbers {
        let places = position..position + channel.size();
        let (Some(own), Some(last)) = (columns.get(places.clone()), last.get_mut(places.clone())) else {
            continue;
        };
        let mut value = whole(&mut last.iter().copied());
        for (row, element) in rows.chunks_mut(stride).enumerate() {
            let difference = whole(&mut own.iter().map(|c| c.get(row).copied().unwrap_or_default()));
            value = channel.next(value, difference);
            let bytes = element.get_mut(places.clone()).unwrap_or_default().iter_mut();
            bytes.zip(value.to_le_bytes()).for_each(|(place, byte)| *place = byte);
        }
        last.iter_mut().zip(value.to_le_bytes()).for_each(|(place, byte)| *place = byte);
    }
}

/// Appends the differences of a group, of so many bits. Those that do not fit stand behind as bytes.
fn differences(stream: &mut Stream<'_>, bits: usize, column: &mut Vec<u8>) -> Result<(), &'static str> {
    let start = column.len();
    match bits {
        0 => {
            column.resize(start + GROUP, 0);
            return Ok(());
        }
        8 => {
            column.extend_from_slice(stream.take(GROUP)?);
            return Ok(());
        }
        _ => {}
    }
    let most = (1 << bits) - 1;
    for packed in stream.take(GROUP * bits / 8)? {
        // Single bits stand in it from the lowest on, others from the highest.
        let packed = if bits == 1 { packed.reverse_bits() } else { *packed };
        for place in (0..8 / bits).rev() {
            column.push((packed >> (place * bits)) & most);
        }
    }
    for value in column.get_mut(start..).unwrap_or_default() {
        if *value == most {
            *value = stream.byte()?;
        }
    }
    Ok(())
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that fails may panic")]
mod tests {
    use base64::{Engine, engine::general_purpose::STANDARD};

    use super::*;

    /// What [`elements`] gives, packed by meshoptimizer (version 1, level 3): bytes in the first and the third channel, bits
    /// that change, turned by 2, in the second.
    const BITS: &str = "oZvqGQBKSn1KSn1KSn1KfUpKfUpKfUp9Skp9Skp9Skp9Sn1KSn1KSn1KfUpKfUpKfUp9Skp9Skp9Skp9Sn1KSn1KSn1KfUpKfUpKfUp9Skp9Skp9Skp9Sn1KSn1KSn1KfUpKfUpKfUp9Skp9Skp9Skp9Sn1KSn1KSn1KfUpKfUpKfUpKfUp9Skp9Skp9Sn1KSn1KSn1KfUpKfUpKfUpKfUp9Skp9Skp9Sn1KSn1KSn1KfUpKfUpKfUpKfUp9Skp9Skp9Sn1KSn1KSn1KfUpKfUpKfUpKfUp9Skp9Skp9Sn1KSn1KSn1KSn1KfUpKfUpKfUp9Skp9Skp9Sn1KSn1KSn1KSn0AAAAAAAICBAgCAhAgAgJAgAICAAECAgQCAggQAgIgQAICgAACAQICAgQIAgIQIAICQIACAgABAgIEAgIIEAICACGjwQfEoSMhp8QBw6EnJKHDAcekISOhxwTBoyEnpMEDwackIaPBB8ShIyGnxAHDoSckocMBx6QhI6HHBMGjISekwQPBpyQho8EHxKEjIafEAcOhJyShwwHHpCEjoccEwaMhJ6TBA8GnJCGjwQfEoSMhp8QBw6EnJKHDAcekISOhxwTBoyEnpMEDwackIaPBB8ShIyGnxAHDoSckocMBx6QhI6HHBMGjISekwQPBpyQho8EHxKEjIafEAcOhJyShwwHHpCEjoccEwaMhJ6TBA8GnJCGjwQfEoSMhp8QBw6EnJKHDAcekISOhxwTBoyEnpMEDwackIaPBB8ShIyGnxFVVVVUmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmZmVVVVVQiIiIiIiIiIiIiIiIiIiIiIiIiIiIiIiIiIiIiIiIiIiIiIiIiIiIiIiIiIiIiIiIiIiIiIiIiIiIiIiIiIiIgEAAAAMABvcJvqmUp9Skp9Skp9Sn1KSn1KSn1KfUpKfUpKfUpKfUp9Skp9Skp9Sn1KSn1KSn1KACBAAgKAAAIBAgICAcOhJyShwwHHpCEjoccEwaMhJ6TBA8GnJCGjwQfEoSMhp8QBw6EnJKHDAccVZmZmZmZmZmZmZmYAFYiIiIiIiIiIiIiIAAAAAAAAAAAAAAAAAAAAAIA/AAMAAAAiAA==";

    fn elements() -> Vec<u8> {
        let element = |i: u32| {
            let bits = ((i * i % 7) << 27) ^ ((i % 5) << 22) ^ 0x3f80_0000;
            let bytes = [i % 2, 3, i / 2, if i == 20 { 200 } else { 0 }].map(|v| v as u8);
            let words = [i * 37 % 100, i / 9].map(|v| (v as u16).to_le_bytes());
            [words.as_flattened(), &bits.to_le_bytes(), &bytes].concat()
        };
        (0..300).flat_map(element).collect()
    }

    #[test]
    fn bits_that_change_are_those_that_were_packed() {
        let packed = STANDARD.decode(BITS).unwrap();
        assert_eq!(unpack(&packed, 300, 12).unwrap(), elements());
    }

    #[test]
    fn damaged_streams_of_version_1_are_told() {
        let good = STANDARD.decode(BITS).unwrap();
        let last = good.len() - 1;
        let mut wrong = good.clone();
        *wrong.get_mut(last).unwrap() = 3;
        assert_eq!(unpack(&wrong, 300, 12).unwrap_err(), "it has a channel of no kind");
        assert_eq!(unpack(&good, 256, 12).unwrap_err(), "something stands behind its end");
        assert_eq!(unpack(&good, u32::MAX as usize, 12).unwrap_err(), "it ends too early");
        for place in 0..good.len() {
            let mut other = good.clone();
            *other.get_mut(place).unwrap() ^= 0x5a;
            drop(unpack(&other, 300, 12));
            assert!(unpack(good.get(..place).unwrap(), 300, 12).is_err());
        }
    }
}
