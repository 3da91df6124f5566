//! tmp
use durer::*;
fn main() {
    let mut args = std::env::args().skip(1);
    let scene = args.next().unwrap();
    let spp: u32 = args.next().unwrap().parse().unwrap();
    let threads: usize = args.next().unwrap().parse().unwrap();
    let mut i = open(&scene);
    let t0 = std::time::Instant::now();
    let p = prepare(&mut i, &Options { samples: Some(spp), threads: Some(threads), ..Default::default() })
        .unwrap();
    println!("prepare {:?}", t0.elapsed());
    for _ in 0..3 {
        let t = std::time::Instant::now();
        let r = p.job().render(Default::default(), &(), &Default::default());
        let s = t.elapsed().as_secs_f64();
        println!(
            "{:.3} s, {} samples, {} rays, {:.2} Mrays/s, {:.0} ns/ray",
            s,
            r.samples,
            r.rays,
            r.rays as f64 / s / 1e6,
            s * 1e9 / r.rays as f64
        );
    }
}
