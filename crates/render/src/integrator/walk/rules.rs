//! What an integrator asks of the recursion, and the parameters that all of them take.
use std::num::NonZeroU32;

use durer_scene::{Args, ParamDefault, ParamSpec, ParamType};

/// What an integrator asks of the recursion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rules {
    /// Bounces traced at most.
    pub(crate) max_depth: u32,
    /// A branch whose share in the pixel is at or below this is not traced.
    pub(crate) min_contribution: f32,
    /// Shadow rays to each light with extent; 0: one to its middle.
    pub(crate) shadow_rays: u32,
    /// Rays drawn from each lobe that spreads; `None`: its sharp direction stands for it.
    pub(crate) gloss_rays: Option<NonZeroU32>,
}

/// The parameter that limits the depth.
pub(crate) const MAX_DEPTH: ParamSpec =
    ParamSpec::new("maxdepth", ParamType::Int, ParamDefault::Int(10), "Bounces traced at most.")
        .unit("bounces")
        .range(0.0, 1000.0);
/// The parameter that limits the contribution.
pub(crate) const MIN_CONTRIBUTION: ParamSpec = ParamSpec::float(
    "mincontribution",
    1.0 / 512.0,
    "A branch whose share in the pixel is at or below this is not traced.",
)
.range(0.0, 1.0);

impl Rules {
    /// Whitted's rules with the limits that the parameters above give.
    pub(crate) fn read(args: &Args<'_>) -> Self {
        Self {
            max_depth: args.int(MAX_DEPTH.name) as u32,
            min_contribution: args.float(MIN_CONTRIBUTION.name),
            shadow_rays: 1,
            gloss_rays: None,
        }
    }
}
