//! Strands of a text file: a line for each control point, `x y z radius`; an empty line ends a strand.
//!
//! Points are placed by `to_world`, radii are not scaled by it, as in Mitsuba. Tubes have round ends here.
use std::sync::Arc;

use durer_core::glam::{DAffine3, DVec3};
use durer_scene::{Assets, Data, Params, ShapeSource, ValueType};

use super::{
    object::Object,
    shape::Parts,
    world::{World, node},
};

/// A control point and its radius.
type Knot = (DVec3, f64);

/// The strands of a file: cubic B-splines, or straight pieces.
pub(super) fn strands(world: &mut World<'_>, object: &Object) -> Option<Parts> {
    let path = world.path(object, "filename")?;
    let at = object.get("filename").map_or(object.at, |p| p.at);
    let is_spline = object.plugin == "bsplinecurve";
    let read = match world.assets.bytes(&path) {
        Ok(bytes) => parsed(&bytes, if is_spline { 4 } else { 2 }).map_err(|why| format!("{path}: {why}")),
        Err(error) => Err(error.to_string()),
    };
    let strands = match read {
        Ok(strands) => strands,
        Err(message) => {
            world.said.error(at, message);
            return None;
        }
    };
    let placed = object.transform("to_world", world.said);
    let back = placed.inverse();
    if !back.is_finite() {
        world.said.error(object.at, "\"to_world\" makes the strands flat");
        return None;
    }
    let part = |knots: &Vec<Knot>| {
        let knots = knots.iter().map(|(p, r)| (placed.transform_point3(*p), *r));
        let knots = if is_spline { knots.collect() } else { straight(&knots.collect::<Vec<_>>()) };
        let points = knots.iter().flat_map(|(p, _)| p.to_array().map(|v| v as f32)).collect();
        let widths = knots.iter().map(|(_, r)| 2.0 * *r as f32).collect();
        let params = Params::new()
            .string("type", "cylinder")
            .string("basis", if is_spline { "bspline" } else { "bezier" })
            .with("P", ValueType::Point3, Data::Floats(points))
            .with("widths", ValueType::Float, Data::Floats(widths));
        (ShapeSource::Node(Arc::new(node("curve", params, object.at))), back)
    };
    Some(strands.iter().map(part).collect::<Vec<(ShapeSource, DAffine3)>>())
}

/// Straight pieces as cubic ones, each with two more points between its ends.
fn straight(knots: &[Knot]) -> Vec<Knot> {
    let mut all: Vec<Knot> = knots.first().copied().into_iter().collect();
    for (&(a, r), &(b, s)) in knots.iter().zip(knots.iter().skip(1)) {
        all.extend([1.0 / 3.0, 2.0 / 3.0].map(|t| (a.lerp(b, t), r + (s - r) * t)));
        all.push((b, s));
    }
    all
}

/// The strands in a text, of at least so many points.
fn parsed(bytes: &[u8], least: usize) -> Result<Vec<Vec<Knot>>, String> {
    let text = std::str::from_utf8(bytes).map_err(|_| "this is no text of control points")?;
    let mut strands: Vec<Vec<Knot>> = vec![Vec::new()];
    for (number, line) in (1..).zip(text.lines()) {
        let is_new = strands.last().is_none_or(Vec::is_empty);
        if line.trim().is_empty() {
            if !is_new {
                strands.push(Vec::new());
            }
            continue;
        }
        let numbers: Vec<f64> = line.split_whitespace().map_while(|word| word.parse().ok()).collect();
        let [x, y, z, r] = numbers[..] else {
            return Err(format!("line {number} is no control point, expected x y z radius"));
        };
        if ![x, y, z, r].iter().all(|v| (*v as f32).is_finite()) || r < 0.0 {
            return Err(format!("line {number}: a number that is infinite or none, or a radius below 0"));
        }
        if let Some(strand) = strands.last_mut() {
            strand.push((DVec3::new(x, y, z), r));
        }
    }
    strands.retain(|strand| !strand.is_empty());
    match strands.iter().map(Vec::len).min() {
        None => Err("there are no control points in it".to_owned()),
        Some(count) if count < least => {
            Err(format!("a strand has {count} control points, expected {least} or more"))
        }
        Some(_) => Ok(strands),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that fails may panic")]
mod tests {
    use super::*;

    #[test]
    fn empty_lines_part_strands() {
        let text = "\n0 0 0 0.5\n 1 0 0 0.25 \n\n\n0 1 0 1\r\n0 2 0 1\n0 3 1e0 1\n\n";
        let strands = parsed(text.as_bytes(), 2).unwrap();
        assert_eq!(strands.iter().map(Vec::len).collect::<Vec<_>>(), [2, 3]);
        assert_eq!(strands.first().unwrap().get(1), Some(&(DVec3::X, 0.25)));
        let bent = straight(strands.get(1).unwrap());
        assert_eq!((bent.len(), bent.get(3)), (7, Some(&(DVec3::new(0.0, 2.0, 0.0), 1.0))));
    }

    #[test]
    fn damaged_strands_are_told_with_their_line() {
        let wrong = |text: &str| parsed(text.as_bytes(), 4).unwrap_err();
        assert!(wrong("0 0 0 1\n0 0 one 1").contains("line 2"));
        assert!(wrong("0 0 0 1 2").contains("line 1"));
        assert!(wrong("0 0 0 nan").contains("line 1"));
        assert!(wrong("0 0 0 -1").contains("below 0"));
        assert!(wrong("0 0 0 1\n1 0 0 1\n2 0 0 1").contains("3 control points, expected 4"));
        assert!(wrong(" \n").contains("no control points"));
        assert!(parsed(&[0xff, 0xfe], 2).unwrap_err().contains("no text"));
    }
}
