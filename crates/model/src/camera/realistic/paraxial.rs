//! What a lens does near its axis: focal length, principal planes, and where the film must be for a thing to be sharp
//! (Hecht, "Optics", section 6.1; pbrt's `FocusThickLens`).
//!
//! A ray at height `y` with slope `u` is refracted as `n' u' = n u - y (n' - n) / R` and goes on as `y' = y + t u'`.
use super::glass::Interface;

/// A lens near its axis; in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Paraxial {
    /// From the rear principal plane to where parallel light meets.
    pub(super) focal: f64,
    /// From the rearmost surface on to the rear principal plane, towards the film.
    rear: f64,
    /// From the front principal plane to the rear one, towards the film.
    gap: f64,
    /// Height at the stop of a ray that comes parallel to the axis at height 1; at the front surface if there is no stop.
    pub(super) at_stop: f64,
}

/// A ray parallel to the axis at height 1, sent through: height and slope behind, and height at the stop.
fn sent(surfaces: impl Iterator<Item = (Interface, f64)>) -> [f64; 3] {
    let (mut y, mut nu, mut before) = (1.0, 0.0, 1.0);
    let mut at_stop = None;
    let mut way = 0.0;
    for (surface, behind) in surfaces {
        y += way * nu / before;
        if surface.is_stop() {
            at_stop = Some(y);
        }
        nu -= y * (behind - before) * surface.curvature;
        (before, way) = (behind, surface.thickness);
    }
    [y, nu, at_stop.unwrap_or(1.0)]
}

impl Paraxial {
    /// `surfaces` from the scene to the film; `None` if they do not gather parallel light.
    pub(super) fn new(surfaces: &[Interface]) -> Option<Self> {
        let [y, u, at_stop] = sent(surfaces.iter().map(|s| (*s, s.index)));
        let focal = -1.0 / u;
        if !(focal > 0.0 && focal.is_finite()) {
            return None;
        }
        let length: f64 = surfaces.iter().rev().skip(1).map(|s| s.thickness).sum();
        // The same from behind: each surface bulges the other way, and what was before it comes after it.
        let before = |i: usize| i.checked_sub(1).and_then(|i| surfaces.get(i));
        let turned = surfaces.iter().enumerate().rev().map(|(i, s)| {
            let (way, index) = before(i).map_or((0.0, 1.0), |s| (s.thickness, s.index));
            (Interface { curvature: -s.curvature, thickness: way, ..*s }, index)
        });
        let [front_y, front_u, _] = sent(turned);
        let rear = -y / u - focal;
        let front = -front_y / front_u - focal;
        Some(Self { focal, rear, gap: length + rear + front, at_stop })
    }

    /// Distance of the film behind the rearmost surface at which things `focus` metres from the film are sharp.
    ///
    /// # Errors
    /// What is asked for in vain.
    pub(super) fn film(&self, focus: f64) -> Result<f64, String> {
        // With s + s' = focus - gap and 1/s + 1/s' = 1/f.
        let between = focus - self.gap;
        let root = 1.0 - 4.0 * self.focal / between;
        if between <= 0.0 || root < 0.0 {
            let nearest = 4.0 * self.focal + self.gap;
            return Err(format!("this lens cannot focus nearer than {nearest:.4} m from the film"));
        }
        let behind = 2.0 * self.focal / (1.0 + root.sqrt()) + self.rear;
        match behind > 0.0 {
            true => Ok(behind),
            false => {
                Err("this lens gathers light before it leaves the glass: there is no place for a film"
                    .to_owned())
            }
        }
    }
}
