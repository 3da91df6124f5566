//! What becomes of hair, of integrators of other versions and of sensors that are no cameras.
#![allow(clippy::expect_used, clippy::indexing_slicing, reason = "a test that fails may panic")]
mod mitsuba_scene;

use durer_core::glam::DVec3;
use durer_io::import::{Reading, open};
use durer_scene::{Data, Severity};
use mitsuba_scene::{errors, material, scene, told};

#[test]
fn hair_has_pigments_or_absorbs() {
    let brown = scene("<bsdf type=\"hair\"/>");
    let of = |name: &str| material(&brown, name)[0];
    assert_eq!(["eumelanin", "pheomelanin", "beta_m", "beta_n", "alpha"].map(of), [1.3, 0.2, 0.3, 0.3, 2.0]);
    assert!((of("eta") - 1.55 / 1.000_277).abs() < 1e-6);
    let color = "<rgb name=\"sigma_a\" value=\"0.25, 0.5, 1\"/>";
    let own = format!("<bsdf type=\"hair\">{color}<float name=\"scale\" value=\"4\"/></bsdf>");
    assert_eq!(material(&scene(&own), "sigma_a"), [1.0, 2.0, 4.0]);
    let both = format!("<bsdf type=\"hair\">{color}<float name=\"eumelanin\" value=\"1\"/></bsdf>");
    assert!(errors(&both)[0].contains("expected one of them"), "{:?}", errors(&both));
}

#[test]
fn integrators_of_other_versions_are_read_as_ours() {
    let of = |inside: &str| scene(inside).desc.integrator.expect("one");
    for (theirs, ours) in
        [("pssmlt", "bdpt"), ("mlt", "bdpt"), ("erpt", "bdpt"), ("vpl", "path"), ("ppm", "sppm")]
    {
        assert_eq!(of(&format!("<integrator type=\"{theirs}\"/>")).kind, ours);
    }
    let photons = of("<integrator type=\"sppm\"><float name=\"initial_radius\" value=\"0.25\"/>\
                      <integer name=\"photon_count\" value=\"5000\"/></integrator>");
    assert_eq!(photons.params.get("radius").map(|p| &p.data), Some(&Data::Floats(vec![0.25])));
    assert_eq!(photons.params.get("photonsperiteration").map(|p| &p.data), Some(&Data::Ints(vec![5000])));
    let hides = "<boolean name=\"hide_emitters\" value=\"true\"/>";
    for word in ["path", "direct", "volpath", "volpathmis"] {
        let read = scene(&format!("<integrator type=\"{word}\">{hides}</integrator>"));
        assert_eq!(told(&read, Severity::Warning), Vec::<String>::new(), "{word}");
        let hidden = read.desc.integrator.expect("one");
        assert_eq!(
            hidden.params.get("hideemitters").map(|p| &p.data),
            Some(&Data::Bools(vec![true])),
            "{word}"
        );
    }
    let told = told(&scene(&format!("<integrator type=\"bdpt\">{hides}</integrator>")), Severity::Warning);
    assert!(told[0].contains("no counterpart"), "{told:?}");
}

#[test]
fn what_is_no_camera_says_what_to_take_instead() {
    let meter = scene(
        "<sensor type=\"radiancemeter\"><point name=\"origin\" value=\"1, 2, 3\"/>\
                       <vector name=\"direction\" value=\"0, 0, -2\"/></sensor>",
    );
    assert_eq!(told(&meter, Severity::Error), Vec::<String>::new());
    let placed = meter.desc.cameras[0].world_from_camera.at(0.0);
    assert_eq!(placed.transform_point3(DVec3::ZERO), DVec3::new(1.0, 2.0, 3.0));
    assert!((placed.transform_vector3(DVec3::Z) + DVec3::Z).length() < 1e-12);
    for name in ["irradiancemeter", "distant", "batch"] {
        let said = errors(&format!("<sensor type=\"{name}\"/>"));
        assert!(said[0].contains("no counterpart (") && said[0].len() > 80, "{said:?}");
    }
    assert!(
        errors("<sensor type=\"radiancemeter\"><point name=\"origin\" value=\"1, 2, 3\"/></sensor>")[0]
            .contains("both")
    );
}

#[test]
fn strands_are_read_from_text() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("written");
    write(
        "strands.txt",
        "0 0 0 0.5\n1 0 0 0.25\n1 1 0 0.25\n1 1 1 0\n\n0 0 5 1\n0 0 6 1\n0 0 7 1\n0 0 8 1\n0 0 9 1\n",
    );
    let read = |kind: &str, file: &str| {
        let placed = "<transform name='to_world'><scale value='2'/><translate x='10'/></transform>";
        let file = format!("<string name='filename' value='{file}'/>");
        write(
            "scene.xml",
            &format!("<scene version='3.0.0'><shape type='{kind}'>{file}{placed}</shape></scene>"),
        );
        open(&folder.path().join("scene.xml"), Reading::default())
    };
    let splines = read("bsplinecurve", "strands.txt");
    assert_eq!(told(&splines, Severity::Warning), Vec::<String>::new());
    let numbers = |shape: &durer_scene::ShapeDesc, name: &str| match &shape.source {
        durer_scene::ShapeSource::Node(node) => match node.params.get(name).map(|p| &p.data) {
            Some(Data::Floats(v)) => v.clone(),
            other => panic!("{other:?}"),
        },
        durer_scene::ShapeSource::Mesh(_) => panic!("a mesh"),
    };
    let [first, second] = splines.desc.shapes.as_slice() else { panic!("two strands") };
    // Points are placed, and widths stay.
    assert_eq!(numbers(first, "P")[..6], [10.0, 0.0, 0.0, 12.0, 0.0, 0.0]);
    assert_eq!(numbers(first, "widths"), [1.0, 0.5, 0.5, 0.0]);
    assert_eq!((numbers(second, "P").len(), numbers(second, "widths")), (15, vec![2.0; 5]));
    let there = first.world_from_object.at(0.0).transform_point3(DVec3::new(12.0, 0.0, 0.0));
    assert!((there - DVec3::new(12.0, 0.0, 0.0)).length() < 1e-9, "{there:?}");
    let straight = read("linearcurve", "strands.txt");
    let pieces = &straight.desc.shapes[0];
    assert_eq!((numbers(pieces, "P").len(), numbers(pieces, "widths").len()), (30, 10));
    write("short.txt", "0 0 0 1\n1 0 0 1\n");
    let short = told(&read("bsplinecurve", "short.txt"), Severity::Error);
    assert!(short[0].contains("short.txt: a strand has 2 control points, expected 4"), "{short:?}");
    assert!(told(&read("bsplinecurve", "nowhere.txt"), Severity::Error)[0].contains("file not found"));
}

#[test]
fn phases_and_grids_of_media_are_kept() {
    let medium = |inside: &str| {
        let all = scene(&format!("<medium type='homogeneous' id='m'>{inside}</medium>"));
        assert_eq!(told(&all, Severity::Warning), Vec::<String>::new());
        all.desc.media[0].node.clone()
    };
    let air = medium("<phase type='rayleigh'/>");
    assert_eq!(air.params.get("phase").map(|p| &p.data), Some(&Data::Strings(vec!["rayleigh".to_owned()])));
    assert!(air.params.get("g").is_none());
    let on = medium("<phase type='hg'><float name='g' value='0.5'/></phase>");
    assert_eq!(on.params.get("g").map(|p| &p.data), Some(&Data::Floats(vec![0.5])));
}
