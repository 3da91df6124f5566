//! Curves on their way into the kernel: still ones that are placed once stand together in one geometry of each form, however
//! many shapes they come from; the rest become instances.
use std::{collections::HashMap, sync::Arc};

use durer_accel::{
    Placement,
    curve::{CurveBasis, CurveKind, Curves},
};
use durer_core::{
    Id,
    glam::DAffine3,
    math::{Motion, Point3, Vector3},
};
use durer_model::shape::{StrandForm, Strands};

use crate::{Object, scene::Owners};

/// A geometry of the kernel.
pub(super) struct Gathered {
    pub(super) curves: Arc<Curves>,
    pub(super) owners: Owners,
    /// All objects that are part of it, at least one.
    pub(super) objects: Vec<Id<Object>>,
    pub(super) placement: Placement,
}

/// What curves that stand together have become so far.
struct Heap {
    curves: Curves,
    owners: Vec<(Id<Object>, u32)>,
    objects: Vec<Id<Object>>,
}

impl Heap {
    fn new(form: StrandForm) -> Self {
        let kind = match form {
            StrandForm::Flat => CurveKind::Flat,
            StrandForm::Ribbon => CurveKind::Oriented,
            StrandForm::Round => CurveKind::Round,
        };
        let curves = Curves {
            kind,
            basis: CurveBasis::Bezier,
            points: Vec::new(),
            radii: Vec::new(),
            normals: Vec::new(),
            segments: Vec::new(),
        };
        Self { curves, owners: Vec::new(), objects: Vec::new() }
    }

    /// Adds curves where `m`, which stretches by `scale` in all directions, places them.
    fn add(&mut self, object: Id<Object>, strands: &Strands, (m, scale): (&DAffine3, f64)) {
        let first = self.curves.points.len() as u32;
        let parts = 0..strands.count() as u32;
        self.curves.segments.extend(parts.clone().map(|i| first + i * Strands::POINTS as u32));
        self.owners.extend(parts.map(|part| (object, part)));
        let points = strands.points.iter().map(|p| Point3::from_f64(m.transform_point3(p.to_f64())));
        self.curves.points.extend(points);
        self.curves.radii.extend(strands.radii.iter().map(|r| (f64::from(*r) * scale) as f32));
        let turned = |n: &Vector3| Vector3::from_f64(m.transform_vector3(n.to_f64()) / scale);
        self.curves.normals.extend(strands.normals.iter().map(turned));
        self.objects.push(object);
    }

    fn finish(self, placement: Placement) -> Gathered {
        Gathered {
            curves: Arc::new(self.curves),
            owners: self.owners.into(),
            objects: self.objects,
            placement,
        }
    }
}

/// By what a transformation stretches, if it does so in all directions.
fn scale(m: &DAffine3) -> Option<f64> {
    let [x, y, z] = [m.matrix3.x_axis, m.matrix3.y_axis, m.matrix3.z_axis];
    let scale = x.length();
    let close = |a: f64, b: f64| (a - b).abs() <= 1e-5 * scale * scale;
    let is_even = close(y.length_squared(), scale * scale) && close(z.length_squared(), scale * scale);
    let is_square = close(x.dot(y), 0.0) && close(y.dot(z), 0.0) && close(z.dot(x), 0.0);
    // A mirroring would turn the sides of what faces the ray.
    (is_even && is_square && m.matrix3.determinant() > 0.0).then_some(scale)
}

/// Geometries for these curves, in an order that depends on theirs alone.
pub(super) fn gathered(strands: Vec<(Id<Object>, Arc<Strands>, Motion)>) -> Vec<Gathered> {
    let mut uses: HashMap<*const Strands, u32> = HashMap::new();
    strands.iter().for_each(|(_, strands, _)| *uses.entry(Arc::as_ptr(strands)).or_default() += 1);
    let mut heaps: [Option<Heap>; 3] = [None, None, None];
    let mut apart = Vec::new();
    for (object, strands, motion) in strands {
        let m = motion.at(0.0);
        let is_single = uses.get(&Arc::as_ptr(&strands)) == Some(&1);
        match scale(&m).filter(|_| is_single && motion.is_still()) {
            Some(scale) => {
                let heap = heaps[strands.form as usize].get_or_insert_with(|| Heap::new(strands.form));
                heap.add(object, &strands, (&m, scale));
            }
            None => {
                let mut heap = Heap::new(strands.form);
                heap.add(object, &strands, (&DAffine3::IDENTITY, 1.0));
                apart.push(heap.finish(Placement::from_motion(&motion)));
            }
        }
    }
    heaps.into_iter().flatten().map(|heap| heap.finish(Placement::Identity)).chain(apart).collect()
}
