//! Files that the test writes, and what is read of them.
#![allow(clippy::unwrap_used, clippy::indexing_slicing, reason = "a test that fails may panic")]
use std::io::Write;

use flate2::{Compression, write::ZlibEncoder};

use super::*;

/// Vertex `i` of mesh `m` stands at `(m, i, m + i)`.
fn body(version: u16, m: u32, double: bool, flags: u32) -> Vec<u8> {
    let mut raw = Vec::new();
    raw.extend((flags | if double { DOUBLE } else { 0x1000 }).to_le_bytes());
    if version == 4 {
        raw.extend(b"a mesh\0");
    }
    raw.extend(4u64.to_le_bytes());
    raw.extend(2u64.to_le_bytes());
    let mut put = |v: f64| match double {
        true => raw.extend(v.to_le_bytes()),
        false => raw.extend((v as f32).to_le_bytes()),
    };
    for i in 0..4u32 {
        [m, i, m + i].into_iter().for_each(|v| put(v.into()));
    }
    if flags & NORMALS != 0 {
        (0..4).for_each(|_| [0.0, 0.0, 1.0].into_iter().for_each(&mut put));
    }
    if flags & TEXCOORDS != 0 {
        (0..4).for_each(|i| [f64::from(i), 0.25].into_iter().for_each(&mut put));
    }
    for i in [0u32, 1, 2, 2, 1, 3] {
        raw.extend(i.to_le_bytes());
    }
    let mut packed = ZlibEncoder::new(Vec::new(), Compression::fast());
    packed.write_all(&raw).unwrap();
    packed.finish().unwrap()
}

/// A file of three meshes.
fn file(version: u16, double: bool, flags: u32) -> Vec<u8> {
    let (mut out, mut starts) = (Vec::new(), Vec::new());
    for m in 0..3 {
        starts.push(out.len() as u64);
        out.extend(MAGIC.to_le_bytes());
        out.extend(version.to_le_bytes());
        out.extend(body(version, m, double, flags));
    }
    for start in starts {
        match version {
            4 => out.extend(start.to_le_bytes()),
            _ => out.extend((start as u32).to_le_bytes()),
        }
    }
    out.extend(3u32.to_le_bytes());
    out
}

#[test]
fn what_is_written_is_read_in_both_versions_and_precisions() {
    for (version, double) in [(3, false), (3, true), (4, false), (4, true)] {
        for flags in [0, NORMALS, TEXCOORDS, NORMALS | TEXCOORDS, NORMALS | FACE_NORMALS] {
            let bytes = file(version, double, flags);
            for m in 0..3u8 {
                let mesh = parsed(&bytes, m.into(), 1 << 20).unwrap();
                assert_eq!(mesh.indices, [[0, 1, 2], [2, 1, 3]]);
                let m = f32::from(m);
                assert_eq!(mesh.positions[3], Point3::new(m, 3.0, m + 3.0));
                assert_eq!(
                    mesh.normals.len(),
                    if flags == NORMALS || flags == NORMALS | TEXCOORDS { 4 } else { 0 }
                );
                assert_eq!(
                    mesh.uvs.get(2).copied(),
                    (flags & TEXCOORDS != 0).then(|| Point2::new(2.0, 0.25))
                );
            }
        }
    }
}

#[test]
fn damaged_files_are_told() {
    let bytes = file(4, false, 0);
    let wrong = |bytes: &[u8], index, most| parsed(bytes, index, most).unwrap_err();
    assert_eq!(wrong(b"PK..", 0, 1 << 20), "this is no serialized mesh of Mitsuba");
    assert_eq!(wrong(&bytes, 3, 1 << 20), "there is no mesh 3: the file holds 3, counted from 0");
    assert!(wrong(&bytes, 0, 40).contains("more than 40 bytes"));
    for cut in 4..bytes.len() {
        drop(parsed(&bytes[..cut], 1, 1 << 20));
    }
    // Numbers that are promised and not there take no memory.
    let mut raw = 0x1000u32.to_le_bytes().to_vec();
    raw.extend(b"\0");
    raw.extend([(1u64 << 40).to_le_bytes(), 1u64.to_le_bytes()].concat());
    let mut packed = ZlibEncoder::new(Vec::new(), Compression::fast());
    packed.write_all(&raw).unwrap();
    let mut promised = [MAGIC.to_le_bytes(), 4u16.to_le_bytes()].concat();
    promised.extend(packed.finish().unwrap());
    promised.extend([0; 12]);
    assert!(wrong(&promised, 0, 1 << 30).contains("more than"));
    let mut other = bytes;
    other[2] = 9;
    assert_eq!(wrong(&other, 0, 1 << 20), "serialized meshes of version 9 are not read, only 3 and 4");
}
