//! Documents of ray trees: every format is read back by a reader that is not ours where there is one, and a document that
//! went through JSON is written to the same files.
use std::{io::Read, sync::OnceLock};

use durer::{
    Options, Prepared, builtin, import,
    probe::Detail,
    scene::Limits,
    tree::{Format, Page, Subject, Surroundings, Tree, plain},
};
use durer_tests::{prepared, scene};

fn whitted() -> &'static Prepared {
    static SCENE: OnceLock<Prepared> = OnceLock::new();
    SCENE.get_or_init(|| {
        let options = Options { width: Some(96), samples: Some(4), ..Options::default() };
        prepared(builtin::find("whitted").expect("built in").import(), &options)
    })
}

fn page(prepared: &Prepared, pixel: [u32; 2]) -> Page {
    let subject = Subject { name: "whitted", prepared };
    let detail = Detail { walks: 3, ..Detail::default() };
    subject.page(pixel, &[0], Surroundings::SceneAndSamples(10_000), detail)
}

fn ball() -> &'static Page {
    static PAGE: OnceLock<Page> = OnceLock::new();
    PAGE.get_or_init(|| page(whitted(), [55, 30]))
}

fn written(format: Format, page: &Page) -> Vec<u8> {
    format.write(page).expect("there is room")
}

fn text(format: Format, page: &Page) -> String {
    String::from_utf8(written(format, page)).expect("UTF-8")
}

/// The page with its first tree only.
fn first(page: &Page) -> Page {
    Page { trees: page.trees[..1].to_vec(), ..page.clone() }
}

#[test]
fn a_tree_that_went_through_json_is_the_same_and_folds_to_its_value() {
    for page in [ball(), &page(whitted(), [3, 2])] {
        let one = first(page);
        let json = text(Format::Json, &one);
        let back: Tree = serde_json::from_str(&json).expect("a tree");
        assert!(back == one.trees[0]);
        assert_eq!(serde_json::to_string_pretty(&back).expect("JSON") + "\n", json);
        assert_eq!(back.fold().map(f32::to_bits), plain(back.rgb).map(f32::to_bits));
    }
    assert!(ball().trees[0].nodes.len() > 10, "the hollow ball makes a tree worth the name");
}

#[test]
fn a_page_that_went_through_json_is_written_to_the_same_files() {
    let compact = text(Format::PageJson, ball());
    let back: Page = serde_json::from_str(&compact).expect("a page");
    let formats = [
        Format::Html,
        Format::Svg,
        Format::Dot,
        Format::Glb,
        Format::Csv,
        Format::Markdown,
        Format::PageJson,
    ];
    for format in formats {
        assert!(written(format, &back) == written(format, ball()), "{format:?}");
    }
}

#[test]
fn numbers_that_are_none_survive_as_null() {
    let light = r#"LightSource "point" "rgb I" [3e38 3e38 3e38] "float scale" 1e10 "point3 from" [0 3 -3]"#;
    let sphere = r#"Shape "sphere" "float radius" 1"#;
    let head = "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\nLookAt 0 0 -4 0 0 0 0 1 0\n\
                Camera \"perspective\" \"float fov\" 40\nWorldBegin\n";
    let bad = scene(&format!("{head}{light}\n{sphere}"), &Options { samples: Some(1), ..Options::default() });
    let page = page(&bad, [4, 2]);
    assert!(!page.trees[0].rgb[0].0.is_finite());
    assert_eq!(page.trees[0].nodes[0].stop.as_deref(), Some("nan-rejected"));
    let json: serde_json::Value = serde_json::from_str(&text(Format::Json, &first(&page))).expect("JSON");
    assert!(json["rgb"][0].is_null() && json["bad"].is_u64());
    let back: Page = serde_json::from_str(&text(Format::PageJson, &page)).expect("a page");
    assert!(written(Format::Svg, &back) == written(Format::Svg, &page));
}

#[test]
fn the_data_of_the_page_unpacks_to_the_page() {
    let packed = base64(&written(Format::Html, ball()));
    let mut json = String::new();
    flate2::read::GzDecoder::new(packed.as_slice()).read_to_string(&mut json).expect("gzip");
    assert_eq!(json, text(Format::PageJson, ball()));
    assert!(!json.contains("null,\"") && !json.contains(":null"));
    let back: Page = serde_json::from_str(&json).expect("a page");
    assert!(back.trees == ball().trees);
    assert_eq!((back.trees.len(), back.values.len(), back.dims.len()), (4, 4, 4));
    assert!(back.trees[0].nodes[0].walk.len() > 1 && back.trees[1].nodes[0].walk.is_empty());
    let scene = back.scene.expect("a scene");
    let spheres = scene.objects.iter().filter(|o| o.sphere.is_some()).count();
    assert_eq!((spheres, scene.lights.len()), (3, whitted().scene.lights.len()));
    assert!(scene.objects.iter().any(|o| o.mesh.as_ref().is_some_and(|m| m.unpacked().is_some())));
}

/// Plain base64, read the long way.
fn base64(text: &[u8]) -> Vec<u8> {
    let digit = |c: u8| match c {
        b'A'..=b'Z' => c - b'A',
        b'a'..=b'z' => c - b'a' + 26,
        b'0'..=b'9' => c - b'0' + 52,
        b'+' => 62,
        b'/' => 63,
        _ => panic!("{c}"),
    };
    let mut bytes = Vec::new();
    let (mut bits, mut count) = (0u32, 0);
    for &c in text.iter().take_while(|c| **c != b'=') {
        bits = bits << 6 | u32::from(digit(c));
        count += 6;
        if count >= 8 {
            count -= 8;
            bytes.push((bits >> count) as u8);
        }
    }
    bytes
}

#[test]
fn values_and_mean_are_those_of_the_picture() {
    let film = durer_tests::render(whitted()).film;
    let mean = film.pixels()[30 * 96 + 55].mean();
    assert_eq!(plain(ball().mean).map(f32::to_bits), mean.map(f32::to_bits));
    for (sample, tree) in ball().trees.iter().enumerate() {
        assert_eq!((tree.sample as usize, tree.samples), (sample, 4));
        assert_eq!(tree.rgb, ball().values[sample]);
        assert_eq!(tree.film, ball().dims[sample].film);
        assert!((0..2).all(|i| (tree.film[i].0 - [55.5, 30.5][i]).abs() < 2.0));
    }
}

#[test]
fn glb_holds_the_rays_as_lines_and_the_scene_as_triangles() {
    let bytes = written(Format::Glb, ball());
    let glb = gltf::Gltf::from_slice(&bytes).expect("a valid file");
    let blob = glb.blob.as_deref().expect("a binary part");
    let mut segments = 0;
    let mut kinds = Vec::new();
    for mesh in glb.meshes() {
        for primitive in mesh.primitives() {
            let reader = primitive.reader(|_| Some(blob));
            let points: Vec<[f32; 3]> = reader.read_positions().expect("positions").collect();
            let indices: Vec<u32> = reader.read_indices().expect("indices").into_u32().collect();
            assert!(indices.iter().all(|&i| (i as usize) < points.len()));
            let bounds = primitive.bounding_box();
            for i in 0..3 {
                let least = points.iter().map(|p| p[i]).fold(f32::INFINITY, f32::min);
                assert_eq!(least, bounds.min[i]);
            }
            if primitive.mode() == gltf::mesh::Mode::Lines {
                segments += indices.len() / 2;
                kinds.push(mesh.name().expect("a name").to_owned());
            }
        }
    }
    let traced = ball().trees.iter().flat_map(|t| &t.nodes).filter(|n| !n.is_untraced()).count();
    assert_eq!(segments, traced);
    assert!(kinds.contains(&"refraction rays".to_owned()), "{kinds:?}");
    // Our own importer reads the triangles, and finds the camera.
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("rays.glb");
    std::fs::write(&path, &bytes).expect("a file");
    let imported = import::open(&path, Limits::default());
    assert!(!imported.diagnostics.has_errors(), "{:?}", imported.diagnostics);
    assert_eq!(imported.desc.cameras.len(), 1);
    let objects = ball().scene.as_ref().expect("a scene").objects.len();
    assert_eq!(imported.desc.shapes.len(), objects, "{:?}", imported.diagnostics);
}

#[test]
fn the_camera_of_the_glb_sees_what_the_picture_shows() {
    // The first point that the eye ray hits, seen from the file's camera, lies where the sample lies in the picture.
    let page = ball();
    let bytes = written(Format::Glb, page);
    let glb = gltf::Gltf::from_slice(&bytes).expect("a valid file");
    let blob = glb.blob.as_deref().expect("a binary part");
    let node = glb.nodes().find(|n| n.camera().is_some()).expect("a camera");
    let m = node.transform().matrix();
    let rays = glb.meshes().find(|m| m.name() == Some("eye rays")).expect("eye rays");
    let primitive = rays.primitives().next().expect("lines");
    let end = primitive.reader(|_| Some(blob)).read_positions().expect("positions").nth(1).expect("an end");
    let to: [f32; 3] = std::array::from_fn(|i| end[i] - m[3][i]);
    let along = |axis: usize| (0..3).map(|i| to[i] * m[axis][i]).sum::<f32>();
    let window = page.scene.as_ref().expect("a scene").camera.window.map(|v| v.0);
    let [x, y] = [along(0) / -along(2), along(1) / -along(2)];
    let film =
        [(x - window[0]) / (window[1] - window[0]) * 96.0, (y - window[2]) / (window[3] - window[2]) * 54.0];
    for i in 0..2 {
        assert!((film[i] - page.trees[0].film[i].0).abs() < 0.01, "{film:?} {:?}", page.trees[0].film);
    }
}

#[test]
fn svg_is_sound_xml_with_a_mark_for_every_ray() {
    let svg = text(Format::Svg, ball());
    let rays: usize = ball().trees.iter().map(|t| t.nodes.len()).sum();
    assert_eq!(svg.matches("<g><title>").count(), rays);
    assert!(svg.contains("data:image/png;base64,") && svg.contains("contribution"));
    let mut open = Vec::new();
    for tag in svg.split('<').skip(1) {
        let (tag, _) = tag.split_once('>').expect("a tag ends");
        let name = tag.split([' ', '/', '\n']).find(|w| !w.is_empty()).expect("a name");
        match (tag.starts_with('/'), tag.ends_with('/')) {
            (true, _) => assert_eq!(open.pop(), Some(name)),
            (false, true) => {}
            (false, false) => open.push(name),
        }
    }
    assert!(open.is_empty());
}

#[test]
fn names_of_a_scene_are_never_commands_of_a_format() {
    let mut page = first(ball());
    let name = "<script>\"&'\\ \u{1b}[2J=1,2\n|";
    for node in page.trees[0].nodes.iter_mut().filter(|n| n.object.is_some()) {
        node.object = Some(name.to_owned());
    }
    page.trees[0].scene = "=cmd|'</text>".to_owned();
    let svg = text(Format::Svg, &page);
    assert!(!svg.contains("<script") && !svg.contains('\u{1b}'));
    let dot = text(Format::Dot, &page);
    assert!(dot.contains("<script>\\\"&'\\\\ ?[2J=1,2\\n|") && !dot.contains('\u{1b}'));
    assert!(text(Format::Csv, &page).contains("\"<script>\"\"&'"));
    assert!(text(Format::Markdown, &page).contains("\\<script\\>"));
}

#[test]
fn csv_has_a_row_with_all_columns_for_every_ray() {
    let csv = text(Format::Csv, &first(ball()));
    let mut lines = csv.lines();
    let columns: Vec<&str> = lines.next().expect("a head").split(',').collect();
    let tree = &ball().trees[0];
    for node in &tree.nodes {
        let row = lines
            .next()
            .expect("a row")
            .replace("\"glass ball, outer\"", "o")
            .replace("\"glass ball, inner\"", "i");
        let cells: Vec<&str> = row.split(',').collect();
        assert_eq!(cells.len(), columns.len(), "{row}");
        let cell = |name: &str| cells[columns.iter().position(|c| *c == name).expect("a column")];
        assert_eq!(cell("kind"), node.kind);
        assert_eq!(cell("result_g").parse::<f32>().expect("a number").to_bits(), node.result[1].0.to_bits());
    }
    assert_eq!(lines.next(), None);
}

#[test]
fn ten_thousand_rays_leave_room_for_the_program_of_the_page() {
    let options = Options { width: Some(96), samples: Some(1024), ..Options::default() };
    let many = prepared(builtin::find("whitted").expect("built in").import(), &options);
    let subject = Subject { name: "whitted", prepared: &many };
    let page = subject.page([55, 30], &[0], Surroundings::SceneAndSamples(10_000), Detail::default());
    let nodes: usize = page.trees.iter().map(|t| t.nodes.len()).sum();
    assert!((9_900..=10_000).contains(&nodes), "{nodes}");
    let packed = written(Format::Html, &page);
    assert!(packed.len() <= Page::ROOM, "{}", packed.len());
    let mut json = String::new();
    flate2::read::GzDecoder::new(base64(&packed).as_slice()).read_to_string(&mut json).expect("gzip");
    let back: Page = serde_json::from_str(&json).expect("a page");
    let kept: usize = back.trees.iter().map(|t| t.nodes.len()).sum();
    assert_eq!(kept, nodes, "details went, no ray did");
}
