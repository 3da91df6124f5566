//! What a film keeps beside colours, if the scene asks for it and somebody wants it.
use durer_core::spectrum::Carried;
use durer_render::{
    film::{Buckets, Layers},
    integrator::{Integrator, Output},
};
use durer_scene::{Diagnostics, LayersDesc, Location, SceneDesc};

use crate::Options;

/// Most bytes of their sums: as many as those of the colours of the largest picture.
const MOST_BYTES: u64 = 1 << 32;

/// What a picture of this size keeps of what the scene asks for; `None` if it does not fit in memory.
pub(crate) fn kept(
    desc: &SceneDesc,
    options: &Options,
    (integrator, carried, (width, height)): (&dyn Integrator, Carried, (u32, u32)),
    diagnostics: &mut Diagnostics,
) -> Option<Option<Layers>> {
    let Some(asked) = desc.film.layers.filter(|_| options.layers) else { return Some(None) };
    let layers = match asked {
        LayersDesc::Surfaces(space) => Layers::Surfaces(space),
        LayersDesc::Buckets { count, range } => Layers::Buckets(Buckets { count, range }),
    };
    if integrator.facts().output != Output::Radiance {
        let message = "the picture shows no light: what the film keeps beside colours is left out";
        diagnostics.warning(Location::None, message);
        return Some(None);
    }
    if matches!(layers, Layers::Buckets(_)) && carried == Carried::Rgb {
        let message = "rays carry red, green and blue: the film \"spectral\" has no buckets of wavelengths";
        diagnostics.warning(Location::None, message);
        return Some(None);
    }
    let bytes = (u64::from(width) * u64::from(height)).saturating_mul(layers.bytes());
    if bytes > MOST_BYTES {
        let gib = |bytes: u64| bytes.div_ceil(1 << 30);
        let message = format!(
            "what the film keeps beside colours takes {} GiB for {width} x {height} pixels: {} bytes for each",
            gib(bytes),
            layers.bytes()
        );
        let hint = match layers {
            Layers::Surfaces(_) => "make the picture smaller",
            Layers::Buckets(_) => "make the picture or \"nbuckets\" smaller",
        };
        diagnostics
            .error(Location::None, message)
            .hint(format!("at most {} GiB are taken: {hint}", gib(MOST_BYTES)));
        return None;
    }
    Some(Some(layers))
}
