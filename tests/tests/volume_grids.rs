//! Smoke on grids, in clouds and in files of others, against closed forms.
#![allow(clippy::expect_used, reason = "a scene that lacks what a test looks for is a failed test")]
use durer::{Options, Prepared};
use durer_tests::{import, render, scene, shared};

const SKY: &str = "LightSource \"infinite\" \"rgb L\" [1 1 1]\n";
const ALL: &str = "\"integer maxdepth\" 10000 \"integer roulettedepth\" 10000";

/// A picture of one spot, taken from the origin towards `to`.
fn picture(to: &str, integrator: &str, world: &str, samples: u32) -> Prepared {
    let text = format!(
        "Film \"rgb\" \"integer xresolution\" 1 \"integer yresolution\" 1\nPixelFilter \"box\"\n\
         LookAt 0 0 0  {to}  0 1 0\nCamera \"perspective\" \"float fov\" 0.0001\n\
         Integrator \"volpath\" {integrator}\nWorldBegin\n{world}"
    );
    scene(&text, &Options { samples: Some(samples), ..Options::default() })
}

fn colour(scene: &Prepared) -> [f64; 3] {
    render(scene).film.pixels()[0].mean().map(f64::from)
}

fn near(found: f64, expected: f64, within: f64, what: &str) {
    assert!((found - expected).abs() <= within * expected.abs(), "{what}: {found}, expected {expected}");
}

/// A medium called smoke in a box of 2 x 2 x 1 metres, two metres ahead, and the box.
fn smoke(kind: &str, params: &str) -> String {
    format!(
        "AttributeBegin Translate -1 -1 2\n\
         MakeNamedMedium \"smoke\" \"string type\" \"{kind}\" \"point3 p1\" [2 2 1] {params}\n\
         Material \"interface\" MediumInterface \"smoke\" \"\"\n\
         Shape \"trianglemesh\"\n\
         \"integer indices\" [0 2 1 1 2 3  4 5 6 5 7 6  0 1 4 1 5 4  2 6 3 3 6 7  0 4 2 2 4 6  1 3 5 3 7 5]\n\
         \"point3 P\" [0 0 0  2 0 0  0 2 0  2 2 0  0 0 1  2 0 1  0 2 1  2 2 1] AttributeEnd\n"
    )
}

/// Densities of a grid that are all different.
fn uneven(count: usize) -> String {
    (0..count).map(|i| format!("{} ", (i * 7 % 11) as f64 * 0.3)).collect()
}

#[test]
fn a_grid_absorbs_by_what_lies_between_its_values() {
    // Halfway to the sides 1 has become 1/2: 3/4 over the whole way of one value, 7/8 of two.
    for (grid, mean) in [("[1]", 0.75), ("[1 1] \"integer nz\" 2", 0.875)] {
        let params = format!("\"float density\" {grid} \"rgb sigma_a\" [0.5 1 2] \"rgb sigma_s\" [0 0 0]");
        let world = SKY.to_owned() + &smoke("uniformgrid", &params);
        let found = colour(&picture("0 0 1", "", &world, 65_536));
        for (found, sigma) in found.into_iter().zip([0.5, 1.0, 2.0]) {
            near(found, f64::exp(-sigma * mean), 4e-3, grid);
        }
    }
    // The same in colours, of which each has a grid; sigma_s alone means sigma_a 1.
    let params = "\"integer nz\" 2 \"rgb sigma_a\" [0.5 1 2  0.5 1 2] \"rgb sigma_s\" [0 0 0  0 0 0]";
    let found = colour(&picture("0 0 1", "", &(SKY.to_owned() + &smoke("rgbgrid", params)), 65_536));
    for (found, sigma) in found.into_iter().zip([0.5, 1.0, 2.0]) {
        near(found, f64::exp(-sigma * 0.875), 4e-3, "rgbgrid");
    }
}

#[test]
fn where_nothing_is_lost_smoke_disappears_in_a_uniform_sky() {
    let grid =
        format!("\"integer nx\" 5 \"integer ny\" 4 \"integer nz\" 9 \"float density\" [{}]", uneven(180));
    let white = "\"rgb sigma_a\" [0 0 0] \"rgb sigma_s\" [4 4 4] \"float g\" 0.3";
    let cloud = "\"float density\" 2 \"float frequency\" 3";
    let scattering: String = (0..8).map(|i| format!("{0} {0} {0}  ", i + 1)).collect();
    let zero = "0 0 0  ".repeat(8);
    let rgb = format!(
        "\"integer nx\" 2 \"integer ny\" 2 \"integer nz\" 2 \"rgb sigma_a\" [{zero}] \"rgb sigma_s\" [{scattering}]"
    );
    for (kind, params) in
        [("uniformgrid", format!("{grid} {white}")), ("cloud", format!("{cloud} {white}")), ("rgbgrid", rgb)]
    {
        for to in ["0 0 1", "0.3 -0.2 1"] {
            let world = SKY.to_owned() + &smoke(kind, &params);
            let found = colour(&picture(to, ALL, &world, 256));
            found.into_iter().for_each(|found| near(found, 1.0, 1e-3, kind));
        }
    }
}

#[test]
fn lanes_that_scatter_differently_and_what_glows_are_right_in_the_mean() {
    let grid =
        format!("\"integer nx\" 5 \"integer ny\" 4 \"integer nz\" 9 \"float density\" [{}]", uneven(180));
    // Light comes from the sky, and from a sphere around everything that is asked by shadow rays.
    let shell = "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [0 0 0] ReverseOrientation AreaLightSource \"diffuse\" Shape \"sphere\" \"float radius\" 30 AttributeEnd\n";
    let chromatic = "\"rgb sigma_a\" [0 0 0] \"rgb sigma_s\" [0.3 1 3]";
    let glowing = "\"rgb sigma_a\" [1 1 1] \"rgb sigma_s\" [0.6 0.6 0.6] \"rgb Le\" [1 1 1]";
    for (light, what) in [(SKY, "sky"), (shell, "shell")] {
        for params in [chromatic, glowing] {
            let world = light.to_owned() + &smoke("uniformgrid", &format!("{grid} {params}"));
            let found = colour(&picture("0.1 0.1 1", ALL, &world, 65_536));
            found.into_iter().for_each(|found| near(found, 1.0, 1.5e-2, &format!("{what}, {params}")));
        }
    }
}

#[test]
fn hot_smoke_sends_what_a_black_body_does() {
    let fire = "\"float density\" [1] \"float temperature\" [3000] \"rgb sigma_a\" [400 400 400] \"rgb sigma_s\" [0 0 0]";
    let dark = "LightSource \"infinite\" \"rgb L\" [0 0 0]\n";
    // Seen from so near its middle nothing else is seen of it; a half of the temperature is left at the sides.
    let found = colour(&picture("0 0 1", "", &(dark.to_owned() + &smoke("uniformgrid", fire)), 4096));
    let cold = durer::spectrum::LightColor::glow(1500.0).color.rgb.map(f64::from);
    let hot = durer::spectrum::LightColor::glow(3000.0).color.rgb.map(f64::from);
    for i in 0..3 {
        assert!(found[i] >= cold[i] * 0.99 && found[i] < hot[i], "{found:?}, between {cold:?} and {hot:?}");
    }
}

#[test]
fn a_level_set_of_openvdb_is_fog_as_deep_as_its_sphere() {
    let Some(folder) = shared("a_level_set_of_openvdb_is_fog_as_deep_as_its_sphere") else { return };
    let own = tempfile::tempdir().expect("a folder");
    std::fs::copy(folder.join("assets/volumes/sphere.vdb"), own.path().join("sphere.vdb")).expect("copied");
    let text = format!(
        "Film \"rgb\" \"integer xresolution\" 1 \"integer yresolution\" 1\nPixelFilter \"box\"\n\
         LookAt 0 0 -5  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 0.0001\nIntegrator \"volpath\"\nWorldBegin\n{SKY}\
         MakeNamedMedium \"ball\" \"string type\" \"nanovdb\" \"string filename\" \"sphere.vdb\" \"string grid\" \"ls_sphere\"\n\
         \"rgb sigma_a\" [0.1 0.2 0.4] \"rgb sigma_s\" [0 0 0]\n\
         Material \"interface\" MediumInterface \"ball\" \"\" Shape \"sphere\" \"float radius\" 3.5\n"
    );
    let file = own.path().join("ball.pbrt");
    std::fs::write(&file, text).expect("written");
    let mut imported = durer::open(&file.to_string_lossy());
    let options = Options { samples: Some(16_384), ..Options::default() };
    let prepared =
        durer::prepare(&mut imported, &options).unwrap_or_else(|| panic!("{:?}", imported.diagnostics));
    // Radius 3, less half a band of 0.15 m at both ends, where the density rises.
    for (found, sigma) in colour(&prepared).into_iter().zip([0.1, 0.2, 0.4]) {
        near(found, f64::exp(-sigma * (6.0 - 0.15)), 1e-2, "sphere.vdb");
    }
}

#[test]
fn what_is_wrong_with_media_is_said_with_its_place() {
    let cases = [
        ("MakeNamedMedium \"a\" \"string type\" \"homogenous\"", "did you mean"),
        ("MakeNamedMedium \"a\"", "needs the parameter"),
        ("MakeNamedMedium \"a\" \"string type\" \"homogeneous\" \"rgb sigma\" [1 1 1]", "sigma_a"),
        (
            "MakeNamedMedium \"a\" \"string type\" \"homogeneous\" \"string preset\" \"Wholemilc\"",
            "Wholemilk",
        ),
        ("MakeNamedMedium \"a\" \"string type\" \"homogeneous\" \"float g\" 2", "expected -1 to 1"),
        (
            "MakeNamedMedium \"a\" \"string type\" \"uniformgrid\" \"float density\" [1 2 3] \"integer nx\" 2",
            "2 x 1 x 1",
        ),
        (
            "MakeNamedMedium \"a\" \"string type\" \"uniformgrid\" \"float density\" [1] \"point3 p1\" [1 1 0]",
            "flat",
        ),
        ("MakeNamedMedium \"a\" \"string type\" \"nanovdb\" \"string filename\" \"no.vdb\"", "no.vdb"),
        ("MakeNamedMedium \"a\" \"string type\" \"homogeneous\"\nMediumInterface \"b\" \"\"", "b"),
        ("Material \"dielectric\" \"string medium\" \"milk\"", "milk"),
    ];
    for (line, expected) in cases {
        let mut imported = import(&format!("Camera \"perspective\"\nWorldBegin\n{line}\nShape \"sphere\"\n"));
        let prepared = durer::prepare(&mut imported, &Options::default());
        let said = format!("{:?}", imported.diagnostics);
        assert!(prepared.is_none() && said.contains(expected), "{line}: {said}");
    }
}
