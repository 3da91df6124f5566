//! Rays from the eye: where each touches the scene.
use std::sync::atomic::{AtomicU64, Ordering};

use durer_core::{
    glam::DVec2,
    math::{Normal3, Point2, Ray},
    spectrum::Basis,
};
use durer_render::{SampleCx, Scene, probe::NoProbe};

/// What a ray touched.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Touch {
    /// Object and instance.
    pub(crate) thing: [u32; 2],
    /// Metres from the eye.
    pub(crate) t: f32,
    /// Geometric normal, unit, turned to the eye.
    pub(crate) n_g: Normal3,
    /// Shading normal, unit, turned along with it.
    pub(crate) n_s: Normal3,
}

/// A point of the picture, the ray through it, and what that touched.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spot {
    /// In pixels from the upper left corner.
    pub(crate) at: DVec2,
    pub(crate) ray: Ray,
    pub(crate) touch: Option<Touch>,
}

/// Casts rays and counts them.
pub(crate) struct Eye<'a> {
    cx: SampleCx<'a>,
    /// The moment of the drawing.
    time: f32,
    rays: AtomicU64,
}

impl<'a> Eye<'a> {
    /// Looks through the centre of the lens, at half exposure of the middle row: a drawing is not blurred.
    pub(crate) fn new(scene: &'a Scene) -> Self {
        let view = &scene.view;
        let time = view.shutter.moment(0.5, view.height / 2, view.height);
        Self { cx: SampleCx { scene, basis: Basis::Rgb }, time, rays: AtomicU64::new(0) }
    }

    /// How many rays were cast.
    pub(crate) fn rays(&self) -> u64 {
        self.rays.load(Ordering::Relaxed)
    }

    /// The moment of the drawing, in seconds.
    pub(crate) fn time(&self) -> f32 {
        self.time
    }

    /// The ray through a point of the picture or beside it.
    pub(crate) fn ray(&self, at: DVec2) -> Ray {
        const CENTRE: Point2 = Point2::new(0.5, 0.5);
        self.cx.scene.view.ray(Point2::new(at.x as f32, at.y as f32), CENTRE, self.time)
    }

    /// Casts the ray through a point of the picture.
    pub(crate) fn look(&self, at: DVec2) -> Spot {
        let ray = self.ray(at);
        Spot { at, ray, touch: self.touch(&ray) }
    }

    fn touch(&self, ray: &Ray) -> Option<Touch> {
        self.rays.fetch_add(1, Ordering::Relaxed);
        let hit = self.cx.scene.closest(&self.cx, ray, &mut NoProbe, ())?;
        let (object, surface) = self.cx.scene.surface(ray, &hit);
        let is_back = surface.n_g.dot(ray.d) > 0.0;
        let turn = |n: Normal3| if is_back { -n } else { n };
        // Shapes that are no meshes share an instance: the object tells them apart.
        let thing = [object.index() as u32, hit.instance];
        Some(Touch { thing, t: hit.t, n_g: turn(surface.n_g), n_s: turn(surface.n_s) })
    }
}
