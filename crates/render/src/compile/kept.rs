//! What is kept of a compilation, so that changes of camera, lights and materials do not build the geometry anew.
//!
//! Render space stays where it was: bits of what is compiled again are those of a first compilation as long as the camera
//! is where it was then.
use std::sync::Arc;

use durer_core::{
    glam::DVec3,
    math::{Bounds3, Motion, Point3},
};
use durer_model::{light::Extent, shape::Geometry, texture::Texture};
use durer_scene::{Assets, CameraDesc, Diagnostics, LightDesc, SceneDesc, TextureDesc};

use super::{Before, CompileOptions, GeometryCounts, camera, compiled, geometry, nodes};
use crate::{Scene, media};

/// What shapes are built into, before they are placed.
#[derive(Debug)]
pub(super) struct Ground {
    /// Each shape of the description; `None` where it is a mesh of the description, or could not be built.
    pub(super) built: Vec<Option<Geometry>>,
    pub(super) counts: GeometryCounts,
    /// World bounds of everything finite.
    pub(super) bounds: Bounds3,
    /// Whether a shape does.
    pub(super) moves: bool,
}

impl Ground {
    pub(super) fn new(nodes: &mut nodes::Builder<'_>) -> Self {
        let built = nodes.shapes();
        let desc = nodes.desc;
        let bends = |g: &Geometry| matches!(g, Geometry::Mesh(mesh) if !mesh.is_still());
        let moves = desc.shapes.iter().any(|s| !s.world_from_object.is_still())
            || desc.meshes.iter().any(|mesh| !mesh.is_still())
            || built.iter().flatten().any(bends);
        let bounds = geometry::world_bounds(desc, &built);
        Self { counts: GeometryCounts::of(desc, &built), bounds, moves, built }
    }

    /// A ball around the bounds, in a space that begins at `origin`; of a radius of 1 m if there is nothing finite.
    pub(super) fn extent(&self, origin: DVec3) -> Extent {
        if self.bounds.is_empty() {
            return Extent { center: Point3::from_f64(-origin), radius: 1.0 };
        }
        let center = Point3::from_f64(self.bounds.center().to_f64() - origin);
        Extent { center, radius: 0.5 * self.bounds.diagonal().length() }
    }
}

/// What compiling again needs not do again. It holds for descriptions with the same shapes, meshes, textures and moving
/// things; everything else may differ.
#[derive(Clone, Debug)]
pub struct Kept {
    /// The camera that took the picture: the one that was chosen, or the one that was made up.
    pub camera: CameraDesc,
    /// The lights, those that were made up too.
    pub lights: Vec<LightDesc>,
    /// Whether anything but the camera moves.
    pub moves: bool,
    /// Where render space has its origin, in the world.
    pub(super) origin: DVec3,
    pub(super) ground: Arc<Ground>,
    pub(super) placed: geometry::Placed,
    pub(super) textures: Arc<[Box<dyn Texture>]>,
    /// How these were described.
    pub(super) described: Arc<[TextureDesc]>,
}

impl Kept {
    /// Compiles a scene and keeps what another compilation can use; `None` if `diagnostics` got an error.
    pub fn first(
        desc: &SceneDesc,
        (assets, options): (&dyn Assets, &CompileOptions),
        diagnostics: &mut Diagnostics,
    ) -> Option<(Scene, Self)> {
        let (scene, kept) = compiled(desc, (assets, options), Before::Nothing, diagnostics)?;
        Some((scene, kept?))
    }

    /// Compiles the scene again, with other materials, lights, cameras or at another time. The hierarchy is built anew only
    /// if rays have to ask other objects than before what they are made of, as where a material gets holes. `None` if
    /// `diagnostics` got an error.
    pub fn again(
        &self,
        desc: &SceneDesc,
        (assets, options): (&dyn Assets, &CompileOptions),
        diagnostics: &mut Diagnostics,
    ) -> Option<(Scene, Self)> {
        let (scene, kept) = compiled(desc, (assets, options), Before::Kept(self), diagnostics)?;
        Some((scene, kept?))
    }

    /// Compiles what the scene has become at another moment of an animation. What is where it was and as it was is used again,
    /// as are textures if they are described as before; hits are those of a first compilation, bit for bit, if the
    /// description says where render space has its origin. `None` if `diagnostics` got an error.
    pub fn moved(
        &self,
        desc: &SceneDesc,
        (assets, options): (&dyn Assets, &CompileOptions),
        diagnostics: &mut Diagnostics,
    ) -> Option<(Scene, Self)> {
        let (scene, kept) = compiled(desc, (assets, options), Before::Moment(self), diagnostics)?;
        Some((scene, kept?))
    }

    /// The same scene seen by the camera that `options` choose, in a picture of the size that they ask for. Takes
    /// microseconds. `None` if `diagnostics` got an error.
    pub fn retake(
        &self,
        scene: &Scene,
        desc: &SceneDesc,
        (assets, options): (&dyn Assets, &CompileOptions),
        diagnostics: &mut Diagnostics,
    ) -> Option<Scene> {
        let camera = camera::chosen(desc, options, diagnostics).unwrap_or_else(|| self.camera.clone());
        let names = durer_scene::TextureNames::of(&[]);
        let mut nodes = nodes::Builder { desc, assets, missing: options.missing, names: &names, diagnostics };
        let camera = options.lens.given_to(camera);
        let view = camera::view(&mut nodes, &camera, options, (self.moves, Some(self.origin)))?;
        let mut scene = scene.seen_by(view);
        camera::focus(&mut scene, camera::pixel_scale(desc, options), camera.node.at, diagnostics)?;
        scene.start = media::start(&scene);
        Some(scene)
    }

    /// World bounds of everything finite; empty if there is nothing.
    pub fn bounds(&self) -> Bounds3 {
        self.ground.bounds
    }

    /// First and last moment at which something of the description has a key, in seconds; `None` if nothing moves.
    pub fn times(desc: &SceneDesc) -> Option<(f64, f64)> {
        let motions = (desc.shapes.iter().map(|s| &s.world_from_object))
            .chain(desc.lights.iter().map(|l| &l.world_from_light))
            .chain(desc.cameras.iter().map(|c| &c.world_from_camera));
        let moving = motions.filter(|m| !m.is_still());
        let keys = moving.flat_map(Motion::keys).map(|key| key.0);
        let bent = desc.meshes.iter().filter(|mesh| !mesh.is_still());
        let bent = bent.flat_map(|mesh| {
            std::iter::once(mesh.time).chain(mesh.later.iter().map(|key| key.time)).map(f64::from)
        });
        keys.chain(bent).fold(None, |range, t| match range {
            None => Some((t, t)),
            Some((first, last)) => Some((t.min(first), t.max(last))),
        })
    }
}
