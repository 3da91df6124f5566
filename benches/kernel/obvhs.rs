//! obvhs, a BVH crate in Rust: eight-wide compressed trees over triangles one at a time.
//!
//! Built by its own preset "medium", which it recommends beside Embree; triangles lie in the order of the leaves, as its
//! documentation advises. It takes the finite `t_max` that rays without end need.
use std::{hint::black_box, time::Duration};

use durer::{
    glam::Vec3A,
    math::{Point3, Ray},
};
use durer_benches::{
    rays::{Found, Query},
    scene::Mesh,
    turns::Kernel,
};
use obvhs::{
    BvhBuildParams,
    cwbvh::{CwBvh, builder::build_cwbvh_from_tris},
    ray::{Ray as ObvhsRay, RayHit},
    rt_triangle::RtTriangle,
    triangle::Triangle,
};

/// A mesh in its tree.
pub(crate) struct Obvhs {
    tree: CwBvh,
    triangles: Vec<RtTriangle>,
}

impl Obvhs {
    pub(crate) fn build(mesh: &Mesh) -> Self {
        let corner = |vertex: u32| vector(mesh.positions[vertex as usize]);
        let triangles: Vec<Triangle> = mesh
            .indices
            .iter()
            .map(|&[a, b, c]| Triangle { v0: corner(a), v1: corner(b), v2: corner(c) })
            .collect();
        let params = BvhBuildParams::medium_build();
        let tree = build_cwbvh_from_tris(&triangles, params, &mut Duration::default());
        let leaves = tree.primitive_indices.iter().map(|&i| RtTriangle::from(&triangles[i as usize]));
        Self { triangles: leaves.collect(), tree }
    }

    #[inline(never)]
    fn closest(&self, ray: &Ray) -> Option<RayHit> {
        let mut hit = RayHit::none();
        let found =
            self.tree.ray_traverse(as_theirs(ray), &mut hit, |ray, i| self.triangles[i].intersect(ray));
        found.then_some(hit)
    }

    #[inline(never)]
    fn any(&self, ray: &Ray) -> bool {
        !self.tree.ray_traverse_miss(as_theirs(ray), |ray, i| self.triangles[i].intersect(ray))
    }
}

fn vector(p: Point3) -> Vec3A {
    Vec3A::from_array(p.to_array())
}

fn as_theirs(ray: &Ray) -> ObvhsRay {
    ObvhsRay::new(vector(ray.o), Vec3A::from_array(ray.d.to_array()), ray.t_min, ray.t_max.min(f32::MAX))
}

impl Kernel for Obvhs {
    fn trace(&self, rays: &[Ray], query: Query) {
        for ray in rays {
            match query {
                Query::Closest => _ = black_box(self.closest(ray)),
                Query::Any => _ = black_box(self.any(ray)),
            }
        }
    }

    fn find(&self, ray: &Ray, query: Query) -> Option<Found> {
        match query {
            Query::Closest => self.closest(ray).map(|hit| Found {
                t: hit.t,
                instance: 0,
                prim: self.tree.primitive_indices[hit.primitive_id as usize],
            }),
            Query::Any => self.any(ray).then_some(Found { t: 0.0, instance: 0, prim: 0 }),
        }
    }
}
