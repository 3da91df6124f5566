//! Rows of the tables we know.
use durer_core::math::{Normal3, Point2, Point3};
use durer_scene::counted;

use super::{
    header::{Element, Scalar, Shape},
    numbers::{MISSING, Numbers},
};
use crate::import::{
    color::linear,
    text::{Complaint, Tally},
};

/// What a column of vertices means: places in a row of [`ROW`] numbers, by name.
const NAMES: [(usize, &[&str]); ROW] = [
    (0, &["x"]),
    (1, &["y"]),
    (2, &["z"]),
    (3, &["nx", "normal_x"]),
    (4, &["ny", "normal_y"]),
    (5, &["nz", "normal_z"]),
    (6, &["u", "s", "texture_u", "texture_s"]),
    (7, &["v", "t", "texture_v", "texture_t"]),
    (8, &["red", "diffuse_red", "r", "color_0"]),
    (9, &["green", "diffuse_green", "g", "color_1"]),
    (10, &["blue", "diffuse_blue", "b", "color_2"]),
    (11, &["alpha", "diffuse_alpha", "a", "weight_0"]),
    (12, &["tangent_x"]),
    (13, &["tangent_y"]),
    (14, &["tangent_z"]),
    (15, &["tangent_w"]),
    (16, &["u2"]),
    (17, &["v2"]),
];

/// Numbers of a vertex that we read.
const ROW: usize = 18;

/// What a table is read as.
#[derive(Debug)]
pub(super) enum Role {
    Vertices(Vertices),
    Faces {
        indices: usize,
        coords: Option<usize>,
        strips: bool,
        /// The column of numbers of faces.
        number: Option<usize>,
        /// The columns of colours that faces bring, and what they are divided by; see [`Vertices`].
        colors: Option<([Option<usize>; 4], f32)>,
    },
    /// Passed over.
    Other,
}

/// The columns of the vertices.
#[derive(Debug)]
pub(super) struct Vertices {
    /// For each property its place in the row.
    slots: Vec<Option<usize>>,
    normals: bool,
    uvs: bool,
    /// What the colours are divided by before they are decoded; 1 for colours that are linear.
    colors: Option<f32>,
    tangents: bool,
    second_uvs: bool,
}

/// What the table `element` is read as.
pub(super) fn role(element: &Element) -> Result<Role, Complaint> {
    let strips = element.name == "tristrips";
    match element.name.as_str() {
        "vertex" => vertices(element).map(Role::Vertices),
        "face" | "tristrips" => {
            let lists = |(i, p): (usize, &super::header::Property)| {
                matches!(p.shape, Shape::List { .. }).then_some(i)
            };
            let indices = element.find(&["vertex_indices", "vertex_index"]).and_then(lists);
            let coords = element.find(&["texcoord"]).and_then(lists);
            match indices {
                Some(indices) => {
                    let number = element.find(&["face_indices"]).map(|(i, _)| i);
                    Ok(Role::Faces { indices, coords, strips, number, colors: face_colors(element) })
                }
                None if element.count == 0 => Ok(Role::Other),
                None => {
                    let message = format!("the element {} has no list \"vertex_indices\"", element.name);
                    Err(Complaint::error(element.at.clone(), message))
                }
            }
        }
        _ => Ok(Role::Other),
    }
}

/// The columns of the colours of faces; none without red, green and blue, but a weight alone will do.
fn face_colors(element: &Element) -> Option<([Option<usize>; 4], f32)> {
    let scalar = |names: &[&str]| element.find(names).filter(|(_, p)| matches!(p.shape, Shape::Scalar(_)));
    let found: [Option<(usize, &super::header::Property)>; 4] =
        std::array::from_fn(|i| NAMES.get(8 + i).and_then(|(_, names)| scalar(names)));
    let scale = match found.iter().flatten().next()?.1.shape {
        Shape::Scalar(ty) => scale(ty),
        Shape::List { .. } => 1.0,
    };
    Some((found.map(|f| f.map(|(i, _)| i)), scale))
}

/// What a colour is divided by before it is decoded.
fn scale(ty: Scalar) -> f32 {
    match ty {
        Scalar::U8 => 255.0,
        Scalar::U16 => 65535.0,
        _ => 1.0,
    }
}

/// The colour that these numbers of a row say; alpha may be missing.
fn colored([r, g, b, a]: [f32; 4], scale: f32) -> [f32; 4] {
    let a = if a.is_nan() { 1.0 } else { (a / scale).clamp(0.0, 1.0) };
    let [r, g, b] = [r, g, b].map(|c| match scale {
        1.0 => c.max(0.0),
        _ => linear(c / scale),
    });
    [r, g, b, a]
}

fn vertices(element: &Element) -> Result<Vertices, Complaint> {
    let scalar = |names: &[&str]| match element.find(names) {
        Some((i, p)) => match p.shape {
            Shape::Scalar(ty) => Some((i, ty)),
            Shape::List { .. } => None,
        },
        None => None,
    };
    let found = NAMES.map(|(_, names)| scalar(names));
    let [x, y, z, nx, ny, nz, u, v, r, g, b, _, tx, ty, tz, _, u2, v2] = found;
    if x.and(y).and(z).is_none() {
        let message = "the vertices have no properties x, y and z";
        return Err(Complaint::error(element.at.clone(), message));
    }
    let mut slots = vec![None; element.properties.len()];
    for (found, (place, _)) in found.iter().zip(NAMES) {
        if let Some(slot) = found.and_then(|(i, _)| slots.get_mut(i)) {
            *slot = Some(place);
        }
    }
    Ok(Vertices {
        slots,
        normals: nx.and(ny).and(nz).is_some(),
        uvs: u.and(v).is_some(),
        colors: r.filter(|_| g.and(b).is_some()).map(|(_, ty)| scale(ty)),
        tangents: tx.and(ty).and(tz).is_some(),
        second_uvs: u2.and(v2).is_some(),
    })
}

/// What was read so far, from the beginning or from somewhere within the body.
#[derive(Debug, Default)]
pub(super) struct Rows {
    pub(super) positions: Vec<Point3>,
    pub(super) normals: Vec<Normal3>,
    pub(super) uvs: Vec<Point2>,
    pub(super) colors: Vec<[f32; 4]>,
    pub(super) tangents: Vec<[f32; 4]>,
    pub(super) second_uvs: Vec<Point2>,
    pub(super) corners: Vec<u32>,
    /// Texture coordinates of the corners, if faces bring their own.
    pub(super) coords: Vec<Point2>,
    /// A colour of each face, if faces bring their own.
    pub(super) face_colors: Vec<[f32; 4]>,
    /// A number of each face, if faces bring them.
    pub(super) faces: Vec<u32>,
    /// Where each polygon ends in `corners`; empty as long as all are triangles.
    pub(super) ends: Vec<usize>,
    /// Lines with more numbers than their table has.
    pub(super) long: Tally,
}

impl Rows {
    /// Appends what comes behind.
    pub(super) fn append(&mut self, mut later: Self) {
        if !later.ends.is_empty() || !self.ends.is_empty() {
            self.uneven();
            later.uneven();
            let before = self.corners.len();
            self.ends.extend(later.ends.iter().map(|end| end + before));
        }
        let read = (!self.coords.is_empty(), !later.coords.is_empty());
        if read.0 || read.1 {
            self.coords.resize(self.corners.len(), Point2::default());
            later.coords.resize(later.corners.len(), Point2::default());
        }
        self.long.append(later.long);
        self.positions.append(&mut later.positions);
        self.normals.append(&mut later.normals);
        self.uvs.append(&mut later.uvs);
        self.colors.append(&mut later.colors);
        self.tangents.append(&mut later.tangents);
        self.second_uvs.append(&mut later.second_uvs);
        self.corners.append(&mut later.corners);
        self.faces.append(&mut later.faces);
        self.face_colors.append(&mut later.face_colors);
        self.coords.append(&mut later.coords);
    }
    /// Makes `ends` say what it left unsaid.
    fn uneven(&mut self) {
        if self.ends.is_empty() {
            self.ends = (1..=self.corners.len() / 3).map(|i| 3 * i).collect();
        }
    }
    /// The polygon whose corners were appended behind `start` is whole.
    fn close(&mut self, start: usize) {
        let count = self.corners.len() - start;
        if count != 3 && self.ends.is_empty() {
            self.ends = (1..=start / 3).map(|i| 3 * i).collect();
            self.ends.push(self.corners.len());
        } else if !self.ends.is_empty() {
            self.ends.push(self.corners.len());
        }
    }

    /// Reads one row of `element`.
    pub(super) fn row(
        &mut self,
        element: &Element,
        role: &Role,
        vertices: usize,
        numbers: &mut impl Numbers,
    ) -> Result<(), Complaint> {
        match role {
            Role::Vertices(columns) => self.vertex(element, columns, numbers),
            Role::Faces { .. } => self.face(element, role, vertices, numbers),
            Role::Other => element.properties.iter().try_for_each(|p| skip(p.shape, numbers)),
        }
    }

    fn vertex(
        &mut self,
        element: &Element,
        columns: &Vertices,
        numbers: &mut impl Numbers,
    ) -> Result<(), Complaint> {
        let mut row = [0.0; ROW];
        // What may be missing where its neighbours are there: alpha, and the handedness of tangents.
        (row[11], row[15]) = (f32::NAN, 1.0);
        for (property, slot) in element.properties.iter().zip(&columns.slots) {
            match (property.shape, slot.and_then(|s| row.get_mut(s))) {
                (Shape::Scalar(ty), Some(value)) => {
                    *value = numbers.float(ty)?;
                    if !value.is_finite() {
                        *value = f32::NAN;
                        if slot.is_some_and(|s| s < 3) {
                            return Err(numbers.fault("a coordinate is nan or infinite".to_owned()));
                        }
                    }
                }
                (shape, _) => skip(shape, numbers)?,
            }
        }
        let [x, y, z, nx, ny, nz, u, v, r, g, b, a, tx, ty, tz, tw, u2, v2] = row;
        self.positions.push(Point3::new(x, y, z));
        if columns.normals {
            self.normals.push(Normal3::from([nx, ny, nz]));
        }
        if columns.uvs {
            self.uvs.push(Point2::new(u, v));
        }
        if let Some(scale) = columns.colors {
            self.colors.push(colored([r, g, b, a], scale));
        }
        if columns.tangents {
            self.tangents.push([tx, ty, tz, tw]);
        }
        if columns.second_uvs {
            self.second_uvs.push(Point2::new(u2, v2));
        }
        Ok(())
    }

    fn face(
        &mut self,
        element: &Element,
        role: &Role,
        vertices: usize,
        numbers: &mut impl Numbers,
    ) -> Result<(), Complaint> {
        let Role::Faces { indices, coords, strips, number, colors } = *role else {
            return Ok(());
        };
        let (start, mut own) = (self.corners.len(), Vec::new());
        let mut color = [0.0, 0.0, 0.0, f32::NAN];
        for (i, property) in element.properties.iter().enumerate() {
            match property.shape {
                Shape::List { count, item } if i == indices => {
                    let length = list_length(count, numbers)?;
                    if strips {
                        self.strips(item, length, vertices, numbers)?;
                        continue;
                    }
                    for there in 0..length {
                        match index(item, vertices, numbers) {
                            Ok(corner) => self.corners.push(corner),
                            Err(wrong) if wrong.message == MISSING => {
                                return Err(short_face(length, there, numbers));
                            }
                            Err(wrong) => return Err(wrong),
                        }
                    }
                }
                Shape::List { count, item } if Some(i) == coords => {
                    let length = list_length(count, numbers)?;
                    for _ in 0..length / 2 {
                        own.push(Point2::new(numbers.float(item)?, numbers.float(item)?));
                    }
                    numbers.skip(item, length % 2)?;
                }
                Shape::Scalar(ty) if Some(i) == number && !strips => {
                    self.faces.push(numbers.integer(ty)?.max(0) as u32);
                }
                Shape::Scalar(ty) if colors.is_some() => {
                    let place = colors.and_then(|(columns, _)| columns.iter().position(|c| *c == Some(i)));
                    let value = numbers.float(ty)?;
                    if let Some(place) = place.and_then(|p| color.get_mut(p)) {
                        *place = value;
                    }
                }
                shape => skip(shape, numbers)?,
            }
        }
        if !strips {
            self.close(start);
            self.face_colors.extend(colors.map(|(_, scale)| colored(color, scale)));
            let length = self.corners.len();
            if own.len() == length - start && !own.is_empty() {
                self.coords.resize(start, Point2::default());
                self.coords.append(&mut own);
            }
        }
        Ok(())
    }

    /// Triangle strips, ended by -1.
    fn strips(
        &mut self,
        item: Scalar,
        length: usize,
        vertices: usize,
        numbers: &mut impl Numbers,
    ) -> Result<(), Complaint> {
        let (mut last, mut count) = ([0; 2], 0);
        for _ in 0..length {
            let value = numbers.integer(item)?;
            if value == -1 {
                count = 0;
                continue;
            }
            let corner = checked(value, vertices, numbers)?;
            let [a, b] = last;
            if count >= 2 {
                let triangle = if count % 2 == 0 { [a, b, corner] } else { [b, a, corner] };
                let start = self.corners.len();
                self.corners.extend(triangle);
                self.close(start);
            }
            (last, count) = ([b, corner], count + 1);
        }
        Ok(())
    }
}

fn short_face(says: usize, lists: usize, numbers: &impl Numbers) -> Complaint {
    numbers.fault(format!("this face says {} but lists {lists}", counted(says, "corner")))
}

fn skip(shape: Shape, numbers: &mut impl Numbers) -> Result<(), Complaint> {
    match shape {
        Shape::Scalar(ty) => numbers.skip(ty, 1),
        Shape::List { count, item } => {
            let length = list_length(count, numbers)?;
            numbers.skip(item, length)
        }
    }
}

fn list_length(ty: Scalar, numbers: &mut impl Numbers) -> Result<usize, Complaint> {
    let length = numbers.integer(ty)?;
    usize::try_from(length).map_err(|_| numbers.fault(format!("a list of {length} values")))
}

fn index(ty: Scalar, vertices: usize, numbers: &mut impl Numbers) -> Result<u32, Complaint> {
    let value = numbers.integer(ty)?;
    checked(value, vertices, numbers)
}

fn checked(value: i64, vertices: usize, numbers: &impl Numbers) -> Result<u32, Complaint> {
    let found = u32::try_from(value).ok().filter(|&v| (v as usize) < vertices);
    found.ok_or_else(|| {
        numbers.fault(format!("a face names vertex {value}, but there are {vertices}, counted from 0"))
    })
}
