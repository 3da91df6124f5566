//! Same scene, same seed, same picture: whatever the number of threads, the hierarchy, or who counts.
use durer::{Distribution, Gather, Options, accel::Engine, builtin, film::Tile, integrator::Sampling};
use durer_tests::{bits, prepared, render};

fn options() -> Options {
    Options { width: Some(80), samples: Some(70), ..Options::default() }
}

fn whitted(options: &Options) -> durer::Prepared {
    prepared(builtin::find("whitted").expect("built in").import(), options)
}

#[test]
fn the_number_of_threads_does_not_change_a_bit() {
    let one = bits(&render(&whitted(&Options { threads: Some(1), ..options() })));
    for threads in [2, 3, 16] {
        assert!(
            one == bits(&render(&whitted(&Options { threads: Some(threads), ..options() }))),
            "{threads}"
        );
    }
}

#[test]
fn brute_force_and_hierarchy_give_the_same_bits() {
    let tree = render(&whitted(&options()));
    let brute = render(&whitted(&Options { engine: Engine::BruteForce, ..options() }));
    assert!(bits(&tree) == bits(&brute));
}

#[test]
fn counting_changes_nothing_and_agrees_with_the_count_of_rays() {
    let prepared = whitted(&options());
    let plain = render(&prepared);
    let counted = prepared.job().render(Gather::Counters, &(), &Default::default());
    assert!(bits(&plain) == bits(&counted));
    assert_eq!(plain.rays, counted.rays);
    let counters = counted.counters.expect("asked for");
    assert_eq!(counters.all_rays(), counted.rays);
    assert_eq!(counters.max_depth, 8, "the limit that the scene sets");
}

#[test]
fn a_crop_is_a_part_of_the_whole_picture() {
    let whole = render(&whitted(&options()));
    let crop = Tile { x0: 20, y0: 10, x1: 61, y1: 33 };
    let part = render(&whitted(&Options { crop: Some(crop), ..options() }));
    let (whole_bits, part_bits) = (bits(&whole), bits(&part));
    for y in 0..whole.film.height {
        for x in 0..whole.film.width {
            let i = (y * whole.film.width + x) as usize;
            let inside = (crop.x0..crop.x1).contains(&x) && (crop.y0..crop.y1).contains(&y);
            assert_eq!(part_bits[i], if inside { whole_bits[i] } else { [0; 3] }, "{x},{y}");
        }
    }
}

#[test]
fn another_seed_is_another_picture() {
    let a = bits(&render(&whitted(&options())));
    let b = bits(&render(&whitted(&Options { seed: Some(1), ..options() })));
    assert!(a != b);
}

#[test]
fn a_cancelled_render_keeps_what_it_has() {
    let prepared = whitted(&options());
    let cancel = true.into();
    let rendered = prepared.job().render(Gather::Rays, &(), &cancel);
    assert!(rendered.cancelled && rendered.samples == 0);
}

/// The scene with all effects, its rays shared or nested.
fn cook(sampling: Sampling, options: Options) -> durer::Prepared {
    let distribution = Distribution {
        shadow_rays: Some(2),
        gloss_rays: Some(2),
        time_samples: Some(2),
        sampling: Some(sampling),
        ..Distribution::default()
    };
    let options = Options { width: Some(40), samples: Some(9), distribution, ..options };
    prepared(builtin::find("cook").expect("built in").import(), &options)
}

#[test]
fn distributed_rays_depend_on_neither_threads_nor_hierarchy_nor_who_counts() {
    for sampling in [Sampling::Shared, Sampling::Nested] {
        let taken = |options| bits(&render(&cook(sampling, options)));
        let one = taken(Options { threads: Some(1), ..Options::default() });
        for threads in [2, 7] {
            assert!(one == taken(Options { threads: Some(threads), ..Options::default() }), "{threads}");
        }
        let brute = Options {
            engine: Engine::BruteForce,
            crop: Some(Tile { x0: 3, y0: 4, x1: 30, y1: 12 }),
            ..Options::default()
        };
        let part = taken(brute);
        for (i, pixel) in part.iter().enumerate() {
            let inside = (3..30).contains(&(i % 40)) && (4..12).contains(&(i / 40));
            assert_eq!(*pixel, if inside { one[i] } else { [0; 3] }, "{i}");
        }
        let counted = cook(sampling, Options::default());
        let counted = counted.job().render(Gather::Counters, &(), &Default::default());
        assert!(bits(&counted) == one);
        assert_eq!(counted.counters.map(|c| c.all_rays()), Some(counted.rays));
        assert!(one != taken(Options { seed: Some(1), ..Options::default() }));
    }
}
