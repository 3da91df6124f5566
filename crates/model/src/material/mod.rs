//! Materials: what a surface is made of.
//!
//! A new material is one file here and one line in [`MATERIALS`].

use std::fmt::Debug;

use durer_core::{math::Vector3, spectrum::Spectrum};
use durer_scene::Entry;

use crate::{ShadeCx, Surface, bsdf::Bsdf, texture::TextureAt};

/// A material.
pub trait Material: Debug + Send + Sync {
    /// Evaluates the textures at `surface` and returns the lobes by value. May tilt `surface.n_s` (normal maps).
    /// `wo` is the unit direction back along the ray.
    fn bsdf(&self, cx: &ShadeCx<'_>, surface: &mut Surface, wo: Vector3) -> Bsdf;
    /// Radiance the surface emits by itself.
    fn emission(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Spectrum {
        let _ = (cx, at);
        Spectrum::BLACK
    }
    /// True if some points of the surface may be holes, see [`Material::is_hole`].
    fn has_holes(&self) -> bool {
        false
    }
    /// True if the surface is cut out at a point: rays pass as if nothing were there.
    fn is_hole(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> bool {
        let _ = (cx, at);
        false
    }
}

/// All kinds of material.
pub const MATERIALS: &[Entry<Box<dyn Material>>] = &[];
