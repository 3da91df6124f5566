//! The words of `--sample`.
use std::sync::atomic::{AtomicBool, Ordering};

use durer::{
    Gather, Prepared,
    drive::{Antialias, Taken},
    spectrum::luminance,
};

use crate::exit::WrongUsage;

/// Samples of a pixel where all of them must be held at once.
const MOST_SAMPLES: u32 = 1 << 16;
/// Rays of all trees that are shown together.
const MOST_RAYS: u64 = 500_000;

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

    /// Their indices; `None` if there is none. Samples are taken to look for one, but not kept: of a search that was
    /// cancelled the best so far.
    pub(super) fn of(
        self,
        prepared: &Prepared,
        pixel: [u32; 2],
        cancel: &AtomicBool,
    ) -> Result<Option<Vec<u32>>, WrongUsage> {
        let job = prepared.job();
        let count = || job.sample_count(pixel);
        let light = |taken: &Taken| luminance(taken.rgb.unwrap_or_default().map(f64::from));
        let taken = || job.each_sample(pixel, Gather::Rays).take_while(|_| !cancel.load(Ordering::Relaxed));
        Ok(match self {
            Self::Index(sample) => {
                check_sample(prepared, count(), sample)?;
                Some(vec![sample])
            }
            Self::All => {
                check_many("--sample all shows", count())?;
                let rays = job.record(pixel, 0).0.nodes.len() as u64;
                check_rays(count(), rays)?;
                Some((0..count()).collect())
            }
            Self::Nan => taken().find(|s| !light(s).is_finite()).map(|s| vec![s.sample]),
            Self::Brightest => {
                let finite = taken().map(|s| (s.sample, light(&s))).filter(|(_, light)| light.is_finite());
                let best = finite.reduce(|best, s| if s.1 > best.1 { s } else { best });
                Some(vec![best.map_or(0, |(sample, _)| sample)])
            }
        })
    }
}

/// Complains about a sample that the pixel does not have.
pub(crate) fn check_sample(prepared: &Prepared, count: u32, sample: u32) -> Result<(), WrongUsage> {
    if sample < count {
        return Ok(());
    }
    Err(WrongUsage(match prepared.settings.antialias {
        Antialias::Supersample => {
            format!("there is no sample {sample}: a pixel has {count} (--spp), counted from 0")
        }
        Antialias::Adaptive(_) => {
            format!("there is no sample {sample}: this pixel has {count}, counted from 0")
        }
    }))
}

/// Complains where all samples of a pixel must be held at once, and they are too many.
pub(crate) fn check_many(what: &str, count: u32) -> Result<(), WrongUsage> {
    if count <= MOST_SAMPLES {
        return Ok(());
    }
    Err(WrongUsage(format!(
        "{what} all {count} samples of a pixel: more than {MOST_SAMPLES} are not kept\n  \
         help: lower --spp, or ask for one of them: --sample K, brightest or nan"
    )))
}

/// Complains about more rays than fit in memory.
fn check_rays(samples: u32, rays: u64) -> Result<(), WrongUsage> {
    let all = u64::from(samples) * rays;
    if all <= MOST_RAYS {
        return Ok(());
    }
    Err(WrongUsage(format!(
        "--sample all shows about {all} rays of {samples} samples: more than {MOST_RAYS} are not kept\n  \
         help: lower --spp, or ask for one of them: --sample K, brightest or nan"
    )))
}
