//! STL as bytes: 80 of a header that may say anything, the number of triangles, 50 for each triangle.
use rayon::prelude::*;

use super::{Solid, check};
use crate::import::{
    content::{Content, beginning},
    text::Complaint,
};
use durer_scene::counted;

const HEADER: usize = 80;
/// Normal, three corners, two spare bytes.
const TRIANGLE: usize = 50;
/// Triangles that one thread reads at once.
const BLOCK: usize = 1 << 14;

/// The number of triangles that the file claims.
fn count(bytes: &[u8]) -> Option<usize> {
    let number = bytes.get(HEADER..)?.first_chunk()?;
    Some(u32::from_le_bytes(*number) as usize)
}

/// True if the file is exactly as long as it claims, which text is not but by chance.
pub(super) fn fits(bytes: &[u8]) -> bool {
    count(bytes).is_some_and(|n| n * TRIANGLE + HEADER + 4 == bytes.len())
}

/// Reads the one body of a file.
pub(super) fn read(bytes: &[u8], warnings: &mut Vec<Complaint>) -> Result<Vec<Solid>, Complaint> {
    let wrong = |message: String| {
        let hint = "an STL file is text that begins with \"solid\", or 84 bytes and 50 for each triangle";
        Complaint::whole(message).hint(hint)
    };
    let foreign = || {
        if let Some(content) = Content::of(bytes).and_then(|content| content.complaint("STL")) {
            return Some(Complaint::whole(content));
        }
        // Text all the way into what would be the number of triangles.
        let head = bytes.get(..bytes.len().min(HEADER + 4)).unwrap_or_default();
        let text = head.iter().all(|b| matches!(b, b' '..=b'~' | b'\t' | b'\n' | b'\r'));
        (text && head.len() > 3)
            .then(|| wrong(format!("this is no STL file: it begins with {}", beginning(bytes))))
    };
    let Some(count) = count(bytes) else {
        let short = || {
            let there = counted(bytes.len(), "byte");
            wrong(format!("this is no STL file: {there} are too few for a binary one"))
        };
        return Err(foreign().unwrap_or_else(short));
    };
    let body = bytes.get(HEADER + 4..).unwrap_or_default();
    let there = body.len() / TRIANGLE;
    if count > there {
        let cut = || {
            let message =
                format!("the file was cut off: {there} of {} are there", counted(count, "triangle"));
            Complaint::whole(message).hint("export or copy it again")
        };
        return Err(foreign().unwrap_or_else(cut));
    }
    if body.len() != count * TRIANGLE {
        let more = body.len() - count * TRIANGLE;
        let verb = if more == 1 { "is" } else { "are" };
        let message = format!("{} behind the last triangle {verb} ignored", counted(more, "byte"));
        warnings.push(Complaint::whole(message).warning());
    }
    let body = body.get(..count * TRIANGLE).unwrap_or_default();
    let blocks: Vec<_> = body.chunks(BLOCK * TRIANGLE).enumerate().collect();
    let read = blocks.into_par_iter().map(|(i, block)| {
        let triangles = block.chunks_exact(TRIANGLE).enumerate();
        let checked = triangles.map(|(k, bytes)| {
            let corners = corners(bytes);
            let message = |m| Complaint::whole(format!("triangle {}: {m}", i * BLOCK + k));
            check(&corners).map(|()| corners).map_err(message)
        });
        checked.collect::<Result<Vec<_>, _>>()
    });
    let mut triangles = Vec::with_capacity(count);
    for block in read.collect::<Vec<_>>() {
        triangles.extend(block?);
    }
    Ok(vec![Solid { name: String::new(), triangles }])
}

fn corners(triangle: &[u8]) -> [[f32; 3]; 3] {
    let mut numbers = triangle.as_chunks::<4>().0.iter().skip(3).map(|b| f32::from_le_bytes(*b));
    std::array::from_fn(|_| std::array::from_fn(|_| numbers.next().unwrap_or(0.0)))
}
