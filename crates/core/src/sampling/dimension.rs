//! Names of the random decisions along a path.

/// A random decision. Two decisions at one point of the ray tree never share a dimension; the way to the point is in
/// the sampler's branch (see [`super::Sampler::fork`]).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum Dim {
    /// Position inside the pixel.
    Pixel,
    /// Moment within the shutter interval.
    Time,
    /// Point on the lens.
    Lens,
    /// Point on a light.
    Light,
    /// Direction of a scattered ray.
    Scatter,
    /// Which light.
    LightChoice,
    /// Which of the ways in which a surface scatters.
    Lobe,
    /// Whether a path goes on.
    Roulette,
}

impl Dim {
    /// The word in exports.
    pub fn word(self) -> &'static str {
        match self {
            Self::Pixel => "film",
            Self::Time => "time",
            Self::Lens => "lens",
            Self::Light => "light",
            Self::Scatter => "scatter",
            Self::LightChoice => "light-choice",
            Self::Lobe => "lobe",
            Self::Roulette => "roulette",
        }
    }
}
