//! What the film makes of light before it sums it: its speed, the largest value it takes, and what it calls white.
//!
//! As pbrt-v4's `PixelSensor` and `RGBFilm` have it with the sensor "cie1931": a sample becomes X, Y, Z times speed; if the
//! largest of the three exceeds `maxcomponentvalue` all are scaled down to it; then white is balanced. The last is linear, so
//! that it does not matter that pbrt balances the sum.
use durer_core::{
    glam::DMat3,
    spectrum::{D65, adaptation, daylight, xyz_from_rec709},
};

/// Three rows.
type Matrix = [[f32; 3]; 3];

/// What the film makes of light.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sensor {
    /// `None` of a film that holds what arrives.
    own: Option<Box<Own>>,
}

#[derive(Clone, Debug, PartialEq)]
struct Own {
    /// X, Y, Z from linear Rec. 709.
    xyz: Matrix,
    /// The most that any of X, Y, Z may be.
    most: f32,
    /// Linear Rec. 709 from that under another white.
    balance: Option<Matrix>,
}

/// What became of a sample on the film, beyond its gain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Developing {
    /// By how much it is scaled down because it is too bright; 1 if it is not.
    pub clamp: f32,
    /// What then becomes of red, green and blue, a row for each; `None` where it stays as it is.
    pub balance: Option<Matrix>,
}

fn rows(m: DMat3) -> Matrix {
    m.transpose().to_cols_array_2d().map(|row| row.map(|v| v as f32))
}

fn times(m: &Matrix, v: [f32; 3]) -> [f32; 3] {
    m.map(|[r, g, b]| r * v[0] + g * v[1] + b * v[2])
}

impl Sensor {
    /// A film that takes daylight of so many kelvin for white, and of each sample at most this of X, Y and Z.
    pub fn new(white: Option<f32>, most: Option<f32>) -> Self {
        if white.is_none() && most.is_none() {
            return Self::default();
        }
        let xyz = xyz_from_rec709();
        let balance =
            white.map(|kelvin| rows(xyz.inverse() * adaptation([daylight(kelvin.into()), D65]) * xyz));
        Self { own: Some(Box::new(Own { xyz: rows(xyz), most: most.unwrap_or(f32::INFINITY), balance })) }
    }

    /// What the film holds of a sample: linear Rec. 709.
    #[inline]
    pub fn held(&self, rgb: [f32; 3]) -> [f32; 3] {
        // PERF: most films hold what arrives (bench render).
        match &self.own {
            None => rgb,
            Some(_) => self.developing(rgb).of(rgb),
        }
    }

    /// What becomes of a sample.
    pub fn developing(&self, rgb: [f32; 3]) -> Developing {
        let Some(own) = &self.own else { return Developing::NONE };
        let largest = times(&own.xyz, rgb).into_iter().fold(f32::NEG_INFINITY, f32::max);
        // What is infinite stays no number: it is the film's to reject.
        let clamp = if largest > own.most { own.most / largest } else { 1.0 };
        Developing { clamp, balance: own.balance }
    }
}

impl Developing {
    /// Nothing.
    pub const NONE: Self = Self { clamp: 1.0, balance: None };

    /// What it makes of a sample.
    pub fn of(&self, rgb: [f32; 3]) -> [f32; 3] {
        let clamped = if self.clamp == 1.0 { rgb } else { rgb.map(|v| v * self.clamp) };
        match &self.balance {
            Some(balance) => times(balance, clamped),
            None => clamped,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_too_bright_keeps_its_colour() {
        let sensor = Sensor::new(None, Some(2.0));
        // Blue has the largest Z: 0.9505, of red X: 0.4124.
        let clamped = sensor.held([0.0, 0.0, 8.0]);
        assert!((clamped[2] - 2.0 / 0.9505).abs() < 1e-3 && clamped[0] == 0.0, "{clamped:?}");
        assert_eq!(sensor.held([1.0, 1.0, 1.0]), [1.0; 3]);
        let [r, g, _] = sensor.held([30.0, 3.0, 0.0]);
        assert!((r / g - 10.0).abs() < 1e-4, "{r} {g}");
        assert!((0.4124 * r + 0.3576 * g - 2.0).abs() < 1e-3);
        assert!(sensor.held([f32::INFINITY, 0.0, 0.0]).iter().any(|v| v.is_nan()));
    }

    #[test]
    fn what_the_film_calls_white_becomes_white() {
        for kelvin in [2900.0, 5000.0, 9000.0] {
            let xyz = durer_core::spectrum::tristimulus(daylight(kelvin));
            let light = (xyz_from_rec709().inverse() * xyz).as_vec3().to_array();
            let held = Sensor::new(Some(kelvin as f32), None).held(light);
            assert!(held.iter().all(|v| (v - 1.0).abs() < 1e-3), "{kelvin}: {held:?}");
        }
        let cold = Sensor::new(Some(3000.0), None).held([1.0; 3]);
        assert!(cold[2] > 1.3 && cold[0] < 0.8, "{cold:?}");
    }
}
