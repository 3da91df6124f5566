//! Cameras: where they stand, where they look, and which one a render uses.
use durer::{
    Prepared,
    glam::DVec3,
    math::Vector3,
    scene::{CameraDesc, Data, Node, SceneDesc},
};
use serde::Serialize;

/// A camera of the file.
#[derive(Serialize)]
pub(super) struct CameraFacts<'a> {
    pub(super) name: &'a str,
    pub(super) kind: &'a str,
    /// In world space.
    pub(super) position: [f64; 3],
    /// Of unit length, in world space.
    pub(super) direction: [f64; 3],
    /// Full angle in degrees; `None` where the kind has none.
    pub(super) fov: Option<f32>,
    /// The side of the picture that `fov` measures: `x`, `y` or `shorter`.
    pub(super) fov_axis: Option<&'a str>,
    /// It is the one that takes the picture.
    pub(super) used: bool,
}

/// The cameras of a description at a moment in seconds; `wanted` is the name or index that the user asks for.
pub(super) fn of<'a>(desc: &'a SceneDesc, wanted: Option<&str>, time: f32) -> Vec<CameraFacts<'a>> {
    let named = |wanted: &str| desc.cameras.iter().position(|c| c.name == wanted);
    let used = wanted.map_or(Some(0), |wanted| named(wanted).or_else(|| wanted.parse().ok()));
    let cameras = desc.cameras.iter().enumerate();
    cameras.map(|(index, camera)| facts(camera, f64::from(time), used == Some(index))).collect()
}

fn facts(camera: &CameraDesc, time: f64, used: bool) -> CameraFacts<'_> {
    let placed = camera.world_from_camera.at(time);
    let node = &camera.node;
    let angular = node.kind == "perspective";
    CameraFacts {
        name: &camera.name,
        kind: &node.kind,
        position: placed.translation.to_array(),
        direction: placed.matrix3.z_axis.normalize_or_zero().to_array(),
        // 90 and the shorter side are the defaults of the kind.
        fov: angular.then(|| number(node, "fov").unwrap_or(90.0)),
        fov_axis: angular.then(|| word(node, "fovaxis").unwrap_or("shorter")),
        used,
    }
}

/// Where the camera of a compiled scene stands and looks, in world space.
pub(super) fn view(prepared: &Prepared) -> ([f64; 3], [f64; 3]) {
    let view = &prepared.scene.view;
    let ahead: DVec3 = view
        .render_from_camera(view.shutter.interval().min)
        .vector(Vector3::new(0.0, 0.0, 1.0))
        .normalize()
        .to_f64();
    (view.world_from_render.to_array(), ahead.to_array())
}

fn number(node: &Node, param: &str) -> Option<f32> {
    match &node.params.get(param)?.data {
        Data::Floats(values) => values.first().copied(),
        Data::Ints(values) => values.first().map(|v| *v as f32),
        _ => None,
    }
}

fn word<'a>(node: &'a Node, param: &str) -> Option<&'a str> {
    match &node.params.get(param)?.data {
        Data::Strings(words) => words.first().map(String::as_str),
        _ => None,
    }
}
