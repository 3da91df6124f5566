//! Numbers of the document: short decimals that read back as they were, and `null` for those that are none.
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A number in single precision. NaN and the infinities are written as `null`, which is read as NaN.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Number(#[cfg_attr(test, schemars(with = "Option<f32>"))] pub f32);

/// A coordinate in world space, in metres. NaN and the infinities are written as `null`, which is read as NaN.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Metres(#[cfg_attr(test, schemars(with = "Option<f64>"))] pub f64);

/// Linear RGB.
pub type Rgb = [Number; 3];
/// A place in world space.
pub type Place = [Metres; 3];
/// A direction in world space.
pub type Direction = [Number; 3];

/// Rgb from plain numbers.
pub fn rgb(v: [f32; 3]) -> Rgb {
    v.map(Number)
}

/// Plain numbers again.
pub fn plain(v: Rgb) -> [f32; 3] {
    v.map(|v| v.0)
}

/// A place from plain numbers.
pub(super) fn place(v: [f64; 3]) -> Place {
    v.map(Metres)
}

impl Metres {
    /// The shortest decimal number within an eighth of the rounding of `rounded`, the same coordinate in `f32` of a space
    /// whose origin is nearer: digits beyond mean nothing.
    pub fn short(exact: f64, rounded: f32) -> Self {
        let grain = f64::from(rounded.abs().next_up() - rounded.abs()) / 4.0;
        // Moving the origin rounds too, which is all that counts near the nearer one.
        let moved = exact.abs() * f64::EPSILON;
        let grain = if grain < moved { 16.0 * moved } else { grain };
        if !exact.is_finite() || grain <= 0.0 || !grain.is_finite() {
            return Self(exact);
        }
        let decimals = (-grain.log10()).ceil().clamp(0.0, 40.0) as usize;
        Self(format!("{exact:.decimals$}").parse().unwrap_or(exact))
    }
}

macro_rules! number {
    ($name:ident, $of:ty) => {
        impl PartialEq for $name {
            /// As the document sees it: what is no number is equal to what is none.
            fn eq(&self, o: &Self) -> bool {
                self.0 == o.0 || !self.0.is_finite() && !o.0.is_finite()
            }
        }
        impl Serialize for $name {
            fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
                if self.0.is_finite() { self.0.serialize(to) } else { to.serialize_none() }
            }
        }
        impl<'de> Deserialize<'de> for $name {
            fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
                Ok(Self(Option::<$of>::deserialize(from)?.unwrap_or(<$of>::NAN)))
            }
        }
    };
}
number!(Number, f32);
number!(Metres, f64);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_back_and_what_is_none_is_null() {
        let numbers = [Number(0.1), Number(-0.0), Number(f32::NAN), Number(f32::INFINITY), Number(1e-40)];
        let text = serde_json::to_string(&numbers).expect("JSON");
        assert_eq!(text, "[0.1,-0.0,null,null,1e-40]");
        let back: [Number; 5] = serde_json::from_str(&text).expect("numbers");
        assert_eq!(back, numbers);
        assert_eq!(back[0].0.to_bits(), 0.1f32.to_bits());
    }

    #[test]
    fn coordinates_keep_the_digits_that_mean_something() {
        let short = |exact, rounded| Metres::short(exact, rounded).0;
        assert_eq!(short(f64::from(0.3f32), 0.3), 0.300_000_012);
        assert_eq!(short(f64::from(0.3f32) + 1e7, 0.3), 10_000_000.300_000_012);
        assert!((short(1.0 / 3.0, 1.0 / 3.0) - 1.0 / 3.0).abs() < 4e-9);
        assert_eq!((short(5.0, 0.0), short(-5.399_999_999_999_999_5, 0.0)), (5.0, -5.4));
        assert!(short(f64::NAN, 1.0).is_nan());
    }
}
