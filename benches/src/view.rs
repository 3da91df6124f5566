//! Where the first rays come from: a square picture of pixels in tiles of 8 x 8.
use durer::math::{Bounds3, Point3, Ray, Vector3, float};

/// Pixels along an edge of a tile.
const TILE: u32 = 8;

/// A pinhole camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Where all rays begin.
    pub eye: Point3,
    /// To the middle of the picture, of unit length like the other two.
    pub forward: Vector3,
    /// To the right edge.
    pub right: Vector3,
    /// To the upper edge.
    pub up: Vector3,
    /// Angle between the edges of the picture.
    pub fov_degrees: f32,
}

impl View {
    /// From `eye` to `at` with y upwards.
    pub fn looking(eye: Point3, at: Point3, fov_degrees: f32) -> Self {
        let forward = (at - eye).normalize();
        let right = forward.cross(Vector3::new(0.0, 1.0, 0.0)).normalize();
        Self { eye, forward, right, up: right.cross(forward), fov_degrees }
    }

    /// All of `bounds`, seen from the front and a little from above.
    pub fn from_front(bounds: &Bounds3) -> Self {
        let (center, size) = (bounds.center(), bounds.diagonal().length());
        Self::looking(center + Vector3::new(0.1, 0.25, 1.0) * (0.75 * size), center, 45.0)
    }

    /// A ray through the centre of each of `edge * edge` pixels, tile by tile. `edge` is a multiple of 8.
    pub fn rays(&self, edge: u32) -> Vec<Ray> {
        let reach = float::tan(self.fov_degrees.to_radians() / 2.0);
        let at = |pixel: u32| 2.0 * (pixel as f32 + 0.5) / edge as f32 - 1.0;
        let mut rays = Vec::with_capacity((edge * edge) as usize);
        for (tile_y, tile_x) in pairs(edge / TILE) {
            for (y, x) in pairs(TILE) {
                let (x, y) = (at(tile_x * TILE + x), -at(tile_y * TILE + y));
                let d = self.forward + self.right * (reach * x) + self.up * (reach * y);
                rays.push(Ray::new(self.eye, d.normalize()));
            }
        }
        rays
    }
}

/// Row by row, `(row, column)` of a square.
fn pairs(edge: u32) -> impl Iterator<Item = (u32, u32)> {
    (0..edge).flat_map(move |row| (0..edge).map(move |column| (row, column)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_fill_the_picture_tile_by_tile() {
        let view = View::looking(Point3::ZERO, Point3::new(0.0, 0.0, -3.0), 90.0);
        let rays = view.rays(16);
        assert_eq!(rays.len(), 256);
        let mean = rays.iter().fold(Vector3::new(0.0, 0.0, 0.0), |sum, ray| sum + ray.d);
        assert!(mean.x.abs() < 1e-3 && mean.y.abs() < 1e-3 && mean.z < -150.0);
        // The first tile is the upper left one, and fills it before the next begins.
        assert!(rays[..64].iter().all(|ray| ray.d.x < 0.0 && ray.d.y > 0.0));
        assert!(rays[64..128].iter().all(|ray| ray.d.x > 0.0 && ray.d.y > 0.0));
        let edge = rays[0].d / -rays[0].d.z;
        assert!((edge.x + 15.0 / 16.0).abs() < 1e-6, "{edge:?}");
    }
}
