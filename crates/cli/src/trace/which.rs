//! The words of `--sample`.
use durer::drive::Taken;

/// Which samples of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Which {
    Index(u32),
    All,
    /// Of the finite ones that of the largest luminance.
    Brightest,
    /// The first that is infinite or NaN.
    Nan,
}

impl Which {
    pub(super) fn read(word: &str) -> Result<Self, String> {
        match word {
            "all" => Ok(Self::All),
            "brightest" => Ok(Self::Brightest),
            "nan" => Ok(Self::Nan),
            number => number.trim().parse().map(Self::Index).map_err(|_| {
                format!(
                    "expected a whole number from 0 to {}, or one of the words all, brightest, nan",
                    u32::MAX
                )
            }),
        }
    }

    /// Their indices; `None` if there is none.
    pub(super) fn of(self, samples: &[Taken]) -> Option<Vec<u32>> {
        let light = |taken: &Taken| {
            let [r, g, b] = taken.rgb.unwrap_or_default().map(f64::from);
            0.2126 * r + 0.7152 * g + 0.0722 * b
        };
        match self {
            Self::Index(sample) => Some(vec![sample]),
            Self::All => Some(samples.iter().map(|s| s.sample).collect()),
            Self::Nan => samples.iter().find(|s| !light(s).is_finite()).map(|s| vec![s.sample]),
            Self::Brightest => {
                let finite = samples.iter().filter(|s| light(s).is_finite());
                let best = finite.reduce(|best, s| if light(s) > light(best) { s } else { best });
                best.or(samples.first()).map(|s| vec![s.sample])
            }
        }
    }
}
