//! Laws that every lobe and every registered material keeps (T2, T3; validation.md E3 to E6), over all of them without being
//! asked: directions have the density that they say, weights are `f cos / density`, no more leaves than arrives, values are
//! reciprocal. `DURER_SLOW=1` takes more directions and more points.
mod lobes;
mod materials;
mod measured;
mod numbers;
mod sampling;

use durer_core::math::{Point2, Vector3};
use durer_testkit::{DVec3, random::Random};

/// Whether more time may be spent.
fn slow() -> bool {
    std::env::var_os("DURER_SLOW").is_some_and(|v| v == "1")
}

/// A direction in single precision.
fn v(w: DVec3) -> Vector3 {
    Vector3::from_f64(w)
}

/// A point of the unit square.
fn unit(random: &mut Random) -> Point2 {
    Point2::new(number(random), number(random))
}

/// A number in `[0, 1)`.
fn number(random: &mut Random) -> f32 {
    random.unit().min(0.999_999) as f32
}

/// Directions to look from, on both sides.
fn seen_from() -> Vec<Vector3> {
    let cosines: &[f32] = if slow() { &[1.0, 0.98, 0.7, 0.4, 0.15, -0.1, -0.6] } else { &[0.95, 0.35, -0.7] };
    cosines.iter().map(|z| Vector3::new((1.0 - z * z).sqrt() * 0.8, (1.0 - z * z).sqrt() * 0.6, *z)).collect()
}
