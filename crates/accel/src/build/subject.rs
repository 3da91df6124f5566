//! What one tree is grown over: parts of several kinds, numbered one after another.
use durer_core::math::{Bounds3, Point3, Transform};

use super::source::{Key, Quads};
use crate::{
    grow::{Primitives, clip::clip},
    layout::{Link, Target},
    slab::grown,
};

/// Boxes at the start and at the end of the tree's stretch of time.
pub(crate) type Stretch = [Bounds3; 2];

/// What the tree calls a triangle, and its corners at both ends.
pub(super) type Triangle = (u32, [[Point3; 3]; 2]);

/// Primitives of one kind, each known to the tree by a number: `first_id` and up, or a list.
pub(crate) enum Part<'a> {
    Triangles {
        positions: &'a [Point3],
        indices: &'a [[u32; 3]],
        place: Option<Transform>,
        first_id: u32,
    },
    Quads {
        mesh: &'a Quads,
        place: Option<Transform>,
        first_id: u32,
    },
    /// In the tree's own space, by number.
    Loose(Vec<(u32, [Point3; 3])>),
    /// Between two keys.
    Keyed {
        start: &'a Key<'a>,
        end: &'a Key<'a>,
        indices: &'a [[u32; 3]],
    },
    /// Shapes with finite boxes.
    Items(Vec<(u32, Bounds3)>),
    Instances(Vec<(u32, Stretch)>),
}

impl Part<'_> {
    fn len(&self) -> usize {
        match self {
            Self::Triangles { indices, .. } | Self::Keyed { indices, .. } => indices.len(),
            Self::Quads { mesh, .. } => 2 * mesh.indices.len(),
            Self::Loose(list) => list.len(),
            Self::Items(list) => list.len(),
            Self::Instances(list) => list.len(),
        }
    }

    /// The triangle numbered `at`, at one end of the stretch.
    ///
    /// PERF: no `array::map`, which is not compiled away here (bench kernel, build).
    #[inline]
    fn corners(&self, at: usize, end: usize) -> Option<[Point3; 3]> {
        let (positions, [a, b, c], place) = match self {
            Self::Triangles { positions, indices, place, .. } => (*positions, indices[at], place),
            Self::Quads { mesh, place, .. } => {
                let [a, b, c, d] = mesh.indices[at / 2];
                let half = if at.is_multiple_of(2) { [a, b, d] } else { [c, d, b] };
                (mesh.positions.as_slice(), half, place)
            }
            Self::Keyed { start, end: last, indices } => {
                let key = if end == 0 { start } else { last };
                (&*key.1, indices[at], &None)
            }
            Self::Loose(list) => return Some(list[at].1),
            Self::Items(_) | Self::Instances(_) => return None,
        };
        let (a, b, c) = (positions[a as usize], positions[b as usize], positions[c as usize]);
        Some(match place {
            None => [a, b, c],
            Some(m) => [m.point(a), m.point(b), m.point(c)],
        })
    }

    /// The triangle at both ends of the stretch.
    #[inline]
    pub(super) fn triangle(&self, at: usize) -> Option<[[Point3; 3]; 2]> {
        let start = self.corners(at, 0)?;
        match self {
            Self::Keyed { .. } => Some([start, self.corners(at, 1)?]),
            _ => Some([start; 2]),
        }
    }

    #[inline]
    fn boxes(&self, at: usize) -> Stretch {
        let end = |end: usize| self.corners(at, end).map_or(Bounds3::EMPTY, |corners| around(&corners));
        match self {
            Self::Items(list) => [list[at].1; 2],
            Self::Instances(list) => list[at].1,
            Self::Keyed { .. } => [end(0), end(1)],
            Self::Triangles { .. } | Self::Quads { .. } | Self::Loose(_) => [end(0); 2],
        }
    }

    /// The number the tree knows it by.
    #[inline]
    fn id(&self, at: usize) -> u32 {
        match self {
            Self::Triangles { first_id, .. } | Self::Quads { first_id, .. } => first_id + at as u32,
            Self::Keyed { .. } => at as u32,
            Self::Loose(list) => list[at].0,
            Self::Items(list) => list[at].0,
            Self::Instances(list) => list[at].0,
        }
    }
}

/// Parts, numbered one after another.
pub(crate) struct Subject<'a> {
    parts: Vec<Part<'a>>,
    /// First number of each part.
    starts: Vec<u32>,
    total: usize,
    /// Whether boxes differ between the ends of the stretch.
    pub(crate) moves: bool,
}

impl<'a> Subject<'a> {
    pub(crate) fn new(parts: Vec<Part<'a>>, moves: bool) -> Self {
        let parts: Vec<_> = parts.into_iter().filter(|part| part.len() > 0).collect();
        let mut total = 0;
        let starts = parts.iter().map(|part| {
            let start = total as u32;
            total += part.len();
            start
        });
        let starts = starts.collect();
        Self { parts, starts, total, moves }
    }

    #[inline]
    fn find(&self, number: u32) -> (&Part<'a>, usize) {
        let part = match self.parts.len() {
            1 => 0,
            _ => self.starts.partition_point(|start| *start <= number) - 1,
        };
        (&self.parts[part], (number - self.starts[part]) as usize)
    }

    /// Its triangle and what the tree calls it; `None` for other things.
    #[inline]
    pub(crate) fn triangle(&self, number: u32) -> Option<Triangle> {
        let (part, at) = self.find(number);
        Some((part.id(at), part.triangle(at)?))
    }

    /// Those of `numbers` that are triangles, each in its place.
    pub(super) fn triangles(&self, numbers: &[u32], to: &mut [Triangle]) {
        let [Part::Triangles { positions, indices, place: None, first_id }] = self.parts.as_slice() else {
            for (number, to) in numbers.iter().zip(to) {
                *to = self.triangle(*number).unwrap_or(*to);
            }
            return;
        };
        // PERF: short loops, in which the processor asks for many places at a time (bench kernel, build).
        let mut names = [[0; 3]; 64];
        for (numbers, to) in numbers.chunks(names.len()).zip(to.chunks_mut(names.len())) {
            for (number, name) in numbers.iter().zip(&mut names) {
                *name = indices[*number as usize];
            }
            for ((number, name), to) in numbers.iter().zip(&names).zip(to) {
                let corners =
                    [positions[name[0] as usize], positions[name[1] as usize], positions[name[2] as usize]];
                *to = (first_id + number, [corners; 2]);
            }
        }
    }

    /// The link to something that is not a triangle.
    pub(crate) fn link(&self, number: u32) -> Link {
        let (part, at) = self.find(number);
        Link::new(match part {
            Part::Instances(_) => Target::Instance(part.id(at)),
            _ => Target::Item(part.id(at)),
        })
    }

    #[inline]
    pub(crate) fn boxes(&self, number: u32) -> Stretch {
        let (part, at) = self.find(number);
        part.boxes(at)
    }
}

impl Primitives for Subject<'_> {
    fn len(&self) -> usize {
        self.total
    }
    #[inline]
    fn bounds(&self, prim: u32) -> Bounds3 {
        let [start, end] = self.boxes(prim);
        if self.moves { start.union(end) } else { start }
    }
    #[inline]
    fn packs(&self, prim: u32) -> bool {
        !matches!(self.find(prim).0, Part::Items(_) | Part::Instances(_))
    }
    fn clip(&self, prim: u32, within: &Bounds3, axis: usize, at: f32) -> Option<[Bounds3; 2]> {
        if self.moves {
            return None;
        }
        let (_, [triangle, _]) = self.triangle(prim)?;
        Some(clip(&triangle, within, axis, at))
    }
}

/// The box around a triangle.
#[inline]
pub(super) fn around([a, b, c]: &[Point3; 3]) -> Bounds3 {
    Bounds3 { min: a.min(*b).min(*c), max: a.max(*b).max(*c) }
}

/// A box with the slack of box tests at both ends; moving ones twice, for their planes are computed.
pub(crate) fn slackened(boxes: &Stretch, extent: f32, moves: bool) -> Stretch {
    match moves {
        true => boxes.map(|b| grown(&grown(&b, extent), extent)),
        false => [grown(&boxes[0], extent); 2],
    }
}
