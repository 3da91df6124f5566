//! Pictures that shine, in wavelengths: white light through a filter of the pixel's colour, as lights of one colour are.
use std::path::Path;

use durer::{
    Options,
    spectrum::{Carried, Color},
};
use durer_tests::{prepared, render};

const BOTH: [Carried; 2] = [Carried::Rgb, Carried::Wavelengths];
const FLAME: [f32; 3] = [0.9, 0.45, 0.12];
const BRICK: [f32; 3] = [0.63, 0.12, 0.05];

/// A picture of one colour as a Portable Float Map.
fn pfm(rgb: [f32; 3]) -> Vec<u8> {
    let pixels = std::iter::repeat_n(rgb, 8).flatten().flat_map(f32::to_le_bytes);
    b"PF\n4 2\n-1.0\n".iter().copied().chain(pixels).collect()
}

/// The mean of a picture, in parallel rays along +z.
fn seen(folder: &Path, carried: Carried, world: &str) -> [f64; 3] {
    let text = format!(
        "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\nIntegrator \"path\"\n\
         Camera \"orthographic\" \"float screenwindow\" [-0.1 0.1 -0.1 0.1]\nWorldBegin\n{world}"
    );
    let file = folder.join("scene.pbrt");
    std::fs::write(&file, text).expect("a file");
    let options = Options { carried: Some(carried), samples: Some(256), ..Options::default() };
    let pixels = render(&prepared(durer::open(&file.to_string_lossy()), &options)).film.pixels();
    let of = |c: usize| pixels.iter().map(|pixel| f64::from(pixel.mean()[c])).sum::<f64>();
    [0, 1, 2].map(|c| of(c) / pixels.len() as f64)
}

/// The colour of light of `light` that a surface of `share` sends back.
fn reflected(carried: Carried, light: [f32; 3], share: [f32; 3]) -> [f64; 3] {
    const STEPS: u32 = 4000;
    let mut sum = [0.0; 3];
    for i in 0..STEPS {
        let basis = carried.basis(|| (i as f32 + 0.5) / STEPS as f32);
        let lanes = basis.emission(Color { rgb: light }) * basis.reflectance(Color { rgb: share });
        sum.iter_mut().zip(basis.to_rgb(lanes)).for_each(|(sum, v)| *sum += f64::from(v) / f64::from(STEPS));
    }
    sum
}

/// A mirror that sends rays to the left, to a wall there.
fn mirror([r, g, b]: [f32; 3]) -> String {
    format!(
        "Material \"mirror\" \"rgb reflectance\" [{r} {g} {b}] \
         Shape \"plane\" \"point3 point\" [0 0 2] \"vector3 normal\" [-0.70710678 0 -0.70710678]\n"
    )
}

fn matte([r, g, b]: [f32; 3]) -> String {
    format!(
        "Material \"diffuse\" \"rgb reflectance\" [{r} {g} {b}] \
         Shape \"plane\" \"point3 point\" [0 0 2] \"vector3 normal\" [0 0 -1]\n"
    )
}

#[test]
fn pictures_shine_as_lights_of_their_colours_do() {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, rgb) in [("white.pfm", [1.0; 3]), ("flame.pfm", FLAME)] {
        std::fs::write(folder.path().join(name), pfm(rgb)).expect("a file");
    }
    let wall = |look: &str| {
        format!(
            "AreaLightSource \"diffuse\" \"bool twosided\" true {look} \
             Shape \"bilinearmesh\" \"point3 P\" [-4 -2 0  -4 -2 4  -4 2 0  -4 2 4] \"point2 uv\" [0 0 1 0 0 1 1 1]"
        )
    };
    let one_color = format!("\"rgb L\" [{} {} {}]", FLAME[0], FLAME[1], FLAME[2]);
    let file = |word: &str, name: &str| format!("\"string {word}\" \"{name}.pfm\"");
    // Who sends it, and what sends it back: how bright it is only white tells.
    type Of<'a> = &'a dyn Fn(&str) -> String;
    let worlds: [(&str, Of); 5] = [
        ("wall", &|name| mirror(BRICK) + &wall(&file("filename", name))),
        ("sky in a mirror", &|name| {
            mirror(BRICK) + &format!("LightSource \"infinite\" {}", file("filename", name))
        }),
        ("sky on a wall", &|name| {
            matte(BRICK) + &format!("LightSource \"infinite\" {}", file("filename", name))
        }),
        ("projector", &|name| {
            matte(BRICK) + &format!("LightSource \"projection\" \"float fov\" 60 {}", file("filename", name))
        }),
        ("lamp of one colour", &|name| match name {
            "white" => mirror(BRICK) + &wall("\"rgb L\" [1 1 1]"),
            _ => mirror(BRICK) + &wall(&one_color),
        }),
    ];
    let mut redder = 0.0;
    for (light, world) in worlds {
        let white = BOTH.map(|carried| seen(folder.path(), carried, &world("white")));
        let (once, bright) = (reflected(BOTH[1], [1.0; 3], BRICK), white[1][0] / f64::from(BRICK[0]));
        (0..3).for_each(|c| {
            // White is as bright in both, and shows the surface's own colour.
            assert!((white[0][c] - white[1][c]).abs() < 6e-3 * bright, "{light}: {white:?}");
            assert!((white[1][c] - bright * once[c]).abs() < 6e-3 * bright, "{light}: {white:?} {once:?}");
        });
        for carried in BOTH {
            let (found, expected) =
                (seen(folder.path(), carried, &world("flame")), reflected(carried, FLAME, BRICK));
            (0..3).for_each(|c| {
                assert!(
                    (found[c] - bright * expected[c]).abs() < 6e-3 * bright,
                    "{light}, {carried:?}: {found:?}, expected {expected:?} times {bright}"
                );
            });
        }
        let [rgb, waves] = BOTH.map(|carried| reflected(carried, FLAME, BRICK));
        redder += waves[0] - rgb[0];
    }
    // Two filters one behind the other are not the product of their colours.
    assert!(redder.abs() > 5.0 * 0.01, "{redder}");
}

#[test]
fn the_white_of_aces_is_that_of_its_daylight() {
    // SMPTE ST 2065-1: white at x 0.32168, y 0.33767; to linear Rec. 709 (IEC 61966-2-1) without adaptation.
    let (x, y) = (0.32168, 0.33767);
    let xyz = [x / y, 1.0, (1.0 - x - y) / y];
    let rows = [[3.2406, -1.5372, -0.4986], [-0.9689, 1.8758, 0.0415], [0.0557, -0.2040, 1.0570]];
    let daylight = rows.map(|row| row[0] * xyz[0] + row[1] * xyz[1] + row[2] * xyz[2]);
    let folder = tempfile::tempdir().expect("a folder");
    let world = "ColorSpace \"aces2065-1\" LightSource \"infinite\" \"rgb L\" [1 1 1]\n".to_owned();
    for carried in BOTH {
        let found = seen(folder.path(), carried, &(world.clone() + &mirror([0.5; 3])));
        assert!(
            (0..3).all(|c| (found[c] - 0.5 * daylight[c]).abs() < 5e-3),
            "{carried:?}: {found:?}, expected half of {daylight:?}"
        );
    }
}
