//! Temporary.
use durer::{
    Options, builtin,
    film::{ToneMap, develop},
    image::{Packing, encode_png},
};
use durer_tests::{prepared, render};
#[test]
fn picture() {
    let get = |k: &str, d: &str| std::env::var(k).unwrap_or(d.to_owned());
    let name = get("ZZ_SCENE", "caustic");
    let imported = match builtin::find(&name) {
        Some(s) => s.import(),
        None => durer::open(&name),
    };
    let prepared = prepared(
        imported,
        &Options {
            integrator: Some(get("ZZ_INT", "bdpt")),
            width: Some(get("ZZ_W", "320").parse().unwrap()),
            samples: Some(get("ZZ_SPP", "16").parse().unwrap()),
            ..Options::default()
        },
    );
    let start = std::time::Instant::now();
    let r = render(&prepared);
    eprintln!("{} {:?} rays {} imb {:?} bad {}", name, start.elapsed(), r.rays, r.imbalances, r.bad_samples);
    let rgb: Vec<_> = r.film.pixels().iter().map(|p| p.mean()).collect();
    let mean: f32 = rgb.iter().map(|c| c[1]).sum::<f32>() / rgb.len() as f32;
    eprintln!("mean {mean}");
    let d = develop(r.film.width, r.film.height, &rgb, get("ZZ_EV", "0").parse().unwrap(), ToneMap::Agx);
    std::fs::write(
        get("ZZ_OUT", "/tmp/wt/bdpt.png"),
        encode_png(d.width, d.height, &d.rgb8, Packing::Small).unwrap(),
    )
    .unwrap();
}
