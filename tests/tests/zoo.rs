//! One scene with a bit of everything: meshes, shapes, cut-outs, instances, movers. What holds for the built-in scene must
//! hold here as well.
use durer::{Imported, Options, Prepared, accel::Engine, spectrum::Basis};
use durer_tests::{bits, import, prepared, render, scene, shared};

const ZOO: &str = r#"
Film "rgb" "integer xresolution" 72 "integer yresolution" 54
Sampler "zsobol" "integer pixelsamples" 6
Integrator "whitted" "integer maxdepth" 6
LookAt 0 2.2 -6  0 0.9 0  0 1 0
Camera "perspective" "float fov" 42 "float shutteropen" 0.2 "float shutterclose" 0.8
WorldBegin
LightSource "gradientsky"
LightSource "point" "rgb I" [30 28 25] "point3 from" [-3 5 -3]
LightSource "spot" "rgb I" [40 40 60] "point3 from" [3 5 -2] "point3 to" [1 0 0]
Texture "stripes" "float" "checkerboard" "float uscale" 6 "float vscale" 6
Texture "board" "spectrum" "checkerboard" "float uscale" 1 "float vscale" 1 "rgb tex1" [.2 .3 .7] "rgb tex2" [.9 .8 .6]
Material "diffuse" "texture reflectance" "board"
Shape "plane"
AttributeBegin
  Material "principled" "texture alpha" "stripes" "string alphamode" "mask" "rgb basecolor" [.8 .2 .1]
  Shape "disk" "float radius" 0.8 "float height" 0.01
  Translate -1.6 0.8 0.2
  Shape "trianglemesh" "point3 P" [-.8 -.8 0 .8 -.8 0 .8 .8 0 -.8 .8 0] "integer indices" [0 1 2 0 2 3]
    "point2 uv" [0 0 1 0 1 1 0 1]
  Material "diffuse" "rgb reflectance" [.1 .6 .2]
  Shape "trianglemesh" "point3 P" [-.8 -.8 0 .8 -.8 0 .8 .8 0 -.8 .8 0] "integer indices" [0 1 2 0 2 3]
AttributeEnd
ObjectBegin "pyramid"
  Material "mirror"
  Shape "trianglemesh" "point3 P" [-.3 0 -.3 .3 0 -.3 .3 0 .3 -.3 0 .3 0 .6 0]
    "integer indices" [0 1 4 1 2 4 2 3 4 3 0 4]
  Material "dielectric"
  AttributeBegin
    Translate 0 0.8 0
    Shape "sphere" "float radius" 0.2
  AttributeEnd
ObjectEnd
AttributeBegin
  Translate 1.2 0 -1
  Rotate 30 0 1 0
  ObjectInstance "pyramid"
AttributeEnd
AttributeBegin
  Translate 0.3 0 -1.6
  Scale -0.7 1.2 0.7
  ObjectInstance "pyramid"
AttributeEnd
AttributeBegin
  Material "classic" "rgb diffuse" [.6 .1 .1] "rgb specular" [.5 .5 .5] "rgb reflection" [.2 .2 .2]
  Translate 1.4 1.2 1
  ActiveTransform EndTime
  Translate 0.5 0.3 0
  Rotate 70 0 0 1
  ActiveTransform All
  Scale 1 0.6 1
  Shape "sphere" "float radius" 0.6 "float zmin" -0.4 "float phimax" 300
AttributeEnd
AttributeBegin
  Material "diffuse" "rgb reflectance" [.7 .7 .2]
  ActiveTransform EndTime
  Translate -0.3 0.5 0
  ActiveTransform All
  Translate 0 1.4 1.5
  Shape "trianglemesh" "point3 P" [-.5 0 0 .5 0 0 0 .7 0] "integer indices" [0 1 2]
  Shape "polygon" "point3 P" [-1 -1 1 1 -1 1 1 1 1 -1 1 1 -.5 -.5 1 -.5 .5 1 .5 .5 1 .5 -.5 1] "integer counts" [4 4]
AttributeEnd
"#;

/// What to open, and how.
type Exhibit = (String, fn(&str) -> Imported);

/// The zoo, and real glTF files where there are some.
fn scenes(test: &str) -> Vec<Exhibit> {
    let mut scenes: Vec<Exhibit> = vec![(ZOO.to_owned(), import)];
    if let Some(folder) = shared(test) {
        for file in ["AlphaBlendModeTest.glb", "NegativeScaleTest.glb", "SimpleInstancing.glb"] {
            let path = folder.join("assets/gltf").join(file);
            scenes.push((path.to_string_lossy().into_owned(), |path| durer::open(path)));
        }
    }
    scenes
}

fn small(options: Options) -> Options {
    Options { width: Some(72), height: Some(54), samples: Some(5), ..options }
}

#[test]
fn threads_hierarchy_and_recording_change_no_bit() {
    for (what, open) in scenes("zoo") {
        let ready = |options: Options| -> Prepared { prepared(open(&what), &small(options)) };
        let one = ready(Options { threads: Some(1), ..Options::default() });
        let expected = bits(&render(&one));
        assert!(expected.iter().any(|p| *p != expected[0]), "{what} shows something");
        assert!(
            expected == bits(&render(&ready(Options { threads: Some(3), ..Options::default() }))),
            "threads"
        );
        for i in 0..60u32 {
            let (tree, rgb) = one.job().record([(i * 29) % 72, (i * 11) % 54], i % 5);
            assert_eq!(Basis::Rgb.to_rgb(tree.fold()).map(f32::to_bits), rgb.map(f32::to_bits), "fold");
        }
    }
}

#[test]
fn brute_force_sees_the_same_zoo() {
    let brute = Options { engine: Engine::BruteForce, ..Options::default() };
    assert!(
        bits(&render(&scene(ZOO, &small(brute)))) == bits(&render(&scene(ZOO, &small(Options::default()))))
    );
}

/// A masked square and an opaque one in the same plane, seen and lit from the front.
fn decal(first: &str, second: &str) -> String {
    let square = "Shape \"trianglemesh\" \"point3 P\" [-1 -1 0 1 -1 0 1 1 0 -1 1 0] \"integer indices\" [0 1 2 0 2 3]\n";
    format!(
        "Film \"rgb\" \"integer xresolution\" 5 \"integer yresolution\" 5\nLookAt 0 0 -3 0 0 0 0 1 0\n\
         Camera \"perspective\" \"float fov\" 20\nWorldBegin\n\
         LightSource \"distant\" \"point3 from\" [0 0 -1] \"point3 to\" [0 0 0] \"rgb L\" [1 1 1]\n\
         {first}{square}{second}{square}\
         Material \"diffuse\"\nShape \"plane\" \"point3 point\" [0 0 2] \"vector3 normal\" [0 0 -1]\n"
    )
}

#[test]
fn a_hole_hides_nothing_that_lies_in_the_same_plane() {
    let hole = "Material \"principled\" \"string alphamode\" \"mask\" \"float alpha\" 0.2\n";
    let red = "Material \"diffuse\" \"rgb reflectance\" [1 0 0]\n";
    for (first, second) in [(hole, red), (red, hole)] {
        for engine in [Engine::Bvh, Engine::BruteForce] {
            let options =
                Options { integrator: Some("cast".into()), engine, samples: Some(1), ..Options::default() };
            let text = decal(first, second).replace("Camera", "Sampler \"independent\"\nCamera");
            let prepared = scene(&text, &Options { show: Some(durer::Show::Albedo), ..options });
            assert!(
                render(&prepared).film.pixels().iter().all(|p| p.mean() == [1.0, 0.0, 0.0]),
                "{engine:?}"
            );
            // From behind the wall's shadow: the red square keeps the light from the wall.
            let wall = decal(first, second).replace("LookAt 0 0 -3 0 0 0", "LookAt 0 0 1 0 0 2");
            let direct = Options { integrator: Some("whitted".into()), ..Options::default() };
            let wall = scene(&wall, &Options { engine, samples: Some(1), ..direct });
            assert!(render(&wall).film.pixels().iter().all(|p| p.mean() == [0.0; 3]), "{engine:?}");
        }
    }
}

#[test]
fn the_cameras_shutter_is_used_if_something_moves_and_options_win() {
    let of = |options: Options| scene(ZOO, &small(options)).scene.view.shutter.interval();
    let interval = |min, max| durer::math::Interval::new(min, max);
    assert_eq!(of(Options::default()), interval(0.2, 0.8));
    assert_eq!(
        of(Options { shutter: Some(interval(0.0, 0.5)), time: 1.0, ..Options::default() }),
        interval(1.0, 1.5)
    );
    let still = ZOO.replace("ActiveTransform EndTime", "ActiveTransform All");
    assert_eq!(scene(&still, &small(Options::default())).scene.view.shutter.interval(), interval(0.0, 0.0));
}
