//! Shapes: hits, error bounds, silhouettes, self-intersection.
mod bilinear;
mod cylinder;
mod flat;
mod loopsubdiv;
mod mesh;
mod plymesh;
mod polygon;
mod registry;
mod scale;
mod sdfgrid;
mod sphere;

use std::sync::Arc;

use durer_core::{
    glam::DVec3,
    math::{Point3, Ray, Vector3},
};
use durer_model::shape::{Geometry, SHAPES, Shape};
use durer_scene::{Args, Data, Diagnostics, Missing, Node, Params, ValueType};

/// What the registry makes of a node, or everything it complains about.
fn build(kind: &str, params: Params) -> Result<Geometry, String> {
    let node = Node::new(kind, params);
    let entry = SHAPES.iter().find(|e| e.answers_to(kind)).expect("a registered word");
    let mut diagnostics = Diagnostics::default();
    let mut args =
        Args::check(&node, entry.schema, &[], &mut diagnostics).with_assets(&plymesh::Files, Missing::Warn);
    let built = (entry.build)(&mut args);
    let said = diagnostics.iter().map(|d| d.message.as_str()).collect::<Vec<_>>().join("; ");
    match built {
        Some(geometry) => {
            assert!(!diagnostics.has_errors(), "{kind} was built in spite of: {said}");
            Ok(geometry)
        }
        None => Err(said),
    }
}

fn shape(kind: &str, params: Params) -> Arc<dyn Shape> {
    match build(kind, params) {
        Ok(Geometry::Shapes(parts)) if parts.len() == 1 => parts[0].clone(),
        other => panic!("{kind} is no shape: {other:?}"),
    }
}

fn points(list: &[[f32; 3]]) -> (ValueType, Data) {
    (ValueType::Point3, Data::Floats(list.as_flattened().to_vec()))
}

fn ray(o: DVec3, d: DVec3) -> Ray {
    Ray::new(Point3::from_f64(o), Vector3::from_f64(d))
}
