//! Points of a mesh in 16 bits a coordinate, all as base64.
use base64::{Engine, engine::general_purpose::STANDARD};
use serde::{Deserialize, Serialize};

use crate::{
    glam::DVec3,
    tree::number::{Metres, Number},
};

use super::Soup;

/// Triangles. A point is `origin + scale * q` with `q` from `positions`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct GhostMesh {
    /// The lower corner of its box.
    pub origin: [Metres; 3],
    /// Metres to a step.
    pub scale: Number,
    /// Three 16-bit unsigned numbers, little-endian, for each point, in base64.
    pub positions: String,
    /// Three indices of points for each triangle, 16 bits each, or 32 if `wide`; little-endian, in base64.
    pub indices: String,
    /// Indices have 32 bits.
    pub wide: bool,
}

/// Points, and three of them for each triangle.
pub type Triangles = (Vec<[f64; 3]>, Vec<[u32; 3]>);

impl GhostMesh {
    pub(super) fn new(soup: &Soup) -> Self {
        let soup = soup.without_unused();
        let low = soup.positions.iter().fold(DVec3::INFINITY, |a, p| a.min(*p));
        let high = soup.positions.iter().fold(DVec3::NEG_INFINITY, |a, p| a.max(*p));
        let (low, span) =
            if low.is_finite() { (low, (high - low).max_element()) } else { (DVec3::ZERO, 0.0) };
        let scale = (span / f64::from(u16::MAX)) as f32;
        let step = if scale > 0.0 { f64::from(scale) } else { 1.0 };
        let quantised = soup.positions.iter().flat_map(|p| {
            ((*p - low) / step).to_array().map(|v| v.round().clamp(0.0, f64::from(u16::MAX)) as u16)
        });
        let positions: Vec<u8> = quantised.flat_map(u16::to_le_bytes).collect();
        let wide = soup.positions.len() > usize::from(u16::MAX) + 1;
        let flat = soup.indices.iter().flatten();
        let indices: Vec<u8> = match wide {
            true => flat.flat_map(|i| i.to_le_bytes()).collect(),
            false => flat.flat_map(|i| (*i as u16).to_le_bytes()).collect(),
        };
        Self {
            origin: low.to_array().map(|v| Metres::short(v, scale * 256.0)),
            scale: Number(scale),
            positions: STANDARD.encode(positions),
            indices: STANDARD.encode(indices),
            wide,
        }
    }

    /// Points and triangles again; `None` if it is damaged.
    pub fn unpacked(&self) -> Option<Triangles> {
        let (positions, indices) =
            (STANDARD.decode(&self.positions).ok()?, STANDARD.decode(&self.indices).ok()?);
        let numbers: Vec<u16> = positions.as_chunks::<2>().0.iter().map(|b| u16::from_le_bytes(*b)).collect();
        let point = |q: &[u16; 3]| {
            std::array::from_fn(|i| self.origin[i].0 + f64::from(self.scale.0) * f64::from(q[i]))
        };
        let points: Vec<[f64; 3]> = numbers.as_chunks::<3>().0.iter().map(point).collect();
        let flat: Vec<u32> = match self.wide {
            true => indices.as_chunks::<4>().0.iter().map(|b| u32::from_le_bytes(*b)).collect(),
            false => indices.as_chunks::<2>().0.iter().map(|b| u16::from_le_bytes(*b).into()).collect(),
        };
        let triangles = flat.as_chunks::<3>().0.to_vec();
        let sound = triangles.iter().flatten().all(|&i| (i as usize) < points.len());
        sound.then_some((points, triangles))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_come_back_within_half_a_step() {
        let positions =
            vec![DVec3::new(-3.0, 1e3, 0.1), DVec3::new(5.0, 1001.0, 0.2), DVec3::new(0.3, 1e3, 0.3)];
        let soup = Soup { positions: positions.clone(), indices: vec![[0, 2, 1]] };
        let mesh = GhostMesh::new(&soup);
        let (points, triangles) = mesh.unpacked().expect("a sound mesh");
        for (corner, index) in [0, 2, 1].into_iter().zip(triangles[0]) {
            let found = DVec3::from_array(points[index as usize]);
            assert!((found - positions[corner]).abs().max_element() <= f64::from(mesh.scale.0) * 0.52);
        }
        assert!(!mesh.wide && GhostMesh::new(&Soup::default()).unpacked().is_some());
    }
}
