//! Which boxes a ray comes near enough to: boxes enlarged on all sides, entered like any others.
//!
//! What must be found is that the ray comes, in render space, within `q` of some place of a box of the tree's space. The
//! ball of radius `q` becomes an ellipsoid under the inverse of the tree's map, whose half extents along the axes are `q`
//! times the lengths of that inverse's rows: the box is enlarged by those. The ray is followed in the tree's space, by its
//! length there.
use durer_core::{
    glam::{DAffine3, DMat3, DVec3},
    math::{Ray, Transform},
};
use wide::f32x8;

use crate::{
    lanes::Portable,
    layout::{Axis, PacketRecord},
    slab::{greater, lesser},
};

/// Room for roundings of places to f32, as a fraction: two bits more than they take.
const ROUNDINGS: f64 = 1e-6;
/// Room for roundings of lengths along the ray.
const LESS: f32 = 1.0 - ROUNDINGS as f32;
const MORE: f32 = 1.0 + ROUNDINGS as f32;
/// Smallest component of a unit direction: below it the ray moves along the axis by nothing.
const FLOOR: f64 = 1e-18;
/// Squares of coordinates up to this are finite.
const SQUARES_MAX: f32 = 1e18;

/// A ray in a tree's space.
pub(super) struct Gate {
    o: [f32; 3],
    /// The unit direction, and its reciprocals.
    d: [f32; 3],
    r: [f32; 3],
    /// Where the ray begins and ends, as lengths.
    ends: [f32; 2],
    /// What a length in the tree's space can become in render space, with the shift of a sphere's centre.
    stretch: f64,
    /// What a length in render space can become along each axis.
    rows: [f64; 3],
    /// The same in any direction.
    shrink: f64,
    /// Squares can be taken.
    is_small: bool,
    /// Error of places in render space.
    error: f64,
    /// Error of the origin.
    origin_error: [f64; 3],
    /// The ray's parameter where it is nearest to the render-space image of `x` is `slope . x + at_zero`.
    slope: DVec3,
    at_zero: f64,
    t_per_length: f64,
    t_ends: [f64; 2],
}

/// How much larger than what is inside them placed bounding spheres are, and how far their centres are shifted: both
/// together. A box around the image of a sphere of radius 1 has half extents of at most the lengths of the map's rows; that
/// it lies in there gives the square root of 2 (see [`super`]).
pub(super) fn sphere_stretch(map: &DAffine3) -> f64 {
    let m = &map.matrix3;
    if *m == DMat3::IDENTITY {
        return 1.0;
    }
    let squares = m.x_axis.length_squared() + m.y_axis.length_squared() + m.z_axis.length_squared();
    (2.0 * squares).sqrt()
}

/// The largest length that a vector of length 1 is mapped to, or a little more: none if the map turns and scales evenly.
fn norm(m: &DMat3) -> f64 {
    let squares = (m.transpose() * *m).abs();
    let sums = squares.x_axis + squares.y_axis + squares.z_axis;
    sums.max_element().sqrt()
}

impl Gate {
    /// `size` is the largest coordinate of the tree's boxes.
    pub(super) fn new(ray: &Ray, place: Option<&Transform>, size: f32) -> Self {
        let (o, d) = (ray.o.to_f64(), ray.d.to_f64());
        let map = place.map_or(DAffine3::IDENTITY, Transform::to_f64);
        let back = map.inverse();
        let (object_o, object_d) = (back.transform_point3(o), back.transform_vector3(d));
        let length = object_d.length();
        let direction = (object_d / length).to_array();
        let small = object_o.abs().max_element().max(f64::from(size)) < f64::from(SQUARES_MAX);
        let per_square = 1.0 / d.length_squared();
        let slope = map.matrix3.transpose() * d * per_square;
        let inverse = back.matrix3.transpose();
        let rows = [inverse.x_axis, inverse.y_axis, inverse.z_axis].map(DVec3::length);
        // Without a map everything is exact.
        let (error, stretch) = place.map_or((0.0, 1.0), |_| {
            let reach = map.matrix3.abs() * DVec3::splat(f64::from(size)) + map.translation.abs();
            (ROUNDINGS * reach.max_element(), sphere_stretch(&map))
        });
        let reciprocal = |x: f64| (1.0 / x.abs().max(FLOOR)).copysign(x) as f32;
        let t_ends = [f64::from(ray.t_min), f64::from(ray.t_max)];
        let along = |t: f64, more: f64| {
            let max = f64::from(f32::MAX);
            ((t * length) + (t * length).abs() * more).clamp(-max, max) as f32
        };
        Self {
            o: object_o.to_array().map(|x| x as f32),
            d: direction.map(|x| x as f32),
            r: direction.map(reciprocal),
            ends: [along(t_ends[0], -ROUNDINGS), along(t_ends[1], ROUNDINGS)],
            stretch,
            rows: if place.is_some() { rows } else { [1.0; 3] },
            shrink: if place.is_some() { norm(&back.matrix3) } else { 1.0 },
            is_small: small,
            error,
            origin_error: (object_o.abs() * f64::from(f32::EPSILON)).to_array(),
            slope,
            at_zero: (map.translation - o).dot(d) * per_square,
            t_per_length: d.length() * per_square,
            t_ends,
        }
    }

    /// By how much boxes are enlarged along each axis so that none is missed in which a sphere begins that sticks out of
    /// it by no more than `reach` and is enlarged by no more than `radius`.
    pub(super) fn margin(&self, reach: f32, radius: f32) -> [f32; 3] {
        let near = self.stretch * f64::from(reach) + f64::from(radius) + self.error;
        std::array::from_fn(|axis| {
            let out = near * self.rows[axis] * (1.0 + 10.0 * ROUNDINGS) + self.origin_error[axis];
            // A map that has no inverse: nothing is excluded.
            if self.rows[axis].is_finite() { (out as f32).next_up() } else { f32::INFINITY }
        })
    }

    /// Bit `i`: the ray comes near the box of lane `i`. Empty lanes have no box.
    #[inline(always)]
    pub(super) fn lanes<const N: usize>(&self, planes: &[[[f32; N]; 2]; 3], margin: &[f32; 3]) -> u32 {
        let (mut near, mut far) = ([self.ends[0]; N], [self.ends[1]; N]);
        for axis in 0..3 {
            let (o, r) = (self.o[axis], self.r[axis]);
            let rises = r.is_sign_positive();
            let [first, last] = if rises { [0, 1] } else { [1, 0] };
            let out = if rises { margin[axis] } else { -margin[axis] };
            let (first, last) = (&planes[axis][first], &planes[axis][last]);
            for i in 0..N {
                let entry = (first[i] - o - out) * r;
                let exit = (last[i] - o + out) * r;
                near[i] = greater(near[i], lesser(entry * LESS, entry * MORE));
                far[i] = lesser(far[i], greater(exit * LESS, exit * MORE));
            }
        }
        let mut bits = 0;
        for i in 0..N {
            bits |= u32::from(near[i] <= far[i]) << i;
        }
        bits
    }

    /// Bit `i`: the ray may come within `radius` of the sphere around triangle `i` of a packet.
    #[inline(always)]
    pub(super) fn triangles<R: PacketRecord>(&self, packet: &R, moment: f32, radius: f32) -> u32 {
        let used = (1u32 << packet.len()) - 1;
        if !(self.is_small && self.shrink.is_finite()) {
            return used;
        }
        let splat = |x: f64| f32x8::splat(x as f32);
        let mut centers = [f32x8::ZERO; 3];
        let (mut half, mut away, mut along) = (f32x8::ZERO, f32x8::ZERO, f32x8::ZERO);
        for (at, axis) in [Axis::X, Axis::Y, Axis::Z].into_iter().enumerate() {
            let corner = |vertex: usize| packet.coordinate::<f32x8>(Portable, vertex, axis, moment);
            let (a, b, c) = (corner(0), corner(1), corner(2));
            let (lower, upper) = (a.fast_min(b).fast_min(c), a.fast_max(b).fast_max(c));
            let center = (lower + upper) * 0.5 - f32x8::splat(self.o[at]);
            let side = (upper - lower) * 0.5;
            half += side * side;
            away += center * center;
            along += center * f32x8::splat(self.d[at]);
            centers[at] = center;
        }
        let [start, end] = self.ends.map(f32x8::splat);
        let along = along.fast_max(start).fast_min(end);
        let mut distance = f32x8::ZERO;
        for (center, d) in centers.into_iter().zip(self.d) {
            let beside = center - along * f32x8::splat(d);
            distance += beside * beside;
        }
        let sphere = half.sqrt() * splat(self.stretch * self.shrink);
        let near = sphere + splat((f64::from(radius) + self.error) * self.shrink);
        let error = splat(self.origin_error.iter().sum::<f64>()) + away.sqrt() * splat(8.0 * ROUNDINGS);
        let limit = near * splat(1.0 + 10.0 * ROUNDINGS) + error;
        let far: u32 = (limit * limit).simd_lt(distance).to_bitmask();
        used & !far
    }

    /// The ray's parameter at the furthest sphere with its centre in a box, or within `reach` of it.
    pub(super) fn furthest(&self, [min, max]: [[f32; 3]; 2], reach: f32) -> f32 {
        let mut t = self.at_zero;
        for axis in 0..3 {
            let slope = self.slope[axis];
            t += slope * f64::from(if slope > 0.0 { max[axis] } else { min[axis] });
        }
        t += (self.stretch * f64::from(reach) + self.error) * self.t_per_length;
        let [t_min, t_max] = self.t_ends;
        let t = (t + t.abs() * ROUNDINGS).max(t_min).min(t_max) as f32;
        t.next_up().min(t_max as f32).min(f32::MAX)
    }
}
