//! Values on a grid in space.
use durer_core::glam::DVec3;
use durer_scene::{Data, ValueType};

use super::*;

fn made(values: &[f32], nx: i32) -> Result<Box<dyn Texture>, String> {
    let params = Params::new().with("values", ValueType::Float, Data::Floats(values.to_vec())).int("nx", nx);
    let image = Image { width: 1, height: 1, channels: 1, data: ImageData::U8(vec![0]) };
    built("volume", TextureValue::Color, params, &image)
}

fn in_space(x: f32) -> TextureAt {
    TextureAt { p: Point3::new(x, 0.3, 0.2), ..at(0.0, 0.0) }
}

#[test]
fn places_of_space_have_the_values_of_a_grid() {
    let mut grey = made(&[0.2, 0.6], 2).expect("sound");
    for (x, expected) in [(-3.0, 0.2), (0.25, 0.2), (0.5, 0.4), (0.75, 0.6), (7.0, 0.6)] {
        assert!((grey.float(&CX, &in_space(x)) - expected).abs() < 1e-6, "{x}");
    }
    assert_eq!(grey.largest(&CX), 0.6);
    // The unit cube becomes twice as large.
    grey.place(&DAffine3::from_scale(DVec3::splat(2.0)));
    assert!((grey.float(&CX, &in_space(1.0)) - 0.4).abs() < 1e-6);
    let colored = made(&[1.0, 0.0, 0.5, 0.0, 1.0, 0.5], 2).expect("sound");
    assert_eq!(colored.color(&CX, &in_space(0.5)).rgb, [0.5; 3]);
    assert_eq!(colored.color(&CX, &in_space(0.0)).rgb, [1.0, 0.0, 0.5]);
    assert!(made(&[1.0; 4], 2).is_err_and(|why| why.contains("expected 2 x 1 x 1")));
}
