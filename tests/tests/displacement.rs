//! Shapes whose surface a texture moves.
use durer::{Options, Prepared};
use durer_tests::{import, render, scene};

/// A picture of 16 x 16 pixels from above, 2 x 2 m, of the numbers that `cast` shows.
fn from_above(show: &str, world: &str) -> Prepared {
    // Mirrored, so that x grows to the right.
    let text = format!(
        "Scale -1 1 1\nLookAt 0 0 5  0 0 0  0 1 0\nCamera \"orthographic\"\n\
         Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 16\n\
         Integrator \"cast\" \"string show\" \"{show}\"\nWorldBegin\n{world}"
    );
    scene(&text, &Options::default())
}

/// What of the first number of each pixel there is.
fn numbers(prepared: &Prepared) -> Vec<f32> {
    render(prepared).film.pixels().iter().map(|pixel| pixel.mean()[0]).collect()
}

const SQUARE: &str = "\"point3 P\" [ -1 -1 0  1 -1 0  1 1 0  -1 1 0 ] \"point2 uv\" [ 0 0  1 0  1 1  0 1 ] \
                      \"integer indices\" [ 0 1 2  0 2 3 ]";

#[test]
fn a_square_lies_where_its_texture_moves_it() {
    let even = format!(
        "Texture \"d\" \"float\" \"constant\" \"float value\" 0.25\n\
                        Shape \"trianglemesh\" {SQUARE} \"texture displacement\" \"d\" \"float edgelength\" 0.3"
    );
    for depth in numbers(&from_above("depth", &even)) {
        assert!((depth - 4.75).abs() < 1e-5, "{depth}");
    }
    // A slope, from 0 to 0.5, as bilinear interpolation gives it.
    let slope = format!(
        "Texture \"d\" \"float\" \"bilerp\" \"float v00\" 0 \"float v01\" 0 \"float v10\" 0.5 \"float v11\" 0.5\n\
                         Shape \"trianglemesh\" {SQUARE} \"texture displacement\" \"d\" \"float edgelength\" 0.1"
    );
    for (i, depth) in numbers(&from_above("depth", &slope)).iter().enumerate() {
        let u = ((i % 16) as f32 + 0.5) / 16.0;
        assert!((depth - (5.0 - 0.5 * u)).abs() < 1e-4, "pixel {i}: {depth}");
    }
    // Its normals are those of the slope: dz/dx = 0.25.
    let expected = -0.25 / (1.0f32 + 0.0625).sqrt();
    for x in numbers(&from_above("normal", &slope)) {
        assert!((x - expected).abs() < 1e-4, "{x} {expected}");
    }
}

#[test]
fn patches_and_subdivided_meshes_are_displaced_as_well() {
    let patch = "Texture \"d\" \"float\" \"constant\" \"float value\" 0.25\n\
                 Shape \"bilinearmesh\" \"point3 P\" [ -1 -1 0  1 -1 0  -1 1 0  1 1 0 ] \"texture displacement\" \"d\"";
    for depth in numbers(&from_above("depth", patch)) {
        assert!((depth - 4.75).abs() < 1e-5, "{depth}");
    }
    let cube = "Shape \"loopsubdiv\" \"point3 P\" [ 1 0 0  -1 0 0  0 1 0  0 -1 0  0 0 1  0 0 -1 ]\n\
                \"integer indices\" [ 0 2 4  2 1 4  1 3 4  3 0 4  2 0 5  1 2 5  3 1 5  0 3 5 ] \"integer levels\" 4";
    let middle = |more: &str| {
        let depths = numbers(&from_above("depth", &format!("{cube}{more}")));
        depths[8 * 16 + 8]
    };
    let (own, moved) = (middle(""), middle(" \"float displacement\" 0.2 \"float edgelength\" 0.05"));
    // Beside the top, whose curvature has no bound, a little more.
    assert!((0.2..0.22).contains(&(own - moved)), "{own} {moved}");
}

#[test]
fn edges_are_measured_where_the_shape_stands() {
    let triangles = |words: &str, before: &str| {
        let world = format!(
            "Texture \"d\" \"float\" \"constant\" \"float value\" 0\n{before}\n\
             Shape \"trianglemesh\" {SQUARE} \"texture displacement\" \"d\" {words}"
        );
        let prepared = scene(&format!("WorldBegin\n{world}"), &Options::default());
        prepared.scene.accel.stats().triangles
    };
    // A square of 2 m whose diagonals and sides are split in turn.
    assert_eq!(triangles("\"float edgelength\" 3", ""), 2);
    assert_eq!(triangles("\"float edgelength\" 2.5", ""), 4);
    assert_eq!(triangles("\"float edgelength\" 1.9", ""), 8);
    assert_eq!(triangles("\"float edgelength\" 19", "Scale 10 10 10"), 8);
    assert_eq!(triangles("\"float displacement.edgelength\" 1.9", ""), 8);
    let scaled =
        "Option \"float displacementedgescale\" 0.5\nWorldBegin\nTexture \"d\" \"float\" \"constant\"\n";
    let text = format!(
        "{scaled}Shape \"trianglemesh\" {SQUARE} \"texture displacement\" \"d\" \"float edgelength\" 3.8"
    );
    assert_eq!(scene(&text, &Options::default()).scene.accel.stats().triangles, 8);
}

#[test]
fn textures_that_fill_space_are_asked_where_the_shape_stands() {
    // A board of 3D: fields of 1 m, of which the one around (0.5, 0.5, 0.5) is raised, seen from above after a move.
    let world = "Texture \"d\" \"float\" \"checkerboard\" \"integer dimension\" 3 \"float tex1\" 0 \"float tex2\" 0.5\n\
                 Translate 0 0 0.5\nShape \"trianglemesh\" \"point3 P\" [ -1 -1 0  1 -1 0  1 1 0  -1 1 0 ]\n\
                 \"integer indices\" [ 0 1 2  0 2 3 ] \"texture displacement\" \"d\" \"float edgelength\" 0.05";
    let depths = numbers(&from_above("depth", world));
    let at = |x: usize, y: usize| depths[y * 16 + x];
    let quarters = [at(4, 4), at(12, 4), at(4, 12), at(12, 12)];
    assert!(
        (quarters[0] - quarters[3]).abs() < 1e-5 && (quarters[1] - quarters[2]).abs() < 1e-5,
        "{quarters:?}"
    );
    assert!((quarters[0] - quarters[1]).abs() > 0.49, "{quarters:?}");
}

#[test]
fn what_cannot_be_displaced_is_named() {
    let said = |world: &str| {
        let mut imported = import(&format!("WorldBegin\n{world}"));
        let _ = durer::prepare(&mut imported, &Options::default());
        imported.diagnostics.iter().map(|d| d.message.clone()).collect::<Vec<_>>().join(" | ")
    };
    let bare = "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0  1 0 0  0 1 0 ]";
    let dots = "Texture \"d\" \"float\" \"dots\"\n";
    for (world, expected) in [
        (format!("{dots}{bare} \"texture displacement\" \"d\""), "needs texture coordinates"),
        (format!("{dots}{bare} \"texture displacement\" \"dd\""), "unknown float texture \"dd\""),
        (
            format!("{bare} \"float displacement\" 1 \"float edgelength\" 0"),
            "\"edgelength\" is 0, expected more than 0 m",
        ),
        (format!("{bare} \"float displacement\" 1 \"float edgelength\" 1e-5"), "more than 8388608 triangles"),
        (format!("{bare} \"float edgelength\" 2"), "\"edgelength\" has no effect without \"displacement\""),
        (
            format!("{bare} \"float displacement\" 1 \"point3 P1\" [ 0 0 1  1 0 1  0 1 1 ]"),
            "vertices that move cannot be displaced",
        ),
        (
            format!(
                "{bare} \"float displacement\" 1 \"float edgelength\" 2 \"float displacement.edgelength\" 2"
            ),
            "they mean the same",
        ),
    ] {
        let said = said(&world);
        assert!(said.contains(expected), "{said} does not say: {expected}");
    }
}
