//! Lights without extent whose intensity depends on the direction, as a pattern has it: `E = I(w) cos / d²`.
use std::{f32::consts::PI, fmt::Debug, sync::OnceLock};

use durer_core::{
    glam::{DAffine3, DMat3},
    math::{Bounds3, Point2, Point3, Vector3, float::cos},
    sampling::Sampler,
    spectrum::{Color, LightColor},
};

use super::{
    Cone, Emitted, Extent, Leaving, Light, LightBound, LightBounds, LightCx, LightSample, Source, Track,
    falloff::Falloff, largest, pattern_rays::PatternRays,
};

/// How the intensity of a light depends on the direction, in the light's own space.
pub(super) trait Pattern: Debug + Send + Sync {
    /// The intensity in unit direction `d`.
    fn intensity(&self, d: Vector3) -> Color;
    /// A cone outside of which it is black.
    fn cone(&self) -> Cone;
    /// The largest component that it has in any direction.
    fn largest(&self) -> f32;
    /// Luminance of its integral over all directions.
    fn integral(&self) -> f32;
}

/// A light without extent with a pattern.
#[derive(Debug)]
pub(super) struct Beam<P> {
    /// Where it is in its own space.
    position: Point3,
    pattern: P,
    /// Factor on the pattern.
    factor: LightColor,
    track: Track,
    /// What leads from render space to the light's own directions, if it stands still.
    still: Option<(Point3, DMat3)>,
    /// By which directions of particles are chosen, once some are.
    rays: OnceLock<PatternRays>,
}

impl<P: Pattern> Beam<P> {
    pub(super) fn new(position: Point3, pattern: P, factor: LightColor) -> Self {
        let track = Track::still(DAffine3::IDENTITY);
        Self {
            position,
            pattern,
            factor,
            track,
            still: Some((position, DMat3::IDENTITY)),
            rays: OnceLock::new(),
        }
    }
    fn rays(&self) -> &PatternRays {
        self.rays.get_or_init(|| PatternRays::of(&self.pattern))
    }
    /// Density of particles in unit direction `d` of render space, 1/sr: the solid angle grows by `|det M| / |M d|³`.
    fn density(&self, own: &DMat3, d: Vector3) -> f32 {
        let towards = *own * d.to_f64();
        let growth = own.determinant().abs() / towards.length().powi(3);
        self.rays().density(Vector3::from_f64(towards.normalize())) * growth as f32
    }
    fn placed(&self, m: &DAffine3) -> (Point3, DMat3) {
        (Point3::from_f64(m.transform_point3(self.position.to_f64())), m.matrix3.inverse())
    }
    fn at(&self, time: f32) -> (Point3, DMat3) {
        self.still.unwrap_or_else(|| self.placed(&self.track.at(time)))
    }
    /// Its cone in render space, at all times.
    fn cone(&self) -> Cone {
        let own = self.pattern.cone();
        let first = self.track.at(f32::NEG_INFINITY).matrix3;
        let turns = |m: &DMat3| {
            let [x, y, z] = [m.x_axis, m.y_axis, m.z_axis];
            let size = x.length_squared();
            let is = |value: f64, expected: f64| (value - expected).abs() <= 1e-6 * size;
            is(y.length_squared(), size)
                && is(z.length_squared(), size)
                && is(x.dot(y), 0.0)
                && is(y.dot(z), 0.0)
                && is(z.dot(x), 0.0)
        };
        if self.track.stations().all(|m| m.matrix3 == first) && turns(&first) {
            let axis = (first * own.axis.to_f64()).normalize();
            return Cone { axis: Vector3::from_f64(axis), angle: own.angle };
        }
        Cone::ALL
    }
}

impl<P: Pattern> Light for Beam<P> {
    fn place(&mut self, track: &Track) {
        self.still = track.is_still().then(|| self.placed(&track.at(0.0)));
        self.track = track.clone();
    }
    fn sample(&self, cx: &LightCx, p: Point3, _sampler: &Sampler) -> Option<LightSample> {
        let (position, own) = self.at(cx.time);
        let (wi, irradiance) = Falloff::InverseSquare.towards(position, p)?;
        let d = Vector3::from_f64((own * -wi.to_f64()).normalize());
        let weight = cx.basis.tinted(&self.factor, self.pattern.intensity(d)) * irradiance;
        (!weight.is_black()).then_some(LightSample { wi, point: Some(position), weight, pdf: None, on: None })
    }
    /// Of one that moves there is no bound, as it may pass near anything.
    fn bound(&self) -> LightBound {
        let intensity = self.pattern.largest() * largest(self.factor.color);
        let (facing, fades_from) = match self.still {
            Some((position, _)) => (intensity, Some(position)),
            None => (if intensity > 0.0 { f32::INFINITY } else { 0.0 }, None),
        };
        LightBound { facing, fades_from, ..LightBound::default() }
    }
    fn bounds(&self) -> Option<LightBounds> {
        let normals = self.cone();
        let positions = self.track.stations().map(|m| self.placed(m).0);
        let open = 2.0 * PI * (1.0 - cos(self.pattern.cone().angle));
        Some(LightBounds {
            bounds: Bounds3::around(positions),
            normals,
            end: 0.0,
            both_sides: false,
            // The mean over its cone.
            intensity: self.power(0.0) / open.max(f32::MIN_POSITIVE),
        })
    }
    fn power(&self, _radius: f32) -> f32 {
        self.factor.luminance() * self.pattern.integral()
    }
    fn emit(&self, cx: &LightCx, _within: &Extent, [_, u]: [Point2; 2]) -> Option<Emitted> {
        let (p, own) = self.at(cx.time);
        let towards = self.rays().direction(u);
        let d = Vector3::from_f64((own.inverse() * towards.to_f64()).normalize());
        let light = cx.basis.tinted(&self.factor, self.pattern.intensity(towards));
        let pdf_direction = self.density(&own, d);
        (pdf_direction > 0.0 && !light.is_black()).then_some(Emitted {
            p,
            d,
            source: Source::Point,
            light,
            pdf_place: 1.0,
            pdf_direction,
        })
    }
    fn emission_pdf(&self, cx: &LightCx, _within: &Extent, ray: &Leaving) -> [f32; 2] {
        [1.0, self.density(&self.at(cx.time).1, ray.d)]
    }
    fn is_emitter(&self) -> bool {
        self.is_sampled()
    }
    fn is_sampled(&self) -> bool {
        self.power(0.0) > 0.0
    }
}
