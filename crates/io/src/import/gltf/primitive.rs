//! One primitive to one triangle mesh: vertices, triangles, morph targets (in `morph.rs`) and skin (in `skin.rs`).
use std::collections::HashMap;

use durer_core::{
    glam::DVec3,
    math::{Normal3, Point2, Point3},
};
use durer_scene::{Mesh, VertexKey, counted};

use super::{
    accessor::Accessor,
    buffer::Buffers,
    document::Document,
    draco,
    element::{Checked, Element},
    mesh::Wish,
    morph::Targets,
    skin::{Influences, Skin},
};

/// How indices become triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Mode {
    /// Every three.
    Triangles,
    /// Every one with the two before it.
    Strip,
    /// Every one with the one before it and the first.
    Fan,
}

/// The mode of a primitive; `None`, after a warning, for points and lines.
pub(super) fn mode<'a>(document: &Document<'a>, primitive: &Element<'a>) -> Checked<Option<Mode>> {
    let what = match primitive.index_or("mode", 4)? {
        0 => "points",
        1 => "lines",
        2 => "line loops",
        3 => "line strips",
        4 => return Ok(Some(Mode::Triangles)),
        5 if primitive.extension(draco::NAME)?.is_some() => return Ok(Some(Mode::Triangles)),
        5 => return Ok(Some(Mode::Strip)),
        6 => return Ok(Some(Mode::Fan)),
        other => return Err(primitive.fault_at("mode", format!("expected 0 to 6, found {other}"))),
    };
    document.warn(primitive, format!("{what} are not drawn: they have no surface"));
    Ok(None)
}

/// Makes the mesh; `None`, after a warning, if there is nothing to draw.
pub(super) fn build<'a>(
    document: &Document<'a>,
    buffers: &Buffers,
    wish: &Wish<'a>,
    (skins, times): (&HashMap<usize, Skin>, &[f32]),
) -> Checked<Option<Mesh>> {
    let primitive = &wish.primitive;
    let attributes = primitive.required("attributes")?;
    let Some(reference) = attributes.get("POSITION")? else {
        document.warn(primitive, "a primitive without POSITION draws nothing");
        return Ok(None);
    };
    let positions = Accessor::open(document, buffers, &reference)?;
    let corners = corners(document, buffers, primitive, &positions)?;
    document.spend(primitive, corners.len(), 12)?;
    if wish.mode == Mode::Triangles && corners.len() % 3 != 0 {
        document.warn(primitive, "the number of indices is not a multiple of 3; the last ones are ignored");
    }
    let mut indices = triangles(&corners, wish.mode);
    if indices.is_empty() {
        document.warn(primitive, "a primitive without triangles draws nothing");
        return Ok(None);
    }
    let used = used_vertices(&corners, positions.count, &mut indices);
    let columns = Columns { document, buffers, vertices: positions.count, which: used.as_deref() };
    let mesh = columns.mesh(&attributes, wish.sets, indices)?;
    let skin = match wish.skin.and_then(|skin| skins.get(&skin)) {
        Some(skin) => Some((skin, columns.influences(&attributes, skin)?)),
        None => None,
    };
    let shaping = Shaping { targets: Targets::read(&columns, wish)?, skin };
    document.spend(primitive, mesh.positions.len().saturating_mul(shaping.moments() - 1), 24)?;
    let mesh = shaping.shaped(mesh, times);
    mesh.validate().map_err(|e| primitive.fault(e.to_string()))?;
    if has_no_area(&mesh) {
        document.warn(primitive, "no triangle of this primitive has an area: nothing of it will be seen");
    }
    Ok(Some(mesh))
}

/// What gives a mesh its shape, moment by moment.
struct Shaping<'s> {
    targets: Targets<'s>,
    skin: Option<(&'s Skin, Vec<Vec<Influences>>)>,
}

impl Shaping<'_> {
    /// At how many moments the shape is known; 1 if it does not change.
    fn moments(&self) -> usize {
        self.targets.moments().max(self.skin.as_ref().map_or(1, |(skin, _)| skin.moments()))
    }
    fn shape(&self, mesh: &mut Mesh, moment: usize) {
        self.targets.apply(mesh, moment);
        if let Some((skin, influences)) = &self.skin {
            skin.bend(mesh, influences, moment);
        }
    }
    /// The mesh in its shape at all moments. Tangents, colours and texture coordinates stay those of the first.
    fn shaped(&self, mesh: Mesh, times: &[f32]) -> Mesh {
        let mut first = mesh.clone();
        self.shape(&mut first, 0);
        for (moment, &time) in times.iter().enumerate().take(self.moments()).skip(1) {
            let (positions, normals) = (mesh.positions.clone(), mesh.normals.clone());
            let mut outline = Mesh { positions, normals, ..Mesh::default() };
            self.shape(&mut outline, moment);
            let Mesh { positions, normals, .. } = outline;
            first.later.push(VertexKey { time, positions, normals });
        }
        if !first.is_still() {
            first.time = times.first().copied().unwrap_or(0.0);
        }
        first
    }
}

/// True if nothing of a mesh can be hit.
pub(super) fn has_no_area(mesh: &Mesh) -> bool {
    let is_flat = |positions: &[Point3]| {
        mesh.indices.iter().all(|triangle| {
            let [a, b, c] =
                triangle.map(|i| positions.get(i as usize).map_or(DVec3::ZERO, |p| Point3::to_f64(*p)));
            (b - a).cross(c - a) == DVec3::ZERO
        })
    };
    (0..mesh.keys()).all(|key| is_flat(mesh.key(key).1))
}

/// The attributes of one primitive, all of the same length.
pub(super) struct Columns<'r, 'a> {
    /// The document.
    pub(super) document: &'r Document<'a>,
    buffers: &'r Buffers,
    vertices: usize,
    which: Option<&'r [u32]>,
}

impl<'r, 'a> Columns<'r, 'a> {
    /// The accessor of an attribute, if there is one.
    pub(super) fn open(&self, attributes: &Element<'a>, name: &str) -> Checked<Option<Accessor<'r, 'a>>> {
        let Some(reference) = attributes.get(name)? else {
            return Ok(None);
        };
        let accessor = Accessor::open(self.document, self.buffers, &reference)?;
        if accessor.count == self.vertices {
            return Ok(Some(accessor));
        }
        let message = format!(
            "{name} has {} for {}",
            counted(accessor.count, "element"),
            counted(self.vertices, "vertex")
        );
        Err(accessor.element.fault(message))
    }
    /// The elements that the triangles use; none if they hold infinities: a renderer could do nothing with them.
    pub(super) fn rows<const N: usize>(
        &self,
        name: &str,
        accessor: &Accessor<'r, 'a>,
    ) -> Checked<Vec<[f32; N]>> {
        let rows = accessor.floats::<N>(self.document, self.which)?;
        if rows.iter().flatten().all(|v| v.is_finite()) {
            return Ok(rows);
        }
        let message = format!("{name} holds infinite or NaN numbers; ignored");
        self.document.warn(&accessor.element, message);
        Ok(Vec::new())
    }
    /// The attribute; empty if it is missing.
    pub(super) fn column<const N: usize>(&self, from: &Element<'a>, name: &str) -> Checked<Vec<[f32; N]>> {
        self.open(from, name)?.map_or(Ok(Vec::new()), |accessor| self.rows(name, &accessor))
    }
    /// Colours of vertices; those without alpha get `alpha`.
    pub(super) fn colors(&self, from: &Element<'a>, alpha: f32) -> Checked<Vec<[f32; 4]>> {
        const NAME: &str = "COLOR_0";
        let Some(mut accessor) = self.open(from, NAME)? else {
            return Ok(Vec::new());
        };
        if accessor.holds_integers() {
            self.document.warn(&accessor.element, "integer colours are taken for fractions of 1");
            accessor = accessor.into_fractions();
        }
        if accessor.lanes == 3 {
            let rows = self.rows(NAME, &accessor)?;
            return Ok(rows.into_iter().map(|[r, g, b]| [r, g, b, alpha]).collect());
        }
        self.rows(NAME, &accessor)
    }

    fn mesh(&self, attributes: &Element<'a>, sets: [usize; 2], indices: Vec<[u32; 3]>) -> Checked<Mesh> {
        let positions = match self.open(attributes, "POSITION")? {
            Some(accessor) => accessor.floats::<3>(self.document, self.which)?,
            None => Vec::new(),
        };
        let [uvs, second_uvs] = sets.map(|set| self.coordinates(attributes, set));
        let normals: Vec<_> =
            self.column::<3>(attributes, "NORMAL")?.into_iter().map(Normal3::from).collect();
        // Without normals tangents do not count (section 3.7.2.1).
        let tangents = if normals.is_empty() { Vec::new() } else { self.column(attributes, "TANGENT")? };
        Ok(Mesh {
            positions: positions.into_iter().map(Point3::from).collect(),
            indices,
            normals,
            uvs: uvs?,
            second_uvs: second_uvs?,
            tangents,
            colors: self.colors(attributes, 1.0)?,
            ..Mesh::default()
        })
    }
    /// Texture coordinates; v of glTF grows downwards, ours upwards.
    fn coordinates(&self, attributes: &Element<'a>, set: usize) -> Checked<Vec<Point2>> {
        let rows = self.column(attributes, &format!("TEXCOORD_{set}"))?;
        Ok(rows.into_iter().map(|[u, v]| Point2::new(u, 1.0 - v)).collect())
    }

    /// What the vertices follow, set by set.
    fn influences(&self, attributes: &Element<'a>, skin: &Skin) -> Checked<Vec<Vec<Influences>>> {
        let mut sets = Vec::new();
        loop {
            let names = ["JOINTS", "WEIGHTS"].map(|name| format!("{name}_{}", sets.len()));
            let [joints_name, weights_name] = &names;
            let open = |name| self.open(attributes, name);
            let (joints, weights) = match (open(joints_name)?, open(weights_name)?) {
                (None, None) => return Ok(sets),
                (Some(joints), Some(weights)) => (joints, weights),
                (None, Some(lone)) | (Some(lone), None) => {
                    let message = format!("{joints_name} and {weights_name} must come together");
                    return Err(lone.element.fault(message));
                }
            };
            let element = joints.element.clone();
            let joints = joints.indices::<4>(self.document, self.which)?;
            let weights = if weights.holds_integers() { weights.into_fractions() } else { weights };
            let weights = self.rows::<4>(weights_name, &weights)?;
            let set: Vec<Influences> = joints.iter().zip(&weights).map(|(j, w)| zip(*j, *w)).collect();
            let missing = |(joint, weight): &&(u32, f32)| *weight != 0.0 && *joint as usize >= skin.len();
            if let Some((joint, _)) = set.iter().flatten().find(missing) {
                let message = format!(
                    "a vertex follows joint {joint}, but the skin has {}",
                    counted(skin.len(), "joint")
                );
                return Err(element.fault(message));
            }
            sets.push(set);
        }
    }
}

fn zip([a, b, c, d]: [u32; 4], [p, q, r, s]: [f32; 4]) -> Influences {
    [(a, p), (b, q), (c, r), (d, s)]
}

/// The vertices in the order in which the primitive visits them.
fn corners<'a>(
    document: &Document<'a>,
    buffers: &Buffers,
    primitive: &Element<'a>,
    positions: &Accessor<'_, 'a>,
) -> Checked<Vec<u32>> {
    let Some(reference) = primitive.get("indices")? else {
        document.spend(&positions.element, positions.count, 4)?;
        let count = u32::try_from(positions.count).map_err(|e| positions.element.fault(e.to_string()))?;
        return Ok((0..count).collect());
    };
    let accessor = Accessor::open(document, buffers, &reference)?;
    let corners: Vec<u32> = accessor.indices::<1>(document, None)?.into_iter().map(|[i]| i).collect();
    match corners.iter().enumerate().find(|(_, c)| **c as usize >= positions.count) {
        None => Ok(corners),
        Some((at, index)) => {
            let vertices = positions.count;
            let message = match vertices {
                0 => format!("index {index} at position {at}, but there are no vertices"),
                1 => format!("index {index} at position {at}, but there is only 1 vertex"),
                n => format!("index {index} at position {at}, but there are only {n} vertices"),
            };
            Err(accessor.element.fault(message))
        }
    }
}

/// Triangles of a list of corners (glTF 2.0, section 3.7.2.1).
fn triangles(corners: &[u32], mode: Mode) -> Vec<[u32; 3]> {
    match mode {
        Mode::Triangles => corners.as_chunks::<3>().0.to_vec(),
        Mode::Strip => {
            let turn = |(i, w): (usize, &[u32])| match *w {
                [a, b, c] if i % 2 == 0 => Some([a, b, c]),
                [a, b, c] => Some([a, c, b]),
                _ => None,
            };
            corners.windows(3).enumerate().filter_map(turn).collect()
        }
        Mode::Fan => {
            let Some((&hub, rim)) = corners.split_first() else {
                return Vec::new();
            };
            rim.iter().zip(rim.iter().skip(1)).map(|(&a, &b)| [a, b, hub]).collect()
        }
    }
}

/// Many exporters let all primitives share one vertex array. The vertices that the triangles of this one use, if they
/// are clearly fewer than all, with `indices` renumbered to them; else `None`.
fn used_vertices(corners: &[u32], vertices: usize, indices: &mut [[u32; 3]]) -> Option<Vec<u32>> {
    if corners.len() >= vertices {
        return None;
    }
    let mut used = corners.to_vec();
    used.sort_unstable();
    used.dedup();
    for corner in indices.iter_mut().flatten() {
        *corner = used.binary_search(corner).ok()? as u32;
    }
    Some(used)
}
