//! Points that move on straight lines between keys.
use super::Point3;

/// Which keys surround a moment, and how far it lies between them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// The earlier key; the later one follows it.
    pub key: usize,
    /// 0 at the earlier, 1 at the later.
    pub u: f32,
}

impl Segment {
    /// The segment of `time` among at least two keys with rising times. Before the first and after the last key time
    /// stands still.
    #[inline]
    pub fn at(time: f32, keys: usize, time_of: impl Fn(usize) -> f32) -> Self {
        let mut key = 0;
        while key + 2 < keys && time_of(key + 1) <= time {
            key += 1;
        }
        let (t0, t1) = (time_of(key), time_of(key + 1));
        Self { key, u: ((time - t0) / (t1 - t0)).clamp(0.0, 1.0) }
    }

    /// The point at `u` between `a` and `b`. It never leaves the box around the two, whatever rounding does.
    #[inline]
    pub fn point(&self, a: Point3, b: Point3) -> Point3 {
        let one = |a: f32, b: f32| {
            let x = a * (1.0 - self.u) + b * self.u;
            if a < b { x.clamp(a, b) } else { x.clamp(b, a) }
        };
        Point3::new(one(a.x, b.x), one(a.y, b.y), one(a.z, b.z))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_find_their_segment_and_time_stands_still_outside() {
        let times = [1.0f32, 2.0, 4.0];
        let at = |t| Segment::at(t, 3, |i| times[i]);
        for (t, key, u) in [(0.0, 0, 0.0), (1.5, 0, 0.5), (2.0, 1, 0.0), (3.0, 1, 0.5), (9.0, 1, 1.0)] {
            assert_eq!(at(t), Segment { key, u }, "{t}");
        }
    }

    #[test]
    fn ends_are_met_exactly_and_never_passed() {
        let (a, b) = (Point3::new(0.1, -3.7, 1e9), Point3::new(0.3, -3.7, -2e-9));
        for i in 0..=1000 {
            let p = Segment { key: 0, u: i as f32 / 1000.0 }.point(a, b);
            assert!(p.x >= a.x && p.x <= b.x && p.y == a.y && p.z <= a.z && p.z >= b.z);
        }
        let end = |u| Segment { key: 0, u }.point(a, b);
        assert_eq!((end(0.0), end(1.0)), (a, b));
    }
}
