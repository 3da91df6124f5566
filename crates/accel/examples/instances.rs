//! One mesh in a thousand places, some of which some rays do not see: `cargo run -p durer-accel --example instances`.
use durer_accel::glam::{DAffine3, DQuat, DVec3};
use durer_accel::math::{Point3, Ray, Transform, Vector3};
use durer_accel::{AccelBuilder, BuildError, BuildOptions, Placement, Triangles, Visibility};

/// What rays look for.
const EVEN: u32 = 1;
const ODD: u32 = 2;

fn main() -> Result<(), BuildError> {
    let mut builder = AccelBuilder::new(BuildOptions::default());
    let corners = [[-0.4, -0.4, 0.0], [0.4, -0.4, 0.0], [0.0, 0.4, 0.0]];
    let mesh = builder
        .triangles(Triangles { positions: corners.map(Point3::from).to_vec(), indices: vec![[0, 1, 2]] })?;
    for i in 0..1000u32 {
        let place = DVec3::new(f64::from(i % 10), f64::from(i / 10 % 10), f64::from(i / 100));
        let turn = DQuat::from_rotation_z(f64::from(i) * 0.1);
        let size = DVec3::splat(0.5 + 0.5 * f64::from(i % 7) / 6.0);
        let map = DAffine3::from_scale_rotation_translation(size, turn, place);
        let seen = Visibility { mask: if i % 2 == 0 { EVEN } else { ODD }, ..Visibility::default() };
        builder.instance_seen(mesh, Placement::Still(Transform::from_f64(&map)), seen)?;
    }
    let accel = builder.build()?;
    println!("{:?}", accel.stats());

    let ray = Ray::new(Point3::new(3.0, 4.0, -1.0), Vector3::new(0.0, 0.0, 1.0));
    for (name, mask) in [("all", u32::MAX), ("even", EVEN), ("odd", ODD), ("none", 0)] {
        let hit = accel.query(&ray).mask(mask).closest();
        println!("{name:>5}: {:?}", hit.map(|h| (h.instance, h.t)));
    }
    // Behind the first thing there are others: go on from there.
    let mut rest = ray;
    let mut met = Vec::new();
    while let Some(hit) = accel.closest(&rest) {
        met.push(hit.instance);
        rest.t_min = hit.t.next_up();
    }
    println!("one behind the other: {met:?}");
    Ok(())
}
