//! What glTF materials, textures, cameras and lights become.
mod gltf_document;

use durer_core::glam::DVec3;
use durer_scene::{Assets, Data, Node, Severity, ShapeSource};
use gltf_document::{first, floats, import, import_well, numbers, word};
use serde_json::{Value, json};

fn with_images(mut d: Value) -> Value {
    d["nodes"] = json!([{}]);
    d["images"] = json!([{"uri": "a%20b.png"}, {"uri": "data:image/png;base64,iVBORw0KGgo"}]);
    d["textures"] = json!([{"source": 0, "sampler": 0}, {"source": 1}]);
    d["samplers"] = json!([{"wrapS": 33071, "wrapT": 33648, "magFilter": 9728}]);
    d
}

#[test]
fn plain_materials_keep_their_factors() {
    let d = json!({"nodes": [{}], "materials": [
        {"name": "m", "pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 0.4], "roughnessFactor": 0.25},
         "emissiveFactor": [1, 2, 3], "alphaMode": "MASK", "alphaCutoff": 0.75, "extensions": {
            "KHR_materials_emissive_strength": {"emissiveStrength": 7}, "KHR_materials_ior": {"ior": 1.33},
            "KHR_materials_transmission": {"transmissionFactor": 0.5}}},
        {},
    ]});
    let desc = import_well(d, &[]).desc;
    let m = &desc.materials[0].node;
    assert_eq!((desc.materials[0].name.as_str(), m.kind.as_str()), ("m", "principled"));
    for (name, value) in [
        ("basecolor", vec![0.1, 0.2, 0.3]),
        ("alpha", vec![0.4]),
        ("alphacutoff", vec![0.75]),
        ("metallic", vec![1.0]),
        ("roughness", vec![0.25]),
        ("emission", vec![1.0, 2.0, 3.0]),
        ("emissionstrength", vec![7.0]),
        ("eta", vec![1.33]),
        ("transmission", vec![0.5]),
    ] {
        assert_eq!(numbers(m, name), value, "{name}");
    }
    assert_eq!(word(m, "alphamode"), "mask");
    let plain = &desc.materials[1].node;
    assert_eq!((numbers(plain, "metallic"), numbers(plain, "roughness")), (vec![1.0], vec![1.0]));
    assert!(plain.params.get("alpha").is_none() && plain.params.get("emission").is_none());
}

#[test]
fn extensions_of_the_material_become_its_layers() {
    let d = json!({"nodes": [{}], "materials": [{"extensions": {
        "KHR_materials_specular": {"specularFactor": 0.5, "specularColorFactor": [2, 1, 0.5]},
        "KHR_materials_clearcoat": {"clearcoatFactor": 0.75, "clearcoatRoughnessFactor": 0.25},
        "KHR_materials_sheen": {"sheenColorFactor": [0.25, 0.5, 1], "sheenRoughnessFactor": 0.5},
        "KHR_materials_anisotropy": {"anisotropyStrength": 0.5, "anisotropyRotation": 1.5},
        "KHR_materials_iridescence": {"iridescenceFactor": 1, "iridescenceIor": 1.75, "iridescenceThicknessMaximum": 500},
        "KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 0.5,
            "diffuseTransmissionColorFactor": [1, 0.5, 0]},
        "KHR_materials_transmission": {"transmissionFactor": 1},
        "KHR_materials_volume": {"thicknessFactor": 0.125, "attenuationColor": [0.5, 1, 1], "attenuationDistance": 2},
        "KHR_materials_dispersion": {"dispersion": 0.25}
    }}]});
    let desc = import_well(d, &[]).desc;
    let m = &desc.materials[0].node;
    for (name, value) in [
        ("specular", vec![0.5]),
        ("specularcolor", vec![2.0, 1.0, 0.5]),
        ("clearcoat", vec![0.75]),
        ("clearcoatroughness", vec![0.25]),
        ("sheencolor", vec![0.25, 0.5, 1.0]),
        ("sheenroughness", vec![0.5]),
        ("anisotropy", vec![0.5]),
        ("anisotropyrotation", vec![1.5]),
        ("iridescence", vec![1.0]),
        ("iridescenceeta", vec![1.75]),
        ("iridescencethickness", vec![500.0]),
        ("diffusetransmission", vec![0.5]),
        ("diffusetransmissioncolor", vec![1.0, 0.5, 0.0]),
        ("thickness", vec![0.125]),
        ("attenuationcolor", vec![0.5, 1.0, 1.0]),
        ("attenuationdistance", vec![2.0]),
        ("dispersion", vec![0.25]),
    ] {
        assert_eq!(numbers(m, name), value, "{name}");
    }
    assert!(m.params.get("onesided").is_none());
}

#[test]
fn layers_have_maps_of_directions() {
    let d = with_images(json!({"materials": [{"extensions": {
        "KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatNormalTexture": {"index": 0, "scale": 0.5}},
        "KHR_materials_anisotropy": {"anisotropyStrength": 0.5, "anisotropyTexture": {"index": 1}},
    }}]}));
    let desc = import_well(d, &[]).desc;
    let m = &desc.materials[0].node;
    for (parameter, file) in [("clearcoatnormal", "a b.png"), ("anisotropydirection", "image:1")] {
        let name = word(m, parameter);
        let texture = &desc.textures.iter().find(|t| t.name == name).expect("a texture").node;
        assert_eq!(
            (word(texture, "filename"), word(texture, "encoding")),
            (file.to_owned(), "linear".to_owned())
        );
    }
    assert_eq!(numbers(m, "clearcoatnormalscale"), [0.5]);
}

#[test]
fn textures_carry_channel_encoding_factor_wrap_and_filter() {
    let d = with_images(json!({"materials": [
        {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "baseColorFactor": [0.5, 1, 1, 1],
            "metallicRoughnessTexture": {"index": 1}, "roughnessFactor": 0.5, "metallicFactor": 1},
         "normalTexture": {"index": 1, "scale": 2}, "alphaMode": "BLEND"},
        {"pbrMetallicRoughness": {"metallicRoughnessTexture": {"index": 1}, "metallicFactor": 0}},
    ]}));
    let imported = import_well(d, &[]);
    let desc = &imported.desc;
    let m = &desc.materials[0].node;
    let texture = |of: &Node, name: &str| -> Node {
        let name = word(of, name);
        desc.textures.iter().find(|t| t.name == name).expect("a texture").node.clone()
    };
    let base = texture(m, "basecolor");
    assert_eq!(word(&base, "filename"), "a b.png");
    assert_eq!(word(&base, "encoding"), "sRGB");
    assert_eq!((word(&base, "wrap"), word(&base, "wrapv")), ("clamp".to_owned(), "mirror".to_owned()));
    assert_eq!(word(&base, "filter"), "point");
    assert_eq!(numbers(&base, "factor"), [0.5, 1.0, 1.0]);
    assert!(texture(m, "roughness").params.get("filter").is_none(), "no sampler, no filter");
    let rough = texture(m, "roughness");
    assert_eq!((word(&rough, "channel"), word(&rough, "filename")), ("g".to_owned(), "image:1".to_owned()));
    assert_eq!(numbers(&rough, "scale"), [0.5]);
    assert!(rough.params.get("wrap").is_none() && rough.params.get("uvmatrix").is_none());
    assert_eq!(word(&texture(m, "metallic"), "channel"), "b");
    assert_eq!(word(&texture(m, "alpha"), "channel"), "a");
    assert_eq!(word(&texture(m, "normal"), "encoding"), "linear");
    assert_eq!(numbers(m, "normalscale"), [2.0]);
    assert_eq!(&*imported.assets.bytes("image:1").expect("embedded"), b"\x89PNG\r\n\x1a\n");
    // An idle texture (factor 0) is none; one used twice is one.
    assert_eq!(numbers(&desc.materials[1].node, "metallic"), [0.0]);
    assert_eq!(desc.textures.len(), 6);
}

#[test]
fn images_that_extensions_give_come_before_those_for_other_readers() {
    let textures = json!([
        {"source": 1, "extensions": {"KHR_texture_basisu": {"source": 0}}},
        {"extensions": {"KHR_texture_basisu": {"source": 0}, "EXT_texture_webp": {"source": 2}}},
    ]);
    let base = |index: u32| json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": index}}});
    let mut d = with_images(json!({"materials": [base(0), base(1)]}));
    d["textures"] = textures;
    d["images"] = json!([{"uri": "a.ktx2"}, {"uri": "a.png"}, {"uri": "a.webp"}]);
    let desc = import_well(d, &[]).desc;
    let files: Vec<String> = desc.textures.iter().map(|t| word(&t.node, "filename")).collect();
    assert_eq!(files, ["a.ktx2", "a.webp"]);
}

#[test]
fn texture_transforms_become_a_matrix_for_v_upwards() {
    let info = |t: Value| json!({"index": 0, "extensions": {"KHR_texture_transform": t}});
    let d = with_images(json!({"materials": [
        {"pbrMetallicRoughness": {"baseColorTexture": info(json!({"offset": [0.25, 0.5]}))}},
        {"pbrMetallicRoughness": {"baseColorTexture": info(json!({"scale": [1, 1]}))}},
    ]}));
    let imported = import_well(d, &[]);
    let [moved, plain] = &imported.desc.textures[..] else { panic!("two textures") };
    assert_eq!(numbers(&moved.node, "uvmatrix"), [1.0, 0.0, 0.25, 0.0, 1.0, -0.5]);
    assert!(plain.node.params.get("uvmatrix").is_none() && plain.node.params.get("uvset").is_none());
}

#[test]
fn textures_pick_their_coordinates_and_those_of_the_normal_map_come_first() {
    let uv = |offset: u32| json!({"bufferView": 0, "byteOffset": offset, "componentType": 5126, "type": "VEC2", "count": 3});
    let moved = json!({"index": 0, "texCoord": 0, "extensions": {"KHR_texture_transform":
        {"texCoord": 3, "rotation": std::f64::consts::FRAC_PI_2, "scale": [2, 2]}}});
    let mut d = with_images(json!({"materials": [
        {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}, "normalTexture": moved},
        {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "texCoord": 1}}},
    ]}));
    let attributes = json!({"POSITION": 0, "TEXCOORD_0": 1, "TEXCOORD_1": 2, "TEXCOORD_3": 3});
    let mut with_tangents = attributes.clone();
    with_tangents["NORMAL"] = json!(0);
    with_tangents["TANGENT"] = json!(4);
    d["meshes"] = json!([{"primitives": [{"attributes": attributes, "material": 0},
        {"attributes": attributes, "material": 1}, {"attributes": with_tangents, "material": 0}]}]);
    d["nodes"] = json!([{"mesh": 0}]);
    let vec = |kind: &str| json!({"bufferView": 0, "componentType": 5126, "type": kind, "count": 3});
    d["accessors"] = json!([vec("VEC3"), uv(0), uv(4), uv(8), vec("VEC4")]);
    d["bufferViews"] = json!([{"buffer": 0, "byteLength": 48}]);
    let values: Vec<f32> = (0..12).map(|i| i as f32).collect();
    let desc = import_well(d, &floats(&values)).desc;
    let set = |of: &Node, name: &str| {
        let name = word(of, name);
        let texture = desc.textures.iter().find(|t| t.name == name).expect("a texture");
        match texture.node.params.get("uvset").map(|p| &p.data) {
            None => 0,
            Some(Data::Ints(v)) => v[0],
            other => panic!("{other:?}"),
        }
    };
    let material = |shape: usize| &desc.materials[desc.shapes[shape].material.expect("one").index()].node;
    let mesh = |shape: usize| match desc.shapes[shape].source {
        ShapeSource::Mesh(id) => &desc.meshes[id.index()],
        ShapeSource::Node(_) => panic!("a mesh"),
    };
    // The normal map's TEXCOORD_3 comes first, the base colour's TEXCOORD_0 second.
    assert_eq!((set(material(0), "normal"), set(material(0), "basecolor")), (0, 1));
    assert_eq!((mesh(0).uvs[0].x, mesh(0).second_uvs[0].x), (2.0, 0.0));
    assert_eq!(set(material(1), "basecolor"), 0);
    assert_eq!((mesh(1).uvs[0].x, mesh(1).second_uvs[0].x), (1.0, 0.0));
    // A quarter turn and a scale of 2, for v upwards; tangents of the file stay as they are.
    assert_eq!(numbers(material(0), "normaluv"), [0.0, -2.0, 2.0, 0.0]);
    assert!(material(2).params.get("normaluv").is_none());
    assert_eq!(word(material(2), "normal"), word(material(0), "normal"));
}

#[test]
fn a_third_set_of_coordinates_is_warned_about() {
    let d = with_images(
        json!({"materials": [{"emissiveTexture": {"index": 0, "texCoord": 2}, "emissiveFactor": [1, 1, 1],
        "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 1, "texCoord": 1}}}]}),
    );
    let (pointer, message) = first(&import_well(d, &[]), Severity::Warning);
    assert!(pointer == "/materials/0" && message.contains("TEXCOORD_2"), "{pointer}: {message}");
}

#[test]
fn single_sided_materials_hide_their_backs_unless_light_passes_them() {
    let d = json!({"nodes": [{}], "materials": [{}, {"doubleSided": true},
        {"extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}}}]});
    let desc = import_well(d, &[]).desc;
    let hides = |i: usize| desc.materials[i].node.params.get("onesided").is_some();
    assert!(hides(0) && !hides(1) && !hides(2));
}

#[test]
fn perspective_cameras_look_along_minus_z_unmirrored_and_without_scale() {
    let turn = std::f64::consts::FRAC_1_SQRT_2;
    let d = json!({"cameras": [{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1}}],
        "nodes": [{"name": "eye", "camera": 0, "translation": [1, 2, 3], "rotation": [0, turn, 0, turn],
                   "scale": [5, 5, 5]}]});
    let desc = import_well(d, &[]).desc;
    let camera = &desc.cameras[0];
    assert_eq!((camera.name.as_str(), camera.node.kind.as_str()), ("eye", "perspective"));
    assert_eq!(numbers(&camera.node, "fov"), [0.5f64.to_degrees() as f32]);
    assert_eq!(word(&camera.node, "fovaxis"), "y");
    let m = camera.world_from_camera.at(0.0);
    // Turned by 90 degrees about y, -z becomes -x and x becomes -z.
    let near = |a: DVec3, b: DVec3| (a - b).length() < 1e-12;
    assert!(near(m.transform_vector3(DVec3::Z), -DVec3::X), "forward");
    assert!(near(m.transform_vector3(DVec3::X), -DVec3::Z), "right");
    assert!(near(m.transform_vector3(DVec3::Y), DVec3::Y), "up");
    assert!(near(m.transform_point3(DVec3::ZERO), DVec3::new(1.0, 2.0, 3.0)));
    assert!(m.matrix3.determinant() < 0.0, "from a left-handed to a right-handed space");
}

#[test]
fn orthographic_cameras_give_the_window() {
    let d = json!({"cameras": [{"type": "orthographic", "orthographic": {"xmag": 2, "ymag": 1, "zfar": 9, "znear": 0}}],
        "nodes": [{"camera": 0}]});
    let node = &import_well(d, &[]).desc.cameras[0].node;
    assert_eq!(
        (node.kind.as_str(), numbers(node, "screenwindow")),
        ("orthographic", vec![-2.0, 2.0, -1.0, 1.0])
    );
}

#[test]
fn punctual_lights_shine_along_minus_z() {
    let d = json!({
        "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": {"KHR_lights_punctual": {"lights": [
            {"type": "point", "color": [1, 0.5, 0.25], "intensity": 8},
            {"type": "spot", "name": "s", "spot": {"outerConeAngle": 0.5, "innerConeAngle": 0.25}},
            {"type": "directional", "intensity": 3},
        ]}},
        "nodes": [{"children": [1, 2, 3]},
            {"translation": [1, 2, 3], "scale": [9, 9, 9], "extensions": {"KHR_lights_punctual": {"light": 0}}},
            {"extensions": {"KHR_lights_punctual": {"light": 1}}},
            {"extensions": {"KHR_lights_punctual": {"light": 2}}}],
    });
    let desc = import_well(d, &[]).desc;
    let [point, spot, sun] = &desc.lights[..] else { panic!("three lights") };
    assert_eq!((point.node.kind.as_str(), numbers(&point.node, "I")), ("point", vec![8.0, 4.0, 2.0]));
    let placed = point.world_from_light.at(0.0);
    assert!((placed.transform_point3(DVec3::X) - DVec3::new(2.0, 2.0, 3.0)).length() < 1e-12, "no scale");
    assert_eq!((spot.name.as_str(), spot.node.kind.as_str()), ("s", "spot"));
    assert_eq!(numbers(&spot.node, "to"), [0.0, 0.0, -1.0]);
    let degrees = 0.5f64.to_degrees() as f32;
    assert_eq!(numbers(&spot.node, "coneangle"), [degrees]);
    assert!((numbers(&spot.node, "conedeltaangle")[0] - degrees / 2.0).abs() < 1e-5);
    assert_eq!((sun.node.kind.as_str(), numbers(&sun.node, "L")), ("distant", vec![3.0; 3]));
    assert_eq!(numbers(&sun.node, "to"), [0.0, 0.0, -1.0]);
}

#[test]
fn unlit_materials_keep_their_colour_and_lose_all_else() {
    let d = json!({"nodes": [{}], "materials": [{"extensions": {"KHR_materials_unlit": {}}, "emissiveFactor": [1, 1, 1],
        "alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0, 0.25]}}]});
    let imported = import_well(d, &[]);
    let m = &imported.desc.materials[0].node;
    assert!(matches!(m.params.get("unlit").map(|p| &p.data), Some(Data::Bools(v)) if v[..] == [true]));
    assert_eq!((numbers(m, "basecolor"), numbers(m, "alpha")), (vec![1.0, 0.5, 0.0], vec![0.25]));
    assert!(m.params.get("emission").is_none() && m.params.get("metallic").is_none());
    assert!(imported.diagnostics.is_empty(), "{:?}", imported.diagnostics);
}

#[test]
fn a_thousand_warnings_do_not_print_a_book() {
    let wild = |i: usize| json!({"pbrMetallicRoughness": {"roughnessFactor": 2 + i}});
    let imported =
        import_well(json!({"nodes": [{}], "materials": (0..1000).map(wild).collect::<Vec<_>>()}), &[]);
    let said: Vec<&str> = imported.diagnostics.iter().map(|d| d.message.as_str()).collect();
    assert_eq!(said.len(), 51);
    assert!(said[50].contains("left out") && said[49].contains("roughnessFactor 51"), "{said:?}");
}

#[test]
fn faults_of_looks_point_at_their_cause() {
    let material = |m: Value| with_images(json!({"materials": [m]}));
    for (d, pointer, text) in [
        (material(json!({"alphaMode": "blend"})), "/materials/0/alphaMode", "found \"blend\""),
        (
            material(json!({"normalTexture": {"index": 7}})),
            "/materials/0/normalTexture/index",
            "only 2 textures",
        ),
        (material(json!({"emissiveFactor": [1, "x", 1]})), "/materials/0/emissiveFactor/1", "found a string"),
        (
            json!({"cameras": [{"type": "fisheye"}], "nodes": [{"camera": 0}]}),
            "/cameras/0/type",
            "\"fisheye\"",
        ),
        (
            json!({"cameras": [{"type": "perspective", "perspective": {"yfov": 4}}], "nodes": [{"camera": 0}]}),
            "/cameras/0/perspective/yfov",
            "between 0 and pi",
        ),
        (
            json!({"nodes": [{"extensions": {"KHR_lights_punctual": {"light": 0}}}]}),
            "/nodes/0/extensions/KHR_lights_punctual/light",
            "lights/0, but there are none",
        ),
    ] {
        let found = first(&import(d, &[]), Severity::Error);
        assert!(found.0 == pointer && found.1.contains(text), "{found:?}");
    }
}

/// The picture has the proportions of the first camera, which the program's size options keep.
#[test]
fn the_first_camera_says_what_proportions_the_picture_has() {
    let scene = |ratio: Value| {
        let camera = |ratio| json!({"type": "perspective", "perspective": {"yfov": 1, "znear": 1, "aspectRatio": ratio}});
        let document = json!({
            "nodes": [{"camera": 0}, {"camera": 1}],
            "scenes": [{"nodes": [0, 1]}],
            "cameras": [camera(ratio), camera(json!(3))],
        });
        let film = import_well(document, &[0; 4]).desc.film;
        (film.width, film.height)
    };
    assert_eq!(scene(json!(1.6)), (Some(1280), Some(800)));
    assert_eq!(scene(json!(0.5)), (Some(1280), Some(2560)));
    for senseless in [0.0, -1.0, 1e9] {
        assert_eq!(scene(json!(senseless)), (None, None));
    }
}

#[test]
fn samplers_that_ask_for_mipmaps_get_smaller_copies() {
    for (min, mag, expected) in [
        (9987, 9729, Some("trilinear")),
        (9984, 9729, Some("trilinear")),
        (9729, 9729, None),
        (9987, 9728, Some("point")),
    ] {
        let mut d = with_images(json!({"materials": [
            {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}
        ]}));
        d["samplers"] = json!([{"minFilter": min, "magFilter": mag}]);
        let desc = import_well(d, &[]).desc;
        let filter =
            desc.textures[0].node.params.get("filter").map(|_| word(&desc.textures[0].node, "filter"));
        assert_eq!(filter.as_deref(), expected, "{min} {mag}");
    }
}
