//! What the lanes of a [`Spectrum`] mean. One value is made per camera sample; no other file may interpret lanes.
use super::{Color, Spectrum};

/// The meaning of the four lanes for one camera sample.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Basis {
    /// Lanes are linear Rec. 709 red, green, blue and green again. The copy keeps `max`, `mean` and divisions free of a
    /// special case: a zero lane would give 0/0, a lane of ones would keep roulette from ever ending.
    #[default]
    Rgb,
}

impl Basis {
    /// Lanes of a reflectance, transmittance or other weight.
    #[inline]
    pub fn reflectance(self, c: Color) -> Spectrum {
        match self {
            Self::Rgb => rgb_lanes(c),
        }
    }
    /// Lanes of an emitted quantity.
    #[inline]
    pub fn emission(self, c: Color) -> Spectrum {
        match self {
            Self::Rgb => rgb_lanes(c),
        }
    }
    /// What the film stores of a radiance: linear Rec. 709 components.
    #[inline]
    pub fn to_rgb(self, s: Spectrum) -> [f32; 3] {
        match self {
            Self::Rgb => {
                let [r, g, b, _] = s.lanes();
                [r, g, b]
            }
        }
    }
}

#[inline]
fn rgb_lanes(c: Color) -> Spectrum {
    let [r, g, b] = c.rgb;
    Spectrum::from_lanes([r, g, b, g])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_is_one_in_every_lane() {
        assert_eq!(Basis::Rgb.reflectance(Color::WHITE), Spectrum::ONE);
    }

    #[test]
    fn rgb_survives_the_round_trip_and_the_mean_weighs_green_twice() {
        let s = Basis::Rgb.emission(Color::new(1.0, 2.0, 4.0));
        assert_eq!(Basis::Rgb.to_rgb(s), [1.0, 2.0, 4.0]);
        assert_eq!(s.mean(), (1.0 + 2.0 * 2.0 + 4.0) / 4.0);
        assert_eq!(s.max(), 4.0);
    }
}
