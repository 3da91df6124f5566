//! Meshes of other formats as triangle meshes of the language.
use durer_scene::{Data, Mesh, Node, Params, ValueType};

/// The shape; an error says what of the mesh the language has no words for.
pub(super) fn node(mesh: &Mesh) -> Result<Node, String> {
    let more = [
        (!mesh.later.is_empty(), "its triangles move by keys"),
        (!mesh.tangents.is_empty(), "it has tangents of its own"),
        (!mesh.colors.is_empty(), "its corners have colours"),
        (!mesh.second_uvs.is_empty(), "it has a second set of texture coordinates"),
    ];
    if let Some((_, why)) = more.iter().find(|(has, _)| *has) {
        return Err((*why).to_owned());
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
    Ok(Node::new("trianglemesh", params))
}
