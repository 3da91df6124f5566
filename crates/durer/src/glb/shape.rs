//! Shapes as meshes: triangles as they are, everything else cut into triangles.
use std::{collections::HashMap, sync::Arc};

use durer_core::{
    glam::DVec3,
    math::{Normal3, Point2, Point3},
};
use durer_model::shape::{Geometry, Outline, SHAPES, Shape};
use durer_scene::{Args, Diagnostics, Mesh, Missing, Node, ShapeDesc, ShapeSource, find};
use serde_json::{Value, json};

use super::Writer;

/// Squares along the edges of a curved shape: the outline of a sphere then passes by the middles of its edges at a
/// two-thousandth of the radius.
const GRID: u32 = 64;
/// Half the edge of what is kept of an endless plane, in metres.
const PLANE: f64 = 1000.0;

/// Primitives by what they are made of, and meshes by these and the material.
#[derive(Default)]
pub(super) struct Known {
    built: HashMap<*const Node, Vec<Arc<Mesh>>>,
    /// The attributes and indices of a mesh, turned inside out or not.
    primitives: HashMap<(*const Mesh, bool), Value>,
    meshes: HashMap<(*const Mesh, bool, Option<usize>), usize>,
}

impl Writer<'_> {
    pub(super) fn shapes(&mut self) {
        for index in 0..self.desc.shapes.len() {
            let shape = &self.desc.shapes[index];
            let name = shape.name.clone();
            let called = if name.is_empty() { format!("shape {index}") } else { name.clone() };
            let material = self.material_of(shape, &called);
            let place = self.placed(&shape.world_from_object, &called);
            for mesh in self.meshes_of(index, &called) {
                if mesh.indices.is_empty() {
                    continue;
                }
                let number = self.mesh(&mesh, (self.desc.shapes[index].reverse_orientation, material), &name);
                self.node(&name, &place, json!({ "mesh": number }));
            }
        }
    }

    /// The triangles of a shape; parts apart.
    fn meshes_of(&mut self, index: usize, called: &str) -> Vec<Arc<Mesh>> {
        let ShapeDesc { source, .. } = &self.desc.shapes[index];
        match source {
            ShapeSource::Mesh(id) => self.desc.meshes.get(id.index()).cloned().into_iter().collect(),
            ShapeSource::Node(node) => {
                let key = Arc::as_ptr(node);
                if let Some(known) = self.memo.shapes.built.get(&key) {
                    return known.clone();
                }
                let built = self.built(node, called);
                self.memo.shapes.built.insert(key, built.clone());
                built
            }
        }
    }

    fn built(&mut self, node: &Node, called: &str) -> Vec<Arc<Mesh>> {
        let mut said = Diagnostics::default();
        let Some(entry) = find(SHAPES, "shape", node, &mut said) else {
            self.warn(format!("\"{called}\" is left out: durer has no shape \"{}\"", node.kind));
            return Vec::new();
        };
        let mut args = Args::check(node, entry.schema, &self.desc.textures, &mut said)
            .with_assets(self.whole.assets, Missing::Warn);
        if node.params.get("displacement").is_some() {
            self.warn(format!("\"{called}\" is written as it is before it is displaced"));
        }
        match (entry.build)(&mut args) {
            Some(Geometry::Mesh(mesh)) => vec![mesh],
            Some(Geometry::Shapes(parts)) => {
                let mut all = Mesh::default();
                for part in parts {
                    self.cut(&*part, called, &mut all);
                }
                vec![Arc::new(all)]
            }
            Some(Geometry::Strands(_)) => {
                self.warn(format!("\"{called}\" is left out: glTF has no curves"));
                Vec::new()
            }
            None => Vec::new(),
        }
    }

    /// Adds a shape as triangles.
    fn cut(&mut self, shape: &dyn Shape, called: &str, mesh: &mut Mesh) {
        let first = mesh.positions.len() as u32;
        let mut put = |p: DVec3, n: DVec3| {
            mesh.positions.push(Point3::from_f64(p));
            mesh.normals.push(Normal3::from_f64(n));
        };
        match shape.outline() {
            Outline::Parallelogram(corner, [a, b]) => {
                let n = a.cross(b).normalize_or_zero();
                [corner, corner + a, corner + a + b, corner + b].into_iter().for_each(|p| put(p, n));
                mesh.indices.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
            }
            Outline::Triangles(triangles) | Outline::Near(triangles) => {
                for (at, [a, b, c]) in (first..).step_by(3).zip(triangles) {
                    let n = (b - a).cross(c - a).normalize_or_zero();
                    [a, b, c].into_iter().for_each(|p| put(p, n));
                    mesh.indices.push([at, at + 1, at + 2]);
                }
            }
            Outline::Sphere { .. } | Outline::Curved => {
                let mut grid = Vec::new();
                for j in 0..=GRID {
                    for i in 0..=GRID {
                        let u = [i, j].map(|i| (i as f32 / GRID as f32).min(1.0f32.next_down()));
                        let Some(at) = shape.by_area(Point2::new(u[0], u[1])) else { return };
                        grid.push((at.p, at.n));
                    }
                }
                let edge = GRID + 1;
                if let Some(corners) = flat(&grid) {
                    corners.into_iter().for_each(|(p, n)| put(p, n));
                    add_square(mesh, [0, 1, 2, 3].map(|i| first + i));
                    return;
                }
                grid.into_iter().for_each(|(p, n)| put(p, n));
                for j in 0..GRID {
                    for i in 0..GRID {
                        let a = first + j * edge + i;
                        add_square(mesh, [a, a + 1, a + edge + 1, a + edge]);
                    }
                }
                let number = 2 * GRID * GRID;
                self.warn(format!(
                    "\"{called}\" is curved: it becomes {number} triangles, without texture coordinates"
                ));
            }
            Outline::Infinite => {
                self.warn(format!("\"{called}\" has no end: a square of {} m of it is kept", 2.0 * PLANE));
                let Some((p, n)) = plane(shape) else { return };
                let (u, v) = n.any_orthonormal_pair();
                let (u, v) = (u * PLANE, v * PLANE);
                [p - u - v, p + u - v, p + u + v, p - u + v].into_iter().for_each(|p| put(p, n));
                add_square(mesh, [0, 1, 2, 3].map(|i| first + i));
            }
        }
    }

    /// The number of a mesh with a material.
    fn mesh(&mut self, mesh: &Arc<Mesh>, (turned, material): (bool, Option<usize>), name: &str) -> usize {
        let key = (Arc::as_ptr(mesh), turned, material);
        if let Some(known) = self.memo.shapes.meshes.get(&key) {
            return *known;
        }
        let mut primitive = match self.memo.shapes.primitives.get(&(key.0, turned)) {
            Some(known) => known.clone(),
            None => {
                let new = self.primitive(mesh, turned);
                self.memo.shapes.primitives.insert((key.0, turned), new.clone());
                new
            }
        };
        if let Some(material) = material {
            primitive["material"] = material.into();
        }
        let mut written = json!({ "primitives": [primitive] });
        if !name.is_empty() {
            written["name"] = name.into();
        }
        self.meshes.push(written);
        self.memo.shapes.meshes.insert(key, self.meshes.len() - 1);
        self.meshes.len() - 1
    }

    fn primitive(&mut self, mesh: &Mesh, turned: bool) -> Value {
        let sign = if turned { -1.0 } else { 1.0 };
        let positions: Vec<[f32; 3]> = mesh.positions.iter().map(|p| p.to_array()).collect();
        let bin = &mut self.bin;
        let mut attributes = json!({ "POSITION": bin.positions(&positions) });
        if !mesh.normals.is_empty() {
            let normals: Vec<[f32; 3]> =
                mesh.normals.iter().map(|n| n.to_array().map(|v| sign * v)).collect();
            attributes["NORMAL"] = bin.vectors(&normals).into();
        }
        // v grows downwards in glTF.
        let flipped = |uvs: &[Point2]| -> Vec<[f32; 2]> { uvs.iter().map(|uv| [uv.x, 1.0 - uv.y]).collect() };
        if !mesh.uvs.is_empty() {
            attributes["TEXCOORD_0"] = bin.vectors(&flipped(&mesh.uvs)).into();
        }
        if !mesh.second_uvs.is_empty() {
            attributes["TEXCOORD_1"] = bin.vectors(&flipped(&mesh.second_uvs)).into();
        }
        if !mesh.tangents.is_empty() && !mesh.normals.is_empty() {
            let tangents: Vec<[f32; 4]> =
                mesh.tangents.iter().map(|[x, y, z, w]| [*x, *y, *z, sign * w]).collect();
            attributes["TANGENT"] = bin.vectors(&tangents).into();
        }
        if !mesh.colors.is_empty() {
            attributes["COLOR_0"] = bin.vectors(&mesh.colors).into();
        }
        let turn = |[a, b, c]: [u32; 3]| if turned { [a, c, b] } else { [a, b, c] };
        let indices = bin.indices(mesh.indices.iter().flat_map(|t| turn(*t)));
        json!({ "attributes": attributes, "indices": indices })
    }
}

/// A point and its normal.
type Place = (DVec3, DVec3);

/// The corners of a grid of points that lies in a plane and has straight edges.
fn flat(grid: &[Place]) -> Option<[Place; 4]> {
    let edge = GRID as usize + 1;
    let corners = [0, edge - 1, edge * edge - 1, edge * (edge - 1)].map(|i| grid[i]);
    let [a, b, c, d] = corners.map(|(p, _)| p);
    let size = (c - a).length().max((d - b).length());
    let n = (c - a).cross(d - b).normalize_or_zero();
    // Points are chosen in single precision.
    let near = 1e-5 * size;
    let is_on = |p: DVec3, from: DVec3, to: DVec3| {
        let along = (to - from).normalize_or_zero();
        (p - from).cross(along).length() <= near
    };
    let in_plane = |(p, _): &Place| (*p - a).dot(n).abs() <= near;
    let straight = (0..edge).all(|i| {
        let last = edge - 1;
        is_on(grid[i].0, a, b)
            && is_on(grid[i * edge + last].0, b, c)
            && is_on(grid[last * edge + i].0, d, c)
            && is_on(grid[i * edge].0, a, d)
    });
    (n != DVec3::ZERO && straight && grid.iter().all(in_plane)).then_some(corners)
}

/// Two triangles that are seen counter-clockwise from where their normals point; none where they have no area.
fn add_square(mesh: &mut Mesh, [a, b, c, d]: [u32; 4]) {
    for [i, j, k] in [[a, b, c], [a, c, d]] {
        let [p, q, r] = [i, j, k].map(|i| mesh.positions[i as usize].to_f64());
        let side = (q - p).cross(r - p);
        let normal = [i, j, k].iter().map(|i| mesh.normals[*i as usize].to_f64()).sum::<DVec3>();
        match side.dot(normal) {
            s if s > 0.0 => mesh.indices.push([i, j, k]),
            s if s < 0.0 => mesh.indices.push([i, k, j]),
            _ => {}
        }
    }
}

/// A point of an endless plane, and its normal: rays along the axes meet it.
fn plane(shape: &dyn Shape) -> Option<(DVec3, DVec3)> {
    use durer_core::math::{Ray, Vector3};
    let axes = [Vector3::new(1.0, 0.0, 0.0), Vector3::new(0.0, 1.0, 0.0), Vector3::new(0.0, 0.0, 1.0)];
    // Not from the origin, which may lie in it.
    let from = Point3::new(0.137, 0.731, -0.337);
    axes.into_iter().flat_map(|d| [d, -d]).find_map(|d| {
        let ray = Ray::new(from, d);
        let hit = shape.intersect(&ray)?;
        let surface = shape.surface(&ray, &hit);
        let n = surface.n_g.to_f64();
        // The foot of the origin.
        Some((n * n.dot(surface.p.to_f64()), n))
    })
}
