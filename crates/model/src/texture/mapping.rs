//! How texture coordinates follow from surface coordinates: an affine map, in f64.
use durer_scene::{Args, ParamDefault, ParamSpec, ParamType};

use super::TextureAt;

/// `u' = m0 u + m1 v + m2`, `v' = m3 u + m4 v + m5`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct UvMapping {
    matrix: [f64; 6],
    /// Whether it starts from the second set of surface coordinates.
    second: bool,
}

/// The words of pbrt's mappings.
pub(super) const MAPPING: ParamSpec = ParamSpec::new(
    "mapping",
    ParamType::Choice(&["uv", "spherical", "cylindrical", "planar"]),
    ParamDefault::Text("uv"),
    "What texture coordinates are made from; only uv, those of the surface, is supported.",
);
/// Factor of u.
pub(super) const U_SCALE: ParamSpec = ParamSpec::float("uscale", 1.0, "Factor of u.");
/// Factor of v.
pub(super) const V_SCALE: ParamSpec = ParamSpec::float("vscale", 1.0, "Factor of v.");
/// Added to u.
pub(super) const U_DELTA: ParamSpec = ParamSpec::float("udelta", 0.0, "Added to u after scaling.");
/// Added to v.
pub(super) const V_DELTA: ParamSpec = ParamSpec::float("vdelta", 0.0, "Added to v after scaling.");
/// Which surface coordinates.
pub(super) const UV_SET: ParamSpec = ParamSpec::new(
    "uvset",
    ParamType::Int,
    ParamDefault::Int(0),
    "Which texture coordinates of a mesh: 0 the first, 1 the second; a shape with one set has it twice.",
)
.range(0.0, 1.0);
/// All six coefficients.
pub(super) const UV_MATRIX: ParamSpec = ParamSpec::new(
    "uvmatrix",
    ParamType::Floats,
    ParamDefault::Unset,
    "Six numbers m0 to m5 instead of the other four: u' = m0 u + m1 v + m2, v' = m3 u + m4 v + m5.",
);

impl UvMapping {
    /// From the parameters above (`uvmatrix` only where the kind has it); complains if they contradict each other.
    pub(super) fn read(args: &mut Args<'_>) -> Self {
        let mapping = args.text("mapping");
        if mapping != "uv" {
            args.error("mapping", format!("the mapping \"{mapping}\" is not supported yet, only \"uv\""));
        }
        let four = ["uscale", "vscale", "udelta", "vdelta"];
        let [su, sv, du, dv] = four.map(|name| f64::from(args.float(name)));
        let second = args.int("uvset") == 1;
        let matrix = match *args.floats("uvmatrix") {
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
        };
        Self { matrix, second }
    }
    /// Texture coordinates at a place.
    pub(super) fn apply(&self, at: &TextureAt) -> [f64; 2] {
        let uv = if self.second { at.second_uv } else { at.uv };
        let (u, v, m) = (f64::from(uv.x), f64::from(uv.y), &self.matrix);
        [m[0] * u + m[1] * v + m[2], m[3] * u + m[4] * v + m[5]]
    }
}
