//! Which samples when, and the eye ray of each.
use durer_core::{
    math::Point2,
    sampling::{Dim, Sampler},
};
use durer_model::camera::Lens;

use super::{Jitter, Nesting};
use crate::{PathRay, View, film::BLOCK};

/// The passes of a render: a first look after one sample, then four times as many each, then block by block. No pass
/// crosses the end of a block, and none has more than `at_once`.
pub(super) fn passes(samples: u32, at_once: u32) -> Vec<(u32, u32)> {
    let mut passes = Vec::new();
    let mut first = 0;
    while first < samples {
        let last = match first {
            0 => 1,
            _ if first < BLOCK => (first * 4).min(BLOCK),
            _ => first + BLOCK,
        };
        let last = last.min(first + at_once);
        passes.push((first, last.min(samples)));
        first = last;
    }
    passes
}

/// The beginning of a sample.
#[derive(Clone, Copy, Debug)]
pub(super) struct Eye {
    pub(super) ray: PathRay,
    /// What the camera makes of the radiance that arrives along the ray; 0 where nothing gets through.
    pub(super) gain: f32,
}

/// The eye ray of a sample of `pixel`, and its weight: spread by the filter, at a moment of the exposure, through a point
/// of the lens.
/// All samples of a pass have the moment of `of_pass`, if it is given.
#[inline]
pub(super) fn eye_ray(
    (view, nesting): (&View, Nesting),
    pixel: [u32; 2],
    sampler: &Sampler,
    of_pass: Option<&Sampler>,
) -> (Eye, f32) {
    let (film, weight) = place(view, nesting, pixel, sampler);
    let u = moment(view, nesting, of_pass.unwrap_or(sampler));
    (eye_through((view, nesting), (film, pixel[1]), sampler, u), weight)
}

/// Where in the picture a sample of `pixel` lies, in pixels, and its weight.
pub(super) fn place(view: &View, nesting: Nesting, pixel: [u32; 2], sampler: &Sampler) -> (Point2, f32) {
    let place = view.filter.sample(in_pixel(nesting, sampler));
    let film = [0, 1].map(|i| pixel[i] as f32 + 0.5 + place.offset[i]);
    (Point2::new(film[0], film[1]), place.weight)
}

/// The numbers that spread samples over a pixel.
pub(super) fn in_pixel(nesting: Nesting, sampler: &Sampler) -> Point2 {
    match nesting.place {
        Jitter::Drawn => sampler.shared_by(nesting.per_place()).d2(Dim::Pixel),
        Jitter::Middle => Point2::new(0.5, 0.5),
    }
}

/// The number that chooses the moment; `None` if there is no choice.
pub(super) fn moment(view: &View, nesting: Nesting, sampler: &Sampler) -> Option<f32> {
    let chooses = nesting.time > 0 && !view.shutter.is_instant();
    chooses.then(|| sampler.shared_by(nesting.lens).d1(Dim::Time))
}

/// The numbers that choose the point of the lens; `None` if there is no choice.
pub(super) fn on_lens(view: &View, nesting: Nesting, sampler: &Sampler) -> Option<Point2> {
    let chooses = nesting.lens > 0 && view.camera.lens().is_open();
    chooses.then(|| sampler.d2(Dim::Lens))
}

/// The eye ray through a point of the picture, in pixels, when the row it lies in is exposed.
pub(super) fn eye_at(view: &View, nesting: Nesting, film: Point2, sampler: &Sampler) -> Eye {
    let row = (film.y as u32).min(view.height.saturating_sub(1));
    eye_through((view, nesting), (film, row), sampler, moment(view, nesting, sampler))
}

/// The eye ray through a point of the picture, in pixels, when this row is exposed.
#[inline]
fn eye_through(
    (view, nesting): (&View, Nesting),
    (film, row): (Point2, u32),
    sampler: &Sampler,
    moment: Option<f32>,
) -> Eye {
    let u = moment.unwrap_or(0.5);
    let lens = on_lens(view, nesting, sampler).unwrap_or(Lens::CENTRE);
    let (ray, gain) = view.eye(film, lens, view.shutter.moment(u, row, view.height));
    Eye { ray: PathRay::eye(ray, *sampler), gain }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::CameraPlacement;
    use durer_core::{
        glam::DVec3,
        math::{Interval, Transform},
        sampling::SamplerKind,
    };
    use durer_model::{camera::CAMERAS, filter::Filter};
    use durer_scene::{Args, Diagnostics, Node, Params, find};

    /// Parallel rays from a lens of radius 1, exposed from 0 to 1 s.
    fn view() -> View {
        let node = Node::new("orthographic", Params::new().float("lensradius", 1.0));
        let mut said = Diagnostics::default();
        let entry = find(CAMERAS, "camera", &node, &mut said).expect("a registered word");
        let mut camera = (entry.build)(&mut Args::check(&node, entry.schema, &[], &mut said)).expect("sound");
        camera.fit(10, 10);
        View {
            shutter: camera.shutter().during(Interval::new(0.0, 1.0)),
            camera,
            placement: CameraPlacement::Still(Transform::IDENTITY),
            world_from_render: DVec3::ZERO,
            width: 10,
            height: 10,
            filter: Filter::pixel(),
            speed: 1.0,
            sensor: Default::default(),
            layers: None,
        }
    }

    /// Place in the pixel 3, 4 (in pixels), moment and point on the lens of each sample.
    fn decisions(samples: u32, nesting: Nesting) -> Vec<([f32; 2], f32, [f32; 2])> {
        let view = view();
        let of = |i| {
            let sampler = Sampler::new(SamplerKind::Stratified, 5, [3, 4], i, samples);
            let (eye, weight) = eye_ray((&view, nesting), [3, 4], &sampler, None);
            assert_eq!((weight, eye.gain), (1.0, 1.0));
            let ray = eye.ray.ray;
            // The rays through a place meet at the depth in focus, 1e6 m away, in front of the place.
            let seen = ray.at((1e6 - ray.o.z) / ray.d.z);
            let lens =
                if nesting.lens == 0 { [0.0; 2] } else { view.camera.lens().at(sampler.d2(Dim::Lens)) };
            let film = [(ray.o.x - lens[0] + 1.0) * 5.0, (1.0 - ray.o.y + lens[1]) * 5.0];
            assert!((seen.x - ray.o.x).abs() < 1.5);
            ([film[0] - 3.0, film[1] - 4.0], ray.time, lens)
        };
        (0..samples).map(of).collect()
    }

    fn cells(points: impl Iterator<Item = [f32; 2]>, n: usize) -> Vec<usize> {
        let mut cells = vec![0; n * n];
        let cell = |v: f32| ((v * n as f32) as usize).min(n - 1);
        points.for_each(|[x, y]| cells[cell(x) + n * cell(y)] += 1);
        cells
    }

    #[test]
    fn nested_samples_go_through_every_place_at_every_moment() {
        // 16 places, 4 moments each, 2 points on the lens each.
        let all = decisions(128, Nesting { time: 4, lens: 2, ..Nesting::default() });
        for group in all.chunks(8) {
            let (place, _, _) = group[0];
            assert!(group.iter().all(|d| (d.0[0] - place[0]).hypot(d.0[1] - place[1]) < 1e-5));
            for moment in group.chunks(2) {
                assert_eq!(moment[0].1, moment[1].1);
                assert_ne!(moment[0].2, moment[1].2);
            }
        }
        assert_eq!(cells(all.iter().step_by(8).map(|d| d.0), 4), vec![1; 16], "places");
        let mut moments = [0; 64];
        all.iter().step_by(2).for_each(|d| moments[(d.1 * 64.0) as usize] += 1);
        assert_eq!(moments, [1; 64], "moments");
        // A quarter of the points of the lens lies within half its radius.
        let inner = all.iter().filter(|d| d.2[0].hypot(d.2[1]) < 0.5).count();
        assert!((28..=36).contains(&inner), "{inner}");
    }

    #[test]
    fn effects_that_are_left_out_stay_in_their_middle() {
        let frozen = decisions(16, Nesting { time: 0, lens: 0, ..Nesting::default() });
        assert!(frozen.iter().all(|d| d.1 == 0.5 && d.2 == [0.0; 2]));
        assert_eq!(cells(frozen.iter().map(|d| d.0), 4), vec![1; 16]);
        let one_place = decisions(16, Nesting { time: 16, lens: 0, ..Nesting::default() });
        assert!(one_place.iter().all(|d| (d.0[0] - 0.5).abs() < 1e-5 && (d.0[1] - 0.5).abs() < 1e-5));
    }

    #[test]
    fn passes_are_gapless_and_end_with_blocks() {
        assert_eq!(passes(1, BLOCK), [(0, 1)]);
        assert_eq!(passes(100, BLOCK), [(0, 1), (1, 4), (4, 16), (16, 64), (64, 100)]);
        for n in 1..300 {
            assert!(passes(n, 1).iter().zip(0..).all(|(&pass, i)| pass == (i, i + 1)));
            let p = passes(n, BLOCK);
            assert!(p.windows(2).all(|w| w[0].1 == w[1].0) && p[p.len() - 1].1 == n);
            assert!((BLOCK..=n).step_by(BLOCK as usize).all(|end| p.iter().any(|w| w.1 == end)));
        }
    }
}
