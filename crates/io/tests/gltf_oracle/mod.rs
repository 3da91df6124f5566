//! Another reader of animated glTF files, in double precision and as plain as the specification: keys, quaternions and
//! matrices as arrays. Nothing is shared with the importer.
use std::{fs, path::Path};

use base64::{Engine, engine::general_purpose::STANDARD};
use serde_json::Value;

/// A matrix of rows.
pub(crate) type Matrix = [[f64; 4]; 4];

/// A file.
pub(crate) struct Oracle {
    json: Value,
    buffers: Vec<Vec<u8>>,
}

fn index(value: &Value) -> usize {
    value.as_u64().expect("an index") as usize
}

fn list(value: &Value) -> Vec<f64> {
    value.as_array().expect("numbers").iter().map(|v| v.as_f64().expect("a number")).collect()
}

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    let entry = |i: usize, j: usize| (0..4).map(|k| a[i][k] * b[k][j]).sum();
    std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)))
}

/// A point brought somewhere else.
pub(crate) fn moved(m: &Matrix, p: &[f64]) -> [f64; 3] {
    std::array::from_fn(|i| m[i][0] * p[0] + m[i][1] * p[1] + m[i][2] * p[2] + m[i][3])
}

/// The matrix of 16 numbers in column order.
fn columns(m: &[f64]) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| m[4 * j + i]))
}

fn placement(t: &[f64], q: &[f64], s: &[f64]) -> Matrix {
    let length = q.iter().map(|v| v * v).sum::<f64>().sqrt();
    let [x, y, z, w] = std::array::from_fn(|i| q[i] / length);
    [
        [(1. - 2. * (y * y + z * z)) * s[0], 2. * (x * y - z * w) * s[1], 2. * (x * z + y * w) * s[2], t[0]],
        [2. * (x * y + z * w) * s[0], (1. - 2. * (x * x + z * z)) * s[1], 2. * (y * z - x * w) * s[2], t[1]],
        [2. * (x * z - y * w) * s[0], 2. * (y * z + x * w) * s[1], (1. - 2. * (x * x + y * y)) * s[2], t[2]],
        [0., 0., 0., 1.],
    ]
}

impl Oracle {
    pub(crate) fn read(path: &Path) -> Self {
        let bytes = fs::read(path).expect("a file");
        let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().expect("4 bytes")) as usize;
        let (json, bin): (Value, _) = if bytes.starts_with(b"glTF") {
            let end = 20 + word(12);
            (serde_json::from_slice(&bytes[20..end]).expect("JSON"), bytes[end + 8..].to_vec())
        } else {
            (serde_json::from_slice(&bytes).expect("JSON"), Vec::new())
        };
        let load = |buffer: &Value| match buffer["uri"].as_str() {
            None => bin.clone(),
            Some(uri) => match uri.split_once(";base64,") {
                Some((_, data)) => STANDARD.decode(data).expect("base64"),
                None => fs::read(path.with_file_name(uri)).expect("a buffer"),
            },
        };
        let buffers = json["buffers"].as_array().expect("buffers").iter().map(load).collect();
        Self { json, buffers }
    }

    /// The elements of an accessor.
    fn elements(&self, accessor: &Value) -> Vec<Vec<f64>> {
        let a = &self.json["accessors"][index(accessor)];
        let lanes = match a["type"].as_str().expect("a type") {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            _ => 16,
        };
        let normalized = a["normalized"].as_bool().unwrap_or(false);
        let kind = index(&a["componentType"]);
        let size = match kind {
            5120 | 5121 => 1,
            5122 | 5123 => 2,
            _ => 4,
        };
        let view = &self.json["bufferViews"][index(&a["bufferView"])];
        let offset = |v: &Value| v["byteOffset"].as_u64().unwrap_or(0) as usize;
        let stride = view["byteStride"].as_u64().map_or(size * lanes, |s| s as usize);
        let bytes = &self.buffers[index(&view["buffer"])];
        let number = |at: usize| {
            let b = &bytes[at..at + size];
            let (value, most) = match kind {
                5120 => (f64::from(b[0] as i8), 127.),
                5121 => (f64::from(b[0]), 255.),
                5122 => (f64::from(i16::from_le_bytes([b[0], b[1]])), 32767.),
                5123 => (f64::from(u16::from_le_bytes([b[0], b[1]])), 65535.),
                5125 => (f64::from(u32::from_le_bytes([b[0], b[1], b[2], b[3]])), 1.),
                _ => (f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]])), 1.),
            };
            if normalized { value / most } else { value }
        };
        let start = offset(view) + offset(a);
        let element = |i: usize| (0..lanes).map(|lane| number(start + i * stride + lane * size)).collect();
        (0..index(&a["count"])).map(element).collect()
    }

    /// The number of animations.
    pub(crate) fn animations(&self) -> usize {
        self.json["animations"].as_array().map_or(0, Vec::len)
    }

    /// First and last key of an animation.
    pub(crate) fn span(&self, animation: usize) -> (f64, f64) {
        let samplers = self.json["animations"][animation]["samplers"].as_array().expect("samplers");
        let times = samplers.iter().flat_map(|s| self.elements(&s["input"])).flatten();
        times.fold((f64::MAX, f64::MIN), |(a, b), t| (a.min(t), b.max(t)))
    }

    /// What an animation says of a property of a node.
    fn animated(&self, animation: usize, node: usize, path: &str, time: f64) -> Option<Vec<f64>> {
        let animation = &self.json["animations"][animation];
        let channels = animation["channels"].as_array().expect("channels");
        let is_it = |c: &&Value| c["target"]["node"] == node && c["target"]["path"] == path;
        let channel = channels.iter().find(is_it)?;
        let sampler = &animation["samplers"][index(&channel["sampler"])];
        let times: Vec<f64> = self.elements(&sampler["input"]).into_iter().flatten().collect();
        let flat: Vec<f64> = self.elements(&sampler["output"]).into_iter().flatten().collect();
        let way = sampler["interpolation"].as_str().unwrap_or("LINEAR");
        let rows = if way == "CUBICSPLINE" { 3 * times.len() } else { times.len() };
        let n = flat.len() / rows;
        let row = |i: usize| &flat[i * n..(i + 1) * n];
        let value = |key: usize| if way == "CUBICSPLINE" { row(3 * key + 1) } else { row(key) };
        if time <= times[0] {
            return Some(value(0).to_vec());
        }
        let last = times.len() - 1;
        if time >= times[last] {
            return Some(value(last).to_vec());
        }
        let k = (0..last).find(|&k| time < times[k + 1]).expect("a key");
        let (d, a, b) = (times[k + 1] - times[k], value(k), value(k + 1));
        let t = (time - times[k]) / d;
        Some(match way {
            "STEP" => a.to_vec(),
            "LINEAR" if path == "rotation" => {
                // Rounded as files have them: they are of length 1.
                let unit = |q: &[f64]| {
                    let length = q.iter().map(|v| v * v).sum::<f64>().sqrt();
                    q.iter().map(|v| v / length).collect::<Vec<f64>>()
                };
                let (a, b) = (unit(a), unit(b));
                let dot: f64 = a.iter().zip(&b).map(|(a, b)| a * b).sum();
                let angle = dot.abs().min(1.0).acos();
                let (p, q) = match angle.sin() {
                    0.0 => (1.0 - t, t),
                    sine => (((1.0 - t) * angle).sin() / sine, (t * angle).sin() / sine),
                };
                a.iter().zip(&b).map(|(a, b)| p * a + q * b * dot.signum()).collect()
            }
            "LINEAR" => a.iter().zip(b).map(|(a, b)| a + (b - a) * t).collect(),
            _ => {
                let (out, into) = (row(3 * k + 2), row(3 * (k + 1)));
                let h = [
                    2. * t.powi(3) - 3. * t.powi(2) + 1.,
                    d * (t.powi(3) - 2. * t.powi(2) + t),
                    -2. * t.powi(3) + 3. * t.powi(2),
                    d * (t.powi(3) - t.powi(2)),
                ];
                (0..n).map(|i| h[0] * a[i] + h[1] * out[i] + h[2] * b[i] + h[3] * into[i]).collect()
            }
        })
    }

    /// Where a node is in the world.
    fn world(&self, animation: usize, node: usize, time: f64) -> Matrix {
        let element = &self.json["nodes"][node];
        let of = |path: &str, default: &[f64]| {
            let own = || element.get(path).map_or(default.to_vec(), list);
            self.animated(animation, node, path, time).unwrap_or_else(own)
        };
        let own = match element.get("matrix") {
            Some(m) => columns(&list(m)),
            None => {
                let t = of("translation", &[0., 0., 0.]);
                placement(&t, &of("rotation", &[0., 0., 0., 1.]), &of("scale", &[1., 1., 1.]))
            }
        };
        let nodes = self.json["nodes"].as_array().expect("nodes");
        let is_parent = |n: &Value| n["children"].as_array().is_some_and(|c| c.contains(&node.into()));
        match nodes.iter().position(is_parent) {
            Some(parent) => product(&self.world(animation, parent, time), &own),
            None => own,
        }
    }

    /// The corners of all triangles in the world, in the order of the document.
    pub(crate) fn corners(&self, animation: usize, time: f64) -> Vec<[f64; 3]> {
        let mut corners = Vec::new();
        let mut stack: Vec<usize> =
            list(&self.json["scenes"][0]["nodes"]).iter().rev().map(|n| *n as usize).collect();
        while let Some(node) = stack.pop() {
            let element = &self.json["nodes"][node];
            if let Some(children) = element.get("children") {
                stack.extend(list(children).iter().rev().map(|n| *n as usize));
            }
            if let Some(mesh) = element.get("mesh") {
                let mesh = &self.json["meshes"][index(mesh)];
                for primitive in mesh["primitives"].as_array().expect("primitives") {
                    corners.extend(self.primitive((animation, time), (node, mesh), primitive));
                }
            }
        }
        corners
    }

    fn primitive(
        &self,
        (animation, time): (usize, f64),
        (node, mesh): (usize, &Value),
        primitive: &Value,
    ) -> Vec<[f64; 3]> {
        let element = &self.json["nodes"][node];
        let mut points = self.elements(&primitive["attributes"]["POSITION"]);
        if let Some(targets) = primitive["targets"].as_array() {
            let rest = element.get("weights").or(mesh.get("weights")).map_or(vec![0.0; targets.len()], list);
            let weights = self.animated(animation, node, "weights", time).unwrap_or(rest);
            for (target, w) in targets.iter().zip(weights) {
                for (p, d) in points.iter_mut().zip(self.elements(&target["POSITION"])) {
                    (0..3).for_each(|i| p[i] += w * d[i]);
                }
            }
        }
        let placed: Vec<[f64; 3]> = match element.get("skin") {
            None => {
                let m = self.world(animation, node, time);
                points.iter().map(|p| moved(&m, p)).collect()
            }
            Some(skin) => {
                let skin = &self.json["skins"][index(skin)];
                let binds = self.elements(&skin["inverseBindMatrices"]);
                let joints = list(&skin["joints"]);
                let joint = |(j, bind): (&f64, &Vec<f64>)| {
                    product(&self.world(animation, *j as usize, time), &columns(bind))
                };
                let joints: Vec<Matrix> = joints.iter().zip(&binds).map(joint).collect();
                let which = self.elements(&primitive["attributes"]["JOINTS_0"]);
                let weights = self.elements(&primitive["attributes"]["WEIGHTS_0"]);
                let bent = |((p, j), w): ((&Vec<f64>, &Vec<f64>), &Vec<f64>)| {
                    let all: f64 = w.iter().sum();
                    let mut sum = [0.0; 3];
                    for i in 0..4 {
                        let q = moved(&joints[j[i] as usize], p);
                        (0..3).for_each(|k| sum[k] += w[i] / all * q[k]);
                    }
                    sum
                };
                points.iter().zip(&which).zip(&weights).map(bent).collect()
            }
        };
        match primitive.get("indices") {
            Some(indices) => self.elements(indices).iter().map(|i| placed[i[0] as usize]).collect(),
            None => placed,
        }
    }
}
