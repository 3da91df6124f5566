//! What a ray may and must meet, in f64 on the same f32 input, with nothing of the kernel in it.
//!
//! Every primitive is seen along the ray: its vertices as points in the plane across it and as depths in units of `t`.
//! The kernel computes with rounded numbers; its error is that of vertices moved by at most
//! `delta = 32 u (farthest vertex from the origin + what placing rounds)`, u = 2^-24. So a triangle
//! - may be hit if the ray passes within `delta` of it, at a `t` between `low` and `high`: the plane's slope times `delta`,
//!   and never outside the depths of its vertices by more than `delta`;
//! - must be hit if the ray passes all three edges by `delta` on the inner side, unless `t` is less than the documented
//!   bound on the error of `t` itself: a ray does not meet what it starts on.
use durer_accel::{Placement, Visibility};
use durer_core::glam::{DAffine3, DMat3, DVec2, DVec3};
use durer_core::math::{Point3, Ray, error::gamma};

use super::scenes::{Body, Scene};
use super::sieve::Asked;
use crate::corpus::Shape;

/// Roundings that a hit may suffer, in units of u times the farthest coordinate.
const ROUNDINGS: f64 = 32.0;
const U: f64 = f32::EPSILON as f64 / 2.0;

/// A meeting that the kernel may report.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Meeting {
    pub(crate) instance: u32,
    pub(crate) prim: u32,
    pub(crate) low: f64,
    pub(crate) high: f64,
    /// Some hit at most this far must be reported.
    pub(crate) sure: bool,
    /// Of triangles: `u`, `v` and how far off they may be.
    pub(crate) weights: Option<([f64; 2], [f64; 2])>,
    /// Of triangles that are no slivers: the geometric normal in object space.
    pub(crate) normal: Option<DVec3>,
}

/// A ray in the space of an instance.
struct Local {
    o: DVec3,
    d: DVec3,
    /// How far placing rounds coordinates of objects of radius `r`: `fixed + r * relative`.
    fixed: f64,
    relative: f64,
    to_world: DAffine3,
}

/// Largest sum of magnitudes in a row.
fn norm(m: &DMat3) -> f64 {
    (m.x_axis.abs() + m.y_axis.abs() + m.z_axis.abs()).max_element()
}

/// `render_from_object` at `time`, element by element between keys.
pub(crate) fn pose(placement: &Placement, time: f32) -> Option<DAffine3> {
    match placement {
        Placement::Identity => None,
        Placement::Still(m) => Some(m.to_f64()),
        Placement::Moving(keys) => {
            let (key, u) = between(keys.iter().map(|key| key.0), time);
            let (a, b) = (keys[key].1.to_f64(), keys[key + 1].1.to_f64());
            let mean = |x: DVec3, y: DVec3| x * (1.0 - u) + y * u;
            let (m, n) = (a.matrix3, b.matrix3);
            Some(DAffine3 {
                matrix3: DMat3::from_cols(
                    mean(m.x_axis, n.x_axis),
                    mean(m.y_axis, n.y_axis),
                    mean(m.z_axis, n.z_axis),
                ),
                translation: mean(a.translation, b.translation),
            })
        }
    }
}

/// The key before `time` and how far it is to the next.
fn between(times: impl Iterator<Item = f32>, time: f32) -> (usize, f64) {
    let times: Vec<f64> = times.map(f64::from).collect();
    let time = f64::from(time);
    let key = (1..times.len() - 1).take_while(|&k| times[k] <= time).count();
    (key, ((time - times[key]) / (times[key + 1] - times[key])).clamp(0.0, 1.0))
}

impl Local {
    fn new(ray: &Ray, placement: &Placement) -> Self {
        let (o, d) = (ray.o.to_f64(), ray.d.to_f64());
        let Some(m) = pose(placement, ray.time) else {
            return Self { o, d, fixed: 0.0, relative: 0.0, to_world: DAffine3::IDENTITY };
        };
        let inverse = m.inverse();
        let (forth, mut back) = (norm(&m.matrix3), norm(&inverse.matrix3));
        if let Placement::Moving(keys) = placement {
            // The map is rounded between keys, with an error of their size; so is its inverse, which squares that.
            let largest = keys.iter().map(|key| norm(&key.1.to_f64().matrix3)).fold(forth, f64::max);
            back *= (largest * back).max(1.0);
        }
        let fixed = back * (o.abs().max_element() + m.translation.abs().max_element());
        let local = inverse.transform_point3(o);
        Self { o: local, d: inverse.transform_vector3(d), fixed, relative: back * forth, to_world: m }
    }

    fn delta(&self, farthest: f64, radius: f64) -> f64 {
        ROUNDINGS * U * (farthest + self.fixed + radius * self.relative)
    }
}

/// Corners of triangle `prim` at `time`, and the largest coordinate they ever have.
fn corners(body: &Body, prim: usize, time: f32) -> ([DVec3; 3], f64) {
    let of = |points: &[Point3], indices: [u32; 3]| indices.map(|i| points[i as usize].to_f64());
    let largest = |t: &[DVec3; 3]| t.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
    match body {
        Body::Mesh(mesh) => {
            let t = of(&mesh.positions, mesh.indices[prim]);
            (t, largest(&t))
        }
        Body::Quads(mesh) => {
            let [a, b, c, d] = mesh.indices[prim / 2];
            let t = of(&mesh.positions, if prim.is_multiple_of(2) { [a, b, d] } else { [c, d, b] });
            (t, largest(&t))
        }
        Body::Keyed { indices, keys } => {
            let (key, u) = between(keys.iter().map(|key| key.0), time);
            let (a, b) = (of(&keys[key].1, indices[prim]), of(&keys[key + 1].1, indices[prim]));
            (std::array::from_fn(|i| a[i] * (1.0 - u) + b[i] * u), largest(&a).max(largest(&b)))
        }
        Body::Balls(_) => ([DVec3::ZERO; 3], 0.0),
    }
}

/// Corners in render space of a random triangle of an instance, or six times the same point on a ball.
pub(crate) fn landmarks(scene: &Scene, instance: usize, prim: usize, time: f32) -> [Point3; 3] {
    let placed = &scene.placed[instance];
    let body = &scene.bodies[placed.body];
    let corners = match body {
        Body::Balls(balls) => match balls[prim] {
            Shape::Sphere { center, radius } => {
                [DVec3::ZERO, DVec3::X, DVec3::Z].map(|v| center.to_f64() + v * f64::from(radius))
            }
            Shape::Plane { point, .. } => [point.to_f64(); 3],
        },
        _ => corners(body, prim, time).0,
    };
    let m = pose(&placed.placement, time).unwrap_or(DAffine3::IDENTITY);
    corners.map(|p| Point3::from_f64(m.transform_point3(p)))
}

fn hull([low, high]: [f64; 2], with: impl IntoIterator<Item = f64>) -> [f64; 2] {
    with.into_iter().fold([low, high], |[low, high], x| [low.min(x), high.max(x)])
}

/// What the kernel knows of a triangle by the ray's main axis.
struct Axial {
    /// The documented bound on the error of `t`, below which a triangle is not met.
    t: f64,
    /// The same of weights.
    weight: f64,
    /// Least and largest depth of a vertex along that axis, in units of `t`.
    depths: [f64; 2],
}

fn axial(o: DVec3, d: DVec3, t: &[DVec3; 3]) -> Axial {
    let (size, g) = (d.abs(), |n| f64::from(gamma(n)));
    let mut most = Axial { t: 0.0, weight: 0.0, depths: [f64::INFINITY, f64::NEG_INFINITY] };
    // Where two components are as large rounding may choose either.
    for last in (0..3).filter(|&axis| size[axis] >= size.max_element() * 0.9999) {
        let (i, j) = ((last + 1) % 3, (last + 2) % 3);
        let v = t.map(|p| {
            let r = p - o;
            [r[i] - d[i] / d[last] * r[last], r[j] - d[j] / d[last] * r[last], r[last]]
        });
        let largest = |k: usize| v.iter().map(|v| v[k].abs()).fold(0.0, f64::max);
        let (x, y, z) = (largest(0), largest(1), largest(2));
        let sum: f64 = (0..3).map(|k| v[k][0] * v[(k + 1) % 3][1] - v[k][1] * v[(k + 1) % 3][0]).sum();
        let weights = g(1) + (g(12) * x * y + g(5) * z * (x + y)) / sum.abs();
        let depths = v.map(|v| v[2] / d[last]);
        most = Axial {
            // A tenth more: the sum is rounded, too.
            t: most.t.max(6.6 * z * weights / d[last].abs()),
            weight: most.weight.max(2.2 * weights),
            depths: hull(most.depths, depths),
        };
    }
    most
}

/// A triangle along the ray.
struct Sight {
    low: f64,
    high: f64,
    sure: bool,
    weights: [f64; 3],
    slack: [f64; 3],
    is_front: bool,
}

fn distance_to_segment(a: DVec2, b: DVec2) -> f64 {
    let ab = b - a;
    let along = if ab == DVec2::ZERO { 0.0 } else { (-a.dot(ab) / ab.length_squared()).clamp(0.0, 1.0) };
    (a + ab * along).length()
}

/// `None` if the ray passes further away than `delta`. `t` and weights are as well known as `axial` says.
fn look(local: &Local, corners: &[DVec3; 3], delta: f64, axial: &Axial) -> Option<Sight> {
    let length = local.d.length();
    let (x, y) = (local.d / length).any_orthonormal_pair();
    let relative = corners.map(|p| p - local.o);
    let p = relative.map(|r| DVec2::new(r.dot(x), r.dot(y)));
    let z = relative.map(|r| r.dot(local.d) / (length * length));
    let edges: [f64; 3] = std::array::from_fn(|i| p[(i + 1) % 3].perp_dot(p[(i + 2) % 3]));
    let area: f64 = edges.iter().sum();
    let nearest = (0..3).map(|i| distance_to_segment(p[i], p[(i + 1) % 3])).fold(f64::INFINITY, f64::min);
    let size = p.iter().map(|p| p.length_squared()).fold(0.0, f64::max);
    // Below that an area is rounding of this very function.
    let is_flat = area.abs() <= 1e-13 * size;
    let inside = !is_flat && edges.iter().all(|e| e * area >= 0.0);
    if !inside && nearest > delta {
        return None;
    }
    let along = delta / length;
    let [low, high] = hull(axial.depths, z);
    let (low, high) = (low - along, high + along);
    // The plane of the triangle may be unknown; then only its extent counts.
    if is_flat {
        return Some(Sight { low, high, sure: false, weights: [0.0; 3], slack: [2.0; 3], is_front: false });
    }
    let weights = edges.map(|e| e / area);
    let slopes: [f64; 3] = std::array::from_fn(|i| (p[(i + 2) % 3] - p[(i + 1) % 3]).length() / area.abs());
    let t: f64 = (0..3).map(|i| weights[i] * z[i]).sum();
    let (e1, e2) = (p[1] - p[0], p[2] - p[0]);
    let gradient =
        DVec2::new((z[1] - z[0]) * e2.y - (z[2] - z[0]) * e1.y, (z[2] - z[0]) * e1.x - (z[1] - z[0]) * e2.x)
            / area;
    let error = 2.0 * delta * gradient.length() + along + axial.t;
    Some(Sight {
        low: low.max(t - error),
        high: high.min(t + error),
        sure: inside && nearest >= delta,
        weights,
        slack: slopes.map(|slope| slope * delta * 2.0 + axial.weight),
        is_front: (corners[1] - corners[0]).cross(corners[2] - corners[0]).dot(local.d) < 0.0,
    })
}

/// Whether the side that is seen counts.
fn shows(seen: &Visibility, asked: &Asked, sight: &Sight) -> bool {
    !(asked.culls && seen.hides_backs && sight.sure) || sight.is_front != seen.is_reversed
}

/// Everything a ray may meet.
pub(crate) fn meetings(scene: &Scene, ray: &Ray, asked: &Asked) -> Vec<Meeting> {
    let mut found = Vec::new();
    for (instance, placed) in (0u32..).zip(&scene.placed) {
        if placed.seen.mask & asked.mask == 0 {
            continue;
        }
        let local = Local::new(ray, &placed.placement);
        let body = &scene.bodies[placed.body];
        for prim in 0..body.len() {
            match body {
                Body::Balls(balls) => ball(&local, ray, &balls[prim], (instance, prim as u32), &mut found),
                _ => {
                    let met = triangle(&local, ray, body, prim, (&placed.seen, asked));
                    found.extend(met.map(|m| Meeting { instance, ..m }));
                }
            }
        }
    }
    found.retain(|m| asked.lets_through(m.instance, m.prim));
    found
}

fn triangle(
    local: &Local,
    ray: &Ray,
    body: &Body,
    prim: usize,
    (seen, asked): (&Visibility, &Asked),
) -> Option<Meeting> {
    let (corners, radius) = corners(body, prim, ray.time);
    let farthest = corners.iter().map(|p| (*p - local.o).abs().max_element()).fold(0.0, f64::max);
    let delta = local.delta(farthest, radius);
    let world = corners.map(|p| local.to_world.transform_point3(p));
    let (object, render) = (axial(local.o, local.d, &corners), axial(ray.o.to_f64(), ray.d.to_f64(), &world));
    // A tree may hold the triangle in either space.
    let axial = Axial {
        t: object.t.max(render.t),
        weight: object.weight.max(render.weight),
        depths: hull(object.depths, render.depths),
    };
    let sight = look(local, &corners, delta, &axial)?;
    if !shows(seen, asked, &sight) {
        return None;
    }
    let (low, high) = (sight.low, sight.high);
    let nearest = if low <= 0.0 && high >= 0.0 { 0.0 } else { low.abs().min(high.abs()) };
    let in_range = low >= ray.t_min.into() && high <= ray.t_max.into() && nearest > axial.t;
    let quad = matches!(body, Body::Quads(_));
    let (w, s) = (sight.weights, sight.slack);
    let weights = match quad && prim % 2 == 1 {
        true => ([1.0 - w[1], 1.0 - w[2]], [s[1], s[2]]),
        false => ([w[1], w[2]], [s[1], s[2]]),
    };
    let (a, b) = (corners[1] - corners[0], corners[2] - corners[0]);
    let normal = a.cross(b);
    let is_sliver = normal.length() < 1e-3 * a.length_squared().max(b.length_squared());
    Some(Meeting {
        instance: 0,
        prim: (if quad { prim / 2 } else { prim }) as u32,
        low,
        high,
        sure: sight.sure && in_range,
        weights: Some(weights),
        normal: (sight.sure && !is_sliver).then_some(normal),
    })
}

/// Both meetings with a ball.
fn ball(local: &Local, ray: &Ray, shape: &Shape, (instance, prim): (u32, u32), found: &mut Vec<Meeting>) {
    let Shape::Sphere { center, radius } = *shape else { return };
    let (center, radius) = (center.to_f64(), f64::from(radius));
    let size = center.abs().max_element() + radius;
    let to = center - local.o;
    let delta = local.delta(to.abs().max_element() + size, size);
    let length = local.d.length();
    let middle = to.dot(local.d) / (length * length);
    let passes = (to - local.d * middle).length();
    let half = |r: f64| (r * r - passes * passes).max(0.0).sqrt() / length;
    if passes > radius + delta {
        return;
    }
    let (most, least) = (half(radius + delta), half((radius - delta).max(0.0)));
    let along = delta / length;
    for [low, high] in [[middle - most, middle - least], [middle + least, middle + most]] {
        let (low, high) = (low - along, high + along);
        let sure = passes < radius - delta && low >= f64::from(ray.t_min) && high <= f64::from(ray.t_max);
        found.push(Meeting { instance, prim, low, high, sure, weights: None, normal: None });
    }
}
