//! A material, a place and what is seen there, for tests.
#![allow(dead_code, reason = "each test target uses some of it")]
use durer_core::{
    math::{Normal3, Point2, Point3, Vector3},
    spectrum::Basis,
};
use durer_model::{
    ShadeCx, Surface,
    bsdf::{Branch, Bsdf},
    material::{MATERIALS, Material},
};
use durer_scene::{Args, Diagnostics, Node, Params, find};

pub(crate) const CX: ShadeCx<'static> = ShadeCx { basis: Basis::Rgb, textures: &[], log: None };

pub(crate) fn built(kind: &str, params: Params) -> (Option<Box<dyn Material>>, Diagnostics) {
    let mut diagnostics = Diagnostics::default();
    let node = Node::new(kind, params);
    let entry = find(MATERIALS, "material", &node, &mut diagnostics).expect("a registered material");
    let mut args = Args::check(&node, entry.schema, &[], &mut diagnostics);
    let material = (entry.build)(&mut args);
    (material, diagnostics)
}

pub(crate) fn material(kind: &str, params: Params) -> Box<dyn Material> {
    let (material, diagnostics) = built(kind, params);
    assert!(diagnostics.is_empty(), "{diagnostics:?}");
    material.expect("sound parameters")
}

/// A horizontal place with z up, u along x and v along y.
pub(crate) fn place() -> Surface {
    Surface {
        p: Point3::ZERO,
        p_error: Vector3::ZERO,
        n_g: Normal3::new(0.0, 0.0, 1.0),
        n_s: Normal3::new(0.0, 0.0, 1.0),
        uv: Point2::new(0.5, 0.5),
        second_uv: Point2::new(0.5, 0.5),
        face: 0,
        dpdu: Vector3::new(2.0, 0.0, 0.0),
        dpdv: Vector3::new(0.0, 0.5, 0.0),
        vertex_color: [1.0; 4],
        footprint: durer_model::texture::Footprint::POINT,
    }
}

pub(crate) fn seen_under(cos: f32) -> Vector3 {
    Vector3::new((1.0 - cos * cos).sqrt(), 0.0, cos)
}

pub(crate) fn bsdf(material: &dyn Material, wo: Vector3) -> Bsdf<'_> {
    material.bsdf(&CX, &mut place(), wo)
}

pub(crate) fn branches(bsdf: &Bsdf, wo: Vector3) -> Vec<Branch> {
    bsdf.branches(wo).iter().copied().collect()
}
