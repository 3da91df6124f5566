//! Normals of smoothing groups (`s 1`) where the file has none: at each vertex the sum over the faces of the group that
//! meet there, each weighted with its angle (Thürmer and Wüthrich 1998), so that the cut of a face into triangles does
//! not matter. Across groups edges stay sharp; without `s` all are.
use durer_core::{
    glam::DVec3,
    math::{Normal3, Point3, float},
};

use super::{corner::NONE, model::Model, piece::Event};
use crate::import::{polygon::newell, unify::Unifier};

/// Gives corners of smooth faces without normal one.
pub(super) fn add_normals(model: &mut Model) {
    let any = |e: &(usize, Event)| matches!(e.1, Event::Smooth(s) if s != 0);
    if !model.pieces.iter().any(|p| p.events.iter().any(any)) {
        return;
    }
    let mut unifier = Unifier::new(model.positions.len());
    let mut sums: Vec<DVec3> = Vec::new();
    let known = model.normals.len() as u32;
    let (mut group, mut points) = (0, Vec::new());
    for piece in &mut model.pieces {
        let mut events = piece.events.iter().peekable();
        let mut start = 0;
        for (face, &end) in piece.ends.iter().enumerate() {
            while let Some((_, event)) = events.next_if(|(at, _)| *at <= face) {
                if let Event::Smooth(next) = event {
                    group = *next;
                }
            }
            let corners = piece.corners.get_mut(start..end).unwrap_or_default();
            start = end;
            if group == 0 || corners.iter().any(|[_, _, n]| *n != NONE) {
                continue;
            }
            points.clear();
            points.extend(corners.iter().map(|[v, ..]| at(&model.positions, *v)));
            let weights = weighted_normals(&points);
            for ([v, _, n], weighted) in corners.iter_mut().zip(weights) {
                let id = unifier.id(*v, [group, 0], sums.len() as u32);
                if id as usize == sums.len() {
                    sums.push(DVec3::ZERO);
                }
                if let Some(sum) = sums.get_mut(id as usize) {
                    *sum += weighted;
                }
                *n = known + id;
            }
        }
        for (_, event) in events {
            if let Event::Smooth(next) = event {
                group = *next;
            }
        }
    }
    model.normals.extend(sums.iter().map(|n| Normal3::from_f64(n.normalize_or_zero())));
}

fn at(positions: &[Point3], v: u32) -> DVec3 {
    positions.get(v as usize).map_or(DVec3::ZERO, |p| p.to_f64())
}

/// The unit normal of a polygon times the angle at each of its corners.
pub(in crate::import) fn weighted_normals(points: &[DVec3]) -> impl Iterator<Item = DVec3> {
    let normal = newell(points).normalize_or_zero();
    let before = points.iter().cycle().skip(points.len().saturating_sub(1));
    let after = points.iter().cycle().skip(1);
    points.iter().zip(before).zip(after).map(move |((p, a), b)| {
        let (a, b) = (*a - *p, *b - *p);
        normal * f64::from(float::atan2(a.cross(b).length() as f32, a.dot(b) as f32))
    })
}
