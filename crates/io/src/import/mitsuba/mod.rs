//! Mitsuba's scenes: XML of version 3, and of 0.x, whose names are changed as Mitsuba 3 changes them.
//!
//! [`reader`] turns text into objects ([`object`], [`prop`], [`value`], [`transform`], [`upgrade`]); a file per family turns objects into
//! a description ([`world`] is what they share): [`sensor`], [`integrator`], [`shape`], [`bsdf`], [`texture`], [`emitter`],
//! [`medium`]. Each plugin says which parameters it takes. Space is right-handed, cameras look along +z with x to the left; v
//! of textures grows downwards. docs/mitsuba.md says what differs.

mod bsdf;
mod curve;
mod emitter;
mod hair;
mod index;
mod integrator;
mod layered;
mod measured;
mod medium;
mod mesh;
mod metal;
mod object;
mod phase;
mod principled;
mod prop;
mod reader;
mod sensor;
mod serialized;
mod shape;
mod texture;
mod tilted;
mod transform;
mod upgrade;
mod value;
mod volume;
mod world;

use std::path::Path;

use durer_core::glam::DAffine3;
use durer_scene::Location;

use self::{
    object::{Child, What},
    reader::Reader,
    world::World,
};
use super::{Imported, Reading};
use crate::assets::read_file;

/// Reads the file at `path`.
pub(super) fn read(path: &Path, reading: &Reading, imported: &mut Imported) {
    let name = path.display().to_string();
    let Imported { desc, assets, sources, diagnostics, .. } = imported;
    let bytes = match read_file(path, &name, assets.limits()) {
        Ok(bytes) => bytes,
        Err(error) => {
            diagnostics.error(Location::None, error.to_string());
            return;
        }
    };
    let mut reader = Reader::new(assets, sources, diagnostics, &reading.definitions);
    reader.file(&name, &bytes, Location::None);
    let Reader { top, ids, folders, unused, .. } = reader;
    let mut unused: Vec<String> = unused.into_iter().collect();
    unused.sort();
    for name in unused {
        let message = format!("\"{name}\" is given a value, but no <default> of the scene has that name");
        diagnostics.error(Location::None, message);
    }
    let mut world = World::new(desc, assets, diagnostics, (folders, ids));
    top.iter().for_each(|child| add(&mut world, child));
    if world.desc.integrator.is_none() {
        world.desc.integrator = Some(integrator::usual());
    }
}

/// Something that stands in the scene itself.
fn add(world: &mut World<'_>, child: &Child) {
    let What::Object(object) = &child.what else {
        world.said.error(child.at, "a reference stands for itself: it belongs in an object");
        return;
    };
    match object.tag.as_str() {
        "shape" => shape::add(world, object, DAffine3::IDENTITY),
        "emitter" => emitter::add(world, object),
        "sensor" => sensor::add(world, object),
        "integrator" => {
            let made = integrator::integrator(world, object);
            if world.desc.integrator.is_some() {
                world.said.error(object.at, "a second integrator: the scene has one already");
            }
            world.desc.integrator = made;
        }
        // What stands here for others to refer to is made even if none does, so that its faults are told.
        "bsdf" => drop(bsdf::material(world, object)),
        "medium" => drop(medium::medium(world, object)),
        "texture" | "spectrum" | "volume" | "phase" => {}
        tag => {
            world
                .said
                .error(object.at, format!("a {tag} belongs in a sensor or film, not in the scene itself"));
        }
    }
}
