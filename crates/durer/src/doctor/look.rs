//! A first look: what a few eye rays meet.
use durer_core::{
    Id,
    math::{Point2, Point3, Ray},
};
use durer_model::{Surface, camera::Lens};
use durer_scene::SceneDesc;

use super::{Finding, exposure::Trouble};
use crate::{Job, Object, Prepared, Settings, Show, integrator::Cast};

/// Eye rays per row and column.
const LOOKS: [u32; 2] = [24, 16];
/// A scene that spans fewer pixels than this is not seen.
const LEAST_PIXELS: f64 = 2.0;

/// What an eye ray met.
pub(super) struct Sight {
    pub(super) ray: Ray,
    pub(super) surface: Surface,
    pub(super) object: Id<Object>,
    inside: bool,
}

/// What eye rays all over the picture met.
pub(super) struct Look {
    rays: usize,
    pub(super) sights: Vec<Sight>,
}

/// The middles of pixels all over the picture.
pub(super) fn places(prepared: &Prepared, [columns, rows]: [u32; 2]) -> Vec<[u32; 2]> {
    let view = &prepared.scene.view;
    let at = |i: u32, of: u32, edge: u32| (u64::from(2 * i + 1) * u64::from(edge) / u64::from(2 * of)) as u32;
    let place = |x, y| [at(x, columns, view.width), at(y, rows, view.height)];
    (0..rows).flat_map(|y| (0..columns).map(move |x| (x, y))).map(|(x, y)| place(x, y)).collect()
}

impl Look {
    pub(super) fn take(prepared: &Prepared) -> Self {
        let cast = Cast { show: Show::Depth };
        let settings = Settings { samples: 1, ..prepared.settings };
        let job = Job { scene: &prepared.scene, integrator: &cast, settings, passes: Default::default() };
        let places = places(prepared, LOOKS);
        let sight = |&pixel: &[u32; 2]| {
            let (tree, _) = job.record(pixel, 0);
            let node = tree.nodes.first()?;
            let hit = node.hit.as_ref()?;
            let (object, surface) = prepared.scene.surface(&node.path.ray, &hit.hit);
            Some(Sight { ray: node.path.ray, surface, object, inside: !hit.from_outside })
        };
        Self { rays: places.len(), sights: places.iter().filter_map(sight).collect() }
    }

    /// Nothing is seen, or everything from its inside.
    pub(super) fn finding(
        &self,
        desc: &SceneDesc,
        prepared: &Prepared,
        trouble: Option<Trouble>,
    ) -> Option<Finding> {
        if self.sights.is_empty() {
            return Some(self.past_everything(prepared));
        }
        // A camera in water is meant.
        let is_opaque = |object| prepared.scene.material(object).medium().is_none();
        let inside = self.sights.iter().filter(|s| s.inside && is_opaque(s.object));
        let share = 100 * inside.clone().count() / self.sights.len();
        // The automatic camera stands outside of everything: open or turned surfaces are no fault of its.
        if share <= 50 || desc.cameras.is_empty() {
            return None;
        }
        let mut objects: Vec<u32> = inside.map(|s| s.object.index() as u32).collect();
        objects.sort_unstable();
        let most = objects.chunk_by(|a, b| a == b).max_by_key(|same| same.len())?.first()?;
        let name = &prepared.scene.object(Id::new(*most)).name;
        let message = format!(
            "{share} % of what the camera sees is seen from its inside, most of it of \"{name}\": it may stand in an object, \
             or normals are turned"
        );
        // Where something can be seen it may well be meant: a room with open walls.
        let found = if trouble.is_some() { Finding::warning(message) } else { Finding::note(message) };
        Some(found.remedy(format!(
            "move the camera out of \"{name}\", or turn its normals (ReverseOrientation) if it is a room"
        )))
    }

    fn past_everything(&self, prepared: &Prepared) -> Finding {
        let rays = self.rays;
        let message =
            |why: &str| format!("the camera seems to look past everything: {rays} eye rays met nothing{why}");
        let view = &prepared.scene.view;
        let bounds = prepared.scene.accel.bounds();
        let middle = Point2::new(view.width as f32 * 0.5, view.height as f32 * 0.5);
        let time = view.shutter.interval().min;
        let axis = view.ray(middle, Lens::CENTRE, time);
        let corners = (0..8).map(|i| {
            let pick = |bit: u32, a: f32, b: f32| if i >> bit & 1 == 0 { a } else { b };
            let (a, b) = (bounds.min, bounds.max);
            Point3::new(pick(0, a.x, b.x), pick(1, a.y, b.y), pick(2, a.z, b.z))
        });
        let depths: Vec<f32> = corners.map(|p| (p - axis.o).dot(axis.d)).collect();
        let centre = bounds.min + (bounds.max - bounds.min) * 0.5;
        let distance = f64::from((centre - axis.o).length());
        let to = view.to_world(centre).map(super::size::short).join(" ");
        if depths.iter().all(|depth| *depth < 0.0) {
            return Finding::warning(message(": all of the scene lies behind it"))
                .remedy(format!("turn it around; the middle of the scene is at {to}"));
        }
        // How much of the picture the scene spans, by the angle between two neighbouring pixels.
        let beside = view.ray(Point2::new(middle.x + 1.0, middle.y), Lens::CENTRE, time);
        let pixel = f64::from((beside.d - axis.d).length());
        let size = f64::from((bounds.max - bounds.min).length());
        if pixel > 0.0 && size / distance < LEAST_PIXELS * pixel {
            let [size, distance] = [size, distance].map(super::size::short);
            let why = format!(": it is smaller than a pixel, {size} m across and {distance} m away");
            return Finding::warning(message(&why)).remedy(
                "move the camera close, or see whether scene and camera have the same unit of length",
            );
        }
        Finding::warning(message("")).remedy(format!("point the camera at {to}, the middle of the scene"))
    }
}
