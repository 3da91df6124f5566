//! A sky all around: of the same radiance everywhere, or a picture.
//!
//! Rays that leave the scene see it; it is its own ambient term and its own glossy reflection, without shadows: tabulated
//! from the picture (`blur.rs`, `pyramid.rs`). In the light's own space z is up (`layout.rs`).
mod blur;
pub(crate) mod layout;
mod panorama;
mod pyramid;

use std::f32::consts::PI;

use durer_core::{
    math::{Normal3, Transform, Vector3},
    spectrum::{Basis, Color, Spectrum},
};
use durer_scene::{Args, Kind, ParamDefault, ParamSpec, ParamType, Schema};

use self::{blur::Blur, layout::Layout, panorama::Panorama, pyramid::Pyramid};
use super::{Light, Track, scaled};

/// A sky all around.
#[derive(Debug)]
pub struct Infinite {
    /// Radiance, or factor on the picture.
    radiance: Color,
    picture: Option<Box<Picture>>,
}

#[derive(Debug)]
struct Picture {
    panorama: Panorama,
    blur: Blur,
    render_from_light: Transform,
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
                "How the picture lies on the sphere: latitude-longitude with +z at the top and u from +x by +y, or \
                 pbrt-v4's equal-area octahedral map. Auto takes square pictures for equal-area ones.",
            ),
            ParamSpec::new(
                "portal",
                ParamType::Point3s,
                ParamDefault::Unset,
                "Where the light comes in, a help for path tracing: not used yet.",
            ),
        ],
    };
    fn build(args: &mut Args<'_>) -> Option<Self::Output> {
        if !args.is_set("filename") {
            return Some(Box::new(Self { radiance: scaled(args, "L", "illuminance", PI), picture: None }));
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
            return Some(Box::new(Self { radiance: Color::new(1.0, 0.0, 1.0), picture: None }));
        };
        if let Some(reason) = panorama::unfit(&image) {
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
        let blur = Blur::of(&pyramid, panorama.size()[1]);
        let picture = Box::new(Picture { panorama, blur, render_from_light: Transform::IDENTITY });
        Some(Box::new(Self { radiance: Color::gray(scale), picture: Some(picture) }))
    }
}

impl Infinite {
    /// What `look` says of the picture in a direction of render space; the constant radiance if there is none.
    fn emitted(&self, basis: Basis, d: Vector3, look: impl Fn(&Picture, Vector3) -> [f32; 3]) -> Spectrum {
        let Some(picture) = &self.picture else { return basis.emission(self.radiance) };
        let d = picture.render_from_light.inverse().vector(d).normalize();
        basis.emission(Color { rgb: look(picture, d) } * self.radiance)
    }
}

impl Light for Infinite {
    fn place(&mut self, track: &Track) {
        if let Some(picture) = &mut self.picture {
            picture.render_from_light = Transform::from_f64(&track.at(f32::NEG_INFINITY));
        }
    }
    fn surrounds(&self) -> bool {
        true
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
