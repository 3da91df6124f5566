//! Scenes of all kinds of geometry that can be changed.
use durer_accel::curve::{CurveKind, Curves};
use durer_accel::point::{PointKind, Points};
use durer_accel::{
    Accel, AccelBuilder, BuildOptions, GeometryData, GeometryId, Placement, Quads, Triangles, Visibility,
};
use durer_core::glam::{DAffine3, DQuat, DVec3};
use durer_core::math::{Motion, Point3, Transform};

use crate::corpus::{Random, Shape, Shapes};
use crate::shapes::{cloud, strands};

#[derive(Clone)]
pub(super) enum Geometry {
    Mesh(Triangles),
    Quads(Quads),
    Keyed(Vec<[u32; 3]>, Vec<(f32, Vec<Point3>)>),
    Balls(Vec<Shape>),
    Curves(Curves),
    Points(Points),
}

pub(super) struct Recipe {
    pub(super) geometries: Vec<Geometry>,
    pub(super) instances: Vec<(usize, Placement, Visibility)>,
}

fn affine(random: &mut Random) -> DAffine3 {
    let turn =
        DQuat::from_axis_angle(random.direction().to_f64().normalize(), random.between(0.0, 3.0).into());
    let scale = DVec3::new(random.between(0.3, 1.5).into(), -0.8, random.between(0.3, 1.5).into());
    DAffine3::from_scale_rotation_translation(scale, turn, random.point(2.0).to_f64())
}

pub(super) fn placement(random: &mut Random) -> Placement {
    match random.below(5) {
        0 => Placement::Identity,
        1 | 2 => Placement::Still(Transform::from_f64(&affine(random))),
        3 => {
            let keys = Motion::keyed(vec![(0.0, affine(random)), (1.0, affine(random))]);
            Placement::from_motion(&keys.expect("sound keys"))
        }
        _ => {
            let (a, b) = (affine(random), affine(random));
            Placement::Moving(vec![(-0.5, Transform::from_f64(&a)), (0.7, Transform::from_f64(&b))])
        }
    }
}

fn points(random: &mut Random, count: usize) -> Vec<Point3> {
    let centers: Vec<_> = (0..5).map(|_| random.point(2.0)).collect();
    (0..count).map(|_| centers[random.below(5)] + random.direction() * random.between(0.0, 0.7)).collect()
}

fn corners<const N: usize>(random: &mut Random, count: usize, vertices: usize) -> Vec<[u32; N]> {
    (0..count).map(|_| std::array::from_fn(|_| random.below(vertices) as u32)).collect()
}

impl Geometry {
    /// Numbered by kind.
    fn new(random: &mut Random, kind: usize) -> Self {
        match kind {
            0 => Self::Mesh(Triangles { positions: points(random, 50), indices: corners(random, 70, 50) }),
            1 => Self::Quads(Quads { positions: points(random, 40), indices: corners(random, 30, 40) }),
            2 => {
                let keys = [-0.1, 0.3, 0.8].map(|time| (time, points(random, 40)));
                Self::Keyed(corners(random, 40, 40), keys.to_vec())
            }
            3 => Self::Balls((0..20).map(|_| shape(random)).collect()),
            4 => {
                let kind = [CurveKind::Round, CurveKind::Flat][random.below(2)];
                Self::Curves(strands(random, kind, 15))
            }
            _ => Self::Points(cloud(random, PointKind::Sphere, 40)),
        }
    }

    /// Of the same kind and size, different otherwise.
    pub(super) fn another(&self, random: &mut Random) -> Self {
        match self {
            Self::Mesh(_) => Self::new(random, 0),
            Self::Quads(_) => Self::new(random, 1),
            Self::Keyed(..) => Self::new(random, 2),
            Self::Balls(_) => Self::new(random, 3),
            Self::Curves(curves) => {
                let shift = random.direction();
                let points = curves.points.iter().map(|p| *p + shift + random.direction() * 0.1).collect();
                let radii = curves.radii.iter().map(|r| r * random.between(0.5, 2.0)).collect();
                Self::Curves(Curves { points, radii, ..curves.clone() })
            }
            Self::Points(_) => Self::new(random, 5),
        }
    }

    pub(super) fn data(&self) -> GeometryData<'_> {
        match self {
            Self::Mesh(Triangles { positions, indices }) => GeometryData::Triangles { positions, indices },
            Self::Quads(mesh) => GeometryData::Quads(mesh.clone()),
            Self::Keyed(indices, keys) => GeometryData::KeyedTriangles {
                indices,
                keys: keys.iter().map(|(time, positions)| (*time, positions.as_slice())).collect(),
            },
            Self::Balls(balls) => GeometryData::User(balls.iter().map(Shape::bounds).collect()),
            Self::Curves(curves) => GeometryData::Curves(curves.clone()),
            Self::Points(points) => GeometryData::Points(points.clone()),
        }
    }

    fn add<'a>(&'a self, builder: &mut AccelBuilder<'a>) -> GeometryId {
        let id = match self.data() {
            GeometryData::Triangles { positions, indices } => builder.borrowed_triangles(positions, indices),
            GeometryData::Quads(mesh) => builder.quads(mesh),
            GeometryData::KeyedTriangles { indices, keys } => builder.keyed_triangles(indices, keys),
            GeometryData::User(boxes) => builder.user(boxes),
            GeometryData::Curves(curves) => builder.curves(curves),
            GeometryData::Points(points) => builder.points(points),
        };
        id.expect("sound geometry")
    }

    fn landmarks(&self) -> &[Point3] {
        match self {
            Self::Mesh(mesh) => &mesh.positions,
            Self::Quads(mesh) => &mesh.positions,
            Self::Keyed(_, keys) => &keys[1].1,
            Self::Balls(_) => &[],
            Self::Curves(curves) => &curves.points,
            Self::Points(points) => &points.centers,
        }
    }
}

/// Rarely a plane, whose box is infinite.
fn shape(random: &mut Random) -> Shape {
    if random.below(60) == 0 {
        return Shape::Plane { point: random.point(3.0), normal: random.direction().into() };
    }
    Shape::Sphere { center: random.point(2.0), radius: random.between(0.02, 0.3) }
}

impl Recipe {
    /// Of each kind one geometry that lies in the scene's tree, and one that is placed twice, or once but apart.
    pub(super) fn new(random: &mut Random) -> Self {
        let (mut geometries, mut instances) = (Vec::new(), Vec::new());
        let all = Visibility::default();
        let some = Visibility { mask: 1, ..all };
        // A mesh that is placed elsewhere is part of the scene's tree too.
        geometries.push(Geometry::new(random, 0));
        instances.push((0, Placement::Still(Transform::from_f64(&affine(random))), all));
        for kind in 0..6 {
            geometries.push(Geometry::new(random, kind));
            instances.push((geometries.len() - 1, Placement::Identity, if kind == 1 { some } else { all }));
            geometries.push(Geometry::new(random, kind));
            let copies = 1 + kind % 2;
            for copy in 0..copies {
                let placed = if copy == 0 { placement(random) } else { Placement::Identity };
                instances.push((geometries.len() - 1, placed, if copy == 1 { some } else { all }));
            }
        }
        Self { geometries, instances }
    }

    /// Whether a geometry has trees of its own.
    fn is_apart(&self, geometry: usize) -> bool {
        geometry != 0
            && (geometry.is_multiple_of(2) || matches!(self.geometries[geometry], Geometry::Keyed(..)))
    }

    /// Instances that can be placed anew.
    pub(super) fn movable(&self) -> Vec<u32> {
        let indices = (0u32..).zip(&self.instances);
        indices.filter(|(_, (geometry, ..))| self.is_apart(*geometry)).map(|(index, _)| index).collect()
    }

    pub(super) fn build(&self, options: BuildOptions) -> (Accel, Vec<GeometryId>) {
        let mut builder = AccelBuilder::new(options);
        let ids: Vec<_> = self.geometries.iter().map(|geometry| geometry.add(&mut builder)).collect();
        for (_, id) in ids.iter().enumerate().filter(|(geometry, _)| self.is_apart(*geometry)) {
            builder.keep_apart(*id).expect("known");
        }
        for (geometry, placement, seen) in &self.instances {
            builder.instance_seen(ids[*geometry], placement.clone(), *seen).expect("sound placement");
        }
        (builder.build().expect("within limits"), ids)
    }

    pub(super) fn shapes(&self) -> Shapes {
        let of = |geometry: usize| match &self.geometries[geometry] {
            Geometry::Balls(balls) => balls.clone(),
            _ => Vec::new(),
        };
        Shapes(self.instances.iter().map(|(geometry, ..)| of(*geometry)).collect())
    }

    pub(super) fn landmarks(&self) -> Vec<Point3> {
        self.geometries.iter().flat_map(|geometry| geometry.landmarks().iter().copied()).collect()
    }
}
