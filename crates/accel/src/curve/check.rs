//! Whether curves are sound: everything their methods take for granted.
use super::{CurveError, CurveKind, Curves};

impl Curves {
    /// Finds the first mistake.
    ///
    /// # Errors
    /// If counts do not match, a segment names points that do not exist, a position is not finite, a radius is
    /// negative or not finite, or a normal is zero or not finite.
    pub fn check(&self) -> Result<(), CurveError> {
        let points = self.points.len();
        if self.radii.len() != points {
            return Err(CurveError::RadiusCount { points, radii: self.radii.len() });
        }
        let expected = if self.kind == CurveKind::Oriented { points } else { 0 };
        if self.normals.len() != expected {
            return Err(CurveError::NormalCount { expected, normals: self.normals.len() });
        }
        if let Some(point) = self.points.iter().position(|p| !p.is_finite()) {
            return Err(CurveError::PointNotFinite { point });
        }
        if let Some(point) = self.radii.iter().position(|r| !(r.is_finite() && *r >= 0.0)) {
            return Err(CurveError::RadiusInvalid { point });
        }
        if let Some(point) = self.normals.iter().position(|n| !n.is_finite() || n.to_array() == [0.0; 3]) {
            return Err(CurveError::NormalInvalid { point });
        }
        let needed = self.basis.points();
        let short = |first: u32| first as usize + needed > points;
        match self.segments.iter().position(|first| short(*first)) {
            Some(segment) => {
                Err(CurveError::SegmentOutOfRange { segment, first: self.segments[segment], needed, points })
            }
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::CurveBasis;
    use durer_core::math::{Point3, Vector3};

    fn sound() -> Curves {
        Curves {
            kind: CurveKind::Oriented,
            basis: CurveBasis::BSpline,
            points: vec![Point3::ZERO; 5],
            radii: vec![0.0; 5],
            normals: vec![Vector3::new(0.0, 1.0, 0.0); 5],
            segments: vec![0, 1],
        }
    }
    fn refused(change: impl Fn(&mut Curves)) -> CurveError {
        let mut curves = sound();
        change(&mut curves);
        curves.check().expect_err("a mistake")
    }

    #[test]
    fn every_mistake_is_found_and_sound_curves_pass() {
        use CurveError as E;
        assert_eq!(sound().check(), Ok(()));
        assert_eq!(Curves { basis: CurveBasis::Linear, segments: vec![3], ..sound() }.check(), Ok(()));
        assert_eq!(refused(|c| c.radii.truncate(4)), E::RadiusCount { points: 5, radii: 4 });
        assert_eq!(refused(|c| c.normals.clear()), E::NormalCount { expected: 5, normals: 0 });
        assert_eq!(refused(|c| c.kind = CurveKind::Flat), E::NormalCount { expected: 0, normals: 5 });
        assert_eq!(refused(|c| c.points[2].y = f32::NAN), E::PointNotFinite { point: 2 });
        for r in [-1e-30, f32::INFINITY, f32::NAN] {
            assert_eq!(refused(|c| c.radii[4] = r), E::RadiusInvalid { point: 4 });
        }
        for n in [0.0, f32::NAN, f32::INFINITY] {
            assert_eq!(refused(|c| c.normals[1] = Vector3::splat(n)), E::NormalInvalid { point: 1 });
        }
        let error = refused(|c| c.segments[1] = 2);
        assert_eq!(error, E::SegmentOutOfRange { segment: 1, first: 2, needed: 4, points: 5 });
        assert_eq!(
            error.to_string(),
            "segment 1 begins at control point 2 and needs 4, but there are 5 (counted from 0); correct the index or add points"
        );
        let wrapping = refused(|c| c.segments[0] = u32::MAX);
        assert_eq!(wrapping, E::SegmentOutOfRange { segment: 0, first: u32::MAX, needed: 4, points: 5 });
    }
}
