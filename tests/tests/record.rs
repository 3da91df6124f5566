//! Watching changes nothing, and what was seen adds up to the pixel.
use durer::{Distribution, Options, builtin, integrator::Sampling, spectrum::Basis};
use durer_tests::{prepared, render};

fn whitted(samples: u32) -> durer::Prepared {
    let scene = builtin::find("whitted").expect("built in");
    prepared(scene.import(), &Options { width: Some(96), samples: Some(samples), ..Options::default() })
}

#[test]
fn recording_never_changes_the_pixel() {
    let prepared = whitted(1);
    let film = render(&prepared).film;
    let pixels = film.pixels();
    for y in 0..film.height {
        for x in 0..film.width {
            let (_, rgb) = prepared.job().record([x, y], 0);
            let stored = pixels[(y * film.width + x) as usize].mean();
            assert_eq!(stored.map(f32::to_bits), rgb.map(f32::to_bits), "pixel {x},{y}");
        }
    }
}

#[test]
fn folding_the_tree_gives_the_sample_bit_for_bit_and_contributions_sum_to_it() {
    let prepared = whitted(4);
    let mut deepest = 0;
    for i in 0..600u32 {
        let pixel = [(i * 37) % 96, (i * 17) % 54];
        let (tree, rgb) = prepared.job().record(pixel, i % 4);
        let folded = Basis::Rgb.to_rgb(tree.fold());
        assert_eq!(folded.map(f32::to_bits), rgb.map(f32::to_bits), "pixel {pixel:?}");
        assert_eq!(Basis::Rgb.to_rgb(tree.nodes[0].result), rgb);
        let mut sum = [0.0f64; 3];
        for node in &tree.nodes {
            let c = Basis::Rgb.to_rgb(node.contribution());
            sum.iter_mut().zip(c).for_each(|(s, c)| *s += f64::from(c));
            deepest = deepest.max(node.depth);
        }
        for (s, v) in sum.iter().zip(rgb) {
            assert!(
                (s - f64::from(v)).abs() <= 1e-5 * f64::from(v).max(1.0),
                "pixel {pixel:?}: {sum:?} {rgb:?}"
            );
        }
    }
    assert!(deepest >= 5, "the hollow ball makes deep trees, not {deepest}");
}

#[test]
fn trees_of_distributed_rays_are_the_pixel_too() {
    for sampling in [Sampling::Shared, Sampling::Nested] {
        let distribution = Distribution {
            shadow_rays: Some(2),
            gloss_rays: Some(3),
            sampling: Some(sampling),
            ..Distribution::default()
        };
        let options = Options { width: Some(48), samples: Some(1), distribution, ..Options::default() };
        let prepared = prepared(builtin::find("cook").expect("built in").import(), &options);
        let film = render(&prepared).film;
        let samples = prepared.settings.samples;
        let mut glossy = 0;
        for (i, pixel) in film.pixels().iter().enumerate() {
            let trees = (0..samples).map(|s| prepared.job().record([i as u32 % 48, i as u32 / 48], s));
            let mut sum = [0.0f64; 3];
            for (tree, rgb) in trees {
                let folded = Basis::Rgb.to_rgb(tree.fold());
                assert_eq!(folded.map(f32::to_bits), rgb.map(f32::to_bits), "pixel {i}");
                let parts = tree.nodes.iter().map(|n| f64::from(Basis::Rgb.to_rgb(n.contribution())[1]));
                let whole: f64 = parts.sum();
                assert!(
                    (whole - f64::from(rgb[1])).abs() <= 1e-5 * whole.max(1.0),
                    "pixel {i}: {whole} {rgb:?}"
                );
                sum.iter_mut().zip(rgb).for_each(|(s, v)| *s += f64::from(v) / f64::from(samples));
                glossy +=
                    tree.nodes.iter().filter(|n| n.kind == durer::probe::RayKind::GlossyReflection).count();
            }
            // The filter does not weigh all samples exactly alike.
            let allowed = if samples == 1 { 0.0 } else { 0.01 };
            for (s, v) in sum.iter().zip(pixel.mean()) {
                assert!((s - f64::from(v)).abs() <= allowed * s, "pixel {i}: {s} {v}");
            }
        }
        assert!(glossy > 500, "{glossy}");
    }
}

#[test]
fn what_was_cut_off_is_within_its_bound() {
    let of = |depth| {
        let options = Options {
            width: Some(48),
            samples: Some(1),
            max_depth: Some(depth),
            min_contribution: Some(0.0),
            ..Options::default()
        };
        prepared(builtin::find("glass-plate").expect("built in").import(), &options)
    };
    let (cut, whole) = (of(2), of(9));
    let map = cut.job().killed(&Default::default());
    let mut lacking = 0;
    for (i, share) in map.shares.iter().enumerate() {
        let pixel = [i as u32 % 48, i as u32 / 48];
        let (tree, rgb) = whole.job().record(pixel, 0);
        let (some, less) = cut.job().record(pixel, 0);
        assert_eq!(*share, Basis::Rgb.to_rgb(some.killed()));
        assert!(map.max_radiance >= some.max_radiance());
        for ((more, less), share) in rgb.iter().zip(less).zip(share) {
            let bound = share * tree.max_radiance();
            assert!(more - less <= bound * 1.0001 + 1e-6, "pixel {pixel:?}: {more} - {less} > {bound}");
            lacking += usize::from(more - less > 1e-3);
        }
    }
    assert!(lacking > 100, "{lacking} pixels lack something");
    assert!(of(40).job().record([0, 0], 0).0.killed().is_black(), "the sky beside the plates");
}
