//! Things that move while rays look: `cargo run -p durer-accel --example motion`.
use durer_accel::math::{Point3, Ray, Transform, Vector3};
use durer_accel::{AccelBuilder, BuildError, BuildOptions, Placement, Triangles};

const FLAG: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

fn flag(lean: f32) -> Vec<Point3> {
    [[0.0, 0.0], [0.5, 0.0], [0.5 + lean, 1.0], [lean, 1.0]].map(|[x, y]| Point3::new(x, y, 0.0)).to_vec()
}

fn main() -> Result<(), BuildError> {
    let (upright, leaning) = (flag(0.0), flag(0.8));
    let mut builder = AccelBuilder::new(BuildOptions::default());
    // A mesh whose vertices move: three keys, straight lines between them.
    let waves = builder.keyed_triangles(&FLAG, [(0.0, &*upright), (0.5, &*leaning), (1.0, &*upright)])?;
    builder.instance(waves, Placement::Identity)?;
    // A mesh that is moved.
    let stiff = builder.triangles(Triangles { positions: upright.clone(), indices: FLAG.to_vec() })?;
    let at = |x: f32| Transform::translate(Vector3::new(x, 0.0, 0.0));
    builder.instance(stiff, Placement::Moving(vec![(0.0, at(2.0)), (1.0, at(5.0))]))?;
    let accel = builder.build()?;

    for step in 0..=8 {
        let time = step as f32 / 8.0;
        let line = (0..72).map(|column| {
            let o = Point3::new(column as f32 * 0.08, 0.9, 1.0);
            let ray = Ray { time, ..Ray::new(o, Vector3::new(0.0, 0.0, -1.0)) };
            accel.closest(&ray).map_or('.', |h| if h.instance == 0 { 'w' } else { 's' })
        });
        println!("{time:5.3} s  {}", line.collect::<String>());
    }
    Ok(())
}
