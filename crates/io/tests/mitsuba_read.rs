//! Mitsuba's XML, piece by piece: what is read of it, and what is said of what is wrong.
#![allow(clippy::expect_used, clippy::indexing_slicing, reason = "a test that fails may panic")]
mod mitsuba_scene;

use durer_core::glam::DVec3;
use durer_io::import::{Imported, Reading};
use durer_scene::{Crop, Data, Limits, Severity, ShapeSource};
use mitsuba_scene::{errors, material, scene, text, told};

#[test]
fn unknown_words_are_told_with_their_place_and_the_nearest_one() {
    assert_eq!(
        errors("<shape type=\"spere\"/>"),
        ["2:14: unknown shape \"spere\" (did you mean \"sphere\"?)"]
    );
    let wrong = "<shape type=\"sphere\"><float name=\"radios\" value=\"2\"/></shape>";
    assert_eq!(
        errors(wrong),
        ["2:50: unknown parameter of shape \"sphere\" \"radios\" (did you mean \"radius\"?)"]
    );
    assert_eq!(
        errors("<shap type=\"sphere\"/>"),
        ["2:1: unknown element \"shap\" (did you mean \"shape\"?)"]
    );
    assert_eq!(
        errors("<shape type=\"sphere\" nmae=\"x\"/>"),
        ["2:22: unknown attribute of <shape> \"nmae\" (did you mean \"name\"?)"]
    );
    let glass = "<bsdf type=\"dielectric\"><string name=\"int_ior\" value=\"wader\"/></bsdf>";
    assert_eq!(errors(glass), ["2:55: unknown substance \"wader\" (did you mean \"water\"?)"]);
}

#[test]
fn values_that_are_none_are_told() {
    let radius = |value: &str| {
        errors(&format!("<shape type=\"sphere\"><float name=\"radius\" value=\"{value}\"/></shape>"))
    };
    assert_eq!(radius("two"), ["2:50: expected a number, found \"two\""]);
    assert_eq!(radius("1e999"), ["2:50: expected a number, found \"1e999\""]);
    assert_eq!(radius("-1"), ["2:50: \"radius\" is -1, expected a number above 0"]);
    let wrong = "<shape type=\"sphere\"><string name=\"radius\" value=\"1\"/></shape>";
    assert_eq!(errors(wrong), ["2:51: \"radius\" is a string, expected a number"]);
    let flat = "<shape type=\"sphere\"><transform name=\"to_world\"><scale value=\"0\"/></transform></shape>";
    assert_eq!(errors(flat), ["2:22: this transform makes everything flat"]);
    assert_eq!(errors("<shape/>"), ["2:1: <shape> has no attribute \"type\""]);
    assert_eq!(
        errors("<float name=\"x\" value=\"1\"/>"),
        ["2:1: <float> stands for itself: it belongs in an object"]
    );
}

#[test]
fn names_stand_for_values_and_the_users_go_first() {
    let inside = "<default name=\"r\" value=\"2\"/><shape type=\"sphere\"><float name=\"radius\" value=\"$r\"/></shape>";
    let radius = |imported: Imported| match &imported.desc.shapes[0].source {
        ShapeSource::Node(node) => match node.params.get("radius").map(|p| &p.data) {
            Some(Data::Floats(v)) => v[0],
            _ => panic!("{node:?}"),
        },
        ShapeSource::Mesh(_) => panic!("a mesh"),
    };
    assert_eq!(radius(scene(inside)), 2.0);
    let reading = Reading { definitions: vec![("r".to_owned(), "5".to_owned())], ..Reading::default() };
    assert_eq!(radius(text(&format!("<scene version='3.0.0'>{inside}</scene>"), reading)), 5.0);
    let missing = inside.replace("$r", "$s");
    assert_eq!(errors(&missing), ["2:79: unknown value \"$s\" (valid: r)"]);
}

#[test]
fn references_are_found_wherever_they_stand() {
    let shape = "<shape type=\"sphere\"><ref id=\"red\"/></shape>";
    let red = "<bsdf type=\"diffuse\" id=\"red\"><rgb name=\"reflectance\" value=\"1 0 0\"/></bsdf>";
    for inside in [format!("{shape}{red}"), format!("{red}{shape}")] {
        let imported = scene(&inside);
        assert_eq!(told(&imported, Severity::Error), Vec::<String>::new());
        assert_eq!(material(&imported, "reflectance"), [1.0, 0.0, 0.0]);
        assert_eq!(imported.desc.materials.len(), 2, "one material and its sides");
    }
    assert_eq!(
        errors(&shape.replace("red", "rad"))[0],
        "2:22: unknown id \"rad\" (the scene defines no ids)"
    );
    let alias = format!("{red}<alias id=\"red\" as=\"rouge\"/>{}", shape.replace("red", "rouge"));
    assert_eq!(errors(&alias), Vec::<String>::new());
}

#[test]
fn what_contains_itself_is_told() {
    let knot = "<bsdf type=\"twosided\" id=\"a\"><ref id=\"a\"/></bsdf>";
    assert!(errors(knot)[0].contains("is in itself"), "{:?}", errors(knot));
    let group = "<shape type=\"shapegroup\" id=\"g\"><shape type=\"instance\"><ref id=\"g\"/></shape></shape>\
                 <shape type=\"instance\"><ref id=\"g\"/></shape>";
    assert!(errors(group)[0].contains("is in itself"), "{:?}", errors(group));
    assert!(errors("<include filename=\"loop.xml\"/>")[0].contains("includes itself"));
    let deep = "<bsdf type=\"twosided\">".repeat(400) + &"</bsdf>".repeat(400);
    assert!(errors(&deep)[0].contains("deep"), "{:?}", errors(&deep)[0]);
}

#[test]
fn xml_that_is_none_is_told_with_its_place() {
    let of = |whole: &str| told(&text(whole, Reading::default()), Severity::Error);
    let wrong = of("<scene version=\"3.0.0\">\n  <shape type=\"sphere\">\n</scene>");
    assert!(wrong[0].starts_with("3:") && wrong[0].contains("no proper XML"), "{wrong:?}");
    let bomb =
        "<!DOCTYPE s [<!ENTITY a \"aaaa\"><!ENTITY b \"&a;&a;\">]><scene version=\"3.0.0\">&b;</scene>";
    assert!(of(bomb)[0].contains("DTD"), "{:?}", of(bomb));
    assert!(of("<scene version=\"3.0.0\"/>").is_empty());
    assert!(of("<scene/>")[0].contains("no version"));
    for end in 0..bomb.len() {
        drop(of(&bomb[..end]));
    }
}

#[test]
fn steps_of_a_transform_act_one_after_another() {
    let imported = scene(
        "<shape type=\"sphere\"><transform name=\"to_world\"><scale value=\"2\"/><translate x=\"1\"/>\
         <rotate z=\"1\" angle=\"90\"/></transform></shape>",
    );
    let placed = imported.desc.shapes[0].world_from_object.at(0.0);
    // (1, 0, 0) -> (2, 0, 0) -> (3, 0, 0) -> (0, 3, 0)
    assert!(placed.transform_point3(DVec3::X).abs_diff_eq(DVec3::new(0.0, 3.0, 0.0), 1e-12));
}

#[test]
fn cameras_have_x_to_the_right_of_what_they_look_at() {
    let imported = scene(
        "<sensor type=\"perspective\"><transform name=\"to_world\"><lookat origin=\"0, 0, -5\" target=\"0, 0, 0\" \
         up=\"0, 1, 0\"/></transform></sensor>",
    );
    let placed = imported.desc.cameras[0].world_from_camera.at(0.0);
    // Seen from -z with y up, the world's +x is to the left in right-handed space.
    assert_eq!(placed.transform_vector3(DVec3::X), DVec3::NEG_X);
    assert_eq!(placed.transform_vector3(DVec3::Z), DVec3::Z);
    assert_eq!((imported.desc.film.width, imported.desc.film.height), (Some(768), Some(576)));
}

#[test]
fn spectra_are_numbers_pairs_or_files() {
    let of = |spectrum: &str| {
        let imported = scene(&format!("<bsdf type=\"diffuse\">{spectrum}</bsdf>"));
        assert_eq!(told(&imported, Severity::Error), Vec::<String>::new());
        material(&imported, "reflectance")
    };
    assert_eq!(of("<spectrum name=\"reflectance\" value=\"0.25\"/>"), [0.25; 3]);
    assert_eq!(of("<spectrum name=\"reflectance\" value=\"400:0.25, 700:0.5\"/>"), [400.0, 0.25, 700.0, 0.5]);
    assert_eq!(of("<spectrum name=\"reflectance\" filename=\"a.spd\"/>"), [400.0, 0.25, 700.0, 0.5]);
    assert_eq!(of("<rgb name=\"reflectance\" value=\"#ff0000\"/>"), [1.0, 0.0, 0.0]);
    let falling = "<bsdf type=\"diffuse\"><spectrum name=\"reflectance\" value=\"700:1, 400:1\"/></bsdf>";
    assert!(errors(falling)[0].contains("must rise"), "{:?}", errors(falling));
}

#[test]
fn files_of_mitsuba_0_are_renamed_and_that_is_noted() {
    let old = "<scene version=\"0.5.0\"><integrator type=\"path\"><integer name=\"maxDepth\" value=\"4\"/></integrator>\
               <shape type=\"sphere\"><transform name=\"toWorld\"><translate x=\"1\"/></transform></shape></scene>";
    let imported = text(old, Reading::default());
    assert_eq!(told(&imported, Severity::Error), Vec::<String>::new());
    assert!(told(&imported, Severity::Note)[0].contains("Mitsuba 0.5.0"));
    let node = imported.desc.integrator.expect("paths");
    assert_eq!(node.params.get("maxdepth").map(|p| p.data.clone()), Some(Data::Ints(vec![3])));
    assert_eq!(imported.desc.shapes[0].world_from_object.at(0.0).translation, DVec3::X);
}

#[test]
fn meshes_without_normals_are_smooth_unless_their_faces_are_flat() {
    let of = |more: &str| {
        let file = "<string name=\"filename\" value=\"triangle.obj\"/>";
        let imported = scene(&format!("<shape type=\"obj\">{file}{more}</shape>"));
        assert_eq!(told(&imported, Severity::Error), Vec::<String>::new());
        imported.desc.meshes[0].clone()
    };
    assert_eq!(of("").normals.len(), 3);
    assert!(of("<boolean name=\"face_normals\" value=\"true\"/>").normals.is_empty());
    assert_eq!(of("").uvs[2].y, 1.0);
    assert_eq!(of("<boolean name=\"flip_tex_coords\" value=\"false\"/>").uvs[2].y, 0.0);
}

#[test]
fn plastic_is_linear_unless_it_is_told_otherwise() {
    let of = |more: &str| {
        let color =
            "<rgb name=\"diffuse_reflectance\" value=\"0.5, 0, 1\"/><float name=\"int_ior\" value=\"1.5\"/>";
        let read = scene(&format!("<bsdf type=\"plastic\">{color}{more}</bsdf>"));
        assert_eq!(told(&read, Severity::Warning), Vec::<String>::new());
        assert_eq!(material(&read, "reflectance"), [0.5, 0.0, 1.0]);
        let of = read.desc.materials.iter().find(|m| m.node.kind == "coateddiffuse").expect("plastic");
        match of.node.params.get("nonlinear").map(|p| &p.data) {
            Some(Data::Bools(v)) => (v.clone(), read),
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(of("").0, [false]);
    assert_eq!(of("<boolean name=\"nonlinear\" value=\"true\"/>").0, [true]);
    let dimmed = of("<rgb name=\"specular_reflectance\" value=\"0.1, 0.2, 0.3\"/>").1;
    assert_eq!(material(&dimmed, "reflection"), [0.1, 0.2, 0.3]);
}

/// Text of a parameter of the last material that is no `sides`.
fn word(imported: &Imported, name: &str) -> Vec<String> {
    let of = imported.desc.materials.iter().rev().find(|m| m.node.kind != "sides").expect("a material");
    match of.node.params.get(name).map(|p| &p.data) {
        Some(Data::Strings(v)) => v.clone(),
        other => panic!("{name}: {other:?} of {:?}", of.node),
    }
}

#[test]
fn facets_are_beckmanns_unless_the_scene_says_otherwise() {
    for plugin in ["roughconductor", "roughdielectric", "roughplastic"] {
        let of = |more: &str| {
            let read =
                scene(&format!("<bsdf type=\"{plugin}\"><float name=\"alpha\" value=\"0.3\"/>{more}</bsdf>"));
            assert_eq!(told(&read, Severity::Warning), Vec::<String>::new(), "{plugin}");
            assert_eq!(material(&read, "roughness"), [0.3]);
            word(&read, "distribution")
        };
        assert_eq!(of(""), ["beckmann"]);
        assert_eq!(of("<string name=\"distribution\" value=\"beckmann\"/>"), ["beckmann"]);
        assert_eq!(of("<string name=\"distribution\" value=\"ggx\"/>"), ["ggx"]);
    }
    assert!(
        errors("<bsdf type=\"roughconductor\"><string name=\"distribution\" value=\"gxx\"/></bsdf>")[0]
            .contains("gxx")
    );
}

#[test]
fn disneys_materials_keep_all_that_they_say() {
    let float = |name: &str, value: f32| format!("<float name=\"{name}\" value=\"{value}\"/>");
    let names = [
        ("roughness", "roughness"),
        ("anisotropic", "anisotropic"),
        ("spec_trans", "spectrans"),
        ("spec_tint", "speculartint"),
        ("sheen", "sheen"),
        ("sheen_tint", "sheentint"),
        ("flatness", "flatness"),
    ];
    let solid = [("metallic", "metallic"), ("clearcoat", "clearcoat"), ("clearcoat_gloss", "clearcoatgloss")];
    let check = |plugin: &str, own: &[(&str, &str)]| {
        let all: Vec<_> =
            names.iter().chain(own).enumerate().map(|(i, n)| (n, 0.05 + 0.1 * i as f32)).collect();
        let text: String = all.iter().map(|((theirs, _), v)| float(theirs, *v)).collect();
        let read = scene(&format!("<bsdf type=\"{plugin}\">{text}</bsdf>"));
        assert_eq!(told(&read, Severity::Warning), Vec::<String>::new(), "{plugin}");
        for ((_, ours), v) in all {
            assert_eq!(material(&read, ours), [v], "{ours}");
        }
        material(&read, "eta")[0]
    };
    // Half of the 8 % that a specular of 1 reflects at normal incidence.
    let eta = check("principled", &solid);
    assert!((((eta - 1.0) / (eta + 1.0)).powi(2) - 0.04).abs() < 1e-6, "{eta}");
    assert_eq!(check("principledthin", &[("diff_trans", "difftrans")]), 1.5);
    let of = |more: &str| material(&scene(&format!("<bsdf type=\"principled\">{more}</bsdf>")), "eta")[0];
    assert_eq!(of(&float("eta", 1.3)), 1.3);
    assert_eq!(of(&(float("eta", 1.0) + &float("spec_trans", 0.5))), 1.001);
    let both = format!("<bsdf type=\"principled\">{}{}</bsdf>", float("eta", 1.3), float("specular", 0.5));
    assert!(errors(&both)[0].contains("only one"));
}

#[test]
fn factors_on_what_is_mirrored_and_let_through_are_kept() {
    let color = |name: &str, v: f32| format!("<rgb name=\"{name}\" value=\"{v}, 0.5, 1\"/>");
    for plugin in ["dielectric", "roughdielectric"] {
        let (r, t) = (color("specular_reflectance", 0.1), color("specular_transmittance", 0.2));
        let read = scene(&format!("<bsdf type=\"{plugin}\">{r}{t}</bsdf>"));
        assert_eq!(told(&read, Severity::Warning), Vec::<String>::new());
        assert_eq!(material(&read, "reflection"), [0.1, 0.5, 1.0]);
        assert_eq!(material(&read, "transmission"), [0.2, 0.5, 1.0]);
    }
    let read = scene(&format!("<bsdf type=\"conductor\">{}</bsdf>", color("specular_reflectance", 0.1)));
    assert_eq!(material(&read, "reflection"), [0.1, 0.5, 1.0]);
}

#[test]
fn checkerboards_of_numbers_begin_with_the_second_one() {
    let of = |name: &str, value: durer_scene::TextureValue| {
        let board = "<float name=\"color0\" value=\"0.1\"/><float name=\"color1\" value=\"0.7\"/>";
        let read = scene(&format!(
            "<bsdf type=\"roughdielectric\"><texture type=\"checkerboard\" name=\"alpha\">{board}</texture></bsdf>\
             <bsdf type=\"diffuse\"><texture type=\"checkerboard\" name=\"reflectance\">{board}</texture></bsdf>"
        ));
        let texture = read.desc.textures.iter().find(|t| t.value == value).expect("a texture");
        match &texture.node.params.get(name).expect("given").data {
            Data::Floats(v) => v[0],
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(of("tex1", durer_scene::TextureValue::Color), 0.1);
    assert_eq!(of("tex1", durer_scene::TextureValue::Float), 0.7);
}

#[test]
fn small_limits_are_kept() {
    let limits = Limits { file_bytes: 20, ..Limits::default() };
    let imported = text("<scene version=\"3.0.0\"><shape type=\"sphere\"/></scene>", limits.into());
    assert!(imported.diagnostics.has_errors());
}

#[test]
fn films_are_cropped() {
    let of = |words: &str| {
        scene(&format!(
            "<sensor type=\"perspective\"><film type=\"hdrfilm\"><integer name=\"width\" value=\"8\"/>\
             <integer name=\"height\" value=\"6\"/>{words}</film></sensor>"
        ))
    };
    let crop = |name: &str, value: u32| format!("<integer name=\"crop_{name}\" value=\"{value}\"/>");
    let part = of(&[crop("offset_x", 2), crop("width", 5), crop("offset_y", 1)].concat());
    assert_eq!(told(&part, Severity::Error), Vec::<String>::new());
    assert_eq!(part.desc.film.crop, Some(Crop::Pixels([2, 7, 1, 6])));
    assert_eq!(of(&crop("width", 8)).desc.film.crop, None);
    let outside = told(&of(&(crop("offset_x", 4) + &crop("width", 5))), Severity::Error);
    assert_eq!(outside.len(), 1);
    assert!(outside[0].contains("a part of 5 x 6 pixels from 4, 0 on is not within 8 x 6"), "{outside:?}");
}
