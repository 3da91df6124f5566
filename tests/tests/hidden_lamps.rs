//! Lamps and skies that are not seen directly (`hideemitters`), as Mitsuba's `hide_emitters` has it.
use durer::{Options, Prepared, explain::check};
use durer_tests::{render, scene};

const SIDE: usize = 24;

/// A lamp before a sphere that hangs before the sky, above a floor that mirrors on its right half.
fn room(integrator: &str, world: &str) -> Prepared {
    let text = format!(
        "Film \"rgb\" \"integer xresolution\" {SIDE} \"integer yresolution\" {SIDE}\nPixelFilter \"box\"\n\
         LookAt 0 1 -6  0 1 0  0 1 0\nCamera \"perspective\" \"float fov\" 50\nIntegrator {integrator}\nWorldBegin\n\
         LightSource \"infinite\" \"rgb L\" [0.5 0.6 0.8]\n{world}\n\
         Material \"diffuse\" \"rgb reflectance\" [0.7 0.4 0.2]\n\
         AttributeBegin Translate 0 1.2 0 Shape \"sphere\" \"float radius\" 1 AttributeEnd\n\
         AttributeBegin Rotate -90 1 0 0 Shape \"disk\" \"float radius\" 8 AttributeEnd\n\
         Material \"conductor\" AttributeBegin Translate 2.2 1 0 Shape \"sphere\" \"float radius\" 0.8 AttributeEnd\n"
    );
    scene(&text, &Options { samples: Some(16), ..Options::default() })
}

const LAMP: &str = "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [9 9 9] Translate -0.4 1.2 -2\n\
                    Shape \"sphere\" \"float radius\" 0.4 AttributeEnd";

fn pixels(prepared: &Prepared) -> Vec<[f32; 3]> {
    render(prepared).film.pixels().iter().map(|p| p.mean()).collect()
}

#[test]
fn eye_rays_see_what_is_behind_lamps_and_a_black_sky() {
    for word in ["path", "volpath", "direct"] {
        let of = |hides: bool| pixels(&room(&format!("\"{word}\" \"bool hideemitters\" {hides}"), LAMP));
        let (seen, hidden) = (of(false), of(true));
        let at = |picture: &[[f32; 3]], x: usize, y: usize| picture[y * SIDE + x];
        // Up in the corner there is nothing but the sky.
        assert!(at(&seen, 0, 0)[2] > 0.7, "{word}");
        assert_eq!(at(&hidden, 0, 0), [0.0; 3], "{word}");
        // The lamp hangs before the sphere: 9 with it, below 1.5 without.
        let bright = |picture: &[[f32; 3]]| picture.iter().filter(|p| p[0] > 8.0).count();
        assert!(bright(&seen) >= 8, "{word}: {}", bright(&seen));
        // In the mirror ball it is seen all the same, as small as it is there.
        assert!(bright(&hidden) < bright(&seen) / 2, "{word}: {}", bright(&hidden));
        // It lights the floor as before: pixels that see neither are the same to the bit.
        let floor = |picture: &[[f32; 3]]| picture[(SIDE - 3) * SIDE..].to_vec();
        assert_eq!(floor(&seen), floor(&hidden), "{word}");
        assert!(floor(&seen).iter().all(|p| p[0] > 0.01), "{word}");
        // What was behind the lamp is a part of the sphere, lit by it from the front.
        let (x, y) = (SIDE / 2 - 2, SIDE / 2 - 1);
        let [behind, lamp] = [at(&hidden, x, y), at(&seen, x, y)];
        assert!(
            lamp[0] > 8.0 && behind[0] > 0.05 && behind[0] > 1.2 * behind[2],
            "{word}: {behind:?} {lamp:?}"
        );
    }
}

#[test]
fn without_lamps_and_sky_nothing_changes() {
    let world = "LightSource \"point\" \"point3 from\" [0 5 -5] \"rgb I\" [50 50 50]";
    let lit = |hides: bool| {
        let of = format!("\"path\" \"bool hideemitters\" {hides}");
        pixels(&room(&of, world))[(SIDE - 3) * SIDE..].to_vec()
    };
    assert_eq!(lit(false), lit(true));
}

#[test]
fn no_law_is_broken_by_rays_that_go_through_lamps() {
    for word in ["path", "volpath", "direct"] {
        let prepared = room(&format!("\"{word}\" \"bool hideemitters\" true"), LAMP);
        let job = prepared.job();
        let mut passed = 0;
        for i in 0..SIDE as u32 {
            let (tree, _) = job.record([i, SIDE as u32 / 2 - 1], i % 4);
            let found = check(&prepared, &tree);
            assert!(found.is_empty(), "{word} {i}: {found:#?}");
            passed += usize::from(tree.nodes.iter().any(|n| n.kind == durer::probe::RayKind::Passing));
        }
        assert!(passed > 0, "{word}: no ray went through the lamp");
    }
}
