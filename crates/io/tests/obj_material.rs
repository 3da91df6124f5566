//! MTL: which files are found, and which material of ours each material becomes.
#[path = "mesh_scene/mod.rs"]
mod mesh_scene;

use durer_io::import::Imported;
use durer_scene::{Data, NamedNode, Severity};
use mesh_scene::{assert_silent, floats, import, material, said};

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n";

fn with(mtl: &str) -> Imported {
    let obj = format!("mtllib a.mtl\n{TRIANGLE}usemtl m\nf 1/1 2/2 3/3\n");
    import(&[
        ("a.obj", obj.as_bytes()),
        ("a.mtl", format!("newmtl m\n{mtl}").as_bytes()),
        ("dot.png", &png([200; 3])),
    ])
}

/// An image of one pixel.
fn png([r, g, b]: [u8; 3]) -> Vec<u8> {
    let folder = tempfile::tempdir().expect("folder");
    let path = folder.path().join("dot.png");
    durer_io::image::write_png(&path, 1, 1, &[r, g, b]).expect("written");
    std::fs::read(path).expect("there")
}

fn word<'n>(node: &'n NamedNode, name: &str) -> Option<&'n str> {
    match &node.node.params.get(name)?.data {
        Data::Strings(words) => words.first().map(String::as_str),
        other => panic!("{name} is {other:?}"),
    }
}

fn near(found: &[f32], expected: &[f32]) {
    let close = |(a, b): (&f32, &f32)| (a - b).abs() < 1e-4;
    assert!(
        found.len() == expected.len() && found.iter().zip(expected).all(close),
        "{found:?}, not {expected:?}"
    );
}

#[test]
fn matte_and_shiny_become_principled() {
    let scene = with("Kd 0.5 0.25 0\nKs 0 0 0\nNs 100\nillum 2\n");
    assert_silent(&scene);
    let m = material(&scene, 0);
    assert_eq!((m.name.as_str(), m.node.kind.as_str()), ("m", "principled"));
    near(&floats(m, "basecolor"), &[0.5, 0.25, 0.0]);
    near(&floats(m, "eta"), &[1.0]);
    // (2 / 102)^(1/4)
    near(&floats(m, "roughness"), &[0.374_2]);
    // f0 = 0.08 * 0.5 = 0.04: glass of 1.5.
    near(&floats(material(&with("Ks 0.5 0.5 0.5\nillum 2\n"), 0), "eta"), &[1.5]);
    near(&floats(material(&with("Ks 0.5 0.5 0.5\nillum 1\n"), 0), "eta"), &[1.0]);
    let scene = with("Pr 0.3\nPm 1\nNi 1.33\n");
    let modern = material(&scene, 0);
    near(&floats(modern, "roughness"), &[0.3]);
    near(&floats(modern, "metallic"), &[1.0]);
    near(&floats(modern, "eta"), &[1.33]);
}

#[test]
fn illumination_models_mirror_and_refract() {
    for (mtl, kind) in [
        ("Kd 0 0 0\nKs 0.9 0.8 0.7\nillum 3\n", "mirror"),
        ("Kd 0.5 0 0\nKs 0.3 0.3 0.3\nillum 5\n", "classic"),
        ("Kd 0.5 0 0\nKs 0.3 0.3 0.3\nPm 1\nillum 3\n", "principled"),
        ("Kd 0 0 0\nNi 1.5\nillum 7\n", "dielectric"),
        ("Kd 0.8 0 0\nNi 1.5\nd 0.2\nillum 6\n", "classic"),
        ("Kd 0.8 0 0\nNi 1.5\nd 0\nillum 4\n", "dielectric"),
        // What Maya writes for everything.
        ("Kd 0.5 0.5 0.5\nTf 1 1 1\nNi 1\nillum 4\n", "principled"),
    ] {
        let scene = with(mtl);
        assert_silent(&scene);
        assert_eq!(material(&scene, 0).node.kind, kind, "{mtl}");
    }
    let scene = with("Kd 0 0 0\nKs 0.9 0.8 0.7\nillum 3\n");
    near(&floats(material(&scene, 0), "reflectance"), &[0.9, 0.8, 0.7]);
}

#[test]
fn thin_surfaces_blend_by_d_or_tr() {
    for (mtl, alpha) in [("d 0.25\n", 0.25), ("Tr 0.25\n", 0.75), ("d 0.25\nTr 0.5\n", 0.25), ("d 0\n", 0.0)]
    {
        let scene = with(mtl);
        let m = material(&scene, 0);
        near(&floats(m, "alpha"), &[alpha]);
        assert_eq!(word(m, "alphamode"), Some("blend"));
    }
    assert!(material(&with("Tr 1\n"), 0).node.params.get("alpha").is_none(), "MeshLab's opaque");
}

#[test]
fn emission_is_radiance() {
    near(&floats(material(&with("Ke 36 33 24\nillum 3\nKs 1 1 1\n"), 0), "emission"), &[36.0, 33.0, 24.0]);
}

#[test]
fn images_have_options_and_factors() {
    let scene = with("Kd 0.5 0.5 0.5\nmap_Kd -clamp on -s 2 3 1 -o 0.25 -blendu on dot.png\nmap_d dot.png\n");
    assert_silent(&scene);
    let (color, opacity) = (&scene.desc.textures[0], &scene.desc.textures[1]);
    assert_eq!(word(material(&scene, 0), "basecolor"), Some(color.name.as_str()));
    assert_eq!(word(material(&scene, 0), "alpha"), Some(opacity.name.as_str()));
    let number = |name: &str| match &color.node.params.get(name).expect(name).data {
        Data::Floats(v) => v.clone(),
        other => panic!("{other:?}"),
    };
    assert_eq!(number("factor"), [0.5; 3]);
    assert_eq!([number("uscale"), number("vscale"), number("udelta")], [[2.0], [3.0], [0.25]]);
    assert!(color.node.params.get("wrap").is_some());
    assert!(opacity.node.params.get("channel").is_some());
    let black = with("Kd 0 0 0\nmap_Kd dot.png\n");
    assert!(black.desc.textures[0].node.params.get("factor").is_none(), "a black factor is a slip");
}

#[test]
fn a_bump_image_is_used_if_it_is_a_normal_map() {
    let obj = format!("mtllib a.mtl\n{TRIANGLE}usemtl m\nf 1/1 2/2 3/3\n");
    let scene = |pixel: [u8; 3]| {
        import(&[
            ("a.obj", obj.as_bytes()),
            ("a.mtl", b"newmtl m\nmap_Bump -bm 0.5 n.png\n"),
            ("n.png", &png(pixel)),
        ])
    };
    let map = scene([128, 128, 255]);
    assert_silent(&map);
    near(&floats(material(&map, 0), "normalscale"), &[0.5]);
    let heights = scene([90, 90, 90]);
    assert!(material(&heights, 0).node.params.get("normal").is_none());
    assert!(said(&heights, Severity::Warning)[0].contains("n.png holds heights"));
}

#[test]
fn images_are_found_beside_the_mtl_file_and_by_their_last_name() {
    let obj = format!("mtllib materials\\a.mtl\n{TRIANGLE}usemtl m\nf 1/1 2/2 3/3\n");
    for (path, file) in [
        ("images\\dot.png", "materials/images/dot.png"),
        ("C:\\Users\\me\\models\\dot.png", "materials/dot.png"),
        ("/models/dot.png", "dot.png"),
        ("my dot.png", "materials/my dot.png"),
    ] {
        let mtl = format!("newmtl m\nmap_Kd {path}\n");
        let image = png([1, 2, 3]);
        let scene = import(&[("a.obj", obj.as_bytes()), ("materials/a.mtl", mtl.as_bytes()), (file, &image)]);
        assert_silent(&scene);
        assert_eq!(scene.desc.textures.len(), 1, "{path}");
    }
    let scene = import(&[("a.obj", obj.as_bytes()), ("materials/a.mtl", b"newmtl m\nmap_Kd ../../x.png\n")]);
    assert!(said(&scene, Severity::Warning)[0].contains(
        "leads out of the scene's folder (for safety only files below it are read); drawn without"
    ));
}

#[test]
fn several_files_and_missing_ones() {
    let obj = format!(
        "mtllib b.mtl c d.mtl gone.mtl\n{TRIANGLE}usemtl red\nf 1 2 3\nusemtl c d\nf 1 3 2\nusemtl rde\nf 2 3 1\n"
    );
    let scene = import(&[
        ("a.obj", obj.as_bytes()),
        ("b.mtl", b"newmtl red\nKd 1 0 0\nnewmtl unused\nmap_Kd gone.png\n"),
        ("c d.mtl", b"newmtl c d\nKd 0 0 1\nnewmtl red\nKd 0 1 0\n"),
    ]);
    near(&floats(material(&scene, 0), "basecolor"), &[1.0, 0.0, 0.0]);
    near(&floats(material(&scene, 1), "basecolor"), &[0.0, 0.0, 1.0]);
    assert_eq!(scene.desc.shapes[2].material, None);
    let expected = [
        "1:8: gone.mtl: file not found; its materials are drawn in grey",
        "12:8: there is no material \"rde\"; drawn in grey",
    ];
    assert_eq!(said(&scene, Severity::Warning), expected);
    let hints: Vec<_> = scene.diagnostics.iter().filter_map(|d| d.hint.as_deref()).collect();
    assert_eq!(hints, ["did you mean \"red\"?"]);
}

#[test]
fn a_file_of_the_models_own_name_stands_in_for_a_missing_one() {
    let obj = format!("mtllib other.mtl\n{TRIANGLE}usemtl m\nf 1 2 3\n");
    let scene = import(&[("a.obj", obj.as_bytes()), ("a.mtl", b"newmtl m\nKd 1 0 0\n")]);
    assert_eq!(said(&scene, Severity::Warning), ["1:8: other.mtl is not there; a.mtl is read instead"]);
    near(&floats(material(&scene, 0), "basecolor"), &[1.0, 0.0, 0.0]);
}

#[test]
fn wrong_lines_are_told_in_the_mtl_file() {
    let scene = with("Kd 1 x 0\nKs\nNs nan\nmpa_Kd dot.png\nrefl a.png\nrefl a.png\nd -halo 0.5\n");
    let expected = [
        "2:6: \"x\" is not a number",
        "3:1: a colour is missing",
        "4:4: \"nan\" is not a number",
        "5:1: unknown word \"mpa_Kd\"; its lines are skipped; did you mean \"map_Kd\"?",
        "6:1: refl is not supported yet; drawn without it",
        "8:3: -halo is not supported: the surface is as opaque everywhere",
    ];
    assert_eq!(said(&scene, Severity::Warning), expected);
    assert!(said(&scene, Severity::Error).is_empty());
}

#[test]
fn lines_that_name_thousands_of_material_files_are_cut_off() {
    let words: Vec<String> = (0..5000).map(|i| format!("m{i}")).collect();
    let lines: String = words.iter().map(|w| format!("mtllib {w}.mtl\n")).collect();
    for head in [format!("mtllib {}\n", words.join(" ")), lines] {
        let scene = import(&[("a.obj", format!("{head}{TRIANGLE}f 1 2 3\n").as_bytes())]);
        assert_eq!(scene.desc.shapes.len(), 1);
        let warnings = said(&scene, Severity::Warning);
        assert!(warnings.len() <= 65, "{} warnings", warnings.len());
        let last = "so many material files are named that only the first 64 are looked for";
        assert!(warnings.last().is_some_and(|w| w.ends_with(last)), "{warnings:?}");
    }
}

#[test]
fn words_of_mtl_may_be_in_any_letter_case() {
    let scene = with("KD 0.5 0.25 0\nNS 100\nILLUM 2\nMAP_KE dot.png\n");
    assert_silent(&scene);
    near(&floats(material(&scene, 0), "basecolor"), &[0.5, 0.25, 0.0]);
    assert_eq!(scene.desc.textures.len(), 1);
}

#[test]
fn files_are_found_whose_names_differ_in_letter_case() {
    let obj = format!("mtllib Sub/A.MTL\n{TRIANGLE}usemtl m\nf 1/1 2/2 3/3\n");
    let files: [(&str, &[u8]); 3] = [
        ("a.obj", obj.as_bytes()),
        ("Sub/a.mtl", b"newmtl m\nmap_Kd textures\\DOT.PNG\n"),
        ("Sub/textures/Dot.png", &png([200; 3])),
    ];
    let scene = import(&files);
    assert_eq!(said(&scene, Severity::Warning), ["1:8: Sub/A.MTL is not there; Sub/a.mtl is read instead"]);
    assert_eq!(word(&scene_texture(&scene), "filename"), Some("Sub/textures/Dot.png"));
}

fn scene_texture(scene: &Imported) -> NamedNode {
    let texture = scene.desc.textures.first().expect("a texture");
    NamedNode { name: texture.name.clone(), node: texture.node.clone() }
}

#[test]
fn what_is_invisible_is_told_but_glass_and_cut_outs_are_not() {
    let told = said(&with("Kd 1 0 0\nd 0\n"), Severity::Warning);
    assert_eq!(told.len(), 1);
    assert!(
        told[0].ends_with("material m is fully transparent (d 0): nothing of it will be seen"),
        "{told:?}"
    );
    for mtl in ["d 0\nNi 1.5\nillum 7\n", "d 0\nmap_d dot.png\n", "d 0.01\n", "Tr 1\n"] {
        assert_silent(&with(mtl));
    }
}

#[test]
fn many_missing_images_are_told_in_a_few_lines() {
    let names = (0..500).map(|i| format!("newmtl m{i}\nmap_Kd t{i}.png\n")).collect::<String>();
    let faces = (0..500).map(|i| format!("usemtl m{i}\nf 1/1 2/2 3/3\n")).collect::<String>();
    let obj = format!("mtllib a.mtl\n{TRIANGLE}{faces}");
    let told = said(&import(&[("a.obj", obj.as_bytes()), ("a.mtl", names.as_bytes())]), Severity::Warning);
    assert_eq!(told.len(), 17);
    assert!(told[16].ends_with("484 more images cannot be used; drawn without them"), "{told:?}");
}
