//! No surface at all: pbrt's boundary between two media.
use durer_core::math::Vector3;
use durer_scene::{Args, Kind, Schema};

use super::{Arriving, Material, Sent};
use crate::{Medium, ShadeCx, Surface, bsdf::Bsdf, texture::TextureAt};

/// A surface that is a hole everywhere.
#[derive(Debug)]
pub struct Interface;

impl Kind for Interface {
    type Output = Box<dyn Material>;
    const SCHEMA: Schema = Schema {
        name: "interface",
        aliases: &["none"],
        doc: "No surface: rays pass as if nothing were there, but media may begin and end here.",
        params: &[Medium::INSIDE],
    };
    fn build(_args: &mut Args<'_>) -> Option<Self::Output> {
        Some(Box::new(Self))
    }
}

impl Material for Interface {
    fn bsdf(&self, _cx: &ShadeCx<'_>, _surface: &mut Surface, _wo: Vector3) -> Bsdf<'_> {
        Bsdf::default()
    }
    fn is_nothing(&self) -> bool {
        true
    }
    fn has_holes(&self) -> bool {
        true
    }
    fn is_hole(&self, _cx: &ShadeCx<'_>, _at: &TextureAt) -> bool {
        true
    }
    /// Everything passes.
    fn sent(&self, _: &ShadeCx<'_>, _: &Arriving) -> Sent {
        Sent { followed: 1.0, ..Sent::default() }
    }
}
