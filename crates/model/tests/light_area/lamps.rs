//! Shapes that shine, of all kinds and in all sorts of places, and what rays find of them.
use std::sync::Arc;

use durer_core::{
    glam::{DAffine3, DQuat, DVec3},
    math::{Normal3, Point3, Ray, Transform, Vector3},
    sampling::{Sampler, SamplerKind},
    spectrum::Basis,
};
use durer_model::{
    light::{AREA_LIGHTS, Area, Light, LightCx, LightHit, LightSample, Orientation, Track},
    shape::{Disk, Geometry, Patch, Polygon, Sphere, polygon::FillRule},
};
use durer_scene::{Args, Data, Diagnostics, Mesh, Node, Params, ValueType};

pub(crate) const CX: LightCx = LightCx { basis: Basis::Rgb, time: 0.0 };

/// A shape in its place.
pub(crate) struct Lamp {
    pub(crate) name: &'static str,
    pub(crate) geometry: Geometry,
    pub(crate) place: DAffine3,
}

pub(crate) fn lamp(name: &'static str, geometry: Geometry, place: DAffine3) -> Lamp {
    Lamp { name, geometry, place }
}

pub(crate) fn area(params: Params, lamp: &Lamp, orientation: Orientation) -> Result<Area, &'static str> {
    let mut said = Diagnostics::default();
    let node = Node::new("diffuse", params);
    let mut args = Args::check(&node, AREA_LIGHTS[0].schema, &[], &mut said);
    let emission = (AREA_LIGHTS[0].build)(&mut args).expect("sound parameters");
    Area::new(&emission, &lamp.geometry, Track::still(lamp.place), orientation)
}

pub(crate) fn two_sided() -> Params {
    Params::new().with("twosided", ValueType::Bool, Data::Bools(vec![true]))
}

pub(crate) fn shines(params: Params, lamp: &Lamp) -> Area {
    area(params, lamp, Orientation::AsMade).expect(lamp.name)
}

pub(crate) fn points(list: &[[f32; 3]]) -> Vec<Point3> {
    list.iter().map(|p| Point3::from(*p)).collect()
}

pub(crate) fn mesh(positions: &[[f32; 3]], indices: &[[u32; 3]]) -> Geometry {
    let mesh = Mesh { positions: points(positions), indices: indices.to_vec(), ..Mesh::default() };
    Geometry::Mesh(Arc::new(mesh))
}

pub(crate) fn patch(corners: [[f32; 3]; 4]) -> Geometry {
    Geometry::shape(Patch::new(corners.map(Point3::from)))
}

pub(crate) fn polygon(loops: &[&[[f32; 3]]]) -> Geometry {
    let loops: Vec<_> = loops.iter().map(|l| points(l)).collect();
    Geometry::shape(Polygon::new(&loops, FillRule::EvenOdd).expect("a polygon"))
}

pub(crate) const SQUARE: [[f32; 3]; 4] =
    [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];
pub(crate) const HOLE: [[f32; 3]; 3] = [[-0.5, -0.5, 0.0], [0.7, -0.4, 0.0], [0.1, 0.8, 0.0]];

pub(crate) fn stretched() -> DAffine3 {
    DAffine3::from_scale_rotation_translation(
        DVec3::new(0.6, -1.4, 0.9),
        DQuat::from_rotation_y(0.7),
        DVec3::new(0.2, -0.1, 0.3),
    ) * DAffine3::from_rotation_z(0.5)
}

/// Every shape, as it is and stretched, sheared and mirrored.
pub(crate) fn lamps() -> Vec<Lamp> {
    let i = DAffine3::IDENTITY;
    let turned = DAffine3::from_rotation_x(1.0) * DAffine3::from_scale(DVec3::splat(1.3));
    let mut lamps = Vec::new();
    for (name, place) in [("as made", i), ("turned", turned), ("stretched", stretched())] {
        let shapes = [
            Geometry::shape(Sphere::new(0.8)),
            Geometry::shape(Sphere::cut(0.9, -0.3, 0.7, 250.0)),
            Geometry::shape(Disk::new(0.1, 1.0, 0.0, 360.0)),
            Geometry::shape(Disk::new(-0.2, 1.1, 0.4, 200.0)),
            polygon(&[&SQUARE]),
            polygon(&[&SQUARE, &HOLE]),
            patch([SQUARE[0], SQUARE[1], SQUARE[3], SQUARE[2]]),
            patch([[-1.0, -1.0, 0.3], [1.0, -1.0, -0.4], [-0.9, 1.1, -0.2], [0.8, 0.9, 0.5]]),
            mesh(&SQUARE, &[[0, 1, 2], [0, 2, 3]]),
            mesh(&SQUARE, &[[0, 1, 2]]),
            mesh(
                &[[0.0, 0.0, 0.9], [-0.9, -0.5, 0.0], [0.9, -0.5, 0.0], [0.0, 0.9, 0.0]],
                &[[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]],
            ),
        ];
        lamps.extend(shapes.into_iter().map(|g| lamp(name, g, place)));
    }
    lamps
}

/// Everything of the lamp on the half line from `o` along unit `d`, in f64 for triangles.
pub(crate) fn hits(lamp: &Lamp, o: DVec3, d: DVec3) -> Vec<LightHit> {
    let to_render = Transform::from_f64(&lamp.place);
    match &lamp.geometry {
        Geometry::Mesh(mesh) => {
            let mut found = Vec::new();
            for (part, t) in (0..).zip(&mesh.indices) {
                let [a, b, c] = t.map(|i| lamp.place.transform_point3(mesh.positions[i as usize].to_f64()));
                let n = (b - a).cross(c - a);
                let t = (a - o).dot(n) / d.dot(n);
                let p = o + d * t;
                let inside = |a: DVec3, b: DVec3| (b - a).cross(p - a).dot(n) >= 0.0;
                if t > 0.0 && inside(a, b) && inside(b, c) && inside(c, a) {
                    let n = n.normalize() * lamp.place.matrix3.determinant().signum();
                    found.push(LightHit { p: Point3::from_f64(p), n: Normal3::from_f64(n), part });
                }
            }
            found
        }
        Geometry::Strands(_) => panic!("no lamp is a curve"),
        Geometry::Shapes(parts) => {
            let back = lamp.place.inverse();
            let local = Ray::new(
                Point3::from_f64(back.transform_point3(o)),
                Vector3::from_f64(back.transform_vector3(d)),
            );
            let mut found = Vec::new();
            for (part, shape) in (0..).zip(parts) {
                let mut ray = local;
                while let Some(hit) = shape.intersect(&ray) {
                    let surface = shape.surface(&ray, &hit).placed(&to_render, false);
                    found.push(LightHit { p: surface.p, n: surface.n_g, part });
                    ray.t_min = hit.t * 1.0001;
                }
            }
            found
        }
    }
}

pub(crate) fn sample(light: &Area, from: DVec3, i: u32, n: u32) -> Option<LightSample> {
    light.sample(&CX, Point3::from_f64(from), &Sampler::new(SamplerKind::Sobol, 1, [4, 5], i, n))
}

/// Eyes near, far, aside, nearly in the plane, inside closed shapes.
pub(crate) const EYES: [DVec3; 4] = [
    DVec3::new(0.1, -0.2, 1.6),
    DVec3::new(1.9, 0.4, 0.6),
    DVec3::new(-0.1, 0.15, 0.2),
    DVec3::new(1.3, -1.2, -0.7),
];
