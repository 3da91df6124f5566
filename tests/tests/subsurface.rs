//! Light that walks below surfaces, against closed forms, against explicit media, and against itself.
use durer::{Options, Prepared};
use durer_tests::{
    bits, import, render, scene,
    small::{AHEAD, LAMP, difference, means, picture, total},
};

const SKY: &str = "LightSource \"infinite\" \"rgb L\" [1 1 1]\n";
const DEEP: &str = "\"path\" \"integer maxdepth\" 100";

/// What one ray from the origin sees on the mean.
fn seen(to: &str, integrator: &str, world: &str, samples: u32) -> [f64; 3] {
    let text = format!(
        "Film \"rgb\" \"integer xresolution\" 1 \"integer yresolution\" 1\nPixelFilter \"box\"\n\
         LookAt 0 0 0  {to}  0 1 0\nCamera \"perspective\" \"float fov\" 0.0001\n\
         Integrator {integrator}\nWorldBegin\n{world}"
    );
    let scene = scene(&text, &Options { samples: Some(samples), ..Options::default() });
    let rendered = render(&scene);
    assert!(rendered.imbalances.is_empty(), "{:?}", rendered.imbalances);
    rendered.film.pixels()[0].mean().map(f64::from)
}

fn near(found: f64, expected: f64, within: f64, what: &str) {
    assert!((found - expected).abs() <= within, "{what}: {found}, expected {expected}");
}

/// A ball of radius 1, five metres ahead.
fn ball(material: &str) -> String {
    format!("AttributeBegin {material} Translate 0 0 5 Shape \"sphere\" AttributeEnd\n")
}

/// Everything behind a plane two metres ahead.
fn half_space(material: &str) -> String {
    format!("{material} Shape \"plane\" \"point3 point\" [0 0 2] \"vector3 normal\" [0 0 -1]\n")
}

/// What a smooth boundary reflects.
fn fresnel(cos: f64, eta: f64) -> f64 {
    let below = (1.0 - (1.0 - cos * cos) / (eta * eta)).sqrt();
    let s = (cos - eta * below) / (cos + eta * below);
    let p = (eta * cos - below) / (eta * cos + below);
    0.5 * (s * s + p * p)
}

#[test]
fn white_bodies_do_not_leak() {
    for (sigma, g, eta) in [(0.5, 0.0, 1.33), (8.0, 0.0, 1.0), (8.0, 0.0, 1.33), (8.0, 0.7, 1.5)] {
        let material = format!(
            "Material \"subsurface\" \"rgb sigma_a\" [0 0 0] \"rgb sigma_s\" [{sigma} {sigma} {sigma}] \
             \"float g\" {g} \"float eta\" {eta}"
        );
        for (to, integrator) in [("0 0.3 5", DEEP), ("0 0.9 5", &DEEP.replace("path", "volpath"))] {
            let [found, ..] = seen(to, integrator, &(SKY.to_owned() + &ball(&material)), 2048);
            near(found, 1.0, 8e-3, &format!("sigma {sigma}, g {g}, eta {eta}, {integrator}"));
        }
    }
    // Lanes that get differently far are right in the mean; so dense that single precision hardly tells particles apart.
    let coloured = "Material \"subsurface\" \"rgb sigma_a\" [0 0 0] \"rgb sigma_s\" [1 3 8]";
    let found = seen("0 0.3 5", DEEP, &(SKY.to_owned() + &ball(coloured)), 16_384);
    found.into_iter().for_each(|found| near(found, 1.0, 4e-2, "chromatic"));
    let dense = "Material \"subsurface\" \"rgb reflectance\" [1 1 1] \"rgb mfp\" [1e-8 1e-8 1e-8]";
    let [found, ..] = seen("0 0.3 5", DEEP, &(SKY.to_owned() + &ball(dense)), 256);
    near(found, 1.0, 5e-2, "dense");
}

#[test]
fn half_spaces_send_back_the_reflectance_that_is_asked_for() {
    const RINGS: u32 = 6;
    let asked = [0.15, 0.5, 0.85];
    for (eta, g) in [(1.0f64, 0.0), (1.33, 0.0), (1.33, 0.6)] {
        let material = format!(
            "Material \"subsurface\" \"rgb reflectance\" [0.15 0.5 0.85] \"rgb mfp\" [0.01 0.01 0.01] \
             \"float eta\" {eta} \"float g\" {g}"
        );
        let world = SKY.to_owned() + &half_space(&material);
        let (mut passed, mut sums) = (0.0, [0.0; 3]);
        for ring in 0..RINGS {
            let cos = ((f64::from(ring) + 0.5) / f64::from(RINGS)).sqrt();
            let mirrored = fresnel(cos, eta);
            let to = format!("{} 0 1", (1.0 - cos * cos).sqrt() / cos);
            let found = seen(&to, DEEP, &world, 1024);
            passed += 1.0 - mirrored;
            sums.iter_mut().zip(found).for_each(|(sum, found)| *sum += found - mirrored);
        }
        for (sum, asked) in sums.into_iter().zip(asked) {
            // Similarity is not exact.
            let within = if g == 0.0 { 0.015 } else { 0.03 };
            near(sum / passed, asked, within, &format!("eta {eta}, g {g}"));
        }
    }
}

/// A ball on a floor under a lamp, of this material.
fn lit(material: &str) -> String {
    format!(
        "Material \"diffuse\"\nShape \"bilinearmesh\" \"point3 P\" [-2 0 -2  -2 0 2  2 0 -2  2 0 2]\n{LAMP}\
         AttributeBegin {material} Translate 0 0.8 0 Shape \"sphere\" \"float radius\" 0.8 AttributeEnd\n"
    )
}

#[test]
fn walks_are_what_paths_through_a_medium_with_a_boundary_are() {
    let stuff = "\"rgb sigma_a\" [0.02 0.1 0.4] \"rgb sigma_s\" [3 2.5 2] \"float g\" 0.3";
    let walked = format!("Material \"subsurface\" {stuff} \"float eta\" 1.4 \"float roughness\" 0.25");
    let medium = format!("MakeNamedMedium \"wax\" \"string type\" \"homogeneous\" {stuff}\n");
    let explicit =
        "Material \"dielectric\" \"float eta\" 1.4 \"float roughness\" 0.25 MediumInterface \"wax\" \"\"";
    let depth = "\"integer maxdepth\" 200 \"integer roulettedepth\" 12";
    let one = means(&picture(AHEAD, &format!("\"path\" {depth}"), &lit(&walked), 2048));
    let other = means(&picture(AHEAD, &format!("\"volpath\" {depth}"), &(medium + &lit(explicit)), 2048));
    let (bias, error) = difference(&one, &other);
    assert!(bias.abs() < 0.01 && error < 0.05, "{bias}, {error}");

    // Behind smooth boundaries directions differ, but no share of an even sky does.
    let medium = format!("MakeNamedMedium \"wax\" \"string type\" \"homogeneous\" {stuff}\n");
    let smooth = |text: &str| text.replace("\"float roughness\" 0.25", "");
    let all = "\"integer maxdepth\" 10000 \"integer roulettedepth\" 1000";
    let ours =
        seen("0 0.4 5", &format!("\"path\" {all}"), &(SKY.to_owned() + &ball(&smooth(&walked))), 16_384);
    let world = SKY.to_owned() + &medium + &ball(&smooth(explicit));
    let theirs = seen("0 0.4 5", &format!("\"volpath\" {all}"), &world, 16_384);
    for (ours, theirs) in ours.into_iter().zip(theirs) {
        near(ours, theirs, 0.015, "smooth");
    }
}

#[test]
fn mean_free_paths_scale_with_the_scene() {
    let of = |scale: f64, mfp: f64| {
        let material = format!(
            "Material \"subsurface\" \"rgb reflectance\" [0.8 0.6 0.4] \"rgb mfp\" [{mfp} {mfp} {mfp}] \
             \"float roughness\" 0.2"
        );
        let view = format!(
            "LookAt 0 {} {}  0 {} 0  0 1 0\nCamera \"perspective\" \"float fov\" 40",
            2.0 * scale,
            -6.0 * scale,
            0.6 * scale
        );
        let world = format!("Scale {scale} {scale} {scale}\n{}", lit(&material));
        means(&picture(&view, "\"path\"", &world, 128))
    };
    let small = of(1.0, 0.3);
    let (bias, error) = difference(&small, &of(8.0, 2.4));
    assert!(bias.abs() < 1e-3 && error < 5e-3, "{bias}, {error}");
    // Light gets further, and the ball does not stay as it is.
    assert!(difference(&small, &of(1.0, 0.02)).1 > 0.03);
}

#[test]
fn lights_without_extent_shine_on_smooth_bodies() {
    let lamp = "LightSource \"point\" \"point3 from\" [0 3 2] \"rgb I\" [20 20 20]\n";
    let body = "Material \"subsurface\" \"rgb reflectance\" [0.8 0.8 0.8] \"rgb mfp\" [0.1 0.1 0.1]";
    let lit = seen("0 0.4 5", "\"path\"", &(lamp.to_owned() + &ball(body)), 1024);
    // About as a matte ball is: of a half-space's light 0.8 of 0.92 leaves, in all directions.
    let matte = "Material \"diffuse\" \"rgb reflectance\" [0.75 0.75 0.75]";
    let matte = seen("0 0.4 5", "\"path\"", &(lamp.to_owned() + &ball(matte)), 16);
    assert!((0.6..1.2).contains(&(lit[1] / matte[1])), "{lit:?}, matte {matte:?}");
}

#[test]
fn wavelengths_see_what_colours_see_of_what_is_grey() {
    let wax = "Material \"subsurface\" \"rgb reflectance\" [0.6 0.6 0.6] \"rgb mfp\" [0.2 0.2 0.2]";
    let of = |film: &str| {
        let text = format!(
            "Film \"{film}\" \"integer xresolution\" 12 \"integer yresolution\" 8\n{AHEAD}\nIntegrator \"path\"\n\
             WorldBegin\n{}",
            lit(wax)
        );
        total(&means(&scene(&text, &Options { samples: Some(512), ..Options::default() })))
    };
    let (rgb, spectral) = (of("rgb"), of("spectral"));
    assert!((spectral / rgb - 1.0).abs() < 0.01, "{rgb} {spectral}");
}

fn jade(threads: usize) -> Prepared {
    let material =
        "Material \"subsurface\" \"string name\" \"Skin1\" \"float scale\" 10 \"float roughness\" 0.1";
    let text = format!(
        "Film \"rgb\" \"integer xresolution\" 24 \"integer yresolution\" 16\n{AHEAD}\nIntegrator \"path\"\nWorldBegin\n{}",
        lit(material)
    );
    scene(&text, &Options { samples: Some(16), threads: Some(threads), ..Options::default() })
}

#[test]
fn threads_change_no_bit() {
    assert_eq!(bits(&render(&jade(1))), bits(&render(&jade(3))));
}

#[test]
fn principled_bodies_walk_too() {
    let wax = "\"rgb mfp\" [0.3 0.1 0.05] \"rgb reflectance\" [0.8 0.5 0.3] \"float eta\" 1.5 \"float roughness\" 0.04";
    let own = means(&picture(AHEAD, DEEP, &lit(&format!("Material \"subsurface\" {wax}")), 512));
    let principled = "Material \"principled\" \"float subsurface\" 1 \"rgb subsurfaceradius\" [0.3 0.1 0.05] \
                      \"rgb subsurfacecolor\" [0.8 0.5 0.3] \"rgb basecolor\" [0 0 0] \"float roughness\" 0.447214";
    let other = means(&picture(AHEAD, DEEP, &lit(principled), 512));
    let (bias, error) = difference(&own, &other);
    assert!(bias.abs() < 1e-3 && error < 1e-2, "{bias}, {error}");
    // Half of it is matte, and nothing comes of nothing.
    let half = "Material \"principled\" \"float subsurface\" 0.5 \"rgb basecolor\" [1 1 1] \"float roughness\" 0 \
                \"rgb subsurfaceradius\" [0.2 0.2 0.2]";
    let [found, ..] = seen("0 0.4 5", DEEP, &(SKY.to_owned() + &ball(half)), 2048);
    near(found, 1.0, 0.02, "half");
}

#[test]
fn who_does_not_walk_says_so_and_sees_matte_bodies() {
    let world = "MakeNamedMaterial \"wax\" \"string type\" \"subsurface\" \"rgb reflectance\" [0.5 0.5 0.5] \
                 \"rgb mfp\" [0.01 0.01 0.01]\nNamedMaterial \"wax\"\n";
    for (word, says) in
        [("whitted", true), ("sppm", true), ("direct", true), ("path", false), ("volpath", false)]
    {
        let mut imported =
            import(&format!("Integrator \"{word}\"\nWorldBegin\n{SKY}{world}{}", half_space("")));
        durer::prepare(&mut imported, &Options::default()).expect("a scene");
        let said = imported.diagnostics.iter().any(|d| d.message.contains("material \"wax\" is drawn as"));
        assert_eq!(said, says, "{word}");
    }
    // As bright as what walks, but for how that depends on the view.
    let of = |word: &str| seen("0 0 1", word, &(SKY.to_owned() + world + &half_space("")), 4096)[1];
    let (walked, matte) = (of(DEEP), of("\"direct\" \"integer maxdepth\" 20"));
    near(matte, walked, 0.04, "matte");
}

#[test]
fn what_is_said_twice_or_half_is_refused() {
    for (params, message) in [
        ("\"rgb sigma_a\" [1 1 1]", "\"sigma_a\" needs \"sigma_s\" beside it"),
        (
            "\"rgb sigma_a\" [1 1 1] \"rgb sigma_s\" [1 1 1] \"rgb reflectance\" [1 1 1]",
            "both say what is below the surface",
        ),
        ("\"string name\" \"Skin3\"", "measured stuff \"Skin3\""),
    ] {
        let mut imported =
            import(&format!("WorldBegin\n{SKY}Material \"subsurface\" {params} {}", half_space("")));
        assert!(durer::prepare(&mut imported, &Options::default()).is_none(), "{params}");
        let said: Vec<_> = imported.diagnostics.iter().map(|d| d.message.as_str()).collect();
        assert!(said.iter().any(|m| m.contains(message)), "{params}: {said:?}");
    }
}
