//! Watching changes nothing, and what was seen adds up to the pixel.
use durer::{Options, builtin, spectrum::Basis};
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
