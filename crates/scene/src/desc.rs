//! The scene as plain data: what importers write and `compile` reads.
use std::{collections::BTreeSet, sync::Arc};

use durer_core::{
    Id,
    glam::{DAffine3, DVec3},
    math::{Bounds3, Motion},
};
use serde::Serialize;

use crate::{Location, Mesh, Params};

/// Something of a registered kind with its parameters: a shape, material, light, ...
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Node {
    /// The registered word: `sphere`, `classic`, `point`.
    pub kind: String,
    /// Parameters as written.
    pub params: Params,
    /// Where the kind was named.
    pub at: Location,
}

impl Node {
    /// A node that no text names.
    pub fn new(kind: &str, params: Params) -> Self {
        Self { kind: kind.to_owned(), params, at: Location::None }
    }
}

/// A node that others refer to.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct NamedNode {
    /// Its name; may be empty.
    pub name: String,
    /// The node.
    pub node: Node,
}

/// Index of a material in [`SceneDesc::materials`].
pub type MaterialRef = Id<NamedNode>;

/// Something that floats in places, with the placement of its own space.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct MediumDesc {
    /// Its name.
    pub name: String,
    /// Kind and parameters.
    pub node: Node,
    /// Placement.
    pub world_from_medium: DAffine3,
}

/// Index of a medium in [`SceneDesc::media`].
pub type MediumRef = Id<MediumDesc>;

/// What floats on the two sides of a surface; `None` is nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize)]
pub struct MediumInterface {
    /// Behind it, where its normal does not point.
    pub inside: Option<MediumRef>,
    /// Before it.
    pub outside: Option<MediumRef>,
}

/// A camera with its placement. It looks along +z of camera space with y up and x to the right (pbrt's left-handed
/// camera space: the placement contains the mirroring).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CameraDesc {
    /// Its name; may be empty.
    pub name: String,
    /// Kind and parameters.
    pub node: Node,
    /// Placement.
    pub world_from_camera: Motion,
    /// What it is in, if the file says so: the outside.
    pub media: Option<MediumInterface>,
}

/// What the file asks of the picture; `None` where it is silent.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct FilmDesc {
    /// Pixels per row.
    pub width: Option<u32>,
    /// Rows.
    pub height: Option<u32>,
    /// Samples per pixel.
    pub samples: Option<u32>,
    /// Rays shall carry wavelengths instead of red, green and blue.
    pub spectral: bool,
    /// What it keeps beside colours.
    pub layers: Option<LayersDesc>,
    /// Diagonal of the film in mm, for cameras in which it has a size.
    pub diagonal_mm: Option<f32>,
    /// Speed of the film; 100 leaves pictures as they are.
    pub iso: Option<f32>,
    /// Seconds for which the film is exposed, as far as brightness goes; 1 leaves pictures as they are.
    pub exposure_seconds: Option<f32>,
    /// The temperature of the daylight that it shows as white, in kelvin; what sends as Rec. 709's white if `None`.
    pub white_balance: Option<f32>,
    /// The most that a sample's X, Y or Z may be: brighter ones are scaled down.
    pub max_component_value: Option<f32>,
    /// The part of the picture that is wanted.
    pub crop: Option<Crop>,
    /// What changes every random number.
    pub seed: Option<u64>,
    /// Where the file wants the picture written; shown by `info`, never written to unasked.
    pub filename: Option<String>,
}

/// What a film keeps beside colours.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub enum LayersDesc {
    /// What eye rays meet first, and how much samples differ: pbrt-v4's film `gbuffer`.
    Surfaces(Space),
    /// Light by its wavelength, in so many parts of a range in nm that are equally wide: pbrt-v4's film `spectral`.
    Buckets {
        /// How many.
        count: u32,
        /// The ends of the range.
        range: [f32; 2],
    },
}

/// What places and directions are told in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Space {
    /// The camera's: x right, y up, z ahead.
    Camera,
    /// The world's.
    World,
}

impl Space {
    /// The words for them.
    pub const WORDS: [&'static str; 2] = ["camera", "world"];
    /// The word for it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Camera => Self::WORDS[0],
            Self::World => Self::WORDS[1],
        }
    }
}

/// What holds for all of a scene: pbrt-v4's options.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct OptionsDesc {
    /// All samples of a pixel go through its middle and that of the lens, at half exposure.
    pub disable_pixel_jitter: bool,
    /// All samples carry the same wavelengths, where they carry some.
    pub disable_wavelength_jitter: bool,
    /// Textures are looked at in points.
    pub disable_texture_filtering: bool,
    /// Every surface scatters what it scatters evenly.
    pub force_diffuse: bool,
    /// A factor on how long edges of displaced shapes may be.
    pub displacement_edge_scale: Option<f32>,
}

/// A part of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub enum Crop {
    /// First and last of x, then of y, as shares of the picture's size; y points down.
    Window([f32; 4]),
    /// The same in pixels of the size that the file gives; the last ones are left out.
    Pixels([u32; 4]),
}

impl Crop {
    /// First and last of x, then of y, in pixels of a picture of size `to`, where the file asks for `from`; as pbrt-v4 rounds.
    pub fn pixels(self, [from_x, from_y]: [u32; 2], [to_x, to_y]: [u32; 2]) -> [u32; 4] {
        let share = |share: f32, size: u32| (share * size as f32).ceil() as u32;
        let edge = |edge: u32, from: u32, to: u32| {
            (u64::from(edge) * u64::from(to)).div_ceil(u64::from(from.max(1))) as u32
        };
        match self {
            Self::Window([x0, x1, y0, y1]) => {
                [share(x0, to_x), share(x1, to_x), share(y0, to_y), share(y1, to_y)]
            }
            Self::Pixels([x0, x1, y0, y1]) => [
                edge(x0, from_x, to_x),
                edge(x1, from_x, to_x),
                edge(y0, from_y, to_y),
                edge(y1, from_y, to_y),
            ],
        }
    }
}

/// What a texture yields.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum TextureValue {
    /// One number.
    Float,
    /// A colour.
    Color,
}

/// A texture that parameters refer to by name.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TextureDesc {
    /// The name parameters use.
    pub name: String,
    /// What it yields.
    pub value: TextureValue,
    /// Kind and parameters.
    pub node: Node,
    /// Where its own space is, for kinds that look at points; it has an inverse.
    pub world_from_texture: DAffine3,
}

/// A light with its placement.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LightDesc {
    /// Its name; may be empty.
    pub name: String,
    /// Kind and parameters.
    pub node: Node,
    /// Placement.
    pub world_from_light: Motion,
}

/// Where a shape's geometry is.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum ShapeSource {
    /// Kind and parameters; shapes that share a node share what is built from it.
    Node(Arc<Node>),
    /// A mesh of [`SceneDesc::meshes`]; several shapes may share one.
    Mesh(Id<Mesh>),
}

/// A placed shape.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ShapeDesc {
    /// What the ray tree and `info` call it; may be empty.
    pub name: String,
    /// Geometry.
    pub source: ShapeSource,
    /// Placement.
    pub world_from_object: Motion,
    /// Material; grey matte if none.
    pub material: Option<MaterialRef>,
    /// Turns the normals: the other side is the outside.
    pub reverse_orientation: bool,
    /// The light that its surface sends out, if any.
    pub area_light: Option<Arc<Node>>,
    /// What floats on its two sides, if the file says so.
    pub media: Option<MediumInterface>,
}

/// A way in which a scene moves that is not part of its description: the file can be read at moments of it.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct AnimationDesc {
    /// Its name; may be empty.
    pub name: String,
    /// The time of its first key, in seconds.
    pub start: f32,
    /// The time of its last key, in seconds.
    pub end: f32,
}

/// A whole scene.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct SceneDesc {
    /// File stem or name of the built-in scene.
    pub name: String,
    /// Cameras; the first is the default.
    pub cameras: Vec<CameraDesc>,
    /// Picture settings.
    pub film: FilmDesc,
    /// What is left out, so that something else is seen better.
    pub options: OptionsDesc,
    /// Reconstruction filter.
    pub filter: Option<Node>,
    /// Sampler.
    pub sampler: Option<Node>,
    /// Light transport.
    pub integrator: Option<Node>,
    /// Bounces of paths where the file is silent, if its language says how many.
    pub usual_depth: Option<u32>,
    /// Textures; names are unique per [`TextureValue`].
    pub textures: Vec<TextureDesc>,
    /// Materials.
    pub materials: Vec<NamedNode>,
    /// What floats in bodies or in the air; names are unique.
    pub media: Vec<MediumDesc>,
    /// Lights.
    pub lights: Vec<LightDesc>,
    /// Meshes.
    #[serde(skip)]
    pub meshes: Vec<Arc<Mesh>>,
    /// Shapes.
    pub shapes: Vec<ShapeDesc>,
    /// The sets of materials that its file offers, by name; some may be empty.
    pub variants: Vec<String>,
    /// The animations of its file.
    pub animations: Vec<AnimationDesc>,
    /// Indices of the shapes that are elsewhere, or of another form, at other moments of the animation. They are kept apart
    /// from what rests, so that this has the same bits at all moments and is made once.
    #[serde(skip)]
    pub apart: BTreeSet<usize>,
    /// Where render space has its origin; at the camera if `None`. Of a scene that is described at one moment after another
    /// it is the same for all, so that what rests has the same bits.
    #[serde(skip)]
    pub origin: Option<DVec3>,
    /// What a camera that is made up sees all of; the shapes if `None`. Of a scene that is described at one moment after
    /// another it is the same for all.
    #[serde(skip)]
    pub extent: Option<Bounds3>,
}
