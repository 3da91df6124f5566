//! Colours of measured spectra, against sums over the tabulated observer.
use std::path::{Path, PathBuf};

use durer_core::spectrum::Sampled;

/// A file of the shared assets, if this machine has them: its rows, without the head.
fn table(name: &str) -> Option<Vec<Vec<f64>>> {
    let here = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    let folder = std::env::var_os("DURER_SHARED").map_or(here, PathBuf::from);
    let Ok(text) = std::fs::read_to_string(folder.join("assets/spectra").join(name)) else {
        eprintln!("SKIPPED: no shared/assets/spectra/{name}; set DURER_SHARED");
        return None;
    };
    let row = |line: &str| line.split(',').map(|v| v.trim().parse().expect("a number")).collect();
    Some(text.lines().skip(1).map(row).collect())
}

fn at(table: &[Vec<f64>], column: usize, nm: f64) -> f64 {
    let after = table.partition_point(|row| row[0] <= nm);
    match (after.checked_sub(1).map(|i| &table[i]), table.get(after)) {
        (Some(a), Some(b)) => a[column] + (b[column] - a[column]) * (nm - a[0]) / (b[0] - a[0]),
        (Some(a), None) if a[0] == nm => a[column],
        _ => 0.0,
    }
}

#[test]
fn patches_of_the_color_checker_have_the_colors_of_the_tables() {
    let (Some(cmf), Some(d65), Some(patches)) =
        (table("cie1931_2deg_xyz.csv"), table("illuminant_d65.csv"), table("colorchecker_iso17321.csv"))
    else {
        return;
    };
    for patch in 1..patches[0].len() {
        let (mut xyz, mut white) = ([0.0; 3], 0.0);
        for row in &cmf {
            let light = at(&d65, 1, row[0]);
            white += light * row[2];
            (0..3).for_each(|i| xyz[i] += light * row[i + 1] * at(&patches, patch, row[0]));
        }
        let [x, y, z] = xyz.map(|v| v / white);
        // IEC 61966-2-1, the matrix as printed.
        let expected = [
            3.2406 * x - 1.5372 * y - 0.4986 * z,
            -0.9689 * x + 1.8758 * y + 0.0415 * z,
            0.0557 * x - 0.2040 * y + 1.0570 * z,
        ];
        let numbers: Vec<f32> = patches.iter().flat_map(|row| [row[0] as f32, row[patch] as f32]).collect();
        let found = Sampled::new(&numbers).expect("a spectrum").share().rgb;
        for (found, expected) in found.iter().zip(expected) {
            // The fit of the observer is good to about a hundredth of white.
            assert!(
                (f64::from(*found) - expected.max(0.0)).abs() < 0.015,
                "patch {patch}: {found} {expected}"
            );
        }
    }
}
