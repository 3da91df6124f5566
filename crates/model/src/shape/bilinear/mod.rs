//! Bilinear patches, flat or twisted: `P(u, v) = (1-u)(1-v) p00 + u (1-v) p10 + (1-u) v p01 + u v p11`.
mod patch;

use std::sync::Arc;

use durer_core::{
    glam::DVec3,
    math::{Normal3, Point2, Point3},
};
use durer_scene::{Args, Kind, Mesh, ParamDefault, ParamSpec, ParamType, Schema};

pub use patch::Patch;

use super::{
    ALPHA, Displacement, Geometry, Shape,
    displace::{DISPLACEMENT, DISPLACEMENT_EDGE_LENGTH, EDGE_LENGTH},
};

/// The word `bilinearmesh`.
#[derive(Clone, Copy, Debug)]
pub struct BilinearMesh;

impl Kind for BilinearMesh {
    type Output = Geometry;
    const SCHEMA: Schema = Schema {
        name: "bilinearmesh",
        aliases: &[],
        doc: "Bilinear patches: four corners each, flat or twisted. The outside is where the corners, taken in the order 0, 1, 3, 2, are \
              seen counter-clockwise, unless vertex normals say otherwise.",
        params: &[
            ParamSpec::new("P", ParamType::Point3s, ParamDefault::Required, "Corners.").unit("m"),
            ParamSpec::new(
                "indices",
                ParamType::Ints,
                ParamDefault::Unset,
                "Four corners per patch, counted from 0: at uv (0, 0), (1, 0), (0, 1) and (1, 1); may be left out if \
                 there are just four.",
            )
            .range(0.0, f32::INFINITY),
            ParamSpec::new("N", ParamType::Normals, ParamDefault::Unset, "Shading normal of each corner."),
            ParamSpec::new(
                "uv",
                ParamType::Point2s,
                ParamDefault::Unset,
                "Texture coordinates of each corner; default (0, 0), (1, 0), (0, 1), (1, 1) on every patch.",
            ),
            ParamSpec::new(
                "faceIndices",
                ParamType::Ints,
                ParamDefault::Unset,
                "Number of each patch, by which \"ptex\" is looked up.",
            )
            .range(0.0, f32::INFINITY),
            ParamSpec::new(
                "emissionfilename",
                ParamType::Text,
                ParamDefault::Unset,
                "Where pbrt looks for light first, for less noise: no effect.",
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
        let points: Vec<Point3> = args.triples("P").into_iter().map(Point3::from).collect();
        let normals: Vec<Normal3> = args.triples("N").into_iter().map(Normal3::from).collect();
        let uvs: Vec<Point2> = args.pairs("uv").into_iter().map(Point2::from).collect();
        for (name, what, found) in [("N", "normals", normals.len()), ("uv", "texture coordinates", uvs.len())]
        {
            if found != 0 && found != points.len() {
                args.error(name, format!("{what} has {found} entries for {} vertices", points.len()));
            }
        }
        if let Some(vertex) = points.iter().position(|p| !p.is_finite()) {
            args.error("P", format!("vertex {vertex} is not finite"));
        }
        let quads = quads(args, points.len());
        let faces: Vec<u32> =
            args.ints("faceIndices").iter().map(|face| face.max(&0).unsigned_abs()).collect();
        if !faces.is_empty() && faces.len() != quads.len() {
            args.error("faceIndices", format!("{} numbers for {} patches", faces.len(), quads.len()));
        }
        let flat = |q: &[usize; 4]| {
            let [a, b, c, d] = q.map(|i| points.get(i).copied().unwrap_or(Point3::ZERO).to_f64());
            // The four triangles of a patch that is a line or a point have no area.
            let area = |p: DVec3, q: DVec3, r: DVec3| (q - p).cross(r - p) != DVec3::ZERO;
            !(area(a, b, c) || area(a, b, d) || area(a, c, d) || area(b, c, d))
        };
        if args.is_sound() && !quads.is_empty() && quads.iter().all(flat) {
            args.warning("P", "no patch has an area: nothing of this shape will be seen");
        }
        if Displacement::read(args).is_some() && args.is_sound() {
            return Some(Geometry::Mesh(Arc::new(triangles((&points, &normals, &uvs), &faces, &quads))));
        }
        let of = |(number, q): (usize, [usize; 4])| {
            let patch = Patch::new(q.map(|i| points[i])).numbered(faces.get(number).copied().unwrap_or(0));
            let patch = if normals.is_empty() { patch } else { patch.with_normals(q.map(|i| normals[i])) };
            Arc::new(if uvs.is_empty() { patch } else { patch.with_uvs(q.map(|i| uvs[i])) }) as Arc<dyn Shape>
        };
        args.is_sound().then(|| Geometry::Shapes(quads.into_iter().enumerate().map(of).collect()))
    }
}

/// Two triangles for each patch, as pbrt-v4 displaces quadrilaterals. Patches share no vertices, as each has its own
/// texture coordinates if none are given.
fn triangles(
    (points, normals, uvs): (&[Point3], &[Normal3], &[Point2]),
    faces: &[u32],
    quads: &[[usize; 4]],
) -> Mesh {
    let corner = |i: usize| Point2::new((i % 2) as f32, (i / 2) as f32);
    let corners = || quads.iter().flatten();
    Mesh {
        positions: corners().map(|&i| points[i]).collect(),
        normals: corners().filter_map(|&i| normals.get(i).copied()).collect(),
        uvs: match uvs.is_empty() {
            true => (0..4 * quads.len()).map(|i| corner(i % 4)).collect(),
            false => corners().map(|&i| uvs[i]).collect(),
        },
        faces: faces.iter().flat_map(|&face| [face; 2]).collect(),
        indices: (0..quads.len() as u32)
            .flat_map(|quad| [[0, 1, 3], [0, 3, 2]].map(|t| t.map(|i: u32| 4 * quad + i)))
            .collect(),
        ..Mesh::default()
    }
}

/// The corners of every patch, all in range if nothing was complained about.
fn quads(args: &mut Args<'_>, points: usize) -> Vec<[usize; 4]> {
    let indices = args.ints("indices");
    let (quads, rest) = indices.as_chunks::<4>();
    if !rest.is_empty() {
        args.error("indices", format!("\"indices\" has {} values, expected a multiple of 4", indices.len()));
    }
    if !args.is_set("indices") {
        if points != 4 {
            args.error("indices", format!("bilinearmesh needs \"integer indices\" for {points} vertices"));
        }
        return vec![[0, 1, 2, 3]];
    }
    for (patch, quad) in quads.iter().enumerate() {
        if let Some(bad) = quad.iter().find(|&&i| i.max(0) as usize >= points) {
            args.error(
                "indices",
                format!("patch {patch} refers to vertex {bad}, but there are only {points} vertices"),
            );
            break;
        }
    }
    quads.iter().map(|q| q.map(|i| i.max(0) as usize)).collect()
}
