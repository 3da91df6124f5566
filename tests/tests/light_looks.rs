//! Area lights whose radiance a texture varies, and those with holes: sampling them gives what rays find.
use durer::{
    Options, Prepared, SampleCx,
    math::{Point3, Ray, Vector3},
    model::light::LightCx,
    probe::NoProbe,
    sampling::{Dim, Sampler, SamplerKind},
    spectrum::Basis,
};
use durer_tests::scene;

const CHECK: &str = "Texture \"squares\" \"spectrum\" \"checkerboard\" \"float uscale\" 3 \"float vscale\" 3 \
     \"rgb tex1\" [4 2 1] \"rgb tex2\" [0 .1 .5]\n\
     Texture \"holes\" \"float\" \"checkerboard\" \"float uscale\" 4 \"float vscale\" 4 \"float tex1\" 1 \"float tex2\" 0\n";

const SHAPES: [&str; 5] = [
    "Shape \"disk\"",
    "Shape \"sphere\" \"float radius\" .8",
    "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 0  1 -1 .4  -1 1 0  1 1 0] \"point2 uv\" [0 0 1 0 0 1 1 1]",
    "Shape \"trianglemesh\" \"point3 P\" [-1 -1 0  1 -1 0  1 1 0  -1 1 0] \"point2 uv\" [0 0 1 0 1 1 0 1] \"integer indices\" [0 1 2 0 2 3]",
    "Shape \"loopsubdiv\" \"integer levels\" 2 \"point3 P\" [-1 -1 0  1 -1 0  1 1 0  -1 1 0  0 0 1.5] \
     \"integer indices\" [0 1 4  1 2 4  2 3 4  3 0 4]",
];

fn lamp(shape: &str, material: &str, emission: &str) -> Prepared {
    let text = format!(
        "Camera \"perspective\"\nWorldBegin\n{CHECK}AttributeBegin\n{material}\nAreaLightSource \"diffuse\" {emission}\n\
         Translate .2 .1 2 Rotate 170 1 .3 .1\n{shape}\nAttributeEnd\n"
    );
    scene(&text, &Options::default())
}

/// Irradiance at the origin on what faces +z, in both ways, and the deviations of the means.
fn irradiances(prepared: &Prepared, n: u32) -> [(f64, f64); 2] {
    let scene = &prepared.scene;
    let origin = Point3::new(0.0, 0.0, 0.0);
    let cx = SampleCx { scene, basis: Basis::Rgb };
    let light_cx = LightCx { basis: Basis::Rgb, time: 0.0 };
    let (mut by_light, mut by_direction) = ([0.0; 2], [0.0; 2]);
    let add = |sums: &mut [f64; 2], value: f64| *sums = [sums[0] + value, sums[1] + value * value];
    for i in 0..n {
        let sampler = Sampler::new(SamplerKind::Independent, 1, [0, 0], i, n);
        let of = |light: &dyn durer::model::light::Light| light.sample(&light_cx, origin, &sampler);
        let sampled = of(&*scene.lights[0]).map_or(0.0, |s| {
            let ray = Ray { t_max: 1.0f32.next_down(), ..Ray::new(origin, s.point.expect("near") - origin) };
            let is_seen = !scene.occluded(&cx, &ray, &mut NoProbe, ());
            f64::from(s.weight.mean()) * f64::from(s.wi.z.max(0.0)) * f64::from(u8::from(is_seen))
        });
        add(&mut by_light, sampled);
        // Uniform over the hemisphere about +z.
        let u = sampler.d2(Dim::Scatter);
        let (r, phi) = (f64::from(1.0 - u.x * u.x).sqrt(), std::f64::consts::TAU * f64::from(u.y));
        let d = Vector3::new((r * phi.cos()) as f32, (r * phi.sin()) as f32, u.x);
        let ray = Ray::new(origin, d);
        let found = scene.closest(&cx, &ray, &mut NoProbe, ()).map_or(0.0, |hit| {
            let (object, surface) = scene.surface(&ray, &hit);
            let light = scene.object(object).light.expect("a light");
            f64::from(scene.lights[light as usize].emitted(Basis::Rgb, &surface, -d).mean())
        });
        add(&mut by_direction, found * f64::from(u.x) * std::f64::consts::TAU);
    }
    [by_light, by_direction].map(|[sum, squares]| {
        let mean = sum / f64::from(n);
        (mean, ((squares / f64::from(n) - mean * mean) / f64::from(n)).sqrt())
    })
}

#[test]
fn textured_lights_and_lights_with_holes_give_what_rays_find() {
    let masked = "Material \"principled\" \"texture alpha\" \"holes\" \"string alphamode\" \"mask\"";
    let cases = [
        ("", "\"texture L\" \"squares\""),
        (masked, "\"bool twosided\" true"),
        (masked, "\"texture L\" \"squares\" \"float scale\" 2 \"bool twosided\" true"),
    ];
    for shape in SHAPES {
        for (material, emission) in cases {
            let prepared = lamp(shape, material, emission);
            let [(a, sa), (b, sb)] = irradiances(&prepared, 1 << 17);
            let sigma = sa.hypot(sb);
            assert!(
                b > 0.05 && (a - b).abs() < 4.0 * sigma,
                "{shape} {material} {emission}: {a} {b} sigma {sigma}"
            );
            assert!(sa < sb, "{shape} {emission}: sampling the light is worse than not to: {sa} {sb}");
        }
    }
}

#[test]
fn power_counts_what_shines() {
    let masked = "Material \"principled\" \"texture alpha\" \"holes\" \"string alphamode\" \"mask\"";
    let prepared = lamp(SHAPES[3], masked, "\"float power\" 12");
    assert!((prepared.scene.lights[0].power(1.0) - 12.0).abs() < 1e-3);
    // Half of it is holes, so that the rest is twice as bright as 12 / (pi 4).
    let whole = lamp(SHAPES[3], "", "\"float power\" 12");
    let [masked, whole] = [prepared, whole].map(|p| irradiances(&p, 1 << 14)[0].0);
    assert!((masked / whole - 1.0).abs() < 0.05, "{masked} {whole}");
}
