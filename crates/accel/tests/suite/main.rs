//! What durer-accel promises, checked on seeded random scenes. `DURER_SLOW=1` runs 10^6 rays where noted.
mod animation;
mod bending;
mod corpus;
mod curves;
mod edge_cases;
mod equality;
mod filtered;
mod icosphere;
mod instancing;
mod near_misses;
mod points;
mod properties;
mod shapes;
mod triangle;
mod watertight;
