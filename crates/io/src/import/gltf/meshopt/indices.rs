//! Modes TRIANGLES and INDICES: triangles by the edges and vertices that were met last; indices by their differences.
use super::{Stream, signed};

/// A ring of what was met last.
struct Ring<T> {
    items: [T; 16],
    next: usize,
}

impl<T: Copy> Ring<T> {
    fn new(item: T) -> Self {
        Self { items: [item; 16], next: 0 }
    }
    fn push(&mut self, item: T) {
        if let Some(place) = self.items.get_mut(self.next & 15) {
            *place = item;
        }
        self.next = (self.next + 1) & 15;
    }
    /// What was met `back` items before the last.
    fn get(&self, back: usize) -> Option<T> {
        self.items.get((self.next + 31 - back) & 15).copied()
    }
}

/// What a triangle may refer to.
struct Met {
    edges: Ring<(u32, u32)>,
    vertices: Ring<u32>,
    /// The first index that was not met.
    next: u32,
    /// The last one that was written out.
    last: u32,
}

impl Met {
    fn new_vertex(&mut self) -> u32 {
        let new = self.next;
        self.next = self.next.wrapping_add(1);
        new
    }
    fn written(&mut self, stream: &mut Stream<'_>) -> Result<u32, &'static str> {
        self.last = self.last.wrapping_add(signed(stream.number()?));
        Ok(self.last)
    }
    /// The triangle is met: its edges the other way round, as a neighbour has them.
    fn edges_of(&mut self, [a, b, c]: [u32; 3]) {
        self.edges.push((b, a));
        self.edges.push((c, b));
        self.edges.push((a, c));
    }
    /// A vertex by its code: 0 is new, 15 is written out, the others were met.
    fn vertex(&mut self, code: u8) -> u32 {
        match code {
            0 => self.new_vertex(),
            code => self.vertices.get(usize::from(code) - 1).unwrap_or(0),
        }
    }
}

/// `count` indices, three for each triangle.
pub(super) fn triangles(bytes: &[u8], count: usize) -> Result<Vec<u32>, &'static str> {
    const HEADER: u8 = 0xe1;
    const AUXILIARY: usize = 16;
    if !count.is_multiple_of(3) {
        return Err("the number of indices is no multiple of 3");
    }
    let body = bytes.len().checked_sub(AUXILIARY).ok_or("it ends too early")?;
    let (body, pairs) = bytes.split_at_checked(body).ok_or("it ends too early")?;
    let mut stream = Stream(body);
    if stream.byte()? != HEADER {
        return Err("it does not begin as triangles do");
    }
    let codes = stream.take(count / 3)?;
    let (edges, vertices) = (Ring::new((u32::MAX, u32::MAX)), Ring::new(u32::MAX));
    let mut met = Met { edges, vertices, next: 0, last: 0 };
    let mut all = Vec::with_capacity(count);
    for &code in codes {
        all.extend(match code {
            ..0xf0 => beside_an_edge(&mut met, &mut stream, code)?,
            0xf0..0xfe => {
                let pair = pairs.get(usize::from(code & 15)).copied().unwrap_or(0);
                let a = met.new_vertex();
                fresh(&mut met, a, (pair, None))?
            }
            _ => {
                let pair = stream.byte()?;
                if pair == 0 {
                    met.next = 0;
                }
                let a = if code == 0xfe { Some(met.new_vertex()) } else { None };
                fresh(&mut met, a.unwrap_or(0), (pair, Some((&mut stream, a.is_none()))))?
            }
        });
    }
    if stream.0.is_empty() { Ok(all) } else { Err("something stands behind its end") }
}

/// A triangle at an edge that was met.
fn beside_an_edge(met: &mut Met, stream: &mut Stream<'_>, code: u8) -> Result<[u32; 3], &'static str> {
    let (a, b) = met.edges.get(usize::from(code >> 4)).unwrap_or_default();
    let third = code & 15;
    let c = match third {
        0..13 => match third {
            0 => met.new_vertex(),
            third => met.vertices.get(usize::from(third)).unwrap_or(0),
        },
        15 => met.written(stream)?,
        third => {
            met.last = if third == 13 { met.last.wrapping_sub(1) } else { met.last.wrapping_add(1) };
            met.last
        }
    };
    if third == 0 || third >= 13 {
        met.vertices.push(c);
    }
    met.edges.push((c, b));
    met.edges.push((a, c));
    Ok([a, b, c])
}

/// A triangle whose first vertex is `a`, unless that is written out, and whose others are given by a pair of codes.
fn fresh(
    met: &mut Met,
    a: u32,
    (pair, more): (u8, Option<(&mut Stream<'_>, bool)>),
) -> Result<[u32; 3], &'static str> {
    let (second, third) = (pair >> 4, pair & 15);
    let mut a = a;
    let mut b = met.vertex(second);
    let mut c = met.vertex(third);
    let can_write = more.is_some();
    if let Some((stream, first)) = more {
        if first {
            a = met.written(stream)?;
        }
        if second == 15 {
            b = met.written(stream)?;
        }
        if third == 15 {
            c = met.written(stream)?;
        }
    }
    met.vertices.push(a);
    if second == 0 || (can_write && second == 15) {
        met.vertices.push(b);
    }
    if third == 0 || (can_write && third == 15) {
        met.vertices.push(c);
    }
    met.edges_of([a, b, c]);
    Ok([a, b, c])
}

/// `count` indices.
pub(super) fn sequence(bytes: &[u8], count: usize) -> Result<Vec<u32>, &'static str> {
    const HEADER: u8 = 0xd1;
    const TAIL: usize = 4;
    let body = bytes.len().checked_sub(TAIL).ok_or("it ends too early")?;
    let mut stream = Stream(bytes.get(..body).unwrap_or_default());
    if stream.byte()? != HEADER {
        return Err("it does not begin as indices do");
    }
    if count > stream.0.len() {
        return Err("it ends too early");
    }
    let mut last = [0u32; 2];
    let mut all = Vec::with_capacity(count);
    for _ in 0..count {
        let number = stream.number()?;
        let index = if number & 1 == 0 { &mut last[0] } else { &mut last[1] };
        *index = index.wrapping_add(signed(number >> 1));
        all.push(*index);
    }
    if stream.0.is_empty() { Ok(all) } else { Err("something stands behind its end") }
}
