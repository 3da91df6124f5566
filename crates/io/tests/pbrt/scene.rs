//! Good texts: the scene they describe, against matrices worked out by hand.
use durer_core::glam::{DAffine3, DMat3, DVec3};
use std::sync::Arc;

use durer_scene::{Crop, Data, Location, ShapeDesc, ShapeSource, TextureValue, ValueType};

use super::read::{complaints, read, sound};

pub(crate) fn is(m: DAffine3, columns: [[f64; 3]; 4]) {
    let [x, y, z, t] = columns.map(DVec3::from);
    let expected = DAffine3 { matrix3: DMat3::from_cols(x, y, z), translation: t };
    assert!(m.abs_diff_eq(expected, 1e-12), "{m:?} is not {expected:?}");
}

fn placed(shape: &ShapeDesc) -> DAffine3 {
    shape.world_from_object.at(0.0)
}

fn kind(shape: &ShapeDesc) -> &str {
    match &shape.source {
        ShapeSource::Node(node) => &node.kind,
        ShapeSource::Mesh(_) => panic!("no mesh was read"),
    }
}

#[test]
fn crops_and_seeds_are_read() {
    let of = |text: &str| sound(&format!("{text}\nWorldBegin")).film;
    let film = of(
        "Film \"rgb\" \"float cropwindow\" [ 1 .25 0 .5 ] \"float exposuretime\" .5\nOption \"integer seed\" 7",
    );
    assert_eq!((film.exposure_seconds, film.seed), (Some(0.5), Some(7)));
    let crop = film.crop.expect("a part");
    assert_eq!(crop, Crop::Window([0.25, 1.0, 0.0, 0.5]));
    // Rounded up, as pbrt-v4 does.
    assert_eq!(crop.pixels([8, 8], [10, 5]), [3, 10, 0, 3]);
    let film = of(
        "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 6 \"integer pixelbounds\" [1 3 2 6]\n\
                   Sampler \"sobol\" \"integer seed\" -1",
    );
    assert_eq!(film.seed, Some(0xffff_ffff));
    let crop = film.crop.expect("a part");
    assert_eq!(crop.pixels([8, 6], [8, 6]), [1, 3, 2, 6]);
    assert_eq!(crop.pixels([8, 6], [16, 3]), [2, 6, 1, 3]);
    // All of it is no part.
    let all = "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 6";
    assert_eq!(of(&format!("{all} \"float cropwindow\" [0 1 0 1]")).crop, None);
    assert_eq!(of(&format!("{all} \"integer pixelbounds\" [0 8 0 6]")).crop, None);
}

#[test]
fn colours_of_other_spaces_become_ours() {
    let colors = |text: &str| -> Vec<Vec<f32>> {
        let desc = sound(&format!("WorldBegin\n{text}\nShape \"sphere\""));
        let params = desc.materials.iter().map(|m| &m.node).chain(desc.lights.iter().map(|l| &l.node));
        params
            .flat_map(|node| node.params.iter())
            .filter_map(|p| if let Data::Floats(v) = &p.data { Some(v.clone()) } else { None })
            .collect()
    };
    let near = |found: &[f32], expected: [f32; 3]| {
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 2e-4), "{found:?}, not {expected:?}");
    };
    // A surface keeps white, and light its colour; the space ends with its block.
    let text = "AttributeBegin ColorSpace \"aces2065-1\" Material \"diffuse\" \"rgb reflectance\" [.5 .5 .5]\n\
                LightSource \"point\" \"rgb I\" [1 1 1] AttributeEnd Material \"diffuse\" \"rgb reflectance\" [.1 .2 .3]";
    let found = colors(text);
    near(&found[0], [0.5; 3]);
    assert_eq!(found[1], [0.1, 0.2, 0.3]);
    assert!(found[2][0] > 1.01 && found[2][2] < 0.95, "{found:?}");
    // The matrix of BT.2087, in double precision by another program.
    near(
        &colors("ColorSpace \"rec2020\" Material \"diffuse\" \"rgb reflectance\" [.6 .5 .4]")[0],
        [0.67333, 0.48838, 0.38631],
    );
}

#[test]
fn options_are_read() {
    let desc = sound(
        "LookAt 0 0 4  0 0 0  0 1 0\r\n\
         Camera \"perspective\" \"float fov\" 39 \"string name\" \"front\"\r\n\
         Film \"rgb\" \"integer yresolution\" [ 30 ] \"string filename\" \"out.exr\" \"float diagonal\" 20 \"float iso\" 400\r\n\
         Sampler \"halton\" \"integer pixelsamples\" 7\r\n\
         PixelFilter \"box\"\tIntegrator \"whitted\" \"integer maxdepth\" +3\r\nWorldBegin",
    );
    assert_eq!((desc.film.width, desc.film.height, desc.film.samples), (Some(1280), Some(30), Some(7)));
    assert_eq!(desc.film.filename.as_deref(), Some("out.exr"));
    assert_eq!((desc.film.diagonal_mm, desc.film.iso), (Some(20.0), Some(400.0)));
    assert_eq!((desc.film.crop, desc.film.seed), (None, None));
    assert_eq!(desc.filter.map(|n| n.kind).as_deref(), Some("box"));
    assert_eq!(desc.sampler.map(|n| n.kind).as_deref(), Some("halton"));
    let integrator = desc.integrator.expect("an integrator");
    assert_eq!(integrator.params.get("maxdepth").map(|p| &p.data), Some(&Data::Ints(vec![3])));
    let camera = &desc.cameras[0];
    assert_eq!((camera.name.as_str(), camera.node.kind.as_str()), ("front", "perspective"));
    assert!(camera.node.params.get("name").is_none() && camera.node.params.get("fov").is_some());
    // From +z looking along -z with y up: x of the left-handed camera space is the world's -x.
    is(camera.world_from_camera.at(0.0), [[-1., 0., 0.], [0., 1., 0.], [0., 0., -1.], [0., 0., 4.]]);
}

#[test]
fn the_film_keeps_silent_where_the_file_does() {
    let desc = sound("WorldBegin");
    assert_eq!((desc.film.width, desc.film.height, desc.film.samples), (None, None, None));
    let desc = sound("Film \"rgb\" Sampler \"stratified\" \"integer xsamples\" 3 WorldBegin");
    assert_eq!((desc.film.width, desc.film.height, desc.film.samples), (Some(1280), Some(720), Some(12)));
}

#[test]
fn transformations_multiply_from_the_right() {
    let desc = sound(
        "Scale -1 1 1 WorldBegin AttributeBegin Translate 1 2 3 Rotate 90 0 0 1 Scale 2 3 4 Shape \"a\" AttributeEnd\n\
         Shape \"b\" AttributeBegin Transform [1 0 0 0  0 0 1 0  0 -1 0 0  5 6 7 1] Shape \"c\"\n\
         ConcatTransform [1 0 0 0 0 1 0 0 0 0 1 0 1 1 1 1] Shape \"d\" Identity Shape \"e\" AttributeEnd",
    );
    let shapes = &desc.shapes;
    assert_eq!(shapes.iter().map(kind).collect::<Vec<_>>(), ["a", "b", "c", "d", "e"]);
    // Rotation by 90 degrees about z sends x to y and y to -x.
    is(placed(&shapes[0]), [[0., 2., 0.], [-3., 0., 0.], [0., 0., 4.], [1., 2., 3.]]);
    // WorldBegin forgets the Scale.
    assert_eq!(placed(&shapes[1]), DAffine3::IDENTITY);
    is(placed(&shapes[2]), [[1., 0., 0.], [0., 0., 1.], [0., -1., 0.], [5., 6., 7.]]);
    is(placed(&shapes[3]), [[1., 0., 0.], [0., 0., 1.], [0., -1., 0.], [6., 5., 8.]]);
    assert_eq!(placed(&shapes[4]), DAffine3::IDENTITY);
}

#[test]
fn coordinate_systems_are_remembered() {
    let desc = sound(
        "LookAt 1 2 -5 1 2 0 0 1 0 Camera \"perspective\" WorldBegin AttributeBegin CoordSysTransform \"camera\"\n\
         LightSource \"point\" Translate 0 0 1 CoordinateSystem \"lamp\" AttributeEnd\n\
         CoordSysTransform \"lamp\" Shape \"sphere\" CoordSysTransform \"world\" Shape \"sphere\"",
    );
    is(desc.lights[0].world_from_light.at(0.0), [[1., 0., 0.], [0., 1., 0.], [0., 0., 1.], [1., 2., -5.]]);
    assert_eq!(placed(&desc.shapes[0]).translation, DVec3::new(1.0, 2.0, -4.0));
    assert_eq!(placed(&desc.shapes[1]), DAffine3::IDENTITY);
}

#[test]
fn attribute_blocks_save_the_state() {
    let desc = sound(
        "WorldBegin Material \"mirror\" ReverseOrientation\n\
         AttributeBegin ReverseOrientation Material \"dielectric\" \"float eta\" 1.3 Translate 1 0 0 Shape \"a\" AttributeEnd\n\
         Shape \"b\" NamedMaterial \"late\" Shape \"c\"\nMakeNamedMaterial \"late\" \"string type\" \"diffuse\" \"rgb reflectance\" [ 1 .5 0. ]\n\
         Material \"\" Shape \"d\"",
    );
    let material = |i: usize| &desc.materials[desc.shapes[i].material.expect("a material").index()];
    assert_eq!(material(0).node.kind, "dielectric");
    assert_eq!((material(1).node.kind.as_str(), material(1).name.as_str()), ("mirror", ""));
    assert_eq!((material(2).node.kind.as_str(), material(2).name.as_str()), ("diffuse", "late"));
    assert!(material(2).node.params.get("type").is_none());
    assert_eq!(material(3).node.kind, "interface");
    assert_eq!([0, 1, 2].map(|i: usize| desc.shapes[i].reverse_orientation), [false, true, true]);
    assert_eq!(placed(&desc.shapes[1]), DAffine3::IDENTITY);
    assert_eq!(sound("WorldBegin Shape \"sphere\"").shapes[0].material, None);
}

#[test]
fn transform_blocks_save_the_transformation_only() {
    let imported =
        read("WorldBegin TransformBegin Translate 1 0 0 Material \"mirror\" TransformEnd Shape \"s\"");
    assert!(!imported.diagnostics.has_errors());
    let shape = &imported.desc.shapes[0];
    assert_eq!(placed(shape), DAffine3::IDENTITY);
    assert!(shape.material.is_some());
}

#[test]
fn parameters_keep_type_values_and_place() {
    let text = "WorldBegin\nShape \"s\" \"string name\" \"my ball\" \"bool a\" true \"bool b\" [ \"false\" true ]\n\
                \"point P\" [ 1 2. -.3e1 ] # c\n\"vector2 v\" [1 2] \"normal N\" [0 0 1]\n\
                \"spectrum s\" \"metal-Ag-eta\" \"spectrum t\" [ 400 .5 ] \"blackbody k\" 5500 \"texture x\" \"wood\"\n\
                \" string  file \" \"a\\\"b\" \"integer i\" []";
    let imported = read(text);
    assert_eq!(complaints(&imported), Vec::<String>::new());
    let shape = &imported.desc.shapes[0];
    assert_eq!(shape.name, "my ball");
    let ShapeSource::Node(node) = &shape.source else { panic!("a node") };
    let strings = |s: &str| Data::Strings(vec![s.to_owned()]);
    let expected = [
        ("a", ValueType::Bool, Data::Bools(vec![true]), "\"bool a\" true"),
        ("b", ValueType::Bool, Data::Bools(vec![false, true]), "\"bool b\" [ \"false\" true ]"),
        ("P", ValueType::Point3, Data::Floats(vec![1.0, 2.0, -3.0]), "\"point P\" [ 1 2. -.3e1 ]"),
        ("v", ValueType::Vector2, Data::Floats(vec![1.0, 2.0]), "\"vector2 v\" [1 2]"),
        ("N", ValueType::Normal, Data::Floats(vec![0.0, 0.0, 1.0]), "\"normal N\" [0 0 1]"),
        ("s", ValueType::Spectrum, strings("metal-Ag-eta"), "\"spectrum s\" \"metal-Ag-eta\""),
        ("t", ValueType::Spectrum, Data::Floats(vec![400.0, 0.5]), "\"spectrum t\" [ 400 .5 ]"),
        ("k", ValueType::Blackbody, Data::Floats(vec![5500.0]), "\"blackbody k\" 5500"),
        ("x", ValueType::Texture, strings("wood"), "\"texture x\" \"wood\""),
        ("file", ValueType::String, strings("a\"b"), "\" string  file \" \"a\\\"b\""),
        ("i", ValueType::Integer, Data::Ints(vec![]), "\"integer i\" []"),
    ];
    assert_eq!(node.params.iter().count(), expected.len());
    for (param, (name, ty, data, written)) in node.params.iter().zip(expected) {
        let Location::Span(at) = param.at else { panic!("a span") };
        assert_eq!(&text[at.start as usize..at.end as usize], written);
        assert_eq!((param.name.as_str(), param.ty, &param.data), (name, ty, &data));
    }
    let Location::Span(at) = node.at else { panic!("a span") };
    assert_eq!(&text[at.start as usize..at.end as usize], "\"s\"");
}

#[test]
fn textures_and_lights_are_kept() {
    let imported = read(
        "WorldBegin Texture \"t\" \"float\" \"constant\" \"float value\" 1 Texture \"t\" \"color\" \"imagemap\"\n\
         LightSource \"point\" \"string name\" \"lamp\" \"rgb I\" [ 1 1 1 ]",
    );
    assert_eq!(
        complaints(&imported),
        ["1:71 warning: \"color\" is pbrt-v3's word; it is read as \"spectrum\" | \"color\""]
    );
    let desc = &imported.desc;
    assert_eq!(
        desc.textures.iter().map(|t| t.value).collect::<Vec<_>>(),
        [TextureValue::Float, TextureValue::Color]
    );
    assert_eq!((desc.lights[0].name.as_str(), desc.lights[0].node.params.iter().count()), ("lamp", 1));
}

#[test]
fn attribute_gives_parameters_unless_given() {
    let desc = sound(
        "WorldBegin AttributeBegin Attribute \"shape\" \"float radius\" 2 \"float zmin\" -1 Attribute \"shape\" \"float radius\" 3\n\
         Shape \"a\" Shape \"b\" \"float radius\" 5 AttributeEnd Shape \"c\"",
    );
    let radius = |i: usize| match &desc.shapes[i].source {
        ShapeSource::Node(node) => node.params.get("radius").map(|p| p.data.clone()),
        ShapeSource::Mesh(_) => None,
    };
    assert_eq!(radius(0), Some(Data::Floats(vec![3.0])));
    assert_eq!(radius(1), Some(Data::Floats(vec![5.0])));
    assert_eq!(radius(2), None);
}

#[test]
fn objects_are_placed_by_their_instances() {
    let desc = sound(
        "WorldBegin ObjectInstance \"late\" Material \"mirror\" ObjectBegin \"late\" Translate 0 1 0\n\
         Shape \"a\" Shape \"b\" \"string name\" \"bee\" ObjectEnd\n\
         AttributeBegin Scale 2 2 2 ObjectInstance \"late\" AttributeEnd Shape \"c\"",
    );
    assert_eq!(desc.shapes.iter().map(kind).collect::<Vec<_>>(), ["c", "a", "b", "a", "b"]);
    assert_eq!(placed(&desc.shapes[0]), DAffine3::IDENTITY);
    is(placed(&desc.shapes[2]), [[1., 0., 0.], [0., 1., 0.], [0., 0., 1.], [0., 1., 0.]]);
    is(placed(&desc.shapes[3]), [[2., 0., 0.], [0., 2., 0.], [0., 0., 2.], [0., 2., 0.]]);
    let shared =
        |i: usize| matches!(&desc.shapes[i].source, ShapeSource::Node(n) if Arc::strong_count(n) == 2);
    assert!(shared(1) && shared(4) && !shared(0), "instances share what is built");
    assert_eq!(desc.shapes[4].name, "bee");
    assert!(desc.shapes[4].material.is_some());
}

#[test]
fn copies_are_limited() {
    let numbers = "1 ".repeat(30_000);
    let shapes = "Shape \"s\"\n".repeat(5_000);
    let uses = "ObjectInstance \"o\"\n".repeat(4_000);
    let found = complaints(&read(&format!("WorldBegin\nObjectBegin \"o\"\n{shapes}ObjectEnd\n{uses}")));
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].contains("place more than"), "{found:?}");
    let inherited = format!(
        "WorldBegin\nAttribute \"shape\" \"float x\" [ {numbers} ]\n{}",
        "Shape \"s\"\n".repeat(10_000)
    );
    let found = complaints(&read(&inherited));
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].contains("more than 1 GiB"), "{found:?}");
}

#[test]
fn cameras_of_different_names_are_kept() {
    let imported = read(
        "Camera \"perspective\"\nCamera \"orthographic\"\nCamera \"perspective\" \"string name\" \"side\"\nWorldBegin",
    );
    let cameras = &imported.desc.cameras;
    assert_eq!(
        cameras.iter().map(|c| c.node.kind.as_str()).collect::<Vec<_>>(),
        ["orthographic", "perspective"]
    );
    assert_eq!(
        complaints(&imported),
        [
            "2:8 warning: this Camera replaces the earlier one; several need a \"string name\" each | \"orthographic\""
        ]
    );
}

#[test]
fn shapes_with_holes_have_a_mask_around_their_material() {
    let desc = sound(
        "WorldBegin\nTexture \"t\" \"float\" \"checkerboard\"\nMaterial \"mirror\"\n\
         Shape \"sphere\" \"float alpha\" 0.5\nShape \"sphere\" \"float alpha\" 0.5\nShape \"sphere\" \"texture alpha\" \"t\"\n\
         Shape \"sphere\" \"float alpha\" 1\nNamedMaterial \"later\"\nShape \"disk\" \"float alpha\" 0.25\n\
         MakeNamedMaterial \"later\" \"string type\" \"conductor\"\n",
    );
    let used: Vec<usize> = desc.shapes.iter().map(|s| s.material.map_or(99, |m| m.index())).collect();
    let (first, second) = (used[0], used[2]);
    assert!(used[1] == first && used[3] == 0 && second != first && used[4] != first, "{used:?}");
    for (mask, below) in [(first, "mirror 0"), (second, "mirror 0"), (used[4], "later")] {
        let node = &desc.materials[mask].node;
        assert_eq!(node.kind, "mask");
        let names = &node.params.get("material").expect("a name").data;
        assert_eq!(*names, Data::Strings(vec![below.to_owned()]));
        assert!(desc.materials[..mask].iter().any(|m| m.name == below));
    }
    assert!(desc.shapes.iter().all(|s| match &s.source {
        ShapeSource::Node(node) => node.params.get("alpha").is_none_or(|p| p.data == Data::Floats(vec![1.0])),
        ShapeSource::Mesh(_) => false,
    }));
}

#[test]
fn integrators_with_the_same_picture_stand_for_those_of_pbrt() {
    for (theirs, ours, told) in [
        ("simplepath", "path", "1:12 note: "),
        ("randomwalk", "path", "1:12 warning: "),
        ("simplevolpath", "volpath", "1:12 warning: "),
        ("mlt", "bdpt", "1:12 warning: "),
    ] {
        // pbrt's default and another depth.
        for (more, depth) in [("", 5), (" \"integer maxdepth\" 7", 7)] {
            let imported = read(&format!("Integrator \"{theirs}\"{more}\nWorldBegin"));
            let node = imported.desc.integrator.as_ref().expect("an integrator");
            assert_eq!(node.kind, ours);
            assert_eq!(node.params.get("maxdepth").map(|p| &p.data), Some(&Data::Ints(vec![depth])));
            let all = complaints(&imported);
            let said = format!("integrator \"{theirs}\" is drawn by \"{ours}\"");
            assert!(all[0].starts_with(told) && all[0].contains(&said), "{all:?}");
        }
    }
    let own = read("Integrator \"mlt\" \"integer chains\" 8 \"bool regularize\" true\nWorldBegin");
    let node = own.desc.integrator.as_ref().expect("an integrator");
    assert!(node.params.get("chains").is_none());
    assert_eq!(node.params.get("regularize").map(|p| &p.data), Some(&Data::Bools(vec![true])));
    let wrong = complaints(&read("Integrator \"mlt\" \"integer chain\" 8\nWorldBegin"));
    assert!(wrong.iter().any(|c| c.contains("\"chain\"") && c.contains("chains")), "{wrong:?}");
}
