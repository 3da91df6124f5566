//! The pbrt scene language, from outside.

mod corpus;
mod errors;
mod include;
mod motion;
mod random;
mod read;
mod scene;
