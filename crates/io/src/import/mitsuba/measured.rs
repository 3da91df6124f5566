//! Materials in files of the RGL database, which Mitsuba reads too.
use durer_scene::Params;

use super::{object::Object, world::World};

/// What reflects as a file says.
pub(super) fn reflecting(world: &mut World<'_>, object: &Object) -> Option<(&'static str, Params)> {
    let path = world.path(object, "filename")?;
    Some(("measured", Params::new().string("filename", &path)))
}
