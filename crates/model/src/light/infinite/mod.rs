//! A sky all around: of the same radiance everywhere, or a picture.
//!
//! Rays that leave the scene see it, and paths choose directions of it: evenly, by the picture
//! (`density.rs`), or through a portal (`portal.rs`). It is its own ambient term and its own glossy reflection, without shadows: tabulated
//! from the picture (`blur.rs`, `pyramid.rs`). In the light's own space z is up (`layout.rs`).
mod blur;
mod density;
pub(crate) mod layout;
mod panorama;
mod portal;
mod pyramid;

use std::{f32::consts::PI, sync::Arc};

use durer_core::{
    glam::DAffine3,
    math::{Normal3, Point2, Point3, Transform, Vector3},
    sampling::{Dim, Sampler},
    spectrum::{Basis, Color, LightColor, Spectrum},
};
use durer_scene::{Args, Image, Kind, ParamDefault, ParamSpec, ParamType, Schema};

pub(super) use self::layout::Layout;
use self::{
    blur::Blur,
    density::Density,
    panorama::Panorama,
    portal::{Portal, View},
    pyramid::Pyramid,
};
use super::{
    Emitted, Extent, LEAST_REACH, Leaving, Light, LightBound, LightCx, LightSample, Source, Track, UNIFORM,
    largest, picture::unfit, scaled, sky_power, uniform_direction,
};

/// A sky all around.
#[derive(Debug)]
pub struct Infinite {
    /// Radiance, or factor on the picture.
    radiance: LightColor,
    picture: Option<Box<Picture>>,
    /// In world space.
    portal: Option<Portal>,
    /// What is seen through the portal, once it is placed.
    view: Option<Box<View>>,
}

#[derive(Debug)]
struct Picture {
    panorama: Panorama,
    blur: Blur,
    /// `None` if it is black.
    density: Option<Density>,
    render_from_light: Transform,
    /// By how much the placement shrinks volumes: 1 but for those that are no rotations.
    shrinking: f32,
}

impl Picture {
    fn new(panorama: Panorama, pyramid: Pyramid) -> Self {
        let blur = Blur::of(pyramid, panorama.size()[1]);
        let density = Density::of(&panorama);
        Self { panorama, blur, density, render_from_light: Transform::IDENTITY, shrinking: 1.0 }
    }
    /// Density of the unit direction `d` in render space which is `towards`, of any length, in the light's own: the solid
    /// angle about it grows by `|det M| / |M d|^3`.
    fn spread(&self, density: f32, towards: Vector3) -> f32 {
        density * self.shrinking / (towards.length_squared() * towards.length())
    }
}

impl Kind for Infinite {
    type Output = Box<dyn Light>;
    const SCHEMA: Schema = Schema {
        name: "infinite",
        aliases: &[],
        doc: "A sky all around, of the same radiance everywhere or a picture.",
        params: &[
            ParamSpec::color("L", [1.0; 3], "Radiance of a sky without picture.")
                .unit("W/(m² sr)")
                .range(0.0, f32::INFINITY),
            ParamSpec::float("scale", 1.0, "Factor on the radiance.").range(0.0, f32::INFINITY),
            ParamSpec::new(
                "illuminance",
                ParamType::Float,
                ParamDefault::Unset,
                "Luminance of the irradiance of a plane, which faces +z if there is a picture; replaces the magnitude of \
                 the radiance, scale still applies.",
            )
            .range(0.0, f32::INFINITY),
            ParamSpec::new(
                "filename",
                ParamType::File,
                ParamDefault::Unset,
                "The picture, relative to the scene file: floats are linear, integers sRGB-encoded.",
            ),
            ParamSpec::new(
                "layout",
                ParamType::Choice(Layout::WORDS),
                ParamDefault::Text("auto"),
                "How the picture lies on the sphere: latitude-longitude with +z at the top and u from +x by +y, \
                 the same with the middles of its first and last rows in the poles (Mitsuba's), or pbrt-v4's equal-area octahedral map. Auto takes square pictures for equal-area ones.",
            ),
            ParamSpec::new(
                "portal",
                ParamType::Point3s,
                ParamDefault::Unset,
                "Four corners, in world space, of a rectangular opening through which paths look for the light, a help where \
                 no light comes in elsewhere; outward is (fourth - first) x (second - first).",
            )
            .unit("m"),
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        let portal = portal(args);
        let even = |radiance| Self { radiance, picture: None, portal, view: None };
        if !args.is_set("filename") {
            return Some(Box::new(even(scaled(args, "L", "illuminance", PI))));
        }
        if args.is_set("L") {
            args.error("L", "a sky has a radiance \"L\" or a picture \"filename\", not both");
        }
        let image = args.image("filename");
        if !args.is_sound() {
            return None;
        }
        let Some(image) = image else {
            // The placeholder of a missing picture.
            return Some(Box::new(even(Color::new(1.0, 0.0, 1.0).into())));
        };
        if let Some(reason) = unfit(&image) {
            args.error("filename", format!("{}: {reason}", args.text("filename")));
            return None;
        }
        let layout = Layout::of_word(args.text("layout"), image.width, image.height);
        let panorama = Panorama::new(image, layout);
        if panorama.is_black() {
            args.warning(
                "filename",
                "the picture is black everywhere (negative values count as 0): it gives no light",
            );
        }
        let pyramid = Pyramid::of(&panorama);
        let mut scale = args.float("scale");
        if let Some(wanted) = args.optional_float("illuminance") {
            let found = pyramid.illuminance();
            if found <= 0.0 {
                args.error(
                    "illuminance",
                    "the upper half of the picture is black: no factor makes it bright",
                );
                return None;
            }
            scale *= wanted / found;
        }
        let picture = Some(Box::new(Picture::new(panorama, pyramid)));
        Some(Box::new(Self { picture, ..even(Color::gray(scale).into()) }))
    }
}

/// The parameter `portal`; complains if it is none.
fn portal(args: &mut Args<'_>) -> Option<Portal> {
    let corners = args.triples("portal");
    match Portal::new(&corners).map_err(|reason| args.is_set("portal").then_some(reason)) {
        Ok(portal) => Some(portal),
        Err(reason) => {
            if let Some(reason) = reason {
                args.error("portal", reason);
            }
            None
        }
    }
}

impl Infinite {
    /// A sound picture, times `scale`.
    pub(super) fn of_picture(image: Arc<Image>, layout: Layout, scale: f32) -> Self {
        let panorama = Panorama::new(image, layout);
        let pyramid = Pyramid::of(&panorama);
        let picture = Some(Box::new(Picture::new(panorama, pyramid)));
        Self { radiance: Color::gray(scale).into(), picture, portal: None, view: None }
    }
    /// Mean luminance over the sphere.
    fn mean(&self) -> f32 {
        let of = |picture: &Picture| picture.density.as_ref().map_or(0.0, |density| density.mean);
        self.radiance.luminance() * self.picture.as_deref().map_or(1.0, of)
    }
    /// A direction for the whole scene, portal or not, and its density, 1/sr; `None` if all is black.
    fn direction(&self, u: Point2) -> Option<(Vector3, f32)> {
        let Some(picture) = &self.picture else { return Some(uniform_direction(u)) };
        let (d, pdf) = picture.density.as_ref()?.draw([u.x, u.y]);
        let wi = picture.render_from_light.vector(d).normalize();
        Some((wi, picture.spread(pdf, picture.render_from_light.inverse().vector(wi))))
    }
    /// The density of [`Infinite::direction`].
    fn density(&self, d: Vector3) -> f32 {
        let Some(picture) = &self.picture else { return UNIFORM };
        let towards = picture.render_from_light.inverse().vector(d);
        let density = picture.density.as_ref().map_or(0.0, |density| density.at(towards.normalize()));
        picture.spread(density, towards)
    }
    /// What `look` says of the picture in a direction of render space; the constant radiance if there is none.
    fn emitted(&self, basis: Basis, d: Vector3, look: impl Fn(&Picture, Vector3) -> [f32; 3]) -> Spectrum {
        let Some(picture) = &self.picture else { return basis.light(&self.radiance) };
        let d = picture.render_from_light.inverse().vector(d).normalize();
        basis.tinted(&self.radiance, Color { rgb: look(picture, d) })
    }
}

impl Light for Infinite {
    fn place(&mut self, track: &Track) {
        if let Some(picture) = &mut self.picture {
            let placement = track.at(f32::NEG_INFINITY);
            picture.render_from_light = Transform::from_f64(&placement);
            picture.shrinking = (1.0 / placement.matrix3.determinant().abs()) as f32;
        }
    }
    fn place_portal(&mut self, render_from_world: &DAffine3) {
        let view = self.portal.filter(|_| self.is_sampled()).map(|portal| {
            let sky = |d| Color { rgb: Basis::Rgb.to_rgb(self.escaped(Basis::Rgb, d)) }.luminance();
            Box::new(View::new(portal.placed(render_from_world), sky))
        });
        self.view = view;
    }
    fn sample(&self, cx: &LightCx, p: Point3, sampler: &Sampler) -> Option<LightSample> {
        let u = sampler.d2(Dim::Light);
        let through = self.view.as_ref().and_then(|view| view.draw(p, [u.x, u.y]));
        let (wi, pdf) = match through {
            Some(drawn) => drawn,
            None => self.direction(u)?,
        };
        let weight = self.escaped(cx.basis, wi) / pdf;
        (!weight.is_black()).then_some(LightSample { wi, point: None, weight, pdf: Some(pdf), on: None })
    }
    fn reach(&self, _p: Point3, n: Option<Normal3>, _time: f32) -> f32 {
        let mean = self.mean();
        match n {
            Some(n) if self.picture.is_some() => {
                PI * self.ambient(Basis::Rgb, n).mean().max(LEAST_REACH * mean)
            }
            _ => PI * mean,
        }
    }
    fn power(&self, radius: f32) -> f32 {
        sky_power(self.mean(), radius)
    }
    fn is_sampled(&self) -> bool {
        let shines = |picture: &Picture| picture.density.is_some();
        self.radiance.luminance() > 0.0 && self.picture.as_deref().is_none_or(shines)
    }
    fn is_even(&self) -> bool {
        self.picture.is_none() && self.portal.is_none()
    }
    fn pdf_escaped(&self, _cx: &LightCx, from: Point3, d: Vector3) -> f32 {
        if let Some(pdf) = self.view.as_ref().and_then(|view| view.at(from, d)) {
            return pdf;
        }
        self.density(d)
    }
    /// A portal is a help for points only: light comes from all directions.
    fn emit(&self, cx: &LightCx, within: &Extent, [place, u]: [Point2; 2]) -> Option<Emitted> {
        let (wi, pdf_direction) = self.direction(u)?;
        let (light, (p, pdf_place)) = (self.escaped(cx.basis, wi), within.before(-wi, place));
        let emitted = Emitted { p, d: -wi, source: Source::Far, light, pdf_place, pdf_direction };
        (pdf_direction > 0.0 && !light.is_black()).then_some(emitted)
    }
    fn emission_pdf(&self, _cx: &LightCx, within: &Extent, ray: &Leaving) -> [f32; 2] {
        [within.density_at(ray.p, ray.d), self.density(-ray.d)]
    }
    fn is_emitter(&self) -> bool {
        self.is_sampled()
    }
    fn surrounds(&self) -> bool {
        true
    }
    /// Blurring makes nothing brighter.
    fn bound(&self) -> LightBound {
        let of_picture = self.picture.as_ref().map_or(1.0, |picture| picture.panorama.largest());
        let most = largest(self.radiance.color) * of_picture;
        LightBound { seen: most, ambient: most, ..LightBound::default() }
    }
    fn ambient(&self, basis: Basis, n: Normal3) -> Spectrum {
        self.emitted(basis, Vector3::new(n.x, n.y, n.z), |p, n| p.blur.ambient(n))
    }
    fn glossy_ambient(&self, basis: Basis, d: Vector3, alpha: f32) -> Spectrum {
        self.emitted(basis, d, |p, d| p.blur.glossy(&p.panorama, d, alpha))
    }
    fn escaped(&self, basis: Basis, d: Vector3) -> Spectrum {
        self.emitted(basis, d, |p, d| p.panorama.seen(d))
    }
}
