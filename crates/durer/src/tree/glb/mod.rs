//! The rays as coloured lines in their scene: binary glTF 2.0, which any viewer opens.
//!
//! glTF is right-handed. A world whose camera is left-handed (pbrt's) is mirrored at x = 0, so that what was on the right
//! of the picture stays there.
use serde_json::{Value, json};

use crate::glam::{DAffine3, DMat3, DVec3};

use super::{
    document::Tree,
    ghost::{GhostObject, GhostScene},
    look::Look,
    number::Place,
    page::Page,
};
use crate::glb::bin::{Bin, container};

/// Why no file was made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooLarge;

impl std::fmt::Display for TooLarge {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("it would have more than 4 GiB, which glTF has no room for")
    }
}

impl std::error::Error for TooLarge {}

/// A scene on its way into a file.
struct Writer {
    buffer: Bin,
    meshes: Vec<Value>,
    materials: Vec<Value>,
    nodes: Vec<Value>,
    mirror: DVec3,
    /// What all positions are relative to, so that far scenes keep their digits.
    origin: DVec3,
}

/// All trees of a page as lines, a mesh for each kind of ray, in the scene if the page has one.
///
/// # Errors
/// If it would be too large.
pub fn glb(page: &Page) -> Result<Vec<u8>, TooLarge> {
    let scene = page.scene.as_ref();
    let camera = scene.map(|s| &s.camera);
    let axis = |v: [super::number::Number; 3]| DVec3::from_array(v.map(|v| f64::from(v.0)));
    let left_handed = camera.is_some_and(|c| axis(c.right).cross(axis(c.up)).dot(axis(c.look)) > 0.0);
    let first = page.trees.iter().flat_map(|t| &t.nodes).next().map(|n| vector(n.origin)).unwrap_or_default();
    let mut writer = Writer {
        buffer: Bin::default(),
        meshes: Vec::new(),
        materials: Vec::new(),
        nodes: Vec::new(),
        mirror: DVec3::new(if left_handed { -1.0 } else { 1.0 }, 1.0, 1.0),
        origin: first.round(),
    };
    if let Some(scene) = scene {
        scene.objects.iter().for_each(|o| writer.object(o));
        writer.camera(scene);
    }
    let span = scene.map_or(10.0, |s| (vector(s.bounds[1]) - vector(s.bounds[0])).length().max(1e-3));
    writer.rays(&page.trees, span);
    writer.finish()
}

fn vector(p: Place) -> DVec3 {
    DVec3::from_array(p.map(|v| v.0))
}

impl Writer {
    fn place(&self, p: DVec3) -> [f32; 3] {
        (self.mirror * (p - self.origin)).to_array().map(|v| v as f32)
    }

    fn material(&mut self, name: &str, color: [f32; 3], ghost: bool) -> usize {
        let [r, g, b] = color.map(|v| if v.is_finite() { v.clamp(0.0, 1.0) } else { 0.0 });
        let mut material = json!({
            "name": name,
            "doubleSided": true,
            "pbrMetallicRoughness": {
                "baseColorFactor": [r, g, b, if ghost { 0.3 } else { 1.0 }], "metallicFactor": 0, "roughnessFactor": 1
            }
        });
        if ghost {
            material["alphaMode"] = "BLEND".into();
        } else {
            material["extensions"] = json!({ "KHR_materials_unlit": {} });
        }
        self.materials.push(material);
        self.materials.len() - 1
    }

    fn mesh(
        &mut self,
        name: &str,
        points: &[[f32; 3]],
        indices: &[u32],
        (mode, material): (u8, usize),
    ) -> usize {
        let (positions, indices) =
            (self.buffer.positions(points), self.buffer.indices(indices.iter().copied()));
        let primitive = json!({
            "attributes": { "POSITION": positions }, "indices": indices, "mode": mode, "material": material
        });
        self.meshes.push(json!({ "name": name, "primitives": [primitive] }));
        self.meshes.len() - 1
    }

    fn object(&mut self, object: &GhostObject) {
        let color = object.color.map(|v| v.0.max(0.05));
        if let Some(sphere) = &object.sphere {
            let material = self.material(&object.material, color, true);
            let (points, indices) = ball();
            let mesh = self.mesh(&object.name, &points, &indices, (4, material));
            let r = sphere.radius.0;
            let center = self.place(vector(sphere.center));
            self.nodes.push(
                json!({ "name": object.name, "mesh": mesh, "translation": center, "scale": [r, r, r] }),
            );
            return;
        }
        let Some((points, triangles)) = object.mesh.as_ref().and_then(|m| m.unpacked()) else { return };
        if triangles.is_empty() {
            return;
        }
        let material = self.material(&object.material, color, true);
        let indices: Vec<u32> = triangles.iter().flatten().copied().collect();
        if object.copies.is_empty() {
            let placed: Vec<[f32; 3]> = points.iter().map(|p| self.place(DVec3::from_array(*p))).collect();
            let mesh = self.mesh(&object.name, &placed, &indices, (4, material));
            self.nodes.push(json!({ "name": object.name, "mesh": mesh }));
            return;
        }
        let own: Vec<[f32; 3]> = points
            .iter()
            .map(|p| (self.mirror * DVec3::from_array(*p)).to_array().map(|v| v as f32))
            .collect();
        let mesh = self.mesh(&object.name, &own, &indices, (4, material));
        for (index, copy) in object.copies.iter().enumerate() {
            let m = copy.map(|v| f64::from(v.0));
            let column = |c: usize| DVec3::new(m[c], m[4 + c], m[8 + c]);
            let world = DAffine3 {
                matrix3: DMat3::from_cols(column(0), column(1), column(2)),
                translation: column(3) - self.origin,
            };
            let flip = DAffine3::from_scale(self.mirror);
            let placed = flip * world * flip;
            let mut columns = [0.0f64; 16];
            for (c, v) in
                [placed.matrix3.x_axis, placed.matrix3.y_axis, placed.matrix3.z_axis, placed.translation]
                    .into_iter()
                    .enumerate()
            {
                columns[4 * c..4 * c + 3].copy_from_slice(&v.to_array());
            }
            columns[15] = 1.0;
            let name = object.names.get(index).unwrap_or(&object.name);
            self.nodes.push(json!({ "name": name, "mesh": mesh, "matrix": columns.map(|v| v as f32) }));
        }
    }

    /// The lines of each kind of ray that there is.
    fn rays(&mut self, trees: &[Tree], span: f64) {
        let mut kinds: Vec<&str> = Vec::new();
        for node in trees.iter().flat_map(|t| &t.nodes) {
            if !node.is_untraced() && !kinds.contains(&node.kind.as_str()) {
                kinds.push(&node.kind);
            }
        }
        for kind in kinds {
            let mut points = Vec::new();
            for node in trees.iter().flat_map(|t| &t.nodes).filter(|n| n.kind == kind && !n.is_untraced()) {
                let start = vector(node.origin);
                let direction = DVec3::from_array(node.direction.map(|v| f64::from(v.0)));
                let end = node.end().map_or(start + direction * span, vector);
                let ends = [self.place(start), self.place(end)];
                if ends.iter().flatten().all(|v| v.is_finite()) {
                    points.extend(ends);
                }
            }
            if points.is_empty() {
                continue;
            }
            let name = format!("{kind} rays");
            let material = self.material(&name, Look::of(kind).linear, false);
            let indices: Vec<u32> = (0..points.len() as u32).collect();
            let mesh = self.mesh(&name, &points, &indices, (1, material));
            self.nodes.push(json!({ "name": name, "mesh": mesh }));
        }
    }

    /// The camera's place; perspective ones only: what others see depends on the window.
    fn camera(&mut self, scene: &GhostScene) {
        let c = &scene.camera;
        let axis = |v: [super::number::Number; 3]| self.mirror * DVec3::from_array(v.map(|v| f64::from(v.0)));
        if c.kind != "perspective" || !(c.fov_y.0 > 0.0 && c.fov_y.0 < 180.0) {
            return;
        }
        let (right, up, back) = (axis(c.right), axis(c.up), -axis(c.look));
        let eye = self.place(vector(c.eye));
        let [r, u, b] = [right, up, back].map(|v| v.to_array().map(|v| v as f32));
        let matrix = [
            r[0], r[1], r[2], 0.0, u[0], u[1], u[2], 0.0, b[0], b[1], b[2], 0.0, eye[0], eye[1], eye[2], 1.0,
        ];
        self.nodes.push(json!({ "name": "camera", "camera": 0, "matrix": matrix }));
    }

    fn finish(self) -> Result<Vec<u8>, TooLarge> {
        let Bin { bytes, views, accessors } = self.buffer;
        let mut nodes = self.nodes;
        let roots: Vec<usize> = (0..nodes.len()).collect();
        let has_camera = nodes.iter().any(|n| n.get("camera").is_some());
        nodes.push(json!({ "name": "world", "translation": (self.mirror * self.origin).to_array(), "children": roots }));
        if roots.is_empty() {
            nodes.pop();
        }
        let mut document = json!({
            "asset": { "version": "2.0", "generator": format!("durer {}", env!("CARGO_PKG_VERSION")) },
            "scene": 0,
            "scenes": [{ "name": "ray tree", "nodes": if roots.is_empty() { vec![] } else { vec![roots.len()] } }],
        });
        let lists = [
            ("nodes", nodes),
            ("meshes", self.meshes),
            ("materials", self.materials),
            ("accessors", accessors),
            ("bufferViews", views),
        ];
        for (name, list) in lists {
            if !list.is_empty() {
                document[name] = list.into();
            }
        }
        if document.get("materials").is_some() {
            document["extensionsUsed"] = json!(["KHR_materials_unlit"]);
        }
        if has_camera {
            // The angle matters little: the camera's node says where the picture was taken from.
            document["cameras"] =
                json!([{ "type": "perspective", "perspective": { "yfov": 0.8, "znear": 0.01 } }]);
        }
        if !bytes.is_empty() {
            document["buffers"] = json!([{ "byteLength": bytes.len() }]);
        }
        container(&document, &bytes).ok_or(TooLarge)
    }
}

/// A unit sphere in rows.
fn ball() -> (Vec<[f32; 3]>, Vec<u32>) {
    const ROWS: u32 = 12;
    const COLUMNS: u32 = 24;
    let mut points = Vec::new();
    for row in 0..=ROWS {
        let polar = f64::from(row) / f64::from(ROWS) * std::f64::consts::PI;
        for column in 0..COLUMNS {
            let around = f64::from(column) / f64::from(COLUMNS) * std::f64::consts::TAU;
            let ((sp, cp), (sa, ca)) = (libm::sincos(polar), libm::sincos(around));
            points.push([(sp * ca) as f32, cp as f32, (sp * sa) as f32]);
        }
    }
    let mut indices = Vec::new();
    for row in 0..ROWS {
        for column in 0..COLUMNS {
            let next = (column + 1) % COLUMNS;
            let at = |row: u32, column: u32| row * COLUMNS + column;
            let (a, b, c, d) = (at(row, column), at(row, next), at(row + 1, next), at(row + 1, column));
            if row > 0 {
                indices.extend([a, b, c]);
            }
            if row + 1 < ROWS {
                indices.extend([a, c, d]);
            }
        }
    }
    (points, indices)
}
