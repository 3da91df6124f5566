//! D4: planted bugs are named by `durer explain`, each by its own name and no other.
//!
//! A bug is an integrator that sees another scene than the one that is explained: lights in other places, normals turned,
//! indices of refraction swapped. It runs through the ordinary recorder.
use durer::{
    Contribution, Options, PathRay, Prepared, SampleCx, Scene,
    explain::{Explanation, Law, check, explain},
    integrator::{EyeSamples, Facts, Integrator},
    math::Vector3,
    probe::{Counters, RayKind, RayTree, Recorder, TreeNode},
    spectrum::Spectrum,
    tree::Subject,
};
use durer_tests::scene;

/// An integrator that sees a scene of its own.
struct Wrong {
    inner: Box<dyn Integrator>,
    scene: Scene,
}

impl Wrong {
    fn cx<'a>(&'a self, cx: &SampleCx<'_>) -> SampleCx<'a> {
        SampleCx { scene: &self.scene, basis: cx.basis }
    }
}

impl Integrator for Wrong {
    fn facts(&self) -> Facts {
        self.inner.facts()
    }
    fn eye_samples(&self, asked: u32) -> EyeSamples {
        self.inner.eye_samples(asked)
    }
    fn sample(&self, cx: &SampleCx<'_>, ray: &PathRay, out: &mut Contribution) {
        self.inner.sample(&self.cx(cx), ray, out);
    }
    fn record(&self, cx: &SampleCx<'_>, ray: &PathRay, out: &mut Contribution, recorder: &mut Recorder<'_>) {
        self.inner.record(&self.cx(cx), ray, out, recorder);
    }
    fn replay(
        &self,
        cx: &SampleCx<'_>,
        node: &TreeNode,
        out: &mut Contribution,
        recorder: &mut Recorder<'_>,
    ) {
        self.inner.replay(&self.cx(cx), node, out, recorder);
    }
    fn count(&self, cx: &SampleCx<'_>, ray: &PathRay, out: &mut Contribution, counters: &mut Counters) {
        self.inner.count(&self.cx(cx), ray, out, counters);
    }
}

fn text(world: &str) -> String {
    format!(
        "Film \"rgb\" \"integer xresolution\" 33 \"integer yresolution\" 33\n\
         LookAt 0 3 -6  0 0.7 0  0 1 0\nCamera \"perspective\" \"float fov\" 40\nWorldBegin\n{world}"
    )
}

fn options(integrator: &str) -> Options {
    Options { integrator: Some(integrator.to_owned()), samples: Some(2), ..Options::default() }
}

/// The scene `world`, traced by an integrator that takes it for `seen`.
fn planted(world: &str, seen: &str, integrator: &str) -> Prepared {
    let mut prepared = scene(&text(world), &options(integrator));
    let wrong = scene(&text(seen), &options(integrator));
    prepared.integrator = Box::new(Wrong { inner: wrong.integrator, scene: wrong.scene });
    prepared
}

fn explained(prepared: &Prepared, pixel: [u32; 2]) -> Explanation {
    let subject = Subject { name: "test", prepared };
    explain(&subject, pixel, &subject.samples(pixel), None)
}

/// The text names this law's breach with these words, and no other law's.
fn assert_names(explanation: &Explanation, law: Law, words: &[&str]) {
    let findings = &explanation.findings;
    assert!(!findings.is_empty(), "nothing was found");
    assert!(findings.iter().all(|f| f.finding.law == law), "{findings:#?}");
    let text = explanation.text(false);
    assert!(text.contains("Something is wrong here."), "{text}");
    for word in words {
        assert!(text.contains(word), "no {word:?} in:\n{text}");
    }
}

const FLOOR: &str = "Material \"classic\" \"rgb diffuse\" [0.5 0.5 0.5]\n\
    Shape \"polygon\" \"string name\" \"floor\" \"point3 P\" [-9 0 -9  -9 0 9  9 0 9  9 0 -9]\n";

fn lights(sun: &str, lamp: &str) -> String {
    format!(
        "LightSource \"distant\" \"string name\" \"sun\" \"point3 from\" [{sun}] \"point3 to\" [0 0 0]\n\
         LightSource \"point\" \"string name\" \"lamp\" \"point3 from\" [{lamp}] \"rgb I\" [9 9 9]\n{FLOOR}"
    )
}

#[test]
fn shadow_rays_toward_the_wrong_light_are_named() {
    // The sun stands 45 degrees high in the one scene and in the zenith in the other.
    let (world, seen) = (lights("0 1 1", "2 3 0"), lights("0 1 0", "2 3 0"));
    for integrator in ["whitted", "distributed"] {
        let explanation = explained(&planted(&world, &seen, integrator), [16, 20]);
        let words = ["The shadow ray to light \"sun\" points 45.0 degrees away from it"];
        assert_names(&explanation, Law::ShadowRay, &words);
        assert!(!explanation.text(false).contains("light \"lamp\" points"));
    }
    // Both take the place of the other: seen from the middle, light in the zenith and light beside it.
    let (world, seen) = (lights("0 1 0", "4 3 0"), lights("4 3 0", "0 90 0"));
    let explanation = explained(&planted(&world, &seen, "whitted"), [16, 20]);
    assert_names(
        &explanation,
        Law::ShadowRay,
        &["to light \"sun\"", "to light \"lamp\"", "it points to light \"sun\""],
    );
}

#[test]
fn shadow_rays_toward_the_wrong_lamp_with_extent_are_named() {
    let lamp = |x: f32| {
        format!(
            "{FLOOR}AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [9 9 9]\nTranslate {x} 3 0\n\
             Shape \"sphere\" \"string name\" \"lamp\" \"float radius\" 0.2\nAttributeEnd\n"
        )
    };
    let explanation = explained(&planted(&lamp(1.0), &lamp(2.5), "distributed"), [16, 20]);
    assert_names(&explanation, Law::ShadowRay, &["The shadow ray to light \"", "degrees away from it"]);
    assert!(explained(&planted(&lamp(1.0), &lamp(1.0), "distributed"), [16, 20]).findings.is_empty());
}

const BALL: &str = "Shape \"sphere\" \"string name\" \"ball\" \"float radius\" 1\n";

#[test]
fn flipped_normals_are_named() {
    for material in ["\"diffuse\"", "\"dielectric\" \"float eta\" 1.5"] {
        let world = |turn: &str| {
            format!("{}Material {material}\nTranslate 0 1 0\n{turn}\n{BALL}", lights("0 1 -1", "2 3 0"))
        };
        let prepared = planted(&world(""), &world("ReverseOrientation"), "whitted");
        let explanation = explained(&prepared, [16, 16]);
        assert_names(&explanation, Law::Normal, &["The normal of \"ball\"", "is flipped", "inside"]);
    }
}

fn glass(eta: f32) -> String {
    format!(
        "{}Material \"dielectric\" \"float eta\" {eta}\nTranslate 0 1 0\n{BALL}",
        lights("0 1 -1", "2 3 0")
    )
}

#[test]
fn swapped_indices_of_refraction_are_named() {
    for integrator in ["whitted", "distributed"] {
        let explanation = explained(&planted(&glass(1.5), &glass(1.0 / 1.5), integrator), [17, 18]);
        let words =
            ["refracted at \"ball\"", "sin a / sin b = 0.667, the media say 1.5: n1 and n2 are swapped"];
        assert_names(&explanation, Law::Snell, &words);
    }
    // Near the rim the wrong ratio reflects all.
    let rim = (16..33).find_map(|x| {
        let explanation = explained(&planted(&glass(1.5), &glass(1.0 / 1.5), "whitted"), [x, 16]);
        explanation.text(false).contains("all light is said to be reflected inside").then_some(explanation)
    });
    assert_names(&rim.expect("a place where all is reflected"), Law::Snell, &["n1 and n2 are swapped"]);
}

#[test]
fn a_body_that_is_turned_inside_out_is_named() {
    let world = format!(
        "{}Material \"dielectric\" \"float eta\" 1.5\nTranslate 0 1 0\nReverseOrientation\n{BALL}",
        lights("0 1 -1", "2 3 0")
    );
    let prepared = scene(&text(&world), &options("whitted"));
    assert_names(
        &explained(&prepared, [16, 16]),
        Law::Media,
        &["leaves \"ball\" without having entered it", "turned inside out"],
    );
}

#[test]
fn a_surface_that_makes_light_is_named() {
    let world = format!(
        "{}Material \"classic\" \"rgb reflection\" [0.8 0.8 0.8] \"rgb transmission\" [0.7 0.7 0.7] \
         \"float eta\" 1.5\nTranslate 0 1 0\n{BALL}",
        lights("0 1 -1", "2 3 0")
    );
    let prepared = scene(&text(&world), &options("whitted"));
    let words = ["\"ball\" reflects and transmits more than it gets: the weights of its rays sum to 1.5"];
    assert_names(&explained(&prepared, [16, 16]), Law::Energy, &words);
}

/// The tree of a pixel with a mirror, a light and a floor.
fn mirror_tree() -> (Prepared, RayTree) {
    let world = format!("{}Material \"mirror\"\nTranslate 0 1 0\n{BALL}", lights("0 1 -1", "2 3 0"));
    let prepared = scene(&text(&world), &options("whitted"));
    let tree = prepared.job().record([16, 19], 0).0;
    assert!(check(&prepared, &tree).is_empty());
    (prepared, tree)
}

/// What a tree breaks that was changed after it was recorded.
fn broken(change: impl FnOnce(&mut RayTree, usize)) -> Vec<(Law, String)> {
    let (prepared, mut tree) = mirror_tree();
    let mirrored = tree.nodes.iter().position(|n| n.kind == RayKind::Reflection).expect("a mirrored ray");
    assert!(tree.nodes[mirrored].hit.is_some());
    change(&mut tree, mirrored);
    check(&prepared, &tree).into_iter().map(|f| (f.law, f.text)).collect()
}

#[test]
fn rays_that_are_not_mirrored_are_named() {
    let found = broken(|tree, mirrored| {
        let node = &mut tree.nodes[mirrored];
        node.d = (node.d + Vector3::new(0.0, 0.0, 0.1)).normalize();
        node.hit = None;
    });
    assert!(matches!(&found[..], [(Law::Mirror, text)] if text.contains("leaves \"ball\"")), "{found:?}");
}

#[test]
fn sums_that_are_wrong_are_named() {
    let found = broken(|tree, mirrored| tree.nodes[mirrored].result += Spectrum::splat(0.25));
    assert!(found.iter().all(|f| f.0 == Law::Sum) && found.len() == 1, "{found:?}");
    let found = broken(|tree, mirrored| tree.nodes[mirrored].throughput = Spectrum::splat(0.25));
    assert!(found.iter().any(|f| f.0 == Law::Sum && f.1.contains("share")), "{found:?}");
}

#[test]
fn numbers_that_are_none_and_negative_light_are_named() {
    let found = broken(|tree, _| {
        tree.nodes[0].local = Spectrum::splat(f32::NAN);
        tree.nodes[0].result = Spectrum::splat(f32::NAN);
    });
    assert!(matches!(&found[..], [(Law::Energy, text)] if text.contains("NaN")), "{found:?}");
    let found = broken(|tree, mirrored| {
        tree.nodes[mirrored].local = Spectrum::splat(-1.0);
    });
    assert!(found.iter().any(|f| f.0 == Law::Energy && f.1.contains("negative")), "{found:?}");
}

#[test]
fn a_body_without_a_back_is_named() {
    let world = format!(
        "{}Material \"dielectric\" \"float eta\" 1.5\n\
         Shape \"polygon\" \"string name\" \"pane\" \"point3 P\" [-2 0 0  2 0 0  2 3 0  -2 3 0]\n",
        lights("0 1 -1", "2 3 0")
    );
    let sides = ["", "ReverseOrientation\n"].map(|turn| {
        let prepared = scene(
            &text(&world.replace(
                "Shape \"polygon\" \"string name\" \"pane\"",
                &format!("{turn}Shape \"polygon\" \"string name\" \"pane\""),
            )),
            &options("whitted"),
        );
        explained(&prepared, [16, 16])
    });
    let wrong: Vec<_> = sides.iter().filter(|e| !e.findings.is_empty()).collect();
    assert_eq!(wrong.len(), 1, "one of its sides is an inside");
    assert_names(wrong[0], Law::Media, &["leaves \"pane\" without having entered it", "is open"]);
}

/// What a tree of a glass ball breaks whose refracted ray was changed.
fn broken_glass(change: impl FnOnce(&mut TreeNode)) -> Vec<(Law, String)> {
    let prepared = scene(&text(&glass(1.5)), &options("whitted"));
    let mut tree = prepared.job().record([18, 18], 0).0;
    let refracted = tree.nodes.iter().position(|n| n.kind == RayKind::Refraction).expect("a refracted ray");
    change(&mut tree.nodes[refracted]);
    check(&prepared, &tree).into_iter().map(|f| (f.law, f.text)).collect()
}

#[test]
fn shares_that_are_not_fresnels_are_named() {
    let found = broken_glass(|node| node.weight = Spectrum::splat(0.04));
    let said = found.iter().find(|f| f.0 == Law::Fresnel).map(|f| f.1.as_str()).unwrap_or_default();
    assert!(
        said.contains("must be transmitted (n1 = 1, n2 = 1.5") && said.ends_with("weighs 0.04"),
        "{found:?}"
    );
    assert!(found.iter().all(|f| matches!(f.0, Law::Fresnel | Law::Sum)), "{found:?}");
}

#[test]
fn rays_that_forget_the_body_they_entered_are_named() {
    let found = broken_glass(|node| node.path.media = Default::default());
    assert!(found.iter().any(|f| f.0 == Law::Media && f.1.contains("starts in other bodies")), "{found:?}");
}
