//! What the lanes of a [`Spectrum`] mean. One value is made per camera sample; no other file may interpret lanes.
//!
//! Lanes of light are radiance per wavelength, of which a light that is 1 everywhere has luminance 1, as has D65 in the
//! white of Rec. 709: they are of about the size that red, green and blue have.
use super::{Color, Curve, LightColor, Spectrum, Wavelengths, observer::d65, upsample::Smooth};

/// The meaning of the four lanes for one camera sample.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Basis {
    /// Lanes are linear Rec. 709 red, green, blue and green again. The copy keeps `max`, `mean` and divisions free of a
    /// special case: a zero lane would give 0/0, a lane of ones would keep roulette from ever ending.
    #[default]
    Rgb,
    /// Lanes are values at four wavelengths, of which the first leads.
    Spectral(Wavelengths),
}

/// What rays carry: which basis samples get.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Carried {
    /// Red, green and blue.
    #[default]
    Rgb,
    /// Four wavelengths, other ones for every sample.
    Wavelengths,
}

impl Carried {
    /// The basis of a sample; `u` gives a number in `[0, 1)` if it is asked for.
    #[inline]
    pub fn basis(self, u: impl FnOnce() -> f32) -> Basis {
        match self {
            Self::Rgb => Basis::Rgb,
            Self::Wavelengths => Basis::Spectral(Wavelengths::drawn(u())),
        }
    }
}

impl Basis {
    /// The wavelengths, if lanes are wavelengths.
    #[inline]
    pub fn wavelengths(&self) -> Option<&Wavelengths> {
        match self {
            Self::Rgb => None,
            Self::Spectral(wavelengths) => Some(wavelengths),
        }
    }
    /// Lanes of a reflectance, transmittance or other weight; of what may exceed 1 too, as indices of refraction.
    #[inline]
    pub fn reflectance(&self, c: Color) -> Spectrum {
        match self {
            Self::Rgb => rgb_lanes(c),
            Self::Spectral(wavelengths) => smooth(wavelengths, c, Fit::Tight),
        }
    }
    /// Lanes of a quantity that has no bound, such as an absorption coefficient.
    #[inline]
    pub fn unbounded(&self, c: Color) -> Spectrum {
        match self {
            Self::Rgb => rgb_lanes(c),
            Self::Spectral(wavelengths) => smooth(wavelengths, c, Fit::Loose),
        }
    }
    /// No lane of [`Self::unbounded`] is larger than this times the largest component.
    pub fn headroom(&self) -> f32 {
        match self {
            Self::Rgb => 1.0,
            Self::Spectral(_) => HEADROOM,
        }
    }
    /// Lanes of an emitted quantity: in white, D65.
    #[inline]
    pub fn emission(&self, c: Color) -> Spectrum {
        match self {
            Self::Rgb => rgb_lanes(c),
            Self::Spectral(wavelengths) => smooth(wavelengths, c, Fit::Loose) * self.white(),
        }
    }
    /// Lanes of white light of luminance 1.
    #[inline]
    pub fn white(&self) -> Spectrum {
        match self {
            Self::Rgb => Spectrum::ONE,
            Self::Spectral(wavelengths) => Spectrum::from_lanes(wavelengths.nm().map(d65)),
        }
    }
    /// Lanes of the colour of a light.
    #[inline]
    pub fn light(&self, light: &LightColor) -> Spectrum {
        match self {
            Self::Rgb => rgb_lanes(light.color),
            Self::Spectral(wavelengths) => match light.curve() {
                Some((curve, factor)) => {
                    Spectrum::from_lanes(wavelengths.nm().map(|nm| curve.at(nm) * factor))
                }
                None => self.emission(light.color),
            },
        }
    }
    /// Lanes of a light that is seen through a picture.
    #[inline]
    pub fn tinted(&self, light: &LightColor, by: Color) -> Spectrum {
        match light.curve() {
            Some(_) if *self != Self::Rgb => self.light(light) * self.unbounded(by),
            _ => self.emission(by * light.color),
        }
    }
    /// Lanes of a measured curve; in RGB, of the colour that stands for it.
    #[inline]
    pub fn curve(&self, curve: &Curve, color: Color) -> Spectrum {
        match self {
            Self::Rgb => rgb_lanes(color),
            Self::Spectral(wavelengths) => Spectrum::from_lanes(wavelengths.nm().map(|nm| curve.at(nm))),
        }
    }
    /// The value of a curve where one number is wanted, such as an index of refraction that light is bent by: at the
    /// leading wavelength; in RGB, `usual`.
    #[inline]
    pub fn leading(&self, curve: &Curve, usual: f32) -> f32 {
        match self {
            Self::Rgb => usual,
            Self::Spectral(wavelengths) => curve.at(wavelengths.nm()[0]),
        }
    }
    /// What a ray's share is multiplied with where only the leading wavelength goes its way: nothing of the others, and
    /// four times the one, which each of them is in a quarter of all samples. In RGB all go the same way.
    #[inline]
    pub fn collapse(&self) -> Spectrum {
        match self {
            Self::Rgb => Spectrum::ONE,
            Self::Spectral(_) => Spectrum::from_lanes([4.0, 0.0, 0.0, 0.0]),
        }
    }
    /// The lane by which decisions are made that cannot be made for all, such as how far to the next collision in a
    /// coloured medium: `u` in `[0, 1)` chooses among the equally likely lanes of RGB; the leading wavelength was drawn
    /// before.
    #[inline]
    pub fn lead(&self, u: f32) -> Lane {
        match self {
            Self::Rgb => Lane(((u * 4.0) as u8).min(3)),
            Self::Spectral(_) => Lane(0),
        }
    }
    /// The colour that a weight gives to white light, as far as the lanes can tell: linear Rec. 709 components.
    pub fn under_white(&self, s: Spectrum) -> [f32; 3] {
        self.to_rgb(s * self.white())
    }
    /// What the film stores of a radiance: linear Rec. 709 components.
    #[inline]
    pub fn to_rgb(&self, s: Spectrum) -> [f32; 3] {
        match self {
            Self::Rgb => {
                let [r, g, b, _] = s.lanes();
                [r, g, b]
            }
            Self::Spectral(wavelengths) => {
                let mut rgb = [0.0; 3];
                for (lane, weights) in s.lanes().into_iter().zip(wavelengths.weights()) {
                    rgb.iter_mut().zip(weights).for_each(|(sum, weight)| *sum += lane * weight);
                }
                rgb
            }
        }
    }
}

/// A lane that leads, see [`Basis::lead`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lane(u8);

impl Spectrum {
    /// The value of a lane.
    #[inline]
    pub fn at(self, lane: Lane) -> f32 {
        self.lanes()[usize::from(lane.0)]
    }
}

/// How much an amount may exceed its largest component at some wavelength: curves are at most 1.
const HEADROOM: f32 = 2.0;

/// What a colour's curve is taken from.
#[derive(Clone, Copy, PartialEq)]
enum Fit {
    /// A share of light: the curve of this colour.
    Tight,
    /// An amount: [`HEADROOM`] times its largest component times the curve of what is left, which is smoother (pbrt-v4).
    Loose,
}

/// Lanes of a colour's curve.
fn smooth(wavelengths: &Wavelengths, c: Color, fit: Fit) -> Spectrum {
    let largest = c.rgb.into_iter().fold(0.0, f32::max);
    if fit == Fit::Tight && largest <= 1.0 {
        let curve = Smooth::of(c.rgb);
        return Spectrum::from_lanes(wavelengths.nm().map(|nm| curve.at(nm)));
    }
    if largest <= 0.0 {
        return Spectrum::BLACK;
    }
    let factor = HEADROOM * largest;
    let curve = Smooth::of(c.rgb.map(|v| v / factor));
    Spectrum::from_lanes(wavelengths.nm().map(|nm| factor * curve.at(nm)))
}

#[inline]
fn rgb_lanes(c: Color) -> Spectrum {
    let [r, g, b] = c.rgb;
    Spectrum::from_lanes([r, g, b, g])
}

#[cfg(test)]
mod tests;
