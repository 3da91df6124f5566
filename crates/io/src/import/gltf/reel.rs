//! A file that was read and checked, and what it shows at a moment. What does not change from one moment to the next is
//! made once: still meshes, materials and textures, unless the animation changes numbers of theirs.
use std::collections::HashMap;

use durer_core::{
    glam::DVec3,
    math::{Bounds3, Interval, Point3},
};
use durer_scene::{SceneDesc, ShapeSource};
use serde_json::Value;

use super::{
    animation::Animation,
    buffer::Buffers,
    document::Document,
    element::{Checked, Element},
    luminaire,
    material::Looks,
    mesh::Known,
    node::Hierarchy,
    place::Walk,
    roots,
    stance::{Stance, Story},
    surround,
    texture::Textures,
};
use crate::import::{Imported, Moment};

/// Moments of an animation at which a camera that is made up looks where everything is.
const LOOKS: usize = 9;

/// A file that can be read at one moment after another.
#[derive(Debug)]
pub struct Reel {
    file: String,
    value: Value,
    buffers: Buffers,
    pub(super) animation: Option<Animation>,
    looks: Option<Looks>,
    meshes: Known,
    /// Names under which images that the file embeds are known.
    images: HashMap<usize, String>,
    origin: Option<DVec3>,
    extent: Option<Bounds3>,
}

impl Reel {
    /// Nothing of the file is made yet.
    pub(super) fn new(file: &str, value: Value, buffers: Buffers, animation: Option<Animation>) -> Self {
        Self {
            file: file.to_owned(),
            value,
            buffers,
            animation,
            looks: None,
            meshes: Known::new(),
            images: HashMap::new(),
            origin: None,
            extent: None,
        }
    }

    /// From the first to the last key of what is played, in seconds.
    pub fn span(&self) -> Interval {
        self.animation.as_ref().map_or(Interval::point(0.0), |animation| animation.span)
    }

    /// Shows the file for the first time.
    pub(super) fn open(&mut self, moment: Moment, imported: &mut Imported) {
        self.show(moment, imported);
        if self.animation.is_some() && !imported.diagnostics.has_errors() {
            self.look_around(imported);
            (imported.desc.origin, imported.desc.extent) = (self.origin, self.extent);
        }
    }

    /// Leaves the scene at another moment in `imported`. Meshes that are as they were stay the same.
    pub(in crate::import) fn show(&mut self, moment: Moment, imported: &mut Imported) {
        let mut desc = SceneDesc {
            name: imported.desc.name.clone(),
            animations: std::mem::take(&mut imported.desc.animations),
            variants: std::mem::take(&mut imported.desc.variants),
            origin: self.origin,
            extent: self.extent,
            ..SceneDesc::default()
        };
        let Self { file, value, buffers, animation, looks, meshes, images, .. } = self;
        let mut edited = None;
        if let Some(animation) = animation.as_ref().filter(|animation| animation.edits()) {
            let mut copy = value.clone();
            animation.edit(&mut copy, moment.time);
            edited = Some(copy);
        }
        let document = Document::new(Element::root(edited.as_ref().unwrap_or(value)), file);
        let mut shot = || {
            let nodes = Hierarchy::read(&document)?;
            document.set_budget(buffers.total());
            let stances = match animation {
                Some(animation) => animation.stances(&document, &nodes, moment.shutter)?,
                None => vec![Stance::at_rest(&document, &nodes)?],
            };
            if edited.is_some() || looks.is_none() {
                let mut textures = Textures::new((&document, buffers), &mut imported.assets, images);
                *looks = Some(Looks::read(&document, &mut textures)?);
                desc.textures = textures.list;
                let looks = looks.get_or_insert_default();
                looks.luminaires = luminaire::names((&document, buffers), &mut imported.assets)?;
                looks.surround = surround::light((&document, buffers), &mut imported.assets)?;
            } else {
                desc.textures = std::mem::take(&mut imported.desc.textures);
            }
            let roots = roots(&document, &nodes)?;
            let looks = looks.get_or_insert_default();
            let moved = animation.as_ref().map_or(Vec::new(), |a| nodes.below(a.moved()));
            let story = Story { stances: &stances, animation: animation.as_ref(), moved: &moved };
            Walk::new((&document, buffers), (&nodes, story), looks).run(&roots, meshes, &mut desc)?;
            desc.materials = looks.list.clone();
            desc.lights.extend(looks.surround.clone());
            buffers.warn_of_unused(&document)
        };
        if let Err(fault) = shot() {
            document.error(fault);
        }
        imported.diagnostics.append(document.into_complaints());
        imported.desc = desc;
    }

    /// Learns what must be the same at all moments: where the first camera is when the animation begins, or, without a
    /// camera, where everything is while it is played.
    fn look_around(&mut self, imported: &Imported) {
        let Some(looks) = &self.looks else { return };
        let span = self.span();
        let document = Document::new(Element::root(&self.value), &self.file);
        let mut look = |time: f32| -> Checked<SceneDesc> {
            let nodes = Hierarchy::read(&document)?;
            document.set_budget(self.buffers.total());
            let stances = match &self.animation {
                Some(animation) => animation.stances(&document, &nodes, Interval::point(time))?,
                None => Vec::new(),
            };
            let mut desc = SceneDesc::default();
            let story = Story { stances: &stances, animation: None, moved: &[] };
            let walk = Walk::new((&document, &self.buffers), (&nodes, story), looks);
            walk.run(&roots(&document, &nodes)?, &mut self.meshes, &mut desc)?;
            Ok(desc)
        };
        if !imported.desc.cameras.is_empty() {
            let first = look(span.min).ok();
            let camera = first.and_then(|desc| Some(desc.cameras.first()?.world_from_camera.at(0.0)));
            self.origin = camera.map(|camera| camera.translation);
            return;
        }
        let times = (0..LOOKS).map(|i| span.at(i as f32 / (LOOKS - 1) as f32));
        let bounds = times.filter_map(|time| look(time).ok()).map(|desc| bounds(&desc));
        self.extent = Some(bounds.fold(Bounds3::EMPTY, Bounds3::union));
    }
}

/// The box around all meshes of a still scene.
fn bounds(desc: &SceneDesc) -> Bounds3 {
    let of = |shape: &durer_scene::ShapeDesc| {
        let ShapeSource::Mesh(id) = &shape.source else { return Bounds3::EMPTY };
        let Some(mesh) = desc.meshes.get(id.index()) else { return Bounds3::EMPTY };
        let m = shape.world_from_object.at(0.0);
        Bounds3::around(mesh.positions.iter().map(|p| Point3::from_f64(m.transform_point3(p.to_f64()))))
    };
    desc.shapes.iter().map(of).fold(Bounds3::EMPTY, Bounds3::union)
}
