//! Cameras: perspective and orthographic ones without lens.
use durer_core::glam::{DAffine3, DVec3};
use durer_model::camera::CAMERAS;
use durer_scene::{Args, CameraDesc, Diagnostics, find};
use serde_json::{Value, json};

use super::Writer;

impl Writer<'_> {
    /// The chosen camera first.
    pub(super) fn cameras(&mut self) {
        let chosen = self.whole.camera;
        let others = (0..self.desc.cameras.len()).filter(|&index| index != chosen);
        for index in std::iter::once(chosen).chain(others) {
            let Some(camera) = self.desc.cameras.get(index) else { continue };
            let name = if camera.name.is_empty() { "camera" } else { &camera.name };
            let Some(written) = self.camera(camera, name) else { continue };
            self.cameras.push(written);
            // glTF's cameras look along -z.
            let place = self.placed(&camera.world_from_camera, name)
                * DAffine3::from_scale(DVec3::new(1.0, 1.0, -1.0));
            let number = self.cameras.len() - 1;
            self.node(&camera.name, &place, json!({ "camera": number }));
        }
    }

    fn camera(&mut self, camera: &CameraDesc, name: &str) -> Option<Value> {
        let film = self.whole.film();
        let aspect = f64::from(film.width) / f64::from(film.height.max(1));
        let mut said = Diagnostics::default();
        let entry = find(CAMERAS, "camera", &camera.node, &mut said)?;
        let args = Args::check(&camera.node, entry.schema, &self.desc.textures, &mut said);
        if ["lensradius", "fnumber"].iter().any(|p| args.is_set(p) && args.float(p) != 0.0) {
            self.warn(format!("camera \"{name}\": its lens is not in the file, everything is in focus"));
        }
        let near = 1e-3;
        match entry.schema.name {
            "perspective" => {
                if args.is_set("screenwindow") || args.is_set("frameaspectratio") {
                    self.warn(format!("camera \"{name}\": its window on the picture is not in the file"));
                }
                let half = 0.5 * f64::from(args.float("fov")).to_radians();
                let spans_x = match args.text("fovaxis") {
                    "x" => true,
                    "y" => false,
                    _ => aspect < 1.0,
                };
                let yfov = if spans_x { 2.0 * (half.tan() / aspect).atan() } else { 2.0 * half };
                Some(json!({
                    "type": "perspective", "name": name,
                    "perspective": { "yfov": yfov, "aspectRatio": aspect, "znear": near },
                }))
            }
            "orthographic" => {
                let window: [f64; 4] = match args.floats("screenwindow") {
                    [a, b, c, d] => [*a, *b, *c, *d].map(f64::from),
                    _ if aspect >= 1.0 => [-aspect, aspect, -1.0, 1.0],
                    _ => [-1.0, 1.0, -1.0 / aspect, 1.0 / aspect],
                };
                let [left, right, low, high] = window;
                if left + right != 0.0 || low + high != 0.0 {
                    self.warn(format!("camera \"{name}\": its window is not around its axis; the file's is"));
                }
                let (xmag, ymag) = (0.5 * (right - left), 0.5 * (high - low));
                Some(json!({
                    "type": "orthographic", "name": name,
                    "orthographic": { "xmag": xmag, "ymag": ymag, "znear": 0.0, "zfar": 1e6 },
                }))
            }
            other => {
                self.warn(format!("camera \"{name}\" of kind \"{other}\" is left out: glTF has none such"));
                None
            }
        }
    }
}
