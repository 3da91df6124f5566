//! The lanterns of the built-in hall in haze fade as Beer and Lambert say.
#![allow(clippy::expect_used, reason = "a scene that lacks what a test looks for is a failed test")]
use std::collections::BTreeMap;

use durer::{Options, builtin};
use durer_tests::prepared;

#[test]
fn each_lantern_is_left_by_its_distance() {
    // Without bounces no light is scattered into the way: what is seen is what is left.
    let options = Options { width: Some(960), samples: Some(4096), max_depth: Some(0), ..Options::default() };
    let hall = prepared(builtin::find("fog").expect("built in").import(), &options);
    let job = hall.job();
    let (mut pixels, mut distances) = (BTreeMap::new(), BTreeMap::new());
    for i in 0..(480 * 100) {
        let pixel = [480 + i % 480, 60 + (i / 480) * 3];
        for sample in 0..4 {
            let eye = job.record(pixel, sample).0.nodes[0].clone();
            let Some(hit) = eye.hit else { continue };
            let name = &hall.scene.object(hit.object).name;
            if name.starts_with("lantern") && hit.cos > 0.85 {
                pixels.insert(name.clone(), pixel);
                distances.insert(name.clone(), f64::from(hit.hit.t));
            }
        }
    }
    assert!(pixels.len() >= 3, "{pixels:?}");
    let mut before = 0.0;
    for (name, pixel) in pixels {
        let distance = distances[&name];
        let sum: f64 = (0..4096).map(|sample| f64::from(job.value(pixel, sample)[0])).sum();
        let expected = 22.0 * (-0.054 * distance).exp();
        let found = sum / 4096.0;
        assert!(
            (found / expected - 1.0).abs() < 0.03,
            "{name} at {distance} m: {found}, expected {expected}"
        );
        assert!(distance > before, "the first one is the nearest");
        before = distance;
    }
}

#[test]
fn integrators_that_see_no_media_name_those_they_leave_out() {
    for (integrator, says) in
        [("path", true), ("light", false), ("bdpt", false), ("sppm", true), ("volpath", false)]
    {
        let mut imported = builtin::find("fog").expect("built in").import();
        let options = Options { integrator: Some(integrator.to_owned()), ..Options::default() };
        assert!(durer::prepare(&mut imported, &options).is_some());
        let mut all = imported.diagnostics.iter();
        let said =
            all.any(|d| d.message.contains("does not see the medium") && d.message.contains("\"haze\""));
        assert_eq!(said, says, "{integrator}");
    }
}

#[test]
fn light_tracing_says_what_glows_without_an_end() {
    let body = "Material \"interface\" MediumInterface \"fire\" \"\" Shape \"sphere\"";
    let around = "Material \"interface\" MediumInterface \"\" \"fire\" Shape \"sphere\"";
    for (integrator, shape, says) in
        [("light", around, true), ("light", body, false), ("bdpt", around, false), ("volpath", around, false)]
    {
        let text = format!(
            "Integrator \"{integrator}\"\nWorldBegin\nLightSource \"point\"\n\
             MakeNamedMedium \"fire\" \"string type\" \"homogeneous\" \"rgb Le\" [1 1 1]\n\
             MakeNamedMedium \"ash\" \"string type\" \"homogeneous\"\n{shape}"
        );
        let mut imported = durer_tests::import(&text);
        assert!(durer::prepare(&mut imported, &Options::default()).is_some());
        let all = imported.diagnostics.iter();
        let said: Vec<_> = all.filter(|d| d.message.contains("glows without an end")).collect();
        assert_eq!(said.len(), usize::from(says), "{integrator}: {said:?}");
        assert!(said.iter().all(|d| d.message.contains("\"fire\"")), "{said:?}");
    }
}
