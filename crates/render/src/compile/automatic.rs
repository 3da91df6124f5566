//! What a file lacks: a camera that frames everything, a neutral studio light.
use durer_core::{
    glam::{DAffine3, DMat3, DVec3},
    math::{Bounds3, Motion, Point3, Vector3},
};
use durer_model::Volume;
use durer_scene::{CameraDesc, Diagnostics, LightDesc, Location, Node, Params, SceneDesc};

use super::CompileOptions;

/// Vertical field of view of the automatic camera, in degrees.
const FOV: f32 = 35.0;

/// How much wider than the scene the automatic picture is.
const MARGIN: f64 = 1.06;

/// A camera that sees all of `bounds`, from the right, somewhat above.
pub(super) fn camera(bounds: Bounds3, options: &CompileOptions, diagnostics: &mut Diagnostics) -> CameraDesc {
    diagnostics.note(Location::None, "the scene has no camera: one that frames everything was added");
    let bounds = if bounds.is_empty() || bounds.diagonal().max_component() == 0.0 {
        let center = if bounds.is_empty() { Point3::new(0.0, 0.5, 0.0) } else { bounds.center() };
        Bounds3::new(center - Vector3::splat(1.0), center + Vector3::splat(1.0))
    } else {
        bounds
    };
    let center = bounds.center().to_f64();
    let towards_eye = DVec3::new(0.45, 0.35, 1.0).normalize();
    let placed = look_at(center + towards_eye, center);
    let aspect = f64::from(options.width) / f64::from(options.height);
    let tan = (f64::from(FOV) * 0.5).to_radians().tan();
    // A corner at (x, y, z), seen from the centre, is inside the picture once the eye is this far back.
    let distance = bounds.corners().into_iter().fold(0.0f64, |farthest, corner| {
        let p = placed.matrix3.transpose() * (corner.to_f64() - center);
        let needed = (p.x.abs() / (tan * aspect)).max(p.y.abs() / tan) * MARGIN - p.z;
        farthest.max(needed)
    });
    CameraDesc {
        name: "automatic".to_owned(),
        node: Node::new("perspective", Params::new().float("fov", FOV).string("fovaxis", "y")),
        world_from_camera: Motion::still(look_at(center + towards_eye * distance, center)),
        media: None,
    }
}

/// Camera to world for a right-handed world with y up: x to the right, y up, z forwards.
fn look_at(eye: DVec3, at: DVec3) -> DAffine3 {
    let forward = (at - eye).normalize();
    let right = forward.cross(DVec3::Y).normalize();
    let up = right.cross(forward);
    DAffine3::from_mat3_translation(DMat3::from_cols(right, up, forward), eye)
}

/// The lights of the description; if it has none and none of its `volumes` glows, a soft sky and a key light over the camera's
/// left shoulder.
pub(super) fn lights(
    desc: &SceneDesc,
    volumes: &[Volume],
    world_from_camera: &DAffine3,
    diagnostics: &mut Diagnostics,
) -> Vec<LightDesc> {
    let glows = volumes.iter().any(|volume| !volume.is_dark());
    if glows || desc.shapes.iter().any(|shape| shape.area_light.is_some()) || !desc.lights.is_empty() {
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
    let made = |name: &str, node| LightDesc {
        name: name.to_owned(),
        node,
        world_from_light: Motion::still(DAffine3::IDENTITY),
    };
    let mut lights = desc.lights.clone();
    lights.push(made("studio sky", Node::new("gradientsky", sky)));
    lights.push(made("studio key", Node::new("distant", key)));
    lights
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_corner_is_in_the_picture_and_one_is_near_its_edge() {
        let boxes = [
            Bounds3::new(Point3::splat(-1.0), Point3::splat(1.0)),
            Bounds3::new(Point3::new(100.0, 2.0, -7.0), Point3::new(101.0, 90.0, -6.9)),
            Bounds3::new(Point3::ZERO, Point3::new(30.0, 0.0, 1e-3)),
        ];
        for bounds in boxes {
            for (width, height) in [(1280, 720), (300, 900)] {
                let desc = camera(bounds, &CompileOptions::new(width, height), &mut Diagnostics::default());
                let camera_from_world = desc.world_from_camera.at(0.0).inverse();
                let tan = f64::from(FOV * 0.5).to_radians().tan();
                let (mut widest, mut behind) = (0.0f64, false);
                for corner in bounds.corners() {
                    let p = camera_from_world.transform_point3(corner.to_f64());
                    behind |= p.z <= 0.0;
                    let aspect = f64::from(width) / f64::from(height);
                    widest = widest.max((p.x / p.z / (tan * aspect)).abs()).max((p.y / p.z / tan).abs());
                }
                assert!(!behind && widest < 1.0 && widest > 0.9, "{bounds:?} {width}: {widest}");
            }
        }
    }
}
