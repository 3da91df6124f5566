//! The shutter: when each row of the picture is exposed, and how much at each moment.
//!
//! Openness is linear between equally spaced values over the interval; moments are drawn in proportion to it, so that all
//! count the same. A rolling shutter exposes row `k` of `h` later by `(k + 1/2) / h` times its readout time, as sensors do
//! that are read row by row.
use durer_core::{math::Interval, sampling::LinearDensity};
use durer_scene::{Args, ParamDefault, ParamSpec, ParamType};

/// The parameters of a shutter.
pub(super) const SHUTTER: [ParamSpec; 4] = [
    ParamSpec::float("shutteropen", 0.0, "When the shutter opens, if something moves.").unit("s"),
    ParamSpec::float("shutterclose", 1.0, "When the shutter closes, if something moves.").unit("s"),
    ParamSpec::new(
        "shuttercurve",
        ParamType::Floats,
        ParamDefault::Unset,
        "How far the shutter is open, at two or more moments in equal steps from opening to closing. Default: fully.",
    )
    .range(0.0, f32::INFINITY),
    ParamSpec::float("rollingshutter", 0.0, "How long it takes from the first row to the last to be exposed.")
        .unit("s")
        .range(0.0, f32::INFINITY),
];

/// A shutter.
#[derive(Clone, Debug, PartialEq)]
pub struct Shutter {
    interval: Interval,
    curve: Option<LinearDensity>,
    readout: f32,
}

impl Shutter {
    /// From the parameters [`SHUTTER`].
    pub(super) fn read(args: &mut Args<'_>) -> Self {
        let interval = Interval::new(args.float("shutteropen"), args.float("shutterclose"));
        let values = args.floats("shuttercurve");
        let curve = LinearDensity::new(values.iter().copied());
        if curve.is_none() && args.is_set("shuttercurve") {
            args.error("shuttercurve", "\"shuttercurve\" needs two values or more, one of them above 0");
        }
        Self { interval, curve, readout: args.float("rollingshutter") }
    }

    /// Open for one moment, in seconds.
    pub fn instant(time: f32) -> Self {
        Self { interval: Interval::point(time), curve: None, readout: 0.0 }
    }
    /// The same with other times of opening and closing, in seconds.
    #[must_use]
    pub fn during(&self, interval: Interval) -> Self {
        Self { interval, ..self.clone() }
    }
    /// When the first row begins and ceases to be exposed, in seconds (of a rolling shutter, but for half a row).
    pub fn interval(&self) -> Interval {
        self.interval
    }
    /// Whether each row is exposed for a moment only: no number is needed to choose one.
    pub fn is_instant(&self) -> bool {
        self.interval.min == self.interval.max
    }
    /// Whether rows are exposed one after the other.
    pub fn is_rolling(&self) -> bool {
        self.readout != 0.0
    }
    /// Whether all of the picture is exposed at a single moment.
    pub fn sees_one_moment(&self) -> bool {
        self.is_instant() && self.readout == 0.0
    }
    /// The moment for `u` in `[0, 1]` in row `row` of `rows`, in seconds.
    pub fn moment(&self, u: f32, row: u32, rows: u32) -> f32 {
        let Interval { min, max } = self.interval;
        let open = if min == max {
            min
        } else {
            self.interval.at(self.curve.as_ref().map_or(u, |curve| curve.at(u)))
        };
        if self.readout == 0.0 { open } else { open + (row as f32 + 0.5) / rows as f32 * self.readout }
    }
}
