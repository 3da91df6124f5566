//! Build times and costs, printed: `cargo test --release -p durer-accel speed -- --ignored --nocapture`.
use std::time::Instant;

use super::*;

#[test]
#[ignore = "prints times"]
fn speed() {
    let meshes =
        [("blob", Mesh::blob(330)), ("rooms", Mesh::rooms(40_000)), ("soup", Mesh::soup(500_000, 0.01))];
    for (name, mesh) in meshes {
        for preset in [Preset::Fast, Preset::Balanced, Preset::High] {
            for threads in [1, 2] {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
                let begin = Instant::now();
                let tree = pool.install(|| grow(&mesh, 16, preset));
                let seconds = begin.elapsed().as_secs_f64();
                let packets = tree.children.iter().filter(|c| c.count > 0).count();
                println!(
                    "{name:6} {preset:?} {threads} threads: {:.2} M/s, cost {:.3}, {:.2} a packet, {:.2} children, x{:.3}",
                    1e-6 * mesh.len() as f64 / seconds,
                    sah_cost(&tree),
                    tree.order.len() as f64 / packets as f64,
                    tree.children.len() as f64 / (tree.nodes.len() - 1) as f64,
                    tree.order.len() as f64 / mesh.len() as f64,
                );
            }
        }
    }
}
