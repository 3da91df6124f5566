//! A mixture of two materials: rust on iron, dust on glass.
//!
//! What scatters is the weighted sum of both, which pbrt-v4 reaches by choosing one of them at random for each hit. Where
//! the sum has more lobes than fit, that is done here as well, by numbers that follow from the place and the view.
use durer_core::{math::Vector3, spectrum::Spectrum};
use durer_scene::{Args, FloatInput, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{MATERIALS, Material, number::number};
use crate::{
    Medium, ShadeCx, Surface,
    bsdf::{Bsdf, Lobe},
    medium::Inside,
    texture::TextureAt,
};

/// What is asked of a material at a place.
type Asked<'f> = &'f dyn for<'a> Fn(&'a dyn Material, &mut Surface) -> Bsdf<'a>;

/// Two materials in one place.
#[derive(Debug)]
pub struct Mix {
    materials: [Box<dyn Material>; 2],
    /// Share of the second.
    amount: FloatInput,
    /// If set there is the second alone where its share is at least this, and the first alone elsewhere.
    cutoff: Option<f32>,
}

impl Kind for Mix {
    type Output = Box<dyn Material>;
    const SCHEMA: Schema = Schema {
        name: "mix",
        aliases: &[],
        doc: "A mixture of two materials. The normal and bump map of the one with the larger share tilts the surface.",
        params: &[
            ParamSpec::new(
                "materials",
                ParamType::Texts,
                ParamDefault::Required,
                "Names of two materials that are described before this one.",
            ),
            ParamSpec::float_texture("amount", 0.5, "Share of the second material.").range(0.0, 1.0),
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let [first, second] = args.texts("materials") else {
            args.error("materials", "expected the names of two materials");
            return None;
        };
        let mut named = |word: &str| args.build_named("materials", word, MATERIALS);
        let (first, second) = (named(first), named(second));
        let amount = args.float_input("amount");
        Some(Box::new(Self::new([first?, second?], amount, None)))
    }
}

impl Mix {
    /// The share `amount` of the second material, or with a `cutoff` either of them.
    pub(super) fn new(materials: [Box<dyn Material>; 2], amount: FloatInput, cutoff: Option<f32>) -> Self {
        Self { materials, amount, cutoff }
    }
    fn share(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> f32 {
        // Holes are found in points: an average would count those in it twice.
        let at = if self.has_holes() { at.as_point() } else { *at };
        let share = cx.float(self.amount, &at).clamp(0.0, 1.0);
        match self.cutoff {
            Some(cutoff) if share < cutoff => 0.0,
            Some(_) => 1.0,
            None => share,
        }
    }
    /// The lobes of one of them; of a hole, that light goes on.
    fn one(&self, which: usize, cx: &ShadeCx<'_>, surface: &mut Surface, of: Asked<'_>) -> Bsdf<'_> {
        let material = &self.materials[which];
        match material.has_holes() && material.is_hole(cx, &surface.texture_at()) {
            true => Bsdf::default().with(Lobe::PassThrough { weight: Spectrum::ONE }),
            false => of(&**material, surface),
        }
    }
    fn both(&self, cx: &ShadeCx<'_>, surface: &mut Surface, wo: Vector3, of: Asked<'_>) -> Bsdf<'_> {
        let t = self.share(cx, &surface.texture_at());
        if t == 0.0 || t == 1.0 {
            return self.one(usize::from(t == 1.0), cx, surface, of);
        }
        let larger = usize::from(t > 0.5);
        let as_it_was = *surface;
        let main = self.one(larger, cx, surface, of);
        let mut tilted = *surface;
        let other = self.one(1 - larger, cx, &mut tilted, of);
        let of_other = if larger == 1 { 1.0 - t } else { t };
        if let Some(both) = main.mixed(&other, of_other) {
            return both;
        }
        if number(wo, &as_it_was, 0) >= of_other {
            return main;
        }
        *surface = tilted;
        other
    }
    fn any(&self, of: impl Fn(&dyn Material) -> bool) -> bool {
        self.materials.iter().any(|material| of(&**material))
    }
}

impl Material for Mix {
    fn bsdf(&self, cx: &ShadeCx<'_>, surface: &mut Surface, wo: Vector3) -> Bsdf<'_> {
        self.both(cx, surface, wo, &|material, surface| material.bsdf(cx, surface, wo))
    }
    fn open_bsdf(&self, cx: &ShadeCx<'_>, surface: &mut Surface, wo: Vector3) -> Bsdf<'_> {
        self.both(cx, surface, wo, &|material, surface| material.open_bsdf(cx, surface, wo))
    }
    fn is_walked(&self) -> bool {
        self.any(|material| material.is_walked())
    }
    fn inside(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Option<Inside> {
        self.materials.iter().find_map(|material| material.inside(cx, at))
    }
    fn emission(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> Spectrum {
        let t = self.share(cx, at);
        let [first, second] = self.materials.each_ref().map(|material| material.emission(cx, at));
        first * (1.0 - t) + second * t
    }
    fn medium(&self) -> Option<Medium> {
        self.materials.iter().find_map(|material| material.medium())
    }
    fn has_holes(&self) -> bool {
        self.any(|material| material.has_holes())
    }
    fn coverage(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> f32 {
        let t = self.share(cx, at);
        let [first, second] = self.materials.each_ref().map(|material| material.coverage(cx, at));
        first * (1.0 - t) + second * t
    }
    fn is_hole(&self, cx: &ShadeCx<'_>, at: &TextureAt) -> bool {
        let t = self.share(cx, at);
        let shares = [1.0 - t, t];
        self.materials
            .iter()
            .zip(shares)
            .all(|(material, share)| share == 0.0 || (material.has_holes() && material.is_hole(cx, at)))
    }
    fn is_passed(&self) -> bool {
        self.any(|material| material.is_passed() || material.has_holes())
    }
    fn is_one_sided(&self) -> bool {
        self.materials.iter().all(|material| material.is_one_sided())
    }
}
