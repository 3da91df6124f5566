//! The camera in its place, still or moving, and how its picture is taken.
use durer_accel::Placement;
use durer_core::{
    glam::{DAffine3, DVec3},
    math::{Motion, Point2, Point3, Ray, Transform, Vector3},
};
use durer_model::{
    camera::{Camera, EyeRay, Shutter},
    filter::Filter,
};

use crate::film::{Layers, Sensor};

/// The camera in its place, and the picture it takes.
#[derive(Debug)]
pub struct View {
    /// The camera.
    pub camera: Box<dyn Camera>,
    /// Its placement in render space.
    pub placement: CameraPlacement,
    /// Render space is the world moved by this vector, so that the camera is at its origin when the shutter opens (f64:
    /// the move is exact).
    pub world_from_render: DVec3,
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// When what is exposed.
    pub shutter: Shutter,
    /// How pixels are made of samples.
    pub filter: Filter,
    /// What the picture is multiplied with: the film's speed, ISO 100 is 1.
    pub speed: f32,
    /// What the film makes of that.
    pub sensor: Sensor,
    /// What the film keeps beside colours.
    pub layers: Option<Layers>,
}

/// A point as the camera sees it, in render space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sighted {
    /// Where the eye ray starts.
    pub from: Point3,
    /// The place in the picture, in pixels; it may lie around it.
    pub film: Point2,
    /// See [`View::importance`].
    pub importance: f32,
}

/// `render_from_camera`, at every moment.
#[derive(Clone, Debug, PartialEq)]
pub enum CameraPlacement {
    /// The same at all times.
    Still(Transform),
    /// `(seconds, rows of the matrix)` with rising times, between which the rows move linearly, as the kernel moves shapes:
    /// what moves along with the camera stands still in the picture.
    Moving(Vec<(f32, [[f32; 4]; 3])>),
}

impl CameraPlacement {
    /// In pieces short enough that turns are round; `None` where the matrix has no inverse.
    pub fn from_motion(motion: &Motion) -> Option<Self> {
        let sound = |m: &Transform| m.is_invertible();
        match Placement::from_motion(motion) {
            Placement::Identity => Some(Self::Still(Transform::IDENTITY)),
            Placement::Still(m) => sound(&m).then_some(Self::Still(m)),
            Placement::Moving(keys) => {
                let rows = keys.iter().map(|(time, m)| (*time, *m.rows())).collect();
                keys.iter().all(|(_, m)| sound(m)).then_some(Self::Moving(rows))
            }
        }
    }

    /// The map at `time` seconds.
    pub fn at(&self, time: f32) -> Transform {
        match self {
            Self::Still(m) => *m,
            Self::Moving(keys) => Transform::from_f64(&affine(&rows(keys, time))),
        }
    }

    /// Maps a ray at its time. The direction is not normalised.
    fn ray(&self, ray: &Ray) -> Ray {
        match self {
            Self::Still(m) => m.ray(ray),
            // PERF: without the inverse, which takes longer than all the rest (bench render).
            Self::Moving(keys) => {
                let m = rows(keys, ray.time);
                let (o, d) = (ray.o, ray.d);
                let [ox, oy, oz] = m.map(|r| r[0] * o.x + r[1] * o.y + r[2] * o.z + r[3]);
                let [dx, dy, dz] = m.map(|r| r[0] * d.x + r[1] * d.y + r[2] * d.z);
                Ray { o: Point3::new(ox, oy, oz), d: Vector3::new(dx, dy, dz), ..*ray }
            }
        }
    }
}

/// The matrix between the keys around `time`; before the first and after the last key it is held.
fn rows(keys: &[(f32, [[f32; 4]; 3])], time: f32) -> [[f32; 4]; 3] {
    let after = keys.partition_point(|key| key.0 <= time);
    let (Some((t0, a)), Some((t1, b))) = (after.checked_sub(1).and_then(|i| keys.get(i)), keys.get(after))
    else {
        return keys[after.min(keys.len() - 1)].1;
    };
    let u = (time - t0) / (t1 - t0);
    std::array::from_fn(|r| std::array::from_fn(|c| a[r][c] + (b[r][c] - a[r][c]) * u))
}

fn affine(rows: &[[f32; 4]; 3]) -> DAffine3 {
    let column = |c: usize| DVec3::new(rows[0][c].into(), rows[1][c].into(), rows[2][c].into());
    DAffine3::from_cols(column(0), column(1), column(2), column(3))
}

impl View {
    /// The ray through a point of the picture, in pixels from the upper left corner, in render space and of unit length.
    /// `lens` is where on the lens it starts, see [`durer_model::camera::Lens::at`].
    pub fn ray(&self, film: Point2, lens: Point2, time: f32) -> Ray {
        self.placed(&self.camera.ray(self.part(film), lens, time))
    }
    /// The same with what its radiance counts in the picture.
    #[inline]
    pub(crate) fn eye(&self, film: Point2, lens: Point2, time: f32) -> (Ray, f32) {
        let EyeRay { ray, weight } = self.camera.eye(self.part(film), lens, time);
        (self.placed(&ray), weight * self.speed)
    }
    /// Where on the lens that ray starts, in metres right of and above its centre.
    pub(crate) fn on_lens(&self, film: Point2, lens: Point2) -> [f32; 2] {
        self.camera.on_lens(self.part(film), lens)
    }
    /// A point of the picture by the picture's size.
    fn part(&self, film: Point2) -> Point2 {
        Point2::new(film.x / self.width as f32, film.y / self.height as f32)
    }
    fn placed(&self, ray: &Ray) -> Ray {
        let ray = self.placement.ray(ray);
        // PERF: a placement without scale keeps the length (bench render).
        if (ray.d.length_squared() - 1.0).abs() <= 4.0 * f32::EPSILON {
            ray
        } else {
            Ray { d: ray.d.normalize(), ..ray }
        }
    }
    /// How the camera sees a point of render space at `time` seconds, through the point `lens` of its lens; `None` if it does
    /// not.
    pub fn sees(&self, p: Point3, lens: Point2, time: f32) -> Option<Sighted> {
        let render_from_camera = self.placement.at(time);
        let seen = self.camera.sees(render_from_camera.inverse().point(p), lens)?;
        let film = Point2::new(seen.film.x * self.width as f32, seen.film.y * self.height as f32);
        let from = render_from_camera.point(seen.from);
        let d = render_from_camera.vector(seen.d).normalize();
        Some(Sighted { from, film, importance: self.importance(d, (p - from).length(), time) })
    }
    /// The density of eye rays over an area that faces unit direction `d`, at a distance from their origin: that of
    /// [`durer_model::camera::Camera::importance`], in render space. A placement `M` makes areas across `d` larger by
    /// `|det M| / |M d|`, for unit `d` of camera space.
    pub fn importance(&self, d: Vector3, distance: f32, time: f32) -> f32 {
        let m = self.placement.at(time);
        let along = m.inverse().vector(d);
        let stretch = 1.0 / along.length();
        let det = m.to_f64().matrix3.determinant().abs() as f32;
        self.camera.importance(along * stretch, distance / stretch) * stretch / det
    }
    /// Whether light can be connected to the camera. Not where each row of the picture has a time of its own: which one
    /// a particle is seen in is known too late.
    pub fn is_connectible(&self) -> bool {
        self.camera.is_connectible() && !self.shutter.is_rolling()
    }
    /// The places around the picture that show the same as `film`, in pixels.
    pub fn repeats(&self, film: Point2) -> impl Iterator<Item = Point2> + use<> {
        let (w, h) = (self.width as f32, self.height as f32);
        let all = self.camera.repeats(Point2::new(film.x / w, film.y / h));
        all.into_iter().map(move |at| Point2::new(at.x * w, at.y * h))
    }
    /// The camera's placement at `time` seconds.
    pub fn render_from_camera(&self, time: f32) -> Transform {
        self.placement.at(time)
    }
    /// Cosine between unit direction `d` and the camera's axis at `time` seconds: depth along the axis per ray length.
    pub fn cos_to_axis(&self, d: Vector3, time: f32) -> f32 {
        self.render_from_camera(time).vector(Vector3::new(0.0, 0.0, 1.0)).normalize().dot(d)
    }
    /// A point of render space in world space.
    pub fn to_world(&self, p: Point3) -> [f64; 3] {
        (p.to_f64() + self.world_from_render).to_array()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer_core::glam::DQuat;

    #[test]
    fn moving_cameras_follow_their_keys_and_are_held_outside() {
        let b = DAffine3::from_rotation_translation(DQuat::from_rotation_y(2.0), DVec3::new(4.0, 0.0, -1.0));
        let motion = Motion::keyed(vec![(1.0, DAffine3::IDENTITY), (2.0, b)]).expect("keys");
        let placed = CameraPlacement::from_motion(&motion).expect("invertible");
        let p = Point3::new(0.3, -0.7, 0.9);
        for i in 0..=60 {
            let time = 0.7 + 1.6 * i as f32 / 60.0;
            let expected = motion.at(time.into()).transform_point3(p.to_f64());
            let ray = Ray { time, ..Ray::new(p, Vector3::new(0.0, 0.6, 0.8)) };
            let (moved, at) = (placed.ray(&ray), placed.at(time));
            assert!((moved.o.to_f64() - expected).length() < 3e-4, "{time}: {moved:?} {expected}");
            assert!((moved.o - at.point(p)).length() < 1e-6 && (moved.d - at.vector(ray.d)).length() < 1e-6);
        }
        assert_eq!(placed.at(0.0), Transform::IDENTITY);
        assert_eq!(placed.at(9.0), Transform::from_f64(&affine(Transform::from_f64(&b).rows())));
    }

    #[test]
    fn still_cameras_stay_and_flat_ones_are_refused() {
        let still = CameraPlacement::from_motion(&Motion::still(DAffine3::IDENTITY));
        assert_eq!(still, Some(CameraPlacement::Still(Transform::IDENTITY)));
        let flat = Motion::still(DAffine3::from_scale(DVec3::new(1.0, 0.0, 1.0)));
        assert_eq!(CameraPlacement::from_motion(&flat), None);
    }
}
