//! How texture coordinates follow from the place on a surface: an affine map of surface coordinates, in f64, or of the
//! point in texture space, where the texture was described.
//!
//! With `(x, y, z)` in texture space, `r` its distance from the origin and `q` from the z axis (Physically Based Rendering,
//! 4th edition, section 10.2): spherical `(acos(z / r) / pi, phi / 2 pi)` with the angle `phi` around z in `[0, 2 pi)`,
//! cylindrical `((pi + atan2(y, x)) / 2 pi, z)`, planar `(v1 . p + udelta, v2 . p + vdelta)`. The first two jump from one to
//! zero somewhere; their derivatives do not.
use std::f32::consts::{PI, TAU};

use durer_core::{
    glam::{DAffine3, DVec3},
    math::float::{acos, atan2},
};
use durer_scene::{Args, ParamDefault, ParamSpec, ParamType};

use super::{Footprint, TextureAt};

/// What texture coordinates follow from.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Form {
    /// `u' = m0 u + m1 v + m2`, `v' = m3 u + m4 v + m5`; of the second set of surface coordinates if so said.
    Uv { matrix: [f64; 6], second: bool },
    /// Longitude and latitude.
    Spherical(Space),
    /// Longitude and height.
    Cylindrical(Space),
    /// Components along two vectors.
    Planar { space: Space, along: [DVec3; 2], delta: [f64; 2] },
}

/// Texture coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Mapping {
    form: Form,
}

/// Where the texture lies: `texture_from_render`. The world until it is placed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Space(DAffine3);

impl Space {
    pub(super) const WORLD: Self = Self(DAffine3::IDENTITY);

    /// Puts it where `render_from_texture` says, which has an inverse.
    pub(super) fn place(&mut self, render_from_texture: &DAffine3) {
        self.0 = render_from_texture.inverse();
    }
    /// The point in texture space.
    pub(super) fn point(&self, at: &TextureAt) -> DVec3 {
        self.0.transform_point3(at.p.to_f64())
    }
    /// The sides of a footprint in texture space.
    pub(super) fn sides(&self, footprint: &Footprint) -> [DVec3; 2] {
        [footprint.dpdx, footprint.dpdy].map(|d| self.0.transform_vector3(d.to_f64()))
    }
    /// The length of its longer side.
    pub(super) fn width(&self, footprint: &Footprint) -> f32 {
        let [x, y] = self.sides(footprint);
        x.length().max(y.length()) as f32
    }
}

/// The words of pbrt's mappings.
const MAPPING: ParamSpec = ParamSpec::new(
    "mapping",
    ParamType::Choice(&["uv", "spherical", "cylindrical", "planar"]),
    ParamDefault::Text("uv"),
    "What texture coordinates are made from: those of the surface, or the point in the texture's own space.",
);
/// For u of the planar mapping.
const V1: ParamSpec = ParamSpec::new(
    "v1",
    ParamType::Vector3,
    ParamDefault::Triple([1.0, 0.0, 0.0]),
    "Planar: u is the component along it.",
);
/// For v of the planar mapping.
const V2: ParamSpec = ParamSpec::new(
    "v2",
    ParamType::Vector3,
    ParamDefault::Triple([0.0, 1.0, 0.0]),
    "Planar: v is the component along it.",
);
/// Factor of u.
const U_SCALE: ParamSpec = ParamSpec::float("uscale", 1.0, "Factor of u.");
/// Factor of v.
const V_SCALE: ParamSpec = ParamSpec::float("vscale", 1.0, "Factor of v.");
/// Added to u.
const U_DELTA: ParamSpec = ParamSpec::float("udelta", 0.0, "Added to u after scaling.");
/// Added to v.
const V_DELTA: ParamSpec = ParamSpec::float("vdelta", 0.0, "Added to v after scaling.");
/// Which surface coordinates.
const UV_SET: ParamSpec = ParamSpec::new(
    "uvset",
    ParamType::Int,
    ParamDefault::Int(0),
    "Which texture coordinates of a mesh: 0 the first, 1 the second; a shape with one set has it twice.",
)
.range(0.0, 1.0);
/// The parameters of [`Mapping::read`].
const PARAMS: [ParamSpec; 8] = [UV_SET, U_SCALE, V_SCALE, U_DELTA, V_DELTA, MAPPING, V1, V2];

/// The parameters `own` of a texture, then those of its mapping; `ALL` is how many that makes.
pub(super) const fn mapped<const OWN: usize, const ALL: usize>(own: [ParamSpec; OWN]) -> [ParamSpec; ALL] {
    assert!(ALL == OWN + PARAMS.len(), "a number of all parameters that is not right");
    let mut all = [PARAMS[0]; ALL];
    let mut i = 0;
    while i < ALL {
        all[i] = if i < OWN { own[i] } else { PARAMS[i - OWN] };
        i += 1;
    }
    all
}

/// All six coefficients, where a kind has them.
pub(super) const UV_MATRIX: ParamSpec = ParamSpec::new(
    "uvmatrix",
    ParamType::Floats,
    ParamDefault::Unset,
    "Six numbers m0 to m5 instead of the other four: u' = m0 u + m1 v + m2, v' = m3 u + m4 v + m5.",
);

impl Mapping {
    /// From the parameters above; complains if they contradict each other.
    pub(super) fn read(args: &mut Args<'_>) -> Self {
        let word = args.text("mapping");
        let unused: &[&str] = match word {
            "planar" => &["uscale", "vscale", "uvset", "uvmatrix"],
            "uv" => &["v1", "v2"],
            _ => &["uscale", "vscale", "udelta", "vdelta", "uvset", "uvmatrix", "v1", "v2"],
        };
        for name in unused.iter().filter(|name| args.is_set(name)).collect::<Vec<_>>() {
            args.warning(name, format!("\"{name}\" has no effect on the mapping \"{word}\""));
        }
        let form = match word {
            "spherical" => Form::Spherical(Space::WORLD),
            "cylindrical" => Form::Cylindrical(Space::WORLD),
            "planar" => Form::Planar {
                space: Space::WORLD,
                along: ["v1", "v2"].map(|name| DVec3::from(args.triple(name).map(f64::from))),
                delta: ["udelta", "vdelta"].map(|name| args.float(name).into()),
            },
            _ => Form::Uv { matrix: matrix(args), second: args.int("uvset") == 1 },
        };
        Self { form }
    }

    /// See [`super::Texture::place`].
    pub(super) fn place(&mut self, render_from_texture: &DAffine3) {
        match &mut self.form {
            Form::Uv { .. } => {}
            Form::Spherical(space) | Form::Cylindrical(space) | Form::Planar { space, .. } => {
                space.place(render_from_texture);
            }
        }
    }

    /// Texture coordinates at a place.
    #[inline]
    pub(super) fn apply(&self, at: &TextureAt) -> [f64; 2] {
        match &self.form {
            Form::Uv { matrix: m, second } => {
                let uv = if *second { at.second_uv } else { at.uv };
                let (u, v) = (f64::from(uv.x), f64::from(uv.y));
                [m[0] * u + m[1] * v + m[2], m[3] * u + m[4] * v + m[5]]
            }
            Form::Spherical(space) => {
                let p = space.point(at);
                let phi = atan2(p.y as f32, p.x as f32);
                let phi = if phi < 0.0 { phi + TAU } else { phi };
                // At the origin there is no direction: any will do.
                let cos = if p == DVec3::ZERO { 1.0 } else { p.z / p.length() };
                [acos(cos as f32) / PI, phi / TAU].map(f64::from)
            }
            Form::Cylindrical(space) => {
                let p = space.point(at);
                [f64::from((PI + atan2(p.y as f32, p.x as f32)) / TAU), p.z]
            }
            Form::Planar { space, along, delta } => {
                let p = space.point(at);
                [along[0].dot(p) + delta[0], along[1].dot(p) + delta[1]]
            }
        }
    }

    /// What the steps to the right and down that span the footprint add to texture coordinates.
    pub(super) fn spread(&self, at: &TextureAt, footprint: &Footprint) -> [[f64; 2]; 2] {
        match &self.form {
            Form::Uv { matrix: m, .. } => [footprint.duvdx, footprint.duvdy].map(|step| {
                let [du, dv] = step.map(f64::from);
                [m[0] * du + m[1] * dv, m[3] * du + m[4] * dv]
            }),
            Form::Spherical(space) => {
                let p = space.point(at);
                let (q2, q) = (p.x * p.x + p.y * p.y, p.x.hypot(p.y));
                let theta = DVec3::new(p.x * p.z, p.y * p.z, -q2) / (p.length_squared() * q);
                steps(space, footprint, [theta / std::f64::consts::PI, turn(p)])
            }
            Form::Cylindrical(space) => steps(space, footprint, [turn(space.point(at)), DVec3::Z]),
            Form::Planar { space, along, .. } => steps(space, footprint, *along),
        }
    }
}

/// The gradient of the angle around z, in turns.
fn turn(p: DVec3) -> DVec3 {
    DVec3::new(-p.y, p.x, 0.0) / (std::f64::consts::TAU * (p.x * p.x + p.y * p.y))
}

/// The footprint's sides along the gradients of both coordinates; 0 where these are not finite, as on the axis.
fn steps(space: &Space, footprint: &Footprint, gradients: [DVec3; 2]) -> [[f64; 2]; 2] {
    space.sides(footprint).map(|side| {
        gradients.map(|gradient| {
            let step = gradient.dot(side);
            if step.is_finite() { step } else { 0.0 }
        })
    })
}

/// The coefficients of the uv mapping.
fn matrix(args: &mut Args<'_>) -> [f64; 6] {
    let four = ["uscale", "vscale", "udelta", "vdelta"];
    let [su, sv, du, dv] = four.map(|name| f64::from(args.float(name)));
    match *args.floats("uvmatrix") {
        [] => [su, 0.0, du, 0.0, sv, dv],
        [m0, m1, m2, m3, m4, m5] => {
            if let Some(name) = four.into_iter().find(|name| args.is_set(name)) {
                args.error(name, format!("give either \"uvmatrix\" or \"{name}\", not both"));
            }
            [m0, m1, m2, m3, m4, m5].map(f64::from)
        }
        ref other => {
            args.error("uvmatrix", format!("\"uvmatrix\" has {} values, expected 6", other.len()));
            [1.0, 0.0, 0.0, 0.0, 1.0, 0.0]
        }
    }
}
