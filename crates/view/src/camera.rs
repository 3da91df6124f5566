//! Cameras as the page moves them: where they are, where they look, what is up.
//!
//! Camera space is left-handed, x right, y up, z forwards; whether the world is too shows in the camera's placement, which
//! mirrors or not. What else a placement does to camera space, as a stretch, stays as it was.
use durer::{
    Prepared, SampleCx,
    glam::{DAffine3, DMat3, DVec3},
    math::{Motion, Point2},
    model::camera::Lens,
    probe::NoProbe,
    scene::CameraDesc,
    spectrum::Basis,
};
use serde::Serialize;

/// What a placement does beside turning and moving: `linear = [right, up, forward] * rest`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Frame {
    /// Upper triangular; the unit matrix for almost all cameras.
    rest: DMat3,
    /// Right is up times forward: the world is left-handed.
    is_left_handed: bool,
}

/// Where a camera is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pose {
    pub(crate) eye: DVec3,
    /// Of unit length, as the others.
    pub(crate) forward: DVec3,
    pub(crate) up: DVec3,
    pub(crate) right: DVec3,
}

impl Frame {
    /// That of a camera at `time` seconds.
    pub(crate) fn of(camera: &CameraDesc, time: f32) -> Self {
        let linear = camera.world_from_camera.at(time.into()).matrix3;
        let is_left_handed = linear.determinant() > 0.0;
        let unplaced = Self { rest: DMat3::IDENTITY, is_left_handed };
        let rest = match unplaced.pose(linear.z_axis, linear.z_axis, linear.y_axis) {
            Some(pose) => DMat3::from_cols(pose.right, pose.up, pose.forward).transpose() * linear,
            None => DMat3::IDENTITY,
        };
        let rest = if rest.abs_diff_eq(DMat3::IDENTITY, 1e-9) { DMat3::IDENTITY } else { rest };
        Self { rest, is_left_handed }
    }

    /// A pose; `None` if the directions say nothing: not finite, of no length, or parallel.
    pub(crate) fn pose(&self, eye: DVec3, forward: DVec3, up: DVec3) -> Option<Pose> {
        let forward = forward.try_normalize()?;
        let side = if self.is_left_handed { up.cross(forward) } else { forward.cross(up) };
        let right = side.try_normalize().filter(|_| side.length() > 1e-9 * up.length())?;
        let up = if self.is_left_handed { forward.cross(right) } else { right.cross(forward) };
        let far = eye.abs().max_element();
        (eye.is_finite() && far < 1e12).then_some(Pose { eye, forward, up, right })
    }

    /// The placement of a camera there.
    pub(crate) fn placed(&self, pose: &Pose) -> Motion {
        let turned = DMat3::from_cols(pose.right, pose.up, pose.forward);
        Motion::still(DAffine3::from_mat3_translation(turned * self.rest, pose.eye))
    }

    /// Where a camera is at `time` seconds.
    pub(crate) fn pose_of(&self, camera: &CameraDesc, time: f32) -> Option<Pose> {
        let m = camera.world_from_camera.at(time.into());
        self.pose(m.translation, m.matrix3.z_axis, m.matrix3.y_axis)
    }

    /// The word for it.
    pub(crate) fn handedness(&self) -> &'static str {
        if self.is_left_handed { "left" } else { "right" }
    }
}

/// A camera as the page is told of it.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct CameraTold {
    name: String,
    kind: String,
    eye: [f64; 3],
    forward: [f64; 3],
    up: [f64; 3],
    right: [f64; 3],
    /// Degrees from edge to edge; `None` if rays do not start in a point.
    fov: Option<[f64; 2]>,
    /// Metres to what is seen in the middle.
    distance: f64,
    /// It is one of the scene's, where the scene has it.
    exact: bool,
}

impl CameraTold {
    pub(crate) fn new(
        camera: &CameraDesc,
        frame: &Frame,
        prepared: &Prepared,
        (around, exact): (f64, bool),
    ) -> Self {
        let time = prepared.scene.view.shutter.interval().min;
        let axes = |pose: Option<Pose>| {
            pose.map_or([DVec3::ZERO, DVec3::Z, DVec3::Y, DVec3::X], |p| [p.eye, p.forward, p.up, p.right])
        };
        let [eye, forward, up, right] = axes(frame.pose_of(camera, time)).map(|v| v.to_array());
        Self {
            name: camera.name.clone(),
            kind: camera.node.kind.clone(),
            eye,
            forward,
            up,
            right,
            fov: (camera.node.kind == "perspective").then(|| fov(prepared)),
            distance: distance(prepared).unwrap_or(around),
            exact,
        }
    }
}

/// The angles between rays through the middles of opposite edges, in degrees.
fn fov(prepared: &Prepared) -> [f64; 2] {
    let (view, time) = (&prepared.scene.view, prepared.scene.view.shutter.interval().min);
    let size = [view.width as f32, view.height as f32];
    let ray = |x: f32, y: f32| view.ray(Point2::new(x * size[0], y * size[1]), Lens::CENTRE, time).d;
    let angle = |a: [f32; 2], b: [f32; 2]| {
        let (a, b) = (ray(a[0], a[1]), ray(b[0], b[1]));
        // Half the distance of unit vectors is the sine of half the angle.
        let half = f64::from((a - b).length() * 0.5).min(1.0);
        2.0 * half.asin().to_degrees()
    };
    [angle([0.0, 0.5], [1.0, 0.5]), angle([0.5, 0.0], [0.5, 1.0])]
}

/// How far away that is what is seen in the middle, in metres.
fn distance(prepared: &Prepared) -> Option<f64> {
    let scene = &prepared.scene;
    let view = &scene.view;
    let middle = Point2::new(view.width as f32 * 0.5, view.height as f32 * 0.5);
    let ray = view.ray(middle, Lens::CENTRE, view.shutter.moment(0.5, view.height / 2, view.height));
    let cx = SampleCx { scene, basis: Basis::Rgb };
    scene.closest(&cx, &ray, &mut NoProbe, ()).map(|hit| f64::from(hit.t))
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer::scene::{Node, Params};

    fn camera(m: DAffine3) -> CameraDesc {
        CameraDesc {
            name: String::new(),
            node: Node::new("perspective", Params::new()),
            world_from_camera: Motion::still(m),
            media: None,
        }
    }

    #[test]
    fn a_camera_that_is_told_and_put_back_is_where_it_was() {
        let turned = DAffine3::from_axis_angle(DVec3::new(1.0, 2.0, -0.5).normalize(), 1.1);
        let moved = DAffine3::from_translation(DVec3::new(3.0, -1.0, 7.0)) * turned;
        let mirrored = moved * DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0));
        let stretched = moved * DAffine3::from_scale(DVec3::new(2.0, 1.0, 0.5));
        for (m, hand) in [(moved, "left"), (mirrored, "right"), (stretched, "left")] {
            let camera = camera(m);
            let frame = Frame::of(&camera, 0.0);
            let pose = frame.pose_of(&camera, 0.0).expect("a pose");
            assert!(frame.placed(&pose).at(0.0).abs_diff_eq(m, 1e-12), "{m:?}");
            assert_eq!(frame.handedness(), hand);
            let again = frame.pose(pose.eye, pose.forward * 3.0, pose.up + pose.forward).expect("a pose");
            assert!(again.right.abs_diff_eq(pose.right, 1e-12) && again.up.abs_diff_eq(pose.up, 1e-12));
        }
    }

    #[test]
    fn poses_that_say_nothing_are_none() {
        let frame = Frame::of(&camera(DAffine3::IDENTITY), 0.0);
        let none = [
            (DVec3::ZERO, DVec3::ZERO, DVec3::Y),
            (DVec3::ZERO, DVec3::Z, DVec3::Z),
            (DVec3::ZERO, DVec3::Z, DVec3::ZERO),
            (DVec3::NAN, DVec3::Z, DVec3::Y),
            (DVec3::X * 1e300, DVec3::Z, DVec3::Y),
            (DVec3::ZERO, DVec3::NAN, DVec3::Y),
        ];
        for (eye, forward, up) in none {
            assert_eq!(frame.pose(eye, forward, up), None, "{eye} {forward} {up}");
        }
    }
}
