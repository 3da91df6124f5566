//! The ray tree of a pixel sample as a document: what `docs/ray-tree.md` describes.
//!
//! Field names are keys: a contract. Within a version keys may be added, none renamed. What does not apply is `None` and
//! `null`. Kinds, reasons and roles are words, not enumerations, so that readers of today open trees of tomorrow.
use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::{
    compare::Comparison,
    cut::LeftOut,
    drawn::Drawn,
    floating::Floating,
    gathered::Gathered,
    number::{Direction, Metres, Number, Place, Rgb},
};

/// The version of the document.
pub const VERSION: u32 = 1;

/// All rays of one sample.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct Tree {
    /// Version of this schema: 1.
    pub version: u32,
    /// Version of the program that wrote it.
    pub durer: String,
    /// The scene, as it was named on the command line.
    pub scene: String,
    /// The integrator's registered word.
    pub integrator: String,
    /// Pixels per row of the picture.
    pub width: u32,
    /// Rows of the picture.
    pub height: u32,
    /// Column and row of the pixel; 0,0 is the upper left one.
    pub pixel: [u32; 2],
    /// Index of the sample within the pixel, from 0.
    pub sample: u32,
    /// How many samples the pixel has.
    pub samples: u32,
    /// `supersample` or `adaptive`.
    pub antialias: String,
    /// What the sample counts in the pixel; null with adaptive antialiasing.
    pub filter_weight: Option<Number>,
    /// What the camera makes of the radiance that arrives along the eye ray, if not the same: `rgb` is that times the
    /// eye ray's result.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gain: Option<Number>,
    /// By how much the film scales that down because it is too bright, if it does: `rgb` is that much darker.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clamp: Option<Number>,
    /// What becomes of red, green and blue on a film that calls another light white, a row for each; the last step to `rgb`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub balance: Option<[Rgb; 3]>,
    /// Where in the picture the sample lies, in pixels from the upper left corner.
    pub film: [Number; 2],
    /// Where on the lens the eye ray starts, in metres right of and above its centre; null for a pinhole.
    pub lens: Option<[Number; 2]>,
    /// The moment of the sample, in seconds.
    pub time: Number,
    /// The wavelengths that rays carry, in nm; null if they carry red, green and blue.
    pub wavelengths: Option<[Number; 4]>,
    /// What a lane of 1 counts in `rgb`, for each of the wavelengths; null if there are none.
    pub lane_weights: Option<[Rgb; 4]>,
    /// What the integrator was told: its parameters with their values.
    pub rules: BTreeMap<String, serde_json::Value>,
    /// The value of the sample: linear RGB, or the three numbers of a data picture.
    pub rgb: Rgb,
    /// Sum of `lost` of all nodes: the share of the pixel that rays which were not traced would have had.
    pub killed: Rgb,
    /// The largest radiance in the tree, over nodes and channels.
    pub max_radiance: Number,
    /// The largest radiance that any ray of the scene can bring, over channels and in the mean over random choices. Null
    /// if no ray was given up that it concerns, or if there is no bound.
    pub brightest: Option<Number>,
    /// So much of `rgb` at most is missing because rays were not traced: `lost` times `brightest`, or times what the
    /// light of a shadow ray sends, of all nodes. Null if there is no bound.
    pub missing: Option<Rgb>,
    /// Why there is no bound on what is missing; null if there is one.
    pub no_bound: Option<String>,
    /// What the numbers of a data picture are: `depth`, `normal`, `uv`, `id` or `cost`. Null if `rgb` is light.
    pub data: Option<String>,
    /// The node that an infinite or NaN value comes from; null if there is none.
    pub bad: Option<u32>,
    /// The rays, parents before children, in the order they were announced; ids are indices.
    pub nodes: Vec<Node>,
    /// Against the same sample under other settings (`--diff`).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub diff: Option<Comparison>,
    /// In the page only: the rays of the tree that there was no room for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub left_out: Option<LeftOut>,
}

/// One ray.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct Node {
    /// Its index in `nodes`.
    pub id: usize,
    /// The ray it was spawned by; null for the eye ray.
    pub parent: Option<u32>,
    /// What it is for.
    pub kind: String,
    /// Bounces before it.
    pub depth: u32,
    /// Where it starts.
    pub origin: Place,
    /// Where it goes; unit length.
    pub direction: Direction,
    /// Its length in metres: to the hit, to the particle or to the light. Null if it left the scene.
    pub t: Option<Number>,
    /// Where it hit a surface.
    pub point: Option<Place>,
    /// What it hit.
    pub object: Option<String>,
    /// Which placement of geometry that is, as the kernel counts them.
    pub instance: Option<u32>,
    /// Which triangle or part of the object, as the kernel counts them.
    pub primitive: Option<u32>,
    /// Material of the object: its name, or kind and number.
    pub material: Option<String>,
    /// Unit shading normal, on the outside.
    pub normal: Option<Direction>,
    /// Unit geometric normal, on the outside.
    pub geometric_normal: Option<Direction>,
    /// Surface coordinates.
    pub uv: Option<[Number; 2]>,
    /// Weights of the corners 0, 1 and 2 of the triangle that was hit.
    pub barycentric: Option<[Number; 3]>,
    /// The corners of the triangle that was hit.
    pub triangle: Option<[Place; 3]>,
    /// `outside` or `inside`: where the ray came from.
    pub side: Option<String>,
    /// Cosine of the angle between the ray and the shading normal, at least 0.
    pub cos: Option<Number>,
    /// Its moment, in seconds.
    pub time: Number,
    /// What the parent multiplies `result` with.
    pub weight: Rgb,
    /// Product of the weights from the eye to here: the ray's share in the pixel.
    pub throughput: Rgb,
    /// `weight`, `throughput`, `local` and `result` at the wavelengths of the tree; null if rays carry red, green and blue.
    /// The keys of these names are then the colours that weights give to white light, and those of the light: rounded
    /// views, of which only the light's sum.
    pub lanes: Option<Lanes>,
    /// Radiance from no other ray.
    pub local: Rgb,
    /// Of `local`, what the surface sends out by itself.
    pub emission: Option<Rgb>,
    /// Of `local`, the ambient term.
    pub ambient: Option<Rgb>,
    /// Of `local`, the sky's blurred image in glossy lobes that no ray is drawn from.
    pub blurred_sky: Option<Rgb>,
    /// The share of light that is left at the start of the ray of what leaves the surface: absorption in bodies and
    /// attenuation by distance; 1 in air.
    pub arrived: Rgb,
    /// `throughput` times `local`: contributions of all nodes sum to `rgb`, up to rounding.
    pub contribution: Rgb,
    /// The ray's radiance: `local` plus weight times result of every child, in their order.
    pub result: Rgb,
    /// Why nothing follows.
    pub stop: Option<String>,
    /// What the reason compared.
    pub limit: Option<Limit>,
    /// The share in the pixel that a ray which was not traced would have had.
    pub lost: Rgb,
    /// Of shadow rays: what they found out.
    pub light: Option<Light>,
    /// What keeps all light of a shadow ray back, if something does.
    pub blocker: Option<String>,
    /// The transparent bodies on both sides of the surface that was hit.
    pub media: Option<Media>,
    /// What floats on the way; null where nothing does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub floating: Option<Floating>,
    /// Light that photons brought to the surface that was hit; null where none are gathered.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gathered: Option<Gathered>,
    /// Reflection and refraction at the surface that was hit.
    pub fresnel: Option<Fresnel>,
    /// What the surface does with light.
    pub lobes: Vec<Lobe>,
    /// How `weight` came about, where something was chosen at random.
    pub drawn: Option<Drawn>,
    /// Random numbers that were drawn at this node.
    pub random: Vec<Random>,
    /// State of the sampler from which the node can be traced again, in hexadecimal.
    pub sampler: Option<String>,
    /// Textures that were looked up.
    pub textures: Vec<Lookup>,
    /// What finding the hit took.
    pub tests: Tests,
    /// Nanoseconds that it took; null if it was not timed. Differs from run to run.
    pub ns: Option<u64>,
    /// Boxes in the order they were tested, if that was asked for.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub walk: Vec<TestedBox>,
    /// In the page only, where the tree was cut: its id in the whole one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub whole_id: Option<u32>,
    /// In the page only: what of the rays below it there was no room for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub left_out: Option<LeftOut>,
}

/// What a ray carries, by wavelength.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct Lanes {
    /// What the parent multiplies `result` with.
    pub weight: [Number; 4],
    /// The ray's share in the pixel.
    pub throughput: [Number; 4],
    /// Radiance from no other ray.
    pub local: [Number; 4],
    /// The ray's radiance.
    pub result: [Number; 4],
}

/// What a ray was compared with when it was given up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct Limit {
    /// Its depth, or its share in the pixel.
    pub value: Number,
    /// The largest depth, or the share at or below which rays are given up.
    pub threshold: Number,
}

/// What a shadow ray found out.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct Light {
    /// Index of the light in the scene.
    pub index: u32,
    /// Its name.
    pub name: Option<String>,
    /// The point of the light that the ray goes to; null if it is infinitely far away.
    pub point: Option<Place>,
    /// Some of its light arrives.
    pub visible: bool,
    /// The share of the light that passes what lies between: 1 where nothing does.
    pub passed: Rgb,
    /// What would arrive if nothing lay between.
    pub unoccluded: Rgb,
}

/// The transparent bodies on both sides of a surface.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct Media {
    /// Those the ray is in before it meets the surface, the innermost last.
    pub before: Vec<Body>,
    /// Those that it is in behind the surface.
    pub after: Vec<Body>,
    /// Index of refraction before the surface.
    pub n1: Number,
    /// Index of refraction behind it.
    pub n2: Number,
}

/// A transparent body.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct Body {
    /// An object that it fills. Bodies of one material are not told apart.
    pub object: String,
    /// Where bodies overlap that of the highest priority is there.
    pub priority: Option<i32>,
    /// Its index of refraction.
    pub ior: Number,
}

/// Reflection and refraction at a smooth surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct Fresnel {
    /// Share of the light that is reflected.
    pub reflect: Number,
    /// Share that is refracted.
    pub transmit: Number,
    /// Angle from the normal beyond which all light is reflected, in degrees; null where there is none.
    pub critical_angle: Option<Number>,
    /// All light is reflected here.
    pub tir: bool,
    /// The material divides light by constants instead (Whitted 1980): `reflect` and `transmit` are what nature would do.
    pub constant: bool,
    /// Index of refraction behind the surface by that before it.
    pub eta: Number,
}

/// A way in which a surface scatters light.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct Lobe {
    /// What it is called.
    pub name: String,
    /// Share of light that it reflects.
    pub reflectance: Rgb,
    /// Share of light that it lets through.
    pub transmittance: Rgb,
    /// Exponent of a highlight.
    pub exponent: Option<Number>,
    /// Roughness of microfacets.
    pub alpha: Option<Number>,
}

/// Random numbers for one purpose.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct Random {
    /// What for.
    pub dim: String,
    /// The numbers, in [0, 1).
    pub u: Vec<Number>,
}

/// A texture that was looked up.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct Lookup {
    /// Its name.
    pub name: String,
    /// Where.
    pub uv: [Number; 2],
    /// What it gave: one number or three.
    pub value: Vec<Number>,
    /// Size of the area that was asked for, in surface coordinates.
    pub footprint: Option<Number>,
    /// Level of detail, 0 for the finest.
    pub level: Option<Number>,
}

/// What finding a hit took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct Tests {
    /// Nodes of hierarchies entered, each of which holds up to 8 or 16 boxes.
    pub boxes: u32,
    /// Primitives tested, of all kinds.
    pub primitives: u32,
    /// Of these, triangles.
    pub triangles: u32,
    /// Shapes that are no triangles, curves or points.
    pub shapes: u32,
    /// Curves.
    pub curves: u32,
    /// Points.
    pub points: u32,
}

/// A box of the hierarchy that was tested.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct TestedBox {
    /// Its lower and upper corner.
    #[serde(rename = "box")]
    pub corners: [[Metres; 3]; 2],
    /// How deep in the hierarchy it lies.
    pub depth: u32,
    /// The ray passes it.
    pub hit: bool,
}
