//! A mesh, one ray, and a picture in letters: `cargo run -p durer-accel --example closest`.
use durer_accel::math::{Point3, Ray, Vector3};
use durer_accel::{Accel, AccelBuilder, BuildError, BuildOptions, Placement, Triangles};

/// An octahedron of radius 1.
fn octahedron() -> Triangles {
    let positions = [[1., 0., 0.], [-1., 0., 0.], [0., 1., 0.], [0., -1., 0.], [0., 0., 1.], [0., 0., -1.]];
    // Counter-clockwise as seen from outside.
    let indices =
        vec![[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
    Triangles { positions: positions.map(Point3::from).to_vec(), indices }
}

/// The brightness of what a ray meets, from 0 to 1.
fn brightness(accel: &Accel, ray: &Ray) -> Option<f32> {
    let hit = accel.closest(ray)?;
    let to_light = Vector3::new(0.4, 0.7, 0.6).normalize();
    Some(0.1 + 0.9 * hit.n_g.normalize().dot(to_light).max(0.0))
}

fn main() -> Result<(), BuildError> {
    let mut builder = AccelBuilder::new(BuildOptions::default());
    let mesh = builder.triangles(octahedron())?;
    builder.instance(mesh, Placement::Identity)?;
    let accel = builder.build()?;

    let eye = Point3::new(0.9, 1.1, 3.0);
    let ray = Ray::new(eye, Point3::ZERO - eye);
    match accel.closest(&ray) {
        Some(hit) => println!("t = {:.3}, triangle {}, at {:?}", hit.t, hit.prim, ray.at(hit.t)),
        None => println!("nothing there"),
    }

    let forward = (Point3::ZERO - eye).normalize();
    let right = forward.cross(Vector3::new(0.0, 1.0, 0.0)).normalize();
    let up = right.cross(forward);
    for row in 0..24 {
        let y = 0.4 - 0.8 * (row as f32 + 0.5) / 24.0;
        let line = (0..60).map(|column| {
            let x = 0.8 * (column as f32 + 0.5) / 60.0 - 0.4;
            let letter = |b: f32| char::from(b".:-=+*#%@"[(b * 8.0) as usize]);
            brightness(&accel, &Ray::new(eye, forward + right * x + up * y)).map_or(' ', letter)
        });
        println!("{}", line.collect::<String>().trim_end());
    }
    Ok(())
}
