//! One light for each shadow ray, chosen by what it could send: the same light on average, for fewer rays.
use durer::{
    Distribution, Options, Prepared,
    integrator::{Lights, Sampling},
    probe::RayKind,
};
use durer_tests::{render, scene};

const SAMPLES: u32 = 65536;

fn options(lights: Lights, samples: u32) -> Options {
    Options {
        integrator: Some("distributed".to_owned()),
        samples: Some(samples),
        distribution: Distribution { lights: Some(lights), ..Distribution::default() },
        ..Options::default()
    }
}

/// A picture of one pixel, all of which is the origin of a floor of white `material`, seen from `eye`.
fn spot(eye: &str, material: &str, lights: &str) -> String {
    format!(
        "Film \"rgb\" \"integer xresolution\" 1 \"integer yresolution\" 1\nPixelFilter \"box\"\n\
         LookAt {eye}  0 0 0  0.1 0.9 0.3\nCamera \"perspective\" \"float fov\" 0.0001\n\
         WorldBegin\n{material}\nShape \"plane\"\n{lights}"
    )
}

const WHITE: &str = "Material \"diffuse\" \"rgb reflectance\" [1 1 1]";
const DISK: &str = "AttributeBegin AreaLightSource \"diffuse\" Translate 0 2 0 Rotate 90 1 0 0 Shape \"disk\" AttributeEnd\n";
const SQUARE: &str = "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [6 6 6] \
     Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \
     \"point3 P\" [-2.2 1 -.5  -2.2 2 -.5  -2.2 2 .5  -2.2 1 .5] AttributeEnd\n";
const POINT: &str = "LightSource \"point\" \"point3 from\" [1 2 0] \"rgb I\" [3 3 3]\n";
const SUN: &str =
    "LightSource \"distant\" \"rgb L\" [0.4 0.4 0.4] \"point3 from\" [0 1 1] \"point3 to\" [0 0 0]\n";
/// Shines away from the floor: it is never worth a ray.
const AWAY: &str = "LightSource \"spot\" \"point3 from\" [0 1 0] \"point3 to\" [0 2 0] \"float coneangle\" 40 \"rgb I\" [90 90 90]\n";

fn mean(scene: &Prepared) -> f64 {
    render(scene).film.pixels()[0].mean()[1].into()
}

/// The shadow rays of each sample: which light each goes to.
fn aims(scene: &Prepared, samples: u32) -> Vec<Vec<u32>> {
    let of = |sample| {
        let tree = scene.job().record([0, 0], sample).0;
        let shadows = tree.nodes.iter().filter(|node| node.kind == RayKind::Shadow);
        shadows.map(|node| node.light.as_ref().expect("a shadow ray has a light").light).collect()
    };
    (0..samples).map(of).collect()
}

#[test]
fn one_light_a_ray_gives_the_light_of_all() {
    // E9 for the disk, I cos / d² for the point, and the sun at 45 degrees; radiance is irradiance over pi.
    let expected = (0.628_319 + 3.0 * 2.0 / 5f64.powf(1.5) + 0.4 * 0.5f64.sqrt()) / std::f64::consts::PI;
    let text = spot("1.5 1.1 6", WHITE, &format!("{DISK}{POINT}{SUN}{AWAY}"));
    let one = mean(&scene(&text, &options(Lights::One, SAMPLES)));
    assert!((one / expected - 1.0).abs() < 2e-3, "{one}, expected {expected}");
}

#[test]
fn lights_that_gloss_rays_meet_count_once() {
    let glossy = "Material \"classic\" \"rgb diffuse\" [0.2 0.2 0.2] \"rgb reflection\" [0.8 0.8 0.8] \"float gloss\" 40";
    let text = spot("2 1.4 0", glossy, &format!("{SQUARE}{DISK}{POINT}"));
    let [all, one] = [Lights::All, Lights::One].map(|lights| mean(&scene(&text, &options(lights, SAMPLES))));
    assert!(all > 0.2 && (one / all - 1.0).abs() < 5e-3, "{one}, with all lights {all}");
}

#[test]
fn lights_are_chosen_in_proportion_to_what_they_could_send() {
    let lamp = |x: i32| format!("LightSource \"point\" \"point3 from\" [{x} 0.001 0]\n");
    let text = spot("1.5 1.1 6", WHITE, &format!("{}{}{AWAY}", lamp(1), lamp(3)));
    let aims = aims(&scene(&text, &options(Lights::One, 4096)), 4096);
    assert!(aims.iter().all(|rays| rays.len() == 1), "a shadow ray a hit");
    let near = aims.iter().filter(|rays| rays[0] == 0).count();
    // 9 to 1 by the squares of the distances, stratified over the samples.
    assert!((near as f64 / 4096.0 - 0.9).abs() < 2e-3, "{near}");
    assert!(aims.iter().all(|rays| rays[0] != 2), "nothing comes from a spot that is turned away");
}

#[test]
fn nested_shadow_rays_choose_each_for_itself() {
    let text = spot("1.5 1.1 6", WHITE, &format!("{DISK}{POINT}"));
    let nested = |lights| {
        let mut options = options(lights, 16);
        options.distribution.shadow_rays = Some(5);
        options.distribution.sampling = Some(Sampling::Nested);
        aims(&scene(&text, &options), 16)
    };
    assert!(nested(Lights::One).iter().all(|rays| rays.len() == 5 && rays.contains(&0) && rays.contains(&1)));
    // Five to the disk and one to the point, which has no extent.
    assert!(nested(Lights::All).iter().all(|rays| rays.len() == 6));
}
