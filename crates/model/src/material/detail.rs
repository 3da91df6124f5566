//! Detail of a surface that its shape does not have: a bump map or a normal map tilts the shading normal.
//!
//! Bumps (Blinn 1978, "Simulation of Wrinkled Surfaces"): the surface moved along its normal by a texture of heights has the
//! derivatives `dp/du + n dh/du` and `dp/dv + n dh/dv`, by finite differences.
use durer_core::{
    math::{Point2, Vector3},
    spectrum::Color,
};
use durer_scene::{Args, FloatInput, ParamDefault, ParamSpec, ParamType};

use super::normal_map;
use crate::{
    ShadeCx, Surface,
    texture::{TextureAt, imagemap::texels::Texels},
};

/// Step of the finite differences, in surface coordinates (pbrt-v4's, where no ray differentials tell another).
const STEP: f32 = 5e-4;

/// Bumps and normals of pbrt's materials.
#[derive(Debug)]
pub(super) struct Detail {
    heights: Option<FloatInput>,
    normals: Option<Texels>,
}

impl Detail {
    pub(super) const DISPLACEMENT: ParamSpec = ParamSpec::new(
        "displacement",
        ParamType::FloatTexture,
        ParamDefault::Unset,
        "Heights in metres: a bump map that tilts the shading normal; the shape stays as it is.",
    );
    pub(super) const NORMAL_MAP: ParamSpec = ParamSpec::new(
        "normalmap",
        ParamType::File,
        ParamDefault::Unset,
        "An image of normals, n = 2 c - 1, linear.",
    );

    /// Reads both parameters.
    pub(super) fn read(args: &mut Args<'_>) -> Self {
        let heights = args.is_set("displacement").then(|| args.float_input("displacement"));
        // pbrt's own exporters write an empty name for none.
        let image = if args.text("normalmap").is_empty() { None } else { args.image("normalmap") };
        let normals = image.filter(|i| i.width > 0 && i.height > 0).map(|image| Texels::new(image, false));
        if heights.is_some() && normals.is_some() {
            args.warning("displacement", "\"displacement\" has no effect beside \"normalmap\"");
        }
        Self { heights, normals }
    }

    /// Tilts the shading normal.
    pub(super) fn tilt(&self, cx: &ShadeCx<'_>, surface: &mut Surface, wo: Vector3) {
        if let Some(normals) = &self.normals {
            surface.n_s = normal_map::tilted(surface, looked_up(normals, surface.uv), 1.0, wo);
        } else if let Some(heights) = self.heights
            && !matches!(heights, FloatInput::Constant(_))
        {
            bump(cx, heights, surface, wo);
        }
    }
}

fn bump(cx: &ShadeCx<'_>, heights: FloatInput, surface: &mut Surface, wo: Vector3) {
    let at = surface.texture_at();
    let (dpdu, dpdv) = (surface.dpdu, surface.dpdv);
    let here = cx.float(heights, &at);
    let slope = |du: f32, dv: f32| {
        let step = |uv: Point2| Point2::new(uv.x + du, uv.y + dv);
        let p = at.p + dpdu * du + dpdv * dv;
        let beside = TextureAt { uv: step(at.uv), second_uv: step(at.second_uv), p, ..at };
        (cx.float(heights, &beside) - here) / STEP
    };
    let n_s = Vector3::from(surface.n_s);
    let u = dpdu + n_s * slope(STEP, 0.0);
    let v = dpdv + n_s * slope(0.0, STEP);
    let n = u.cross(v);
    if n.length() > 0.0 && n.is_finite() {
        let n = n.normalize();
        surface.n_s = normal_map::kept(surface, if n.dot(n_s) < 0.0 { -n } else { n }, wo);
        surface.dpdu = u;
        surface.dpdv = v;
    }
}

/// The colour between the texels around a point; the image repeats.
fn looked_up(texels: &Texels, uv: Point2) -> Color {
    let size = [texels.width(), texels.height()];
    let place = [f64::from(uv.x), 1.0 - f64::from(uv.y)];
    if !place.iter().all(|v| v.is_finite()) {
        return Color::new(0.5, 0.5, 1.0);
    }
    let at: [(f64, f64); 2] = std::array::from_fn(|i| {
        let x = place[i].rem_euclid(1.0) * f64::from(size[i]) - 0.5;
        (x.floor(), x - x.floor())
    });
    let texel = |dx: f64, dy: f64| {
        let index = |i: usize, d: f64| (at[i].0 + d).rem_euclid(f64::from(size[i])) as u32;
        let [r, g, b, _] = texels.rgba(index(0, dx), index(1, dy));
        Color::new(r, g, b)
    };
    let (fx, fy) = (at[0].1 as f32, at[1].1 as f32);
    let along = |dy: f64| texel(0.0, dy) * (1.0 - fx) + texel(1.0, dy) * fx;
    along(0.0) * (1.0 - fy) + along(1.0) * fy
}
