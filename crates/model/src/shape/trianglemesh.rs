//! The description of triangle meshes, still or with moving vertices.
//!
//! Vertices move on straight lines between keys: `P` is where they are at the first moment, `P1`, `P2`, ... at the later
//! ones; our addition to pbrt's language. Shading normals likewise with `N`, `N1`, `N2`, ... where they are given.
use std::sync::Arc;

use durer_core::math::{Normal3, Point2, Point3};
use durer_scene::{Args, Kind, Mesh, MeshError, ParamDefault, ParamSpec, ParamType, Schema, VertexKey};

use super::{
    ALPHA, Displacement, Geometry,
    displace::{DISPLACEMENT, DISPLACEMENT_EDGE_LENGTH, EDGE_LENGTH},
};

/// The word `trianglemesh`.
#[derive(Clone, Copy, Debug)]
pub struct TriangleMesh;

const fn key(name: &'static str, doc: &'static str) -> ParamSpec {
    ParamSpec::new(name, ParamType::Point3s, ParamDefault::Unset, doc).unit("m")
}

/// What [`ParamSpec::doc`] says of every key but the first.
const NEXT: &str = "Where the vertices are at the next moment.";

/// The parameters of the keys, in order.
const KEYS: [ParamSpec; 9] = [
    key("P1", "Where the vertices are at the second moment; they move on straight lines."),
    key("P2", NEXT),
    key("P3", NEXT),
    key("P4", NEXT),
    key("P5", NEXT),
    key("P6", NEXT),
    key("P7", NEXT),
    key("P8", NEXT),
    key("P9", NEXT),
];

const fn normal_key(name: &'static str) -> ParamSpec {
    ParamSpec::new(
        name,
        ParamType::Normals,
        ParamDefault::Unset,
        "The shading normals at that moment; default: N.",
    )
}

/// The shading normals of the keys, in order.
const NORMAL_KEYS: [ParamSpec; 9] = [
    normal_key("N1"),
    normal_key("N2"),
    normal_key("N3"),
    normal_key("N4"),
    normal_key("N5"),
    normal_key("N6"),
    normal_key("N7"),
    normal_key("N8"),
    normal_key("N9"),
];

impl Kind for TriangleMesh {
    type Output = Geometry;
    const SCHEMA: Schema = Schema {
        name: "trianglemesh",
        aliases: &[],
        doc: "Triangles. The outside is where vertices are seen counter-clockwise, unless vertex normals say otherwise.",
        params: &[
            ParamSpec::new("P", ParamType::Point3s, ParamDefault::Required, "Vertices.").unit("m"),
            ParamSpec::new(
                "indices",
                ParamType::Ints,
                ParamDefault::Unset,
                "Three vertices per triangle, counted from 0; may be left out if there are just three vertices.",
            )
            .range(0.0, f32::INFINITY),
            ParamSpec::new("N", ParamType::Normals, ParamDefault::Unset, "Shading normal of each vertex."),
            ParamSpec::new("S", ParamType::Vector3s, ParamDefault::Unset, "Shading tangent of each vertex."),
            ParamSpec::new("uv", ParamType::Point2s, ParamDefault::Unset, "Texture coordinates of each vertex."),
            ParamSpec::new(
                "uv2",
                ParamType::Point2s,
                ParamDefault::Unset,
                "A second set of them, for textures that ask for it.",
            ),
            ParamSpec::new(
                "handedness",
                ParamType::Floats,
                ParamDefault::Unset,
                "1 or -1 for each vertex with S: the bitangent is that times N x S; default: 1.",
            ),
            ParamSpec::new(
                "colors",
                ParamType::Floats,
                ParamDefault::Unset,
                "Linear red, green, blue and alpha of each vertex, by which materials multiply their colour.",
            ),
            KEYS[0],
            KEYS[1],
            KEYS[2],
            KEYS[3],
            KEYS[4],
            KEYS[5],
            KEYS[6],
            KEYS[7],
            KEYS[8],
            NORMAL_KEYS[0],
            NORMAL_KEYS[1],
            NORMAL_KEYS[2],
            NORMAL_KEYS[3],
            NORMAL_KEYS[4],
            NORMAL_KEYS[5],
            NORMAL_KEYS[6],
            NORMAL_KEYS[7],
            NORMAL_KEYS[8],
            ParamSpec::new(
                "times",
                ParamType::Floats,
                ParamDefault::Unset,
                "The moments of P, P1, ..., rising; default: from 0 to 1 in equal steps.",
            )
            .unit("s"),
            ParamSpec::new(
                "faceIndices",
                ParamType::Ints,
                ParamDefault::Unset,
                "Number of each triangle's face, by which \"ptex\" is looked up.",
            )
            .range(0.0, f32::INFINITY),
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
        let positions = points(args, "P");
        let indices = args.ints("indices");
        let (triples, rest) = indices.as_chunks::<3>();
        if !rest.is_empty() {
            let message = format!("\"indices\" has {} values, expected a multiple of 3", indices.len());
            args.error("indices", message);
        }
        let mut triangles: Vec<[u32; 3]> = triples.iter().map(|t| t.map(|i| i.max(0) as u32)).collect();
        if !args.is_set("indices") {
            triangles.push([0, 1, 2]);
            if positions.len() != 3 {
                let message =
                    format!("trianglemesh needs \"integer indices\" for {} vertices", positions.len());
                args.error("indices", message);
            }
        }
        let normals = args.triples("N").into_iter().map(Normal3::from).collect();
        let uvs = args.pairs("uv").into_iter().map(Point2::from).collect();
        let second_uvs = args.pairs("uv2").into_iter().map(Point2::from).collect();
        let (tangents, colors) = (tangents(args), colors(args));
        let (time, later) = keys(args);
        let indices = triangles;
        let faces = args.ints("faceIndices").iter().map(|face| face.max(&0).unsigned_abs()).collect();
        let mesh =
            Mesh { positions, indices, normals, uvs, second_uvs, faces, tangents, colors, time, later };
        if args.is_sound()
            && let Err(error) = mesh.validate()
        {
            let wrong = |k: &VertexKey| k.positions.len() != mesh.positions.len();
            let name = match error {
                MeshError::Index { .. } => "indices",
                MeshError::Length { attribute: "normals", .. } => "N",
                MeshError::Length { attribute: "tangents", .. } => "S",
                MeshError::Length { attribute: "colors", .. } => "colors",
                MeshError::Faces { .. } => "faceIndices",
                MeshError::Length { attribute: "second texture coordinates", .. } => "uv2",
                MeshError::Length { attribute: "normals of a vertex key", .. } => {
                    let wrong =
                        |k: &VertexKey| !k.normals.is_empty() && k.normals.len() != mesh.normals.len();
                    mesh.later
                        .iter()
                        .position(wrong)
                        .and_then(|key| NORMAL_KEYS.get(key))
                        .map_or("N", |k| k.name)
                }
                MeshError::Length { attribute: "vertex key", .. } => {
                    mesh.later.iter().position(wrong).and_then(|key| KEYS.get(key)).map_or("P", |k| k.name)
                }
                MeshError::Length { .. } => "uv",
                MeshError::Time { .. } => "times",
                MeshError::NotFinite { .. } => "P",
            };
            args.error(name, error.to_string());
        }
        args.is_sound().then(|| Geometry::Mesh(Arc::new(mesh)))
    }
}

fn points(args: &Args<'_>, name: &str) -> Vec<Point3> {
    args.triples(name).into_iter().map(Point3::from).collect()
}

/// `S` with its handedness; complains if there is not one for each.
fn tangents(args: &mut Args<'_>) -> Vec<[f32; 4]> {
    let (along, sides) = (args.triples("S"), args.floats("handedness").to_vec());
    if !sides.is_empty() && (sides.len() != along.len() || sides.iter().any(|w| w.abs() != 1.0)) {
        let message = format!("\"handedness\" must be 1 or -1 for each of the {} vectors of S", along.len());
        args.error("handedness", message);
    }
    let side = |i: usize| sides.get(i).copied().unwrap_or(1.0);
    along.into_iter().enumerate().map(|(i, [x, y, z])| [x, y, z, side(i)]).collect()
}

/// Four numbers each; complains if that does not come out even.
fn colors(args: &mut Args<'_>) -> Vec<[f32; 4]> {
    let (colors, rest) = args.floats("colors").as_chunks::<4>();
    let (colors, is_whole) = (colors.to_vec(), rest.is_empty());
    if !is_whole {
        args.error("colors", "\"colors\" needs four numbers for each vertex: red, green, blue and alpha");
    }
    colors
}

/// The moment of `P` and the keys after it; complains about gaps between them and moments that do not fit.
fn keys(args: &mut Args<'_>) -> (f32, Vec<VertexKey>) {
    let given = KEYS.iter().take_while(|k| args.is_set(k.name)).count();
    if let Some(stray) = KEYS.iter().skip(given).find(|k| args.is_set(k.name)) {
        let missing = KEYS[given].name;
        args.error(stray.name, format!("\"{}\" is given, but not \"{missing}\" before it", stray.name));
    }
    let times: Vec<f32> = match args.floats("times") {
        [] => (0..=given).map(|key| key as f32 / given.max(1) as f32).collect(),
        times => times.to_vec(),
    };
    if times.len() != given + 1 {
        let message =
            format!("\"times\" has {} moments, but there are {} of P, P1, ...", times.len(), given + 1);
        args.error("times", message);
        return (0.0, Vec::new());
    }
    if let Some(stray) = NORMAL_KEYS.iter().skip(given).find(|k| args.is_set(k.name)) {
        args.error(stray.name, format!("\"{}\" is given, but there is no such key of P", stray.name));
    }
    let moments = KEYS.iter().zip(&NORMAL_KEYS).zip(times.iter().skip(1));
    let key = |((key, normals), &time): ((&ParamSpec, &ParamSpec), &f32)| {
        let normals = args.triples(normals.name).into_iter().map(Normal3::from).collect();
        VertexKey { time, positions: points(args, key.name), normals }
    };
    let later = moments.map(key).collect();
    (times[0], later)
}
