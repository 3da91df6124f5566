//! Samplers: strata, independence, and how they divide.
use super::*;

const KINDS: [SamplerKind; 7] = SamplerKind::ALL;
const DIMS: [Dim; 5] = [Dim::Pixel, Dim::Time, Dim::Lens, Dim::Light, Dim::Scatter];

fn points(kind: SamplerKind, seed: u64, dim: Dim, n: u32) -> Vec<Point2> {
    (0..n).map(|i| Sampler::new(kind, seed, [3, 7], i, n).d2(dim)).collect()
}

#[test]
fn every_elementary_interval_of_a_sobol_pair_holds_one_point() {
    for m in 1..=8u32 {
        let n = 1 << m;
        for seed in 0..8 {
            let points = points(SamplerKind::PaddedSobol, seed, Dim::Lens, n);
            for split in 0..=m {
                let (nx, ny) = (1 << split, 1 << (m - split));
                let mut seen = vec![0; n as usize];
                for p in &points {
                    let cell = (p.x * nx as f32) as u32 + nx * (p.y * ny as f32) as u32;
                    seen[cell as usize] += 1;
                }
                assert!(seen.iter().all(|&c| c == 1), "m {m} split {split} seed {seed}");
            }
        }
    }
}

#[test]
fn dimensions_pixels_branches_and_seeds_are_uncorrelated() {
    let n = 4096;
    let base = |i: u32| Sampler::new(SamplerKind::PaddedSobol, 1, [i % 64, i / 64], 0, 16);
    let others: [&dyn Fn(u32) -> f32; 4] = [
        &|i| base(i).d1(Dim::Time),
        &|i| base(i).fork(1).d1(Dim::Light),
        &|i| Sampler::new(SamplerKind::PaddedSobol, 2, [i % 64, i / 64], 0, 16).d1(Dim::Light),
        &|i| base(i + 1).d1(Dim::Light),
    ];
    for other in others {
        let sum: f32 =
            (0..n).map(|i| (base(i).d1(Dim::Light) - 0.5) * (other(i) - 0.5)).sum::<f32>() / n as f32;
        assert!((sum * 12.0).abs() < 0.05, "correlation {}", sum * 12.0);
    }
}

#[test]
fn all_kinds_are_uniform() {
    for kind in KINDS {
        let p = points(kind, 9, Dim::Scatter, 1024);
        let mean = p.iter().fold(Point2::default(), |a, &b| a + b) * (1.0 / 1024.0);
        assert!((mean.x - 0.5).abs() < 0.03 && (mean.y - 0.5).abs() < 0.03, "{kind:?} {mean:?}");
        assert!(p.iter().all(|p| p.x >= 0.0 && p.x < 1.0 && p.y >= 0.0 && p.y < 1.0));
    }
}

#[test]
fn the_parts_of_all_samples_are_one_net() {
    let base = |i: u32| Sampler::new(SamplerKind::PaddedSobol, 3, [5, 9], i, 16).fork(2);
    for dim in [Dim::Light, Dim::Scatter] {
        let mut cells = [[0; 8]; 8];
        for p in (0..16).flat_map(|i| (0..4).map(move |j| base(i).split(j, 4).d2(dim))) {
            cells[(p.y * 8.0) as usize][(p.x * 8.0) as usize] += 1;
        }
        assert_eq!(cells, [[1; 8]; 8], "{dim:?}");
    }
}

#[test]
fn one_sample_goes_through_the_centre_of_the_pixel() {
    let s = Sampler::new(SamplerKind::PaddedSobol, 5, [1, 2], 0, 1);
    assert_eq!(s.d2(Dim::Pixel), Point2::new(0.5, 0.5));
    assert_ne!(s.d2(Dim::Lens), Point2::new(0.5, 0.5));
}

#[test]
fn sixteen_samples_hit_all_cells_of_every_dimension_once_c3() {
    for kind in [SamplerKind::PaddedSobol, SamplerKind::Stratified, SamplerKind::Regular] {
        for pixel in 0..200u32 {
            for (dim, way) in DIMS.into_iter().flat_map(|dim| [0, 1, 2].map(|way| (dim, way))) {
                let at = |i| {
                    let eye = Sampler::new(kind, 4, [pixel % 20, pixel / 20], i, 16);
                    if way == 0 { eye } else { eye.fork(way) }
                };
                let mut cells = [0; 16];
                let mut slices = [0; 16];
                for i in 0..16 {
                    let (p, u) = (at(i).d2(dim), at(i).d1(dim));
                    cells[(4.0 * p.x) as usize + 4 * (4.0 * p.y) as usize] += 1;
                    slices[(16.0 * u) as usize] += 1;
                }
                assert_eq!((cells, slices), ([1; 16], [1; 16]), "{kind:?} {dim:?} way {way}");
            }
        }
    }
}

/// The correlation of two numbers of sample `i` of 16 over 10^4 pixels.
fn correlation(kind: SamplerKind, i: u32, a: impl Fn(&Sampler) -> f32, b: impl Fn(&Sampler) -> f32) -> f64 {
    let n = 10_000u32;
    let of = |p: u32| Sampler::new(kind, 11, [p % 100, p / 100], i, 16);
    let sum: f64 = (0..n).map(|p| (f64::from(a(&of(p))) - 0.5) * (f64::from(b(&of(p))) - 0.5)).sum();
    sum / f64::from(n) * 12.0
}

#[test]
fn dimensions_and_bounces_are_uncorrelated_c3() {
    for kind in KINDS.into_iter().filter(|kind| *kind != SamplerKind::Regular) {
        for i in [0, 5] {
            for (k, a) in DIMS.into_iter().enumerate() {
                for b in DIMS.into_iter().skip(k + 1) {
                    let r = correlation(kind, i, |s| s.d2(a).x, |s| s.d2(b).x);
                    assert!(r.abs() < 0.05, "{kind:?}: {a:?} and {b:?}: {r}");
                    let r = correlation(kind, i, |s| s.d1(a), |s| s.d2(b).y);
                    assert!(r.abs() < 0.05, "{kind:?}: {a:?} and {b:?}: {r}");
                }
                let r = correlation(kind, i, |s| s.fork(1).d2(a).x, |s| s.fork(1).fork(1).d2(a).x);
                assert!(r.abs() < 0.05, "{kind:?}: {a:?} at two bounces: {r}");
                let r = correlation(kind, i, |s| s.d2(a).y, |s| s.fork(0).d2(a).y);
                assert!(r.abs() < 0.05, "{kind:?}: {a:?} before and after a bounce: {r}");
                let r = correlation(kind, i, |s| s.d2(a).x, |s| s.d2(a).y);
                assert!(r.abs() < 0.05, "{kind:?}: both numbers of {a:?}: {r}");
            }
        }
    }
}

#[test]
fn the_parts_of_all_samples_fill_the_strata_of_all() {
    let base = |i: u32| Sampler::new(SamplerKind::Stratified, 3, [5, 9], i, 16).fork(2);
    let mut cells = [[0; 8]; 8];
    let mut slices = [0; 64];
    for s in (0..16).flat_map(|i| (0..4).map(move |j| base(i).split(j, 4))) {
        let p = s.d2(Dim::Light);
        cells[(p.y * 8.0) as usize][(p.x * 8.0) as usize] += 1;
        slices[(s.d1(Dim::Light) * 64.0) as usize] += 1;
    }
    assert_eq!((cells, slices), ([[1; 8]; 8], [1; 64]));
}

#[test]
fn shared_samplers_are_spread_over_their_groups() {
    for kind in [SamplerKind::PaddedSobol, SamplerKind::Stratified] {
        let at = |i: u32| Sampler::new(kind, 3, [5, 9], i, 64).shared_by(4);
        let mut cells = [0; 16];
        for i in 0..64 {
            let p = at(i).d2(Dim::Pixel);
            assert_eq!(p, at(i - i % 4).d2(Dim::Pixel));
            cells[(4.0 * p.x) as usize + 4 * (4.0 * p.y) as usize] += 1;
        }
        assert_eq!(cells, [4; 16], "{kind:?}");
    }
    let only = Sampler::new(SamplerKind::PaddedSobol, 3, [5, 9], 3, 4).shared_by(4);
    assert_eq!(only.d2(Dim::Pixel), Point2::new(0.5, 0.5));
}

#[test]
fn digits_hold_a_whole_sampler() {
    for kind in KINDS {
        let sampler = Sampler::new(kind, u64::MAX, [3, 9], 70_000, u32::MAX).fork(4);
        let hex = sampler.to_hex();
        assert_eq!(Sampler::from_hex(&hex), Some(sampler), "{hex}");
        let broken = [
            &hex[1..],
            &format!("{hex}0"),
            &hex.replace(&hex[..1], "9"),
            "",
            "0+00000000000000000000000000000000",
        ];
        broken.iter().for_each(|b| assert_eq!(Sampler::from_hex(b), None, "{b}"));
    }
}

#[test]
fn digits_of_earlier_versions_mean_what_they_meant() {
    let old = "0123456789abcdef00000000500000010";
    let sampler = Sampler::from_hex(old).expect("a sampler");
    assert_eq!((sampler.kind, sampler.index, sampler.count), (SamplerKind::PaddedSobol, 5, 16));
    assert_eq!((sampler.place, sampler.forks, sampler.to_hex().as_str()), (0, 0, old));
    // Kinds that have no place in the picture take none.
    assert_eq!(Sampler::from_hex(&format!("{old}0000000100")), None);
}

#[test]
fn points_that_are_counted_in_another_way_are_of_another_set() {
    for kind in [SamplerKind::Sobol, SamplerKind::ZSobol] {
        let eye = |i: u32| Sampler::new(kind, 3, [5, 9], i, 64);
        // All parts of a split together, of eye and of the first hit: one net.
        let mut cells = [[0; 16]; 16];
        for p in (0..64).flat_map(|i| (0..4).map(move |j| eye(i).fork(2).split(j, 4).d2(Dim::Light))) {
            cells[(p.y * 16.0) as usize][(p.x * 16.0) as usize] += 1;
        }
        assert_eq!(cells, [[1; 16]; 16], "{kind:?}");
        // Sharing with none, and splitting in one, change nothing.
        let same = eye(7).fork(2);
        assert_eq!((same.shared_by(1), same.split(0, 1)), (same, same));
        // Places that four samples share are spread over the lens of each: 16 times 4 points fill 64 cells of both.
        let mut pairs = [[0; 16]; 16];
        for i in 0..64 {
            let (place, lens) = (eye(i).shared_by(4).d2(Dim::Pixel), eye(i).d2(Dim::Lens));
            let cell = |p: Point2| (4.0 * p.x) as usize + 4 * (4.0 * p.y) as usize;
            pairs[cell(place)][cell(lens)] += 1;
        }
        assert!(pairs.iter().all(|of_place| of_place.iter().sum::<i32>() == 4), "{kind:?}");
    }
}
