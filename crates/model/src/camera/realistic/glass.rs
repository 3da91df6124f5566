//! The surfaces of a lens, and rays that go through them one by one (Kolb, Mitchell and Hanrahan 1995, "A Realistic Camera
//! Model for Computer Graphics"; Physically Based Rendering, 4th edition, online edition, section "Realistic cameras").
//!
//! Coordinates are those of the camera: the film at `z = 0`, the scene along +z. A ray is met with a sphere by the formula of
//! lens designers (Welford 1986, "Aberrations of Optical Systems", section 4.2), which starts at the surface's vertex: it
//! chooses the side of the sphere where the glass is, and does not cancel where the sphere is nearly flat.
use durer_core::glam::DVec3;

/// A surface of a lens, or the aperture stop; in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Interface {
    /// 1 by the radius; above 0 if it bulges towards the scene, 0 for the stop.
    pub(super) curvature: f64,
    /// To the next surface towards the film.
    pub(super) thickness: f64,
    /// Index of refraction on the side of the film.
    pub(super) index: f64,
    /// Of what lets light through.
    pub(super) radius: f64,
}

impl Interface {
    pub(super) fn is_stop(&self) -> bool {
        self.curvature == 0.0
    }
}

/// A surface in its place.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Placed {
    /// Of its vertex, measured from that of the rearmost surface.
    z: f64,
    curvature: f64,
    radius_squared: f64,
    /// Index of refraction on the side of the film by that on the side of the scene.
    ratio: f64,
}

/// A ray that came through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Through {
    /// Where it leaves the front surface.
    pub(super) o: DVec3,
    /// Its unit direction.
    pub(super) d: DVec3,
    /// Where it went through the stop, by the stop's radius.
    pub(super) at_stop: [f64; 2],
}

/// The glass of a lens.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Glass {
    /// From the film to the scene.
    placed: Vec<Placed>,
    /// Of the stop; 1 where there is none.
    stop_radius: f64,
    rear_radius: f64,
}

impl Glass {
    /// `surfaces` from the scene to the film.
    pub(super) fn new(surfaces: &[Interface]) -> Self {
        let mut z = 0.0;
        let mut placed = Vec::with_capacity(surfaces.len());
        for (i, surface) in surfaces.iter().enumerate().rev() {
            if i + 1 < surfaces.len() {
                z += surface.thickness;
            }
            let before = i.checked_sub(1).and_then(|i| surfaces.get(i)).map_or(1.0, |s| s.index);
            placed.push(Placed {
                z,
                curvature: surface.curvature,
                radius_squared: surface.radius * surface.radius,
                ratio: surface.index / before,
            });
        }
        let stop_radius = surfaces.iter().find(|s| s.is_stop()).map_or(1.0, |s| s.radius);
        Self { placed, stop_radius, rear_radius: surfaces.last().map_or(0.0, |s| s.radius) }
    }

    /// Of the rearmost surface, in metres.
    pub(super) fn rear_radius(&self) -> f64 {
        self.rear_radius
    }
    /// From the rearmost surface to the front one, in metres.
    pub(super) fn length(&self) -> f64 {
        self.placed.last().map_or(0.0, |front| front.z)
    }

    /// The way of a ray from the film at distance `film` behind the rearmost surface; `None` if the barrel, the stop or total
    /// reflection ends it.
    pub(super) fn trace(&self, film: f64, mut o: DVec3, d: DVec3) -> Option<Through> {
        let mut d = d.normalize();
        let mut at_stop = [0.0; 2];
        for surface in &self.placed {
            let z = film + surface.z;
            // Where it crosses the plane through the vertex.
            let p = o + d * ((z - o.z) / d.z);
            let c = -surface.curvature;
            let f = c * (p.x * p.x + p.y * p.y);
            let g = d.z - c * (p.x * d.x + p.y * d.y);
            let squared = g * g - c * f;
            if !(squared > 0.0 && g > 0.0) {
                return None;
            }
            let cosine = squared.sqrt();
            let p = p + d * (f / (g + cosine));
            if p.x * p.x + p.y * p.y > surface.radius_squared {
                return None;
            }
            o = p;
            if c == 0.0 {
                at_stop = [p.x / self.stop_radius, p.y / self.stop_radius];
                continue;
            }
            let mu = surface.ratio;
            let squared = 1.0 - mu * mu * (1.0 - cosine * cosine);
            if squared <= 0.0 {
                return None;
            }
            let n = DVec3::new(-c * p.x, -c * p.y, 1.0 - c * (p.z - z));
            d = d * mu + n * (squared.sqrt() - mu * cosine);
            if d.z <= 0.0 {
                return None;
            }
        }
        Some(Through { o, d: d.normalize(), at_stop })
    }
}
