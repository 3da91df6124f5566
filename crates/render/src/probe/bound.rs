//! How bright anything in a scene can be: what bounds the light of rays that were given up.
//!
//! A ray sees the sky, or a surface. What that sends at most follows from what arrives at it and from what the rays bring
//! that it follows ([`Sent`]): the largest radiance is the smallest one that is consistent with all surfaces. It holds in
//! the mean over random choices: a single sample of a lamp's light may be larger than the lamp. Lights that fade with the
//! square of the distance have a bound where no surface is near them, which is measured.
use std::{collections::HashMap, f32::consts::PI};

use durer_core::{
    glam::DVec3,
    math::{Bounds3, Point3, Ray, Vector3},
    spectrum::Basis,
};
use durer_model::{
    light::LightBound,
    material::{Arriving, GlossRays, Sent},
    shape::Shape,
};
use durer_scene::Mesh;

use crate::{Form, Piece, SampleCx, Scene};

/// Moments at which things are looked at that may move.
const MOMENTS: u32 = 9;

impl Scene {
    /// The largest radiance that any ray can bring, over all channels, in the mean over random choices. Looked for when it
    /// is asked for first.
    ///
    /// # Errors
    /// Why there is no bound, as a clause.
    pub fn brightest(&self, gloss: GlossRays) -> Result<f32, &str> {
        let found = self.brightest[gloss as usize].get_or_init(|| self.find_brightest(gloss));
        found.as_ref().copied().map_err(String::as_str)
    }

    fn find_brightest(&self, gloss: GlossRays) -> Result<f32, String> {
        let arriving = self.arriving_at_most(gloss)?;
        let cx = SampleCx { scene: self, basis: Basis::Rgb };
        let of_materials: Vec<Sent> = self.materials.iter().map(|m| m.sent(&cx.shade(), &arriving)).collect();
        let far = self.far.iter().map(|&light| &self.lights[light as usize]);
        let mut most = far.map(|light| light.bound().seen).sum::<f32>();
        for object in self.objects.iter() {
            let mut sent = of_materials.get(object.material as usize).copied().unwrap_or_default();
            sent.own += object.light.map_or(0.0, |light| self.lights[light as usize].bound().seen);
            let own = sent.bound();
            if own.is_infinite() && sent.own.is_infinite() {
                let name = &object.name;
                return Err(format!(
                    "highlights of lights without extent on \"{name}\" have no bound, or nobody knows one of its material"
                ));
            } else if own.is_infinite() {
                let name = &object.name;
                return Err(format!("\"{name}\" adds light to all that it reflects or lets through"));
            }
            most = most.max(own);
        }
        Ok(most)
    }

    /// What can arrive at a surface.
    fn arriving_at_most(&self, gloss: GlossRays) -> Result<Arriving, String> {
        let (mut seen, mut ambient, mut lamps, mut irradiance) = (0.0, 0.0, 0.0f32, 0.0);
        for (index, light) in self.lights.iter().enumerate() {
            let LightBound { facing, fades_from, .. } = light.bound();
            if light.surrounds() {
                seen += light.bound().seen;
                ambient += light.bound().ambient;
            } else {
                lamps = lamps.max(light.bound().seen);
            }
            let nearest = match fades_from {
                Some(place) if facing > 0.0 => self.nearest(place),
                _ => 1.0,
            };
            let own = if facing > 0.0 { facing / (nearest * nearest) } else { 0.0 };
            if own.is_infinite() {
                let name = self.light_names.get(index).map_or("?", String::as_str);
                return Err(format!("light \"{name}\" grows without limit near it, where surfaces may be"));
            }
            irradiance += own;
        }
        Ok(Arriving { sky: f32::max(seen, ambient), lamps, facing: irradiance / PI, gloss })
    }

    /// No surface comes nearer to a point of render space, in metres; 0 if one may touch it.
    fn nearest(&self, p: Point3) -> f32 {
        let shutter = &self.view.shutter;
        let moments = match shutter.sees_one_moment() {
            true => 1,
            false => MOMENTS,
        };
        let time = |i: u32| {
            let row = i * self.view.height.saturating_sub(1) / MOMENTS.max(1);
            shutter.moment(i as f32 / MOMENTS as f32, row, self.view.height)
        };
        let pieces = self.pieces(time(0));
        if (1..moments).any(|i| self.have_moved(&pieces, time(i))) {
            return 0.0;
        }
        let mut known = HashMap::new();
        let boxes = pieces.iter().map(|piece| (box_distance(piece, p, &mut known), piece));
        let mut nearest_first: Vec<(f64, &Piece<'_>)> = boxes.collect();
        nearest_first.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut nearest = f64::INFINITY;
        for (at_least, piece) in nearest_first {
            if at_least >= nearest {
                break;
            }
            nearest = nearest.min(distance(piece, p, time(0)).unwrap_or(at_least));
        }
        nearest as f32
    }

    fn have_moved(&self, before: &[Piece<'_>], time: f32) -> bool {
        let is_still = |piece: &Piece<'_>| match piece.form {
            Form::Mesh(mesh) => mesh.is_still(),
            Form::Shape(_) => true,
        };
        let places = |a: &Piece<'_>, b: &Piece<'_>| a.render_from_object == b.render_from_object;
        before.iter().zip(self.pieces(time)).any(|(a, b)| !places(a, &b) || !is_still(a))
    }
}

/// How far a point is from the box around a piece.
fn box_distance(piece: &Piece<'_>, p: Point3, known: &mut HashMap<*const Mesh, Bounds3>) -> f64 {
    let own = match piece.form {
        Form::Mesh(mesh) => *known
            .entry(std::ptr::from_ref(mesh))
            .or_insert_with(|| Bounds3::around(mesh.positions.iter().copied())),
        Form::Shape(shape) => shape.bounds(),
    };
    if !own.is_finite() {
        return 0.0;
    }
    let placed = Bounds3::around(own.corners().map(|corner| piece.render_from_object.point(corner)));
    let (p, low, high) = (p.to_f64(), placed.min.to_f64(), placed.max.to_f64());
    (low - p).max(p - high).max(DVec3::ZERO).length()
}

/// How far a point is from a piece; `None` if that is not known.
fn distance(piece: &Piece<'_>, p: Point3, time: f32) -> Option<f64> {
    let place = |corner: Point3| piece.render_from_object.point(corner).to_f64();
    match piece.form {
        Form::Mesh(mesh) => {
            let corners = mesh.indices.iter().map(|t| mesh.corners(t.map(|i| i as usize), time).map(place));
            Some(corners.map(|corners| to_triangle(p.to_f64(), corners)).fold(f64::INFINITY, f64::min))
        }
        Form::Shape(shape) if shape.bounds().is_finite() => None,
        Form::Shape(shape) => to_plane(piece, shape, p),
    }
}

/// The distance from an endless plane, which a ray along one of the axes meets.
fn to_plane(piece: &Piece<'_>, shape: &dyn Shape, p: Point3) -> Option<f64> {
    let o = piece.render_from_object.inverse().point(p);
    let axes = [Vector3::new(1.0, 0.0, 0.0), Vector3::new(0.0, 1.0, 0.0), Vector3::new(0.0, 0.0, 1.0)];
    axes.into_iter().flat_map(|axis| [axis, -axis]).find_map(|d| {
        let ray = Ray { o, d, t_min: 0.0, t_max: f32::INFINITY, time: 0.0 };
        let hit = shape.intersect(&ray)?;
        let surface = shape.surface(&ray, &hit).placed(&piece.render_from_object, false);
        Some((p.to_f64() - surface.p.to_f64()).dot(surface.n_g.to_f64()).abs())
    })
}

/// The distance from a triangle: from its plane above it, else from the nearest edge.
fn to_triangle(p: DVec3, corners: [DVec3; 3]) -> f64 {
    let edges = [0, 1, 2].map(|i| (corners[i], corners[(i + 1) % 3] - corners[i]));
    let n = edges[0].1.cross(edges[1].1);
    let is_above = n != DVec3::ZERO && edges.iter().all(|(a, edge)| n.dot(edge.cross(p - *a)) >= 0.0);
    if is_above {
        return (p - corners[0]).dot(n).abs() / n.length();
    }
    let to_edge = |(a, edge): (DVec3, DVec3)| {
        let share = ((p - a).dot(edge) / edge.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        (p - a - edge * share).length()
    };
    edges.map(to_edge).into_iter().fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_is_as_far_as_its_nearest_point() {
        let corners = [DVec3::ZERO, DVec3::X * 2.0, DVec3::Y * 2.0];
        let cases = [
            (DVec3::new(0.5, 0.5, 3.0), 3.0),
            (DVec3::new(0.5, 0.5, -3.0), 3.0),
            (DVec3::new(-4.0, 0.0, 3.0), 5.0),
            (DVec3::new(1.0, -2.0, 0.0), 2.0),
            (DVec3::new(2.0, 2.0, 0.0), 2f64.sqrt()),
        ];
        for (p, expected) in cases {
            assert!((to_triangle(p, corners) - expected).abs() < 1e-12, "{p}");
        }
        let point = [DVec3::ONE; 3];
        assert!((to_triangle(DVec3::new(1.0, 1.0, 4.0), point) - 3.0).abs() < 1e-12);
    }
}
