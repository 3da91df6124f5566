//! Displacement: triangles are split until none has a long edge, and vertices move along their normals by what a texture says.
//!
//! As pbrt-v4's `TriQuadMesh::Displace`: a triangle is split at the middle of its longest edge (Rivara 1984) until all three are
//! shorter than `edgelength` in the world. Whether an edge is split depends on it alone, so that neighbours agree and no gaps
//! open. Vertices at one place that differ in texture coordinates are one in matters of normals, where pbrt lets seams open.
use std::collections::HashMap;

use durer_core::{
    glam::DVec3,
    math::{Normal3, Point2, Point3},
};
use durer_scene::{Args, FloatInput, Mesh, ParamDefault, ParamSpec, ParamType};

/// Most triangles made.
pub const MOST_TRIANGLES: usize = 1 << 23;

/// What moves the vertices.
pub(super) const DISPLACEMENT: ParamSpec = ParamSpec::new(
    "displacement",
    ParamType::FloatTexture,
    ParamDefault::Unset,
    "How far the surface moves along its normals: for real, unlike that of a material.",
);
/// How fine the mesh becomes.
pub(super) const EDGE_LENGTH: ParamSpec = ParamSpec::float(
    "edgelength",
    1.0,
    "Displaced triangles are split until their edges are shorter, in the world; at most 8388608 triangles are made.",
)
.unit("m")
.above(0.0, f32::INFINITY);
/// The same as pbrt's manual calls it.
pub(super) const DISPLACEMENT_EDGE_LENGTH: ParamSpec = ParamSpec::new(
    "displacement.edgelength",
    ParamType::Float,
    ParamDefault::Unset,
    "The same, as pbrt's manual has it.",
)
.unit("m")
.above(0.0, f32::INFINITY);

/// How a mesh is displaced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Displacement {
    /// How far, in the mesh's own space.
    pub by: FloatInput,
    /// All edges become shorter, in metres.
    pub edge_length: f32,
}

impl Displacement {
    /// As the parameters of a mesh say; `None` if it is not displaced.
    pub fn read(args: &mut Args<'_>) -> Option<Self> {
        let other = args.optional_float(DISPLACEMENT_EDGE_LENGTH.name);
        if !args.is_set(DISPLACEMENT.name) {
            for name in [EDGE_LENGTH.name, DISPLACEMENT_EDGE_LENGTH.name] {
                if args.is_set(name) {
                    args.warning(name, format!("\"{name}\" has no effect without \"displacement\""));
                }
            }
            return None;
        }
        if other.is_some() && args.is_set(EDGE_LENGTH.name) {
            let message = "both \"edgelength\" and \"displacement.edgelength\" are given: they mean the same";
            args.error(DISPLACEMENT_EDGE_LENGTH.name, message);
        }
        let edge_length = other.unwrap_or_else(|| args.float(EDGE_LENGTH.name));
        Some(Self { by: args.float_input(DISPLACEMENT.name), edge_length })
    }
}

/// A vertex that is to move.
#[derive(Clone, Copy, Debug)]
pub struct Vertex {
    /// Where it is.
    pub p: Point3,
    /// Unit normal; zero if it has none.
    pub n: Normal3,
    /// Texture coordinates.
    pub uv: Point2,
    /// The second set; the first where there is none.
    pub second_uv: Point2,
    /// Linear RGBA factor.
    pub color: [f32; 4],
}

/// The mesh, split and moved. `is_long` says of the ends of an edge whether it must be split, `by` how far a vertex moves along its
/// normal.
///
/// # Errors
/// Why this mesh cannot be displaced, as a sentence.
pub fn displaced(
    mesh: &Mesh,
    length: impl Fn(Point3, Point3) -> f32,
    edge_length: f32,
    by: impl Fn(&Vertex) -> f32,
) -> Result<Mesh, String> {
    if !mesh.is_still() {
        return Err("vertices that move cannot be displaced: leave the keys of their motion out".to_owned());
    }
    let mut fine = Mesh { tangents: Vec::new(), indices: Vec::new(), faces: Vec::new(), ..mesh.clone() };
    if fine.normals.is_empty() {
        fine.normals = normals(&mesh.positions, &mesh.indices);
    }
    split(&mut fine, (&mesh.indices, &mesh.faces), length, edge_length)?;
    let is_turned = is_turned(mesh);
    let moved: Vec<Point3> = (0..fine.positions.len())
        .map(|i| {
            let uv = fine.uvs.get(i).copied().unwrap_or_default();
            let n = fine.normals[i].to_f64().normalize_or_zero();
            let vertex = Vertex {
                p: fine.positions[i],
                n: Normal3::from_f64(n),
                uv,
                second_uv: fine.second_uvs.get(i).copied().unwrap_or(uv),
                color: fine.colors.get(i).copied().unwrap_or([1.0; 4]),
            };
            Point3::from_f64(vertex.p.to_f64() + n * f64::from(by(&vertex)))
        })
        .collect();
    if let Some(vertex) = moved.iter().position(|p| !p.is_finite()) {
        return Err(format!("vertex {vertex} is displaced to where no number is"));
    }
    fine.normals = normals(&moved, &fine.indices);
    if is_turned {
        fine.normals.iter_mut().for_each(|n| *n = -*n);
    }
    fine.positions = moved;
    Ok(fine)
}

/// Splits `triangles`, whose vertices the mesh has, until no edge is long.
fn split(
    mesh: &mut Mesh,
    (triangles, faces): (&[[u32; 3]], &[u32]),
    length: impl Fn(Point3, Point3) -> f32,
    edge_length: f32,
) -> Result<(), String> {
    let too_many = || {
        Err(format!(
            "displacement makes more than {MOST_TRIANGLES} triangles with edges shorter than {edge_length} m: take a larger \
             \"edgelength\""
        ))
    };
    // None with such edges is larger than that of equal ones: what is hopeless is refused before it takes memory.
    let largest = 0.25 * 3f64.sqrt() * f64::from(edge_length).powi(2);
    let area: f64 = triangles.iter().map(|t| area(t.map(|i| mesh.positions[i as usize]), &length)).sum();
    if area / largest > MOST_TRIANGLES as f64 {
        return too_many();
    }
    let mut middles: HashMap<(u32, u32), u32> = HashMap::new();
    let mut open = Vec::new();
    let mut count = triangles.len();
    for (number, &triangle) in triangles.iter().enumerate() {
        open.push(triangle);
        while let Some([a, b, c]) = open.pop() {
            let [p, q, r] = [a, b, c].map(|i| mesh.positions[i as usize]);
            let (ab, bc, ca) = (length(p, q), length(q, r), length(r, p));
            let longest = ab.max(bc).max(ca);
            if longest < edge_length {
                mesh.indices.push([a, b, c]);
                mesh.faces.extend(faces.get(number));
                continue;
            }
            // So that the first two vertices have the longest edge.
            let [a, b, c] = match longest {
                l if l == ab => [a, b, c],
                l if l == bc => [b, c, a],
                _ => [c, a, b],
            };
            count += 1;
            if count > MOST_TRIANGLES {
                return too_many();
            }
            let middle = *middles.entry((a.min(b), a.max(b))).or_insert_with(|| between(mesh, a, b));
            // The last in is the first out: halves come in the order of the triangle.
            open.push([middle, b, c]);
            open.push([a, middle, c]);
        }
    }
    Ok(())
}

/// Area by the lengths of the edges (Heron).
fn area([p, q, r]: [Point3; 3], length: impl Fn(Point3, Point3) -> f32) -> f64 {
    let [a, b, c] = [length(p, q), length(q, r), length(r, p)].map(f64::from);
    let s = 0.5 * (a + b + c);
    (s * (s - a) * (s - b) * (s - c)).max(0.0).sqrt()
}

/// Adds the vertex in the middle of two.
fn between(mesh: &mut Mesh, a: u32, b: u32) -> u32 {
    let (a, b) = (a as usize, b as usize);
    let half = |a: DVec3, b: DVec3| 0.5 * (a + b);
    let uv = |set: &mut Vec<Point2>| {
        if let (Some(p), Some(q)) = (set.get(a), set.get(b)) {
            set.push(Point2::new(0.5 * (p.x + q.x), 0.5 * (p.y + q.y)));
        }
    };
    uv(&mut mesh.uvs);
    uv(&mut mesh.second_uvs);
    if let (Some(p), Some(q)) = (mesh.colors.get(a), mesh.colors.get(b)) {
        let color = std::array::from_fn(|i| 0.5 * (p[i] + q[i]));
        mesh.colors.push(color);
    }
    let [m, n] = [a, b].map(|i| mesh.normals[i].to_f64().normalize_or_zero());
    mesh.normals.push(Normal3::from_f64(half(m, n).normalize_or_zero()));
    let [p, q] = [a, b].map(|i| mesh.positions[i].to_f64());
    mesh.positions.push(Point3::from_f64(half(p, q)));
    mesh.positions.len() as u32 - 1
}

/// The sum of the normals of the triangles around each place, by area, of unit length; zero where there are none.
fn normals(positions: &[Point3], indices: &[[u32; 3]]) -> Vec<Normal3> {
    let mut places: HashMap<[u32; 3], usize> = HashMap::new();
    let place_of: Vec<usize> = positions
        .iter()
        .map(|p| {
            // 0 and -0 are one place.
            let key = p.to_array().map(|v| (v + 0.0).to_bits());
            let next = places.len();
            *places.entry(key).or_insert(next)
        })
        .collect();
    let mut sums = vec![DVec3::ZERO; places.len()];
    for triangle in indices {
        let n = normal(positions, triangle);
        triangle.iter().for_each(|&i| sums[place_of[i as usize]] += n);
    }
    place_of.into_iter().map(|place| Normal3::from_f64(sums[place].normalize_or_zero())).collect()
}

/// Twice the area, along the normal.
fn normal(positions: &[Point3], triangle: &[u32; 3]) -> DVec3 {
    let [p, q, r] = triangle.map(|i| positions[i as usize].to_f64());
    (q - p).cross(r - p)
}

/// Whether the normals of vertices are on the other side of most of the surface.
fn is_turned(mesh: &Mesh) -> bool {
    let sum: f64 = mesh
        .indices
        .iter()
        .map(|triangle| {
            let own = triangle.iter().filter_map(|&i| mesh.normals.get(i as usize));
            let own = own.fold(DVec3::ZERO, |sum, n| sum + n.to_f64());
            own.dot(normal(&mesh.positions, triangle))
        })
        .sum();
    sum < 0.0
}

#[cfg(test)]
mod tests;
