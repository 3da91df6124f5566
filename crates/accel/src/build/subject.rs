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

    /// The triangle numbered `at`, at both ends of the stretch.
    pub(super) fn triangle(&self, at: usize) -> Option<[[Point3; 3]; 2]> {
        let placed = |p: Point3, place: &Option<Transform>| place.as_ref().map_or(p, |m| m.point(p));
        match self {
            Self::Triangles { positions, indices, place, .. } => {
                Some([indices[at].map(|i| placed(positions[i as usize], place)); 2])
            }
            Self::Quads { mesh, place, .. } => {
                let [a, b, c, d] = mesh.indices[at / 2];
                let corners = if at.is_multiple_of(2) { [a, b, d] } else { [c, d, b] };
                Some([corners.map(|i| placed(mesh.positions[i as usize], place)); 2])
            }
            Self::Keyed { start, end, indices } => {
                Some([start, end].map(|key| indices[at].map(|i| key.1[i as usize])))
            }
            Self::Loose(list) => Some([list[at].1; 2]),
            Self::Items(_) | Self::Instances(_) => None,
        }
    }

    fn boxes(&self, at: usize) -> Stretch {
        match self {
            Self::Items(list) => [list[at].1; 2],
            Self::Instances(list) => list[at].1,
            _ => {
                let corners = self.triangle(at).unwrap_or([[Point3::ZERO; 3]; 2]);
                corners.map(|[a, b, c]| Bounds3 { min: a.min(b).min(c), max: a.max(b).max(c) })
            }
        }
    }

    /// The number the tree knows it by.
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

    fn find(&self, number: u32) -> (&Part<'a>, usize) {
        let part = match self.parts.len() {
            1 => 0,
            _ => self.starts.partition_point(|start| *start <= number) - 1,
        };
        (&self.parts[part], (number - self.starts[part]) as usize)
    }

    /// Its triangle and what the tree calls it; `None` for other things.
    pub(crate) fn triangle(&self, number: u32) -> Option<(u32, [[Point3; 3]; 2])> {
        let (part, at) = self.find(number);
        Some((part.id(at), part.triangle(at)?))
    }

    /// The link to something that is not a triangle.
    pub(crate) fn link(&self, number: u32) -> Link {
        let (part, at) = self.find(number);
        Link::new(match part {
            Part::Instances(_) => Target::Instance(part.id(at)),
            _ => Target::Item(part.id(at)),
        })
    }

    pub(crate) fn boxes(&self, number: u32) -> Stretch {
        let (part, at) = self.find(number);
        part.boxes(at)
    }
}

impl Primitives for Subject<'_> {
    fn len(&self) -> usize {
        self.total
    }
    fn bounds(&self, prim: u32) -> Bounds3 {
        let [start, end] = self.boxes(prim);
        if self.moves { start.union(end) } else { start }
    }
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

/// A box with the slack of box tests at both ends; moving ones twice, for their planes are computed.
pub(crate) fn slackened(boxes: &Stretch, extent: f32, moves: bool) -> Stretch {
    let once = boxes.map(|b| grown(&b, extent));
    if moves { once.map(|b| grown(&b, extent)) } else { once }
}
