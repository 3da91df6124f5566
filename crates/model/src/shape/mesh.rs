//! The surface of triangle meshes at a hit.
//!
//! `P = b_0 p_0 + b_1 p_1 + b_2 p_2` with `b_0 = 1 - u - v`, `b_1 = u`, `b_2 = v` (lecture, barycentric coordinates).
//! Partial derivatives solve `p_i = p + u_i dpdu + v_i dpdv` for the triangle's texture coordinates (Physically Based
//! Rendering, 4th edition, section 6.5.2); the error of the point is that of section 6.8.5. Finding the hit is the
//! kernel's business (`durer-accel`).
use durer_core::{
    glam::DVec3,
    math::{Frame, Normal3, Point2, Point3, Vector3, error::gamma},
};
use durer_scene::Mesh;

use crate::{Surface, texture::Footprint};

/// Weights of the three vertices of one triangle.
struct Weights {
    vertices: [usize; 3],
    b: [f32; 3],
}

impl Weights {
    /// The weighted sum of an attribute; `None` if the mesh has none.
    fn sum<T: Copy, const N: usize>(&self, list: &[T], numbers: impl Fn(T) -> [f32; N]) -> Option<[f32; N]> {
        let [p, q, r] = self.vertices.map(|i| list.get(i).copied().map(&numbers));
        let (p, q, r) = (p?, q?, r?);
        Some(self.mean([p, q, r]))
    }
    /// The weighted sum of the vertices' numbers.
    fn mean<const N: usize>(&self, [p, q, r]: [[f32; N]; 3]) -> [f32; N] {
        std::array::from_fn(|i| self.b[0] * p[i] + self.b[1] * q[i] + self.b[2] * r[i])
    }
}

/// The place where triangle `prim` of a valid `mesh` was hit at `time`, in object space; `u` and `v`, the notes of the
/// hit, weigh its vertices 1 and 2.
///
/// The geometric normal follows the counter-clockwise winding, turned to the side of the vertex normals if there are any
/// (as pbrt does). A triangle without area gets the z axis if nothing better is known.
pub fn mesh_surface(mesh: &Mesh, prim: u32, [u, v]: [f32; 2], time: f32) -> Surface {
    let vertices = mesh.indices[prim as usize].map(|i| i as usize);
    let weights = Weights { vertices, b: [1.0 - u - v, u, v] };
    let [p0, p1, p2] = mesh.corners(vertices, time).map(Point3::to_f64);
    let (b1, b2) = (f64::from(u), f64::from(v));
    // In f64: rounding b_0 to f32 would move the point off the plane by more than the bound when b_0 is small.
    let b0 = 1.0 - b1 - b2;
    let p = Point3::from_f64(p0 * b0 + p1 * b1 + p2 * b2);
    let p_error = Vector3::from_f64((p0 * b0).abs() + (p1 * b1).abs() + (p2 * b2).abs()) * gamma(7);

    let normals = mesh.corner_normals(vertices, time);
    let shading = normals.map(|n| Normal3::from(weights.mean(n.map(Normal3::to_array)))).and_then(unit);
    let winding = Some(Normal3::from_f64((p1 - p0).cross(p2 - p0).normalize_or_zero()));
    let winding = winding.filter(|n| *n != Normal3::ZERO);
    let n_g = match (winding, shading) {
        (Some(n), Some(s)) => n.face_forward(s),
        (Some(n), None) | (None, Some(n)) => n,
        (None, None) => Normal3::new(0.0, 0.0, 1.0),
    };
    let n_s = shading.unwrap_or(n_g);
    let (uv, along) = match mesh.uvs.as_slice() {
        // As if the corners were at (0, 0), (1, 0) and (1, 1).
        [] => (Point2::new(u + v, v), spanning(p1 - p0, p2 - p1)),
        uvs => {
            let uvs = vertices.map(|i| uvs[i]);
            (Point2::from(weights.mean(uvs.map(Point2::to_array))), partials([p0, p1, p2], uvs))
        }
    };
    let (dpdu, dpdv) = tangents(mesh, &weights, n_s).or(along).unwrap_or_else(|| {
        let frame = Frame::from_z(n_g);
        (frame.x, frame.y)
    });
    Surface {
        p,
        p_error,
        n_g,
        n_s,
        uv,
        second_uv: weights.sum(&mesh.second_uvs, Point2::to_array).map_or(uv, Point2::from),
        face: mesh.faces.get(prim as usize).copied().unwrap_or(0),
        dpdu,
        dpdv,
        vertex_color: weights.sum(&mesh.colors, |c| c).unwrap_or([1.0; 4]),
        footprint: Footprint::POINT,
    }
}

/// `n` at unit length; `None` if it has no direction.
fn unit(n: Normal3) -> Option<Normal3> {
    let n = Normal3::from_f64(n.to_f64().normalize_or_zero());
    (n != Normal3::ZERO && n.is_finite()).then_some(n)
}

/// The frame of the vertices' tangents: `dpdu = t`, `dpdv = w cross(n, t)` (glTF 2.0, section 3.7.2.1).
fn tangents(mesh: &Mesh, weights: &Weights, n: Normal3) -> Option<(Vector3, Vector3)> {
    let [x, y, z, _] = weights.sum(&mesh.tangents, |t| t)?;
    let t = Vector3::new(x, y, z);
    // Handedness is the same at all three vertices of a sound file; a mean of both would be no handedness.
    let w = mesh.tangents[weights.vertices[0]][3];
    let b = n.cross(t) * w;
    (b.length_squared() > 0.0 && b.is_finite()).then_some((t, b))
}

/// The derivatives of the point by the texture coordinates; `None` if those, or the vertices, span no area.
fn partials([p0, p1, p2]: [DVec3; 3], uvs: [Point2; 3]) -> Option<(Vector3, Vector3)> {
    let [(u0, v0), (u1, v1), (u2, v2)] = uvs.map(|c| (f64::from(c.x), f64::from(c.y)));
    let (du02, dv02, du12, dv12) = (u0 - u2, v0 - v2, u1 - u2, v1 - v2);
    let (dp02, dp12) = (p0 - p2, p1 - p2);
    let determinant = du02 * dv12 - dv02 * du12;
    let per = 1.0 / determinant;
    spanning((dp02 * dv12 - dp12 * dv02) * per, (dp12 * du02 - dp02 * du12) * per)
}

/// Both in f32; `None` if they span no area.
fn spanning(dpdu: DVec3, dpdv: DVec3) -> Option<(Vector3, Vector3)> {
    let (dpdu, dpdv) = (Vector3::from_f64(dpdu), Vector3::from_f64(dpdv));
    let area2 = dpdu.to_f64().cross(dpdv.to_f64()).length_squared();
    (area2 > 0.0 && area2 < f64::INFINITY).then_some((dpdu, dpdv))
}
