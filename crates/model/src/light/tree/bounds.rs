//! What is known of a light, or of many, by which they are chosen: a box, a cone of normals, an intensity.
//!
//! The cone of normals and the angle from them at which the light ends are those of Conty Estevez and Kulla 2018
//! ("Importance Sampling of Many Lights with Adaptive Tree Splitting", section 4).
use std::f32::consts::{FRAC_PI_2, PI, TAU};

use durer_core::math::{
    Bounds3, Vector3,
    float::{atan2, cos, sin},
};

/// Rounding of the axis of a cone that was made of others, in radians.
const ROUNDING: f32 = 1e-6;

/// All directions within an angle of an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// The axis, of unit length.
    pub axis: Vector3,
    /// The angle, in `[0, pi]`.
    pub angle: f32,
}

impl Cone {
    /// All directions.
    pub const ALL: Self = Self { axis: Vector3::new(0.0, 0.0, 1.0), angle: PI };

    /// One direction, of unit length.
    pub const fn direction(axis: Vector3) -> Self {
        Self { axis, angle: 0.0 }
    }

    /// A cone around both.
    #[must_use]
    pub fn union(self, o: Self) -> Self {
        let (a, b) = if self.angle >= o.angle { (self, o) } else { (o, self) };
        let normal = a.axis.cross(b.axis);
        let between = atan2(normal.length(), a.axis.dot(b.axis));
        if between + b.angle <= a.angle || a.axis == b.axis {
            return a;
        }
        let angle = 0.5 * (a.angle + between + b.angle) + ROUNDING;
        if angle >= PI || normal.length_squared() == 0.0 {
            return Self::ALL;
        }
        // The axis of the wider one turns towards that of the other.
        let turn = angle - a.angle;
        let aside = normal.cross(a.axis).normalize();
        Self { axis: (a.axis * cos(turn) + aside * sin(turn)).normalize(), angle }
    }
}

/// Where a light is, where it shines to and how strongly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightBounds {
    /// A box around it, at all times.
    pub bounds: Bounds3,
    /// Its normals, or the directions in which it shines alike.
    pub normals: Cone,
    /// The angle from the nearest of them, in `[0, pi]`, beyond which it does not shine.
    pub end: f32,
    /// Whether it shines along its normals reversed as well.
    pub both_sides: bool,
    /// Its largest intensity, in luminance, W/sr.
    pub intensity: f32,
}

impl LightBounds {
    /// Shines from nowhere: the neutral element of `union`.
    pub(crate) const NOTHING: Self = Self {
        bounds: Bounds3::EMPTY,
        normals: Cone::direction(Vector3::new(0.0, 0.0, 1.0)),
        end: 0.0,
        both_sides: false,
        intensity: 0.0,
    };

    /// What is known of both together.
    #[must_use]
    pub fn union(self, o: Self) -> Self {
        if self.intensity == 0.0 || o.intensity == 0.0 {
            return if self.intensity == 0.0 { o } else { self };
        }
        let turned = self.both_sides && o.both_sides && self.normals.axis.dot(o.normals.axis) < 0.0;
        let other = if turned { Cone { axis: -o.normals.axis, ..o.normals } } else { o.normals };
        Self {
            bounds: self.bounds.union(o.bounds),
            normals: self.normals.union(other),
            end: self.end.max(o.end),
            both_sides: self.both_sides || o.both_sides,
            intensity: self.intensity + o.intensity,
        }
    }

    /// How costly it is to have these lights in one node: intensity by the measures of directions and of space (equation 1
    /// of section 4.4). For space it is the square of the diagonal, which lights in a plane or on a line have as well.
    pub(super) fn cost(&self) -> f32 {
        if self.intensity == 0.0 {
            return 0.0;
        }
        let o = self.normals.angle;
        let w = (o + self.end).min(PI);
        let (sin_o, cos_o) = (sin(o), cos(o));
        let rim = 2.0 * w * sin_o - cos(o - 2.0 * w) - 2.0 * o * sin_o + cos_o;
        let directions = TAU * (1.0 - cos_o) + FRAC_PI_2 * rim;
        self.intensity * directions * self.bounds.diagonal().length_squared()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit(x: f32, y: f32, z: f32) -> Vector3 {
        Vector3::new(x, y, z).normalize()
    }

    #[test]
    fn unions_hold_what_they_are_of() {
        let cones = [
            Cone { axis: unit(1.0, 0.0, 0.0), angle: 0.1 },
            Cone { axis: unit(1.0, 0.2, 0.0), angle: 0.0 },
            Cone { axis: unit(0.0, 1.0, 1.0), angle: 0.4 },
            Cone { axis: unit(-1.0, 0.0, 0.1), angle: 0.2 },
            Cone::ALL,
        ];
        for (a, b) in cones.iter().flat_map(|a| cones.iter().map(move |b| (*a, *b))) {
            let both = a.union(b);
            for part in [a, b] {
                let between = atan2(both.axis.cross(part.axis).length(), both.axis.dot(part.axis));
                assert!(
                    between + part.angle <= both.angle + 1e-5 || both.angle == PI,
                    "{a:?} {b:?} {both:?}"
                );
            }
        }
        let wide = cones[0].union(cones[1]);
        assert!((wide.angle - 0.5 * (0.1 + 0.2f32.atan())).abs() < 1e-4, "no wider than needed: {wide:?}");
    }

    #[test]
    fn what_is_spread_over_space_and_directions_costs_more() {
        let at = |x: f32, axis| {
            let p = durer_core::math::Point3::new(x, 0.0, 0.0);
            LightBounds {
                bounds: Bounds3::around([p]),
                normals: Cone::direction(axis),
                end: FRAC_PI_2,
                both_sides: false,
                intensity: 1.0,
            }
        };
        let (up, down) = (unit(0.0, 0.0, 1.0), unit(0.0, 0.0, -1.0));
        let near = at(0.0, up).union(at(1.0, up)).cost();
        assert!(
            near < at(0.0, up).union(at(2.0, up)).cost() && near < at(0.0, up).union(at(1.0, down)).cost()
        );
        assert_eq!(at(0.0, up).union(LightBounds::NOTHING), at(0.0, up));
    }
}
