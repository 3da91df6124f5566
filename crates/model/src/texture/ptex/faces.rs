//! Texels of faces, at any size, also beyond their edges.
//!
//! Edge 0 goes from (0, 0) to (1, 0), edge 1 on to (1, 1), edge 2 to (0, 1), edge 3 back. Of two faces that share an edge one
//! goes along it the other way. Beyond an edge lie the texels of the face beside, of a copy with as many along the edge if it
//! has one; beyond a corner those of the face beside the face beside. Where nothing is beside, and between whole faces and
//! parts of faces, the last texel goes on.
use std::sync::Arc;

use durer_scene::{Ptex, PtexFace, PtexShape};
use rayon::prelude::*;

use super::super::{
    TextureAt,
    imagemap::{encoding::Encoding, filter::level, texels::Texels},
};

type Rgb = [f32; 3];

/// All faces, with their smaller copies.
#[derive(Clone, Debug)]
pub(super) struct Faces {
    shape: PtexShape,
    faces: Vec<PtexFace>,
    texels: Texels,
    /// Linear values of the smaller copies: of each face in turn, the larger ones first.
    copies: Vec<Rgb>,
    /// Where those of each face begin.
    starts: Vec<usize>,
}

/// Columns and rows of a copy that is smaller by so many halvings.
fn size(face: &PtexFace, level: u8) -> [usize; 2] {
    face.log2.map(|log2| 1 << log2.saturating_sub(level))
}

/// Halvings until one texel is left.
fn halvings(face: &PtexFace) -> u8 {
    face.log2[0].max(face.log2[1])
}

impl Faces {
    pub(super) fn new(file: &Ptex, encoding: Encoding) -> Self {
        let texels = Texels::stored_as(Arc::clone(&file.texels), encoding);
        let (copies, starts) = (Vec::new(), Vec::with_capacity(file.faces.len()));
        let mut all = Self { shape: file.shape, faces: file.faces.clone(), texels, copies, starts };
        let of_faces: Vec<Vec<Rgb>> = all.faces.par_iter().map(|face| all.smaller(face)).collect();
        for copies in of_faces {
            all.starts.push(all.copies.len());
            all.copies.extend(copies);
        }
        all
    }

    /// The copies of a face, the larger ones first.
    fn smaller(&self, face: &PtexFace) -> Vec<Rgb> {
        let mut copies = Vec::new();
        for level in 1..=halvings(face) {
            let [w, h] = size(face, level);
            for (x, y) in (0..h).flat_map(|y| (0..w).map(move |x| (x, y))) {
                let value = self.mean((face, &copies), level - 1, [x, y]);
                copies.push(value);
            }
        }
        copies
    }

    /// The mean of the texels that one of the next smaller copy covers.
    fn mean(&self, (face, copies): (&PtexFace, &[Rgb]), level: u8, [x, y]: [usize; 2]) -> Rgb {
        let [w, h] = size(face, level);
        let four = match self.shape {
            // Three that point the same way, and between them one that is stored in the other half.
            PtexShape::Triangles => {
                let (a, b) = (2 * x, 2 * y);
                [[a, b], [a + 1, b], [a, b + 1], [h - 1 - b, w - 1 - a]]
            }
            PtexShape::Quads => {
                let [a, b] = [(x, w), (y, h)].map(|(i, n)| if n == 1 { [0, 0] } else { [2 * i, 2 * i + 1] });
                [[a[0], b[0]], [a[1], b[0]], [a[0], b[1]], [a[1], b[1]]]
            }
        };
        let mut sum = [0.0; 3];
        for at in four {
            sum.iter_mut().zip(self.of((face, copies), level, at)).for_each(|(s, v)| *s += 0.25 * v);
        }
        sum
    }

    /// A texel of a copy, linear.
    fn texel(&self, number: usize, level: u8, at: [usize; 2]) -> Rgb {
        self.of((&self.faces[number], &self.copies[self.starts[number]..]), level, at)
    }

    /// The same of a face with these copies.
    fn of(&self, (face, copies): (&PtexFace, &[Rgb]), level: u8, [x, y]: [usize; 2]) -> Rgb {
        let within = y * size(face, level)[0] + x;
        if level == 0 {
            let [r, g, b, _] = self.texels.rgba((face.first + within) as u32, 0);
            return [r, g, b];
        }
        let before: usize = (1..level).map(|level| size(face, level).iter().product::<usize>()).sum();
        copies[before + within]
    }

    /// The value at a point of a face, over its footprint.
    pub(super) fn at(&self, at: &TextureAt) -> Rgb {
        let number = at.face as usize;
        let Some(face) = self.faces.get(number) else { return [0.0; 3] };
        let uv = [at.uv.x, at.uv.y].map(|c| if c.is_finite() { c.clamp(0.0, 1.0) } else { 0.0 });
        let [across, down] = [at.footprint.duvdx, at.footprint.duvdy];
        let extent = |i: usize| across[i].abs().max(down[i].abs()) * face.size()[i] as f32;
        let most = f32::from(halvings(face));
        let level = level(extent(0).max(extent(1))).min(most);
        let (finer, share) = (level.floor(), level.fract());
        let of = |level: f32| match self.shape {
            PtexShape::Quads => self.between(number, level as u8, uv),
            PtexShape::Triangles => self.texel(number, level as u8, triangle(face, level as u8, uv)),
        };
        let fine = of(finer);
        if share == 0.0 {
            return fine;
        }
        let coarse = of(finer + 1.0);
        std::array::from_fn(|i| fine[i] + (coarse[i] - fine[i]) * share)
    }

    /// Between the four nearest texels.
    fn between(&self, face: usize, level: u8, uv: [f32; 2]) -> Rgb {
        let size = size(&self.faces[face], level);
        let at = [0, 1].map(|i| uv[i] * size[i] as f32 - 0.5);
        let (first, share) = (at.map(|x| x.floor() as i64), at.map(|x| x - x.floor()));
        let mut sum = [0.0; 3];
        for corner in 0..4 {
            let step = [corner & 1, corner >> 1];
            let weight = |i: usize| if step[i] == 1 { share[i] } else { 1.0 - share[i] };
            let w = weight(0) * weight(1);
            if w != 0.0 {
                let value = self.beyond(face, level, [0, 1].map(|i| first[i] + step[i]), 2);
                sum.iter_mut().zip(value).for_each(|(s, v)| *s += w * v);
            }
        }
        sum
    }

    /// A texel that may lie one step beyond edges, of which so many may be crossed.
    fn beyond(&self, number: usize, level: u8, [x, y]: [i64; 2], crossings: u8) -> Rgb {
        let face = &self.faces[number];
        let [w, h] = size(face, level).map(|n| n as i64);
        let edge = match (x, y) {
            _ if x >= w => 1,
            _ if x < 0 => 3,
            _ if y < 0 => 0,
            _ if y >= h => 2,
            _ => return self.texel(number, level, [x as usize, y as usize]),
        };
        let inside = [x.clamp(0, w - 1), y.clamp(0, h - 1)];
        if crossings == 0 {
            return self.texel(number, level, inside.map(|i| i as usize));
        }
        let beside =
            face.beside[edge].filter(|(other, _)| self.faces[*other as usize].is_part == face.is_part);
        let Some((other, entered)) = beside else {
            // The other coordinate may lie outside still.
            let next = if edge % 2 == 1 { [inside[0], y] } else { [x, inside[1]] };
            return self.beyond(number, level, next, crossings - 1);
        };
        // Texels along the edge, counted as the face goes along it, then as the other does.
        let (count, along) = match edge {
            0 => (w, x),
            1 => (h, y),
            2 => (w, w - 1 - x),
            _ => (h, h - 1 - y),
        };
        let there = &self.faces[other as usize];
        let finest = there.log2[usize::from(entered % 2)];
        let level = finest.saturating_sub(count.ilog2() as u8);
        let [w, h] = size(there, level).map(|n| n as i64);
        let others = if entered % 2 == 0 { w } else { h };
        let along = ((2 * (count - along) - 1) * others).div_euclid(2 * count);
        let next = match entered {
            0 => [along, 0],
            1 => [w - 1, along],
            2 => [w - 1 - along, h - 1],
            _ => [0, h - 1 - along],
        };
        self.beyond(other as usize, level, next, crossings - 1)
    }

    /// No value is of larger magnitude.
    pub(super) fn largest(&self) -> f32 {
        self.texels.largest()
    }

    /// Heap memory in bytes.
    pub(super) fn bytes(&self) -> u64 {
        (size_of_val(&*self.copies) + size_of_val(&*self.starts) + size_of_val(&*self.faces)) as u64
    }
}

/// The texel of a triangle. Those that point the other way are stored in the half of the square that is left.
fn triangle(face: &PtexFace, level: u8, [u, v]: [f32; 2]) -> [usize; 2] {
    let n = size(face, level)[0];
    // Back onto the third edge from beyond it.
    let over = 0.5 * (u + v - 1.0).max(0.0);
    let at = [u - over, v - over].map(|c| c.max(0.0) * n as f32);
    let [i, j] = at.map(|x| (x as usize).min(n - 1));
    let is_turned = at[0] - i as f32 + at[1] - j as f32 > 1.0;
    if is_turned { [n - 1 - j, n - 1 - i] } else { [i, j] }
}
