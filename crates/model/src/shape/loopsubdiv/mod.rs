//! Loop's subdivision surfaces (Loop 1987; weights of Warren, limit and tangent masks of Hoppe et al. 1994; Physically
//! Based Rendering, 3rd edition, section 3.8).
//!
//! Every level splits each triangle into four. A vertex inside with `n` neighbours moves to
//! `(1 - n b) v + b sum of neighbours`, `b = 3 / (8 n)`, for n = 3: 3/16; one on a boundary to
//! `3/4 v + 1/8 (neighbours on the boundary)`. A new vertex lies at `3/8 (ends) + 1/8 (opposite corners)` of its edge, on a
//! boundary in its middle. At the end vertices go to where infinitely many levels would take them: `(1 - n g) v + g sum`
//! with `g = 1 / (n + 3 / (8 b))`, on a boundary `2/3 v + 1/6 (neighbours)`, the limit of the rule above, which is the
//! uniform cubic B-spline (pbrt takes 3/5 and 1/5, which it is not).
//!
//! Any triangles have such a surface: an edge of more than two, or whose two run the same way along it, is taken for
//! a boundary of each; a vertex that joins several fans of triangles only is one vertex per fan.
mod halfedges;
mod masks;

use std::sync::Arc;

use durer_core::{
    glam::DVec3,
    math::{Normal3, Point3},
};
use durer_scene::{Args, Kind, Mesh, ParamDefault, ParamSpec, ParamType, Schema};

use super::{
    ALPHA, Displacement, Geometry,
    displace::{DISPLACEMENT, DISPLACEMENT_EDGE_LENGTH, EDGE_LENGTH},
};
use halfedges::HalfEdges;
use masks::Masks;

/// Most triangles made.
const MOST_TRIANGLES: usize = 1 << 23;

/// The word `loopsubdiv`.
#[derive(Clone, Copy, Debug)]
pub struct LoopSubdiv;

/// The limit surface at the vertices that `levels` levels make of the triangles `indices` of `points`, as a mesh with
/// normals. Indices must be in range.
pub fn subdivide(points: &[Point3], indices: &[[u32; 3]], levels: u32) -> Mesh {
    let (mut edges, origins) = HalfEdges::new(points.len(), indices);
    let mut positions: Vec<DVec3> = origins.iter().map(|&i| points[i as usize].to_f64()).collect();
    for _ in 0..levels {
        let masks = Masks::new(&edges, positions.len());
        let mut refined = masks.refined(&positions);
        let (next, vertices) = edges.split(positions.len());
        refined.resize(vertices, DVec3::ZERO);
        edges.edge_points(&positions, &mut refined[positions.len()..]);
        (edges, positions) = (next, refined);
    }
    let masks = Masks::new(&edges, positions.len());
    let unit = |n: DVec3| Normal3::from_f64(n.normalize_or_zero());
    Mesh {
        normals: masks.normals(&positions).into_iter().map(unit).collect(),
        positions: masks.limits(&positions).into_iter().map(Point3::from_f64).collect(),
        indices: edges.triangles(),
        ..Mesh::default()
    }
}

impl Kind for LoopSubdiv {
    type Output = Geometry;
    const SCHEMA: Schema = Schema {
        name: "loopsubdiv",
        aliases: &[],
        doc: "Loop's subdivision surface of a triangle mesh: smooth inside, with smooth creases along its boundaries. The outside is where \
              vertices are seen counter-clockwise.",
        params: &[
            ParamSpec::new("P", ParamType::Point3s, ParamDefault::Required, "Vertices of the control mesh.")
                .unit("m"),
            ParamSpec::new(
                "indices",
                ParamType::Ints,
                ParamDefault::Required,
                "Three vertices per triangle, counted from 0.",
            )
            .range(0.0, f32::INFINITY),
            ParamSpec::new(
                "levels",
                ParamType::Int,
                ParamDefault::Int(3),
                "How often each triangle is split into four; at most 8388608 triangles are made.",
            )
            .range(0.0, 12.0),
            ParamSpec::new(
                "scheme",
                ParamType::Choice(&["loop"]),
                ParamDefault::Text("loop"),
                "The only scheme.",
            ),
            ALPHA,
            DISPLACEMENT,
            EDGE_LENGTH,
            DISPLACEMENT_EDGE_LENGTH,
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Geometry> {
        if !args.is_sound() {
            return None;
        }
        Displacement::read(args);
        let points: Vec<Point3> = args.triples("P").into_iter().map(Point3::from).collect();
        let (triples, rest) = args.ints("indices").as_chunks::<3>();
        if !rest.is_empty() {
            let count = args.ints("indices").len();
            args.error("indices", format!("\"indices\" has {count} values, expected a multiple of 3"));
        }
        let indices = triples.iter().map(|t| t.map(|i| i.max(0) as u32)).collect();
        let control = Mesh { positions: points, indices, ..Mesh::default() };
        if let Err(error) = control.validate() {
            args.error("indices", error.to_string());
            return None;
        }
        let levels = u32::try_from(args.int("levels")).unwrap_or(0);
        let made = control.indices.len().saturating_mul(1 << (2 * levels.min(16)));
        if made > MOST_TRIANGLES {
            let most = (0..levels)
                .rev()
                .find(|l| control.indices.len().saturating_mul(1 << (2 * l)) <= MOST_TRIANGLES);
            let advice = most.map_or_else(
                || "the control mesh itself has too many".to_owned(),
                |l| format!("take at most {l}"),
            );
            args.error(
                "levels",
                format!("{levels} levels make {made} triangles, more than {MOST_TRIANGLES}: {advice}"),
            );
            return None;
        }
        let odd = HalfEdges::new(control.positions.len(), &control.indices).0.odd();
        if odd > 0 {
            args.warning(
                "indices",
                format!(
                    "{odd} edges belong to more than two triangles, or to two that run the same way along them: they \
                     are treated as boundaries"
                ),
            );
        }
        args.is_sound()
            .then(|| Geometry::Mesh(Arc::new(subdivide(&control.positions, &control.indices, levels))))
    }
}
