//! `transform`: steps one after another, each in world space.
use durer_core::glam::{DAffine3, DMat3, DVec3};

use super::value::{number, numbers, triple};

/// The steps.
pub(super) const STEPS: [&str; 5] = ["translate", "rotate", "scale", "lookat", "matrix"];

/// The step called `name`, whose attributes `attribute` tells.
pub(super) fn step(name: &str, attribute: impl Fn(&str) -> Option<String>) -> Result<DAffine3, String> {
    let vector = |usual: f64| -> Result<DVec3, String> {
        if let Some(value) = attribute("value") {
            return triple(&value).map(DVec3::from);
        }
        let mut all = [usual; 3];
        for (place, axis) in all.iter_mut().zip(["x", "y", "z"]) {
            if let Some(value) = attribute(axis) {
                *place = number(&value)?;
            }
        }
        Ok(all.into())
    };
    let needed = |name: &str| attribute(name).ok_or_else(|| format!("\"{name}\" is missing"));
    match name {
        "translate" => Ok(DAffine3::from_translation(vector(0.0)?)),
        "scale" => Ok(DAffine3::from_scale(vector(1.0)?)),
        "rotate" => {
            let axis = vector(0.0)?.try_normalize().ok_or("the axis has no direction")?;
            Ok(DAffine3::from_axis_angle(axis, number(&needed("angle")?)?.to_radians()))
        }
        "lookat" => {
            let point = |name: &str| triple(&needed(name)?).map(DVec3::from);
            let up = attribute("up").map_or(Ok(DVec3::ZERO), |up| triple(&up).map(DVec3::from))?;
            look_at(point("origin")?, point("target")?, up)
        }
        _ => matrix(&numbers(&needed("value")?)?),
    }
}

/// Mitsuba's `lookat`: +z to the target, +y up, and +x, as space is right-handed, to the left. Without `up` any will do.
fn look_at(origin: DVec3, target: DVec3, up: DVec3) -> Result<DAffine3, String> {
    let forward = (target - origin).try_normalize().ok_or("origin and target are the same")?;
    let up = if up == DVec3::ZERO { forward.any_orthogonal_vector() } else { up };
    let left = up.cross(forward).try_normalize().ok_or("up is the direction of view")?;
    let matrix = DMat3::from_cols(left, forward.cross(left), forward);
    Ok(DAffine3::from_mat3_translation(matrix, origin))
}

/// Nine or sixteen numbers, row by row.
fn matrix(m: &[f64]) -> Result<DAffine3, String> {
    let (rows, translation) = match *m {
        [a, b, c, d, e, f, g, h, i] => ([[a, b, c], [d, e, f], [g, h, i]], DVec3::ZERO),
        [a, b, c, x, d, e, f, y, g, h, i, z, p, q, r, w] => {
            if [p, q, r] != [0.0; 3] || w == 0.0 {
                return Err("a matrix that is no affine map cannot be used".to_owned());
            }
            let rows = [[a, b, c], [d, e, f], [g, h, i]].map(|row| row.map(|v| v / w));
            (rows, DVec3::new(x, y, z) / w)
        }
        _ => return Err(format!("expected 9 or 16 numbers, found {}", m.len())),
    };
    let [x, y, z] = rows.map(DVec3::from);
    Ok(DAffine3::from_mat3_translation(DMat3::from_cols(x, y, z).transpose(), translation))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that fails may panic")]
mod tests {
    use super::*;

    fn of(name: &str, attributes: &[(&str, &str)]) -> Result<DAffine3, String> {
        step(name, |wanted| attributes.iter().find(|(n, _)| *n == wanted).map(|(_, v)| (*v).to_owned()))
    }

    #[test]
    fn steps_move_points_as_in_mitsuba() {
        let p = DVec3::new(1.0, 2.0, 3.0);
        let moved = |name, attributes: &[_]| of(name, attributes).unwrap().transform_point3(p);
        assert_eq!(moved("translate", &[("z", "2")]), DVec3::new(1.0, 2.0, 5.0));
        assert_eq!(moved("scale", &[("value", "2")]), p * 2.0);
        assert_eq!(moved("scale", &[("x", "2")]), DVec3::new(2.0, 2.0, 3.0));
        assert!(
            moved("rotate", &[("z", "1"), ("angle", "90")]).abs_diff_eq(DVec3::new(-2.0, 1.0, 3.0), 1e-12)
        );
        let rows = "1 0 0 5  0 0 1 6  0 1 0 7  0 0 0 1";
        assert_eq!(moved("matrix", &[("value", rows)]), DVec3::new(6.0, 9.0, 9.0));
        assert_eq!(moved("matrix", &[("value", "0 1 0, 1 0 0, 0 0 1")]), DVec3::new(2.0, 1.0, 3.0));
    }

    #[test]
    fn a_camera_that_looks_at_something_has_x_to_its_left() {
        let looks = [("origin", "0, 0, -5"), ("target", "0 0 0"), ("up", "0 1 0")];
        let placed = of("lookat", &looks).unwrap();
        assert_eq!(placed.transform_point3(DVec3::new(0.0, 0.0, 5.0)), DVec3::ZERO);
        // Looking along +z with y up, the world's +x is to the left.
        assert_eq!(placed.transform_vector3(DVec3::X), DVec3::X);
    }

    #[test]
    fn steps_without_meaning_are_refused() {
        let wrong = |name, attributes: &[_]| of(name, attributes).unwrap_err();
        assert_eq!(wrong("rotate", &[("angle", "3")]), "the axis has no direction");
        assert_eq!(wrong("matrix", &[("value", "1 2 3")]), "expected 9 or 16 numbers, found 3");
        let same = [("origin", "0 0 0"), ("target", "0 0 0")];
        assert_eq!(wrong("lookat", &same), "origin and target are the same");
        assert_eq!(wrong("translate", &[("x", "east")]), "expected a number, found \"east\"");
    }
}
