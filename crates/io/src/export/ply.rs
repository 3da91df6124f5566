//! Meshes as PLY files, in little-endian bytes: what [`crate::import`] reads of them has the same bits.
//!
//! Tangents with their handedness and a second set of texture coordinates stand in columns that other programs pass over.
use durer_scene::Mesh;

/// The file; `None` if the format has no place for something of the mesh.
pub(super) fn bytes(mesh: &Mesh) -> Option<Vec<u8>> {
    // Its reader keeps colours to what is sensible.
    let is_color = |c: &[f32; 4]| c.iter().all(|v| *v >= 0.0 && v.is_finite()) && c[3] <= 1.0;
    if !mesh.later.is_empty() || mesh.indices.is_empty() || !mesh.colors.iter().all(is_color) {
        return None;
    }
    let columns: [(bool, &str); 5] = [
        (!mesh.normals.is_empty(), "nx ny nz"),
        (!mesh.uvs.is_empty(), "u v"),
        (!mesh.colors.is_empty(), "red green blue alpha"),
        (!mesh.tangents.is_empty(), "tangent_x tangent_y tangent_z tangent_w"),
        (!mesh.second_uvs.is_empty(), "u2 v2"),
    ];
    let names =
        std::iter::once("x y z").chain(columns.iter().filter(|(has, _)| *has).map(|(_, names)| *names));
    let names: Vec<&str> = names.flat_map(|names| names.split(' ')).collect();
    let mut head = format!("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", mesh.positions.len());
    names.iter().for_each(|name| head += &format!("property float {name}\n"));
    let numbers = if mesh.faces.is_empty() { "" } else { "property int face_indices\n" };
    head += &format!(
        "element face {}\nproperty list uchar int vertex_indices\n{numbers}end_header\n",
        mesh.indices.len()
    );
    let mut bytes = head.into_bytes();
    bytes.reserve(4 * names.len() * mesh.positions.len() + 13 * mesh.indices.len());
    for (vertex, p) in mesh.positions.iter().enumerate() {
        let mut put = |numbers: &[f32]| {
            if numbers.iter().any(|v| !v.is_finite()) {
                return false;
            }
            numbers.iter().for_each(|v| bytes.extend(v.to_le_bytes()));
            true
        };
        let sound = put(&p.to_array())
            && mesh.normals.get(vertex).is_none_or(|n| put(&n.to_array()))
            && mesh.uvs.get(vertex).is_none_or(|uv| put(&uv.to_array()))
            && mesh.colors.get(vertex).is_none_or(|c| put(c))
            && mesh.tangents.get(vertex).is_none_or(|t| put(t))
            && mesh.second_uvs.get(vertex).is_none_or(|uv| put(&uv.to_array()));
        if !sound {
            return None;
        }
    }
    for (triangle, corners) in mesh.indices.iter().enumerate() {
        bytes.push(3);
        for number in corners.iter().chain(mesh.faces.get(triangle)) {
            bytes.extend(i32::try_from(*number).ok()?.to_le_bytes());
        }
    }
    Some(bytes)
}
