//! What a sample leaves in the film beside the colour of its pixel: layers, and light for other places.
use durer_core::spectrum::Spectrum;

use super::{BadSample, Job, TileDone, pass::Eye};
use crate::{
    Contribution, SampleCx, Splat, Value,
    film::{self, Layers, Pixel, add_met},
    integrator::first_met,
};

/// What a thread adds samples of a tile to.
#[derive(Default)]
pub(super) struct Sums {
    pub(super) pixels: Vec<Pixel>,
    /// Those beside colours, pixel by pixel, if there are some.
    pub(super) layers: Vec<f64>,
}

impl Job<'_> {
    /// The sums of each pixel in turn; nothing of a film that keeps colours alone.
    pub(super) fn pixels_of<'s>(&self, sums: &'s mut [f64]) -> std::slice::ChunksExactMut<'s, f64> {
        sums.chunks_exact_mut(self.scene.view.layers.map_or(1, |layers| layers.sums()))
    }

    /// Adds a sample to the sums of its pixel.
    pub(super) fn keep(
        &self,
        cx: &SampleCx<'_>,
        (eye, out): (&Eye, &Contribution),
        (rgb, weight): ([f32; 3], f32),
        sums: &mut [f64],
    ) {
        match self.scene.view.layers {
            // Where the camera lets no light through it sees nothing.
            Some(Layers::Surfaces(space)) if eye.gain != 0.0 => {
                if let Some(met) = first_met(cx, &eye.ray, space) {
                    add_met(sums, &met, rgb, weight);
                }
            }
            Some(Layers::Buckets(buckets)) => {
                let Some(wavelengths) = cx.basis.wavelengths() else { return };
                let radiance = match out.value {
                    Value::Radiance(radiance) => radiance * eye.gain,
                    Value::Data(_) => Spectrum::BLACK,
                };
                buckets.add(sums, &wavelengths.values(self.held(cx, radiance)), weight);
            }
            _ => {}
        }
    }

    /// Takes what a sample has for other places of the picture; none of it if part of it is infinite or NaN.
    pub(super) fn splat(
        &self,
        cx: &SampleCx<'_>,
        out: &mut Contribution,
        done: &mut TileDone,
        bad: BadSample,
    ) {
        // PERF: what has no splats asks for nothing (bench render).
        if out.splats.is_empty() {
            return;
        }
        if out.splats.iter().all(|splat| splat.radiance.is_finite()) {
            for splat in &out.splats {
                let view = &self.scene.view;
                let rgb = view.sensor.held(cx.basis.to_rgb(splat.radiance).map(|v| v * view.speed));
                let places = std::iter::once(splat.film).chain(view.repeats(splat.film));
                done.splats.extend(places.map(|film| film::Splat { film: film.to_array(), rgb }));
                self.keep_splat(cx, splat, done);
            }
        } else {
            done.bad(bad);
        }
        out.splats.clear();
    }

    /// Adds to layers what a splat brings to all of its places.
    fn keep_splat(&self, cx: &SampleCx<'_>, splat: &Splat, done: &mut TileDone) {
        let (Some(Layers::Buckets(buckets)), Some(wavelengths)) =
            (self.scene.view.layers, cx.basis.wavelengths())
        else {
            return;
        };
        let radiance = self.held(cx, splat.radiance * self.scene.view.speed);
        done.lanes.resize(done.splats.len(), buckets.lanes(&wavelengths.values(radiance)));
    }

    /// What the film holds of light: scaled down where its colour is.
    fn held(&self, cx: &SampleCx<'_>, radiance: Spectrum) -> Spectrum {
        radiance * self.scene.view.sensor.developing(cx.basis.to_rgb(radiance)).clamp
    }
}
