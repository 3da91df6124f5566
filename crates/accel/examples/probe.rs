//! What does a ray cost, and which boxes did it visit? `cargo run -p durer-accel --example probe`.
use durer_accel::math::{Point3, Ray, Vector3};
use durer_accel::{
    AccelBuilder, BuildError, BuildOptions, Placement, Preset, TraversalCounts, TraversalProbe, Triangles,
};

/// Remembers the nodes in the order they were entered.
#[derive(Default)]
struct Visited(Vec<u32>);

impl TraversalProbe for Visited {
    type Id = ();
    fn node(&mut self, _: (), bvh_node: u32) {
        self.0.push(bvh_node);
    }
}

/// Hills of 2 * 200 * 200 triangles over the unit square.
fn hills() -> Triangles {
    const SIDE: u32 = 200;
    let mut mesh = Triangles::default();
    for i in 0..=SIDE {
        for j in 0..=SIDE {
            let (x, y) = (i as f32 / SIDE as f32, j as f32 / SIDE as f32);
            let wave = |x: f32| 4.0 * (x * 5.0).fract() * (1.0 - (x * 5.0).fract());
            mesh.positions.push(Point3::new(x, y, 0.05 * wave(x) * wave(y)));
            let k = i * (SIDE + 1) + j;
            if i < SIDE && j < SIDE {
                mesh.indices.extend([[k, k + SIDE + 1, k + SIDE + 2], [k, k + SIDE + 2, k + 1]]);
            }
        }
    }
    mesh
}

fn main() -> Result<(), BuildError> {
    let mesh = hills();
    for preset in [Preset::Fast, Preset::Balanced, Preset::High] {
        let mut builder = AccelBuilder::new(BuildOptions { preset, ..BuildOptions::default() });
        let id = builder.borrowed_triangles(&mesh.positions, &mesh.indices)?;
        builder.instance(id, Placement::Identity)?;
        let accel = builder.build()?;

        let mut counts = TraversalCounts::default();
        for i in 0..10_000 {
            let o = Point3::new((i % 100) as f32 / 100.0, (i / 100) as f32 / 100.0, 0.5);
            accel.query(&Ray::new(o, Vector3::new(0.3, 0.2, -1.0))).probe(&mut counts, ()).closest();
        }
        let each = |sum: u64| sum as f64 / 1e4;
        println!(
            "{preset:?}: {:.1} nodes and {:.1} triangles a ray; {:?}",
            each(counts.nodes),
            each(counts.primitives),
            accel.stats()
        );

        let mut visited = Visited::default();
        let ray = Ray::new(Point3::new(0.1, 0.1, 0.5), Vector3::new(0.3, 0.2, -1.0));
        accel.query(&ray).probe(&mut visited, ()).closest();
        for bounds in visited.0.into_iter().filter_map(|node| accel.node_bounds(node)) {
            println!("    {:?} .. {:?}", bounds.bounds.min, bounds.bounds.max);
        }
    }
    Ok(())
}
