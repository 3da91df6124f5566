//! Oracles for durer's tests: double-precision formulas that are written apart from the code they check.
//!
//! Nothing here is used when rendering. Directions are of unit length and point away from the surface unless said
//! otherwise; in local frames z is the normal.
#![forbid(unsafe_code)]

pub mod bilinear;
pub mod chi_square;
pub mod gloss_table;
pub mod interface;
pub mod lens;
pub mod measured;
pub mod microfacet;
pub mod ptex;
pub mod quadrature;
pub mod random;

pub use glam::DVec3;
