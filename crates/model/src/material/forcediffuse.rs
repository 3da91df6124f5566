//! Everything matte: pbrt-v4's option `forcediffuse`.
//!
//! A surface scatters evenly, on its own side, the share `r = int f cos` of light from all around that it would have scattered
//! towards the eye. As in pbrt-v4 one direction that is drawn stands for the integral: right in the mean over a pixel.
use durer_core::{
    math::{Point2, Vector3},
    spectrum::Spectrum,
};

use super::{Material, number::number};
use crate::{
    ShadeCx, Surface,
    bsdf::{Bsdf, Lobe},
    texture::TextureAt,
};

/// A material that is made matte. No light gets in.
#[derive(Debug)]
pub struct ForceDiffuse(pub Box<dyn Material>);

impl Material for ForceDiffuse {
    fn bsdf(&self, cx: &ShadeCx<'_>, surface: &mut Surface, wo: Vector3) -> Bsdf<'_> {
        let own = self.0.bsdf(cx, surface, wo);
        // What is not there stays so; panes that light passes straight are there.
        let holes = self.has_holes();
        let is_hole = |lobe: &Lobe| holes && matches!(lobe, Lobe::PassThrough { .. });
        let wo_local = surface.frame().to_local(wo);
        let [choice, x, y] = [1, 2, 3].map(|which| number(wo, surface, which));
        let scattered = own.only(|lobe| !is_hole(lobe)).scatter(wo_local, choice, Point2::new(x, y));
        let albedo = scattered.map_or(Spectrum::BLACK, |scattered| scattered.weight);
        let own_holes = own.lobes().filter(|lobe| is_hole(lobe)).copied();
        let matte = (!albedo.is_black()).then_some(Lobe::Diffuse { albedo });
        let bsdf = own_holes.chain(matte).fold(Bsdf::default(), Bsdf::with);
        if own.is_led() { bsdf.led() } else { bsdf }
    }
    fn emission(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Spectrum {
        self.0.emission(cx, at)
    }
    fn is_nothing(&self) -> bool {
        self.0.is_nothing()
    }
    fn has_holes(&self) -> bool {
        self.0.has_holes()
    }
    fn is_passed(&self) -> bool {
        self.has_holes()
    }
    fn is_one_sided(&self) -> bool {
        self.0.is_one_sided()
    }
    fn is_hole(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> bool {
        self.0.is_hole(cx, at)
    }
    fn coverage(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> f32 {
        self.0.coverage(cx, at)
    }
}
