//! What part of a surface a sample stands for: its share of a pixel, thrown onto the surface.
//!
//! A pixel's width and height, seen along an eye ray, become two tangents of the surface it meets (Igehy 1999). After a
//! bounce the surface is taken as if the camera looked at it from where it is (`Camera::Approximate_dp_dxy` of pbrt-v4):
//! cheap, nothing travels with the ray, and too small rather than too large where mirrors or diffuse surfaces widen what is
//! seen. With n samples a pixel each stands for `1 / sqrt(n)` of its sides, but at least for an eighth, so that textures
//! stay smooth between samples.
use durer_core::math::{Ray, Vector3};
use durer_model::{
    Surface,
    camera::central_differentials,
    texture::{Filters, Footprint, Habit},
};

use crate::{PathRay, View};

/// Least share of a pixel's side.
const LEAST_SHARE: f32 = 0.125;

/// Who looks at a surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Onlooker {
    /// Metres from the eye to the ray's origin; `None` after a bounce.
    walked: Option<f32>,
    /// Samples of the pixel.
    samples: u32,
    habit: Habit,
}

impl Onlooker {
    /// At the end of a ray.
    pub(crate) fn of(path: &PathRay, habit: Habit) -> Self {
        let walked = (path.depth == 0).then_some(path.walked);
        Self { walked, samples: path.sampler.count(), habit }
    }

    /// Of an eye ray that stands for a whole pixel.
    pub(crate) fn of_pixel() -> Self {
        Self { walked: Some(0.0), samples: 1, habit: Habit::Asked }
    }

    /// Whether textures of which the most curious wants this much need to know the footprint.
    pub(crate) fn asks(&self, filters: Filters) -> bool {
        match filters {
            Filters::Never => false,
            Filters::AsPbrt => self.habit == Habit::AsPbrt,
            Filters::Always => true,
        }
    }

    /// The footprint on `surface`, where `ray`, of unit direction, hit after `t` metres.
    pub(crate) fn footprint(&self, view: &View, ray: &Ray, t: f32, surface: &Surface) -> Footprint {
        let render_from_camera = view.render_from_camera(ray.time);
        let camera_from_render = render_from_camera.inverse();
        let (along, differentials) = match self.walked {
            Some(walked) => {
                let along = camera_from_render.vector(ray.d) * (walked + t);
                (along, view.camera.differentials(along.normalize()))
            }
            None => {
                let along = Vector3::from_f64(camera_from_render.point(surface.p).to_f64());
                (along, central_differentials(&*view.camera, along.normalize()))
            }
        };
        let (distance, d) = (along.length(), along.normalize());
        let n = camera_from_render.normal(surface.n_g);
        let share = (1.0 / (self.samples.max(1) as f32).sqrt()).max(LEAST_SHARE);
        let sides = [share / view.width.max(1) as f32, share / view.height.max(1) as f32];
        let tangents = std::array::from_fn(|i| {
            let across = (differentials[i].o + differentials[i].d * distance) * sides[i];
            // Along the ray to the plane of the surface.
            render_from_camera.vector(across - d * (n.dot(across) / n.dot(d)))
        });
        Footprint::on(surface, tangents, self.habit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::CameraPlacement;
    use durer_core::{
        glam::{DAffine3, DVec3},
        math::{Normal3, Point2, Point3, Transform},
    };
    use durer_model::{camera::CAMERAS, filter::Filter};
    use durer_scene::{Args, Diagnostics, Node, Params, find};

    const SIZE: [u32; 2] = [400, 300];

    fn view(kind: &str, params: Params) -> View {
        let (node, mut said) = (Node::new(kind, params), Diagnostics::default());
        let entry = find(CAMERAS, "camera", &node, &mut said).expect("a registered word");
        let mut camera = (entry.build)(&mut Args::check(&node, entry.schema, &[], &mut said)).expect("sound");
        camera.fit(SIZE[0], SIZE[1]);
        let place = DAffine3::from_rotation_y(0.7) * DAffine3::from_scale(DVec3::new(-2.0, 2.0, 2.0));
        View {
            shutter: camera.shutter().clone(),
            camera,
            placement: CameraPlacement::Still(Transform::from_f64(&place)),
            world_from_render: DVec3::ZERO,
            width: SIZE[0],
            height: SIZE[1],
            filter: Filter::pixel(),
            speed: 1.0,
            sensor: Default::default(),
            layers: None,
        }
    }

    /// Where a ray meets the plane through `p` with normal `n`: the way, and the place.
    fn met(ray: &Ray, p: Point3, n: Normal3) -> (f32, Point3) {
        let t = n.dot(p - ray.o) / n.dot(ray.d);
        (t, ray.at(t))
    }

    fn surface(p: Point3, n: Normal3, [dpdu, dpdv]: [Vector3; 2]) -> Surface {
        let uv = Point2::new(0.0, 0.0);
        Surface {
            p,
            p_error: Vector3::ZERO,
            n_g: n,
            n_s: n,
            uv,
            second_uv: uv,
            face: 0,
            dpdu,
            dpdv,
            vertex_color: [1.0; 4],
            footprint: Footprint::POINT,
        }
    }

    /// Footprints of eye rays are what rays through neighbouring pixels meet, also through the rim of a lens.
    #[test]
    fn footprints_of_eye_rays_reach_to_the_next_pixels() {
        let lens = Params::new().float("lensradius", 0.05).float("focaldistance", 3.0);
        for (kind, params) in [
            ("perspective", Params::new().float("fov", 70.0)),
            ("perspective", lens.clone()),
            ("orthographic", Params::new()),
            ("orthographic", lens),
        ] {
            let view = view(kind, params);
            for (x, y) in [(200.0, 150.0), (20.5, 280.5), (390.0, 3.0)] {
                let through = |x: f32, y: f32| view.ray(Point2::new(x, y), Point2::new(0.8, 0.1), 0.0);
                let ray = through(x, y);
                let n = Normal3::from((ray.d * -1.0 + Vector3::new(0.3, 0.5, -0.2)).normalize());
                // In focus: lenses blur the rest, which is not the footprint's business.
                let (t, p) = met(&ray, ray.at(6.0 / ray.d.length()), n);
                let (u, v) =
                    (n.cross(Vector3::new(0.2, 1.0, 0.1)) * 3.0, n.cross(Vector3::new(1.0, 0.0, 0.4)));
                let onlooker = Onlooker { walked: Some(0.0), samples: 1, habit: Habit::Asked };
                let footprint = onlooker.footprint(&view, &ray, t, &surface(p, n, [u, v]));
                for (tangent, duv, [dx, dy]) in [
                    (footprint.dpdx, footprint.duvdx, [0.5, 0.0]),
                    (footprint.dpdy, footprint.duvdy, [0.0, 0.5]),
                ] {
                    let step = met(&through(x + dx, y + dy), p, n).1 - met(&through(x - dx, y - dy), p, n).1;
                    assert!((tangent - step).length() < 0.01 * step.length(), "{kind}: {tangent:?} {step:?}");
                    let by_uv = u * duv[0] + v * duv[1];
                    assert!((by_uv - tangent).length() < 1e-3 * step.length(), "{by_uv:?} {tangent:?}");
                }
            }
        }
    }

    #[test]
    fn after_a_bounce_the_camera_looks_from_where_it_is() {
        let view = view("perspective", Params::new().float("fov", 50.0));
        let ray = view.ray(Point2::new(200.0, 150.0), durer_model::camera::Lens::CENTRE, 0.0);
        let n = Normal3::from(-ray.d);
        let surface = surface(ray.at(5.0), n, [Vector3::new(1.0, 0.0, 0.0), Vector3::new(0.0, 1.0, 0.0)]);
        let of = |walked: Option<f32>, samples: u32| {
            let onlooker = Onlooker { walked, samples, habit: Habit::Asked };
            let footprint = onlooker.footprint(&view, &ray, 5.0, &surface);
            [footprint.dpdx.length(), footprint.dpdy.length()]
        };
        let near = |a: [f32; 2], b: [f32; 2]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 2e-3 * b);
        let direct = of(Some(0.0), 1);
        assert!(near(of(None, 1), direct), "{:?} {direct:?}", of(None, 1));
        assert!(near(of(None, 16), direct.map(|s| s / 4.0)));
        assert!(near(of(Some(0.0), 10_000), direct.map(|s| s / 8.0)), "an eighth is the least");
        let asks =
            |habit: Habit, filters: Filters| Onlooker { walked: None, samples: 1, habit }.asks(filters);
        assert!(!asks(Habit::AsPbrt, Filters::Never) && !asks(Habit::Asked, Filters::AsPbrt));
        assert!(asks(Habit::AsPbrt, Filters::AsPbrt) && asks(Habit::Asked, Filters::Always));
    }
}
