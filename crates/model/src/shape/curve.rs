//! Strands along cubic curves: hair, fur, grass, threads. What comes of them is Bezier segments, which the kernel intersects
//! without cutting them (`durer_accel::curve`).
//!
//! Control points are pbrt-v4's: Bezier or uniform B-spline, of degree 2 or 3, of any number of segments; the width goes evenly
//! from one end to the other. A quadratic segment `q0 q1 q2` is the cubic `q0, (q0 + 2 q1) / 3, (2 q1 + q2) / 3, q2`.
use std::sync::Arc;

use durer_core::math::{Bounds3, Point3, Vector3};
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use super::{ALPHA, Geometry};

/// What surface strands have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum StrandForm {
    /// Ribbons that face every ray.
    Flat,
    /// Ribbons with normals of their own.
    Ribbon,
    /// Tubes with round ends.
    Round,
}

/// Cubic Bezier segments.
#[derive(Clone, Debug, PartialEq)]
pub struct Strands {
    /// Their surface.
    pub form: StrandForm,
    /// Four control points of each segment.
    pub points: Vec<Point3>,
    /// Half the width at each control point.
    pub radii: Vec<f32>,
    /// A normal at each control point of ribbons; else empty.
    pub normals: Vec<Vector3>,
}

impl Strands {
    /// Control points of a segment.
    pub const POINTS: usize = 4;

    /// How many segments there are.
    pub fn count(&self) -> usize {
        self.points.len() / Self::POINTS
    }
    /// A box around all of it.
    pub fn bounds(&self) -> Bounds3 {
        let balls = self.points.iter().zip(&self.radii);
        Bounds3::around(balls.flat_map(|(p, r)| [*p - Vector3::splat(*r), *p + Vector3::splat(*r)]))
    }
}

/// The word `curve`.
#[derive(Clone, Copy, Debug)]
pub struct Curve;

impl Kind for Curve {
    type Output = Geometry;
    const SCHEMA: Schema = Schema {
        name: "curve",
        aliases: &[],
        doc: "A strand along a chain of cubic or quadratic curves, for hair and grass. Along it is u, across it v.",
        params: &[
            ParamSpec::new("P", ParamType::Point3s, ParamDefault::Required, "Control points.").unit("m"),
            ParamSpec::new(
                "type",
                ParamType::Choice(&["flat", "ribbon", "cylinder"]),
                ParamDefault::Text("flat"),
                "flat: a ribbon that faces every ray, for hair; ribbon: with normals; cylinder: a tube with round ends.",
            ),
            ParamSpec::new(
                "basis",
                ParamType::Choice(&["bezier", "bspline"]),
                ParamDefault::Text("bezier"),
                "bezier: the segments share their ends; bspline: each segment begins one point later.",
            ),
            ParamSpec::new("degree", ParamType::Int, ParamDefault::Int(3), "Of the curve: 2 or 3.")
                .range(2.0, 3.0),
            ParamSpec::float("width", 1.0, "Width, everywhere.").unit("m").range(0.0, f32::INFINITY),
            ParamSpec::new(
                "width0",
                ParamType::Float,
                ParamDefault::Unset,
                "Width at the first end; default width.",
            )
            .unit("m")
            .range(0.0, f32::INFINITY),
            ParamSpec::new(
                "width1",
                ParamType::Float,
                ParamDefault::Unset,
                "Width at the last end; default width.",
            )
            .unit("m")
            .range(0.0, f32::INFINITY),
            ParamSpec::new(
                "widths",
                ParamType::Floats,
                ParamDefault::Unset,
                "Widths of the control points instead, as many as \"P\" has: mixed as the points are.",
            )
            .unit("m")
            .range(0.0, f32::INFINITY),
            ParamSpec::new(
                "N",
                ParamType::Normals,
                ParamDefault::Unset,
                "Normals of a ribbon, where segments begin and end.",
            ),
            ParamSpec::new(
                "splitdepth",
                ParamType::Int,
                ParamDefault::Int(3),
                "No effect: the hierarchy cuts boxes where it helps.",
            ),
            ALPHA,
        ],
    };

    fn build(args: &mut Args<'_>) -> Option<Geometry> {
        let points: Vec<Point3> = args.triples("P").into_iter().map(Point3::from).collect();
        let degree = args.int("degree") as usize;
        let form = match args.text("type") {
            "ribbon" => StrandForm::Ribbon,
            "cylinder" => StrandForm::Round,
            _ => StrandForm::Flat,
        };
        let is_spline = args.text("basis") == "bspline";
        if !args.is_sound() {
            return None;
        }
        let step = if is_spline { 1 } else { degree };
        if points.len() <= degree || !(points.len() - 1 - degree).is_multiple_of(step) {
            let expected = match is_spline {
                true => format!("{} or more", degree + 1),
                false => format!("{} and then {degree} for each further segment", degree + 1),
            };
            args.error("P", format!("\"P\" has {} points, expected {expected}", points.len()));
            return None;
        }
        let count = (points.len() - 1 - degree) / step + 1;
        let normals: Vec<Vector3> = args.triples("N").into_iter().map(Vector3::from).collect();
        let normals = ribbon_normals(args, form, (count, normals))?;
        let width = args.float("width");
        let [w0, w1] = ["width0", "width1"].map(|name| args.optional_float(name).unwrap_or(width));
        let widths = args.floats("widths");
        if !widths.is_empty() && widths.len() != points.len() {
            let message = format!(
                "\"widths\" has {} values, expected {}, as many as \"P\"",
                widths.len(),
                points.len()
            );
            args.error("widths", message);
            return None;
        }
        let weights = bezier(degree, is_spline);
        let mut strands = Strands { form, points: Vec::new(), radii: Vec::new(), normals };
        for segment in 0..count {
            let control = &points[segment * step..];
            strands.points.extend(weights.map(|weights| {
                let parts = control.iter().zip(weights).map(|(p, w)| p.to_f64() * w);
                Point3::from_f64(parts.fold(Vector3::ZERO.to_f64(), |sum, part| sum + part))
            }));
            if let Some(own) = widths.get(segment * step..).filter(|own| !own.is_empty()) {
                strands.radii.extend(weights.map(|weights| {
                    let parts = own.iter().zip(weights).map(|(width, w)| 0.5 * f64::from(*width) * w);
                    parts.sum::<f64>() as f32
                }));
                continue;
            }
            // The same bits where segments meet, so that tubes have no walls there.
            let at = |i: usize| 0.5 * (w0 + (w1 - w0) * (i as f32 / (3 * count) as f32));
            strands.radii.extend((0..Strands::POINTS).map(|i| at(3 * segment + i)));
        }
        Some(Geometry::Strands(Arc::new(strands)))
    }
}

/// Normals at the control points of ribbons, evenly between those at the ends of segments.
fn ribbon_normals(
    args: &mut Args<'_>,
    form: StrandForm,
    (count, given): (usize, Vec<Vector3>),
) -> Option<Vec<Vector3>> {
    if form != StrandForm::Ribbon {
        if !given.is_empty() {
            args.warning("N", "\"N\" has no effect: only the type \"ribbon\" has normals");
        }
        return Some(Vec::new());
    }
    if given.len() != count + 1 {
        let message = format!(
            "\"N\" has {} normals, expected {}, where segments begin and end",
            given.len(),
            count + 1
        );
        args.error("N", message);
        return None;
    }
    let between = |pair: &[Vector3]| {
        let (a, b) = (pair[0].normalize(), pair[1].normalize());
        [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0].map(|t| a * (1.0 - t) + b * t)
    };
    Some(given.windows(2).flat_map(between).collect())
}

/// What each control point of a segment counts in the four points of its cubic Bezier curve.
fn bezier(degree: usize, is_spline: bool) -> [[f64; 4]; 4] {
    let third = 1.0 / 3.0;
    let cubed = |q: [[f64; 4]; 3]| {
        let mixed = |a: f64, b: f64, c: f64| [0, 1, 2, 3].map(|i| a * q[0][i] + b * q[1][i] + c * q[2][i]);
        [q[0], mixed(third, 2.0 * third, 0.0), mixed(0.0, 2.0 * third, third), q[2]]
    };
    match (degree, is_spline) {
        (2, false) => cubed([[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]),
        (2, true) => cubed([[0.5, 0.5, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.5, 0.5, 0.0]]),
        (_, false) => [0, 1, 2, 3].map(|i| [0, 1, 2, 3].map(|j| if i == j { 1.0 } else { 0.0 })),
        (_, true) => {
            let sixth = 1.0 / 6.0;
            [
                [sixth, 4.0 * sixth, sixth, 0.0],
                [0.0, 2.0 * third, third, 0.0],
                [0.0, third, 2.0 * third, 0.0],
                [0.0, sixth, 4.0 * sixth, sixth],
            ]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn widths_of_control_points_are_mixed_as_the_points_are() {
        let control = [0.0f64, 6.0, 12.0, 0.0];
        let blended =
            bezier(3, true).map(|weights| control.iter().zip(weights).map(|(v, w)| v * w).sum::<f64>());
        // (0 + 24 + 12) / 6, (12 + 12) / 3, (6 + 24) / 3, (6 + 48 + 0) / 6.
        for (found, expected) in blended.iter().zip([6.0, 8.0, 10.0, 9.0]) {
            assert!((found - expected).abs() < 1e-12, "{blended:?}");
        }
        for (degree, is_spline) in [(2, false), (2, true), (3, false), (3, true)] {
            for weights in bezier(degree, is_spline) {
                assert!(
                    (weights.iter().sum::<f64>() - 1.0).abs() < 1e-12,
                    "{degree} {is_spline} {weights:?}"
                );
            }
        }
    }
}
