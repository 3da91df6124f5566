//! Scene descriptions: plain data that importers write and `durer-render` compiles.
//!
//! [`SceneDesc`] knows no files, no threads and no rendering. Nodes carry spans, so that every later complaint points
//! at the text it is about ([`Diagnostics`]). A [`Schema`] says which parameters a kind takes.
#![forbid(unsafe_code)]
#![deny(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::indexing_slicing)]

mod assets;
mod counted;
mod desc;
mod diag;
mod mesh;
mod nearest;
mod params;
mod ptex;
mod schema;
mod span;
mod tensors;
mod voxels;

pub use assets::{AssetError, Assets, Image, ImageData, Limits};
pub use counted::counted;
pub use desc::{
    AnimationDesc, CameraDesc, Crop, FilmDesc, LayersDesc, LightDesc, MaterialRef, MediumDesc,
    MediumInterface, MediumRef, NamedNode, Node, OptionsDesc, SceneDesc, ShapeDesc, ShapeSource, Space,
    TextureDesc, TextureValue,
};
pub use diag::{Diagnostic, Diagnostics, Severity, listed};
pub use mesh::{Mesh, MeshError, VertexKey};
pub use nearest::nearest_word;
pub use params::{Data, Param, Params, ValueType};
pub use ptex::{Ptex, PtexFace, PtexShape};
pub use schema::{
    Args, ColorInput, Entry, FloatInput, Kind, LightInput, Missing, ParamDefault, ParamSpec, ParamType,
    Schema, TextureNames, find,
};
pub use span::{Location, SourceId, Sources, Span};
pub use tensors::{Tensor, TensorType, Tensors};
pub use voxels::{BLOCK, VoxelBlocks, Voxels};
