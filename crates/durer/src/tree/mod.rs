//! The ray tree as a document: what `durer trace` writes and everything that shows a tree reads.
//!
//! A [`Subject`] is traced into [`Tree`]s, and these are written: as JSON with all keys, as the data of a [`Page`], as a
//! graph, a drawing, a table, a scene. `docs/ray-tree.md` describes the keys; a test keeps it and the schema beside it true.
mod capture;
mod compare;
mod cut;
mod document;
mod dot;
mod drawn;
mod find;
mod floating;
mod fold;
mod format;
mod gathered;
pub mod ghost;
mod glb;
mod look;
mod material;
mod number;
mod page;
mod picture;
mod room;
#[cfg(test)]
mod schema;
mod svg;
mod table;

pub use capture::{Subject, Surroundings};
pub use compare::{Change, Comparison};
pub use cut::LeftOut;
pub use document::{
    Body, Fresnel, Light, Limit, Lobe, Lookup, Media, Node, Random, TestedBox, Tests, Tree, VERSION,
};
pub use dot::dot;
pub use drawn::Drawn;
pub use find::{Find, Found};
pub use floating::{Floating, Scattered};
pub use format::{FORMATS, Format};
pub use gathered::Gathered;
pub use ghost::GhostScene;
pub use glb::{TooLarge, glb};
pub use look::{Look, Wording, met, short, triple};
pub use number::{Direction, Metres, Number, Place, Rgb, plain, rgb};
pub use page::{Dimensions, Other, Page};
pub use picture::Thumbnail;
pub use svg::svg;
pub use table::{csv, markdown};
