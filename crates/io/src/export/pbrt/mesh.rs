//! Meshes of other formats as triangle meshes of the language, or in files of their own.
use durer_scene::{Data, Mesh, Node, Params, ValueType};

use crate::export::{Content, beside::Gathered, ply};

/// Triangles of a mesh that is not in the way of those who read the text.
const FEW: usize = 2000;

/// Writes a mesh that is large, or that `several` shapes have, into a file: those that name the same file share what is
/// built from it. `None` if it belongs into the text.
pub(super) fn file(
    mesh: &Mesh,
    several: bool,
    (gathered, number): (&mut Gathered<'_>, usize),
) -> Option<Node> {
    if mesh.indices.len() <= FEW && !several {
        return None;
    }
    let path = gathered.add(&format!("mesh-{number}.ply"), Content::Bytes(ply::bytes(mesh)?.into()));
    Some(Node::new("plymesh", Params::new().string("filename", &path)))
}

/// The shape; an error says what of the mesh the language has no words for.
pub(super) fn node(mesh: &Mesh) -> Result<Node, String> {
    if !mesh.later.is_empty() {
        return Err("its triangles move by keys".to_owned());
    }
    let indices = mesh.indices.iter().flatten().map(|&i| i32::try_from(i));
    let indices =
        indices.collect::<Result<Vec<i32>, _>>().map_err(|_| "it has too many corners".to_owned())?;
    let floats = |list: Vec<f32>| Data::Floats(list);
    let positions = mesh.positions.iter().flat_map(|p| p.to_array()).collect();
    let mut params = Params::new().with("indices", ValueType::Integer, Data::Ints(indices)).with(
        "P",
        ValueType::Point3,
        floats(positions),
    );
    if !mesh.normals.is_empty() {
        let normals = mesh.normals.iter().flat_map(|n| n.to_array()).collect();
        params = params.with("N", ValueType::Normal, floats(normals));
    }
    if !mesh.uvs.is_empty() {
        let uvs = mesh.uvs.iter().flat_map(|uv| [uv.x, uv.y]).collect();
        params = params.with("uv", ValueType::Point2, floats(uvs));
    }
    if !mesh.second_uvs.is_empty() {
        let uvs = mesh.second_uvs.iter().flat_map(|uv| [uv.x, uv.y]).collect();
        params = params.with("uv2", ValueType::Point2, floats(uvs));
    }
    if !mesh.faces.is_empty() {
        let faces: Option<Vec<i32>> = mesh.faces.iter().map(|face| i32::try_from(*face).ok()).collect();
        let faces = faces.ok_or("the number of a face is too large")?;
        params = params.with("faceIndices", ValueType::Integer, Data::Ints(faces));
    }
    if !mesh.tangents.is_empty() {
        let along = mesh.tangents.iter().flat_map(|[x, y, z, _]| [*x, *y, *z]).collect();
        let sides = mesh.tangents.iter().map(|[.., w]| *w).collect();
        params = params.with("S", ValueType::Vector3, floats(along)).with(
            "handedness",
            ValueType::Float,
            floats(sides),
        );
    }
    if !mesh.colors.is_empty() {
        params =
            params.with("colors", ValueType::Float, floats(mesh.colors.iter().flatten().copied().collect()));
    }
    Ok(Node::new("trianglemesh", params))
}
