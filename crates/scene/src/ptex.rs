//! Ptex: a small picture for each face of a mesh, and which faces lie beside each other (Burley and Lacewell 2008).
use std::sync::Arc;

use crate::Image;

/// The pictures of all faces.
#[derive(Clone, Debug, PartialEq)]
pub struct Ptex {
    /// What the faces are.
    pub shape: PtexShape,
    /// The faces, by number.
    pub faces: Vec<PtexFace>,
    /// Texels of all faces in one row, those of a face row by row as its coordinates grow.
    pub texels: Arc<Image>,
    /// What of the file was passed over, as clauses.
    pub passed_over: Vec<&'static str>,
}

/// What the faces of a mesh are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PtexShape {
    /// Of three corners, at (0, 0), (1, 0) and (0, 1).
    Triangles,
    /// Of four corners, at (0, 0), (1, 0), (1, 1) and (0, 1).
    Quads,
}

/// A face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PtexFace {
    /// Logarithms to base 2 of the numbers of columns and rows.
    pub log2: [u8; 2],
    /// Its first texel.
    pub first: usize,
    /// What lies beside its edges, of which the first goes from corner 0 to corner 1, and which edge of that face; `None`
    /// where nothing does.
    pub beside: [Option<(u32, u8)>; 4],
    /// It is part of a face of more or fewer corners: as long as half of an edge of those that are whole.
    pub is_part: bool,
}

impl PtexFace {
    /// Columns and rows.
    pub fn size(&self) -> [usize; 2] {
        self.log2.map(|log2| 1 << log2)
    }
}
