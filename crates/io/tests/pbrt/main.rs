//! The pbrt scene language, from outside.

mod corpus;
mod errors;
mod include;
mod random;
mod read;
mod scene;
