//! pbrt-v4's test functions over the unit square, each of mean 1. Nothing of the scene is looked at: a picture shows how well a
//! sampler integrates, with fewer errors the evener its pixels.
use std::f32::consts::{FRAC_1_PI, FRAC_1_SQRT_2};

use durer_core::{
    math::{Point2, float::exp, float::sqr},
    sampling::Dim,
};
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{Integrator, Start, Transport};
use crate::{
    Contribution, SampleCx, Value,
    probe::{Probe, RayKind, StopReason},
};

/// The integrator: what is integrated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Function {
    /// 2 on the left half, 0 on the right one.
    Step,
    /// 2 on one side of a diagonal.
    Diagonal,
    /// The same in a disk that touches the sides, 0 around it.
    Disk,
    /// 10 by 10 fields of 0 and 2.
    Checkerboard,
    /// The same, turned by 45 degrees.
    RotatedCheckerboard,
    /// The middle of a normal distribution, up to two standard deviations.
    Gaussian,
}

impl Function {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::Step,
        Self::Diagonal,
        Self::Disk,
        Self::Checkerboard,
        Self::RotatedCheckerboard,
        Self::Gaussian,
    ];
    /// The words for them.
    const WORDS: [&str; 6] = ["step", "diagonal", "disk", "checkerboard", "rotatedcheckerboard", "gaussian"];

    /// Its value at a point of the unit square.
    pub fn at(self, p: Point2) -> f32 {
        let half = |is_two: bool| if is_two { 2.0 } else { 0.0 };
        let field = |x: f32, y: f32| half(((10.0 * x) as u32 ^ (10.0 * y) as u32) & 1 == 1);
        // Of the middle.
        let (x, y) = (p.x - 0.5, p.y - 0.5);
        match self {
            Self::Step => half(p.x < 0.5),
            Self::Diagonal => half(p.x + p.y < 1.0),
            Self::Disk if sqr(x) + sqr(y) < 0.25 => 4.0 * FRAC_1_PI,
            Self::Disk => 0.0,
            Self::Checkerboard => field(p.x, p.y),
            Self::RotatedCheckerboard => {
                // The square holds a little more of the fields that are 2; pbrt-v4 has the number.
                const MEAN: f32 = 1.000_068_7;
                let [along, across] = [p.x - p.y, p.x + p.y].map(|v| 10.0 + v * FRAC_1_SQRT_2);
                field(along, across) / MEAN
            }
            Self::Gaussian => {
                // A standard deviation of 1/4, and erf(sqrt 2): what lies within two of them.
                const WITHIN: f32 = 0.954_499_7;
                8.0 * FRAC_1_PI / sqr(WITHIN) * exp(-8.0 * (sqr(x) + sqr(y)))
            }
        }
    }
}

impl Kind for Function {
    type Output = Box<dyn Integrator>;
    const SCHEMA: Schema = Schema {
        name: "function",
        aliases: &[],
        doc: "A function of the numbers that spread samples over a pixel, of mean 1: to compare samplers.",
        params: &[
            ParamSpec::new(
                "function",
                ParamType::Choice(&Self::WORDS),
                ParamDefault::Text("step"),
                "What is integrated.",
            ),
            ParamSpec::new(
                "skipbad",
                ParamType::Bool,
                ParamDefault::Bool(true),
                "No effect: as many samples are taken as are asked for.",
            ),
            ParamSpec::new("filename", ParamType::File, ParamDefault::Unset, "No effect."),
            ParamSpec::new("imagefilename", ParamType::File, ParamDefault::Unset, "No effect."),
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        for name in ["filename", "imagefilename"] {
            if args.is_set(name) {
                let message = format!(
                    "\"{name}\" is not written: the picture itself shows the error of the samples, and --samples says how many"
                );
                args.warning(name, message);
            }
        }
        let number = Self::WORDS.iter().position(|word| *word == args.text("function"))?;
        Some(Box::new(*Self::ALL.get(number)?))
    }
}

impl Transport for Function {
    fn looks(&self) -> bool {
        false
    }
    fn trace<P: Probe>(
        &self,
        cx: &SampleCx<'_>,
        start: Start<'_>,
        parent: P::Id,
        probe: &mut P,
        out: &mut Contribution,
    ) {
        let ray = match start {
            Start::Eye(ray) => ray,
            Start::Again(node) => &node.path,
        };
        let id = probe.ray(parent, ray, RayKind::Eye);
        let radiance = cx.basis.white() * self.at(ray.sampler.d2(Dim::Pixel));
        probe.local(id, radiance);
        probe.stop(id, StopReason::MissedScene, durer_core::spectrum::Spectrum::BLACK);
        probe.result(id, radiance);
        out.value = Value::Radiance(radiance);
        out.rays = 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn functions_have_the_mean_1() {
        const N: u32 = 1500;
        for (function, word) in Function::ALL.into_iter().zip(Function::WORDS) {
            let at = |i: u32| (i as f32 + 0.5) / N as f32;
            let row = |y: u32| (0..N).map(|x| f64::from(function.at(Point2::new(at(x), at(y))))).sum::<f64>();
            let mean = (0..N).map(row).sum::<f64>() / f64::from(N * N);
            assert!((mean - 1.0).abs() < 1e-3, "{word}: {mean}");
        }
    }

    #[test]
    fn functions_are_what_they_are_called() {
        let at = |function: Function, x: f32, y: f32| function.at(Point2::new(x, y));
        assert_eq!((at(Function::Step, 0.4, 0.9), at(Function::Step, 0.6, 0.1)), (2.0, 0.0));
        assert_eq!((at(Function::Diagonal, 0.4, 0.5), at(Function::Diagonal, 0.6, 0.5)), (2.0, 0.0));
        assert_eq!((at(Function::Disk, 0.5, 0.01), at(Function::Disk, 0.1, 0.1)), (4.0 * FRAC_1_PI, 0.0));
        let board = Function::Checkerboard;
        assert_eq!((at(board, 0.05, 0.05), at(board, 0.15, 0.05), at(board, 0.15, 0.15)), (0.0, 2.0, 0.0));
        let (middle, edge) = (at(Function::Gaussian, 0.5, 0.5), at(Function::Gaussian, 1.0, 0.5));
        assert!((edge / middle - exp(-2.0)).abs() < 1e-6, "{middle} {edge}");
    }
}
