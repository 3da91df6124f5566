//! What a file lacks: a camera that frames everything, a neutral studio light.
use durer_core::{
    glam::{DAffine3, DMat3, DVec3},
    math::{Bounds3, Motion},
};
use durer_scene::{CameraDesc, Diagnostics, LightDesc, Location, Node, Params, SceneDesc};

use super::CompileOptions;

/// Vertical field of view of the automatic camera, in degrees.
const FOV: f32 = 35.0;

/// A camera that sees all of `bounds`, from the right, somewhat above.
pub(super) fn camera(bounds: Bounds3, options: &CompileOptions, diagnostics: &mut Diagnostics) -> CameraDesc {
    diagnostics.note(Location::None, "the scene has no camera: one that frames everything was added");
    let (center, radius) = if bounds.is_empty() {
        (DVec3::new(0.0, 0.5, 0.0), 1.5)
    } else {
        let radius = f64::from(bounds.diagonal().length()) * 0.5;
        (bounds.center().to_f64(), if radius > 0.0 { radius } else { 1.0 })
    };
    let aspect = f64::from(options.width) / f64::from(options.height);
    let half = (f64::from(FOV) * 0.5).to_radians();
    let narrow = if aspect < 1.0 { (half.tan() * aspect).atan() } else { half };
    let towards_eye = DVec3::new(0.45, 0.35, 1.0).normalize();
    let eye = center + towards_eye * (radius / narrow.sin());
    CameraDesc {
        name: "automatic".to_owned(),
        node: Node::new("perspective", Params::new().float("fov", FOV).string("fovaxis", "y")),
        world_from_camera: Motion::still(look_at(eye, center)),
    }
}

/// Camera to world for a right-handed world with y up: x to the right, y up, z forwards.
fn look_at(eye: DVec3, at: DVec3) -> DAffine3 {
    let forward = (at - eye).normalize();
    let right = forward.cross(DVec3::Y).normalize();
    let up = right.cross(forward);
    DAffine3::from_mat3_translation(DMat3::from_cols(right, up, forward), eye)
}

/// The lights of the description; if it has none, a soft sky and a key light over the camera's left shoulder.
pub(super) fn lights(
    desc: &SceneDesc,
    world_from_camera: &DAffine3,
    diagnostics: &mut Diagnostics,
) -> Vec<LightDesc> {
    if !desc.lights.is_empty() {
        return desc.lights.clone();
    }
    diagnostics.note(Location::None, "the scene has no light: a neutral studio light was added");
    let sky = Params::new()
        .rgb("zenith", [0.75, 0.78, 0.82])
        .rgb("horizon", [0.95, 0.95, 0.95])
        .rgb("ground", [0.30, 0.29, 0.28]);
    let m = world_from_camera.matrix3;
    let from = (m * DVec3::new(-0.6, 1.0, -0.8)).normalize().as_vec3().to_array();
    let point = |p: [f32; 3]| durer_scene::Data::Floats(p.to_vec());
    let key = Params::new()
        .rgb("L", [1.9, 1.85, 1.75])
        .with("from", durer_scene::ValueType::Point3, point(from))
        .with("to", durer_scene::ValueType::Point3, point([0.0; 3]));
    let light = |name: &str, node| LightDesc {
        name: name.to_owned(),
        node,
        world_from_light: Motion::still(DAffine3::IDENTITY),
    };
    vec![light("studio sky", Node::new("gradientsky", sky)), light("studio key", Node::new("distant", key))]
}
