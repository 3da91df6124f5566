//! KTX 2 pictures whose pixels are not packed by Basis Universal: files written by hand.
use std::io::Write;

use durer_io::image::read;
use durer_scene::{Image, ImageData, Limits};
use flate2::{Compression, write::ZlibEncoder};

/// A file of one level, after the specification's section 3.
fn file(format: u32, [width, height]: [u32; 2], scheme: u32, (stored, length): (&[u8], usize)) -> Vec<u8> {
    let mut bytes = b"\xabKTX 20\xbb\r\n\x1a\n".to_vec();
    [format, 1, width, height, 0, 0, 1, 1, scheme].iter().for_each(|v| bytes.extend(v.to_le_bytes()));
    bytes.resize(80, 0);
    let begin = 104;
    [begin, stored.len(), length].iter().for_each(|v| bytes.extend((*v as u64).to_le_bytes()));
    bytes.extend(stored);
    bytes
}

fn picture(format: u32, size: [u32; 2], pixels: &[u8]) -> Image {
    read(&file(format, size, 0, (pixels, pixels.len())), "a.ktx2", Limits::default())
        .expect("a sound picture")
}

#[test]
fn bytes_are_read_in_their_order() {
    let pixels: Vec<u8> = (0..24).collect();
    let rgb = picture(29, [4, 2], &pixels);
    assert_eq!((rgb.width, rgb.height, rgb.channels), (4, 2, 3));
    assert_eq!(rgb.data, ImageData::U8(pixels.clone()));
    let bgr = picture(30, [4, 2], &pixels);
    let ImageData::U8(swapped) = &bgr.data else { panic!("eight bits a channel") };
    assert_eq!(swapped[..6], [2, 1, 0, 5, 4, 3]);
    let bgra = picture(44, [3, 2], &pixels);
    let ImageData::U8(swapped) = &bgra.data else { panic!("eight bits a channel") };
    assert_eq!((bgra.channels, &swapped[4..8]), (4, &[6u8, 5, 4, 7][..]));
    assert_eq!(picture(9, [6, 4], &pixels).channels, 1);
    let two = picture(16, [6, 2], &pixels);
    let ImageData::U8(three) = &two.data else { panic!("eight bits a channel") };
    assert_eq!((two.channels, &three[..6]), (3, &[0u8, 1, 0, 2, 3, 0][..]));
}

#[test]
fn larger_numbers_are_read_as_they_are() {
    let words: Vec<u8> = [1u16, 256, 65_535].iter().flat_map(|v| v.to_le_bytes()).collect();
    assert_eq!(picture(84, [1, 1], &words).data, ImageData::U16(vec![1, 256, 65_535]));
    // 1, -2 and the smallest number above 0 of halves.
    let halves: Vec<u8> = [0x3c00u16, 0xc000, 1].iter().flat_map(|v| v.to_le_bytes()).collect();
    assert_eq!(picture(90, [1, 1], &halves).data, ImageData::F32(vec![1.0, -2.0, 2f32.powi(-24)]));
    let floats: Vec<u8> = [0.25f32, 1e9, -3.0, 1.0].iter().flat_map(|v| v.to_le_bytes()).collect();
    assert_eq!(picture(109, [1, 1], &floats).data, ImageData::F32(vec![0.25, 1e9, -3.0, 1.0]));
    // 1, 0.5 and 2 of 11, 11 and 10 bits; 1, 0.5 and 2 with the exponent of 2.
    let short = 15u32 << 6 | 14 << 6 << 11 | 16 << 5 << 22;
    assert_eq!(picture(122, [1, 1], &short.to_le_bytes()).data, ImageData::F32(vec![1.0, 0.5, 2.0]));
    let shared = 128u32 | 64 << 9 | 256 << 18 | 17 << 27;
    assert_eq!(picture(123, [1, 1], &shared.to_le_bytes()).data, ImageData::F32(vec![1.0, 0.5, 2.0]));
}

/// A stream of Zstandard whose blocks are as they are (RFC 8878, sections 3.1.1 and 3.1.1.2).
fn zstandard(bytes: &[u8]) -> Vec<u8> {
    let mut stream = 0xfd2f_b528u32.to_le_bytes().to_vec();
    // One segment of a length in two bytes, less 256.
    stream.push(0x60);
    stream.extend((bytes.len() as u16 - 256).to_le_bytes());
    let block = 1 | (bytes.len() as u32) << 3;
    stream.extend(&block.to_le_bytes()[..3]);
    stream.extend(bytes);
    stream
}

#[test]
fn packed_pixels_are_unpacked() {
    let pixels: Vec<u8> = (0..16 * 16 * 3).map(|i| (i % 251) as u8).collect();
    let mut zlib = ZlibEncoder::new(Vec::new(), Compression::best());
    zlib.write_all(&pixels).expect("in memory");
    for (scheme, stored) in [(2, zstandard(&pixels)), (3, zlib.finish().expect("in memory"))] {
        let bytes = file(29, [16, 16], scheme, (&stored, pixels.len()));
        let image = read(&bytes, "a.ktx2", Limits::default()).expect("a sound picture");
        assert_eq!(image.data, ImageData::U8(pixels.clone()), "{scheme}");
        // Cut anywhere, or with any byte another: a message or another picture, but no panic.
        for place in 0..bytes.len() {
            assert!(read(&bytes[..place], "a.ktx2", Limits::default()).is_err(), "{scheme} {place}");
            let mut other = bytes.clone();
            other[place] ^= 0x5a;
            let _ = read(&other, "a.ktx2", Limits::default());
        }
        // More than the header says.
        let long = file(29, [16, 15], scheme, (&stored, pixels.len()));
        let error = read(&long, "a.ktx2", Limits::default()).expect_err("too long").to_string();
        assert!(error.contains("not as long as its header says"), "{error}");
    }
}

#[test]
fn what_is_not_read_is_told_by_name() {
    let said = |format: u32, scheme: u32| {
        let bytes = file(format, [4, 4], scheme, (&[0; 48], 48));
        read(&bytes, "a.ktx2", Limits::default()).expect_err("not read").to_string()
    };
    for (format, name) in [(131, "BC1"), (143, "BC6H"), (146, "BC7"), (147, "ETC2"), (184, "ASTC")] {
        let error = said(format, 0);
        assert!(error.contains(&format!("packed as {name}")) && error.contains("PNG"), "{error}");
    }
    assert!(said(1000, 0).contains("rare format 1000"), "{}", said(1000, 0));
    assert!(said(29, 7).contains("supercompression 7"), "{}", said(29, 7));
    let huge = file(29, [60_000, 4000], 2, (&[0; 48], 48));
    let error = read(&huge, "a.ktx2", Limits::default()).expect_err("too large").to_string();
    assert!(error.contains("cannot be stored"), "{error}");
}
