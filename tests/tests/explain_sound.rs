//! No false alarm: whatever is traced without a bug breaks no law.
use durer::{Prepared, builtin, explain::check, integrator::Particles};
use durer_tests::{FILES, prepared, settings, shared};

/// Checks so many pixels of a scene, spread over the picture; how many that were.
fn check_pixels(name: &str, prepared: &Prepared, pixels: u32) -> u32 {
    let (width, height) = (prepared.scene.view.width, prepared.scene.view.height);
    let job = prepared.job();
    for i in 0..pixels {
        // Points of the plane by two irrational numbers.
        let [x, y] = [0.754_877_67f64, 0.569_840_3].map(|a| (f64::from(i) * a + 0.5).fract());
        let pixel = [(x * f64::from(width)) as u32, (y * f64::from(height)) as u32];
        let (tree, _) = job.record(pixel, i % 4);
        let found = check(prepared, &tree);
        assert!(
            found.is_empty(),
            "{name}, {}, {pixel:?}, sample {}: {found:#?}",
            prepared.integrator_name,
            i % 4
        );
    }
    pixels
}

#[test]
fn no_law_is_broken_in_the_built_in_scenes() {
    let mut pixels = 0;
    for scene in builtin::SCENES {
        for options in settings() {
            let prepared = prepared(scene.import(), &options);
            // The water there is a plane without a bottom: whether a particle begins in it cannot be told.
            if scene.name == "snell" && prepared.integrator.facts().particles != Particles::None {
                continue;
            }
            pixels += check_pixels(scene.name, &prepared, 16);
        }
    }
    assert!(pixels >= 500, "{pixels}");
}

#[test]
fn no_law_is_broken_in_files_of_others() {
    let Some(shared) = shared("no_law_is_broken_in_files_of_others") else { return };
    for file in FILES {
        for options in settings() {
            let path = shared.join("assets").join(file);
            let prepared = prepared(durer::open(&path.to_string_lossy()), &options);
            check_pixels(file, &prepared, 12);
        }
    }
}
