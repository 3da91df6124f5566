//! Values as OpenVDB packs them: by zlib, or by Blosc, which shuffles the bytes of numbers and packs them with LZ4.
use std::io::Read;

use flate2::read::ZlibDecoder;

use super::bytes::{Bytes, Mask, Why};

/// How the values of a grid are packed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Packing {
    pub(super) zlib: bool,
    pub(super) blosc: bool,
    /// Inactive values are left out.
    pub(super) active_only: bool,
    /// Numbers are half floats.
    pub(super) half: bool,
}

/// What is said of inactive values that are left out.
mod inactive {
    pub(super) const BACKGROUND: u8 = 0;
    pub(super) const MINUS_BACKGROUND: u8 = 1;
    pub(super) const ONE: u8 = 2;
    pub(super) const MASK: u8 = 3;
    pub(super) const MASK_AND_ONE: u8 = 4;
    pub(super) const MASK_AND_TWO: u8 = 5;
    pub(super) const ALL: u8 = 6;
}

impl Packing {
    /// The values of a node of `count` of them, of which those of `active` are active.
    pub(super) fn values(
        self,
        bytes: &mut Bytes<'_>,
        (count, active): (usize, Mask<'_>),
        background: f32,
    ) -> Result<Vec<f32>, Why> {
        let said = bytes.u8()?;
        let mut others = match said {
            inactive::MINUS_BACKGROUND => [-background, background],
            inactive::MASK => [-background, background],
            inactive::BACKGROUND..=inactive::ALL => [background, background],
            other => return Err(Why::Damaged(format!("a node says {other} of its values, expected 0 to 6"))),
        };
        if let inactive::ONE | inactive::MASK_AND_ONE | inactive::MASK_AND_TWO = said {
            others = [bytes.f32()?, background];
        }
        if said == inactive::MASK_AND_TWO {
            others = [others[0], bytes.f32()?];
        }
        let chosen = match said {
            inactive::MASK | inactive::MASK_AND_ONE | inactive::MASK_AND_TWO => {
                Some(Mask::read(bytes, count)?)
            }
            _ => None,
        };
        if !self.active_only || said == inactive::ALL {
            return self.numbers(bytes, count);
        }
        let mut there = self.numbers(bytes, active.count())?.into_iter();
        let [first, second] = others;
        let value = |i| match active.is_on(i) {
            true => there.next().unwrap_or(background),
            false if chosen.is_some_and(|mask| mask.is_on(i)) => second,
            false => first,
        };
        Ok((0..count).map(value).collect())
    }

    fn numbers(self, bytes: &mut Bytes<'_>, count: usize) -> Result<Vec<f32>, Why> {
        let size = if self.half { 2 } else { 4 };
        let plain = self.unpacked(bytes, count * size)?;
        Ok(match self.half {
            true => plain.as_chunks::<2>().0.iter().map(|b| half(u16::from_le_bytes(*b))).collect(),
            false => plain.as_chunks::<4>().0.iter().map(|b| f32::from_le_bytes(*b)).collect(),
        })
    }

    /// As many bytes, unpacked.
    fn unpacked(self, bytes: &mut Bytes<'_>, length: usize) -> Result<Vec<u8>, Why> {
        if !self.zlib && !self.blosc {
            return bytes.take(length).map(<[u8]>::to_vec);
        }
        // A length of 0 or less says that nothing is packed.
        let packed = bytes.i64()?;
        let there = usize::try_from(packed.unsigned_abs())
            .map_err(|_| Why::Damaged("values are longer than memory".to_owned()))?;
        let there = bytes.take(there)?;
        let plain = match packed {
            ..=0 => there.to_vec(),
            _ if self.blosc => blosc(there, length)?,
            _ => {
                let mut plain = Vec::with_capacity(length);
                let most = length as u64 + 1;
                let read = ZlibDecoder::new(there).take(most).read_to_end(&mut plain);
                read.map_err(|e| Why::Damaged(format!("values packed by zlib are damaged ({e})")))?;
                plain
            }
        };
        if plain.len() != length {
            let found = plain.len();
            return Err(Why::Damaged(format!("values unpack to {found} bytes, expected {length}")));
        }
        Ok(plain)
    }
}

/// A half float (IEEE 754 binary16).
fn half(bits: u16) -> f32 {
    let (sign, exponent, mantissa) = (bits >> 15, (bits >> 10) & 31, f32::from(bits & 1023));
    let magnitude = match exponent {
        0 => mantissa * 2f32.powi(-24),
        31 => f32::INFINITY,
        _ => (1.0 + mantissa / 1024.0) * 2f32.powi(i32::from(exponent) - 15),
    };
    if sign == 1 { -magnitude } else { magnitude }
}

/// A chunk of Blosc 1 that holds `length` bytes.
fn blosc(chunk: &[u8], length: usize) -> Result<Vec<u8>, Why> {
    let damaged = |what: &str| Why::Damaged(format!("values packed by Blosc are damaged: {what}"));
    let mut head = Bytes::new(chunk);
    head.skip(2)?;
    let (flags, typesize) = (head.u8()?, usize::from(head.u8()?).max(1));
    let [plain_length, block_length, _] = [head.u32()?, head.u32()?, head.u32()?].map(|n| n as usize);
    if plain_length != length || (block_length == 0 && length > 0) {
        return Err(damaged("the lengths do not fit"));
    }
    let (is_shuffled, is_plain, by_bits, is_whole) =
        (flags & 1 != 0, flags & 2 != 0, flags & 4 != 0, flags & 16 != 0);
    if is_plain {
        return head.take(length).map(<[u8]>::to_vec);
    }
    if by_bits || flags >> 5 != 1 {
        let codec = ["BloscLZ", "LZ4", "Snappy", "zlib", "Zstandard"].get(usize::from(flags >> 5));
        let how = if by_bits { "shuffled bits" } else { codec.unwrap_or(&"an unknown codec") };
        return Err(Why::Refused(format!("values packed by Blosc with {how}; LZ4 is read")));
    }
    let count = length.div_ceil(block_length.max(1));
    let mut starts = Vec::new();
    for _ in 0..count {
        starts.push(head.u32()?);
    }
    let mut all = Vec::with_capacity(length);
    for (index, start) in starts.into_iter().enumerate() {
        let whole = index + 1 < count || length.is_multiple_of(block_length);
        let own = if whole { block_length } else { length % block_length };
        let parts =
            if !is_whole && whole && typesize <= 16 && block_length / typesize >= 128 { typesize } else { 1 };
        let mut from = Bytes::new(chunk);
        from.jump(u64::from(start))?;
        let mut block = Vec::with_capacity(own);
        for _ in 0..parts {
            let part = own / parts;
            let packed = from.u32()? as usize;
            let packed = from.take(packed)?;
            if packed.len() == part {
                block.extend_from_slice(packed);
                continue;
            }
            let plain = lz4_flex::block::decompress(packed, part).map_err(|e| damaged(&e.to_string()))?;
            block.extend_from_slice(&plain);
        }
        if block.len() != own {
            return Err(damaged("a block is too short or too long"));
        }
        match is_shuffled && typesize > 1 {
            true => unshuffle(&block, typesize, &mut all),
            false => all.extend_from_slice(&block),
        }
    }
    Ok(all)
}

/// First bytes of all numbers, then second bytes, ...: back in order. What is left over at the end was not shuffled.
fn unshuffle(block: &[u8], typesize: usize, all: &mut Vec<u8>) {
    let count = block.len() / typesize;
    for number in 0..count {
        all.extend((0..typesize).filter_map(|byte| block.get(byte * count + number)));
    }
    all.extend_from_slice(block.get(count * typesize..).unwrap_or_default());
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_floats_are_those_of_ieee() {
        let known =
            [(0x3C00, 1.0), (0xC000, -2.0), (0x3555, 0.333_251_95), (1, 5.960_464_5e-8), (0x7BFF, 65504.0)];
        known.into_iter().for_each(|(bits, value)| assert_eq!(half(bits), value));
    }

    #[test]
    fn shuffled_bytes_come_back_in_order() {
        let mut all = Vec::new();
        unshuffle(&[1, 5, 2, 6, 3, 7, 4, 8, 9], 4, &mut all);
        assert_eq!(all, [1, 2, 3, 4, 5, 6, 7, 8, 9]);
    }
}
