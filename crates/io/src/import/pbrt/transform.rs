//! The matrices that directives make.
//!
//! Conventions of pbrt-v4: a written matrix lists its columns, angles are degrees, `LookAt` makes the left-handed camera
//! space (x right, y up, z ahead).
use durer_core::glam::{DAffine3, DMat3, DVec3};

/// The matrix of 16 numbers, column by column.
///
/// # Errors
/// If its last row is not 0 0 0 1.
pub(super) fn matrix(m: &[f64; 16]) -> Result<DAffine3, &'static str> {
    let [a, b, c, p0, d, e, f, p1, g, h, i, p2, x, y, z, w] = *m;
    // Exporters print rounded numbers: a last row this near is meant to be 0 0 0 1.
    if p0.abs().max(p1.abs()).max(p2.abs()).max((w - 1.0).abs()) > 1e-6 {
        return Err(
            "the 4th, 8th and 12th number must be 0 and the 16th 1: durer has no projective transformations",
        );
    }
    Ok(DAffine3 {
        matrix3: DMat3::from_cols(DVec3::new(a, b, c), DVec3::new(d, e, f), DVec3::new(g, h, i)),
        translation: DVec3::new(x, y, z),
    })
}

/// Rotation by `degrees` about `axis`, right-handed; multiples of 90 degrees are exact.
///
/// # Errors
/// If the axis has no direction.
pub(super) fn rotate(degrees: f64, axis: DVec3) -> Result<DAffine3, &'static str> {
    let n = unit(axis).ok_or("the axis of a rotation must not be 0 0 0")?;
    let (sin, cos) = match degrees.rem_euclid(360.0) {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        d => d.to_radians().sin_cos(),
    };
    // Rodrigues: v cos + (n x v) sin + n (n . v) (1 - cos), for the three axes.
    let column = |v: DVec3| v * cos + n.cross(v) * sin + n * (n.dot(v) * (1.0 - cos));
    Ok(DAffine3::from_mat3(DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z))))
}

/// `camera_from_world` of a camera at `eye` that looks at `target`.
///
/// # Errors
/// If the three do not span a frame.
pub(super) fn look_at(eye: DVec3, target: DVec3, up: DVec3) -> Result<DAffine3, &'static str> {
    let ahead = unit(target - eye).ok_or("LookAt: the eye and the point looked at are the same")?;
    let up = unit(up).ok_or("LookAt: the up vector must not be 0 0 0")?;
    let right = up.cross(ahead);
    if right.length() < 1e-12 {
        return Err("LookAt: the up vector points along the viewing direction");
    }
    let right = right.normalize();
    let axes = DMat3::from_cols(right, ahead.cross(right), ahead);
    Ok(DAffine3 { matrix3: axes, translation: eye }.inverse())
}

/// Unit vector, whatever the size of the numbers; `None` for zero and what is not finite.
pub(super) fn unit(v: DVec3) -> Option<DVec3> {
    let largest = v.abs().max_element();
    if largest > 0.0 && largest.is_finite() { (v / largest).try_normalize() } else { None }
}

#[cfg(test)]
#[expect(clippy::expect_used, reason = "a test may panic")]
mod tests {
    use super::*;

    fn close(a: DVec3, b: [f64; 3]) {
        assert!((a - DVec3::from(b)).length() < 1e-12, "{a} is not {b:?}");
    }

    #[test]
    fn look_at_is_left_handed() {
        // Eye on the negative z axis looking along +z with y up: camera space is world space moved.
        let m = look_at(DVec3::new(1.0, 2.0, -5.0), DVec3::new(1.0, 2.0, 0.0), DVec3::Y).expect("a frame");
        close(m.transform_point3(DVec3::new(1.0, 2.0, -5.0)), [0.0, 0.0, 0.0]);
        close(m.transform_vector3(DVec3::X), [1.0, 0.0, 0.0]);
        close(m.transform_vector3(DVec3::Z), [0.0, 0.0, 1.0]);
        // Looking along -z from +z: the world's x axis points to the left.
        let m = look_at(DVec3::new(0.0, 0.0, 4.0), DVec3::ZERO, DVec3::Y).expect("a frame");
        close(m.transform_point3(DVec3::ZERO), [0.0, 0.0, 4.0]);
        close(m.transform_vector3(DVec3::X), [-1.0, 0.0, 0.0]);
        close(m.transform_vector3(DVec3::Y), [0.0, 1.0, 0.0]);
        assert!(m.matrix3.determinant() > 0.0);
        // Looking along +x with z up: right is up x ahead = z x x = y.
        let m = look_at(DVec3::ZERO, DVec3::X, DVec3::Z).expect("a frame").inverse();
        close(m.transform_vector3(DVec3::X), [0.0, 1.0, 0.0]);
        close(m.transform_vector3(DVec3::Y), [0.0, 0.0, 1.0]);
        close(m.transform_vector3(DVec3::Z), [1.0, 0.0, 0.0]);
    }

    #[test]
    fn rotation_is_right_handed_and_exact_at_right_angles() {
        let m = rotate(90.0, DVec3::new(0.0, 0.0, 7.0)).expect("an axis");
        assert_eq!(m.transform_vector3(DVec3::X), DVec3::Y);
        assert_eq!(rotate(-270.0, DVec3::Z).expect("an axis"), m);
        let m = rotate(120.0, DVec3::ONE).expect("an axis");
        close(m.transform_vector3(DVec3::X), [0.0, 1.0, 0.0]);
        close(m.transform_vector3(DVec3::Y), [0.0, 0.0, 1.0]);
        let m = rotate(30.0, DVec3::Y).expect("an axis");
        close(m.transform_vector3(DVec3::Z), [0.5, 0.0, 0.75f64.sqrt()]);
    }

    #[test]
    fn matrices_list_their_columns() {
        let m = [1., 2., 3., 0., 4., 5., 6., 0., 7., 8., 10., 0., 11., 12., 13., 1.];
        let m = matrix(&m).expect("affine");
        close(m.transform_point3(DVec3::X), [12.0, 14.0, 16.0]);
        close(m.transform_vector3(DVec3::Z), [7.0, 8.0, 10.0]);
        let mut projective = [0.0; 16];
        projective[15] = 2.0;
        assert!(matrix(&projective).is_err());
    }

    #[test]
    fn what_spans_no_frame_is_refused() {
        assert!(look_at(DVec3::ONE, DVec3::ONE, DVec3::Y).is_err());
        assert!(look_at(DVec3::ZERO, DVec3::Y, DVec3::Y).is_err());
        assert!(rotate(1.0, DVec3::ZERO).is_err());
    }
}
