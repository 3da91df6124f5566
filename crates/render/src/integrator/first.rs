//! What an eye ray meets first, whatever the integrator makes of it: a ray of its own, of the same sample.
use durer_core::math::{Normal3, Transform};
use durer_model::texture::Habit;
use durer_scene::Space;

use super::shading::Shading;
use crate::{PathRay, SampleCx, footprint::Onlooker, probe::NoProbe};

/// What a sample's eye ray meets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Met {
    /// The place.
    pub p: [f64; 3],
    /// The geometric normal, on the side of the eye.
    pub n: [f32; 3],
    /// The shading normal.
    pub ns: [f32; 3],
    /// Surface coordinates.
    pub uv: [f32; 2],
    /// What a pixel to the right, and one down, adds to z along the surface.
    pub dz: [f32; 2],
    /// The colour of the material, linear Rec. 709.
    pub albedo: [f32; 3],
}

/// What an eye ray meets first that is no hole, told in a space; `None` if it meets nothing.
pub fn first_met(cx: &SampleCx<'_>, ray: &PathRay, space: Space) -> Option<Met> {
    let view = &cx.scene.view;
    let hit = cx.scene.closest(cx, &ray.ray, &mut NoProbe, ())?;
    let s = Shading::at(cx, &ray.ray, &hit, Some(Onlooker::of(ray, Habit::Asked)));
    let camera_from_render = || view.render_from_camera(ray.ray.time).inverse();
    let (to_space, p) = match space {
        Space::Camera => {
            let to_camera = camera_from_render();
            (to_camera, to_camera.point(s.surface.p).to_f64().to_array())
        }
        // Render space is the world moved.
        Space::World => (Transform::IDENTITY, view.to_world(s.surface.p)),
    };
    let pixel = Onlooker::of_pixel().footprint(view, &ray.ray, hit.t, &s.surface);
    let facing = |n: Normal3| to_space.normal(n.face_forward(s.wo)).normalize().to_array();
    Some(Met {
        p,
        n: facing(s.surface.n_g),
        ns: facing(s.surface.n_s),
        uv: s.surface.uv.to_array(),
        dz: [pixel.dpdx, pixel.dpdy].map(|d| to_space.vector(d).z),
        albedo: cx.basis.to_rgb(s.bsdf.albedo() * cx.basis.white()),
    })
}
